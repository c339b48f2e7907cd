//! Dependence among the equations of a free boundary: the left kernel of their matrix.
//!
//! The mean-value matrix has a left kernel of two dimensions, exactly or nearly. On large regular meshes the kernel
//! is concentrated in a few corners of the boundary. Leaving out the equations of vertices elsewhere makes the
//! remaining matrix singular in 64 bits. So the factors leave out two vertices at which the kernel is large. Inverse
//! iteration finds them.
//!
//! If the equations of two vertices P are left out already and the rest is factored, a single substitution gives the
//! kernel. With the identity on P, it is `Y = −A_FF⁻ᴴ A_PFᴴ` on the others: exactly on a surface that unrolls,
//! nearly on other surfaces. Rounding errors in the kept equations reappear in the equations of P, amplified by the
//! size of Y. The size of Y therefore measures how bad the choice of P is, and better vertices are where Y is
//! largest.

use num_complex::Complex;

use super::system::{FreeSystem, Site};
use crate::linalg::{Factor, Kind};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Phase, SolveError, farthest_pair};
use crate::weights::equations::Equations;

type C64 = Complex<f64>;

/// Share of the diagonal added to a singular matrix, so that inverse iteration can find its left kernel.
const SHIFT: f64 = 1e-8;

/// Number of rounds of inverse iteration. Each amplifies the kernel by the ratio of singular values.
const ROUNDS: usize = 2;

/// Largest accepted ratio of the left kernel elsewhere to the left kernel at the vertices left out: of 16 digits 12
/// remain. On meshes of scans and of art the ratio reaches a thousand (on the corpus, with the farthest two vertices
/// and weights of five families). On regular grids it grows by a factor of e every two squares.
const MOST_GROWTH: f64 = 1e4;

/// Share of the best candidate's value from which candidates count as equally good; the farthest of them is taken.
const NEARLY_AS_GOOD: f64 = 0.5;

/// Two vertices whose equations depend most on all others: the left kernel of the equations is largest there.
/// Returns the farthest pair of the boundary if the kernel cannot be found.
///
/// # Errors
///
/// [`SolveError::Cancelled`] if cancelled.
pub(crate) fn gauge_of(
    mesh: &DiskMesh,
    equations: &Equations<C64>,
    control: Control<'_>,
) -> Result<[VertexId; 2], SolveError> {
    control.enter(Phase::Factor)?;
    match gauge_in_kernel(mesh, equations, control) {
        Err(error) if error != SolveError::Cancelled => Ok(farthest_pair(mesh)),
        other => other,
    }
}

fn gauge_in_kernel(
    mesh: &DiskMesh,
    equations: &Equations<C64>,
    control: Control<'_>,
) -> Result<[VertexId; 2], SolveError> {
    let system = FreeSystem::new(mesh, |_| false, control)?;
    let named = |error| system.named(error);
    let mut matrix = system.negated_matrix(mesh, equations, control)?;
    for (row, column, value) in matrix.triplet_iter_mut() {
        if row == column {
            *value *= 1.0 + SHIFT;
        }
    }
    let factor = system.analysis(Kind::General, control)?.factor(&matrix, control.cancel()).map_err(named)?;
    let n = system.free().len();
    // Any start with a component in the kernel works: a constant column and an alternating column.
    let mut kernel: Vec<C64> =
        (0..2 * n).map(|i| C64::new(1.0, if i < n { 0.0 } else { (i % 7) as f64 - 3.0 })).collect();
    for _ in 0..ROUNDS {
        kernel = factor.solve_adjoint(&matrix, &kernel, control.cancel()).map_err(named)?.x;
        orthonormalize(&mut kernel, n);
    }
    let (first, second) = kernel.split_at(n);
    let a = largest(n, |i| first[i].norm_sqr() + second[i].norm_sqr()).unwrap_or(0);
    let b = largest(n, |i| (first[a] * second[i] - second[a] * first[i]).norm_sqr()).unwrap_or(0);
    if a == b {
        return Err(SolveError::Linear { reason: "the left kernel has one dimension".to_owned() });
    }
    Ok([a.min(b), a.max(b)].map(|row| system.free()[row]))
}

