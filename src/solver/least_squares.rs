//! Least squares with pins: all equations kept, exact pins met exactly, weighted ones by their weights (paper §6).
//!
//! # Problem
//!
//! A move δ from positions that leave D of the equations minimises
//!
//! ```text
//! ‖A δ + D‖² + Σ w_j² |δ_j − τ_j|²      over the weighted pins j,   with δ_j = τ_j for the exact ones
//! ```
//!
//! where τ is the way from a pin to its target.
//!
//! # Method
//!
//! The factors leave out the unknowns *and* the equations of a few vertices: either two vertices g where the equations
//! depend on each other (`left_kernel.rs`), whatever is pinned; or the pins that are eliminated, and then g is empty.
//! With N = −A without these rows and columns, s = δ on g, and e the (negated) residual of the other rows:
//!
//! ```text
//! δ   = u + U s + N⁻¹ e        u = N⁻¹ D,  U = N⁻¹ A_{·g}
//! r_g = ρ + S s + A_{g·} N⁻¹ e  ρ = A_{g·} u + D_g,  S = A_{g·} U + A_gg
//! ```
//!
//! Stationarity gives `e = −W (r_g, λ)` and `w_j² (δ_j − τ_j) = λ_j`, where W has the columns `N⁻ᴴ A_{g·}ᴴ` and `N⁻ᴴ E_Pᵀ`.
//! With K = Wᴴ W, the compliances C = diag(1/w_j²), zero for exact pins, and M = U on the pins (the identity on pins in
//! g) that is a dense system of k + 4 unknowns:
//!
//! ```text
//! ⎡ I + K_gg  K_gP      −S ⎤ ⎡ r_g ⎤   ⎡ ρ       ⎤
//! ⎢ K_Pg      K_PP + C  −M ⎥ ⎢ λ   ⎥ = ⎢ u_P − τ ⎥
//! ⎣ Sᴴ        Mᴴ         0 ⎦ ⎣ s   ⎦   ⎣ 0       ⎦
//! ```
//!
//! It depends on the pinned vertices and their weights alone: other targets cost three solves.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{DMatrix, DVector, Dyn, LU};
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::equations::Equations;
use super::free_solve::Site;
use crate::linalg::{Factor, LinalgError, gram};
use crate::mesh::VertexId;

type C64 = Complex<f64>;

/// Columns that are solved for together.
const GROUP: usize = 8;

/// Bytes that the columns of W may take together; beyond, each is solved for once more instead of being kept.
const COLUMNS_KEPT: usize = 256_000_000;

/// Entries of a row, by column.
type Row = Vec<(usize, C64)>;

/// A factored matrix with what it was made of.
pub(super) struct Factored<'a> {
    pub(super) matrix: &'a CscMatrix<C64>,
    pub(super) factor: &'a Factor<C64>,
    /// Looked at between groups of solves.
    pub(super) cancel: &'a AtomicBool,
}

/// A pinned vertex as least squares sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PinRow {
    pub(super) vertex: VertexId,
    /// 1/weight², in units of the equations; 0 where the pin is exact.
    pub(super) compliance: f64,
}

impl PinRow {
    /// Whether the target is met to the last bit.
    pub(super) fn is_exact(&self) -> bool {
        self.compliance == 0.0
    }
}

/// A problem made ready: everything that does not depend on where the pins are to go.
pub(super) struct LeastSquares {
    /// The vertices that the factors leave out and that move all the same: two or none.
    gauge: Vec<VertexId>,
    pins: Vec<PinRow>,
    /// The gauge's equations and the pins' unit rows, over the unknowns of the factors.
    rows: Vec<Row>,
    /// What the gauge's vertices give to the other equations.
    from_gauge: Vec<Vec<C64>>,
    dense: LU<C64, Dyn, Dyn>,
}

