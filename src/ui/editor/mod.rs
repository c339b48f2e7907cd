//! The editor's state: the session, and everything about the window that is not part of the document.
//!
//! | file | what |
//! |---|---|
//! | `request.rs`, `requests.rs` | what a person asks of the window, and what it does |
//! | `purpose.rs` | files that are asked for |
//! | `scene.rs`, `scenes.rs` | what the panes draw, and the jobs that prepare it |
//! | `preview.rs` | the embedding that follows a dragged pin |
//! | `steps.rs`, `ease.rs` | moves along the timeline, and the way between two steps |
//! | `views.rs`, `framing.rs` | what the cameras look at |
//! | `project_view.rs` | how the window looks, for the project file |
//! | `selection.rs` | what is selected, and what is under the pointer |
//! | `tools.rs` | the tool in hand, and what it has begun |
//! | `look.rs` | how faces show: shading, wireframe, picture, colours |
//! | `picture.rs` | where the picture lies in the plane |
//! | `layout.rs` | what of the window is open |
//! | `opened.rs` | what the window keeps of the open document |
//! | `host.rs` | egui's context and the graphics card |
//! | `nudge.rs` | pins moved by arrow keys |
//! | `defect.rs` | one thing wrong with an embedding |

mod defect;
mod ease;
mod framing;
mod host;
mod layout;
mod look;
pub(super) mod nudge;
mod opened;
mod picture;
mod preview;
mod project_view;
pub(super) mod purpose;
mod request;
mod requests;
pub(super) mod scene;
mod scenes;
mod selection;
mod steps;
mod tools;
mod views;

pub use defect::Defect;
pub use ease::Ease;
pub use host::Host;
pub use layout::Layout;
pub use look::Look;
pub use nudge::Nudge;
pub use opened::Opened;
pub use purpose::Purpose;
pub use request::{Pane, Request, Shading, StepTarget, Tab, Tool};
pub use scene::{Element, MeshScene, Paint, PaintKey, PlaneScene};
pub use selection::{Pointer, Selection};
pub use tools::ToolState;

use eframe::egui;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use crate::session::{Busy, Job, OutputFit, RecentFiles, Session};
use crate::ui::panels::dialogs::Dialogs;
use crate::ui::panels::exports::PaneShot;
use crate::ui::panes::compare::Ghost;
use crate::ui::{HullView, TimelineView, Unsaved};
use crate::view::{OrbitCamera, PlaneCamera};
use preview::PreviewScene;

/// How often the session is asked whether a copy for recovery is due.
const COPY_INTERVAL: Duration = Duration::from_secs(5);

/// Everything the window knows.
pub struct Editor {
    /// The document and the work on it.
    pub session: Session,
    /// What is selected.
    pub selection: Selection,
    /// What is under the pointer.
    pub pointer: Pointer,
    /// The tool in hand.
    pub tools: ToolState,
    /// How faces show.
    pub look: Look,
    /// What of the window is open.
    pub layout: Layout,
    /// What the window keeps of the open document.
    pub opened: Opened,
    /// What shows the window.
    pub host: Host,
    /// Hull and pockets of the virtual boundary.
    pub hull: HullView,
    /// The way between steps.
    pub ease: Ease,
    /// Camera of the mesh's pane.
    pub orbit: Option<OrbitCamera>,
    /// Camera of the embedding's pane.
    pub plane_camera: Option<PlaneCamera>,
    /// Size of the mesh's pane, points.
    pub mesh_pane_size: DVec2,
    /// Size of the embedding's pane, points.
    pub plane_pane_size: DVec2,
    /// Where the panes of mesh and embedding lie, points; `None` where one does not show.
    pub pane_rects: [Option<egui::Rect>; 2],
    /// The question about unsaved work.
    pub unsaved: Unsaved,
    /// The timeline under the panes.
    pub timeline: TimelineView,
    /// Size of coordinates in files.
    pub fit: OutputFit,
    /// File dialogs.
    pub dialogs: Dialogs,
    /// Whether the person asked to quit.
    pub quit: bool,
    /// The mesh as given.
    pub(super) mesh_scene: Option<Arc<MeshScene>>,
    mesh_scene_job: Option<Job<(), MeshScene>>,
    pub(super) plane_scene: Option<Arc<PlaneScene>>,
    plane_scene_job: Option<(u64, Job<(), PlaneScene>)>,
    pub(super) preview: Option<PreviewScene>,
    pub(super) shot: Option<PaneShot>,
    /// The plane's camera that it was saved with, until there is an embedding to look at.
    plane_camera_wanted: Option<Vec<f64>>,
    pub(super) ghost: Option<Ghost>,
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor").field("session", &self.session).field("tools", &self.tools).finish_non_exhaustive()
    }
}

