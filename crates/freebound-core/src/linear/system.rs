//! Linear system of the free vertices: vertex equations with the pinned vertices eliminated (paper §3.3).
//!
//! With F the free and P the pinned vertices, `A_FF z_F = −A_FP t`. The pattern depends on the mesh and on the set
//! of pinned vertices; weights and targets only change values.

use std::ops::{AddAssign, Mul};
use std::sync::Arc;

use crate::parallel::prelude::*;
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;

use crate::linalg::{Analysis, Kind, LinalgError, Pattern, Scalar};
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};
use crate::problem::{Control, Embedding, SolveError};
use crate::weights::equations::Equations;

/// Number of columns per task.
const COLUMNS_PER_TASK: usize = 16_384;

/// Marker of a vertex without a row and of an entry without a link.
const NONE: u32 = u32::MAX;

/// Layout of the system: its unknown vertices, and the position of each coefficient in the matrix.
#[derive(Clone, Debug)]
pub struct FreeSystem {
    free: Vec<VertexId>,
    row_of_vertex: Vec<u32>,
    /// Sparsity pattern of the matrix.
    pattern: Arc<Pattern>,
    /// Link of each entry (tail, head); `NONE` on the diagonal.
    links: Vec<u32>,
    /// Index of the diagonal entry of each row among the values.
    slot_of_diagonal: Vec<u32>,
    /// Links from a free to a pinned vertex.
    to_pinned: Vec<HalfedgeId>,
}

/// Consecutive columns of the system.
#[derive(Default)]
struct Columns {
    shapes: Vec<ColumnShape>,
    rows: Vec<u32>,
    /// Link of each entry, like [`FreeSystem::links`].
    links: Vec<u32>,
    to_pinned: Vec<HalfedgeId>,
}

struct ColumnShape {
    entries: usize,
    /// Number of entries above the diagonal.
    above: usize,
}

impl Columns {
    fn new(mesh: &DiskMesh, free: &[VertexId], row_of_vertex: &[u32]) -> Self {
        let mut this = Self::default();
        let mut column: Vec<(u32, u32)> = Vec::new();
        for &v in free {
            column.clear();
            let own = row_of_vertex[v.index()];
            column.push((own, NONE));
            for h in mesh.links_from(v) {
                let row = row_of_vertex[mesh.head(h).index()];
                if row == NONE {
                    this.to_pinned.push(h);
                } else {
                    // The entry (tail, head) of the reverse link belongs to this column.
                    column.push((row, mesh.twin(h).number()));
                }
            }
            column.sort_unstable_by_key(|&(row, _)| row);
            let above = column.partition_point(|&(row, _)| row < own);
            this.shapes.push(ColumnShape { entries: column.len(), above });
            this.rows.extend(column.iter().map(|&(row, _)| row));
            this.links.extend(column.iter().map(|&(_, link)| link));
        }
        this
    }
}

