//! Least squares with many pins: the residuals of the equations and the moves of the vertices in one sparse system.
//!
//! `least_squares.rs` solves once for every pin and keeps a dense matrix of them: its time grows with the cube of
//! their number. The sparse system here has the same minimum without either. With the residuals r of all equations
//! that are kept, the moves δ of all vertices that can move, and the compliances c of the soft pins, `r = A δ + D`
//! and stationarity are
//!
//! ```text
//! ⎡ −I     A f        ⎤ ⎡ r   ⎤   ⎡ −D          ⎤
//! ⎣ f Aᴴ  f² diag 1/c ⎦ ⎣ δ/f ⎦ = ⎣ f diag 1/c τ ⎦      f² = min(1, c) by rows; without a soft pin 1/c = 0
//! ```
//!
//! (the augmented system of Björck 1967, "Iterative refinement of linear least squares solutions"). Residual and
//! move of a vertex are eliminated as a pair: a pair's pivot block is regular wherever the vertex's own coefficient
//! is not zero. So the order of elimination is as free as that of A itself, and A is never squared. The matrix is
//! Hermitian. A hard pin has a residual alone, and only if one of its neighbours can move.

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;

use super::least_squares::{Factored, Remainder, Spring};
use super::system::Site;
use crate::linalg::{Analysis, Kind, LinalgError};
use crate::mesh::VertexId;
use crate::problem::{Control, SolveError};
use crate::weights::equations::Equations;

type C64 = Complex<f64>;

/// Layout of the system: vertices that can move in the order of the unknowns of the [`Site`], two rows each, then
/// pins.
#[derive(Debug)]
pub(crate) struct ManyPins {
    /// Soft pins, ascending.
    pub(crate) springs: Vec<Spring>,
    /// Hard pins whose equations have a part in the minimum, ascending.
    kept: Vec<VertexId>,
}

/// Rows of the residual and of the move of a vertex; their columns have equal numbers.
#[derive(Clone, Copy)]
struct Rows {
    residual: usize,
    /// `None` for a pin.
    moved: Option<usize>,
}

impl ManyPins {
    /// Lays out the system. `rest` names the hard pins whose equations are kept, and the soft pins.
    pub(crate) fn new(site: Site<'_>, rest: Remainder) -> Self {
        let mut kept = rest.left_out;
        kept.retain(|&pin| site.mesh.links_from(pin).any(|h| site.system.row(site.mesh.head(h)).is_some()));
        Self { springs: rest.springs, kept }
    }

    /// Orders and analyses the system.
    pub(crate) fn analysis(&self, site: Site<'_>, control: Control<'_>) -> Result<Analysis, SolveError> {
        let coefficients = vec![C64::ZERO; site.mesh.link_count()];
        let matrix = self.matrix(site, &Equations { coefficients, bounded_corners: 0 });
        let kind = Kind::Augmented { pairs: site.system.free().len() };
        Analysis::new(kind, matrix.pattern(), control.cancel()).map_err(|error| self.named(site, error))
    }

