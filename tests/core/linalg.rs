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
    let rhs: Vec<T> = (0..3 * n).map(|_| T::draw(&mut random)).collect();
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
}
