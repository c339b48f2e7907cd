//! Meshes of the largest and smallest sizes, in units that bring them to the middle of the range of numbers.

use glam::DVec3;

/// Sizes from its reciprocal up to this are left as they are: fourth powers of them are still normal numbers.
const LARGE: f64 = (1_u128 << 100) as f64;

/// The greatest power of two, as an exponent, that has a normal number for its reciprocal.
const GREATEST: f64 = 1022.0;

/// Divides positions by a power of two, which is returned: 1 where they lie in the middle of the range already. Nothing is
/// rounded, but for coordinates that vanish beside the largest.
pub(super) fn take_unit(positions: &mut [DVec3]) -> f64 {
    let size = positions.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if size == 0.0 || (LARGE.recip()..=LARGE).contains(&size) {
        return 1.0;
    }
    let unit = size.log2().round().clamp(-GREATEST, GREATEST).exp2();
    for position in positions {
        *position /= unit;
    }
    unit
}
