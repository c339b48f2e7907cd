//! Distortion of an embedding: its deviation from an isometry in angles, areas and stretch, per face and summed up.
//!
//! # Equations
//!
//! On a face the map from the surface to the plane is linear; J is its 2×2 matrix in a frame of the face, and
//! σ₁ ≥ σ₂ ≥ 0 are J's singular values after the embedding was scaled to the total area of the surface, so that no
//! measure depends on the embedding's size. With A the area on the surface and A′ the area in the plane:
//!
//! ```text
//! angle        σ₁ / σ₂                         1 where angles are kept
//! area         σ₁ σ₂ = A′ / A                  1 where the area is kept
//! stretch L²   √((1/σ₁² + 1/σ₂²) / 2)          root mean square length on the surface of unit vectors of the plane
//! stretch L∞   1/σ₂                            the greatest such length
//! symmetric    |J|² + |J⁻¹|², the sum of all σ² and 1/σ²: Dirichlet's energy both ways, 4 where nothing is distorted
//!
//! with J = (a b; c d):    σ₁ = (|(a + d, c − b)| + |(a − d, b + c)|) / 2,    σ₁ σ₂ = |ad − bc|
//! ```
//!
//! Summed up, in the mean a face counts by its area A on the surface:
//!
//! ```text
//! mean q = Σ A q / Σ A      stretch L² = √(Σ A L²² / Σ A)      stretch L∞ = max L∞
//! ```
//!
//! The 99th percentile is weighted alike: the least value that 99 % of the surface does not exceed. The mean of
//! A′/A is 1 whatever the embedding, so areas are summed up as max(A′/A, A/A′), 1 at best as the angles.
//!
//! Source of the stretch: P. Sander, J. Snyder, S. Gortler, H. Hoppe, "Texture Mapping Progressive Meshes", 2001, with
//! Γ = 1/σ₂ and γ = 1/σ₁.
//!
//! # Degenerate faces
//!
//! A needle, a face whose height is less than 10⁻⁴ of its longest side, is measured as if it had that height. The energy
//! of a step of relaxing has the same rest shapes and weights, so that it equals the mean of the report.
//!
//! Areas are unsigned: a flipped face counts as its mirror image does; that it is flipped the verdict tells. A face of
//! area zero in the plane, or with a corner that is not finite, has area 0 and all else infinite. A face of area zero
//! on the surface has no J; its values are all 1 and it does not count in any sum, percentile or maximum. No value is
//! ever NaN. JSON has no infinity and shows `null` for it.

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// Distortion of one face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceDistortion {
    /// σ₁/σ₂, at least 1.
    pub angle: f64,
    /// A′/A at equal total areas: below 1 if the face shrank, above 1 if it grew.
    pub area: f64,
    /// Root mean square stretch from the plane to the surface.
    pub stretch_l2: f64,
    /// Greatest stretch from the plane to the surface.
    pub stretch_linf: f64,
}

impl FaceDistortion {
    /// Symmetric Dirichlet energy |J|² + |J⁻¹|², at least 4.
    pub fn symmetric_dirichlet(&self) -> f64 {
        // |J⁻¹|² is twice the squared mean stretch, and |J| = |J⁻¹| · det J; a face of area zero has no J.
        let forth = if self.area > 0.0 { self.stretch_l2 * self.area } else { 0.0 };
        2.0 * (self.stretch_l2.powi(2) + forth.powi(2))
    }
}

/// Distortion of an embedding.
#[derive(Clone, Debug, PartialEq)]
pub struct Distortion {
    /// Distortion of each face, without the faces that fill holes.
    pub faces: Vec<FaceDistortion>,
    /// All faces together.
    pub summary: DistortionSummary,
}

/// Distortion summed up over the surface; the report's object of that name.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DistortionSummary {
    /// Spread of σ₁/σ₂.
    pub angle: Spread,
    /// Spread of max(A′/A, A/A′).
    pub area: Spread,
    /// Root mean square stretch from the plane to the surface.
    pub stretch_l2: f64,
    /// Greatest stretch from the plane to the surface.
    pub stretch_linf: f64,
    /// Symmetric Dirichlet energy: |J|² + |J⁻¹|².
    pub symmetric_dirichlet: Mean,
}

impl DistortionSummary {
    /// Ratio of areas from which a map needs relaxing: a picture's pixel becomes a patch of ten by ten.
    pub const BAD_RATIO_OF_AREAS: f64 = 100.0;

