//! Least squares with pins: all equations kept, hard pins met exactly, soft pins by their weights (paper §6).
//!
//! # Problem
//!
//! A move δ from positions with the residuals D, with the hard pins on their targets already, minimises
//!
//! ```text
//! ‖A δ + D‖² + Σ w_j² |δ_j − τ_j|²      over the soft pins j,   with δ = 0 on the hard pins
//! ```
//!
//! with τ the vector from a pin to its target.
//!
//! # Method
//!
//! The factors leave out the unknowns *and* the equations of a few vertices g; these equations are kept apart. The
//! set g holds all pins, which usually makes the rest well-conditioned. If not, it also holds two vertices whose
//! equations depend on the others (`left_kernel.rs`). The vertices m of g that are not hard-pinned can move. With
//! N = −A without the rows and columns of g, s = δ on m, and e the (negated) residual of the other rows:
//!
//! ```text
//! δ   = u + U s + N⁻¹ e        u = N⁻¹ D,  U = N⁻¹ A_{·m}
//! r_g = ρ + S s + A_{g·} N⁻¹ e  ρ = A_{g·} u + D_g,  S = A_{g·} U + A_gm
//! ```
//!
//! Stationarity gives `e = −W (r_g, λ)` and `w_j² (δ_j − τ_j) = λ_j`. W has the columns `N⁻ᴴ A_{g·}ᴴ` and `N⁻ᴴ E_Pᵀ`,
//! and P are the soft pins. With K = Wᴴ W, the compliances `C = diag(1/w_j²)`, and M = U on P (the identity where P
//! and m meet), this is a small dense system:
//!
//! ```text
//! ⎡ I + K_gg  K_gP      −S ⎤ ⎡ r_g ⎤   ⎡ ρ       ⎤
//! ⎢ K_Pg      K_PP + C  −M ⎥ ⎢ λ   ⎥ = ⎢ u_P − τ ⎥
//! ⎣ Sᴴ        Mᴴ         0 ⎦ ⎣ s   ⎦   ⎣ 0       ⎦
//! ```
//!
//! The system depends on the pinned vertices and their weights alone. Other targets cost a single solve, because the
//! rows along u are Wᴴ D, and three solves if W is too large to keep. If pins are eliminated, their equations are
//! not kept, and g is empty.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::parallel::prelude::*;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::system::Site;
use crate::linalg::{Factor, LinalgError, gram};
use crate::mesh::VertexId;
use crate::weights::equations::Equations;

type C64 = Complex<f64>;

/// Number of columns per solve.
const GROUP: usize = 8;

/// Largest memory of the columns of W in bytes; larger sets are solved for again instead of being kept.
const COLUMNS_KEPT: usize = 256_000_000;

/// Number of rows per task.
const ROWS_PER_TASK: usize = 4096;

/// Entries of a row, by column.
type Row = Vec<(usize, C64)>;

/// Matrix with its factors.
pub(crate) struct Factored<'a> {
    pub(crate) matrix: &'a CscMatrix<C64>,
    pub(crate) factor: &'a Factor<C64>,
    /// Cancel flag, checked between groups of solves.
    pub(crate) cancel: &'a AtomicBool,
}

/// Soft pin in least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spring {
    pub(crate) vertex: VertexId,
    /// 1/weight², in units of the equations.
    pub(crate) compliance: f64,
}

/// Vertices that the factors leave out, and soft pins.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Remainder {
    /// Set g: the vertices whose equations are kept apart.
    pub(crate) left_out: Vec<VertexId>,
    /// Set m: the vertices of g that can move.
    pub(crate) movers: Vec<VertexId>,
    /// Set P: the soft pins.
    pub(crate) springs: Vec<Spring>,
}

/// Prepared problem: everything that does not depend on the targets of the pins.
#[derive(Debug)]
pub(crate) struct LeastSquares {
    pub(crate) rest: Remainder,
    /// Equations of g and unit rows of P, over the unknowns of the factors.
    rows: Vec<Row>,
    /// Consecutive columns of W, if they fit in memory.
    columns: Option<Vec<C64>>,
    /// Coefficients of the vertices of m in the equations of the factors.
    from_movers: Vec<Vec<C64>>,
    dense: LU<C64, Dyn, Dyn>,
}