impl Editor {
    /// An empty window. `context` is woken when the background has news.
    pub fn new(context: &egui::Context, recent: RecentFiles) -> Self {
        let waker = context.clone();
        Self {
            session: Session::new(Arc::new(move || waker.request_repaint()), recent),
            selection: Selection::default(),
            pointer: Pointer::default(),
            tools: ToolState::default(),
            look: Look::default(),
            layout: Layout::default(),
            opened: Opened::default(),
            host: Host::new(context),
            hull: HullView::default(),
            ease: Ease::default(),
            orbit: None,
            plane_camera: None,
            mesh_pane_size: DVec2::new(400.0, 400.0),
            plane_pane_size: DVec2::new(400.0, 400.0),
            pane_rects: [None; 2],
            unsaved: Unsaved::default(),
            timeline: TimelineView::default(),
            fit: OutputFit::default(),
            dialogs: Dialogs::default(),
            quit: false,
            mesh_scene: None,
            mesh_scene_job: None,
            plane_scene: None,
            plane_scene_job: None,
            preview: None,
            shot: None,
            plane_camera_wanted: None,
            ghost: None,
        }
    }

    /// The mesh as drawn: that of the embedding on the screen, where there is one.
    pub fn mesh_scene(&self) -> Option<&Arc<MeshScene>> {
        self.drawn_plane().map(|plane| &plane.mesh).or(self.mesh_scene.as_ref())
    }

    /// The embedding as drawn.
    pub fn plane_scene(&self) -> Option<&Arc<PlaneScene>> {
        self.plane_scene.as_ref()
    }

    /// What goes on in the background, once it has taken long enough to be worth a word.
    pub fn busy_for_long(&self) -> Option<Busy> {
        self.session.busy().filter(|_| self.host.is_busy_for_long())
    }

    /// Everything that is wrong with the embedding on the screen: flipped faces, crossings, overwound vertices.
    pub fn defects(&self) -> Vec<Defect> {
        let Some(outcome) = self.session.outcome() else { return Vec::new() };
        let verdict = &outcome.step.verdict;
        let flipped = verdict.flipped_faces.iter().map(|&face| Defect::Flipped(face));
        let crossings = verdict.boundary_crossings.iter().map(|&edges| Defect::Crossing(edges));
        let overwound = verdict.overwound_vertices.iter().map(|&vertex| Defect::Overwound(vertex));
        flipped.chain(crossings).chain(overwound).collect()
    }

    /// Takes in what the background has finished. Call at the start of each frame.
    pub fn poll(&mut self) {
        self.refresh_view();
        self.session.poll();
        self.go_on_after_saving();
        self.go_on_playing();
        self.poll_mesh_scene();
        self.poll_plane_scene();
        self.look.refresh_picture(self.session.document());
        self.refresh_preview();
        self.poll_shot();
        self.go_on_easing();
        self.poll_hull_scene();
        self.refresh_ghost();
        self.refresh_paint();
        self.host.note_work(self.session.busy().is_some(), Instant::now());
        let scenes_pending = self.mesh_scene_job.is_some() || self.plane_scene_job.is_some() || self.is_making_hull();
        if self.session.busy().is_some() || scenes_pending || self.dialogs.is_open() {
            self.host.context().request_repaint_after(Duration::from_millis(100));
        }
        if self.session.has_unsaved_work() {
            // Copies for recovery are made while nobody moves the mouse as well.
            self.host.context().request_repaint_after(COPY_INTERVAL);
        }
        if let Some(choice) = self.dialogs.poll() {
            self.take_choice(choice);
        }
    }

    /// How many selected vertices are pins of the user's.
    pub fn selected_pins(&self) -> usize {
        self.pins_selected().count()
    }

    /// How many defects are listed.
    pub fn defect_count(&self) -> usize {
        self.session.outcome().map_or(0, |outcome| {
            let verdict = &outcome.step.verdict;
            verdict.flipped_faces.len() + verdict.boundary_crossings.len() + verdict.overwound_vertices.len()
        })
    }

    /// Whether there is a defect to go to.
    pub fn has_defects(&self) -> bool {
        self.defect_count() > 0
    }
}