impl FreeSystem {
    /// Lays out the system of all vertices that belong to faces and are not pinned.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the system has 2³² entries or more.
    pub fn new(
        mesh: &DiskMesh,
        is_pinned: impl Fn(VertexId) -> bool,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let mut row_of_vertex = vec![NONE; mesh.vertex_count()];
        let free: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_used(v) && !is_pinned(v)).collect();
        for (row, v) in (0_u32..).zip(&free) {
            row_of_vertex[v.index()] = row;
        }
        let of_task = |own: &[VertexId]| control.go_on().map(|()| Columns::new(mesh, own, &row_of_vertex));
        let columns: Result<Vec<Columns>, SolveError> = free.par_chunks(COLUMNS_PER_TASK).map(of_task).collect();
        let columns = columns?;
        let (mut offsets, mut slot_of_diagonal) = (vec![0], Vec::with_capacity(free.len()));
        let mut begin = 0_u32;
        let narrow = |count: usize| u32::try_from(count).expect("neighbours fit");
        for count in columns.iter().flat_map(|some| &some.shapes) {
            slot_of_diagonal.push(begin + narrow(count.above));
            begin = begin.checked_add(narrow(count.entries)).expect("entries fit");
            offsets.push(begin);
        }
        control.go_on()?;
        let rows = columns.iter().map(|some| &some.rows[..]).collect::<Vec<_>>().concat();
        control.go_on()?;
        let links = columns.iter().map(|some| &some.links[..]).collect::<Vec<_>>().concat();
        let to_pinned = columns.iter().flat_map(|some| some.to_pinned.iter().copied()).collect();
        control.go_on()?;
        let pattern = Arc::new(Pattern { offsets, rows });
        Ok(Self { free, row_of_vertex, pattern, links, slot_of_diagonal, to_pinned })
    }

    /// Vertices with unknown positions, in the order of the rows.
    pub fn free(&self) -> &[VertexId] {
        &self.free
    }

    /// Row of a vertex; `None` if the vertex is pinned or belongs to no face.
    pub fn row(&self, vertex: VertexId) -> Option<usize> {
        let row = self.row_of_vertex[vertex.index()];
        (row != NONE).then_some(row as usize)
    }

    /// Index of the diagonal entry of a row among the values of the matrix.
    pub(crate) fn place_of_diagonal(&self, row: usize) -> usize {
        self.slot_of_diagonal[row] as usize
    }

    /// Sparsity pattern of the matrix: symmetric, with a full diagonal. Built anew by each call, since it takes
    /// twice the memory of the stored form.
    ///
    /// # Panics
    ///
    /// Never: columns are sorted and neighbours are distinct.
    pub fn pattern(&self) -> SparsityPattern {
        self.pattern.widened()
    }

    /// Matrix `−A_FF`, positive definite if the coefficients are conformal.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the equations are not those of this mesh.
    pub fn negated_matrix<T>(
        &self,
        mesh: &DiskMesh,
        equations: &Equations<T>,
        control: Control<'_>,
    ) -> Result<CscMatrix<T>, SolveError>
    where
        T: Scalar,
    {
        let coefficients = &equations.coefficients;
        // Links are summed in ascending order, so that the sum does not depend on the first link of the fan of a
        // vertex.
        let ascending = |links: &mut Vec<HalfedgeId>, row: usize| {
            links.clear();
            links.extend(mesh.links_from(self.free[row]));
            links.sort_unstable_by_key(|h| h.index());
            links.iter().fold(T::ZERO, |sum, h| sum + coefficients[h.index()])
        };
        let diagonal: Vec<T> = control.each_with(self.free.len(), Vec::new, ascending)?;
        let of_link = |link: u32| if link == NONE { T::ZERO } else { T::ZERO - coefficients[link as usize] };
        let mut values: Vec<T> = control.each(self.links.len(), |entry| of_link(self.links[entry]))?;
        for (&slot, sum) in self.slot_of_diagonal.iter().zip(diagonal) {
            values[slot as usize] = sum;
        }
        control.go_on()?;
        let matrix = CscMatrix::try_from_pattern_and_values(self.pattern(), values);
        Ok(matrix.expect("one value per entry was made"))
    }

    /// Vector `A_FP t`: the right-hand side for [`negated_matrix`](Self::negated_matrix).
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

    /// Relative residual ‖Ax − b‖ / ‖b‖. The right-hand side b holds the terms of the pinned vertices at their
    /// positions.
    pub(crate) fn relative_residual<T>(
        &self,
        mesh: &DiskMesh,
        equations: &Equations<T>,
        embedding: &Embedding,
        control: Control<'_>,
    ) -> Result<f64, SolveError>
    where
        T: Copy + Sync + Mul<Complex<f64>, Output = Complex<f64>>,
    {
        let rhs = self.pinned_terms(mesh, equations, |v| Complex::new(embedding[v].x, embedding[v].y));
        let whole: f64 = rhs.iter().map(Complex::norm_sqr).sum();
        let square = |row: usize| equations.residual_of(mesh, embedding, self.free[row]).norm_sqr();
        let squares: Vec<f64> = control.each(self.free.len(), square)?;
        let residual: f64 = squares.iter().sum();
        Ok(if residual > 0.0 { f64::sqrt(residual / whole) } else { 0.0 })
    }

    /// Orders and analyses the pattern.
    pub(crate) fn analysis(&self, kind: Kind, control: Control<'_>) -> Result<Analysis, SolveError> {
        Analysis::of(kind, Arc::clone(&self.pattern), control.cancel()).map_err(|error| self.named(error))
    }

    /// Translates an error of the linear solver into terms of the mesh: its rows are the free vertices.
    pub(crate) fn named(&self, error: LinalgError) -> SolveError {
        match error {
            LinalgError::Singular { row }
            | LinalgError::NotPositiveDefinite { row }
            | LinalgError::NotFinite { row } => SolveError::Singular { vertex: self.free[row] },
            other => other.into(),
        }
    }
}

/// Mesh and unknowns of a system.
#[derive(Clone, Copy)]
pub(crate) struct Site<'a> {
    pub(crate) mesh: &'a DiskMesh,
    pub(crate) system: &'a FreeSystem,
}