/// Two vertices whose equations are better left out than those of `held`, which the factors leave out. `None` if
/// `held` is good enough. Sizes refer to equations whose coefficients sum to 1.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(crate) fn better_gauge(
    site: Site<'_>,
    equations: &Equations<C64>,
    factor: &Factor<C64>,
    held: &[VertexId],
    control: Control<'_>,
) -> Result<Option<[VertexId; 2]>, SolveError> {
    let Site { mesh, system } = site;
    let n = system.free().len();
    let mut kernel = vec![C64::ZERO; held.len() * n];
    for (&vertex, column) in held.iter().zip(kernel.chunks_exact_mut(n.max(1))) {
        for h in mesh.links_from(vertex) {
            if let Some(row) = system.row(mesh.head(h)) {
                column[row] += equations.coefficients[h.index()].conj();
            }
        }
    }
    factor.substitute_adjoint(&mut kernel, control.cancel())?;
    let sum_at = |&v: &VertexId| mesh.links_from(v).map(|h| equations.coefficients[h.index()].norm()).sum();
    let wholes: Vec<f64> = control.each(n, |row| sum_at(&system.free()[row]))?;
    let at_held: Vec<f64> = held.iter().map(sum_at).collect();
    let growth = |row: usize| {
        let share = |(k, at): (usize, &f64)| kernel[k * n + row].norm() / at;
        wholes[row] * at_held.iter().enumerate().map(share).fold(0.0, f64::hypot)
    };
    let growths: Vec<f64> = control.each(n, growth)?;
    let Some(a) = largest(n, |row| growths[row]) else { return Ok(None) };
    if growths[a] <= MOST_GROWTH {
        return Ok(None);
    }
    // Components of the rows orthogonal to the row of a. Not by their squares, which could overflow or underflow.
    let row = |i: usize| kernel.iter().skip(i).step_by(n);
    let length = row(a).map(|z| z.norm()).fold(0.0, f64::hypot);
    let along_a: Vec<C64> = row(a).map(|z| z / length).collect();
    let across = |i: usize| {
        let along: C64 = row(i).zip(&along_a).map(|(z, unit)| z * unit.conj()).sum();
        wholes[i] * row(i).zip(&along_a).map(|(z, unit)| (z - along * unit).norm()).fold(0.0, f64::hypot)
    };
    let across: Vec<f64> = control.each(n, across)?;
    let best = across.iter().copied().fold(0.0, f64::max);
    let distance = |i: usize| mesh.position(system.free()[a]).distance(mesh.position(system.free()[i]));
    let b = largest(n, |i| if across[i] >= NEARLY_AS_GOOD * best { distance(i) } else { -1.0 }).unwrap_or(a);
    let is_found = a != b && best > 0.0 && best.is_finite();
    Ok(is_found.then(|| [a.min(b), a.max(b)].map(|row| system.free()[row])))
}

/// Index below n of the largest size; the first if several are equal.
fn largest(n: usize, size: impl Fn(usize) -> f64) -> Option<usize> {
    (0..n).reduce(|best, i| if size(i) > size(best) { i } else { best })
}

/// Makes two columns orthonormal (Gram and Schmidt).
fn orthonormalize(columns: &mut [C64], n: usize) {
    let scale = |column: &mut [C64]| {
        let norm = column.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        for z in column {
            *z /= norm;
        }
    };
    let (first, second) = columns.split_at_mut(n);
    scale(first);
    let along: C64 = first.iter().zip(&*second).map(|(a, b)| a.conj() * b).sum();
    second.iter_mut().zip(&*first).for_each(|(b, a)| *b -= along * a);
    scale(second);
}
