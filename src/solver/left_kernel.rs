//! Where the equations of a free boundary depend on each other: the left kernel of their matrix.
//!
//! The mean-value matrix has a left kernel of two dimensions, or nearly, and on large regular meshes it lives in a few
//! corners of the boundary. Leaving out the equations of vertices elsewhere makes the rest singular in 64 bits. So the
//! factors leave out two vertices where that kernel is large. They are found by inverse iteration.

use num_complex::Complex;

use super::equations::Equations;
use super::system::FreeSystem;
use super::{Control, SolveError, farthest_pair};
use crate::linalg::Kind;
use crate::mesh::{DiskMesh, VertexId};

type C64 = Complex<f64>;

/// Share of its diagonal that is added to a singular matrix, so that its left kernel can be found by inverse iteration.
const SHIFT: f64 = 1e-8;

/// Rounds of inverse iteration: each brings the kernel forward by the ratio of singular values.
const ROUNDS: usize = 2;

/// The two vertices whose equations depend most on all others: where the left kernel of the equations is largest.
fn gauge_of(mesh: &DiskMesh, equations: &Equations<C64>, control: Control<'_>) -> Result<[VertexId; 2], SolveError> {
    let system = FreeSystem::new(mesh, |_| false);
    let named = |error| system.named(error);
    let mut matrix = system.negated_matrix(mesh, equations);
    for (row, column, value) in matrix.triplet_iter_mut() {
        if row == column {
            *value *= 1.0 + SHIFT;
        }
    }
    let factor = system.analysis(Kind::General)?.factor(&matrix, control.cancel()).map_err(named)?;
    let n = system.free().len();
    // Any start that has a part in the kernel will do: an even column and an alternating one.
    let mut kernel: Vec<C64> =
        (0..2 * n).map(|i| C64::new(1.0, if i < n { 0.0 } else { (i % 7) as f64 - 3.0 })).collect();
    for _ in 0..ROUNDS {
        kernel = factor.solve_adjoint(&matrix, &kernel).map_err(named)?.x;
        orthonormalize(&mut kernel, n);
    }
    let (first, second) = kernel.split_at(n);
    let largest = |size: &dyn Fn(usize) -> f64| {
        let larger = |best: usize, i: usize| if size(i) > size(best) { i } else { best };
        (0..n).fold(0, larger)
    };
    let a = largest(&|i| first[i].norm_sqr() + second[i].norm_sqr());
    let b = largest(&|i| (first[a] * second[i] - second[a] * first[i]).norm_sqr());
    if a == b {
        return Err(SolveError::Linear { reason: "the left kernel has one dimension".to_owned() });
    }
    Ok([a.min(b), a.max(b)].map(|row| system.free()[row]))
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

/// The same; where the kernel cannot be found, the farthest two vertices of the boundary.
pub(super) fn gauge_or_farthest(
    mesh: &DiskMesh,
    equations: &Equations<C64>,
    control: Control<'_>,
) -> Result<Vec<VertexId>, SolveError> {
    match gauge_of(mesh, equations, control) {
        Err(error) if error != SolveError::Cancelled => Ok(farthest_pair(mesh).to_vec()),
        other => other.map(Vec::from),
    }
}
