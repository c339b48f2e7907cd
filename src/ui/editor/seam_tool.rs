//! The seam that is being drawn. It stands on the file's own vertices, which stay what they are while each click cuts the mesh
//! anew; so does the chain of clicks.
//!
//! ```text
//! mesh of the file ── background, once ──▶ SeamGround ── background, once per click ──▶ PathTree ── each frame ──▶ path
//! ```
//!
//! One function says what a click would do; the preview, the words in the status bar and the click itself all ask it.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::Tool;
use super::making::Making;
use super::seam_rules::SeamRules;
use crate::io::MeshFile;
use crate::mesh::{EdgePaths, PathTree, Repairs, Seams, VertexId};
use crate::session::{Action, Failure, Model, Session, Wake};
use crate::ui::Editor;
use crate::view::{OrbitCamera, SurfacePicker, Visibility};

/// Share of creases in the measure of paths at the start.
pub(in crate::ui) const CREASES: f64 = 0.5;

/// An edge by its ends, vertices of the file.
pub(in crate::ui) type Edge = [VertexId; 2];

/// The mesh of the file as one: whole, whatever it is cut into.
#[derive(Debug)]
pub(in crate::ui) struct SeamGround {
    source: Arc<MeshFile>,
    /// World units in one of the file's.
    scale: f64,
    picker: SurfacePicker,
    paths: Arc<EdgePaths>,
}

/// What a ground is of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GroundKey {
    /// What is open, by the session's count.
    opening: u64,
    repair: Repairs,
    scale: f64,
}

/// What a tree of paths is of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TreeKey {
    ground: GroundKey,
    from: VertexId,
    creases: f64,
}

/// A click on a vertex of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeamClick {
    /// The vertex.
    pub vertex: VertexId,
    /// Whether seams go.
    pub erases: bool,
}

/// What a click would do.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) enum SeamIntent {
    /// Begin a seam.
    Begin,
    /// Cut along these edges, from where the seam has got to.
    Add(Vec<Edge>),
    /// Close these edges.
    TakeAway(Vec<Edge>),
    /// End the seam.
    End,
    /// Nothing: no seam is there, or no edges lead there.
    Nothing,
    /// What the paths are is still being found.
    Wait,
}

pub struct SeamTool {
    /// Seams by a rule.
    pub(in crate::ui) rules: SeamRules,
    /// Share of creases in the measure of paths, 0 to 1.
    creases: f64,
    /// Whether clicks take seams away.
    erases: bool,
    /// Where the seam has got to.
    last: Option<VertexId>,
    /// The seams before each click of the chain, and where it had got to.
    trail: Vec<(Seams, VertexId)>,
    /// Clicks that wait for the paths to be found.
    clicks: VecDeque<SeamClick>,
    /// The vertex of the file under the pointer.
    under: Option<VertexId>,
    ground: Option<(GroundKey, Arc<SeamGround>)>,
    ground_job: Making<GroundKey, SeamGround>,
    tree: Option<(TreeKey, PathTree)>,
    tree_job: Making<TreeKey, PathTree>,
}

/// Without what was found: that is as large as the mesh.
impl fmt::Debug for SeamTool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("SeamTool");
        state.field("last", &self.last).field("clicks", &self.clicks).field("is_busy", &self.is_busy());
        state.finish_non_exhaustive()
    }
}

impl SeamGround {
    fn new(source: Arc<MeshFile>, key: GroundKey) -> Self {
        let mesh = source.polygons.triangulate();
        let positions: Vec<DVec3> = mesh.positions.iter().map(|&at| at * key.scale).collect();
        Self {
            picker: SurfacePicker::new(&positions, &mesh.triangles),
            paths: Arc::new(EdgePaths::new(&source.polygons, key.repair)),
            scale: key.scale,
            source,
        }
    }

    /// Where a vertex of the file lies in the world.
    pub(in crate::ui) fn place(&self, vertex: VertexId) -> Option<DVec3> {
        Some(*self.source.polygons.positions.get(vertex.index())? * self.scale)
    }

