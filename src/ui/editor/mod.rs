//! State of the editor: the session, and all state of the window outside the document.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the editor: its parts, and its work in each frame |
//! | `requests.rs` | handling of requests; moves along the timeline |
//! | `files.rs`, `unsaved.rs` | file dialogs; the question about unsaved work |
//! | `comparison/` | methods side by side in the embedding pane |
//! | `mesh_view.rs` | the mesh pane: place, camera, scene |
//! | `page/` | all charts on the page: place, camera, drawn data, selection |
//! | `plane/` | the embedding pane: place, camera, drawn data |
//! | `scene.rs` | data for drawing and picking in both panes |
//! | `paint.rs` | faces coloured by a shading |
//! | `in_file.rs` | map from vertices on the screen to vertices of the file |
//! | `seam_rules.rs` | seams at sharp edges, or at borders of materials or groups |
//! | `sides.rs` | side of a seam that a vertex is on |
//! | `seam_chain.rs` | the clicks that draw a seam, and their undo |
//! | `seam_intent.rs` | effect of a click of the seam tool |
//! | `seam_hover.rs` | the seam under the pointer |
//! | `seam_actions.rs` | handling of requests to the seam tool |
//! | `seam_tool.rs` | the seam being drawn, and shortest paths from its last vertex |
//! | `element.rs`, `numbers.rs` | elements of the mesh by name; names of elements, with the numbers of files |
//! | `drawn_elements.rs` | selected elements with their edges for drawing |
//! | `elements.rs` | selection of vertices, edges and faces, on one chart and on the page |
//! | `around.rs` | the charts around the chart on the screen |
//! | `async_scene.rs` | background construction of scenes |
//! | `selection.rs` | selection, element under the pointer, active tool |
//! | `appearance.rs`, `shade.rs` | appearance of faces: shading of each pane, wireframe, picture, colours |
//! | `layout.rs` | layout of the window |
//! | `preferences.rs` | settings of the window kept between runs |
//! | `opened.rs` | state of the window for the open document |
//! | `project_view.rs` | cameras, shadings, tool and selection in the project file |
//! | `step_curve.rs`, `step_files.rs` | the numbers of the steps that have curves; files with curves and steps |
//! | `checker.rs`, `checker_actions.rs` | the checker over the plane |
//! | `colour_table.rs`, `table_actions.rs` | the table of numbers that colours the faces |
//! | `command_line.rs` | the document as a command line, on the clipboard |
//! | `gpu.rs` | egui's context and the graphics card |
//! | `frames.rs` | duration of frames |
//! | `views.rs` | framing of the selection, elements and defects |
//! | `defect.rs` | defects of an embedding |
//! | `picture_box.rs` | the place of the picture in the plane |

pub(super) mod appearance;
mod around;
mod async_scene;
mod checker;
mod checker_actions;
mod colour_table;
mod command_line;
pub(super) mod comparison;
mod defect;
mod drawn_elements;
mod element;
mod elements;
mod file_elements;
mod files;
mod frames;
mod gpu;
mod in_file;
pub(super) mod layout;
mod mesh_view;
mod numbers;
mod opened;
mod page;
pub(super) mod paint;
pub(super) mod picture_box;
mod plane;
mod preferences;
mod project_view;
mod requests;
pub(super) mod scene;
mod seam_actions;
mod seam_chain;
mod seam_hover;
pub(super) mod seam_intent;
pub(super) mod seam_rules;
pub(super) mod seam_tool;
mod select_by;
mod selection;
mod shade;
mod sides;
pub(super) mod step_curve;
mod step_files;
mod table_actions;
mod unsaved;
mod views;

pub use comparison::MorphView;
pub use defect::Defect;
pub(super) use element::Element;
pub(super) use page::PageScene;
pub(super) use plane::HullScene;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;

