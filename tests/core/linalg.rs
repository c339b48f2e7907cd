//! The sparse factorizations against dense ones, and what they say of bad matrices.

use std::sync::atomic::AtomicBool;

use faer::linalg::solvers::Solve;
use freebound::linalg::{Analysis, Factor, Kind, LinalgError, Scalar};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;
use proptest::prelude::*;

/// Relative to the largest entry of the answer, for matrices of order 40 with diagonals that dominate their rows.
const TOLERANCE: f64 = 1e-11;

/// A small random number generator (xorshift), so that a seed fixes a whole matrix.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}

/// A scalar drawn from a generator.
trait Draw: Scalar {
    fn draw(random: &mut Random) -> Self;
}
impl Draw for f64 {
    fn draw(random: &mut Random) -> Self {
        random.signed()
    }
}
impl Draw for Complex<f64> {
    fn draw(random: &mut Random) -> Self {
        Self::new(random.signed(), random.signed())
    }
}

/// A symmetric pattern with a full diagonal, in which about `density` of all pairs are joined.
fn random_pattern(n: usize, density: f64, random: &mut Random) -> SparsityPattern {
    let mut joined = vec![vec![false; n]; n];
    for i in 0..n {
        joined[i][i] = true;
        for j in 0..i {
            let is_joined = random.unit() < density;
            joined[i][j] = is_joined;
            joined[j][i] = is_joined;
        }
    }
    pattern_of(&joined)
}

fn pattern_of(joined: &[Vec<bool>]) -> SparsityPattern {
    let n = joined.len();
    let mut offsets = vec![0];
    let mut rows = Vec::new();
    for column in joined {
        rows.extend((0..n).filter(|&row| column[row]));
        offsets.push(rows.len());
    }
    SparsityPattern::try_from_offsets_and_indices(n, n, offsets, rows).expect("sorted and in range")
}

