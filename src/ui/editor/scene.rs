//! What both panes draw and pick in: made off the UI thread, once per mesh and once per embedding.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::around::Around;
use crate::mesh::{DiskMesh, FaceId, NewVertex, Refinement, TriMesh, VertexId};
use crate::session::{Model, Outcome};
use crate::solver::{Embedding, FaceDistortion, GaugeSize, Step};
use crate::ui::Shading;
use crate::ui::editor::Element;
use crate::view::{
    EdgeList, FacePaint, MeshArrays, PlaneArrays, PlanePicker, Range, Ray, Scale, Sphere, SurfacePicker,
};

/// A mesh, ready to be drawn and picked in: as given, or with the new vertices of a step.
#[derive(Debug)]
pub struct MeshScene {
    /// What was opened.
    pub model: Arc<Model>,
    /// Which mesh that was.
    pub model_revision: u64,
    /// The mesh with new vertices that it is of; none where it is of the mesh as given.
    pub refinement: Option<Arc<Refinement>>,
    pub arrays: Arc<MeshArrays>,
    /// The boundary, where it is a disk: of holes, too.
    pub boundary: Arc<EdgeList>,
    /// Vertices that only fill holes: they are not shown.
    hidden: Vec<VertexId>,
    pub picker: SurfacePicker,
    /// A ball around it, and around what stands around it.
    pub sphere: Sphere,
    /// The other charts, where the mesh has several.
    pub around: Option<Around>,
}

impl MeshScene {
    pub fn new(model: Arc<Model>, model_revision: u64) -> Self {
        Self::of(model, model_revision, None)
    }

    /// Whether another chart of the same mesh is on the screen of both.
    pub(super) fn is_of_same_mesh(&self, other: &Self) -> bool {
        let charts = |scene: &Self| scene.model.chart.as_ref().map(|of| Arc::clone(&of.charts));
        charts(self).zip(charts(other)).is_some_and(|(own, other)| Arc::ptr_eq(&own, &other))
    }

    /// The vertices of an element; none where the mesh does not have it.
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

    /// The scene of the mesh that a step's embedding is of: that of the mesh as given, that of the step shown before,
    /// or one of its own.
    pub(in crate::ui) fn of_step(given: &Arc<Self>, before: Option<Arc<Self>>, step: &Step) -> Arc<Self> {
        let Some(refinement) = &step.refinement else { return Arc::clone(given) };
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
        // In the unit of the chart's positions.
        let unit = disk.map_or(1.0, DiskMesh::unit);
        let whole = model.chart.as_ref().map(|of| &of.charts.whole().polygons().positions);
        let whole: Option<Vec<DVec3>> = whole.map(|positions| positions.iter().map(|&at| at / unit).collect());
        let sphere = Sphere::around(whole.as_ref().unwrap_or(positions));
        Self {
            model_revision,
            arrays: Arc::new(MeshArrays::in_frame(positions, triangles, sphere)),
            boundary: Arc::new(boundary),
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

    /// The vertices around the hole whose lowest one this is.
    pub(in crate::ui) fn hole_rim(&self, lowest: VertexId) -> Vec<VertexId> {
        let hole = self.mesh().holes().into_iter().find(|hole| hole.rim[0] == lowest);
        hole.map(|hole| hole.rim).unwrap_or_default()
    }

    /// The vertices that are shown.
    pub(in crate::ui) fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        let all = (0..self.mesh().vertex_count()).map(VertexId::from_index);
        all.filter(|vertex| self.hidden.binary_search(vertex).is_err())
    }

    /// Picks among the shown vertices in the plane, where they have these places.
    fn plane_picker(&self, places: &[DVec2]) -> PlanePicker {
        let mut places = places[..self.mesh().vertex_count()].to_vec();
        // What is nowhere is not picked.
        self.hidden.iter().for_each(|vertex| places[vertex.index()] = DVec2::NAN);
        PlanePicker::new(&places)
    }

    pub fn disk(&self) -> Option<&DiskMesh> {
        let given = self.model.disk().map(AsRef::as_ref);
        self.refinement.as_ref().map(|refinement| refinement.disk()).or(given)
    }

    /// The chart that is not on the screen and that a ray meets first, if no face of the chart on the screen is nearer.
    pub(in crate::ui) fn other_chart_at(&self, ray: Ray) -> Option<usize> {
        let (chart, distance) = self.around.as_ref()?.chart_at(ray)?;
        let is_hidden = self.picker.hit(ray).is_some_and(|own| own.distance <= distance);
        (!is_hidden).then_some(chart)
    }

    /// What there is to say about a vertex that the mesh as given does not have.
    pub fn new_vertex(&self, vertex: VertexId) -> Option<&NewVertex> {
        let refinement = self.refinement.as_ref()?;
        refinement.new_vertices().get(vertex.index().checked_sub(refinement.old_vertex_count())?)
    }
}

/// An embedding, ready to be drawn and picked in.
#[derive(Debug)]
pub struct PlaneScene {
    pub mesh: Arc<MeshScene>,
    /// The solve that it was made from.
    pub outcome: Arc<Outcome>,
    pub outcome_revision: u64,
    pub arrays: Arc<PlaneArrays>,
    pub picker: Arc<PlanePicker>,
    /// Faces of the outcome that reach out of the picture; 0 without one.
    pub(in crate::ui) faces_outside: usize,
    /// Where vertices lie where that is not the outcome's embedding; at a stage with those beyond the mesh's.
    positions: Option<Embedding>,
    part: Part,
}

/// What of the way to an outcome a scene shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Part {
    /// The outcome itself.
    Result,
    /// The outcome with what lies around it.
    WithOutside,
    /// A stage before it.
    Stage,
}

