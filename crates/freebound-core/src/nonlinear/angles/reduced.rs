//! Newton step of ABF++: angles and the multipliers of faces are eliminated.
//!
//! # Equation
//!
//! In a face let D = W⁻¹ (three numbers d) and s = d₁ + d₂ + d₃. R holds the rows of its inner corners in the
//! Jacobian. The row of a sum is the unit row of its corner; the row of a wheel has cot α at the next corner and −cot
//! α at the previous corner. With the multiplier of the face eliminated, a face contributes
//!
//! ```text
//! G = D − d dᵀ/s                                  (3 × 3: no move of the angles' sum)
//! M λ⁺ = c − Σ R (G ∇E + d c_t/s)                 M = Σ R G Rᵀ
//! δ = −G (∇E + Rᵀ λ⁺) − d c_t/s
//! ```
//!
//! G is positive semidefinite. M is positive definite if the conditions are independent. The step takes one Cholesky
//! factorization with two unknowns per inner vertex and a block for every pair of neighbours.

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

use super::net::Net;
use super::newton::{Direction, Linearised};
use crate::linalg::{Analysis, Kind, LinalgError};
use crate::linear::block_pattern::{HELD, Neighbours};
use crate::problem::{Control, SolveError};

/// Pattern of M, and the location of the block of each pair of corners.
#[derive(Debug)]
pub(super) struct Reduced {
    pattern: SparsityPattern,
    /// Symbolic factorization; `None` if there is no inner vertex.
    analysis: Option<Analysis>,
    column_lengths: Vec<u32>,
    /// First index of each block of a face's corners, by row and column; [`HELD`] if there is no block.
    slots: Vec<[[u32; 3]; 3]>,
}

/// Contribution of a face to the step.
struct Part {
    /// Rows R of each corner: its sum and its wheel.
    rows: [[[f64; 3]; 2]; 3],
    /// Vector d/s.
    spread: [f64; 3],
    /// Matrix G.
    kept: [[f64; 3]; 3],
}

impl Part {
    fn new(angles: &[f64; 3], curvatures: &[f64; 3]) -> Self {
        let cotangents = angles.map(|angle| angle.tan().recip());
        let rows = [0, 1, 2].map(|k| {
            let (mut sum, mut wheel) = ([0.0; 3], [0.0; 3]);
            sum[k] = 1.0;
            (wheel[(k + 1) % 3], wheel[(k + 2) % 3]) = (cotangents[(k + 1) % 3], -cotangents[(k + 2) % 3]);
            [sum, wheel]
        });
        let d = curvatures.map(f64::recip);
        let spread = d.map(|entry| entry / (d[0] + d[1] + d[2]));
        // Avoids entries that are small differences of large numbers.
        let entry = |i: usize, j: usize| {
            if i == j { d[i] * (spread[(i + 1) % 3] + spread[(i + 2) % 3]) } else { -d[i] * spread[j] }
        };
        let kept = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Self { rows, spread, kept }
    }

    /// Product G x.
    fn keep(&self, x: &[f64; 3]) -> [f64; 3] {
        self.kept.map(|row| dot(&row, x))
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Reduced {
    pub(super) fn new(net: &Net<'_>, control: Control<'_>) -> Result<Self, SolveError> {
        let neighbours = Neighbours::new(&net.corners, net.inner.len());
        let pattern = neighbours.block_pattern(control)?;
        let slot = |row: u32, column: u32| {
            if row == HELD || column == HELD { HELD } else { neighbours.slot(row, column) }
        };
        let slots =
            net.corners.iter().map(|corners| corners.map(|row| corners.map(|column| slot(row, column)))).collect();
        let is_empty = net.inner.is_empty();
        let analysis = if is_empty { None } else { Some(Analysis::new(Kind::Hermitian, &pattern, control.cancel())?) };
        Ok(Self { pattern, analysis, column_lengths: neighbours.column_lengths(), slots })
    }

    /// Newton step at the point of linearisation.
    pub(super) fn direction(&self, at: &Linearised<'_>, control: Control<'_>) -> Result<Direction, SolveError> {
        let net = at.net;
        let count = at.angles.len();
        let parts = control.each(count, |face| Part::new(&at.angles[face], &at.curvatures[face]))?;
        let mut values = vec![0.0; self.pattern.nnz()];
        let mut rhs = at.gaps.as_flattened().to_vec();
        for run in control.runs(count) {
            for face in run? {
                let part = &parts[face];
                let kept = part.keep(&at.gradient[face]);
                let moved = [0, 1, 2].map(|k| kept[k] + part.spread[k] * at.face_gaps[face]);
                for (k, &place) in net.corners[face].iter().enumerate().filter(|(_, place)| **place != HELD) {
                    for (which, row) in part.rows[k].iter().enumerate() {
                        rhs[2 * place as usize + which] -= dot(row, &moved);
                    }
                }
                self.add(face, net.corners[face], part, &mut values);
            }
        }
        let multipliers = self.multipliers(net, values, &rhs, control)?;
        let angles = |face: usize| {
            let part = &parts[face];
            let mut pull = at.gradient[face];
            for (k, &place) in net.corners[face].iter().enumerate().filter(|(_, place)| **place != HELD) {
                for (row, multiplier) in part.rows[k].iter().zip(multipliers[place as usize]) {
                    pull.iter_mut().zip(row).for_each(|(pull, entry)| *pull += entry * multiplier);
                }
            }
            let kept = part.keep(&pull);
            [0, 1, 2].map(|k| -kept[k] - part.spread[k] * at.face_gaps[face])
        };
        Ok(Direction { angles: control.each(count, angles)?, multipliers })
    }

    /// Adds R G Rᵀ of a face.
    fn add(&self, face: usize, corners: [u32; 3], part: &Part, values: &mut [f64]) {
        for (i, row_slots) in self.slots[face].iter().enumerate() {
            for (j, &slot) in row_slots.iter().enumerate().filter(|(_, slot)| **slot != HELD) {
                let length = self.column_lengths[corners[j] as usize];
                for column in 0..2 {
                    let kept = part.keep(&part.rows[j][column]);
                    for row in 0..2 {
                        let place = slot as usize + column * length as usize + row;
                        values[place] += dot(&part.rows[i][row], &kept);
                    }
                }
            }
        }
    }

    fn multipliers(
        &self,
        net: &Net<'_>,
        values: Vec<f64>,
        rhs: &[f64],
        control: Control<'_>,
    ) -> Result<Vec<[f64; 2]>, SolveError> {
        let Some(analysis) = &self.analysis else { return Ok(Vec::new()) };
        let matrix =
            CscMatrix::try_from_pattern_and_values(self.pattern.clone(), values).expect("one value per entry was made");
        let named = |error| match error {
            LinalgError::NotPositiveDefinite { row } | LinalgError::NotFinite { row } => {
                SolveError::Singular { vertex: net.inner[row / 2] }
            }
            other => other.into(),
        };
        let factor = analysis.factor(&matrix, control.cancel()).map_err(named)?;
        let solved = factor.solve_correction(&matrix, rhs, control.cancel()).map_err(named)?.x;
        Ok(solved.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
    }
}
