//! The linear system of the free vertices: vertex equations with the pinned vertices eliminated (paper §3.3).
//!
//! With F the free and P the pinned vertices, `A_FF z_F = −A_FP t`. The pattern depends on the mesh and on which
//! vertices are pinned; weights and targets only change values.

use std::ops::{AddAssign, Mul};

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;
use rayon::prelude::*;

use super::equations::Equations;
use super::{Control, Embedding, SolveError};
use crate::linalg::{Analysis, Kind, LinalgError, Scalar};
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};

/// Marks a vertex without a row and a link without an entry.
const NONE: u32 = u32::MAX;

/// Which vertices are unknown, and where each coefficient stands in the matrix.
#[derive(Clone, Debug)]
pub struct FreeSystem {
    free: Vec<VertexId>,
    row_of_vertex: Vec<u32>,
    pattern: SparsityPattern,
    /// For each link the place of entry (tail, head), `NONE` where an end is pinned.
    slot_of_link: Vec<u32>,
    /// For each row the place of its diagonal entry.
    slot_of_diagonal: Vec<u32>,
    /// Links from a free to a pinned vertex.
    to_pinned: Vec<HalfedgeId>,
}

impl FreeSystem {
    /// Lays out the system of all vertices that belong to faces and are not pinned.
    ///
    /// # Panics
    ///
    /// If the system has 2³² entries or more.
    pub fn new(mesh: &DiskMesh, is_pinned: impl Fn(VertexId) -> bool) -> Self {
        let mut row_of_vertex = vec![NONE; mesh.vertex_count()];
        let free: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_used(v) && !is_pinned(v)).collect();
        for (row, v) in (0_u32..).zip(&free) {
            row_of_vertex[v.index()] = row;
        }
        let mut slot_of_link = vec![NONE; mesh.link_count()];
        let mut slot_of_diagonal = Vec::with_capacity(free.len());
        let mut to_pinned = Vec::new();
        let mut starts = Vec::with_capacity(free.len() + 1);
        let mut rows: Vec<usize> = Vec::with_capacity(free.len() + mesh.link_count());
        let mut column: Vec<(u32, HalfedgeId)> = Vec::new();
        starts.push(0);
        for &v in &free {
            column.clear();
            for h in mesh.links_from(v) {
                let row = row_of_vertex[mesh.head(h).index()];
                if row == NONE {
                    to_pinned.push(h);
                } else {
                    // The entry (tail, head) of the link that comes back stands in this column.
                    column.push((row, mesh.twin(h)));
                }
            }
            column.sort_unstable_by_key(|&(row, _)| row);
            let own = row_of_vertex[v.index()];
            let below = column.partition_point(|&(row, _)| row < own);
            let place = |offset: usize| u32::try_from(rows.len() + offset).expect("entries fit");
            slot_of_diagonal.push(place(below));
            for (i, &(_, h)) in column.iter().enumerate() {
                slot_of_link[h.index()] = place(i + usize::from(i >= below));
            }
            rows.extend(column[..below].iter().map(|&(row, _)| row as usize));
            rows.push(own as usize);
            rows.extend(column[below..].iter().map(|&(row, _)| row as usize));
            starts.push(rows.len());
        }
        let pattern = SparsityPattern::try_from_offsets_and_indices(free.len(), free.len(), starts, rows)
            .expect("columns were sorted and neighbours are distinct");
        Self { free, row_of_vertex, pattern, slot_of_link, slot_of_diagonal, to_pinned }
    }

    /// The vertices whose positions are unknown, in the order of the rows.
    pub fn free(&self) -> &[VertexId] {
        &self.free
    }

    /// The row of a vertex, `None` where it is pinned, or of no face.
    pub fn row(&self, vertex: VertexId) -> Option<usize> {
        let row = self.row_of_vertex[vertex.index()];
        (row != NONE).then_some(row as usize)
    }

    /// Where the values of the matrix have the diagonal entry of a row.
    pub(super) fn place_of_diagonal(&self, row: usize) -> usize {
        self.slot_of_diagonal[row] as usize
    }

    /// Where the matrix has entries. Symmetric, with a full diagonal.
    pub fn pattern(&self) -> &SparsityPattern {
        &self.pattern
    }

    /// The matrix `−A_FF`; positive definite where the coefficients are conformal.
    ///
    /// # Panics
    ///
    /// If the equations are not those of this mesh.
    pub fn negated_matrix<T>(&self, mesh: &DiskMesh, equations: &Equations<T>) -> CscMatrix<T>
    where
        T: Scalar,
    {
        let mut values = vec![T::ZERO; self.pattern.nnz()];
        for (h, &coefficient) in mesh.links().zip(&equations.coefficients) {
            let row = self.row_of_vertex[mesh.tail(h).index()];
            if row == NONE {
                continue;
            }
            values[self.slot_of_diagonal[row as usize] as usize] += coefficient;
            let slot = self.slot_of_link[h.index()];
            if slot != NONE {
                values[slot as usize] -= coefficient;
            }
        }
        CscMatrix::try_from_pattern_and_values(self.pattern.clone(), values).expect("one value per entry was made")
    }

    /// The vector `A_FP t`, the right-hand side that goes with [`negated_matrix`](Self::negated_matrix).
    pub fn pinned_terms<T, P>(
        &self,
        mesh: &DiskMesh,
        equations: &Equations<T>,
        target: impl Fn(VertexId) -> P,
    ) -> Vec<P>
    where
        T: Copy + Mul<P, Output = P>,
        P: Copy + Default + AddAssign,
    {
        let mut terms = vec![P::default(); self.free.len()];
        for &h in &self.to_pinned {
            let row = self.row_of_vertex[mesh.tail(h).index()];
            terms[row as usize] += equations.coefficients[h.index()] * target(mesh.head(h));
        }
        terms
    }

    /// ‖Ax − b‖ / ‖b‖, b being what the pinned vertices give where they lie.
    pub(super) fn relative_residual<T>(&self, mesh: &DiskMesh, equations: &Equations<T>, embedding: &Embedding) -> f64
    where
        T: Copy + Sync + Mul<Complex<f64>, Output = Complex<f64>>,
    {
        let rhs = self.pinned_terms(mesh, equations, |v| Complex::new(embedding[v].x, embedding[v].y));
        let whole: f64 = rhs.iter().map(Complex::norm_sqr).sum();
        let square = |&v: &VertexId| equations.residual_of(mesh, embedding, v).norm_sqr();
        let squares: Vec<f64> = self.free.par_iter().map(square).collect();
        let residual: f64 = squares.iter().sum();
        if residual > 0.0 { f64::sqrt(residual / whole) } else { 0.0 }
    }

    /// Orders and analyses its pattern.
    pub(super) fn analysis(&self, kind: Kind, control: Control<'_>) -> Result<Analysis, SolveError> {
        Analysis::new(kind, &self.pattern, control.cancel()).map_err(|error| self.named(error))
    }

    /// Says a linear solver's error in terms of the mesh: its rows are the free vertices.
    pub(super) fn named(&self, error: LinalgError) -> SolveError {
        match error {
            LinalgError::Singular { row }
            | LinalgError::NotPositiveDefinite { row }
            | LinalgError::NotFinite { row } => SolveError::Singular { vertex: self.free[row] },
            other => other.into(),
        }
    }
}

/// Where a system stands: its mesh and its unknowns.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub(super) mesh: &'a DiskMesh,
    pub(super) system: &'a FreeSystem,
}
