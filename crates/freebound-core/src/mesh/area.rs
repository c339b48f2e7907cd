//! Test for triangles without area, up to the rounding of their coordinates.
//!
//! # Criterion
//!
//! With `L` the longest edge and `M` the largest absolute coordinate, a triangle has zero area if
//!
//! ```text
//! |(b − a) × (c − a)| ≤ 4 ε L M
//! ```
//!
//! `M` is at least the smallest normal number. In other words, the height over `L` is at most 4 ε M. A coordinate as
//! large as `M` is itself exact to ε M / 2 only. So the corners lie on one line up to the rounding of the coordinates.
//! Coincident corners and exactly collinear corners always satisfy the criterion. A thin triangle that merely *looks*
//! flat does not: its height is many times larger.

use glam::DVec3;

/// Largest height over the longest edge, in units of ε M, at which corners count as collinear.
const COLLINEAR: f64 = 4.0;

/// Coordinates above this bound, or below its reciprocal, are scaled to about 1 before multiplication.
const LARGE: f64 = 1e50;

/// True if three finite points lie on a line up to the rounding of their coordinates.
pub(crate) fn is_zero_area(corners: [DVec3; 3]) -> bool {
    let size = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // Coordinates below the smallest normal number all round to one step: ε times that number.
    let size = size.max(f64::MIN_POSITIVE);
    if size > LARGE || size < LARGE.recip() {
        // Divides twice because the reciprocal of a subnormal number is infinite. A power of two rounds nothing.
        let half = (size.log2() / 2.0).round().exp2();
        return flat(corners.map(|p| p / half / half), size / half / half);
    }
    flat(corners, size)
}

fn flat([a, b, c]: [DVec3; 3], size: f64) -> bool {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = ab.length_squared().max(ac.length_squared()).max(bc.length_squared()).sqrt();
    ab.cross(ac).length() <= COLLINEAR * f64::EPSILON * longest * size
}
