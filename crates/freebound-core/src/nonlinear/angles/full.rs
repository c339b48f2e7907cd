//! Newton step of ABF: angles and multipliers in one symmetric system.
//!
//! # Equation
//!
//! ```text
//! ⎡ −F W F   F Jᵀ ⎤ ⎡  F⁻¹ δ ⎤   ⎡ F ∇E ⎤
//! ⎣  J F      0   ⎦ ⎣  −λ⁺   ⎦ = ⎣ −c   ⎦          F = diag(φ): all angles by their own size
//! ```
//!
//! Each angle row that is paired with a multiplier (`pairs.rs`) is followed by the row of that multiplier. The
//! factorization of augmented matrices requires this order (`linalg/ldlt.rs`). All other angles follow.

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

use super::net::Net;
use super::newton::{Direction, Linearised};
use super::pairs::Pairs;
use crate::linalg::{Analysis, Kind, LinalgError};
use crate::linear::block_pattern::HELD;
use crate::mesh::FaceId;
use crate::problem::{Control, SolveError};

/// Layout of the system.
#[derive(Debug)]
pub(super) struct Full {
    rows: Rows,
    pattern: SparsityPattern,
    analysis: Analysis,
    /// Index of the diagonal entry of each angle.
    diagonal: Vec<usize>,
    /// Indices of each coefficient below and above the diagonal, face by face.
    slots: Vec<[usize; 2]>,
}

/// Row numbers of angles and multipliers.
#[derive(Debug)]
struct Rows {
    /// Row of each angle, by its number 3 · face + corner.
    of_angles: Vec<usize>,
    of_faces: Vec<usize>,
    of_vertices: Vec<[usize; 2]>,
    /// Number of pairs; rows below twice this number are paired.
    pairs: usize,
}

/// Coefficient of the Jacobian.
struct Coefficient {
    /// Corner of the angle in its face.
    corner: usize,
    /// Row of the multiplier.
    row: usize,
    value: f64,
}

impl Rows {
    fn new(net: &Net<'_>) -> Self {
        let Pairs { of_faces, of_vertices } = Pairs::new(net);
        let mut of_angles = vec![usize::MAX; 3 * net.corners.len()];
        let partners = of_faces.iter().chain(of_vertices.as_flattened());
        for (pair, &angle) in partners.enumerate() {
            of_angles[angle] = 2 * pair;
        }
        let pairs = of_faces.len() + 2 * of_vertices.len();
        let alone = of_angles.iter_mut().filter(|row| **row == usize::MAX);
        alone.zip(2 * pairs..).for_each(|(row, number)| *row = number);
        let after = |angle: &usize| of_angles[*angle] + 1;
        Self {
            of_faces: of_faces.iter().map(after).collect(),
            of_vertices: of_vertices.iter().map(|[sum, wheel]| [after(sum), after(wheel)]).collect(),
            of_angles,
            pairs,
        }
    }

    /// Node of a row: the two rows of a pair, or a single row.
    fn node(&self, row: usize) -> usize {
        if row < 2 * self.pairs { row / 2 } else { row - self.pairs }
    }

    fn rows_of(&self, node: usize) -> std::ops::Range<usize> {
        if node < self.pairs { 2 * node..2 * node + 2 } else { node + self.pairs..node + self.pairs + 1 }
    }

    /// Coefficients of a face in the Jacobian, always in a fixed order.
    fn coefficients(&self, net: &Net<'_>, face: usize, angles: &[f64; 3]) -> Vec<Coefficient> {
        let mut found = Vec::with_capacity(12);
        let of_face = self.of_faces[face];
        found.extend((0..3).map(|corner| Coefficient { corner, row: of_face, value: 1.0 }));
        let cotangents = angles.map(|angle| angle.tan().recip());
        for (k, &place) in net.corners[face].iter().enumerate().filter(|(_, place)| **place != HELD) {
            let [sum, wheel] = self.of_vertices[place as usize];
            let [after, before] = [(k + 1) % 3, (k + 2) % 3];
            found.push(Coefficient { corner: k, row: sum, value: 1.0 });
            found.push(Coefficient { corner: after, row: wheel, value: cotangents[after] });
            found.push(Coefficient { corner: before, row: wheel, value: -cotangents[before] });
        }
        found
    }

