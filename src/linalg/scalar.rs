//! The two scalars of this layer: `f64` and `Complex<f64>`.

use num_complex::Complex;

/// An entry of a matrix: `f64` or `Complex<f64>`.
pub trait Scalar: faer::traits::ComplexField<Real = f64> + nalgebra::ComplexField<RealField = f64> + Copy {
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;

    /// The larger of |re| and |im|: within √2 of the modulus, and it neither overflows nor underflows.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for Complex<f64> {
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);

    fn size(self) -> f64 {
        self.re.abs().max(self.im.abs())
    }
}