impl PlaneScene {
    pub fn new(mesh: Arc<MeshScene>, outcome: Arc<Outcome>, outcome_revision: u64) -> Self {
        let embedding = &outcome.step.solution.embedding;
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

    /// The same mesh with other points than the outcome's embedding: at a stage on the way to it, or with its outside.
    /// Points beyond the mesh's are drawn with, and not picked.
    pub(in crate::ui) fn of_part(&self, part: Part, positions: Embedding) -> Self {
        let arrays = PlaneArrays::new(&positions, self.mesh.mesh().real_triangles());
        let picker = self.mesh.plane_picker(&positions);
        Self { part, ..self.moved(&self.mesh, positions, arrays, Arc::new(picker)) }
    }

    /// The vertices of `mesh`, this one's or the one as given, on their way to where they will lie. Picks them where they
    /// are in this scene.
    pub(super) fn with_positions(&self, mesh: &Arc<MeshScene>, positions: Embedding) -> Self {
        let picker = if Arc::ptr_eq(mesh, &self.mesh) {
            Arc::clone(&self.picker)
        } else {
            Arc::new(mesh.plane_picker(self.positions()))
        };
        let arrays = PlaneArrays::in_frame(&positions, mesh.mesh().real_triangles(), self.arrays.frame);
        self.moved(mesh, positions, arrays, picker)
    }

    fn moved(
        &self,
        mesh: &Arc<MeshScene>,
        positions: Embedding,
        arrays: PlaneArrays,
        picker: Arc<PlanePicker>,
    ) -> Self {
        let (mesh, arrays, outcome) = (Arc::clone(mesh), Arc::new(arrays), Arc::clone(&self.outcome));
        let (outcome_revision, faces_outside) = (self.outcome_revision, self.faces_outside);
        let (positions, part) = (Some(positions), Part::Result);
        Self { mesh, outcome, outcome_revision, arrays, picker, faces_outside, positions, part }
    }

    pub fn positions(&self) -> &Embedding {
        self.positions.as_ref().unwrap_or(&self.outcome.step.solution.embedding)
    }

    pub(in crate::ui) fn position_of(&self, vertex: VertexId) -> Option<DVec2> {
        self.positions().get(vertex.index()).copied()
    }

    pub fn is_stage(&self) -> bool {
        self.part == Part::Stage
    }

    /// Whether this is the result alone, without stages and outside.
    pub(in crate::ui) fn is_plain_result(&self) -> bool {
        self.part == Part::Result
    }
}

/// How many faces reach out of the picture. What lies on its edge up to rounding does not.
fn faces_outside(outcome: &Outcome, triangles: &[[VertexId; 3]]) -> usize {
    if outcome.problem.settings.size == GaugeSize::TrueArea {
        return 0;
    }
    let [low, high] = outcome.problem.frame.corners();
    let margin = EDGE * (high - low).max_element();
    let embedding = &outcome.step.solution.embedding;
    let is_outside = |v: &VertexId| {
        let z = embedding[*v];
        (z.cmplt(low - margin) | z.cmpgt(high + margin)).any()
    };
    triangles.iter().filter(|corners| corners.iter().any(is_outside)).count()
}

/// Distance from the picture up to which a vertex counts as on its edge, in parts of the picture's longer side.
const EDGE: f64 = 1e-9;

/// Faces coloured by a shading, with what a legend needs.
#[derive(Clone, Debug)]
pub struct Paint {
    pub key: PaintKey,
    pub faces: Arc<FacePaint>,
    pub legend: Option<Legend>,
}

/// What a paint is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaintKey {
    /// The mesh, by its revision.
    pub model: u64,
    /// The outcome, by its revision.
    pub outcome: u64,
    pub shading: Shading,
    /// The step that moves are measured from, where they are asked for.
    pub moved_from: Option<usize>,
}

