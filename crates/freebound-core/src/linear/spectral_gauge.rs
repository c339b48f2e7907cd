//! Spectral map from the factors of two gauge pins, so that no vertex is singled out.
//!
//! A map with two pins chosen by the solver depends on the choice: a mirror-symmetric mesh gets a map that is not
//! symmetric. The spectral map (`spectral.rs`) has no pins. It costs a few more substitutions here, because the
//! factors of the system with two pins also invert the matrix without pins.
//!
//! # Equation
//!
//! L is the conformal energy, p and q are the gauge pins, I are the other vertices. z solves the system with two pins:
//!
//! ```text
//! z_p = 0,  z_q = 1,  L_II z_I = −L_Iq                                       (1)
//! s = (L z)_q = z* L z                  energy of the map with two pins      (2)
//! T b = G b + z (z* b) / s              G = L_II⁻¹ on I, zero at p and q     (3)
//! ```
//!
//! For every b with sum zero, x = T b solves L x = b with x zero at p: rows I hold by (1), and row q holds because
//! the entry q of L G b is −z* b over I. Row p holds because the rows of L sum to zero. Solutions differ by constants
//! only, so T between two projections that remove the mean of the boundary has the eigenvalues 1/λ of the pencil
//! L z = λ B z.
//!
//! The code multiplies (3) by s. On a surface that unrolls, s is 0: the operator is then z z*, and its eigenvector is
//! z itself.
//!
//! Source: block elimination; the eigenproblem is that of `spectral.rs`.

use glam::DVec2;
use num_complex::Complex;

use super::free_solve::FreeSolve;
use super::spectral::{centre, pencil_residual};
use super::system::Site;
use crate::linalg::{EigenLimits, greatest_eigenpair};
use crate::mesh::VertexId;
use crate::problem::{Control, Convergence, Embedding, SolveError, Stop};

type C64 = Complex<f64>;

/// Limits of the iteration. The tolerance keeps the asymmetry of a symmetric mesh below 1e-6.
const LIMITS: EigenLimits = EigenLimits { tolerance: 1e-7, applications: 60 };

/// Largest number of vectors over all vertices that are kept. They make the last application of the operator needless.
const KEPT: usize = 12;

/// Spectral map with the numbers of its solve.
pub(crate) struct SpectralGauge {
    /// Embedding with its boundary centred at the origin.
    pub(crate) embedding: Embedding,
    /// Residual ‖L z − λ B z‖, relative to the sizes of the terms of L z.
    pub(crate) residual: f64,
    pub(crate) convergence: Convergence,
}

/// Operator (3) times s, on vectors over the boundary.
struct Inverse<'a> {
    free: &'a FreeSolve,
    site: Site<'a>,
    /// Solution z of the system with two pins, by vertex.
    pinned: Vec<C64>,
    /// Energy s.
    energy: f64,
    control: Control<'a>,
}

/// Computes the spectral map from the factors and the solution of the system with two gauge pins.
///
/// `None` if the two pins coincide or the iteration does not converge. The solution with two pins then stands.
///
/// # Errors
///
/// [`SolveError::Cancelled`] if cancelled.
pub(crate) fn spectral_gauge(
    free: &FreeSolve,
    site: Site<'_>,
    solution: &Embedding,
    control: Control<'_>,
) -> Result<Option<SpectralGauge>, SolveError> {
    let &[p, q] = free.eliminated() else { return Ok(None) };
    let complex = |v: DVec2| C64::new(v.x, v.y);
    let unit = complex(solution[q] - solution[p]);
    if unit.norm() == 0.0 {
        return Ok(None);
    }
    let pinned: Vec<C64> = solution.iter().map(|&at| complex(at - solution[p]) / unit).collect();
    let force = -free.equations().residual_of(site.mesh, solution, q) / unit;
    let inverse = Inverse { free, site, pinned, energy: force.re.max(0.0), control };
    let mut start: Vec<C64> = site.mesh.boundary_loop().iter().map(|v| inverse.pinned[v.index()]).collect();
    centre(&mut start);
    let mut kept: Vec<Vec<C64>> = Vec::new();
    let apply = |b: &[C64]| {
        let whole = inverse.apply(b)?;
        let mut boundary = inverse.on_boundary(&whole);
        centre(&mut boundary);
        if kept.len() < KEPT {
            kept.push(whole);
        }
        Ok::<_, SolveError>(boundary)
    };
    let found = greatest_eigenpair(&start, LIMITS, apply)?;
    // Written so that NaN counts as a failure, too.
    let has_converged = found.residual <= LIMITS.tolerance;
    if !has_converged {
        return Ok(None);
    }
    let whole =
        if found.applications <= KEPT { combined(&kept, &found.weights) } else { inverse.apply(&found.vector)? };
    let embedding = inverse.normed(whole);
    if embedding.check_finite().is_err() {
        return Ok(None);
    }
    let (_, residual) = pencil_residual(site.mesh, free.equations(), &embedding, control)?;
    let convergence = Convergence { steps: found.applications, residual: found.residual, stop: Stop::Converged };
    Ok(Some(SpectralGauge { embedding, residual, convergence }))
}

/// Sum of vectors with these weights.
fn combined(vectors: &[Vec<C64>], weights: &[f64]) -> Vec<C64> {
    let mut sum = vec![C64::ZERO; vectors[0].len()];
    for (vector, weight) in vectors.iter().zip(weights) {
        for (sum, x) in sum.iter_mut().zip(vector) {
            *sum += x * weight;
        }
    }
    sum
}

impl Inverse<'_> {
    /// Vector s G b + z (z* b), by vertex, for b over the boundary loop.
    fn apply(&self, b: &[C64]) -> Result<Vec<C64>, SolveError> {
        let Site { mesh, system } = self.site;
        let boundary = mesh.boundary_loop();
        let share: C64 = boundary.iter().zip(b).map(|(v, b)| self.pinned[v.index()].conj() * b).sum();
        let mut x: Vec<C64> = self.pinned.iter().map(|z| z * share).collect();
        let mut rhs = vec![C64::ZERO; system.free().len()];
        for (&v, &b) in boundary.iter().zip(b) {
            if let Some(row) = system.row(v) {
                rhs[row] = b * self.energy;
            }
        }
        for (&v, y) in system.free().iter().zip(self.free.substitute(&rhs, self.control)?) {
            x[v.index()] += y;
        }
        Ok(x)
    }

    fn on_boundary(&self, x: &[C64]) -> Vec<C64> {
        self.site.mesh.boundary_loop().iter().map(|v: &VertexId| x[v.index()]).collect()
    }

    /// Embedding with its boundary centred at the origin and of norm 1.
    fn normed(&self, x: Vec<C64>) -> Embedding {
        let boundary = self.on_boundary(&x);
        let mean = boundary.iter().sum::<C64>() / boundary.len() as f64;
        let norm = boundary.iter().map(|z| (z - mean).norm_sqr()).sum::<f64>().sqrt();
        let place = |z: C64| (z - mean) / norm;
        Embedding::from(x.into_iter().map(place).map(|z| DVec2::new(z.re, z.im)).collect::<Vec<_>>())
    }
}