impl LeastSquares {
    /// Solves for the columns of W and U and factors the dense system.
    pub(crate) fn new(
        site: Site<'_>,
        equations: &Equations<C64>,
        rest: Remainder,
        factored: &Factored<'_>,
    ) -> Result<Self, LinalgError> {
        let Remainder { left_out, movers, springs } = &rest;
        let unit = |pin: &Spring| site.system.row(pin.vertex).map(|row| vec![(row, C64::ONE)]).unwrap_or_default();
        let equation = |&v: &VertexId| equation_of(site, equations, v);
        let rows: Vec<Row> = left_out.iter().map(equation).chain(springs.iter().map(unit)).collect();
        let from_movers: Vec<Vec<C64>> = movers.iter().map(|&v| column_of(site, equations, v)).collect();
        let by_movers = factored.factor.solve_columns(factored.matrix, &from_movers.concat(), factored.cancel)?.x;
        let n = site.system.free().len();
        let (k, g, m) = (rows.len(), left_out.len(), movers.len());
        let mut matrix: DMatrix<C64> = DMatrix::zeros(k + m, k + m);
        let columns = may_be_kept(n, k).then(|| columns_of(&rows, n, factored)).transpose()?;
        let gram = match &columns {
            Some(columns) if n > 0 => DMatrix::from_vec(k, k, gram(columns, n)),
            Some(_) => DMatrix::zeros(k, k),
            None => gram_of(&rows, n, factored)?,
        };
        matrix.view_mut((0, 0), (k, k)).copy_from(&gram);
        for (i, row) in rows.iter().enumerate() {
            matrix[(i, i)] += if i < g { 1.0 } else { springs[i - g].compliance };
            for (j, &mover) in movers.iter().enumerate() {
                let mut entry = along(row, &by_movers[j * n..(j + 1) * n]);
                if i < g {
                    entry += between(site, equations, [left_out[i], mover]);
                } else if springs[i - g].vertex == mover {
                    entry += C64::ONE;
                }
                matrix[(i, k + j)] = -entry;
                matrix[(k + j, i)] = entry.conj();
            }
        }
        let dense = matrix.lu();
        if !dense.is_invertible() {
            return Err(LinalgError::Singular { row: 0 });
        }
        Ok(Self { rest, rows, columns, from_movers, dense })
    }

    /// Moves of all vertices that minimise the residuals of the equations, which start at `residuals`. `to_targets`
    /// holds the vectors from the soft pins to their targets.
    pub(crate) fn moves(
        &self,
        site: Site<'_>,
        factored: &Factored<'_>,
        residuals: &[C64],
        to_targets: &[C64],
    ) -> Result<Vec<C64>, LinalgError> {
        let free = site.system.free();
        let mut terms: Vec<C64> = free.par_iter().map(|v| residuals[v.index()]).collect();
        let (k, g) = (self.rows.len(), self.rest.left_out.len());
        let mut rhs = DVector::zeros(k + self.rest.movers.len());
        for (i, still) in self.along_still(&terms, factored)?.into_iter().enumerate() {
            rhs[i] = still + if i < g { residuals[self.rest.left_out[i].index()] } else { -to_targets[i - g] };
        }
        let answer = self.dense.solve(&rhs).ok_or(LinalgError::Singular { row: 0 })?;
        let residual = self.residual_of(answer.as_slice(), factored)?;
        terms.par_iter_mut().with_min_len(ROWS_PER_TASK).enumerate().for_each(|(i, term)| {
            for (column, &moved) in self.from_movers.iter().zip(answer.iter().skip(k)) {
                *term += column[i] * moved;
            }
            *term -= residual[i];
        });
        let moves = factored.factor.solve_correction(factored.matrix, &terms, factored.cancel)?.x;
        let mut all = vec![C64::ZERO; site.mesh.vertex_count()];
        let by_movers = self.rest.movers.iter().zip(answer.iter().skip(k));
        for (vertex, &z) in free.iter().zip(&moves).chain(by_movers) {
            all[vertex.index()] = z;
        }
        Ok(all)
    }

    /// Products of the rows with u = N⁻¹ D, which are Wᴴ D.
    fn along_still(&self, terms: &[C64], factored: &Factored<'_>) -> Result<Vec<C64>, LinalgError> {
        if let Some(columns) = self.columns.as_ref().filter(|_| !terms.is_empty()) {
            let columns: Vec<&[C64]> = columns.chunks_exact(terms.len()).collect();
            return Ok(columns.into_par_iter().map(|column| inner(column, terms)).collect());
        }
        let still = factored.factor.solve_correction(factored.matrix, terms, factored.cancel)?.x;
        Ok(self.rows.iter().map(|row| along(row, &still)).collect())
    }