/// Random values whose diagonal outweighs its row.
fn dominant<T: Draw>(pattern: &SparsityPattern, random: &mut Random) -> CscMatrix<T> {
    let n = pattern.major_dim() as f64;
    let value = |(column, row): (usize, usize), random: &mut Random| {
        T::draw(random) + if row == column { T::from_real(n) } else { T::ZERO }
    };
    let values = pattern.entries().map(|entry| value(entry, random)).collect();
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

fn dense<T: Scalar>(matrix: &CscMatrix<T>) -> faer::Mat<T> {
    let mut dense = faer::Mat::from_fn(matrix.nrows(), matrix.ncols(), |_, _| T::ZERO);
    for (row, column, &value) in matrix.triplet_iter() {
        dense[(row, column)] = value;
    }
    dense
}

/// Largest difference between `x` and the dense solution, relative to the largest entry of the latter.
fn deviation<T: Scalar>(dense: &faer::Mat<T>, x: &[T], rhs: &[T]) -> f64 {
    let n = dense.nrows();
    let count = rhs.len() / n;
    let rhs = faer::MatRef::from_column_major_slice(rhs, n, count);
    let exact = dense.partial_piv_lu().solve(rhs);
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for (place, &x) in x.iter().enumerate() {
        let exact = exact[(place % n, place / n)];
        worst = worst.max((x - exact).size());
        largest = largest.max(exact.size());
    }
    worst / largest
}

fn factored<T: Scalar>(kind: Kind, matrix: &CscMatrix<T>) -> Result<Factor<T>, LinalgError> {
    Analysis::new(kind, matrix.pattern())?.factor(matrix, &AtomicBool::new(false))
}

fn agrees_with_dense<T: Draw>(seed: u64, n: usize, density: f64) {
    let mut random = Random(seed | 1);
    let pattern = random_pattern(n, density, &mut random);
    let matrix: CscMatrix<T> = dominant(&pattern, &mut random);
    let factor = factored(Kind::General, &matrix).expect("a dominant matrix is regular");
    // More than a group of lanes and more than a group of refinement.
    let rhs: Vec<T> = (0..11 * n).map(|_| T::draw(&mut random)).collect();
    let dense = dense(&matrix);
    let many = factor.solve_many(&matrix, &rhs).expect("regular");
    assert!(deviation(&dense, &many.x, &rhs) < TOLERANCE);
    assert!(many.residual < 1e-14, "{}", many.residual);
    let one = factor.solve(&matrix, &rhs[..n]).expect("regular");
    assert!(deviation(&dense, &one.x, &rhs[..n]) < TOLERANCE);
    let transposed = factor.solve_transpose(&matrix, &rhs[..n]).expect("regular");
    assert!(deviation(&dense.transpose().to_owned(), &transposed.x, &rhs[..n]) < TOLERANCE);
    let adjoint = factor.solve_adjoint(&matrix, &rhs[..n]).expect("regular");
    assert!(deviation(&dense.adjoint().to_owned(), &adjoint.x, &rhs[..n]) < TOLERANCE);
    let adjoints = factor.solve_adjoint_many(&matrix, &rhs[..3 * n]).expect("regular");
    assert!(deviation(&dense.adjoint().to_owned(), &adjoints.x, &rhs[..3 * n]) < TOLERANCE);
}

/// A random Hermitian matrix whose diagonal outweighs its row, times `sign`.
fn hermitian<T: Draw>(pattern: &SparsityPattern, sign: f64, random: &mut Random) -> CscMatrix<T> {
    let half: CscMatrix<T> = dominant(pattern, random);
    let adjoint = half.transpose();
    let pairs = half.values().iter().zip(adjoint.values());
    let values = pairs.map(|(&value, mirrored)| (value + mirrored.conjugated()).scaled(0.5 * sign)).collect();
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

fn hermitian_agrees_with_dense<T: Draw>(seed: u64, n: usize, sign: f64) {
    let mut random = Random(seed | 1);
    let pattern = random_pattern(n, 0.2, &mut random);
    let matrix: CscMatrix<T> = hermitian(&pattern, sign, &mut random);
    let factor = factored(Kind::Hermitian, &matrix).expect("definite");
    let rhs: Vec<T> = (0..2 * n).map(|_| T::draw(&mut random)).collect();
    let solved = factor.solve_many(&matrix, &rhs).expect("definite");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
    let transposed = factor.solve_transpose(&matrix, &rhs[..n]).expect("definite");
    assert!(deviation(&dense(&matrix).transpose().to_owned(), &transposed.x, &rhs[..n]) < TOLERANCE);
    let adjoint = factor.solve_adjoint(&matrix, &rhs[..n]).expect("definite");
    assert!(deviation(&dense(&matrix), &adjoint.x, &rhs[..n]) < TOLERANCE);
}

/// The pattern of a grid of `side` × `side` vertices with one diagonal a cell.
fn grid_pattern(side: usize) -> SparsityPattern {
    let joined = |a: usize, b: usize| {
        let (dx, dy) = ((a % side) as i64 - (b % side) as i64, (a / side) as i64 - (b / side) as i64);
        dx.abs() <= 1 && dy.abs() <= 1 && dx * dy >= 0
    };
    let n = side * side;
    let mut offsets = vec![0];
    let mut rows = Vec::new();
    for a in 0..n {
        // Neighbours are at most a row and a vertex away.
        let near = a.saturating_sub(side + 1)..(a + side + 2).min(n);
        rows.extend(near.filter(|&b| joined(a, b)));
        offsets.push(rows.len());
    }
    SparsityPattern::try_from_offsets_and_indices(n, n, offsets, rows).expect("sorted and in range")
}

/// Positive random weights λ off the diagonal and −Σλ on it; with `leak` 0 every row sums to 0 and A is singular.
fn laplacian(pattern: &SparsityPattern, leak: f64, random: &mut Random) -> CscMatrix<f64> {
    let entries: Vec<(usize, usize)> = pattern.entries().collect();
    let mut values: Vec<f64> = entries.iter().map(|_| 0.1 + random.unit()).collect();
    let mut sums = vec![leak; pattern.major_dim()];
    for (&(column, row), value) in entries.iter().zip(&values).filter(|((column, row), _)| column != row) {
        sums[row] += value;
        debug_assert!(column != row);
    }
    for (&(column, row), value) in entries.iter().zip(&mut values).filter(|((column, row), _)| column == row) {
        *value = -sums[row.max(column)];
    }
    CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value an entry")
}

fn scale_rows(matrix: &mut CscMatrix<f64>, scale: impl Fn(usize) -> f64) {
    let rows = matrix.row_indices().to_vec();
    for (row, value) in rows.into_iter().zip(matrix.values_mut()) {
        *value *= scale(row);
    }
}

fn bits<T: Scalar>(x: &[T]) -> Vec<[u64; 2]> {
    x.iter().map(|x| [x.real_part().to_bits(), x.squared_modulus().to_bits()]).collect()
}

#[test]
fn rows_over_twenty_decades_do_not_spoil_the_answer() {
    let mut random = Random(7);
    let mut matrix = laplacian(&grid_pattern(30), 1e-3, &mut random);
    let n = matrix.nrows();
    let exact: Vec<f64> = (0..n).map(|_| random.signed()).collect();
    let scales: Vec<f64> = (0..n).map(|_| 10f64.powf(20.0 * random.unit() - 10.0)).collect();
    scale_rows(&mut matrix, |row| scales[row]);
    let mut rhs = vec![0.0; n];
    for (row, column, value) in matrix.triplet_iter() {
        rhs[row] += value * exact[column];
    }
    let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs)).expect("regular");
    assert!(solved.residual < 1e-14 && solved.scaled_residual < 1e-14, "{}", solved.residual);
    // The unscaled system has a condition number of about 1e4.
    let worst = solved.x.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-11, "{worst}");
}

