//! Least squares with pins where the pinned vertices' own equations must not be left out of the factors.
//!
//! # Why
//!
//! The mean-value matrix has a left kernel of two dimensions, or nearly, and on large regular meshes it lives in a few
//! corners of the boundary. Leaving out the equations of pins elsewhere makes the rest singular in 64 bits. So the
//! factors leave out the unknowns *and* the equations of two vertices g where that kernel is large, whatever is pinned.
//!
//! # Problem
//!
//! A move δ from positions that leave D of their equations, with δ = 0 on the pins P, minimises ‖A δ + D‖. With N = −A
//! without the rows and columns of g, s = δ on g, and e the (negated) residual of the other rows:
//!
//! ```text
//! δ   = u + U s + N⁻¹ e        u = N⁻¹ D,  U = N⁻¹ A_{·g}
//! r_g = ρ + S s + A_{g·} N⁻¹ e  ρ = A_{g·} u + D_g,  S = A_{g·} U + A_gg
//! ```
//!
//! Stationarity gives `e = −W (r_g, λ)`, where W has the columns `N⁻ᴴ A_{g·}ᴴ` and `N⁻ᴴ E_Pᵀ`, and with K = Wᴴ W and M = U on
//! the pins (the identity on pins in g) a dense system of k + 4 unknowns:
//!
//! ```text
//! ⎡ I + K_gg  K_gP  −S ⎤ ⎡ r_g ⎤   ⎡ ρ   ⎤
//! ⎢ K_Pg      K_PP  −M ⎥ ⎢ λ   ⎥ = ⎢ u_P ⎥
//! ⎣ Sᴴ        Mᴴ     0 ⎦ ⎣ s   ⎦   ⎣ 0   ⎦
//! ```

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::equations::Equations;
use super::free_solve::in_vertices;
use super::pinned_rows::{Factored, Row, add_adjoint, gram};
use super::system::FreeSystem;
use super::{Control, SolveError};
use crate::linalg::{Analysis, Kind, LinalgError};
use crate::mesh::{DiskMesh, VertexId};

type C64 = Complex<f64>;

/// Share of its diagonal that is added to a singular matrix, so that its left kernel can be found by inverse iteration.
const SHIFT: f64 = 1e-8;

/// Rounds of inverse iteration: each brings the kernel forward by the ratio of singular values.
const ROUNDS: usize = 2;

