//! The seam that is being drawn. It stands on the file's own vertices, which stay what they are while each click cuts the mesh
//! anew; so does the chain of clicks.
//!
//! ```text
//! mesh of the file ── background, once ──▶ SeamGround ── background, once per click ──▶ PathTree ── each frame ──▶ path
//! ```
//!
//! One function, of `seam_intent.rs`, says what a click would do; the preview, the words in the status bar and the click itself
//! all ask it.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::async_scene::AsyncScene;
use super::seam_chain::Chain;
use super::seam_intent::Foreseen;
use super::seam_rules::SeamRules;
use crate::session::{JobFailure, Model, Session, Wake};
use crate::ui::state::SeamClick;
use crate::view::{OrbitCamera, SurfacePicker, Visibility};
use freebound_core::mesh::{EdgePaths, PathTree, Repairs, VertexId};
use freebound_io::MeshFile;

/// Share of creases in the measure of paths at the start.
pub(in crate::ui) const CREASES: f64 = 0.5;

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
pub(super) struct TreeKey {
    ground: GroundKey,
    from: VertexId,
    creases: f64,
}

pub struct SeamTool {
    /// Seams by a rule.
    pub(in crate::ui) rules: SeamRules,
    /// Share of creases in the measure of paths, 0 to 1.
    creases: f64,
    /// Whether clicks take seams away.
    erases: bool,
    /// The seam as far as it has got.
    pub(super) chain: Chain,
    /// Clicks that wait for the paths to be found.
    pub(super) clicks: VecDeque<SeamClick>,
    /// The vertex of the file under the pointer.
    under: Option<VertexId>,
    /// What a click there would do.
    pub(super) foreseen: Option<Foreseen>,
    /// What was open last, by the session's count.
    opening: Option<u64>,
    ground: Option<(GroundKey, Arc<SeamGround>)>,
    ground_job: AsyncScene<GroundKey, SeamGround>,
    tree: Option<(TreeKey, PathTree)>,
    tree_job: AsyncScene<TreeKey, PathTree>,
}

/// Without what was found: that is as large as the mesh.
impl fmt::Debug for SeamTool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("SeamTool");
        state.field("last", &self.last()).field("clicks", &self.clicks).field("is_busy", &self.is_busy());
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
            chain: Chain::default(),
            clicks: VecDeque::new(),
            under: None,
            foreseen: None,
            opening: None,
            ground: None,
            ground_job: AsyncScene::new("seam ground", wake),
            tree: None,
            tree_job: AsyncScene::new("seam paths", wake),
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
        self.chain.last()
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
        self.clicks.clear();
        self.tree_job.cancel();
        self.chain.end()
    }

    /// Ends the seam, and lets go of what was found for it.
    pub(super) fn put_away(&mut self) {
        self.end();
        self.rules.forget_said();
        self.ground_job.cancel();
        (self.ground, self.tree, self.foreseen) = (None, None, None);
    }

    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        let failure = self.ground_job.take_failure().or(self.tree_job.take_failure()).or(self.rules.take_failure());
        if failure.is_some() {
            self.clicks.clear();
        }
        failure
    }

    /// The paths from a vertex, where they are found.
    pub(super) fn tree_from(&self, from: VertexId) -> Option<&PathTree> {
        let is_of = |key: &TreeKey| key.from == from && key.creases.to_bits() == self.creases.to_bits();
        self.tree.as_ref().filter(|(key, _)| is_of(key)).map(|(_, tree)| tree)
    }

    pub(super) fn tree_key(&self) -> Option<TreeKey> {
        self.tree.as_ref().map(|(key, _)| *key)
    }

    /// Takes in what was found, and has found what is missing.
    pub(super) fn refresh(&mut self, session: &Session) {
        let Some(model) = session.model() else { return self.put_away() };
        let key = GroundKey::of(session, model);
        if self.opening.replace(key.opening).is_some_and(|before| before != key.opening) {
            self.put_away();
        }
        if let Some((of, ground)) = self.ground_job.poll().filter(|(of, _)| *of == key) {
            (self.ground, self.foreseen) = (Some((of, Arc::new(ground))), None);
        }
        let Some((of, ground)) = self.ground.as_ref().filter(|(of, _)| *of == key) else {
            let source = Arc::clone(&model.source);
            return self.ground_job.make(key, move |_| SeamGround::new(source, key));
        };
        let Some(from) = self.last() else { return };
        let key = TreeKey { ground: *of, from, creases: self.creases };
        if let Some(found) = self.tree_job.poll().filter(|(of, _)| *of == key) {
            self.tree = Some(found);
        }
        if self.tree.as_ref().is_none_or(|(of, _)| *of != key) {
            let paths = Arc::clone(&ground.paths);
            self.tree_job.make(key, move |_| PathTree::new(&paths, key.from, key.creases));
        }
    }
}

impl GroundKey {
    fn of(session: &Session, model: &Model) -> Self {
        let scale = model.disk().map_or(1.0, |disk| 1.0 / disk.unit());
        Self { opening: session.opening_revision(), repair: model.prepared.form.repair, scale }
    }
}
