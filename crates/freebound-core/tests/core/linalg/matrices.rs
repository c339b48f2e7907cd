//! Random matrices on symmetric patterns, for the tests of the linear algebra.

use std::sync::atomic::AtomicBool;

use freebound_core::linalg::{Analysis, Factor, Kind, LinalgError, Scalar};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;

use freebound_testkit::Random;

/// Cancellation flag that is never set.
pub(crate) static GO_ON: AtomicBool = AtomicBool::new(false);

/// Scalar drawn from a random generator.
pub(crate) trait Draw: Scalar {
    fn draw(random: &mut Random) -> Self;
}
impl Draw for f64 {
    fn draw(random: &mut Random) -> Self {
        random.between(-1.0, 1.0)
    }
}
impl Draw for Complex<f64> {
    fn draw(random: &mut Random) -> Self {
        Self::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0))
    }
}

/// Pattern given by a predicate of column and row.
pub(crate) fn pattern_where(n: usize, joined: impl Fn(usize, usize) -> bool) -> SparsityPattern {
    let (mut offsets, mut rows) = (vec![0], Vec::new());
    for column in 0..n {
        rows.extend((0..n).filter(|&row| joined(column, row)));
        offsets.push(rows.len());
    }
    SparsityPattern::try_from_offsets_and_indices(n, n, offsets, rows).expect("sorted and in range")
}

/// Symmetric pattern with a full diagonal, in which about `density` of all pairs are joined.
pub(crate) fn random_pattern(n: usize, density: f64, random: &mut Random) -> SparsityPattern {
    let joined: Vec<bool> = (0..n * n).map(|_| random.unit() < density).collect();
    pattern_where(n, |i, j| i == j || joined[i.max(j) * n + i.min(j)])
}

/// Pattern of a grid of `side` × `side` vertices with one diagonal per cell.
pub(crate) fn grid_pattern(side: usize) -> SparsityPattern {
    pattern_where(side * side, |a, b| {
        let (a, b) = (a.min(b), a.max(b));
        // The later of two vertices is never to the left: one diagonal of each cell is not an edge.
        b / side - a / side <= 1 && b % side >= a % side && b % side - a % side <= 1
    })
}

/// Random values with a dominant diagonal.
pub(crate) fn dominant<T: Draw>(pattern: &SparsityPattern, random: &mut Random) -> CscMatrix<T> {
    let n = pattern.major_dim() as f64;
    let value = |(column, row): (usize, usize), random: &mut Random| {
        T::draw(random) + if row == column { T::from_real(n) } else { T::ZERO }
    };
    let values = pattern.entries().map(|entry| value(entry, random)).collect();
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

/// Random Hermitian matrix with a dominant diagonal, times `sign`.
pub(crate) fn hermitian<T: Draw>(pattern: &SparsityPattern, sign: f64, random: &mut Random) -> CscMatrix<T> {
    let half: CscMatrix<T> = dominant(pattern, random);
    let adjoint = half.transpose();
    let pairs = half.values().iter().zip(adjoint.values());
    let values = pairs.map(|(&value, mirrored)| (value + mirrored.conjugate()).scale(0.5 * sign)).collect();
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

/// Positive random weights λ off the diagonal and −Σλ on it. If `leak` is 0, every row sums to 0 and A is singular.
pub(crate) fn laplacian(pattern: &SparsityPattern, leak: f64, random: &mut Random) -> CscMatrix<f64> {
    let entries: Vec<(usize, usize)> = pattern.entries().collect();
    let mut values: Vec<f64> = entries.iter().map(|_| 0.1 + random.unit()).collect();
    let mut sums = vec![leak; pattern.major_dim()];
    for (&(_, row), value) in entries.iter().zip(&values).filter(|((column, row), _)| column != row) {
        sums[row] += value;
    }
    for (&(_, row), value) in entries.iter().zip(&mut values).filter(|((column, row), _)| column == row) {
        *value = -sums[row];
    }
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

pub(crate) fn scale_rows(matrix: &mut CscMatrix<f64>, scale: impl Fn(usize) -> f64) {
    let rows = matrix.row_indices().to_vec();
    for (row, value) in rows.into_iter().zip(matrix.values_mut()) {
        *value *= scale(row);
    }
}

pub(crate) fn factored<T: Scalar>(kind: Kind, matrix: &CscMatrix<T>) -> Result<Factor<T>, LinalgError> {
    Analysis::new(kind, matrix.pattern(), &AtomicBool::new(false))?.factor(matrix, &AtomicBool::new(false))
}
