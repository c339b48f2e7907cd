//! The energy that keeps faces from folding: its value and derivatives for one triangle.
//!
//! ```text
//! f(J) = ½ tr(JᵀJ)/χ(det J) + ½ (det²J + 1)/χ(det J),     χ(d) = (d + √(ε² + d²))/2
//! ```
//!
//! Source: V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in 50 lines of
//! code", 2021. With ε = 0 it is a barrier: infinite where a triangle has no area. With ε > 0 it is finite everywhere,
//! and pulls folded triangles back.
//!
//! # In complex numbers
//!
//! The map of a triangle has the derivatives α = ∂z/∂w and β = ∂z/∂w̄, and with p = |α|², q = |β|²
//!
//! ```text
//! tr(JᵀJ) = 2 (p + q),   det J = p − q,   f = (p + q + ½ (det²J + 1)) / χ(det J)
//! ```
//!
//! So f is a function of p and q alone, and its Hessian in (α, β) falls into three parts that are known in closed
//! form: 2 ∂f/∂p along iα, 2 ∂f/∂q along iβ, and a 2×2 matrix in the directions of α and β. Parts that are not
//! positive are made so, which gives a descent direction for Newton's method (A. Shtengel et al., "Geometric
//! optimization via composite majorization", 2017; B. Smith et al., "Analytic eigensystems for isotropic distortion
//! energies", 2019).

use glam::DVec2;

use super::energy_problem::Damped;

/// Resistance of an element to distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Factor of the energy.
    pub weight: f64,
    /// Smallest ratio of height to longest side. The energy of a thinner rest shape is computed as if it had this
    /// ratio.
    pub thinnest: f64,
}

/// A triangle with its rest shape.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Corners of the element, as numbers of points.
    pub corners: [u32; 3],
    /// Gradients of the three hat functions on the rest shape.
    gradients: [DVec2; 3],
    /// Factor of the element's energy.
    weight: f64,
}

/// A second-order model of an element's energy: coordinates x and y of each corner in turn.
#[derive(Clone, Debug)]
pub struct EnergyModel {
    /// Gradient.
    pub gradient: [f64; 6],
    /// Hessian, made positive semidefinite; symmetric.
    pub hessian: [[f64; 6]; 6],
}

/// Derivatives of f by p and q, of first and second order.
struct Terms {
    p: f64,
    q: f64,
    pp: f64,
    pq: f64,
    qq: f64,
}

/// 1/χ(d) without cancellation, and √(ε² + d²).
fn inverse_chi(d: f64, epsilon: f64) -> (f64, f64) {
    let root = d.hypot(epsilon);
    // (√ + d)(√ − d) = ε².
    let inverse = if d >= 0.0 { 2.0 / (d + root) } else { 2.0 * (root - d) / (epsilon * epsilon) };
    (inverse, root)
}

/// Energy of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// Energy f with this ε.
    Foldover(f64),
    /// ½ (tr(JᵀJ) + tr(J⁻ᵀJ⁻¹)), the symmetric Dirichlet energy: a barrier too, and larger on small triangles.
    SymmetricDirichlet,
    /// ½ (tr(JᵀJ)/σ + σ tr(J⁻ᵀJ⁻¹)) + p det J: symmetric Dirichlet energy of a rest shape with σ times the area, plus
    /// a pressure p on the image's area.
    AtSize {
        /// Factor σ, positive.
        size: f64,
        /// Pressure p of any sign. If positive, its energy falls as the triangle shrinks.
        pressure: f64,
    },
}

impl Energy {
    /// True if the energy is infinite on folded triangles.
    pub fn is_barrier(self) -> bool {
        matches!(self, Self::SymmetricDirichlet | Self::AtSize { .. } | Self::Foldover(0.0))
    }

    /// Value of the energy by s = p + q and d = p − q.
    fn value(self, s: f64, d: f64) -> f64 {
        match self {
            _ if self.is_barrier() && d <= 0.0 => f64::INFINITY,
            Self::Foldover(epsilon) => (s + 0.5 * (d * d + 1.0)) * inverse_chi(d, epsilon).0,
            Self::SymmetricDirichlet => s * (1.0 + d.powi(-2)),
            Self::AtSize { size, pressure } => s * (size.recip() + size * d.powi(-2)) + pressure * d,
        }
    }

