//! The editor's state: the session, and everything about the window that is not part of the document.

use eframe::egui;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::compare::Ghost;
use super::dialogs::{Choice, Dialogs, Purpose, kind_of};
use super::framing::{grown, grown_box, positions_of};
use super::pane::PinOwner;
use super::scene::{MeshScene, Paint, PlaneScene, vertices_of};
use super::{Defect, Ease, HullView, Pane, Request, Shading, Tab, TimelineView, Tool};
use crate::mesh::VertexId;
use crate::session::{Action, Busy, Job, OutputFit, RecentFiles, SaveRequest, Session};
use crate::view::{OrbitCamera, PlaneCamera};

/// A solve shorter than this shows no progress: it would only flicker.
const PATIENCE: Duration = Duration::from_millis(250);

/// Everything the window knows.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own in the window")]
pub struct Editor {
    /// The document and the work on it.
    pub session: Session,
    /// The tool in hand.
    pub tool: Tool,
    /// How faces are coloured.
    pub shading: Shading,
    /// Whether the wireframe shows.
    pub wireframe: bool,
    /// The tab that is open.
    pub tab: Tab,
    /// Whether the panels at the right show; where nobody said, a narrow window does without.
    pub panels_wanted: Option<bool>,
    /// Whether the window is wide enough for the panels.
    pub window_is_wide: bool,
    /// The pane in full size, if one is.
    pub full: Option<Pane>,
    /// Share of the width that the mesh's pane has.
    pub split: f32,
    /// Hull and pockets of the virtual boundary.
    pub hull: HullView,
    /// The way between steps.
    pub ease: Ease,
    /// Whether an inset magnifies a defect.
    pub magnifier: bool,
    /// Selected vertices.
    pub selection: BTreeSet<VertexId>,
    /// The vertex under the pointer, in whichever pane.
    pub hovered: Option<VertexId>,
    /// The pane under the pointer.
    pub pane_under_pointer: Option<Pane>,
    /// The pointer in the plane of the embedding.
    pub pointer_in_embedding: Option<DVec2>,
    /// The pin being dragged.
    pub dragged_pin: Option<VertexId>,
    /// From where the pointer grabbed it to its middle, points.
    pub grab_offset: egui::Vec2,
    /// The box being drawn with Ctrl, from its first corner, in window points.
    pub selection_box: Option<(Pane, egui::Pos2)>,
    /// Camera of the mesh's pane.
    pub orbit: Option<OrbitCamera>,
    /// Camera of the embedding's pane.
    pub plane_camera: Option<PlaneCamera>,
    /// Size of the mesh's pane, points.
    pub mesh_pane_size: DVec2,
    /// Size of the embedding's pane, points.
    pub plane_pane_size: DVec2,
    /// The defect shown last, by place in [`Editor::defects`].
    pub defect: Option<usize>,
    /// Whether the list of keys shows.
    pub keys_shown: bool,
    /// What is typed into "go to", where it shows.
    pub go_to: Option<String>,
    /// The timeline under the panes.
    pub timeline: TimelineView,
    /// Size of coordinates in files.
    pub fit: OutputFit,
    /// Whether there is a graphics card to draw with.
    pub has_gpu: bool,
    /// File dialogs.
    pub dialogs: Dialogs,
    /// Whether the person asked to quit.
    pub quit: bool,
    /// The theme to put on, where it was asked for in this frame.
    pub theme_wanted: Option<egui::ThemePreference>,
    pub(super) context: egui::Context,
    pub(super) mesh_scene: Option<Arc<MeshScene>>,
    pub(super) mesh_scene_job: Option<Job<(), MeshScene>>,
    pub(super) plane_scene: Option<Arc<PlaneScene>>,
    pub(super) plane_scene_job: Option<(u64, Job<(), PlaneScene>)>,
    pub(super) paint: Option<Paint>,
    pub(super) ghost: Option<Ghost>,
    pub(super) busy_since: Option<Instant>,
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor").field("session", &self.session).field("tool", &self.tool).finish_non_exhaustive()
    }
}

impl Editor {
    /// An empty window. `context` is woken when the background has news.
    pub fn new(context: &egui::Context, recent: RecentFiles) -> Self {
        let waker = context.clone();
        Self {
            session: Session::new(Arc::new(move || waker.request_repaint()), recent),
            tool: Tool::default(),
            shading: Shading::default(),
            wireframe: false,
            tab: Tab::default(),
            panels_wanted: None,
            window_is_wide: true,
            full: None,
            split: 0.5,
            hull: HullView::default(),
            ease: Ease::default(),
            magnifier: true,
            selection: BTreeSet::new(),
            hovered: None,
            pane_under_pointer: None,
            pointer_in_embedding: None,
            dragged_pin: None,
            grab_offset: egui::Vec2::ZERO,
            selection_box: None,
            orbit: None,
            plane_camera: None,
            mesh_pane_size: DVec2::new(400.0, 400.0),
            plane_pane_size: DVec2::new(400.0, 400.0),
            defect: None,
            keys_shown: false,
            go_to: None,
            timeline: TimelineView::default(),
            fit: OutputFit::default(),
            has_gpu: false,
            dialogs: Dialogs::default(),
            quit: false,
            theme_wanted: None,
            context: context.clone(),
            mesh_scene: None,
            mesh_scene_job: None,
            plane_scene: None,
            plane_scene_job: None,
            paint: None,
            ghost: None,
            busy_since: None,
        }
    }