/// The two vertices whose equations depend most on all others: where the left kernel of the equations is largest.
///
/// # Errors
///
/// A shifted system that cannot be solved, or the caller's wish to stop.
pub(super) fn gauge_of(
    mesh: &DiskMesh,
    equations: &Equations<C64>,
    control: Control<'_>,
) -> Result<[VertexId; 2], SolveError> {
    let system = FreeSystem::new(mesh, |_| false);
    let named = |error| in_vertices(error, system.free());
    let mut matrix = system.negated_matrix(mesh, equations);
    for (row, column, value) in matrix.triplet_iter_mut() {
        if row == column {
            *value *= 1.0 + SHIFT;
        }
    }
    let analysis = Analysis::new(Kind::General, system.pattern()).map_err(named)?;
    let factor = analysis.factor(&matrix, control.cancel()).map_err(named)?;
    let n = mesh.vertex_count();
    // Any start that has a part in the kernel will do: an even column and an alternating one.
    let mut kernel: Vec<C64> =
        (0..2 * n).map(|i| C64::new(1.0, if i < n { 0.0 } else { (i % 7) as f64 - 3.0 })).collect();
    for _ in 0..ROUNDS {
        kernel = factor.solve_adjoint_many(&matrix, &kernel).map_err(named)?.x;
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
    Ok([VertexId::from_index(a.min(b)), VertexId::from_index(a.max(b))])
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

/// Where the least-squares problem stands.
pub(super) struct GaugeRows<'a> {
    pub(super) mesh: &'a DiskMesh,
    /// The system without the gauge.
    pub(super) system: &'a FreeSystem,
    pub(super) gauge: [VertexId; 2],
    pub(super) pinned: &'a [VertexId],
    pub(super) equations: &'a Equations<C64>,
    pub(super) factored: Factored<'a>,
}

impl GaugeRows<'_> {
    /// The moves of all vertices that leave least of the equations, of which `left` is left before; the pins stay.
    pub(super) fn moves(&self, left: &[C64]) -> Result<Vec<C64>, LinalgError> {
        let free: Vec<C64> = self.system.free().iter().map(|v| left[v.index()]).collect();
        let (into_gauge, from_gauge) = (self.rows_of_gauge(), self.columns_of_gauge());
        let rhs: Vec<C64> = free.iter().chain(from_gauge.iter().flatten()).copied().collect();
        let solved = self.factored.factor.solve_correction(self.factored.matrix, &rhs)?.x;
        let n = free.len();
        let (still, by_gauge) = solved.split_at(n);
        let unit = |v: &VertexId| self.system.row(*v).map(|row| vec![(row, C64::ONE)]).unwrap_or_default();
        let rows: Vec<Row> = into_gauge.iter().cloned().chain(self.pinned.iter().map(unit)).collect();
        let answer = self.dense(&rows, (still, by_gauge), left)?;
        let mut adjoint = vec![C64::ZERO; n];
        for (row, &weight) in rows.iter().zip(answer.iter()) {
            add_adjoint(row, weight, &mut adjoint);
        }
        let residual = self.factored.factor.solve_adjoint(self.factored.matrix, &adjoint)?.x;
        let at_gauge = [answer[rows.len()], answer[rows.len() + 1]];
        let term = |i: usize| free[i] + from_gauge[0][i] * at_gauge[0] + from_gauge[1][i] * at_gauge[1] - residual[i];
        let terms: Vec<C64> = (0..n).map(term).collect();
        let moves = self.factored.factor.solve_correction(self.factored.matrix, &terms)?.x;
        let mut all = vec![C64::ZERO; self.mesh.vertex_count()];
        for (vertex, z) in self.system.free().iter().zip(moves) {
            all[vertex.index()] = z;
        }
        for (vertex, z) in self.gauge.iter().zip(at_gauge) {
            all[vertex.index()] = z;
        }
        for v in self.pinned {
            all[v.index()] = C64::ZERO;
        }
        Ok(all)
    }

    /// Solves for residuals at the gauge, multipliers of the pins, and moves of the gauge.
    fn dense(
        &self,
        rows: &[Row],
        (still, by_gauge): (&[C64], &[C64]),
        left: &[C64],
    ) -> Result<DVector<C64>, LinalgError> {
        let (k, n) = (rows.len(), still.len());
        let mut matrix: DMatrix<C64> = DMatrix::zeros(k + 2, k + 2);
        matrix.view_mut((0, 0), (k, k)).copy_from(&gram(rows, &self.factored)?);
        let mut rhs = DVector::zeros(k + 2);
        let along = |row: &Row, column: &[C64]| row.iter().map(|&(at, value)| value * column[at]).sum::<C64>();
        for (i, row) in rows.iter().enumerate() {
            rhs[i] = along(row, still);
            for j in 0..2 {
                let mut entry = along(row, &by_gauge[j * n..(j + 1) * n]);
                if i < 2 {
                    entry += self.within_gauge(i, j);
                } else if self.pinned[i - 2] == self.gauge[j] {
                    entry += C64::ONE;
                }
                matrix[(i, k + j)] = -entry;
                matrix[(k + j, i)] = entry.conj();
            }
            if i < 2 {
                rhs[i] += left[self.gauge[i].index()];
            } else {
                matrix[(i, i)] -= C64::ONE;
            }
        }
        matrix.lu().solve(&rhs).ok_or(LinalgError::Singular { row: 0 })
    }

    /// The equations of the gauge's vertices, by row of the other vertices.
    fn rows_of_gauge(&self) -> [Row; 2] {
        self.gauge.map(|v| {
            let entry = |h| Some((self.system.row(self.mesh.head(h))?, self.equations.coefficients[h.index()]));
            self.mesh.outgoing(v).filter_map(entry).collect()
        })
    }

    /// What the gauge's vertices give to the other equations.
    fn columns_of_gauge(&self) -> [Vec<C64>; 2] {
        self.gauge.map(|v| {
            let mut column = vec![C64::ZERO; self.system.free().len()];
            for h in self.mesh.outgoing(v) {
                if let Some(row) = self.system.row(self.mesh.head(h)) {
                    column[row] += self.equations.coefficients[self.mesh.twin(h).index()];
                }
            }
            column
        })
    }

    /// The coefficient of one vertex of the gauge in the equation of another.
    fn within_gauge(&self, i: usize, j: usize) -> C64 {
        let coefficients = &self.equations.coefficients;
        if i == j {
            return -self.mesh.outgoing(self.gauge[i]).map(|h| coefficients[h.index()]).sum::<C64>();
        }
        let between = self.mesh.outgoing(self.gauge[i]).filter(|&h| self.mesh.head(h) == self.gauge[j]);
        between.map(|h| coefficients[h.index()]).sum()
    }
}
