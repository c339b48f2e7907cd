//! Least squares with pins: all n equations kept, the pins met exactly (paper §6).
//!
//! # Problem
//!
//! With F the free and P the k pinned vertices, minimise `‖B x − b‖² + ‖C x − c‖²` over the free positions x, where
//!
//! ```text
//! B = −A_FF   b = A_FP t      the equations of the free vertices
//! C = −A_PF   c = A_PP t      those of the pinned ones
//! ```
//!
//! # Method
//!
//! With G = C B⁻¹ and d = c − C B⁻¹ b the minimiser is `x = B⁻¹(b + y)`, `y = Gᴴ (I + G Gᴴ)⁻¹ d`: the factors of B
//! that elimination needs serve least squares as well. Eliminating the pins is the same with y = 0.
//!
//! G is never kept. Its Gram matrix is found from `Gᴴ eⱼ = B⁻ᴴ Cᴴ eⱼ`, one adjoint solve a pin, and y with one more.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::equations::Equations;
use super::system::FreeSystem;
use crate::linalg::{Factor, LinalgError};
use crate::mesh::{DiskMesh, VertexId};

/// Pins whose columns are solved for together.
const GROUP: usize = 8;

type C64 = Complex<f64>;

/// Entries of a row, by column.
pub(super) type Row = Vec<(usize, C64)>;

/// What least squares needs beyond the factors of B: the pinned vertices' equations and I + G Gᴴ.
pub(super) struct PinnedRows {
    /// For each pinned vertex its equation's coefficients, by row of the free neighbour.
    rows: Vec<Row>,
    gram: Cholesky<C64, Dyn>,
}

/// A factored matrix B with what it was made of.
pub(super) struct Factored<'a> {
    pub(super) matrix: &'a CscMatrix<C64>,
    pub(super) factor: &'a Factor<C64>,
    /// Looked at between groups of solves.
    pub(super) cancel: &'a AtomicBool,
}

impl PinnedRows {
    /// Collects the rows of the pinned vertices and factors I + G Gᴴ.
    pub(super) fn new(
        mesh: &DiskMesh,
        system: &FreeSystem,
        equations: &Equations<C64>,
        pinned: &[VertexId],
        factored: &Factored<'_>,
    ) -> Result<Self, LinalgError> {
        let row_of = |v: &VertexId| -> Row {
            let entry = |h| Some((system.row(mesh.head(h))?, -equations.coefficients[h.index()]));
            mesh.outgoing(*v).filter_map(entry).collect()
        };
        let rows: Vec<Row> = pinned.iter().map(row_of).collect();
        let gram = gram(&rows, factored)?;
        let gram = Cholesky::new(gram).ok_or(LinalgError::Singular { row: 0 })?;
        Ok(Self { rows, gram })
    }

    /// d, what the pinned rows leave after the free vertices' moves, from what they left before.
    pub(super) fn discrepancy(&self, before: impl Iterator<Item = C64>, moves: &[C64]) -> Vec<C64> {
        let taken = |row: &Row| row.iter().map(|&(at, value)| value * moves[at]).sum::<C64>();
        before.zip(&self.rows).map(|(left, row)| left - taken(row)).collect()
    }

    /// What is to be added to b, for the discrepancies d of the pinned rows: y.
    pub(super) fn correction(&self, factored: &Factored<'_>, discrepancy: &[C64]) -> Result<Vec<C64>, LinalgError> {
        let weights = self.gram.solve(&DVector::from_column_slice(discrepancy));
        let mut rhs = vec![C64::ZERO; factored.matrix.nrows()];
        for (row, &weight) in self.rows.iter().zip(weights.iter()) {
            add_adjoint(row, weight, &mut rhs);
        }
        Ok(factored.factor.solve_adjoint(factored.matrix, &rhs)?.x)
    }
}

/// Adds `Cᴴ eⱼ` times a weight.
pub(super) fn add_adjoint(row: &[(usize, C64)], weight: C64, into: &mut [C64]) {
    for &(column, value) in row {
        into[column] += value.conj() * weight;
    }
}

/// I + G Gᴴ of rows times the inverse of a matrix, Hermitian to the last bit.
pub(super) fn gram(rows: &[Row], factored: &Factored<'_>) -> Result<DMatrix<C64>, LinalgError> {
    let (n, count) = (factored.matrix.nrows(), rows.len());
    let mut gram = DMatrix::identity(count, count);
    if n == 0 {
        return Ok(gram);
    }
    let adjoint_columns = |group: &[Row]| {
        let mut columns = vec![C64::ZERO; n * group.len()];
        for (row, column) in group.iter().zip(columns.chunks_exact_mut(n)) {
            add_adjoint(row, C64::ONE, column);
        }
        Ok::<_, LinalgError>(factored.factor.solve_adjoint_many(factored.matrix, &columns)?.x)
    };
    if count <= GROUP {
        let columns = adjoint_columns(rows)?;
        let column = |j: usize| &columns[j * n..(j + 1) * n];
        for j in 0..count {
            for i in 0..=j {
                add_pair(&mut gram, (i, j), column(i).iter().zip(column(j)).map(|(a, b)| a.conj() * b).sum());
            }
        }
        return Ok(gram);
    }
    // Too many to keep them all: G Gᴴ eⱼ = C B⁻¹ B⁻ᴴ Cᴴ eⱼ.
    for first in (0..count).step_by(GROUP) {
        if factored.cancel.load(Ordering::Relaxed) {
            return Err(LinalgError::Cancelled);
        }
        let group = &rows[first..(first + GROUP).min(count)];
        let solved = factored.factor.solve_many(factored.matrix, &adjoint_columns(group)?)?.x;
        for (j, column) in (first..).zip(solved.chunks_exact(n)) {
            for (i, row) in rows[..=j].iter().enumerate() {
                add_pair(&mut gram, (i, j), row.iter().map(|&(at, value)| value * column[at]).sum());
            }
        }
    }
    Ok(gram)
}

/// Adds an entry and its mirror image.
fn add_pair(gram: &mut DMatrix<C64>, (i, j): (usize, usize), value: C64) {
    if i == j {
        gram[(i, i)] += C64::new(value.re, 0.0);
    } else {
        gram[(i, j)] += value;
        gram[(j, i)] += value.conj();
    }
}
