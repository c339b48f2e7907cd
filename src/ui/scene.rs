//! What both panes draw and pick in: made off the UI thread, once per mesh and once per embedding.

use std::sync::Arc;

use glam::DVec2;

use super::Shading;
use crate::mesh::{EdgeId, FaceId, TriMesh, VertexId};
use crate::session::{Model, Outcome};
use crate::solver::{FaceDistortion, Verdict};
use crate::view::{EdgeList, FacePaint, MeshArrays, PlaneArrays, PlanePicker, Range, Scale, Sphere, SurfacePicker};

/// The mesh, ready to be drawn and picked in.
#[derive(Debug)]
pub struct MeshScene {
    /// The mesh that it was made from.
    pub model: Arc<Model>,
    /// Which mesh that was.
    pub model_revision: u64,
    /// Draw arrays.
    pub arrays: Arc<MeshArrays>,
    /// The boundary, where it is a disk.
    pub boundary: Arc<EdgeList>,
    /// Picks vertices and points of the surface.
    pub picker: SurfacePicker,
    /// A ball around it.
    pub sphere: Sphere,
}

impl MeshScene {
    /// Makes the scene of a mesh.
    pub fn new(model: Arc<Model>, model_revision: u64) -> Self {
        let TriMesh { positions, triangles, .. } = model.mesh();
        let boundary =
            model.disk().map_or_else(|| EdgeList::new(Vec::new()), |d| EdgeList::closed_loop(d.boundary_loop()));
        Self {
            model_revision,
            arrays: Arc::new(MeshArrays::new(positions, triangles)),
            boundary: Arc::new(boundary),
            picker: SurfacePicker::new(positions, triangles),
            sphere: Sphere::around(positions),
            model,
        }
    }
}

/// An embedding, ready to be drawn and picked in.
#[derive(Debug)]
pub struct PlaneScene {
    /// The solve that it was made from.
    pub outcome: Arc<Outcome>,
    /// Which solve that was.
    pub outcome_revision: u64,
    /// Draw arrays.
    pub arrays: Arc<PlaneArrays>,
    /// Picks vertices.
    pub picker: PlanePicker,
    /// Where vertices lie at a stage on the way to the result, those beyond the mesh's included.
    stage: Option<Vec<DVec2>>,
}

impl PlaneScene {
    /// Makes the scene of an embedding of `mesh`.
    pub fn new(mesh: &TriMesh, outcome: Arc<Outcome>, outcome_revision: u64) -> Self {
        let embedding = &outcome.step.solution.embedding;
        Self {
            outcome_revision,
            arrays: Arc::new(PlaneArrays::new(embedding, &mesh.triangles)),
            picker: PlanePicker::new(embedding),
            stage: None,
            outcome,
        }
    }

    /// Makes the scene of a stage on the way to an outcome: its revision, and where vertices lie.
    pub(super) fn of_stage(
        mesh: &TriMesh,
        outcome: Arc<Outcome>,
        (outcome_revision, positions): (u64, Vec<DVec2>),
    ) -> Self {
        Self {
            outcome_revision,
            arrays: Arc::new(PlaneArrays::new(&positions, &mesh.triangles)),
            picker: PlanePicker::new(&positions[..mesh.vertex_count()]),
            stage: Some(positions),
            outcome,
        }
    }

    /// Where vertices lie.
    pub fn positions(&self) -> &[DVec2] {
        self.stage.as_deref().unwrap_or(&self.outcome.step.solution.embedding)
    }

    /// Whether this is not the result.
    pub fn is_stage(&self) -> bool {
        self.stage.is_some()
    }
}

/// Faces coloured by a shading, with what a legend needs.
#[derive(Clone, Debug)]
pub struct Paint {
    /// What it was made for: outcome, model, shading.
    pub key: (u64, u64, Shading),
    /// Colours and flags per face.
    pub faces: Arc<FacePaint>,
    /// The scale of a shading by numbers.
    pub legend: Option<Legend>,
}

/// A scale with its range and how many faces lie where.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The scale.
    pub scale: Scale,
    /// Its range.
    pub range: Range,
    /// Faces in each of equal parts of the range; those beyond count at the ends.
    pub histogram: Vec<u32>,
}

/// Bars of a histogram.
const BARS: usize = 40;

impl Paint {
    /// Colours the faces of an embedding.
    pub fn new(key: (u64, u64, Shading), face_count: usize, outcome: Option<&Outcome>) -> Self {
        let Some(outcome) = outcome else {
            return Self { key, faces: Arc::new(FacePaint::plain(face_count, &[])), legend: None };
        };
        let flipped = &flipped_faces(&outcome.step.verdict);
        let by = |scale: Scale, of: fn(&FaceDistortion) -> f64| {
            let values: Vec<f64> = outcome.distortion.faces.iter().map(of).collect();
            let range = scale.robust_range(&values);
            let faces = Arc::new(FacePaint::by_value(&values, scale, range, flipped));
            Self { key, faces, legend: Some(Legend { scale, range, histogram: histogram(&values, range) }) }
        };
        match key.2 {
            Shading::Plain | Shading::Checker => {
                Self { key, faces: Arc::new(FacePaint::plain(face_count, flipped)), legend: None }
            }
            Shading::Angle => by(Scale::Angle, |face| face.angle),
            Shading::Area => by(Scale::Area, |face| face.area.log2()),
            Shading::Stretch => by(Scale::Stretch, |face| face.stretch_l2),
        }
    }
}

fn flipped_faces(verdict: &Verdict) -> Vec<crate::mesh::FaceId> {
    verdict.flipped_faces.clone()
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

/// A part of the mesh that a defect or a person names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
}

impl Element {
    /// Understands what a person types: `12` or `v12` a vertex, `e3` an edge, `f7` a face.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim().to_ascii_lowercase();
        let (kind, number) = match text.chars().next()? {
            letter @ ('v' | 'e' | 'f') => (letter, &text[1..]),
            _ => ('v', text.as_str()),
        };
        let number: u32 = number.trim().parse().ok()?;
        Some(match kind {
            'e' => Self::Edge(EdgeId::new(number)),
            'f' => Self::Face(FaceId::new(number)),
            _ => Self::Vertex(VertexId::new(number)),
        })
    }
}

/// The vertices of an element; none where the mesh does not have it.
pub(super) fn vertices_of(model: &Model, element: Element) -> Vec<VertexId> {
    let mesh = model.mesh();
    match element {
        Element::Vertex(vertex) if vertex.index() < mesh.vertex_count() => vec![vertex],
        Element::Vertex(_) => Vec::new(),
        Element::Face(face) => mesh.triangles.get(face.index()).map(|t| t.to_vec()).unwrap_or_default(),
        Element::Edge(edge) => match model.disk() {
            Some(disk) if edge.index() < disk.edge_count() => disk.ends(edge).to_vec(),
            _ => Vec::new(),
        },
    }
}
