//! Face colours of a shading: by a number of each face, or plain.

use std::sync::Arc;

use crate::ui::state::ShadingMode;
use crate::view::{FacePaint, Quantity, Range, Scale};
use freebound_core::flatten::Step;
use freebound_core::mesh::{FaceId, TriMesh, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Embedding;

/// Face colours of a shading, with the data of a legend.
#[derive(Clone, Debug)]
pub struct BrushPaint {
    pub key: PaintKey,
    pub faces: Arc<FacePaint>,
    pub legend: Option<Legend>,
}

/// Inputs that a paint depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaintKey {
    /// Revision of the mesh.
    pub model: u64,
    /// Revision of the outcome.
    pub outcome: u64,
    pub shading: ShadingMode,
    /// Step that moves are measured from, for the shading by moves.
    pub moved_from: Option<usize>,
    /// Number of changes of the shown column, for the shading by a column.
    pub column: u64,
}

/// Numbers that do not come from the embedding alone.
#[derive(Clone, Debug, Default)]
pub struct PaintValues<'a> {
    /// Step that moves are measured from.
    pub base: Option<&'a Outcome>,
    /// Number of each face, from a table.
    pub column: Option<Vec<f64>>,
}

/// Colour scale with its range and a histogram of the faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    pub scale: Scale,
    pub range: Range,
    /// Number of faces in each equal part of the range. Faces beyond the range count at the ends.
    pub histogram: Vec<u32>,
}

const BARS: usize = 40;

impl Legend {
    /// Counts values on a scale with a range.
    pub(super) fn new<'a>(scale: Scale, range: Range, values: impl IntoIterator<Item = &'a f64>) -> Self {
        Self { scale, range, histogram: histogram(values, range) }
    }
}

impl BrushPaint {
    /// Colours the faces of an embedding.
    pub fn new(key: PaintKey, mesh: &TriMesh, outcome: Option<&Outcome>, values: PaintValues<'_>) -> Self {
        let PaintValues { base, column } = values;
        if let Some(values) = column {
            let flipped = outcome.map_or(&[][..], |outcome| &outcome.step.verdict.flipped_faces);
            let (faces, legend) = column_paint(&values, flipped);
            return Self { key, faces: Arc::new(faces), legend: Some(legend) };
        }
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
            Self { key, faces, legend: Some(Legend::new(scale, range, values)) }
        };
        let by = |quantity: Quantity| by_values(quantity.scale(), &quantity.values(&outcome.distortion));
        match (key.shading, base) {
            (
                ShadingMode::Plain
                | ShadingMode::Checker
                | ShadingMode::Picture
                | ShadingMode::SeeThrough
                | ShadingMode::Column,
                _,
            )
            | (ShadingMode::Move, None) => plain(flipped),
            (ShadingMode::Angle, _) => by(Quantity::Angle),
            (ShadingMode::Area, _) => by(Quantity::Area),
            (ShadingMode::Stretch, _) => by(Quantity::Stretch),
            (ShadingMode::Move, Some(base)) => {
                let before = embedding_on(&base.step, &outcome.step);
                by_values(Scale::Move, &face_moves(mesh, &before, &outcome.step.candidate.solution.embedding))
            }
        }
    }
}

/// Colours of the numbers of a table, with their legend.
pub(super) fn column_paint(values: &[f64], flipped: &[FaceId]) -> (FacePaint, Legend) {
    let scale = Scale::of_column(values);
    let range = scale.robust_range(values);
    (FacePaint::by_value(values, scale, range, flipped), Legend::new(scale, range, values))
}

fn histogram<'a>(values: impl IntoIterator<Item = &'a f64>, range: Range) -> Vec<u32> {
    let mut bars = vec![0; BARS];
    for share in values.into_iter().map(|&v| range.share(v)).filter(|share| share.is_finite()) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share lies in 0 to 1")]
        let bar = (share * BARS as f64) as usize;
        bars[bar.min(BARS - 1)] += 1;
    }
    bars
}

/// Positions of a step on the mesh of another step. New vertices that `base` lacks lie on its straight edges.
fn embedding_on(base: &Step, step: &Step) -> Embedding {
    let embedding = &base.candidate.solution.embedding;
    let Some(refinement) = &step.candidate.refinement else { return embedding.clone() };
    if base.candidate.refinement.as_ref().is_some_and(|other| Arc::ptr_eq(other, refinement)) {
        return embedding.clone();
    }
    let mut moved = embedding[..refinement.old_vertex_count()].to_vec();
    for new in refinement.new_vertices() {
        let [a, b] = new.edge.map(|v| embedding[v.index()]);
        moved.push(a.lerp(b, new.at));
    }
    moved.into()
}

/// Distance that each face has moved between two embeddings: the mean over its corners.
fn face_moves(mesh: &TriMesh, before: &Embedding, after: &Embedding) -> Vec<f64> {
    let moves: Vec<f64> = before.iter().zip(after).map(|(a, b)| a.distance(*b)).collect();
    let of_vertex = |v: VertexId| moves.get(v.index()).copied().unwrap_or(f64::NAN);
    mesh.real_triangles().iter().map(|corners| corners.map(of_vertex).iter().sum::<f64>() / 3.0).collect()
}
