//! Order of two points along a direction, exact for every finite input.
//!
//! # Equation
//!
//! ```text
//! order = sign( dₓ (bₓ − aₓ) + d_y (b_y − a_y) )
//! ```
//!
//! # Method
//!
//! Two differences, two products and one sum round five times. The error is at most 4 ε of the sum of the magnitudes
//! of the products, unless something underflows. If the sum exceeds this bound, its sign is right. Otherwise the
//! products of the coordinates are written as integers times powers of two and added in arbitrary-precision
//! integers.

use std::cmp::Ordering;

use glam::DVec2;
use num_bigint::{BigInt, Sign};

use super::orient::integer_and_exponent;

/// Bound of the rounding error of the sum, relative to the sum of the magnitudes of the products.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Sum of magnitudes above which underflow is negligible beside [`ROUNDING`].
const LEAST_SIZE: f64 = 1e-280;

/// Order of two points along a direction, which need not have unit length. `None` if a coordinate is infinite or not
/// a number.
pub fn order_along(direction: DVec2, a: DVec2, b: DVec2) -> Option<Ordering> {
    let terms = direction * (b - a);
    let (sum, size) = (terms.x + terms.y, terms.x.abs() + terms.y.abs());
    if size.is_finite() && size > LEAST_SIZE && sum.abs() > ROUNDING * size {
        return sum.partial_cmp(&0.0);
    }
    let is_finite = direction.is_finite() && a.is_finite() && b.is_finite();
    is_finite.then(|| order_in_integers(direction, a, b))
}

/// Sign of the sum in arbitrary-precision integers.
fn order_in_integers(direction: DVec2, a: DVec2, b: DVec2) -> Ordering {
    let products = [(direction.x, b.x), (-direction.x, a.x), (direction.y, b.y), (-direction.y, a.y)];
    let products = products.map(|(d, z)| {
        let ((d, d_exponent), (z, z_exponent)) = (integer_and_exponent(d), integer_and_exponent(z));
        (BigInt::from(d) * BigInt::from(z), d_exponent + z_exponent)
    });
    let lowest = products.iter().map(|&(_, exponent)| exponent).min().unwrap_or(0);
    let sum: BigInt = products.into_iter().map(|(product, exponent)| product << (exponent - lowest)).sum();
    match sum.sign() {
        Sign::Plus => Ordering::Greater,
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
    }
}
