//! Data for drawing and picking in both panes, made off the UI thread once per mesh and once per embedding.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::around::Around;
use super::element::Element;
use super::in_file::InFile;
use crate::session::Model;
use crate::view::{
    EdgeList, ElementMesh, MeshArrays, MeshPart, PlaneArrays, PlanePicker, Ray, Sphere, SurfacePicker, VertexSets,
};
use freebound_core::flatten::Step;
use freebound_core::mesh::{DiskMesh, NewVertex, Refinement, TriMesh, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Embedding, GaugeSize};

/// Mesh prepared for drawing and picking: as given, or with the new vertices of a step.
#[derive(Debug)]
pub struct MeshScene {
    /// Opened mesh with its preparation.
    pub model: Arc<Model>,
    /// Revision of the model.
    pub model_revision: u64,
    /// Refinement of the mesh with new vertices; `None` for the mesh as given.
    pub refinement: Option<Arc<Refinement>>,
    pub arrays: Arc<MeshArrays>,
    /// Boundary of a disk, and the rims of holes.
    pub boundary: Arc<EdgeList>,
    /// Both sides of the seams, if the mesh is cut.
    pub seams: Arc<EdgeList>,
    /// Map to the vertices of the file.
    pub(in crate::ui) in_file: InFile,
    /// Vertices that only fill holes, which are not shown. Sorted.
    hidden: Vec<VertexId>,
    pub picker: SurfacePicker,
    /// Bounding sphere of the mesh and of the charts around it.
    pub sphere: Sphere,
    /// Other charts, if the mesh has several.
    pub around: Option<Around>,
}

impl MeshScene {
    pub fn new(model: Arc<Model>, model_revision: u64) -> Self {
        Self::of(model, model_revision, None)
    }

    /// True if both scenes are of one source mesh, cut in any way, with radii within a factor of 2. A mesh turned
    /// inside out has another source.
    pub(super) fn is_of_same_mesh(&self, other: &Self) -> bool {
        let grows = self.sphere.radius / other.sphere.radius;
        Arc::ptr_eq(&self.model.source, &other.model.source) && (0.5..2.0).contains(&grows)
    }

    /// Vertices of an element; empty if the mesh does not have it.
    pub(in crate::ui) fn vertices_of(&self, element: Element) -> Vec<VertexId> {
        let mesh = self.mesh();
        match element {
            Element::Vertex(vertex) if vertex.index() < mesh.vertex_count() => vec![vertex],
            Element::Vertex(_) => Vec::new(),
            Element::Face(face) => mesh.real_triangles().get(face.index()).map(|t| t.to_vec()).unwrap_or_default(),
            Element::Edge(edge) => match self.disk() {
                Some(disk) if edge.index() < disk.edge_count() => disk.ends(edge).to_vec(),
                _ => Vec::new(),
            },
        }
    }

    /// Scene for the mesh of a step: the mesh as given, the mesh of the step shown before, or a new scene.
    pub(in crate::ui) fn of_step(given: &Arc<Self>, before: Option<Arc<Self>>, step: &Step) -> Arc<Self> {
        let Some(refinement) = &step.candidate.refinement else { return Arc::clone(given) };
        let has_it = |scene: &Arc<Self>| scene.refinement.as_ref().is_some_and(|other| Arc::ptr_eq(other, refinement));
        before.filter(has_it).unwrap_or_else(|| {
            Arc::new(Self::of(Arc::clone(&given.model), given.model_revision, Some(Arc::clone(refinement))))
        })
    }

    fn of(model: Arc<Model>, model_revision: u64, refinement: Option<Arc<Refinement>>) -> Self {
        let disk = refinement.as_ref().map(|refinement| refinement.disk()).or(model.disk().map(AsRef::as_ref));
        let mesh = disk.map_or(model.mesh(), |disk| disk.mesh());
        let outer = disk.map(DiskMesh::boundary_loop);
        let holes = mesh.holes();
        let boundary = EdgeList::closed_loops(outer.into_iter().chain(holes.iter().map(|hole| &hole.rim[..])));
        let (positions, triangles) = (&mesh.positions, mesh.real_triangles());
        // Divide by the unit of the chart's positions.
        let unit = disk.map_or(1.0, DiskMesh::unit);
        let whole = model.prepared.chart.as_ref().map(|of| &of.charts.whole().polygons().positions);
        let whole: Option<Vec<DVec3>> = whole.map(|positions| positions.iter().map(|&at| at / unit).collect());
        let sphere = Sphere::around(whole.as_ref().unwrap_or(positions));
        Self {
            model_revision,
            arrays: Arc::new(MeshArrays::in_frame(positions, triangles, sphere)),
            boundary: Arc::new(boundary),
            seams: Arc::new(EdgeList::new(model.seam_sides())),
            in_file: InFile::of(&model),
            hidden: disk.map(DiskMesh::virtual_vertices).unwrap_or_default(),
            picker: SurfacePicker::new(positions, triangles),
            sphere,
            around: whole.and_then(|whole| Around::of(&model, &whole, sphere)),
            refinement,
            model,
        }
    }