    /// The mesh as drawn.
    pub fn mesh_scene(&self) -> Option<&Arc<MeshScene>> {
        self.mesh_scene.as_ref()
    }

    /// The embedding as drawn.
    pub fn plane_scene(&self) -> Option<&Arc<PlaneScene>> {
        self.plane_scene.as_ref()
    }

    /// The faces' colours.
    pub fn paint(&self) -> Option<&Paint> {
        self.paint.as_ref()
    }

    /// What goes on in the background, once it has taken long enough to be worth a word.
    pub fn busy_for_long(&self) -> Option<Busy> {
        self.session.busy().filter(|_| self.busy_since.is_some_and(|since| since.elapsed() >= PATIENCE))
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
        self.session.poll();
        self.go_on_playing();
        self.poll_mesh_scene();
        self.poll_plane_scene();
        self.go_on_easing();
        self.poll_hull_scene();
        self.refresh_ghost();
        self.refresh_paint();
        match (self.session.busy(), self.busy_since) {
            (Some(_), None) => self.busy_since = Some(Instant::now()),
            (None, Some(_)) => self.busy_since = None,
            _ => {}
        }
        let scenes_pending = self.mesh_scene_job.is_some() || self.plane_scene_job.is_some() || self.is_making_hull();
        if self.session.busy().is_some() || scenes_pending || self.dialogs.is_open() {
            self.context.request_repaint_after(Duration::from_millis(100));
        }
        if let Some(choice) = self.dialogs.poll() {
            self.take_choice(choice);
        }
    }

    /// Carries out a request.
    pub fn handle(&mut self, request: Request) {
        match request {
            Request::Do(action) => self.act(action),
            Request::RunOrPause => self.run_or_pause(),
            Request::GoToStep(target) => self.go_to_step(target),
            Request::TogglePlay => self.toggle_play(),
            Request::ToggleCurves => self.timeline.curves_wanted = Some(!self.timeline.curves_shown()),
            Request::SetTool(tool) => self.tool = tool,
            Request::SetShading(shading) => self.shading = shading,
            Request::ToggleWireframe => self.wireframe = !self.wireframe,
            Request::ToggleEase => self.ease.wanted = !self.ease.wanted,
            Request::ToggleMagnifier => self.magnifier = !self.magnifier,
            Request::ToggleHull => self.toggle_hull(),
            Request::SetStage(stage) => self.hull.stage = stage,
            Request::ShowTab(tab) => (self.tab, self.panels_wanted) = (tab, Some(true)),
            Request::TogglePanels => self.panels_wanted = Some(!self.panels_shown()),
            Request::Frame => self.frame(),
            Request::GoTo(vertices) => self.go_to_vertices(vertices),
            Request::GoToDefect(place) => self.go_to_defect(place),
            Request::StepDefect(by) => self.step_defect(by),
            Request::Select(vertices) => self.selection = vertices.into_iter().collect(),
            Request::AddToSelection(vertices) => self.selection.extend(vertices),
            Request::UnpinSelected => self.act(Action::Unpin(self.selection.iter().copied().collect())),
            Request::Escape => self.escape(),
            Request::ToggleFull(pane) => self.full = if self.full.is_some() { None } else { Some(pane) },
            Request::TogglePane => {
                let pane = self.pane_under_pointer.unwrap_or(Pane::Plane);
                self.handle(Request::ToggleFull(pane));
            }
            Request::AskOpen => self.dialogs.ask(&self.context, Purpose::Open, self.suggested_name("obj")),
            Request::AskSave => self.dialogs.ask(&self.context, Purpose::Save, self.suggested_name("obj")),
            Request::AskExport => self.dialogs.ask(&self.context, Purpose::Export, self.suggested_name("svg")),
            Request::AskGoTo => self.go_to = Some(String::new()),
            Request::ToggleKeys => self.keys_shown = !self.keys_shown,
            Request::SetTheme(theme) => self.theme_wanted = Some(theme),
            Request::SetFit(fit) => self.fit = fit,
            Request::Quit => self.quit = true,
        }
    }