#[test]
fn a_matrix_with_zero_row_sums_is_singular() {
    for side in [2, 5, 30] {
        let matrix = laplacian(&grid_pattern(side), 0.0, &mut Random(3));
        let error = factored(Kind::General, &matrix).expect_err("the constant vector is in the kernel");
        assert!(matches!(error, LinalgError::Singular { row } if row < side * side), "{error}");
    }
}

#[test]
fn a_zero_row_or_column_is_named() {
    let mut random = Random(5);
    let mut matrix = laplacian(&grid_pattern(6), 0.1, &mut random);
    scale_rows(&mut matrix, |row| if row == 11 { 0.0 } else { 1.0 });
    assert_eq!(factored(Kind::General, &matrix).expect_err("a zero row"), LinalgError::Singular { row: 11 });
    let column = matrix.transpose();
    assert_eq!(factored(Kind::General, &column).expect_err("a zero column"), LinalgError::Singular { row: 11 });
}

#[test]
fn two_equal_rows_are_singular() {
    let joined = vec![vec![true; 5]; 5];
    let mut matrix: CscMatrix<Complex<f64>> = dominant(&pattern_of(&joined), &mut Random(9));
    for column in 0..5 {
        let value = matrix.values()[5 * column + 1];
        matrix.values_mut()[5 * column + 3] = value;
    }
    assert!(matches!(factored(Kind::General, &matrix), Err(LinalgError::Singular { .. })));
}

#[test]
fn a_regular_matrix_with_a_zero_diagonal_is_solved() {
    // Leaves on a clique, each with a zero on its diagonal and eliminated before the clique: a pivot of zero that no
    // exchange inside its supernode can avoid.
    let (clique, leaves) = (60, 20);
    let n = clique + leaves;
    let mut random = Random(21);
    let mut joined = vec![vec![false; n]; n];
    for i in 0..n {
        for j in 0..n {
            let near = |leaf: usize, other: usize| other < clique && other % leaves == leaf - clique;
            joined[i][j] = match (i < clique, j < clique) {
                (true, true) => true,
                (false, true) => near(i, j),
                (true, false) => near(j, i),
                (false, false) => i == j,
            };
        }
    }
    let mut matrix: CscMatrix<Complex<f64>> = dominant(&pattern_of(&joined), &mut random);
    let places: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    for ((column, row), value) in places.into_iter().zip(matrix.values_mut()) {
        if row == column && row >= clique {
            *value = Complex::new(0.0, 0.0);
        }
    }
    let rhs: Vec<_> = (0..n).map(|_| Complex::draw(&mut random)).collect();
    let factor = factored(Kind::General, &matrix).expect("regular with probability one");
    assert!(factor.stats().replaced_pivots > 0, "otherwise this tests nothing");
    let solved = factor.solve(&matrix, &rhs).expect("regular");
    assert!(solved.residual < 1e-12, "{}", solved.residual);
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < 1e-9);
}

#[test]
fn an_indefinite_matrix_is_not_factored_as_a_definite_one() {
    let mut matrix: CscMatrix<f64> = hermitian(&grid_pattern(8), 1.0, &mut Random(1));
    let entry = matrix.get_entry_mut(20, 20).expect("the diagonal is there");
    if let nalgebra_sparse::SparseEntryMut::NonZero(value) = entry {
        *value = -*value;
    }
    let error = factored(Kind::Hermitian, &matrix).expect_err("one negative pivot");
    assert!(matches!(error, LinalgError::NotPositiveDefinite { row } if row < 64), "{error}");
}

#[test]
fn a_nan_is_named_by_its_row() {
    for kind in [Kind::General, Kind::Hermitian] {
        let mut matrix: CscMatrix<f64> = hermitian(&grid_pattern(6), 1.0, &mut Random(1));
        if let Some(nalgebra_sparse::SparseEntryMut::NonZero(value)) = matrix.get_entry_mut(9, 8) {
            *value = f64::NAN;
        }
        assert_eq!(factored(kind, &matrix).expect_err("a NaN"), LinalgError::NotFinite { row: 9 });
    }
}

#[test]
fn a_nan_in_the_right_hand_side_is_named_by_its_row() {
    let matrix = laplacian(&grid_pattern(4), 0.1, &mut Random(1));
    let factor = factored(Kind::General, &matrix).expect("regular");
    let mut rhs = vec![0.0; 32];
    rhs[16 + 5] = f64::INFINITY;
    assert_eq!(factor.solve_many(&matrix, &rhs).expect_err("infinite"), LinalgError::NotFinite { row: 5 });
}