    /// Whether the mesh does not hide a vertex.
    pub(in crate::ui) fn shows(&self, vertex: VertexId, camera: &OrbitCamera) -> bool {
        self.picker.is_visible(vertex, camera.eye())
    }

    /// The vertex of the file nearest to the pointer, among those that show.
    pub(in crate::ui) fn vertex_at(&self, camera: &OrbitCamera, size: DVec2, pointer: DVec2) -> Option<VertexId> {
        self.picker.nearest_vertex(camera, size, pointer, Visibility::Visible).map(|pick| pick.vertex)
    }
}

impl SeamTool {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            rules: SeamRules::new(wake),
            creases: CREASES,
            erases: false,
            last: None,
            trail: Vec::new(),
            clicks: VecDeque::new(),
            under: None,
            ground: None,
            ground_job: Making::new("seam ground", wake),
            tree: None,
            tree_job: Making::new("seam paths", wake),
        }
    }

    pub fn creases(&self) -> f64 {
        self.creases
    }

    pub(super) fn set_creases(&mut self, share: f64) {
        self.creases = share.clamp(0.0, 1.0);
    }

    pub fn erases(&self) -> bool {
        self.erases
    }

    pub(super) fn toggle_erases(&mut self) {
        self.erases = !self.erases;
    }

    /// The vertex of the file that the seam has got to.
    pub fn last(&self) -> Option<VertexId> {
        self.last
    }

    pub(in crate::ui) fn under(&self) -> Option<VertexId> {
        self.under
    }

    pub(in crate::ui) fn set_under(&mut self, vertex: Option<VertexId>) {
        self.under = vertex;
    }

    pub(in crate::ui) fn ground(&self) -> Option<&Arc<SeamGround>> {
        self.ground.as_ref().map(|(_, ground)| ground)
    }

    /// Whether paths are being found, or clicks wait for them.
    pub fn is_busy(&self) -> bool {
        self.rules.is_busy() || self.ground_job.is_busy() || self.tree_job.is_busy() || !self.clicks.is_empty()
    }

    /// Ends the seam that is being drawn. Returns whether there was one.
    pub(super) fn end(&mut self) -> bool {
        self.trail.clear();
        self.clicks.clear();
        self.tree_job.cancel();
        self.last.take().is_some()
    }

    /// Ends the seam, and lets go of what was found for it.
    pub(super) fn put_away(&mut self) {
        self.end();
        self.ground_job.cancel();
        (self.ground, self.tree) = (None, None);
    }

    pub(super) fn take_failure(&mut self) -> Option<Failure> {
        let failure = self.ground_job.take_failure().or(self.tree_job.take_failure()).or(self.rules.take_failure());
        if failure.is_some() {
            self.clicks.clear();
        }
        failure
    }

    /// What a click would do now.
    pub(in crate::ui) fn intent(&self, click: SeamClick, seams: &Seams) -> SeamIntent {
        let vertex = click.vertex;
        let taken = |edges: Vec<Edge>| match edges.is_empty() {
            true => SeamIntent::Nothing,
            false => SeamIntent::TakeAway(edges),
        };
        match self.last {
            None if click.erases => taken(seams.stretches_through(vertex)),
            None => SeamIntent::Begin,
            Some(last) if last == vertex => SeamIntent::End,
            Some(last) if click.erases => taken(seams.way(last, vertex).unwrap_or_default()),
            Some(last) => match &self.tree {
                Some((key, tree)) if key.from == last && key.creases == self.creases => {
                    tree.path_to(vertex).map_or(SeamIntent::Nothing, SeamIntent::Add)
                }
                _ => SeamIntent::Wait,
            },
        }
    }

    /// Takes in what was found, and has found what is missing.
    fn refresh(&mut self, session: &Session) {
        let Some(model) = session.model() else { return self.put_away() };
        let key = GroundKey::of(session, model);
        if self.ground.as_ref().is_some_and(|(of, _)| of.opening != key.opening) {
            self.end();
            (self.ground, self.tree) = (None, None);
        }
        if let Some((of, ground)) = self.ground_job.poll().filter(|(of, _)| *of == key) {
            self.ground = Some((of, Arc::new(ground)));
        }
        let Some((of, ground)) = self.ground.as_ref().filter(|(of, _)| *of == key) else {
            let source = Arc::clone(&model.source);
            return self.ground_job.make(key, move |_| SeamGround::new(source, key));
        };
        let Some(from) = self.last else { return };
        let key = TreeKey { ground: *of, from, creases: self.creases };
        if let Some(found) = self.tree_job.poll().filter(|(of, _)| *of == key) {
            self.tree = Some(found);
        }
        if self.tree.as_ref().is_none_or(|(of, _)| *of != key) {
            let paths = Arc::clone(&ground.paths);
            self.tree_job.make(key, move |_| PathTree::new(&paths, key.from, key.creases));
        }
    }

    /// Goes back along the chain where its clicks were undone.
    fn follow_undo(&mut self, seams: &Seams) {
        while let Some((_, from)) = self.trail.pop_if(|(before, _)| before == seams) {
            self.last = Some(from);
        }
    }
}