    /// Greatest ratio of a face's area in the plane to its area on the surface, or the other way round. `None` if the
    /// ratio does not call for relaxing.
    pub fn bad_ratio_of_areas(&self) -> Option<f64> {
        Some(self.area.max).filter(|&ratio| ratio >= Self::BAD_RATIO_OF_AREAS)
    }
}

/// Mean of a quantity over the surface. JSON shows an infinite mean as `null`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Mean {
    /// Mean, weighted by area on the surface.
    pub mean: f64,
}

/// Spread of a quantity over the surface. JSON shows infinite values as `null`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spread {
    /// Mean, weighted by area on the surface.
    pub mean: f64,
    /// Least value that 99 % of the surface does not exceed.
    pub p99: f64,
    /// Greatest value.
    pub max: f64,
}

/// Measures the distortion of an embedding.
///
/// # Panics
///
/// If the embedding does not have one position per vertex.
pub fn distortion(mesh: &DiskMesh, embedding: &Embedding) -> Distortion {
    assert_eq!(embedding.len(), mesh.vertex_count(), "an embedding has one position per vertex");
    let maps = face_maps(mesh, embedding);
    let total = |of: fn(&FaceMap) -> f64| maps.iter().map(of).filter(|area| area.is_finite()).sum::<f64>();
    let (area_in_embedding, area) = (total(|map| map.double_area * map.determinant), total(|map| map.double_area));
    // Multiplies a squared length in the plane to make the total areas equal.
    let scale = area / area_in_embedding;
    let faces: Vec<FaceDistortion> =
        maps.par_iter().with_min_len(FACES_PER_TASK).map(|map| map.distortion(scale)).collect();
    let summary = summary(&faces, &maps);
    Distortion { faces, summary }
}

/// Linear map of one face, in units of the extents of surface and embedding.
#[derive(Clone, Copy)]
struct FaceMap {
    /// Twice the area on the surface; 0 if it cannot be told from 0.
    double_area: f64,
    /// |det J|.
    determinant: f64,
    /// σ₁.
    greater: f64,
}

/// Number of faces in one task.
const FACES_PER_TASK: usize = 4096;

fn face_maps(disk: &DiskMesh, embedding: &Embedding) -> Vec<FaceMap> {
    let mesh = disk.mesh();
    let extent = |greatest: f64, size: f64| if size.is_finite() { greatest.max(size) } else { greatest };
    let in_space =
        reciprocal(mesh.positions.iter().map(|&p| (p - mesh.positions[0]).abs().max_element()).fold(0.0, extent));
    let origin = embedding.iter().copied().find(|p| p.is_finite()).unwrap_or_default();
    let in_plane = reciprocal(embedding.iter().map(|&p| (p - origin).abs().max_element()).fold(0.0, extent));
    let map = |triangle: &[VertexId; 3]| {
        let corners = disk.rest_shape(*triangle, in_space);
        let images = triangle.map(|v| embedding[v]);
        FaceMap::new([1, 2].map(|k| corners[k] - corners[0]), [1, 2].map(|k| (images[k] - images[0]) * in_plane))
    };
    mesh.real_triangles().par_iter().with_min_len(FACES_PER_TASK).map(map).collect()
}

/// Reciprocal of an extent, kept finite, so that squares of lengths neither underflow nor overflow.
fn reciprocal(extent: f64) -> f64 {
    /// Greatest factor, 1/length: an extent below its reciprocal is as good as zero beside any other.
    const GREATEST: f64 = 1e307;
    extent.recip().min(GREATEST)
}

impl FaceMap {
    /// Linear map that takes two edges of a face, from one corner, to two edges in the plane.
    fn new([first, second]: [DVec2; 2], [first_in_plane, second_in_plane]: [DVec2; 2]) -> Self {
        let double_area = first.perp_dot(second);
        let length = first.length();
        // J takes (length, 0) and (along, height) to the edges in the plane.
        let (along, height) = (first.dot(second) / length, double_area / length);
        let column = first_in_plane / length;
        let other = (second_in_plane - column * along) / height;
        let determinant = (first_in_plane.perp_dot(second_in_plane) / double_area).abs();
        let like_turn = DVec2::new(column.x + other.y, column.y - other.x);
        let like_mirror = DVec2::new(column.x - other.y, column.y + other.x);
        Self { double_area, determinant, greater: f64::midpoint(like_turn.length(), like_mirror.length()) }
    }