    fn terms(self, s: f64, d: f64) -> Terms {
        match self {
            Self::Foldover(epsilon) => {
                let (u, root) = inverse_chi(d, epsilon);
                let (du, ddu) = (-u / root, 2.0 / (root * root * root));
                let n = s + 0.5 * (d * d + 1.0);
                Terms {
                    p: (1.0 + d) * u + n * du,
                    q: (1.0 - d) * u - n * du,
                    pp: u + 2.0 * (1.0 + d) * du + n * ddu,
                    pq: -u - 2.0 * d * du - n * ddu,
                    qq: u - 2.0 * (1.0 - d) * du + n * ddu,
                }
            }
            Self::SymmetricDirichlet => Self::AtSize { size: 1.0, pressure: 0.0 }.terms(s, d),
            Self::AtSize { size, pressure } => {
                let v = size.recip() + size * d.powi(-2);
                let (dv, ddv) = (-2.0 * size * d.powi(-3), 6.0 * size * d.powi(-4));
                Terms {
                    p: v + s * dv + pressure,
                    q: v - s * dv - pressure,
                    pp: 2.0 * dv + s * ddv,
                    pq: -s * ddv,
                    qq: s * ddv - 2.0 * dv,
                }
            }
        }
    }
}

/// Energy of elements with their points at `z`.
pub(crate) fn energy_of(elements: &[Element], z: &[DVec2], energy: Energy) -> f64 {
    elements.iter().map(|element| element.energy(element.corners.map(|c| z[c as usize]), energy)).sum()
}

impl Element {
    /// Builds an element with the counter-clockwise rest shape `[a, b, c]`.
    pub fn new(corners: [u32; 3], [a, b, c]: [DVec2; 3], Stiffness { weight, thinnest }: Stiffness) -> Self {
        let longest = [b - a, c - b, a - c].iter().map(|side| side.length_squared()).fold(0.0, f64::max);
        let double_area = (b - a).perp_dot(c - a).max(thinnest * longest);
        let gradients = [c - b, a - c, b - a].map(|side| side.perp() / double_area);
        Self { corners, gradients, weight }
    }

    /// Gradients of the three hat functions on the rest shape.
    pub fn gradients(&self) -> [DVec2; 3] {
        self.gradients
    }

    /// Factor of the element's energy.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// Derivatives ∂z/∂w and ∂z/∂w̄ of the element's map: α = ½ Σ ḡ z and β = ½ Σ g z.
    pub fn derivatives(&self, z: [DVec2; 3]) -> (DVec2, DVec2) {
        let mut sums = (DVec2::ZERO, DVec2::ZERO);
        for (g, z) in self.gradients.iter().zip(z) {
            sums.0 += conjugate(*g).rotate(z);
            sums.1 += g.rotate(z);
        }
        (0.5 * sums.0, 0.5 * sums.1)
    }

    /// Determinant of the element's map.
    pub fn determinant(&self, z: [DVec2; 3]) -> f64 {
        let [g, h] = [self.gradients[1], self.gradients[2]];
        (z[1] - z[0]).perp_dot(z[2] - z[0]) * g.perp_dot(h)
    }

    /// Energy of the element, times its weight.
    pub fn energy(&self, z: [DVec2; 3], energy: Energy) -> f64 {
        let (alpha, beta) = self.derivatives(z);
        self.weight * energy.value(alpha.length_squared() + beta.length_squared(), self.determinant(z))
    }

    /// Gradient and Hessian of the element's energy; the Hessian is made positive semidefinite.
    pub fn model(&self, z: [DVec2; 3], energy: Energy) -> EnergyModel {
        let (alpha, beta) = self.derivatives(z);
        let (p, q) = (alpha.length_squared(), beta.length_squared());
        // The determinant equals p − q up to rounding. It alone decides if the triangle is folded.
        let by = energy.terms(p + q, self.determinant(z));
        let along = |direction: DVec2| direction.try_normalize().unwrap_or(DVec2::X);
        let (to_alpha, to_beta) = (along(alpha), along(beta));
        // Changes of α and β along and across these directions when the corners move.
        let on_alpha = |by: DVec2| flat(self.gradients.map(|g| 0.5 * by.rotate(g)));
        let on_beta = |by: DVec2| flat(self.gradients.map(|g| 0.5 * by.rotate(conjugate(g))));
        let rows = [on_alpha(to_alpha), on_beta(to_beta), on_alpha(to_alpha.perp()), on_beta(to_beta.perp())];
        let [[aa, ab], [_, bb]] =
            positive([2.0 * by.p + 4.0 * p * by.pp, 4.0 * (p * q).sqrt() * by.pq, 2.0 * by.q + 4.0 * q * by.qq]);
        let (across_alpha, across_beta) = ((2.0 * by.p).max(0.0), (2.0 * by.q).max(0.0));
        let mut hessian = [[0.0; 6]; 6];
        for (i, row) in hessian.iter_mut().enumerate() {
            let scaled = [
                aa * rows[0][i] + ab * rows[1][i],
                ab * rows[0][i] + bb * rows[1][i],
                across_alpha * rows[2][i],
                across_beta * rows[3][i],
            ];
            // Row by row, so that the compiler can vectorise.
            for (by, source) in scaled.iter().zip(&rows) {
                row.iter_mut().zip(source).for_each(|(entry, source)| *entry += by * source);
            }
            for entry in row {
                *entry *= self.weight;
            }
        }
        // d|α|² = 2 Re(ᾱ dα).
        let (by_alpha, by_beta) = (self.weight * by.p * alpha, self.weight * by.q * beta);
        let gradient = self.gradients.map(|g| by_alpha.rotate(g) + by_beta.rotate(conjugate(g)));
        EnergyModel { gradient: flat(gradient), hessian }
    }