    /// Opens, saves or exports as a dialog was answered.
    pub fn take_choice(&mut self, choice: Choice) {
        if choice.purpose == Purpose::Open {
            return self.act(Action::Open(choice.path));
        }
        match kind_of(&choice) {
            Some(kind) => self.act(Action::Save(SaveRequest { path: choice.path, kind, fit: self.fit })),
            None => self.act(Action::RefuseName(choice.path)),
        }
    }

    /// The pins as drawn: the user's, then the gauge pins that the solver chose.
    pub fn pins_shown(&self) -> impl Iterator<Item = (VertexId, DVec2, PinOwner)> {
        let document = self.session.document();
        let users = if document.settings.method.uses_pins() { document.plane_pins() } else { BTreeMap::new() };
        let gauge = self.plane_scene.as_ref().filter(|scene| {
            scene.outcome.step.solution.gauge_completed && scene.outcome.settings.method.uses_pins() && users.len() < 2
        });
        let gauge = gauge.map(|scene| scene.outcome.step.solution.pins.clone()).unwrap_or_default();
        let own = users.clone();
        let solver = gauge.into_iter().filter(move |(vertex, _)| !own.contains_key(vertex));
        let users = users.into_iter().map(|(vertex, pin)| (vertex, pin.target, PinOwner::User));
        users.chain(solver.map(|(vertex, pin)| (vertex, pin.target, PinOwner::Solver)))
    }

    /// Whether the panels at the right show.
    pub fn panels_shown(&self) -> bool {
        self.panels_wanted.unwrap_or(self.window_is_wide)
    }

    /// Whether the mesh's pane does not show.
    pub fn mesh_hidden(&self) -> bool {
        self.full == Some(Pane::Plane)
    }

    /// How many selected vertices are pins of the user's.
    pub fn selected_pins(&self) -> usize {
        let pins = &self.session.document().pins;
        self.selection.iter().filter(|vertex| pins.contains_key(vertex)).count()
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

    fn act(&mut self, action: Action) {
        if matches!(action, Action::Step | Action::Run | Action::ShowStep(_)) {
            self.timeline.playing_since = None;
        }
        self.session.handle(action);
    }

    /// A name for a file made from the mesh on the screen.
    fn suggested_name(&self, extension: &str) -> PathBuf {
        let Some(model) = self.session.model() else { return PathBuf::from(format!("layout.{extension}")) };
        let stem = std::path::Path::new(&model.name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = model.path.as_ref().and_then(|path| path.parent()).map(PathBuf::from).unwrap_or_default();
        folder.join(format!("{stem}-flat.{extension}"))
    }

    fn frame(&mut self) {
        let (Some(scene), Some(orbit)) = (&self.mesh_scene, &mut self.orbit) else { return };
        let positions = &scene.model.mesh().positions;
        let selected: Vec<VertexId> = self.selection.iter().copied().collect();
        let ball =
            if selected.is_empty() { scene.sphere } else { grown(&positions_of(positions, &selected), scene.sphere) };
        orbit.frame(ball, self.mesh_pane_size);
        let (Some(plane), Some(camera)) = (self.drawn_plane().cloned(), &mut self.plane_camera) else { return };
        let bounds = plane.arrays.bounds();
        let wanted = if selected.is_empty() { bounds } else { grown_box(plane.positions(), &selected, bounds) };
        camera.frame(wanted, self.plane_pane_size);
        if let Some(camera) = self.plane_camera.filter(|_| selected.is_empty() && !plane.is_stage()) {
            self.set_framed(camera);
        }
    }

    fn go_to_vertices(&mut self, vertices: Vec<VertexId>) {
        if !vertices.is_empty() {
            self.selection = vertices.into_iter().collect();
            self.frame();
        }
    }

    fn step_defect(&mut self, by: isize) {
        let defects = self.defects();
        if defects.is_empty() {
            return;
        }
        let count = defects.len().cast_signed();
        let next = match self.defect {
            Some(at) => (at.cast_signed() + by).rem_euclid(count),
            None if by < 0 => count - 1,
            None => 0,
        };
        self.defect = Some(next.cast_unsigned());
        self.go_to_defect(next.cast_unsigned());
    }

    fn go_to_defect(&mut self, place: usize) {
        self.defect = Some(place);
        let (Some(scene), Some(defect)) = (self.mesh_scene.clone(), self.defects().get(place).copied()) else { return };
        let vertices = defect.elements().into_iter().flatten().flat_map(|element| vertices_of(&scene.model, element));
        self.go_to_vertices(vertices.collect());
    }

    fn escape(&mut self) {
        if self.dialogs.close() {
        } else if self.keys_shown {
            self.keys_shown = false;
        } else if self.go_to.is_some() {
            self.go_to = None;
        } else if self.dragged_pin.take().is_some() {
            self.act(Action::GiveUpGesture);
        } else if self.selection_box.take().is_some() {
        } else if self.tool != Tool::Select {
            self.tool = Tool::Select;
        } else {
            self.selection.clear();
        }
    }
}
