//! The editor's state: the session, and everything about the window that is not part of the document.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the editor: its parts, and what it does in each frame |
//! | `requests.rs` | requests, carried out; moves along the timeline |
//! | `files.rs`, `unsaved.rs` | files that are asked for; the question about unsaved work |
//! | `comparison/` | methods side by side in the embedding's pane |
//! | `mesh_view.rs` | the mesh's pane: place, camera, scene |
//! | `plane/` | the embedding's pane: place, camera, what it draws |
//! | `scene.rs` | what the panes draw and pick in |
//! | `paint.rs` | faces coloured by a shading |
//! | `in_file.rs` | vertices of what is on the screen as those of the file |
//! | `seam_rules.rs` | seams at sharp edges, or where materials or groups meet |
//! | `sides.rs` | which side of a seam a vertex is on |
//! | `seam_chain.rs` | the clicks that a seam is drawn by, and the way back along them |
//! | `seam_intent.rs` | what a click of the seam tool would do |
//! | `seam_actions.rs` | requests to the seam tool, carried out |
//! | `seam_tool.rs` | the seam that is being drawn, and the shortest paths from where it has got to |
//! | `element.rs` | parts of the mesh by their names |
//! | `around.rs` | the charts around the one that is worked on |
//! | `async_scene.rs` | scenes are made in the background |
//! | `selection.rs` | what is selected, what is under the pointer, the tool in hand |
//! | `appearance.rs`, `shade.rs` | how faces show: shading of each pane, wireframe, picture, colours |
//! | `layout.rs` | what of the window is open |
//! | `preferences.rs` | what of the window is kept between runs |
//! | `opened.rs` | what the window keeps of the open document |
//! | `project_view.rs` | cameras, shadings, tool and selection in the project file |
//! | `gpu.rs` | egui's context and the graphics card |
//! | `frames.rs` | how long frames take |
//! | `views.rs` | what the cameras look at |
//! | `defect.rs` | what is wrong with an embedding |
//! | `picture_box.rs` | the place of the picture in the plane |

pub(super) mod appearance;
mod around;
mod async_scene;
pub(super) mod comparison;
mod defect;
mod element;
mod files;
mod frames;
mod gpu;
mod in_file;
pub(super) mod layout;
mod mesh_view;
mod opened;
pub(super) mod paint;
pub(super) mod picture_box;
mod plane;
mod preferences;
mod project_view;
mod requests;
pub(super) mod scene;
mod seam_actions;
mod seam_chain;
pub(super) mod seam_intent;
pub(super) mod seam_rules;
pub(super) mod seam_tool;
mod selection;
mod shade;
mod sides;
mod unsaved;
mod views;

pub use comparison::MorphView;
pub use defect::Defect;
pub(super) use element::Element;
pub(super) use plane::HullScene;

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;

use crate::session::{Busy, MessagePlace, RecentFiles, Session};
use crate::ui::state::{Tab, TimelineView};
use appearance::PaneShading;
use files::Files;
use gpu::Gpu;
use layout::Layout;
use mesh_view::MeshView;
use opened::Opened;
use plane::{PlaneView, SECONDS, Surroundings};
use scene::MeshScene;
use selection::{Pointer, Selection, ToolState};

/// How often the session is asked whether a copy for recovery is due.
const COPY_INTERVAL: Duration = Duration::from_secs(5);

/// Everything the window knows.
pub struct Editor {
    /// The document and the work on it.
    pub session: Session,
    /// The mesh's pane.
    pub mesh: MeshView,
    /// The embedding's pane.
    pub plane: PlaneView,
    /// What is selected.
    pub selection: Selection,
    /// What is under the pointer.
    pub pointer: Pointer,
    /// The tool in hand.
    pub tools: ToolState,
    /// How faces show.
    pub pane_shading: PaneShading,
    /// What of the window is open.
    pub layout: Layout,
    /// What the window keeps of the open document.
    pub opened: Opened,
    /// What shows the window.
    pub gpu: Gpu,
    /// Files that are asked for, or about to be written.
    pub files: Files,
    /// The timeline under the panes.
    pub timeline: TimelineView,
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor").field("session", &self.session).field("tools", &self.tools).finish_non_exhaustive()
    }
}

impl Editor {
    /// An empty window. `context` is woken when the background has news.
    pub fn new(context: &egui::Context, recent: RecentFiles) -> Self {
        let gpu = Gpu::new(context);
        let wake = gpu.wake();
        Self {
            mesh: MeshView::new(&wake),
            plane: PlaneView::new(&wake),
            session: Session::new(Arc::clone(&wake), recent),
            selection: Selection::default(),
            pointer: Pointer::default(),
            tools: ToolState::new(&wake),
            pane_shading: PaneShading::new(&wake),
            layout: Layout::default(),
            opened: Opened::default(),
            gpu,
            files: Files::default(),
            timeline: TimelineView::default(),
        }
    }

    /// The mesh as drawn: that of the embedding on the screen, where there is one.
    pub fn mesh_scene(&self) -> Option<&Arc<MeshScene>> {
        self.plane.drawn().map(|plane| &plane.mesh).or(self.mesh.scene())
    }

