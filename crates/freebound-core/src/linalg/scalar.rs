//! Number types of this layer: `f64` and `Complex<f64>`, and `f32` for factors of which a few digits are enough.

use num_complex::Complex;

/// Number type of a Cholesky factor.
pub trait Number: faer::traits::ComplexField + nalgebra::ComplexField<RealField: Copy> + Copy {
    /// Type of the real part; the type itself if it is real.
    type Part: Number<Part = Self::Part>;
    /// Additive identity.
    const ZERO: Self;
    /// Multiplicative identity.
    const ONE: Self;
    /// True if the type has an imaginary part.
    const IS_COMPLEX: bool;

    /// Real and imaginary part.
    fn parts(self) -> [Self::Part; 2];

    /// Number with the given real and imaginary parts; a real type ignores the imaginary part.
    fn from_parts(parts: [Self::Part; 2]) -> Self;

    /// Number with a real part alone.
    fn from_real_part(part: Self::Part) -> Self {
        Self::from_parts([part, Self::Part::ZERO])
    }
}

/// Entry of a matrix: `f64` or `Complex<f64>`.
pub trait Scalar:
    Number<Part = f64> + faer::traits::ComplexField<Real = f64> + nalgebra::ComplexField<RealField = f64>
{
    /// Larger of |re| and |im|: within √2 of the modulus, without overflow or underflow.
    fn size(self) -> f64;
}

impl Number for f32 {
    type Part = Self;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const IS_COMPLEX: bool = false;

    fn parts(self) -> [Self; 2] {
        [self, 0.0]
    }

    fn from_parts([real, _]: [Self; 2]) -> Self {
        real
    }
}

impl Number for f64 {
    type Part = Self;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const IS_COMPLEX: bool = false;

    fn parts(self) -> [Self; 2] {
        [self, 0.0]
    }

    fn from_parts([real, _]: [Self; 2]) -> Self {
        real
    }
}

impl Number for Complex<f64> {
    type Part = f64;
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);
    const IS_COMPLEX: bool = true;

    fn parts(self) -> [f64; 2] {
        [self.re, self.im]
    }

    fn from_parts([real, imaginary]: [f64; 2]) -> Self {
        Self::new(real, imaginary)
    }
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