use crate::session::{Busy, MessagePlace, RecentFiles, Session};
use crate::ui::state::{Tab, TimelineView};
use appearance::PaneShading;
use file_elements::NumberedChart;
pub(in crate::ui) use files::BakeChoice;
use files::Files;
use freebound_core::mesh::VertexId;
use gpu::Gpu;
use layout::Layout;
use mesh_view::MeshView;
use opened::Opened;
use plane::{PlaneView, SECONDS, Surroundings};
use scene::MeshScene;
pub(in crate::ui) use selection::RegionShape;
use selection::{Pointer, Selection, ToolState};

/// Interval at which the session checks if a recovery copy is due.
const COPY_INTERVAL: Duration = Duration::from_secs(5);

/// Complete state of the window.
pub struct Editor {
    /// The document and the work on it.
    pub session: Session,
    /// Mesh pane.
    pub mesh: MeshView,
    /// Embedding pane.
    pub plane: PlaneView,
    /// Selected vertices and defect.
    pub selection: Selection,
    /// Element under the pointer.
    pub pointer: Pointer,
    /// Active tool and its state.
    pub tools: ToolState,
    /// Appearance of faces.
    pub pane_shading: PaneShading,
    /// Layout of the window.
    pub layout: Layout,
    /// State of the window for the open document.
    pub opened: Opened,
    /// egui's context and the graphics card.
    pub gpu: Gpu,
    /// File dialogs and files about to be written.
    pub files: Files,
    /// Timeline under the panes.
    pub timeline: TimelineView,
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor").field("session", &self.session).field("tools", &self.tools).finish_non_exhaustive()
    }
}

impl Editor {
    /// Creates an empty window. Background work with news wakes `context`.
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

    /// Mesh on the screen: the mesh of the drawn embedding, or the mesh as given.
    pub fn mesh_scene(&self) -> Option<&Arc<MeshScene>> {
        self.plane.drawn().map(|plane| &plane.mesh).or(self.mesh.scene())
    }

    /// True if a scene has the vertices of the session's mesh. Just after a change of chart or preparation it has
    /// not.
    pub(super) fn is_of_session(&self, scene: &MeshScene) -> bool {
        scene.model_revision == self.session.model_revision()
    }

    /// Clears all vertices of the window's state if the mesh on the screen has changed. If the new mesh is another
    /// preparation of the same file, the selection returns with its scene; another chart has other vertices.
    fn let_go_of_vertices(&mut self) {
        let Some(before) = self.opened.note_model(&self.session) else { return };
        let has_other_form = |scene: &MeshScene| {
            let now = self.session.model();
            now.is_some_and(|now| {
                Arc::ptr_eq(&scene.model.source, &now.source) && scene.model.prepared.form != now.prepared.form
            })
        };
        let drawn = self.plane.drawn().map(|plane| &plane.mesh).filter(|scene| self.selection.are_of(scene));
        let scene = drawn.into_iter().chain(self.mesh.scene());
        // Without a scene, the mesh was never on the screen, and the selection is of the one before it.
        if let Some(scene) = scene.map(Arc::clone).find(|scene| scene.model_revision == before) {
            if has_other_form(&scene) {
                self.selection.keep_of_file(&NumberedChart { scene: &scene, awaited: &BTreeSet::new() });
            } else {
                self.selection.forget_of_file();
            }
        }
        self.selection.let_go();
        self.pointer.forget_vertices();
        self.tools.end_drag();
        self.tools.set_pair(None);
    }

    /// Restores the selection on the mesh that has just appeared. Returns true if the selection is to be framed. If
    /// certain vertices were awaited, other copies of their vertices of the file are not selected.
    fn take_selection_back(&mut self) -> bool {
        let awaited: BTreeSet<VertexId> = self.opened.take_awaited().into_iter().collect();
        let Some(scene) = self.mesh.scene() else { return false };
        self.selection.come_back(&NumberedChart { scene, awaited: &awaited })
    }

    /// Background work, if it has run long enough to show.
    pub fn busy_for_long(&self) -> Option<Busy> {
        self.session.busy().filter(|_| self.gpu.is_busy_for_long())
    }