#[test]
fn a_cancelled_factorization_stops() {
    let matrix = laplacian(&grid_pattern(20), 0.1, &mut Random(1));
    for kind in [Kind::General, Kind::Hermitian] {
        let analysis = Analysis::new(kind, matrix.pattern()).expect("symmetric");
        assert_eq!(analysis.factor(&matrix, &AtomicBool::new(true)).expect_err("cancelled"), LinalgError::Cancelled);
    }
}

#[test]
fn a_reused_analysis_gives_the_bits_of_a_fresh_one_and_two_runs_agree() {
    let mut random = Random(17);
    let pattern = grid_pattern(60);
    let shared = Analysis::new(Kind::General, &pattern).expect("symmetric");
    let rhs: Vec<_> = (0..3600).map(|_| Complex::draw(&mut random)).collect();
    for _ in 0..3 {
        let matrix: CscMatrix<Complex<f64>> = dominant(&pattern, &mut random);
        let reused = shared.factor(&matrix, &AtomicBool::new(false)).and_then(|f| f.solve(&matrix, &rhs));
        let fresh = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs));
        assert_eq!(bits(&reused.expect("regular").x), bits(&fresh.expect("regular").x));
    }
}

#[test]
fn a_right_hand_side_of_zeros_has_residual_zero() {
    let matrix = laplacian(&grid_pattern(4), 0.1, &mut Random(1));
    let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &[0.0; 16])).expect("regular");
    assert_eq!((solved.residual, solved.x), (0.0, vec![0.0; 16]));
}

#[test]
fn a_path_and_a_star_are_factored() {
    // The deepest and the widest elimination tree.
    let n = 3000;
    let path = |i: usize| vec![i.saturating_sub(1), i, (i + 1).min(n - 1)];
    let star = |i: usize| if i == 0 { (0..n).collect() } else { vec![0, i] };
    for neighbours in [&path as &dyn Fn(usize) -> Vec<usize>, &star] {
        let (mut offsets, mut rows) = (vec![0], Vec::new());
        for i in 0..n {
            let mut column = neighbours(i);
            column.dedup();
            rows.extend(column);
            offsets.push(rows.len());
        }
        let pattern = SparsityPattern::try_from_offsets_and_indices(n, n, offsets, rows).expect("sorted");
        let matrix = laplacian(&pattern, 0.1, &mut Random(1));
        let rhs = vec![1.0; n];
        let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs)).expect("regular");
        // Every row sums to −0.1.
        assert!(solved.x.iter().all(|x| (x + 10.0).abs() < 1e-9));
    }
}

#[test]
fn an_empty_system_has_an_empty_answer() {
    let matrix = CscMatrix::<f64>::zeros(0, 0);
    for kind in [Kind::General, Kind::Hermitian] {
        let solved = factored(kind, &matrix).and_then(|f| f.solve(&matrix, &[])).expect("nothing to do");
        assert!(solved.x.is_empty());
    }
}

#[test]
fn a_pattern_without_its_mirror_image_or_diagonal_is_refused() {
    let mut joined = vec![vec![false; 3]; 3];
    (0..3).for_each(|i| joined[i][i] = true);
    joined[0][2] = true;
    let error = Analysis::new(Kind::General, &pattern_of(&joined)).expect_err("(2, 0) stands alone");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 2, column: 0 });
    joined[2][0] = true;
    joined[1][1] = false;
    let error = Analysis::new(Kind::General, &pattern_of(&joined)).expect_err("(1, 1) is missing");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 1, column: 1 });
}

#[test]
fn a_matrix_of_another_pattern_is_refused() {
    let analysis = Analysis::new(Kind::General, &grid_pattern(4)).expect("symmetric");
    let other = CscMatrix::<f64>::identity(16);
    assert_eq!(analysis.factor(&other, &AtomicBool::new(false)).expect_err("other"), LinalgError::OtherPattern);
}

proptest! {
    #[test]
    fn the_real_lu_agrees_with_a_dense_lu(seed: u64, n in 1usize..60, density in 0.0..0.5) {
        agrees_with_dense::<f64>(seed, n, density);
    }

    #[test]
    fn the_complex_lu_agrees_with_a_dense_lu(seed: u64, n in 1usize..60, density in 0.0..0.5) {
        agrees_with_dense::<Complex<f64>>(seed, n, density);
    }

    #[test]
    fn the_cholesky_factorization_agrees_with_a_dense_lu(seed: u64, n in 1usize..60, negative: bool) {
        let sign = if negative { -1.0 } else { 1.0 };
        hermitian_agrees_with_dense::<f64>(seed, n, sign);
        hermitian_agrees_with_dense::<Complex<f64>>(seed, n, sign);
    }
}