impl LeastSquares {
    /// Solves for the columns of W and U and factors the dense system.
    pub(super) fn new(
        site: Site<'_>,
        equations: &Equations<C64>,
        (gauge, pins): (Vec<VertexId>, Vec<PinRow>),
        factored: &Factored<'_>,
    ) -> Result<Self, LinalgError> {
        let unit = |pin: &PinRow| site.system.row(pin.vertex).map(|row| vec![(row, C64::ONE)]).unwrap_or_default();
        let rows: Vec<Row> =
            gauge.iter().map(|&v| equation_of(site, equations, v)).chain(pins.iter().map(unit)).collect();
        let from_gauge: Vec<Vec<C64>> = gauge.iter().map(|&v| column_of(site, equations, v)).collect();
        let by_gauge = factored.factor.solve_many(factored.matrix, &from_gauge.concat())?.x;
        let n = site.system.free().len();
        let (k, g) = (rows.len(), gauge.len());
        let mut matrix: DMatrix<C64> = DMatrix::zeros(k + g, k + g);
        matrix.view_mut((0, 0), (k, k)).copy_from(&gram_of(&rows, n, factored)?);
        for (i, row) in rows.iter().enumerate() {
            matrix[(i, i)] += if i < g { 1.0 } else { pins[i - g].compliance };
            for j in 0..g {
                let mut entry = along(row, &by_gauge[j * n..(j + 1) * n]);
                if i < g {
                    entry += between(site, equations, [gauge[i], gauge[j]]);
                } else if pins[i - g].vertex == gauge[j] {
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
        Ok(Self { gauge, pins, rows, from_gauge, dense })
    }

    /// The moves of all vertices that leave least of the equations, of which `left` is left before. `ways` are those
    /// from the pins to their targets.
    pub(super) fn moves(
        &self,
        site: Site<'_>,
        factored: &Factored<'_>,
        (left, ways): (&[C64], &[C64]),
    ) -> Result<Vec<C64>, LinalgError> {
        let free = site.system.free();
        let mut terms: Vec<C64> = free.iter().map(|v| left[v.index()]).collect();
        let still = factored.factor.solve_correction(factored.matrix, &terms)?.x;
        let (k, g) = (self.rows.len(), self.gauge.len());
        let mut rhs = DVector::zeros(k + g);
        for (i, row) in self.rows.iter().enumerate() {
            rhs[i] = along(row, &still) + if i < g { left[self.gauge[i].index()] } else { -ways[i - g] };
        }
        let answer = self.dense.solve(&rhs).ok_or(LinalgError::Singular { row: 0 })?;
        let mut forces = vec![C64::ZERO; free.len()];
        for (row, &force) in self.rows.iter().zip(answer.iter()) {
            add_adjoint(row, force, &mut forces);
        }
        let residual = factored.factor.solve_adjoint(factored.matrix, &forces)?.x;
        for (i, term) in terms.iter_mut().enumerate() {
            for (column, &moved) in self.from_gauge.iter().zip(answer.iter().skip(k)) {
                *term += column[i] * moved;
            }
            *term -= residual[i];
        }
        let moves = factored.factor.solve_correction(factored.matrix, &terms)?.x;
        let mut all = vec![C64::ZERO; site.mesh.vertex_count()];
        let by_gauge = self.gauge.iter().zip(answer.iter().skip(k));
        for (vertex, &z) in free.iter().zip(&moves).chain(by_gauge) {
            all[vertex.index()] = z;
        }
        for (pin, way) in self.pins.iter().zip(ways).filter(|(pin, _)| pin.is_exact()) {
            all[pin.vertex.index()] = *way;
        }
        Ok(all)
    }

    /// The pins, in the order of the ways.
    pub(super) fn pins(&self) -> &[PinRow] {
        &self.pins
    }
}

/// Adds the adjoint of a row times a weight.
fn add_adjoint(row: &Row, weight: C64, into: &mut [C64]) {
    for &(column, value) in row {
        into[column] += value.conj() * weight;
    }
}

/// A row times a column.
fn along(row: &Row, column: &[C64]) -> C64 {
    row.iter().map(|&(at, value)| value * column[at]).sum()
}

/// K = Wᴴ W, from one adjoint solve a row; from two solves where there are too many columns to keep.
fn gram_of(rows: &[Row], n: usize, factored: &Factored<'_>) -> Result<DMatrix<C64>, LinalgError> {
    let k = rows.len();
    if n == 0 {
        return Ok(DMatrix::zeros(k, k));
    }
    let columns_of = |group: &[Row]| {
        if factored.cancel.load(Ordering::Relaxed) {
            return Err(LinalgError::Cancelled);
        }
        let mut columns = vec![C64::ZERO; n * group.len()];
        for (row, column) in group.iter().zip(columns.chunks_exact_mut(n)) {
            add_adjoint(row, C64::ONE, column);
        }
        Ok(factored.factor.solve_adjoint_many(factored.matrix, &columns)?.x)
    };
    if n * k * size_of::<C64>() <= COLUMNS_KEPT {
        let mut columns = Vec::with_capacity(n * k);
        for group in rows.chunks(GROUP) {
            columns.extend(columns_of(group)?);
        }
        return Ok(DMatrix::from_vec(k, k, gram(&columns, n)));
    }
    let mut matrix = DMatrix::zeros(k, k);
    for (place, group) in rows.chunks(GROUP).enumerate() {
        let solved = factored.factor.solve_many(factored.matrix, &columns_of(group)?)?.x;
        for (j, column) in (place * GROUP..).zip(solved.chunks_exact(n)) {
            for (i, row) in rows[..=j].iter().enumerate() {
                let value = along(row, column);
                matrix[(i, j)] = value;
                matrix[(j, i)] = value.conj();
            }
        }
    }
    Ok(matrix)
}

/// A vertex's equation over the unknowns of the factors.
fn equation_of(site: Site<'_>, equations: &Equations<C64>, vertex: VertexId) -> Row {
    let entry = |h| Some((site.system.row(site.mesh.head(h))?, equations.coefficients[h.index()]));
    site.mesh.outgoing(vertex).filter_map(entry).collect()
}

/// What a vertex that is left out gives to the equations of the others.
fn column_of(site: Site<'_>, equations: &Equations<C64>, vertex: VertexId) -> Vec<C64> {
    let mut column = vec![C64::ZERO; site.system.free().len()];
    for h in site.mesh.outgoing(vertex) {
        if let Some(row) = site.system.row(site.mesh.head(h)) {
            column[row] += equations.coefficients[site.mesh.twin(h).index()];
        }
    }
    column
}

/// The coefficient of one vertex in the equation of another, or of itself.
fn between(site: Site<'_>, equations: &Equations<C64>, [of, to]: [VertexId; 2]) -> C64 {
    let coefficients = &equations.coefficients;
    if of == to {
        return -site.mesh.outgoing(of).map(|h| coefficients[h.index()]).sum::<C64>();
    }
    let halfedges = site.mesh.outgoing(of).filter(|&h| site.mesh.head(h) == to);
    halfedges.map(|h| coefficients[h.index()]).sum()
}
