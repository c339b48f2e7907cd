//! The numbers of this layer: `f64` and `Complex<f64>`, and `f32` for factors of which a few digits are enough.

use num_complex::Complex;

/// A number that a Cholesky factor can be made of.
pub trait Number: faer::traits::ComplexField + nalgebra::ComplexField<RealField: Copy> + Copy {
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;
}

/// An entry of a matrix: `f64` or `Complex<f64>`.
pub trait Scalar: Number + faer::traits::ComplexField<Real = f64> + nalgebra::ComplexField<RealField = f64> {
    /// The larger of |re| and |im|: within √2 of the modulus, and it neither overflows nor underflows.
    fn size(self) -> f64;
}

impl Number for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl Number for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl Number for Complex<f64> {
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);
}

impl Scalar for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for Complex<f64> {
    fn size(self) -> f64 {
        self.re.abs().max(self.im.abs())
    }
}