    pub fn mesh(&self) -> &TriMesh {
        self.refinement.as_ref().map_or(self.model.mesh(), |refinement| refinement.disk().mesh())
    }

    /// Length of the file's unit in the scene's positions: positions are divided by it.
    pub(super) fn unit(&self) -> f64 {
        self.model.disk().map_or(1.0, |disk| disk.unit())
    }

    /// Elements of the mesh.
    pub(in crate::ui) fn elements(&self) -> ElementMesh<'_> {
        let mesh = self.mesh();
        let sets = VertexSets { positions: &mesh.positions, triangles: mesh.real_triangles() };
        let part = self.disk().map(|disk| MeshPart { disk, first_vertex: 0, first_face: 0 });
        ElementMesh::new(sets, part.into_iter().collect())
    }

    /// Rim of the hole with this lowest vertex; empty if there is none.
    pub(in crate::ui) fn hole_rim(&self, lowest: VertexId) -> Vec<VertexId> {
        let hole = self.mesh().holes().into_iter().find(|hole| hole.rim[0] == lowest);
        hole.map(|hole| hole.rim).unwrap_or_default()
    }

    /// Picker for the shown vertices at these positions in the plane.
    fn plane_picker(&self, places: &[DVec2]) -> PlanePicker {
        let mut places = places[..self.mesh().vertex_count()].to_vec();
        // NaN is never picked.
        self.hidden.iter().for_each(|vertex| places[vertex.index()] = DVec2::NAN);
        PlanePicker::new(&places)
    }

    pub fn disk(&self) -> Option<&DiskMesh> {
        let given = self.model.disk().map(AsRef::as_ref);
        self.refinement.as_ref().map(|refinement| refinement.disk()).or(given)
    }

    /// True if a ray meets the mesh or a chart around it.
    pub(in crate::ui) fn hits(&self, ray: Ray) -> bool {
        self.picker.hit(ray).is_some() || self.other_chart_at(ray).is_some()
    }

    /// Other chart that a ray meets first, unless a face of the chart on the screen is nearer.
    pub(in crate::ui) fn other_chart_at(&self, ray: Ray) -> Option<usize> {
        let (chart, distance) = self.around.as_ref()?.chart_at(ray)?;
        let is_hidden = self.picker.hit(ray).is_some_and(|own| own.distance <= distance);
        (!is_hidden).then_some(chart)
    }

    /// Data of a new vertex; `None` if the mesh as given has the vertex.
    pub fn new_vertex(&self, vertex: VertexId) -> Option<&NewVertex> {
        let refinement = self.refinement.as_ref()?;
        refinement.new_vertices().get(vertex.index().checked_sub(refinement.old_vertex_count())?)
    }
}

/// Embedding prepared for drawing and picking.
#[derive(Clone, Debug)]
pub struct PlaneScene {
    pub mesh: Arc<MeshScene>,
    /// Outcome of the solve.
    pub outcome: Arc<Outcome>,
    pub outcome_revision: u64,
    pub arrays: Arc<PlaneArrays>,
    pub picker: Arc<PlanePicker>,
    /// Number of faces of the outcome that extend beyond the picture; 0 in true size.
    pub(in crate::ui) faces_outside: usize,
    /// Positions that differ from the outcome's embedding. Stages may append vertices of the outside.
    positions: Option<Arc<Embedding>>,
    part: Part,
}

/// Relation of a scene to its outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Part {
    /// Embedding of the outcome.
    Result,
    /// Embedding of the outcome with its outside.
    WithOutside,
    /// Stage before the outcome.
    Stage,
}

