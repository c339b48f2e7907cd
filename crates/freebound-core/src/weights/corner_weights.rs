//! Three-point weights of a triangle corner: what it adds to the equation of its vertex.
//!
//! # Equation
//!
//! For a triangle (0, 1, 2), counter-clockwise, with angle α at 0, the identity (paper, eq. 1) reads
//!
//! ```text
//! k₂ (z₂−z₀) + k₁ (z₁−z₀) + i·( d₂ (z₂−z₀)/r₂ − d₁ (z₁−z₀)/r₁ ) = 0
//! k₂ = (d₁/sin α − d₂ cot α)/r₂        k₁ = (d₂/sin α − d₁ cot α)/r₁
//! ```
//!
//! Points of the plane are complex numbers here, and the paper's R⁹⁰ is multiplication by i. Summed over the
//! triangles around a vertex the i-terms telescope: they vanish inside (eq. 2) and leave the natural boundary
//! condition on the boundary (eq. 3).
//!
//! Eq. (2) as printed keeps two of the four terms of λ, and the Wachspress weight as printed has r for r²; the
//! formulas above follow from eq. (1), and `tests/core/weights.rs` shows that they reproduce planar rings.
//!
//! # Symbols
//!
//! | paper  | code             | meaning                            | unit         |
//! |--------|------------------|------------------------------------|--------------|
//! | r₁, r₂ | `radii`          | lengths of the corner's two edges  | length       |
//! | α      | `cross`, `dot`   | angle at the corner, in (0, π)     | length²      |
//! | β, γ   | `far_dots`       | angles at the far ends             | length²      |
//! | d      | rᵖ               | offset along an edge               | lengthᵖ      |
//! | k₁, k₂ | `CornerWeights`  | shares of the two edges            | lengthᵖ⁻¹    |

use glam::DVec3;

use crate::problem::Family;

/// Bound on cotangents and on tangents of half angles. Corners beyond it are degenerate in 64 bits.
const BOUND: f64 = 1e12;

/// Triangle corner as input of the weights. No angles are computed, so nothing cancels near 0 and π.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Lengths of the edges to the next and to the previous corner.
    pub radii: [f64; 2],
    /// Length of the edges' cross product, `r₁ r₂ sin α`, twice the triangle's area.
    pub cross: f64,
    /// Dot product of the two edges, `r₁ r₂ cos α`.
    pub dot: f64,
    /// Dot products of the edges that meet at the next and at the previous corner.
    pub far_dots: [f64; 2],
}

impl Corner {
    /// Corner at `x[0]` of a triangle.
    pub fn at(x: [DVec3; 3]) -> Self {
        let (to_next, to_previous, across) = (x[1] - x[0], x[2] - x[0], x[2] - x[1]);
        Self {
            radii: [to_next.length(), to_previous.length()],
            cross: to_next.cross(to_previous).length(),
            dot: to_next.dot(to_previous),
            far_dots: [-to_next.dot(across), to_previous.dot(across)],
        }
    }

    /// tan(α/2), without cancellation at either end of the range.
    pub fn tan_half(&self) -> f64 {
        let product = self.radii[0] * self.radii[1];
        if self.dot > 0.0 { self.cross / (product + self.dot) } else { (product - self.dot) / self.cross }
    }

    /// cot α, and true if it was bounded.
    pub fn cotangent(&self) -> (f64, bool) {
        bounded(self.dot / self.cross)
    }
}

/// Clamps a ratio to the bound. Returns true if the bound was hit.
pub(crate) fn bounded(ratio: f64) -> (f64, bool) {
    // `clamp` keeps a NaN, but 0/0 is as degenerate as infinity.
    let kept = if ratio.is_nan() { BOUND } else { ratio.clamp(-BOUND, BOUND) };
    (kept, kept.to_bits() != ratio.to_bits())
}

/// Contribution of a corner to the coefficients of its two edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerWeights<T = f64> {
    /// Shares of the edges to the next and to the previous corner: k₁ and k₂.
    pub shares: [T; 2],
    /// True if the corner is degenerate and its weight was bounded.
    pub bounded: bool,
}

/// Shares k₁, k₂ of a corner for the offset d = rᵖ.
pub fn three_point_weights(corner: &Corner, power: f64) -> CornerWeights {
    let Corner { radii: [r1, r2], cross, far_dots, .. } = *corner;
    let mut was_bounded = false;
    let mut bound = |ratio: f64| {
        let (kept, hit) = bounded(ratio);
        was_bounded |= hit;
        kept
    };
    let shares = if power == Family::CONFORMAL_POWER {
        // k₂ is the cotangent at the next corner, opposite the edge to the previous corner; k₁ is the one at the
        // previous corner.
        [bound(far_dots[1] / cross), bound(far_dots[0] / cross)]
    } else if power == Family::WACHSPRESS_POWER {
        [bound(far_dots[0] / cross) / (r1 * r1), bound(far_dots[1] / cross) / (r2 * r2)]
    } else {
        let tan_half = bound(corner.tan_half());
        let [d1, d2] = [r1.powf(power), r2.powf(power)];
        // d₁/sin α − d₂ cot α = (d₁ − d₂)/sin α + d₂ tan(α/2): the second term is the mean value weight.
        let slope = if power == 0.0 { 0.0 } else { (d1 - d2) * bound(r1 * r2 / cross) };
        [(d1 * tan_half - slope) / r1, (d2 * tan_half + slope) / r2]
    };
    CornerWeights { shares, bounded: was_bounded }
}