    /// Matrix of the system. Its pattern does not depend on the values of the equations.
    pub(crate) fn matrix(&self, site: Site<'_>, equations: &Equations<C64>) -> CscMatrix<C64> {
        let order = self.order(site);
        let mut column: Vec<(usize, C64)> = Vec::new();
        let (mut offsets, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut add = |column: &mut Vec<(usize, C64)>| {
            column.sort_unstable_by_key(|&(row, _)| row);
            rows.extend(column.iter().map(|&(row, _)| row));
            values.extend(column.iter().map(|&(_, value)| value));
            offsets.push(rows.len());
            column.clear();
        };
        for &vertex in site.system.free() {
            self.residual_column(site, equations, vertex, &mut column);
            add(&mut column);
            self.move_column(site, equations, vertex, &mut column);
            add(&mut column);
        }
        for &pin in &self.kept {
            self.residual_column(site, equations, pin, &mut column);
            add(&mut column);
        }
        let pattern = SparsityPattern::try_from_offsets_and_indices(order, order, offsets, rows)
            .expect("columns were sorted and neighbours are distinct");
        CscMatrix::try_from_pattern_and_values(pattern, values).expect("one value per entry was made")
    }

    /// Column of the residual of a vertex. Explicit zeros make the pattern a pattern of pairs, so that pairs stay
    /// together.
    fn residual_column(
        &self,
        site: Site<'_>,
        equations: &Equations<C64>,
        vertex: VertexId,
        column: &mut Vec<(usize, C64)>,
    ) {
        let Some(own) = self.rows(site, vertex) else { return };
        column.push((own.residual, -C64::ONE));
        let mut of_itself = C64::ZERO;
        for h in site.mesh.links_from(vertex) {
            let (other, coefficient) = (site.mesh.head(h), equations.coefficients[h.index()]);
            of_itself -= coefficient;
            let Some(Rows { residual, moved }) = self.rows(site, other) else { continue };
            if let Some(moved) = moved {
                column.push((moved, coefficient.conj() * self.damping(other)));
            }
            if own.moved.is_some() || moved.is_some() {
                column.push((residual, C64::ZERO));
            }
        }
        if let Some(moved) = own.moved {
            column.push((moved, of_itself.conj() * self.damping(vertex)));
        }
    }

    /// Column of the move of a vertex that can move.
    fn move_column(
        &self,
        site: Site<'_>,
        equations: &Equations<C64>,
        vertex: VertexId,
        column: &mut Vec<(usize, C64)>,
    ) {
        let Some(Rows { residual, moved: Some(moved) }) = self.rows(site, vertex) else { return };
        let damping = self.damping(vertex);
        let of_itself = -site.mesh.links_from(vertex).map(|h| equations.coefficients[h.index()]).sum::<C64>();
        let pulled = self.spring(vertex).map_or(0.0, |pin| pull(pin.compliance));
        column.extend([(residual, of_itself * damping), (moved, pulled.into())]);
        for h in site.mesh.links_from(vertex) {
            let Some(Rows { residual, moved }) = self.rows(site, site.mesh.head(h)) else { continue };
            column.push((residual, equations.coefficients[site.mesh.twin(h).index()] * damping));
            column.extend(moved.map(|moved| (moved, C64::ZERO)));
        }
    }

    /// Solves for the moves of all vertices; see `LeastSquares::moves`.
    pub(crate) fn moves(
        &self,
        site: Site<'_>,
        factored: &Factored<'_>,
        residuals: &[C64],
        to_targets: &[C64],
    ) -> Result<Vec<C64>, SolveError> {
        let mut rhs = vec![C64::ZERO; self.order(site)];
        for &vertex in site.system.free().iter().chain(&self.kept) {
            if let Some(Rows { residual, .. }) = self.rows(site, vertex) {
                rhs[residual] = -residuals[vertex.index()];
            }
        }
        for (pin, &to_target) in self.springs.iter().zip(to_targets) {
            if let Some(row) = self.rows(site, pin.vertex).and_then(|rows| rows.moved) {
                rhs[row] = to_target * (pull(pin.compliance) / self.damping(pin.vertex));
            }
        }
        let solved = factored.factor.solve_correction(factored.matrix, &rhs, factored.cancel);
        let answer = solved.map_err(|error| self.named(site, error))?.x;
        let mut moves = vec![C64::ZERO; site.mesh.vertex_count()];
        for (place, vertex) in site.system.free().iter().enumerate() {
            moves[vertex.index()] = answer[2 * place + 1] * self.damping(*vertex);
        }
        Ok(moves)
    }

    /// Translates an error of the linear solver into terms of the mesh.
    pub(crate) fn named(&self, site: Site<'_>, error: LinalgError) -> SolveError {
        let free = site.system.free();
        let vertex_of = |row: usize| free.get(row / 2).copied().unwrap_or_else(|| self.kept[row - 2 * free.len()]);
        match error {
            LinalgError::Singular { row } | LinalgError::NotFinite { row } => {
                SolveError::Singular { vertex: vertex_of(row) }
            }
            other => other.into(),
        }
    }

    fn order(&self, site: Site<'_>) -> usize {
        2 * site.system.free().len() + self.kept.len()
    }

    fn rows(&self, site: Site<'_>, vertex: VertexId) -> Option<Rows> {
        if let Some(place) = site.system.row(vertex) {
            return Some(Rows { residual: 2 * place, moved: Some(2 * place + 1) });
        }
        let place = self.kept.binary_search(&vertex).ok()?;
        Some(Rows { residual: 2 * site.system.free().len() + place, moved: None })
    }

    /// Factor f of the equations of a vertex's move; the move itself is divided by f.
    fn damping(&self, vertex: VertexId) -> f64 {
        self.spring(vertex).map_or(1.0, |pin| pin.compliance.min(1.0).sqrt())
    }

    fn spring(&self, vertex: VertexId) -> Option<&Spring> {
        let place = self.springs.binary_search_by_key(&vertex, |pin| pin.vertex).ok()?;
        Some(&self.springs[place])
    }
}

/// Ratio f²/c: 0 if there is no pull, 1 for any compliance of at most 1.
fn pull(compliance: f64) -> f64 {
    compliance.recip().min(1.0)
}
