//! The two scalars of this layer: `f64` and `Complex<f64>`.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use faer::traits::ComplexField;
use num_complex::Complex;

mod private {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for num_complex::Complex<f64> {}
}

/// An entry of a matrix: `f64` or `Complex<f64>`.
pub trait Scalar:
    private::Sealed
    + ComplexField
    + Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + MulAssign
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;

    /// A real number as a scalar.
    fn from_real(value: f64) -> Self;
    /// The real part.
    fn real_part(self) -> f64;
    /// The complex conjugate.
    #[must_use]
    fn conjugated(self) -> Self;
    /// Product with a real number.
    #[must_use]
    fn scaled(self, factor: f64) -> Self;
    /// The larger of |re| and |im|: within √2 of the modulus, and it neither overflows nor underflows.
    fn size(self) -> f64;
    /// Squared modulus.
    fn squared_modulus(self) -> f64;
    /// Whether both parts are finite.
    fn is_finite_scalar(self) -> bool;
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    fn from_real(value: f64) -> Self {
        value
    }
    fn real_part(self) -> f64 {
        self
    }
    fn conjugated(self) -> Self {
        self
    }
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn size(self) -> f64 {
        self.abs()
    }
    fn squared_modulus(self) -> f64 {
        self * self
    }
    fn is_finite_scalar(self) -> bool {
        self.is_finite()
    }
}

impl Scalar for Complex<f64> {
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);

    fn from_real(value: f64) -> Self {
        Self::new(value, 0.0)
    }
    fn real_part(self) -> f64 {
        self.re
    }
    fn conjugated(self) -> Self {
        self.conj()
    }
    fn scaled(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }
    fn size(self) -> f64 {
        self.re.abs().max(self.im.abs())
    }
    fn squared_modulus(self) -> f64 {
        self.norm_sqr()
    }
    fn is_finite_scalar(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}
