//! Embeddings of one mesh beside each other, under one camera: each has a place and a size of its own in the plane, and is seen as if
//! these were the same.

use glam::DVec2;

use super::PlaneCamera;
use freebound_core::geom::{Bounds, double_area};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Outcome;

/// Free space around an embedding, relative to its extent.
const MARGIN: f64 = 0.04;

/// An embedding that is so many times as large as the median one is cut off, rather than that all others get small.
const LARGEST: f64 = 2.5;

/// How an embedding lies in the plane that all of them are seen in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellFrame {
    /// The point of the embedding that is the origin there.
    origin: DVec2,
    /// Units of the embedding for one there.
    size: f64,
}

/// How several embeddings lie in one plane.
#[derive(Clone, Debug, PartialEq)]
pub struct CellFrames {
    /// Each of them.
    pub frames: Vec<CellFrame>,
    /// What is to be seen of that plane.
    pub bounds: Bounds,
}

impl CellFrame {
    /// The point of the embedding that is seen at a point of the common plane.
    pub fn own(self, common: DVec2) -> DVec2 {
        self.origin + self.size * common
    }

    /// How many units of the embedding one of the common plane is.
    pub fn size(self) -> f64 {
        self.size
    }

    /// The camera that shows of the embedding what `camera` shows of the common plane.
    pub fn camera(self, camera: &PlaneCamera) -> PlaneCamera {
        camera.over_similar(self.origin, self.size)
    }
}

impl CellFrames {
    /// Lays out steps on one mesh as given. Embeddings that pins hold stay where they are. The others are seen each about its own
    /// middle: at their own size, which is that of the surface or of the picture; or, where pins hold some, with the area of the
    /// first of those.
    pub fn new(given: &DiskMesh, outcomes: &[&Outcome]) -> Self {
        let pinned = outcomes.iter().find(|outcome| outcome.is_held());
        let size_of = |outcome: &Outcome| match pinned {
            Some(pinned) if !outcome.is_held() => (area(given, outcome) / area(given, pinned)).sqrt(),
            _ => 1.0,
        };
        let boxes: Vec<Bounds> =
            outcomes.iter().map(|outcome| outcome.step.candidate.solution.embedding.bounds()).collect();
        let sizes: Vec<f64> = outcomes
            .iter()
            .map(|outcome| Some(size_of(outcome)).filter(|&size| is_scale(size)).unwrap_or(1.0))
            .collect();
        let held = outcomes.iter().zip(&boxes).filter(|(outcome, _)| outcome.is_held()).map(|(_, bounds)| *bounds);
        let extents = boxes.iter().zip(&sizes).map(|(bounds, size)| bounds.size().max_element() / size);
        let (side, held) = (common_side(extents), around(&held.collect::<Vec<_>>()));
        let bounds = held.unwrap_or_else(|| square(DVec2::ZERO, side));
        let frame = |((outcome, own), &size): ((&&Outcome, &Bounds), &f64)| {
            let origin = if outcome.is_held() { DVec2::ZERO } else { own.middle() - size * bounds.middle() };
            CellFrame { origin: if origin.is_finite() { origin } else { DVec2::ZERO }, size }
        };
        Self { frames: outcomes.iter().zip(&boxes).zip(&sizes).map(frame).collect(), bounds }
    }
}

fn is_scale(size: f64) -> bool {
    size.is_normal() && size > 0.0
}

/// The square around a point with so long a side.
fn square(middle: DVec2, side: f64) -> Bounds {
    let half = DVec2::splat(side / 2.0);
    Bounds { low: middle - half, high: middle + half }
}

/// The square around boxes, those much larger than the others left out; none of none.
fn around(boxes: &[Bounds]) -> Option<Bounds> {
    let side = common_side(boxes.iter().map(|bounds| bounds.size().max_element()));
    let usual = boxes.iter().filter(|bounds| bounds.size().max_element() <= side);
    let all = usual.copied().reduce(Bounds::union)?;
    Some(square(all.middle(), all.size().max_element().max(f64::MIN_POSITIVE) * (1.0 + 2.0 * MARGIN)))
}

/// The side of a square, with a margin, that all of some extents fit into; one that is [`LARGEST`] times as long as the lower median
/// does not count.
fn common_side(extents: impl Iterator<Item = f64>) -> f64 {
    let mut extents: Vec<f64> = extents.filter(|extent| extent.is_finite()).collect();
    extents.sort_by(f64::total_cmp);
    let Some(&largest) = extents.last() else { return 1.0 };
    let median = extents[(extents.len() - 1) / 2];
    let extent = if median > 0.0 { largest.min(LARGEST * median) } else { largest };
    extent.max(f64::MIN_POSITIVE) * (1.0 + 2.0 * MARGIN)
}

/// The area that an embedding covers, folds counted as often as they lie there.
fn area(given: &DiskMesh, outcome: &Outcome) -> f64 {
    let embedding = &outcome.step.candidate.solution.embedding;
    let covered = |corners: &[VertexId; 3]| double_area(corners.map(|v| embedding[v])).abs();
    outcome.step.candidate.mesh(given).mesh().real_triangles().iter().map(covered).sum::<f64>() / 2.0
}