    /// Whether a scene has the vertices that the session has: for a moment after another chart, or another form, has come
    /// there, it has not.
    pub(super) fn is_of_session(&self, scene: &MeshScene) -> bool {
        scene.model_revision == self.session.model_revision()
    }

    /// Lets go of all vertices where the mesh on the screen has other ones than before. Those selected come back with the mesh's
    /// scene, where it is the same mesh in another form; another chart has others.
    fn let_go_of_vertices(&mut self) {
        let Some(before) = self.opened.note_model(&self.session) else { return };
        let has_other_form = |scene: &MeshScene| {
            let now = self.session.model();
            now.is_some_and(|now| {
                Arc::ptr_eq(&scene.model.source, &now.source) && scene.model.prepared.form != now.prepared.form
            })
        };
        let scene = self.mesh.scene().filter(|scene| scene.model_revision == before && has_other_form(scene));
        self.selection.let_go(|vertex| scene?.in_file.vertex(vertex));
        self.pointer.forget_vertices();
        self.tools.end_drag();
        self.tools.set_pair(None);
    }

    /// What goes on in the background, once it has taken long enough to be worth a word.
    pub fn busy_for_long(&self) -> Option<Busy> {
        self.session.busy().filter(|_| self.gpu.is_busy_for_long())
    }

    /// Takes in what the background has finished. Call at the start of each frame.
    pub fn poll(&mut self) {
        if self.opened.view_is_due(&self.session) {
            // For copies for recovery.
            self.keep_view();
        }
        self.session.poll();
        self.let_go_of_vertices();
        self.go_on_after_saving();
        self.go_on_playing();
        self.go_on_with_morph();
        self.go_on_with_seam();
        self.take_seams_by_rule();
        self.foresee_seam();
        if self.mesh.poll(&self.session) {
            self.begin_with_mesh();
        }
        let (plane, around) = self.plane_in_surroundings();
        if let Some(scene) = plane.refresh(around) {
            let vertex_count = scene.mesh.mesh().vertex_count();
            self.selection.keep_below(vertex_count);
            self.pointer.keep_menu_below(vertex_count);
            let count = self.defect_count();
            self.selection.keep_defect_below(count);
        }
        self.tell_failures();
        self.pane_shading.refresh_picture(self.session.document());
        self.poll_shot();
        if let Some(plane) = self.plane.scene() {
            self.pane_shading.refresh_checks(plane, self.timeline.playing_since.is_some());
        }
        self.refresh_paints();
        self.gpu.note_work(self.session.busy().is_some(), Instant::now());
        let scenes_pending = self.mesh.is_making_scene()
            || self.plane.is_making_scene()
            || self.pane_shading.is_making_picture()
            || self.tools.seam.is_busy();
        if self.session.busy().is_some() || scenes_pending || self.files.dialogs.is_open() {
            self.gpu.context().request_repaint_after(Duration::from_millis(100));
        }
        if self.session.has_unsaved_work() {
            // Copies for recovery are made while nobody moves the mouse as well.
            self.gpu.context().request_repaint_after(COPY_INTERVAL);
        }
        if let Some(choice) = self.files.dialogs.poll() {
            self.take_choice(choice);
        }
    }

    /// Says what could not be drawn.
    fn tell_failures(&mut self) {
        let [mesh, plane, picture] =
            [self.mesh.take_failure(), self.plane.take_failure(), self.pane_shading.take_failure()];
        let seam = self.tools.seam.take_failure();
        let failures = [
            (MessagePlace::Mesh, "drawing", mesh),
            (MessagePlace::Embedding, "drawing", plane),
            (MessagePlace::Embedding, "drawing", picture),
            (MessagePlace::Mesh, "finding paths", seam),
        ];
        for (place, work, failure) in failures {
            if let Some(failure) = failure {
                self.session.tell_failure(place, work, &failure);
            }
        }
    }

    /// The embedding's pane, with what it is told of the rest of the window.
    fn plane_in_surroundings(&mut self) -> (&mut PlaneView, Surroundings<'_>) {
        let glide = self.timeline.playing_since.map_or(SECONDS, |_| self.pace().min(SECONDS));
        let around = Surroundings {
            session: &self.session,
            gpu: &self.gpu,
            mesh: self.mesh.scene(),
            glide: self.pane_shading.glides.then_some(glide),
            is_dragging: self.tools.dragged().is_some(),
        };
        (&mut self.plane, around)
    }

    /// Takes in where the embedding's pane lies.
    pub(super) fn lay_out_plane(&mut self, rect: egui::Rect) {
        let (plane, around) = self.plane_in_surroundings();
        plane.set_rect(rect, around);
    }

    /// Begins anew with a mesh that has just come on the screen.
    fn begin_with_mesh(&mut self) {
        self.plane.forget();
        self.pane_shading.forget_paint();
        if self.opened.note_charts(&self.session) {
            self.layout.offer_tab(Tab::Charts);
        }
        if self.opened.put_on_screen(&self.session) {
            self.selection.select([]);
            self.put_on_view();
        }
        if let Some(scene) = self.mesh.scene() {
            self.selection.come_back(|of_file| scene.in_file.copies(of_file).collect());
        }
        self.pointer.forget_vertices();
        self.selection.set_defect(None);
        self.tools.end_drag();
        self.tools.set_pair(None);
    }
}