/// A scale with its range and how many faces lie where.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    pub scale: Scale,
    pub range: Range,
    /// Faces in each of equal parts of the range; those beyond count at the ends.
    pub histogram: Vec<u32>,
}

const BARS: usize = 40;

impl Paint {
    /// Colours the faces of an embedding; moves are measured from `base`.
    pub fn new(key: PaintKey, mesh: &TriMesh, outcome: Option<&Outcome>, base: Option<&Outcome>) -> Self {
        let plain = |flipped: &[FaceId]| Self {
            key,
            faces: Arc::new(FacePaint::plain(mesh.real_face_count(), flipped)),
            legend: None,
        };
        let Some(outcome) = outcome else { return plain(&[]) };
        let flipped = &outcome.step.verdict.flipped_faces;
        let by_values = |scale: Scale, values: &[f64]| {
            let range = scale.robust_range(values);
            let faces = Arc::new(FacePaint::by_value(values, scale, range, flipped));
            Self { key, faces, legend: Some(Legend { scale, range, histogram: histogram(values, range) }) }
        };
        let by = |scale: Scale, of: fn(&FaceDistortion) -> f64| {
            by_values(scale, &outcome.distortion.faces.iter().map(of).collect::<Vec<f64>>())
        };
        match (key.shading, base) {
            (Shading::Plain | Shading::Checker | Shading::Picture | Shading::SeeThrough, _) | (Shading::Move, None) => {
                plain(flipped)
            }
            (Shading::Angle, _) => by(Scale::Angle, |face| face.angle),
            (Shading::Area, _) => by(Scale::Area, |face| face.area.log2()),
            (Shading::Stretch, _) => by(Scale::Stretch, |face| face.stretch_l2),
            (Shading::Move, Some(base)) => {
                let before = embedding_on(&base.step, &outcome.step);
                by_values(Scale::Move, &face_moves(mesh, &before, &outcome.step.solution.embedding))
            }
        }
    }
}

fn histogram(values: &[f64], range: Range) -> Vec<u32> {
    let mut bars = vec![0; BARS];
    for share in values.iter().map(|&v| range.share(v)).filter(|share| share.is_finite()) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share lies in 0 to 1")]
        let bar = (share * BARS as f64) as usize;
        bars[bar.min(BARS - 1)] += 1;
    }
    bars
}

/// Where the vertices of one step lie in another one: new vertices that the other one lacks on its straight edges.
fn embedding_on(base: &Step, step: &Step) -> Embedding {
    let embedding = &base.solution.embedding;
    let Some(refinement) = &step.refinement else { return embedding.clone() };
    if base.refinement.as_ref().is_some_and(|other| Arc::ptr_eq(other, refinement)) {
        return embedding.clone();
    }
    let mut moved = embedding[..refinement.old_vertex_count()].to_vec();
    for new in refinement.new_vertices() {
        let [a, b] = new.edge.map(|v| embedding[v.index()]);
        moved.push(a.lerp(b, new.at));
    }
    moved.into()
}

/// How far each face has moved between two embeddings: the mean of its corners.
fn face_moves(mesh: &TriMesh, before: &Embedding, after: &Embedding) -> Vec<f64> {
    let moves: Vec<f64> = before.iter().zip(after).map(|(a, b)| a.distance(*b)).collect();
    let of_vertex = |v: VertexId| moves.get(v.index()).copied().unwrap_or(f64::NAN);
    mesh.real_triangles().iter().map(|corners| corners.map(of_vertex).iter().sum::<f64>() / 3.0).collect()
}
