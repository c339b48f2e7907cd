//! Opening and saving, in the background.

use std::path::PathBuf;
use std::sync::Arc;

use super::state::{REPORT_IT, lost};
use super::{
    Document, Finished, History, Job, Message, Model, Place, Poll, SaveRequest, Session, Severity, Surface, Timeline,
};
use crate::io::{ReadError, WriteError};
use crate::mesh::{Elements, Fault, TriMesh, VertexId};
use crate::solver::Verdict;

impl Session {
    pub(super) fn open(
        &mut self,
        path: Option<PathBuf>,
        read: impl FnOnce() -> Result<Model, ReadError> + Send + 'static,
    ) {
        match Job::spawn("load", self.waker(), move |_| read()) {
            Ok(job) => {
                self.loading = Some(job);
                self.loading_path = path;
            }
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
                return self.fail(Place::Mesh, lost("loading"), Some(REPORT_IT));
            }
        };
        self.loading = None;
        let path = self.loading_path.take();
        match loaded {
            Ok(model) => {
                if let Some(path) = path {
                    self.recent.remember(&path);
                }
                self.take_model(model);
            }
            Err(error) => self.fail(Place::Mesh, error.to_string(), Some(error.remedy())),
        }
    }

    /// Puts a mesh on the table. The document before it is gone, its history with it.
    fn take_model(&mut self, model: Model) {
        self.messages.clear();
        if let Surface::Faulty(_, diagnosis) = &model.surface {
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
        let is_example = model.is_example();
        self.model = Some(Arc::new(model));
        self.model_revision += 1;
        self.document = Document { settings: self.document.settings, ..Document::default() };
        self.history = History::default();
        self.timeline = Timeline::default();
        self.ending = None;
        self.outcome_revision += 1;
        self.prepared = None;
        self.running = None;
        self.end_preview();
        if is_example {
            // An example is there to be watched: it waits for the person to take the steps.
            self.solve_first_step();
        } else {
            self.solve();
        }
    }

    pub(super) fn save(&mut self, request: SaveRequest) {
        let (Some(model), Some(outcome)) = (self.model.clone(), self.outcome().cloned()) else {
            return self.fail(Place::Embedding, "there is nothing to save yet: open a mesh first".to_owned(), None);
        };
        if !self.is_current() {
            let text = "the embedding on the screen does not belong to these settings and pins yet".to_owned();
            return self.fail(Place::Embedding, text, Some("save again when it is solved"));
        }
        let records = self.timeline.records()[..=outcome.step.index].to_vec();
        let picture = self.document.picture.clone();
        let work = move |_: &super::JobContext<()>| {
            let disk = model.disk().expect("only a disk has an outcome");
            let finished = Finished::new((&model, disk), &outcome, records, request.fit, 0.0).with_picture(picture);
            finished.write(request.kind, &request.path)?;
            Ok((request.path, finished.verdict().clone()))
        };
        match Job::spawn("save", self.waker(), work) {
            Ok(job) => self.saving.push(job),
            Err(error) => self.fail(Place::Embedding, format!("no thread to save with: {error}"), None),
        }
    }

    pub(super) fn poll_saving(&mut self) {
        for job in std::mem::take(&mut self.saving) {
            match job.poll() {
                Poll::Running => self.saving.push(job),
                Poll::Done(saved) => self.tell_saved(saved),
                Poll::Lost => self.fail(Place::Embedding, lost("saving"), Some(REPORT_IT)),
            }
        }
    }

    fn tell_saved(&mut self, saved: Result<(PathBuf, Verdict), WriteError>) {
        match saved {
            Ok((path, verdict)) => {
                let id = self.next_id();
                let text = format!("wrote {} ({})", path.display(), verdict.summary());
                self.messages.push(Message {
                    id,
                    severity: Severity::Note,
                    place: Place::Embedding,
                    text,
                    remedy: None,
                    vertices: Vec::new(),
                });
            }
            Err(error) => self.fail(Place::Embedding, error.to_string(), None),
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