    /// Adopts finished background work. Call at the start of each frame.
    pub fn poll(&mut self) {
        if self.opened.view_is_due(&self.session) {
            // Recovery copies contain the view.
            self.keep_view();
        }
        self.session.poll();
        self.check_gesture();
        self.let_go_of_vertices();
        self.go_on_after_saving();
        self.go_on_playing();
        self.go_on_with_morph();
        self.go_on_with_seam();
        self.take_seams_by_rule();
        self.foresee_seam();
        let scene = self.plane.drawn().map(|plane| &plane.mesh).or(self.mesh.scene()).map(Arc::clone);
        let scene = scene.filter(|scene| self.is_of_session(scene));
        self.tools.seam_hover.refresh(scene.as_ref(), self.pointer.vertex());
        if self.mesh.poll(&self.session) {
            self.begin_with_mesh();
        }
        let (plane, around) = self.plane_in_surroundings();
        if let Some(scene) = plane.refresh(around) {
            let vertex_count = scene.mesh.mesh().vertex_count();
            self.selection.keep_on(&scene.mesh);
            self.pointer.keep_menu_below(vertex_count);
            let count = self.defect_count();
            self.selection.keep_defect_below(count);
            if self.selection.is_map_due() {
                self.frame();
            }
        }
        self.plane.page.refresh(&self.session, self.mesh.scene());
        self.keep_selection_kind();
        self.refresh_selection_lines();
        self.tell_failures();
        self.pane_shading.refresh_picture(self.session.document());
        self.poll_shot();
        self.poll_table();
        self.refresh_checker();
        if let Some(plane) = self.plane.scene() {
            self.pane_shading.checker.refresh_size(plane, self.timeline.playing_since.is_some());
        }
        self.refresh_paints();
        self.gpu.note_work(self.session.busy().is_some(), Instant::now());
        let scenes_pending = self.mesh.is_making_scene()
            || self.plane.is_making_scene()
            || self.plane.page.is_making()
            || self.session.is_judging_move()
            || self.pane_shading.is_making_picture()
            || self.pane_shading.checker.is_making()
            || self.tools.seam.is_busy();
        if self.session.busy().is_some() || scenes_pending || self.files.dialogs.is_open() {
            self.gpu.context().request_repaint_after(Duration::from_millis(100));
        }
        if self.session.has_unsaved_work() {
            // Make recovery copies even if the mouse does not move.
            self.gpu.context().request_repaint_after(COPY_INTERVAL);
        }
        if let Some(choice) = self.files.dialogs.poll() {
            self.take_choice(choice);
        }
    }

    /// Reports failed background jobs.
    fn tell_failures(&mut self) {
        let [mesh, plane, picture] =
            [self.mesh.take_failure(), self.plane.take_failure(), self.pane_shading.take_failure()];
        let plane = plane.or_else(|| self.plane.page.take_failure());
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

    /// Embedding pane, with the inputs that it needs from the rest of the window.
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

    /// Sets the place of the embedding pane.
    pub(super) fn lay_out_plane(&mut self, rect: egui::Rect) {
        let (plane, around) = self.plane_in_surroundings();
        plane.set_rect(rect, around);
    }

    /// Resets the window for a mesh that has just appeared on the screen.
    fn begin_with_mesh(&mut self) {
        self.plane.forget();
        self.pane_shading.forget_paint();
        if self.opened.note_charts(&self.session) {
            self.layout.offer_tab(Tab::Charts);
        }
        if self.opened.put_on_screen(&self.session) {
            self.selection.select([]);
            self.plane.page.forget();
            self.forget_table();
            self.put_on_view();
        }
        if self.take_selection_back() {
            self.frame();
        }
        self.pointer.forget_vertices();
        self.selection.set_defect(None);
        self.tools.end_drag();
        self.tools.set_pair(None);
    }
}
