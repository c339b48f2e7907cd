//! Sign of the area of a triangle, exact for every finite input.
//!
//! # Equation
//!
//! ```text
//! orientation(a, b, c) = sign( (bₓ − aₓ)(c_y − a_y) − (b_y − a_y)(cₓ − aₓ) )
//! ```
//!
//! # Method
//!
//! Shewchuk's adaptive predicate (crate `robust`) is exact unless something underflows or overflows. It is used if
//! every coordinate is 0 or lies within 2⁻⁴⁰⁰ … 2⁴⁰⁰ ([`LEAST`], [`GREATEST`]), because in this range
//!
//! * all coordinates, their differences and the rounding errors of the differences are multiples of 2⁻⁴⁵²; all
//!   products and their rounding errors are multiples of 2⁻⁹⁰⁴. Nothing is lost: the least positive number is
//!   2⁻¹⁰⁷⁴;
//! * the error bounds of the predicate are such a multiple times at least 2⁻¹⁰⁶, a normal number (2⁻¹⁰²² or more);
//! * differences are at most 2⁴⁰¹ and sums of two products at most 2⁸⁰³; splitting a factor multiplies it by 2²⁷:
//!   nothing comes near 2¹⁰²⁴.
//!
//! Otherwise the coordinates are written as integers times a common power of two, and the determinant is computed in
//! arbitrary-precision integers.
//!
//! Source: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.

use glam::DVec2;
use num_bigint::{BigInt, Sign};

/// Least nonzero magnitude for the adaptive predicate: 2⁻⁴⁰⁰.
const LEAST: f64 = f64::from_bits((1023 - 400) << 52);

/// Greatest magnitude for the adaptive predicate: 2⁴⁰⁰.
const GREATEST: f64 = f64::from_bits((1023 + 400) << 52);

/// Key for the equality of points: their bits, except that −0 equals 0.
pub(crate) fn point_key(z: DVec2) -> [u64; 2] {
    (z + DVec2::ZERO).to_array().map(f64::to_bits)
}

/// Twice the signed area of a triangle, rounded: negative if the triangle turns right.
pub fn double_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Orientation of three points in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// Left turn: the area of the triangle is positive.
    CounterClockwise,
    /// Right turn: the area of the triangle is negative.
    Clockwise,
    /// Points on one line, including points that coincide.
    Collinear,
}

/// Exact orientation of three points; `None` if a coordinate is infinite or not a number.
pub fn orientation(a: DVec2, b: DVec2, c: DVec2) -> Option<Orientation> {
    let coordinates = [a.x, a.y, b.x, b.y, c.x, c.y];
    if coordinates.iter().all(|&v| v == 0.0 || (LEAST..=GREATEST).contains(&v.abs())) {
        let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
        let area = robust::orient2d(coord(a), coord(b), coord(c));
        return Some(if area > 0.0 {
            Orientation::CounterClockwise
        } else if area < 0.0 {
            Orientation::Clockwise
        } else {
            Orientation::Collinear
        });
    }
    coordinates.iter().all(|v| v.is_finite()).then(|| orientation_in_integers(coordinates))
}

/// Sign of the determinant in arbitrary-precision integers.
fn orientation_in_integers(coordinates: [f64; 6]) -> Orientation {
    let parts = coordinates.map(integer_and_exponent);
    let lowest = parts.iter().filter(|(integer, _)| *integer != 0).map(|&(_, exponent)| exponent).min().unwrap_or(0);
    let [ax, ay, bx, by, cx, cy] = parts.map(|(integer, exponent)| {
        // The exponent of a zero may lie below the lowest; shifting a zero has no effect.
        BigInt::from(integer) << exponent.saturating_sub(lowest)
    });
    let area = (bx - &ax) * (cy - &ay) - (by - &ay) * (cx - &ax);
    match area.sign() {
        Sign::Plus => Orientation::CounterClockwise,
        Sign::Minus => Orientation::Clockwise,
        Sign::NoSign => Orientation::Collinear,
    }
}

/// Decomposition of a finite number into integer · 2^(exponent − 1075); the exponent is at least 1.
pub(super) fn integer_and_exponent(value: f64) -> (i64, u32) {
    const FRACTION_BITS: u32 = 52;
    let bits = value.to_bits();
    let fraction = (bits & ((1 << FRACTION_BITS) - 1)).cast_signed();
    let exponent = u32::try_from((bits >> FRACTION_BITS) & 0x7ff).expect("eleven bits fit");
    // Subnormal numbers have the exponent of the least normal numbers and no hidden bit.
    let magnitude = if exponent == 0 { fraction } else { fraction | (1 << FRACTION_BITS) };
    (if value.is_sign_negative() { -magnitude } else { magnitude }, exponent.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_their_integer_form_and_come_back() {
        for value in [1.0, -0.75, 5e-324, -2.5e-310, f64::MIN_POSITIVE, f64::MAX, 0.0] {
            let (integer, exponent) = integer_and_exponent(value);
            // Two steps, since 2^(exponent − 1075) alone may be beyond the range of numbers.
            let exponent = exponent.cast_signed() - 1075;
            let back = integer as f64 * 2_f64.powi(exponent / 2) * 2_f64.powi(exponent - exponent / 2);
            assert_eq!(back.to_bits(), value.to_bits(), "{value:e}");
        }
    }
}