    /// Sparsity pattern: two nodes that share a coefficient are connected with all their rows.
    fn pattern(&self, net: &Net<'_>) -> SparsityPattern {
        let order = self.of_angles.len() + self.pairs;
        let mut joined: Vec<[usize; 2]> = (0..self.of_angles.len()).map(|node| [node, node]).collect();
        for (face, angles) in net.targets.iter().enumerate() {
            for coefficient in self.coefficients(net, face, angles) {
                let angle = self.node(self.of_angles[3 * face + coefficient.corner]);
                let multiplier = self.node(coefficient.row);
                joined.extend([[angle, multiplier], [multiplier, angle]]);
            }
        }
        joined.sort_unstable();
        joined.dedup();
        let (mut offsets, mut rows) = (vec![0], Vec::new());
        for neighbours in joined.chunk_by(|a, b| a[0] == b[0]) {
            for _ in self.rows_of(neighbours[0][0]) {
                rows.extend(neighbours.iter().flat_map(|pair| self.rows_of(pair[1])));
                offsets.push(rows.len());
            }
        }
        SparsityPattern::try_from_offsets_and_indices(order, order, offsets, rows).expect("sorted and distinct")
    }
}

impl Full {
    pub(super) fn new(net: &Net<'_>, control: Control<'_>) -> Result<Self, SolveError> {
        let rows = Rows::new(net);
        let pattern = rows.pattern(net);
        let slot = |row: usize, column: usize| {
            let place = pattern.lane(column).binary_search(&row).expect("the pattern has all entries");
            pattern.major_offsets()[column] + place
        };
        let diagonal = rows.of_angles.iter().map(|&row| slot(row, row)).collect();
        let of_face = |(face, angles): (usize, &[f64; 3])| {
            let rows = &rows;
            rows.coefficients(net, face, angles).into_iter().map(move |coefficient| {
                let angle = rows.of_angles[3 * face + coefficient.corner];
                [slot(angle, coefficient.row), slot(coefficient.row, angle)]
            })
        };
        let slots = net.targets.iter().enumerate().flat_map(of_face).collect();
        let analysis = Analysis::new(Kind::Augmented { pairs: rows.pairs }, &pattern, control.cancel())?;
        Ok(Self { rows, pattern, analysis, diagonal, slots })
    }

    /// Newton step at the point of linearisation.
    pub(super) fn direction(&self, at: &Linearised<'_>, control: Control<'_>) -> Result<Direction, SolveError> {
        let Rows { of_angles, of_faces, of_vertices, .. } = &self.rows;
        let mut values = vec![0.0; self.pattern.nnz()];
        let mut rhs = vec![0.0; self.pattern.major_dim()];
        let mut slots = self.slots.iter();
        for (face, (angles, targets)) in at.angles.iter().zip(&at.net.targets).enumerate() {
            for k in 0..3 {
                values[self.diagonal[3 * face + k]] = -at.curvatures[face][k] * targets[k] * targets[k];
                rhs[of_angles[3 * face + k]] = at.gradient[face][k] * targets[k];
            }
            rhs[of_faces[face]] = -at.face_gaps[face];
            for (coefficient, places) in self.rows.coefficients(at.net, face, angles).iter().zip(&mut slots) {
                for &place in places {
                    values[place] += coefficient.value * targets[coefficient.corner];
                }
            }
        }
        for (rows, gaps) in of_vertices.iter().zip(&at.gaps) {
            rows.iter().zip(gaps).for_each(|(&row, gap)| rhs[row] = -gap);
        }
        let matrix =
            CscMatrix::try_from_pattern_and_values(self.pattern.clone(), values).expect("one value per entry was made");
        let named = |error| self.named(at.net, error);
        let factor = self.analysis.factor(&matrix, control.cancel()).map_err(named)?;
        let x = factor.solve_correction(&matrix, &rhs, control.cancel()).map_err(named)?.x;
        let move_of = |(face, targets): (usize, &[f64; 3])| [0, 1, 2].map(|k| x[of_angles[3 * face + k]] * targets[k]);
        Ok(Direction {
            angles: at.net.targets.iter().enumerate().map(move_of).collect(),
            multipliers: of_vertices.iter().map(|rows| rows.map(|row| -x[row])).collect(),
        })
    }

    /// Translates an error to the mesh: the vertex whose angle has the row, or the row before it.
    fn named(&self, net: &Net<'_>, error: LinalgError) -> SolveError {
        match error {
            LinalgError::Singular { row } | LinalgError::NotFinite { row } => {
                let node = self.rows.node(row);
                let angle = self.rows.of_angles.iter().position(|&row| self.rows.node(row) == node).unwrap_or_default();
                SolveError::Singular { vertex: net.mesh.face(FaceId::from_index(angle / 3))[angle % 3] }
            }
            other => other.into(),
        }
    }
}