    /// Measures of the face. `scale` multiplies squared lengths in the plane.
    fn distortion(self, scale: f64) -> FaceDistortion {
        let Self { double_area, determinant, greater } = self;
        if double_area == 0.0 {
            return FaceDistortion { angle: 1.0, area: 1.0, stretch_l2: 1.0, stretch_linf: 1.0 };
        }
        if !(determinant > 0.0 && determinant.is_finite() && greater.is_finite() && scale.is_finite()) {
            let infinite = f64::INFINITY;
            return FaceDistortion { angle: infinite, area: 0.0, stretch_l2: infinite, stretch_linf: infinite };
        }
        // Not the difference of the two lengths, which cancels.
        let lesser = determinant / greater;
        FaceDistortion {
            angle: (greater / lesser).max(1.0),
            area: determinant * scale,
            stretch_l2: greater.hypot(lesser) / (determinant * (2.0 * scale).sqrt()),
            stretch_linf: 1.0 / (lesser * scale.sqrt()),
        }
    }
}

fn summary(faces: &[FaceDistortion], maps: &[FaceMap]) -> DistortionSummary {
    // No list is collected: its memory would cost more time than the numbers.
    fn weighted<'a>(
        faces: &'a [FaceDistortion],
        maps: &'a [FaceMap],
        of: fn(&FaceDistortion) -> f64,
    ) -> impl Iterator<Item = (f64, f64)> + Clone {
        let counts = |&(_, map): &(&FaceDistortion, &FaceMap)| map.double_area > 0.0;
        faces.iter().zip(maps).filter(counts).map(move |(face, map)| (of(face), map.double_area))
    }
    let weighted = |of: fn(&FaceDistortion) -> f64| weighted(faces, maps, of);
    let spreads = || {
        crate::parallel::join(
            || Spread::new(weighted(|face| face.angle).collect()),
            || Spread::new(weighted(|face| face.area.max(face.area.recip())).collect()),
        )
    };
    let means = || {
        crate::parallel::join(
            || mean(weighted(|face| face.stretch_l2.powi(2))).sqrt(),
            // A quarter of the energy is 1 without distortion, as are all other values.
            || mean(weighted(|face| face.symmetric_dirichlet() / 4.0)),
        )
    };
    let ((angle, area), (stretch_l2, quarter)) = crate::parallel::join(spreads, means);
    let stretch_linf = weighted(|face| face.stretch_linf).map(|(value, _)| value).fold(1.0, f64::max);
    DistortionSummary { angle, area, stretch_l2, stretch_linf, symmetric_dirichlet: Mean { mean: 4.0 * quarter } }
}

/// Mean of values with positive weights; 1 if there are none.
fn mean(weighted: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let total: f64 = weighted.clone().map(|(_, weight)| weight).sum();
    if weighted.clone().next().is_none() {
        return 1.0;
    }
    weighted.map(|(value, weight)| value * weight).sum::<f64>() / total
}

impl Spread {
    /// Spread of values with positive weights; 1 if there are none.
    fn new(mut weighted: Vec<(f64, f64)>) -> Self {
        /// Share of the surface that may exceed the percentile.
        const BEYOND: f64 = 0.01;
        /// Divisor of the number of values: the first search covers this share of them, the greatest. On faces of
        /// like size it finds the percentile.
        const FIRST_LOOK: usize = 64;
        if weighted.is_empty() {
            return Self { mean: 1.0, p99: 1.0, max: 1.0 };
        }
        let total: f64 = weighted.iter().map(|&(_, weight)| weight).sum();
        let mean = mean(weighted.iter().copied());
        // Equal values are ordered by their weights, so that sums do not depend on the selection of the greatest
        // values.
        let descending =
            |first: &(f64, f64), second: &(f64, f64)| second.0.total_cmp(&first.0).then(second.1.total_cmp(&first.1));
        let mut count = weighted.len() / FIRST_LOOK;
        loop {
            if count < weighted.len() {
                weighted.select_nth_unstable_by(count, descending);
            }
            let greatest = &mut weighted[..count];
            greatest.sort_unstable_by(descending);
            let mut above = 0.0;
            let p99 = greatest.iter().find(|&&(_, weight)| {
                above += weight;
                above > BEYOND * total
            });
            let p99 = p99.map(|&(value, _)| value);
            if p99.is_some() || count == weighted.len() {
                let max = weighted[0].0;
                return Self { mean, p99: p99.unwrap_or(max), max };
            }
            count = (4 * count).clamp(1, weighted.len());
        }
    }
}