    /// Adds a stiffness against strain of the image to a model of the element. The stiffness is a multiple of the
    /// element's symmetric Dirichlet energy.
    ///
    /// With d the move of the points and a = ∂d/∂z, b = ∂d/∂z̄ on the image, the strain is (Re a, b), and 2 Re a is the
    /// relative change of the area. Im a is a rotation, which stays free.
    pub(crate) fn damped(&self, mut model: EnergyModel, z: [DVec2; 3], damped: Damped) -> EnergyModel {
        let (damping, strains) = match damped {
            Damped::Strain(damping) => (damping, 3),
            Damped::Area(damping) => (damping, 1),
        };
        if damping == 0.0 {
            return model;
        }
        let gradients = Self::new(self.corners, z, Stiffness { weight: 1.0, thinnest: 0.0 }).gradients;
        let turned = gradients.map(|g| DVec2::new(g.y, g.x));
        let rows = [gradients, gradients.map(conjugate), turned].map(flat);
        let stiffness = damping * self.energy(z, Energy::SymmetricDirichlet);
        for (i, entries) in model.hessian.iter_mut().enumerate() {
            for row in &rows[..strains] {
                entries.iter_mut().zip(row).for_each(|(entry, other)| *entry += stiffness * row[i] * other);
            }
        }
        model
    }

    /// Longest step, in multiples of the direction, that keeps an unfolded triangle unfolded.
    pub fn longest_step(z: [DVec2; 3], direction: [DVec2; 3]) -> f64 {
        Self::longest_step_above(0.0, z, direction)
    }

    /// Longest step that keeps twice the area of a triangle at or above a floor. The area must be above the floor now.
    pub fn longest_step_above(floor: f64, z: [DVec2; 3], direction: [DVec2; 3]) -> f64 {
        let (u, v) = (z[1] - z[0], z[2] - z[0]);
        let (du, dv) = (direction[1] - direction[0], direction[2] - direction[0]);
        smallest_positive_root([u.perp_dot(v) - floor, u.perp_dot(dv) + du.perp_dot(v), du.perp_dot(dv)])
    }
}

/// Smallest positive t with c + b t + a t² = 0, for c > 0; infinite if there is none.
fn smallest_positive_root([c, b, a]: [f64; 3]) -> f64 {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // With c > 0 the stable form of the nearer root is 2c / (−b ± √).
    let divisor = -b + discriminant.sqrt();
    if divisor > 0.0 { 2.0 * c / divisor } else { f64::INFINITY }
}

pub(crate) fn conjugate(z: DVec2) -> DVec2 {
    DVec2::new(z.x, -z.y)
}

pub(crate) fn flat(vectors: [DVec2; 3]) -> [f64; 6] {
    let [a, b, c] = vectors;
    [a.x, a.y, b.x, b.y, c.x, c.y]
}

/// Nearest positive semidefinite matrix to [[a, b], [b, c]].
fn positive([a, b, c]: [f64; 3]) -> [[f64; 2]; 2] {
    let (mean, half) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
    let (low, high) = (mean - half, mean + half);
    if low >= 0.0 {
        return [[a, b], [b, c]];
    }
    if high <= 0.0 {
        return [[0.0; 2]; 2];
    }
    // Projection on the eigenvector of the larger eigenvalue, the only one that is kept.
    let factor = high / (high - low);
    [[factor * (a - low), factor * b], [factor * b, factor * (c - low)]]
}