    /// Product of W with the solution of the dense system: the negated residual of the equations of the factors.
    fn residual_of(&self, answer: &[C64], factored: &Factored<'_>) -> Result<Vec<C64>, LinalgError> {
        let n = factored.matrix.nrows();
        let Some(columns) = self.columns.as_ref().filter(|_| n > 0) else {
            let mut sum = vec![C64::ZERO; n];
            for (row, &force) in self.rows.iter().zip(answer) {
                add_adjoint(row, force, &mut sum);
            }
            return Ok(factored.factor.solve_adjoint(factored.matrix, &sum, factored.cancel)?.x);
        };
        let parts = || columns.chunks_exact(n).zip(answer);
        let sum_at = |i: usize| parts().fold(C64::ZERO, |sum, (column, force)| sum + column[i] * force);
        Ok((0..n).into_par_iter().with_min_len(ROWS_PER_TASK).map(sum_at).collect())
    }
}

/// True if `columns` columns with n entries fit in memory together.
pub(crate) fn may_be_kept(n: usize, columns: usize) -> bool {
    n * columns * size_of::<C64>() <= COLUMNS_KEPT
}

/// Adds the adjoint of a row times a weight.
fn add_adjoint(row: &Row, weight: C64, into: &mut [C64]) {
    for &(column, value) in row {
        into[column] += value.conj() * weight;
    }
}

fn along(row: &Row, column: &[C64]) -> C64 {
    row.iter().map(|&(at, value)| value * column[at]).sum()
}

/// Inner product xᴴ y.
fn inner(x: &[C64], y: &[C64]) -> C64 {
    x.iter().zip(y).map(|(x, y)| x.conj() * y).sum()
}

/// Columns of W: a solve for every row.
fn columns_of(rows: &[Row], n: usize, factored: &Factored<'_>) -> Result<Vec<C64>, LinalgError> {
    if rows.len() <= GROUP {
        return columns_of_group(rows, n, factored);
    }
    let mut columns = Vec::with_capacity(n * rows.len());
    for group in rows.chunks(GROUP) {
        columns.extend(columns_of_group(group, n, factored)?);
    }
    Ok(columns)
}

fn columns_of_group(group: &[Row], n: usize, factored: &Factored<'_>) -> Result<Vec<C64>, LinalgError> {
    if factored.cancel.load(Ordering::Relaxed) {
        return Err(LinalgError::Cancelled);
    }
    let mut columns = vec![C64::ZERO; n * group.len()];
    for (row, column) in group.iter().zip(columns.chunks_exact_mut(n.max(1))) {
        add_adjoint(row, C64::ONE, column);
    }
    Ok(factored.factor.solve_adjoint(factored.matrix, &columns, factored.cancel)?.x)
}

/// Matrix K = Wᴴ W by two solves per row, if W is too large to keep.
fn gram_of(rows: &[Row], n: usize, factored: &Factored<'_>) -> Result<DMatrix<C64>, LinalgError> {
    let mut matrix = DMatrix::zeros(rows.len(), rows.len());
    for (place, group) in rows.chunks(GROUP).enumerate() {
        let columns = columns_of_group(group, n, factored)?;
        let solved = factored.factor.solve_correction(factored.matrix, &columns, factored.cancel)?.x;
        for (j, column) in (place * GROUP..).zip(solved.chunks_exact(n.max(1))) {
            for (i, row) in rows[..=j].iter().enumerate() {
                let value = along(row, column);
                matrix[(i, j)] = value;
                matrix[(j, i)] = value.conj();
            }
        }
    }
    Ok(matrix)
}

/// Equation of a vertex over the unknowns of the factors.
fn equation_of(site: Site<'_>, equations: &Equations<C64>, vertex: VertexId) -> Row {
    let entry = |h| Some((site.system.row(site.mesh.head(h))?, equations.coefficients[h.index()]));
    site.mesh.links_from(vertex).filter_map(entry).collect()
}

/// Coefficients of a vertex without an unknown in the equations of the factors.
fn column_of(site: Site<'_>, equations: &Equations<C64>, vertex: VertexId) -> Vec<C64> {
    let mut column = vec![C64::ZERO; site.system.free().len()];
    for h in site.mesh.links_from(vertex) {
        if let Some(row) = site.system.row(site.mesh.head(h)) {
            column[row] += equations.coefficients[site.mesh.twin(h).index()];
        }
    }
    column
}

/// Coefficient of the vertex `to` in the equation of the vertex `of`; both may be equal.
fn between(site: Site<'_>, equations: &Equations<C64>, [of, to]: [VertexId; 2]) -> C64 {
    let coefficients = &equations.coefficients;
    if of == to {
        return -site.mesh.links_from(of).map(|h| coefficients[h.index()]).sum::<C64>();
    }
    let halfedges = site.mesh.links_from(of).filter(|&h| site.mesh.head(h) == to);
    halfedges.map(|h| coefficients[h.index()]).sum()
}