impl PlaneScene {
    pub fn new(mesh: Arc<MeshScene>, outcome: Arc<Outcome>, outcome_revision: u64) -> Self {
        let embedding = &outcome.step.candidate.solution.embedding;
        Self {
            outcome_revision,
            arrays: Arc::new(PlaneArrays::new(embedding, mesh.mesh().real_triangles())),
            picker: Arc::new(mesh.plane_picker(embedding)),
            faces_outside: faces_outside(&outcome, mesh.mesh().real_triangles()),
            positions: None,
            part: Part::Result,
            outcome,
            mesh,
        }
    }

    /// Scene of this mesh at the positions of a stage, or with its outside. Vertices beyond those of the mesh are
    /// drawn but not picked.
    pub(in crate::ui) fn of_part(&self, part: Part, positions: Embedding) -> Self {
        let arrays = PlaneArrays::new(&positions, self.mesh.mesh().real_triangles());
        let picker = self.mesh.plane_picker(&positions);
        Self { part, ..self.moved(&self.mesh, Arc::new(positions), arrays, Arc::new(picker)) }
    }

    /// Scene of `mesh` at intermediate positions. `mesh` is the mesh of this scene or the mesh as given. Picking uses
    /// the positions of this scene.
    pub(super) fn with_positions(&self, mesh: &Arc<MeshScene>, positions: Arc<Embedding>) -> Self {
        let picker = if Arc::ptr_eq(mesh, &self.mesh) {
            Arc::clone(&self.picker)
        } else {
            Arc::new(mesh.plane_picker(self.positions()))
        };
        let arrays = PlaneArrays::in_frame(&positions, mesh.mesh().real_triangles(), self.arrays.frame);
        self.moved(mesh, positions, arrays, picker)
    }

    /// Moves vertices to their positions in an embedding. All other vertices must have their positions already.
    pub(super) fn move_vertices(&mut self, vertices: &[VertexId], embedding: &Embedding) {
        let own = || Arc::new(self.outcome.step.candidate.solution.embedding.clone());
        let mut shared = self.positions.take().unwrap_or_else(own);
        let positions = Arc::make_mut(&mut shared);
        for &vertex in vertices {
            positions[vertex] = embedding[vertex];
        }
        let triangles = self.mesh.mesh().real_triangles();
        self.arrays = Arc::new(PlaneArrays::in_frame(positions, triangles, self.arrays.frame));
        self.positions = Some(shared);
    }

    fn moved(
        &self,
        mesh: &Arc<MeshScene>,
        positions: Arc<Embedding>,
        arrays: PlaneArrays,
        picker: Arc<PlanePicker>,
    ) -> Self {
        let (mesh, arrays, outcome) = (Arc::clone(mesh), Arc::new(arrays), Arc::clone(&self.outcome));
        let (outcome_revision, faces_outside) = (self.outcome_revision, self.faces_outside);
        let (positions, part) = (Some(positions), Part::Result);
        Self { mesh, outcome, outcome_revision, arrays, picker, faces_outside, positions, part }
    }

    pub fn positions(&self) -> &Embedding {
        self.positions.as_deref().unwrap_or(&self.outcome.step.candidate.solution.embedding)
    }

    pub(in crate::ui) fn position_of(&self, vertex: VertexId) -> Option<DVec2> {
        self.positions().get(vertex.index()).copied()
    }

    pub fn is_stage(&self) -> bool {
        self.part == Part::Stage
    }

    /// True if the scene shows the outcome's embedding, not a stage, and no outside.
    pub(in crate::ui) fn is_plain_result(&self) -> bool {
        self.part == Part::Result
    }
}

/// Number of faces that extend beyond the picture by more than the rounding margin [`EDGE`].
fn faces_outside(outcome: &Outcome, triangles: &[[VertexId; 3]]) -> usize {
    if outcome.problem.settings.size == GaugeSize::TrueArea {
        return 0;
    }
    let [low, high] = outcome.problem.frame.corners();
    let margin = EDGE * (high - low).max_element();
    let embedding = &outcome.step.candidate.solution.embedding;
    let is_outside = |v: &VertexId| {
        let z = embedding[*v];
        (z.cmplt(low - margin) | z.cmpgt(high + margin)).any()
    };
    triangles.iter().filter(|corners| corners.iter().any(is_outside)).count()
}

/// Distance from the picture within which a vertex counts as on its edge, as a share of the picture's longer side.
const EDGE: f64 = 1e-9;
