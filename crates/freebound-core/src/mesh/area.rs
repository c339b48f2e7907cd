//! Whether a triangle has an area at all, as far as its coordinates can tell.
//!
//! # Criterion
//!
//! With `L` the longest edge and `M` the largest coordinate by amount, a triangle has zero area where
//!
//! ```text
//! |(b − a) × (c − a)| ≤ 4 ε L M
//! ```
//!
//! (`M` at least the smallest normal number), that is, where its height over `L` is at most 4 ε M. A coordinate as large as `M` is itself known to ε M / 2 only,
//! so the corners lie on one line up to the rounding of the coordinates. Coincident corners and exactly collinear ones
//! always satisfy it. A thin triangle that merely *looks* flat does not: its height is many times larger.

use glam::DVec3;

/// Height over the longest edge, in units of ε M, up to which corners count as collinear.
const COLLINEAR: f64 = 4.0;

/// Coordinates beyond this, or below its reciprocal, are brought near 1 before they are multiplied.
const LARGE: f64 = 1e50;

/// Whether three finite points lie on a line up to the rounding of their coordinates.
pub(super) fn is_zero_area(corners: [DVec3; 3]) -> bool {
    let size = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // Coordinates below the smallest normal number are all rounded to the same step, ε times that number.
    let size = size.max(f64::MIN_POSITIVE);
    if size > LARGE || size < LARGE.recip() {
        // Twice, because the reciprocal of a subnormal number is infinite. A power of two: nothing is rounded.
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
