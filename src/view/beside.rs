//! Frames for several embeddings of one mesh side by side under one camera. Each frame maps an embedding's own plane
//! to a common plane that the camera shows.

use glam::DVec2;

use super::PlaneCamera;
use freebound_core::geom::{Bounds, double_area};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Outcome;

/// Margin around an embedding, relative to its extent.
const MARGIN: f64 = 0.04;

/// Largest embedding that is shown whole, as a multiple of the lower median extent. A larger embedding is cropped,
/// so that the others stay readable.
const LARGEST: f64 = 2.5;

/// Similarity from the common plane to the plane of one embedding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellFrame {
    /// Point of the embedding at the origin of the common plane.
    origin: DVec2,
    /// Embedding units per unit of the common plane.
    size: f64,
}

/// Frames of several embeddings in one common plane.
#[derive(Clone, Debug, PartialEq)]
pub struct CellFrames {
    /// Frame of each embedding.
    pub frames: Vec<CellFrame>,
    /// Part of the common plane to show.
    pub bounds: Bounds,
}

impl CellFrame {
    /// Returns the point of the embedding at a point of the common plane.
    pub fn own(self, common: DVec2) -> DVec2 {
        self.origin + self.size * common
    }

    /// Embedding units per unit of the common plane.
    pub fn size(self) -> f64 {
        self.size
    }

    /// Returns the camera that shows the embedding as `camera` shows the common plane.
    pub fn camera(self, camera: &PlaneCamera) -> PlaneCamera {
        camera.over_similar(self.origin, self.size)
    }
}

impl CellFrames {
    /// Lays out the steps `outcomes` on the mesh `given`. Embeddings held by pins keep their position. Every other
    /// embedding is centred on the middle of its bounding box. It keeps its size if pins hold no embedding;
    /// otherwise it is scaled to the area of the first held embedding.
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

/// Returns the square with the given middle and side.
fn square(middle: DVec2, side: f64) -> Bounds {
    let half = DVec2::splat(side / 2.0);
    Bounds { low: middle - half, high: middle + half }
}

/// Returns the square around boxes, leaving out boxes much larger than the others; `None` for no boxes.
fn around(boxes: &[Bounds]) -> Option<Bounds> {
    let side = common_side(boxes.iter().map(|bounds| bounds.size().max_element()));
    let usual = boxes.iter().filter(|bounds| bounds.size().max_element() <= side);
    let all = usual.copied().reduce(Bounds::union)?;
    Some(square(all.middle(), all.size().max_element().max(f64::MIN_POSITIVE) * (1.0 + 2.0 * MARGIN)))
}

/// Returns the side of a square, margin included, that fits the extents. An extent above [`LARGEST`] times the lower
/// median is cut off there.
fn common_side(extents: impl Iterator<Item = f64>) -> f64 {
    let mut extents: Vec<f64> = extents.filter(|extent| extent.is_finite()).collect();
    extents.sort_by(f64::total_cmp);
    let Some(&largest) = extents.last() else { return 1.0 };
    let median = extents[(extents.len() - 1) / 2];
    let extent = if median > 0.0 { largest.min(LARGEST * median) } else { largest };
    extent.max(f64::MIN_POSITIVE) * (1.0 + 2.0 * MARGIN)
}

/// Area covered by an embedding, with overlaps counted repeatedly.
fn area(given: &DiskMesh, outcome: &Outcome) -> f64 {
    let embedding = &outcome.step.candidate.solution.embedding;
    let covered = |corners: &[VertexId; 3]| double_area(corners.map(|v| embedding[v])).abs();
    outcome.step.candidate.mesh(given).mesh().real_triangles().iter().map(covered).sum::<f64>() / 2.0
}
