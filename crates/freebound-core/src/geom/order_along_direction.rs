//! How two points follow each other along a direction, exact for every finite input.
//!
//! # Equation
//!
//! ```text
//! order = sign( dₓ (bₓ − aₓ) + d_y (b_y − a_y) )
//! ```
//!
//! # Method
//!
//! Two differences, two products and one sum round five times: by at most 4 ε of the sum of the products' sizes, as long as nothing
//! underflows. Where the sum is larger than that its sign is right; elsewhere the products of the coordinates are written
//! as integers times powers of two, and added in integers of any length.

use std::cmp::Ordering;

use glam::DVec2;
use num_bigint::{BigInt, Sign};

use super::orient::integer_and_exponent;

/// Bound of the rounding of the sum, relative to the sum of the products' sizes.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Sums of sizes from here on have lost nothing by underflow that matters beside [`ROUNDING`].
const LEAST_SIZE: f64 = 1e-280;

/// How two points follow each other along a direction, which need have no unit length; `None` where a coordinate is infinite
/// or not a number.
pub fn order_along(direction: DVec2, a: DVec2, b: DVec2) -> Option<Ordering> {
    let terms = direction * (b - a);
    let (sum, size) = (terms.x + terms.y, terms.x.abs() + terms.y.abs());
    if size.is_finite() && size > LEAST_SIZE && sum.abs() > ROUNDING * size {
        return sum.partial_cmp(&0.0);
    }
    let is_finite = direction.is_finite() && a.is_finite() && b.is_finite();
    is_finite.then(|| order_in_integers(direction, a, b))
}

/// The sign of the sum by integers of any length.
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