impl GroundKey {
    fn of(session: &Session, model: &Model) -> Self {
        let scale = model.disk().map_or(1.0, |disk| 1.0 / disk.unit());
        Self { opening: session.opening_revision(), repair: model.form.repair, scale }
    }
}

/// What the window does for the seam tool.
impl Editor {
    /// The seams without those that are listed: those of texture coordinates stay.
    pub(in crate::ui) fn without_seams(&self) -> Seams {
        let seams = self.session.seams();
        seams.without(seams.edges().iter().copied())
    }

    /// The click that a press of the button would be, where the pointer is over a vertex.
    pub(in crate::ui) fn seam_click(&self, has_shift: bool) -> Option<SeamClick> {
        let seam = &self.tools.seam;
        seam.under().map(|vertex| SeamClick { vertex, erases: seam.erases() != has_shift })
    }

    /// What that click would do.
    pub(in crate::ui) fn seam_intent(&self, has_shift: bool) -> Option<SeamIntent> {
        let click = self.seam_click(has_shift).filter(|_| self.tools.tool() == Tool::Seam)?;
        Some(self.tools.seam.intent(click, self.session.seams()))
    }

    pub(super) fn take_seam_click(&mut self, click: SeamClick) {
        self.tools.seam.rules.forget_said();
        self.tools.seam.clicks.push_back(click);
        self.go_on_with_seam();
    }

    /// Finds what paths are wanted, and carries out the clicks that waited for them. Call once per frame.
    pub(super) fn go_on_with_seam(&mut self) {
        if self.tools.tool() != Tool::Seam {
            return;
        }
        self.tools.seam.follow_undo(self.session.seams());
        self.tools.seam.refresh(&self.session);
        while let Some(click) = self.tools.seam.clicks.pop_front() {
            match self.tools.seam.intent(click, self.session.seams()) {
                SeamIntent::Wait => return self.tools.seam.clicks.push_front(click),
                SeamIntent::Begin => self.tools.seam.last = Some(click.vertex),
                SeamIntent::Add(edges) => self.cut_along(self.session.seams().with(edges), click.vertex),
                SeamIntent::TakeAway(edges) => self.cut_along(self.session.seams().without(edges), click.vertex),
                SeamIntent::End => drop(self.tools.seam.end()),
                SeamIntent::Nothing => {}
            }
            self.tools.seam.refresh(&self.session);
        }
    }

    /// Cuts along other seams, and has the chain go on from a vertex, where there is one.
    fn cut_along(&mut self, seams: Seams, to: VertexId) {
        let seam = &mut self.tools.seam;
        if let Some(from) = seam.last {
            if seams != *self.session.seams() {
                seam.trail.push((self.session.seams().clone(), from));
            }
            seam.last = Some(to);
        }
        self.session.handle(Action::SetSeams(seams));
    }
}
