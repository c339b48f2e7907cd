//! Opening, in the background, and putting what was opened on the table.

use std::path::PathBuf;
use std::sync::Arc;

use super::opened::{OpenError, Opened, Origin, Remark};
use super::state::{REPORT_IT, lost};
use super::{Document, History, Job, Message, Place, Poll, Session, Severity, Surface, Timeline};
use crate::examples::Example;
use crate::io::ProjectSource;
use crate::mesh::{Elements, Fault, TriMesh, VertexId};
use crate::solver::Kept;

/// What is on the table, apart from what is edited: what an edit is compared with.
#[derive(Debug, Default)]
pub(super) struct OnTable {
    /// Counts what was opened.
    pub(super) opening: u64,
    /// What to call work that no project and no mesh names.
    pub(super) name: Option<String>,
    /// The project that it is saved to.
    pub(super) project: Option<PathBuf>,
    /// The document as it was opened or saved; none where it is nowhere but here.
    pub(super) saved: Option<Document>,
    /// The project's picture, where it could not be read: it stays in the project until there is another.
    pub(super) missing_picture: Option<ProjectSource>,
}

impl Session {
    /// Opens a mesh file or a project.
    pub(super) fn open(&mut self, path: PathBuf) {
        self.loading_path = Some(path.clone());
        self.load(move || Opened::read(&path));
    }

    /// Opens a built-in mesh.
    pub(super) fn open_example(&mut self, example: Example) {
        self.loading_path = None;
        self.load(move || Ok(Opened::example(example)));
    }

    /// Opens what a session before has left. It belongs to this session from now on.
    pub(super) fn recover(&mut self, path: PathBuf) {
        self.loading_path = None;
        if self.autosave.claim(&path) {
            self.load(move || Opened::recovered(&path));
        } else {
            let text = format!("another session works with it already, or it is gone: {}", path.display());
            self.fail(Place::Mesh, text, None);
        }
    }

    fn load(&mut self, read: impl FnOnce() -> Result<Opened, OpenError> + Send + 'static) {
        self.loading = None;
        match Job::spawn("load", self.waker(), move |_| read()) {
            Ok(job) => self.loading = Some(job),
            Err(error) => self.fail(Place::Mesh, format!("no thread to load with: {error}"), None),
        }
    }

    pub(super) fn poll_loading(&mut self) {
        let Some(job) = &self.loading else { return };
        let loaded = match job.poll() {
            Poll::Running => return,
            Poll::Done(loaded) => loaded,
            Poll::Lost => {
                self.loading = None;
                self.autosave.give_up_claim();
                return self.fail(Place::Mesh, lost("loading"), Some(REPORT_IT));
            }
        };
        self.loading = None;
        let path = self.loading_path.take();
        match loaded {
            Ok(opened) => {
                if let Some(path) = path {
                    self.recent.remember(&path);
                }
                self.take_opened(opened);
            }
            Err(error) => {
                self.autosave.give_up_claim();
                self.fail(Place::Mesh, error.to_string(), Some(error.remedy()));
            }
        }
    }

    /// Puts something on the table. The document before it is gone, its history with it.
    fn take_opened(&mut self, opened: Opened) {
        let Opened { model, mut document, view, origin, remarks, missing_picture, lost_pins } = opened;
        if matches!(origin, Origin::Mesh) {
            document.settings = self.document.settings;
        }
        // An example is there to be watched: it waits for the person to take the steps.
        let waits = model.is_example() && matches!(origin, Origin::Mesh);
        self.autosave.begin_anew(Some(&document).filter(|_| matches!(origin, Origin::Recovery(_))));
        self.on_table = on_table(self.on_table.opening + 1, origin, &document);
        self.on_table.missing_picture = missing_picture;
        if lost_pins {
            // The file keeps them: saving asks for another place.
            self.on_table.project = None;
        }
        self.document = document;
        self.view = view;
        self.history = History::default();
        self.forget_errands();
        self.model = Some(Arc::new(model));
        self.other_side = None;
        self.forget_steps();
        self.messages.clear();
        self.tell_faults();
        for Remark { place, text, remedy } in remarks {
            self.fail(place, text, Some(&remedy));
        }
        if waits {
            self.solve_first_step();
        } else {
            self.solve();
        }
    }

    /// Drops all that was solved: it belongs to another mesh, or to other faces.
    pub(super) fn forget_steps(&mut self) {
        self.model_revision += 1;
        self.timeline = Timeline::default();
        self.ending = None;
        self.outcome_revision += 1;
        self.end_preview();
        self.kept = Kept::default();
        self.running = None;
        self.resting = None;
        self.solve_again = false;
    }

    fn tell_faults(&mut self) {
        let Some(model) = self.model.clone() else { return };
        let Surface::Faulty(_, diagnosis) = &model.surface else { return };
        for fault in &diagnosis.faults {
            let id = self.next_id();
            self.messages.push(Message {
                id,
                severity: Severity::Error,
                place: Place::Mesh,
                text: fault.message(),
                remedy: Some(fault.remedy().to_owned()),
                vertices: first_vertices(fault, model.mesh()),
            });
        }
    }
}

fn on_table(opening: u64, origin: Origin, document: &Document) -> OnTable {
    let saved = Some(document.clone());
    match origin {
        Origin::Mesh => OnTable { opening, saved, ..OnTable::default() },
        Origin::Project(path) => OnTable { opening, project: Some(path), saved, ..OnTable::default() },
        Origin::Recovery(note) => {
            OnTable { opening, name: Some(note.name), project: note.project, ..OnTable::default() }
        }
    }
}

/// Vertices of the first element of a fault.
fn first_vertices(fault: &Fault, mesh: &TriMesh) -> Vec<VertexId> {
    match fault.elements() {
        Elements::Nothing => Vec::new(),
        Elements::Vertices(vertices) => vertices[..1].to_vec(),
        Elements::Edges(edges) => edges[0].to_vec(),
        Elements::Faces(faces) => mesh.triangles[faces.triangles[0].index()].to_vec(),
        Elements::Loops(loops) => loops[0].clone(),
    }
}
