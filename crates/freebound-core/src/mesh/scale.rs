//! Scaling of extremely large and small meshes to the middle of the range of numbers.

use glam::DVec3;

/// Largest size that is not scaled; the smallest is its reciprocal. Fourth powers of such sizes are normal numbers.
const LARGE: f64 = (1_u128 << 100) as f64;

/// Largest exponent of a power of two whose reciprocal is a normal number.
const GREATEST: f64 = 1022.0;

/// Divides positions by a power of two and returns it; 1 if their size is within the middle range already. Nothing is
/// rounded, except for coordinates that underflow beside the largest.
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
