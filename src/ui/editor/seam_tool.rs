//! Seam being drawn. It refers to vertices of the file, which keep their numbers while each click cuts the mesh
//! again; so does the chain of clicks.
//!
//! ```text
//! file's mesh ── background, once ──▶ SeamGround ── background, once per click ──▶ PathTree ── each frame ──▶ path
//! ```
//!
//! A single function in `seam_intent.rs` computes the effect of a click for the preview, the status bar and the
//! click.

use std::collections::{BTreeSet, VecDeque};
use std::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::async_scene::AsyncScene;
use super::seam_chain::Chain;
use super::seam_intent::Foreseen;
use super::seam_rules::SeamRules;
use crate::session::{JobFailure, Model, Session, Wake};
use crate::ui::state::{Edge, SeamClick};
use crate::view::{OrbitCamera, SurfacePicker, Visibility};
use freebound_core::mesh::{EdgePaths, PathTree, Repairs, VertexId};
use freebound_io::MeshFile;

/// Default weight of creases in the length of paths.
pub(in crate::ui) const CREASES: f64 = 0.5;

/// Radius of the brush, points.
pub(in crate::ui) const BRUSH: f64 = 18.0;

/// Mesh of the file before any cuts.
#[derive(Debug)]
pub(in crate::ui) struct SeamGround {
    source: Arc<MeshFile>,
    /// World units per unit of the file.
    scale: f64,
    picker: SurfacePicker,
    paths: Arc<EdgePaths>,
    /// All edges, the smaller number first, ascending.
    edges: Vec<Edge>,
}

/// Inputs that a ground depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GroundKey {
    /// Opening of the session, by its count.
    opening: u64,
    repair: Repairs,
    scale: f64,
}

/// Inputs that a tree of paths depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TreeKey {
    ground: GroundKey,
    from: VertexId,
    creases: f64,
}

pub struct SeamTool {
    /// Seams by a rule.
    pub(in crate::ui) rules: SeamRules,
    /// Weight of creases in the length of paths, 0 to 1.
    creases: f64,
    /// True if clicks close seams, and the brush takes paint away.
    erases: bool,
    /// True if drags over the mesh paint where no automatic seam may run.
    paints: bool,
    /// Edges of the stroke being painted.
    stroke: BTreeSet<Edge>,
    /// Chain of clicks of the seam being drawn.
    pub(super) chain: Chain,
    /// Clicks that wait for the paths.
    pub(super) clicks: VecDeque<SeamClick>,
    /// Vertex of the file under the pointer.
    under: Option<VertexId>,
    /// Effect of the click under the pointer.
    pub(super) foreseen: Option<Foreseen>,
    /// Last opening of the session, by its count.
    opening: Option<u64>,
    ground: Option<(GroundKey, Arc<SeamGround>)>,
    ground_job: AsyncScene<GroundKey, SeamGround>,
    tree: Option<(TreeKey, PathTree)>,
    tree_job: AsyncScene<TreeKey, PathTree>,
}

/// Omits ground and tree, which are as large as the mesh.
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
        let polygons = &source.polygons;
        let side = |corners: &[VertexId], k: usize| {
            let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
            [a.min(b), a.max(b)]
        };
        let faces = (0..polygons.face_count()).map(|face| polygons.face(face));
        let mut edges: Vec<Edge> =
            faces.flat_map(|corners| (0..corners.len()).map(move |k| side(corners, k))).collect();
        edges.sort_unstable();
        edges.dedup();
        let positions: Vec<DVec3> = mesh.positions.iter().map(|&at| at * key.scale).collect();
        Self {
            picker: SurfacePicker::new(&positions, &mesh.triangles),
            paths: Arc::new(EdgePaths::new(&source.polygons, key.repair)),
            scale: key.scale,
            edges,
            source,
        }
    }

    /// Position of a vertex of the file in the world.
    pub(in crate::ui) fn place(&self, vertex: VertexId) -> Option<DVec3> {
        Some(*self.source.polygons.positions.get(vertex.index())? * self.scale)
    }

    /// True if the mesh does not hide a vertex.
    pub(in crate::ui) fn shows(&self, vertex: VertexId, camera: &OrbitCamera) -> bool {
        self.picker.is_visible(vertex, camera.eye())
    }

    /// Visible edges under the brush, whose middle is at the pointer.
    fn edges_under(&self, camera: &OrbitCamera, size: DVec2, pointer: DVec2) -> Vec<Edge> {
        let spots: Vec<Option<DVec2>> = self.picker.spots(camera, size);
        let is_near = |edge: &Edge| match edge.map(|end| spots[end.index()]) {
            [Some(a), Some(b)] => {
                let along = (pointer - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
                a.lerp(b, along.clamp(0.0, 1.0)).distance(pointer) <= BRUSH
            }
            _ => false,
        };
        let near = self.edges.iter().copied().filter(is_near);
        near.filter(|edge| edge.iter().any(|&end| self.shows(end, camera))).collect()
    }

    /// Vertex of the file nearest to the pointer, among visible vertices.
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
            paints: false,
            stroke: BTreeSet::new(),
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

    /// True if drags over the mesh paint where no automatic seam may run.
    pub fn paints(&self) -> bool {
        self.paints
    }

    pub(super) fn toggle_paints(&mut self) {
        self.paints = !self.paints;
        self.end();
    }

    /// Edges of the stroke being painted.
    pub(in crate::ui) fn stroke(&self) -> &BTreeSet<Edge> {
        &self.stroke
    }

    /// Adds the edges under the brush to the stroke.
    pub(in crate::ui) fn paint(&mut self, camera: &OrbitCamera, size: DVec2, pointer: DVec2) {
        let edges = self.ground().map(|ground| ground.edges_under(camera, size, pointer));
        self.stroke.extend(edges.unwrap_or_default());
    }

    /// Ends the stroke and returns its edges.
    pub(in crate::ui) fn end_stroke(&mut self) -> Vec<Edge> {
        std::mem::take(&mut self.stroke).into_iter().collect()
    }

    pub fn erases(&self) -> bool {
        self.erases
    }

    pub(super) fn toggle_erases(&mut self) {
        self.erases = !self.erases;
    }

    /// Last vertex of the seam, a vertex of the file.
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

    /// True if paths are being found, or clicks wait for them.
    pub fn is_busy(&self) -> bool {
        self.rules.is_busy() || self.ground_job.is_busy() || self.tree_job.is_busy() || !self.clicks.is_empty()
    }

    /// Ends the seam being drawn. Returns true if there was one.
    pub(super) fn end(&mut self) -> bool {
        self.clicks.clear();
        self.stroke.clear();
        self.tree_job.cancel();
        self.chain.end()
    }

    /// Ends the seam, and drops the data found for it.
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

    /// Paths from a vertex, if found.
    pub(super) fn tree_from(&self, from: VertexId) -> Option<&PathTree> {
        let is_of = |key: &TreeKey| key.from == from && key.creases.to_bits() == self.creases.to_bits();
        self.tree.as_ref().filter(|(key, _)| is_of(key)).map(|(_, tree)| tree)
    }

    pub(super) fn tree_key(&self) -> Option<TreeKey> {
        self.tree.as_ref().map(|(key, _)| *key)
    }

    /// Adopts finished background jobs, and starts jobs for missing data.
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
