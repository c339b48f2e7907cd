//! Sparse factorizations against dense ones.

use std::sync::atomic::AtomicBool;

use faer::linalg::solvers::Solve;
use freebound_core::linalg::{Analysis, Kind, Scalar};
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;
use proptest::prelude::*;

use super::matrices::{
    Draw, GO_ON, dominant, factored, grid_pattern, hermitian, laplacian, pattern_where, random_pattern, scale_rows,
};
use freebound_testkit::Random;

/// Tolerance relative to the largest entry of the solution, for diagonally dominant matrices of order 40.
const TOLERANCE: f64 = 1e-11;

pub(crate) fn dense<T: Scalar>(matrix: &CscMatrix<T>) -> faer::Mat<T> {
    let mut dense = faer::Mat::from_fn(matrix.nrows(), matrix.ncols(), |_, _| T::ZERO);
    for (row, column, &value) in matrix.triplet_iter() {
        dense[(row, column)] = value;
    }
    dense
}

/// Largest difference between `x` and the dense solution, relative to the dense solution's largest entry.
pub(crate) fn deviation<T: Scalar>(dense: &faer::Mat<T>, x: &[T], rhs: &[T]) -> f64 {
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

fn agrees_with_dense<T: Draw>(seed: u64, n: usize, density: f64) {
    let mut random = Random(seed);
    let pattern = random_pattern(n, density, &mut random);
    let matrix: CscMatrix<T> = dominant(&pattern, &mut random);
    let factor = factored(Kind::General, &matrix).expect("a dominant matrix is regular");
    // More right-hand sides than a group of lanes, and than a group of refinement.
    let rhs: Vec<T> = (0..11 * n).map(|_| T::draw(&mut random)).collect();
    let dense = dense(&matrix);
    let many = factor.solve(&matrix, &rhs, &GO_ON).expect("regular");
    assert!(deviation(&dense, &many.x, &rhs) < TOLERANCE);
    assert!(many.residual < 1e-14, "{}", many.residual);
    let one = factor.solve(&matrix, &rhs[..n], &GO_ON).expect("regular");
    assert!(deviation(&dense, &one.x, &rhs[..n]) < TOLERANCE);
    let adjoint = factor.solve_adjoint(&matrix, &rhs[..n], &GO_ON).expect("regular");
    assert!(deviation(&dense.adjoint().to_owned(), &adjoint.x, &rhs[..n]) < TOLERANCE);
    let adjoints = factor.solve_adjoint(&matrix, &rhs[..3 * n], &GO_ON).expect("regular");
    assert!(deviation(&dense.adjoint().to_owned(), &adjoints.x, &rhs[..3 * n]) < TOLERANCE);
}

fn hermitian_agrees_with_dense<T: Draw>(seed: u64, n: usize, sign: f64) {
    let mut random = Random(seed);
    let pattern = random_pattern(n, 0.2, &mut random);
    let matrix: CscMatrix<T> = hermitian(&pattern, sign, &mut random);
    let factor = factored(Kind::Hermitian, &matrix).expect("definite");
    let rhs: Vec<T> = (0..2 * n).map(|_| T::draw(&mut random)).collect();
    let solved = factor.solve(&matrix, &rhs, &GO_ON).expect("definite");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
    let adjoint = factor.solve_adjoint(&matrix, &rhs[..n], &GO_ON).expect("definite");
    assert!(deviation(&dense(&matrix), &adjoint.x, &rhs[..n]) < TOLERANCE);
}

pub(crate) fn bits<T: Scalar>(x: &[T]) -> Vec<[u64; 2]> {
    x.iter().map(|x| [x.real().to_bits(), x.modulus_squared().to_bits()]).collect()
}

#[test]
fn rows_over_twenty_decades_do_not_spoil_the_answer() {
    let mut random = Random(7);
    let mut matrix = laplacian(&grid_pattern(30), 1e-3, &mut random);
    let n = matrix.nrows();
    let exact: Vec<f64> = (0..n).map(|_| random.between(-1.0, 1.0)).collect();
    let scales: Vec<f64> = (0..n).map(|_| 10f64.powf(20.0 * random.unit() - 10.0)).collect();
    scale_rows(&mut matrix, |row| scales[row]);
    let mut rhs = vec![0.0; n];
    for (row, column, value) in matrix.triplet_iter() {
        rhs[row] += value * exact[column];
    }
    let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("regular");
    assert!(solved.residual < 1e-14 && solved.scaled_residual < 1e-14, "{}", solved.residual);
    // The unscaled system has a condition number of about 1e4.
    let worst = solved.x.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-11, "{worst}");
}

#[test]
fn a_regular_matrix_with_a_zero_diagonal_is_solved() {
    // Leaves on a clique, each with a zero diagonal and eliminated before the clique. No exchange inside a supernode
    // avoids the zero pivot.
    let (clique, leaves) = (60, 20);
    let n = clique + leaves;
    let mut random = Random(21);
    let near = |leaf: usize, other: usize| other < clique && other % leaves == leaf - clique;
    let pattern = pattern_where(n, |i, j| match (i < clique, j < clique) {
        (true, true) => true,
        (false, true) => near(i, j),
        (true, false) => near(j, i),
        (false, false) => i == j,
    });
    let mut matrix: CscMatrix<Complex<f64>> = dominant(&pattern, &mut random);
    let places: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    for ((column, row), value) in places.into_iter().zip(matrix.values_mut()) {
        if row == column && row >= clique {
            *value = Complex::new(0.0, 0.0);
        }
    }
    let rhs: Vec<_> = (0..n).map(|_| Complex::draw(&mut random)).collect();
    let factor = factored(Kind::General, &matrix).expect("regular with probability one");
    assert!(factor.stats().replaced_pivots > 0, "otherwise this tests nothing");
    let solved = factor.solve(&matrix, &rhs, &GO_ON).expect("regular");
    assert!(solved.residual < 1e-12, "{}", solved.residual);
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < 1e-9);
}

#[test]
fn a_reused_analysis_gives_the_bits_of_a_fresh_one_and_two_runs_agree() {
    let mut random = Random(17);
    let pattern = grid_pattern(60);
    let shared = Analysis::new(Kind::General, &pattern, &AtomicBool::new(false)).expect("symmetric");
    let rhs: Vec<_> = (0..3600).map(|_| Complex::draw(&mut random)).collect();
    for _ in 0..3 {
        let matrix: CscMatrix<Complex<f64>> = dominant(&pattern, &mut random);
        let reused = shared.factor(&matrix, &AtomicBool::new(false)).and_then(|f| f.solve(&matrix, &rhs, &GO_ON));
        let fresh = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON));
        assert_eq!(bits(&reused.expect("regular").x), bits(&fresh.expect("regular").x));
    }
}

#[test]
fn an_adjoint_answer_that_dwarfs_its_right_hand_side_is_judged_by_its_backward_error() {
    // A with 1 on the diagonal, −1.7 and −0.3 below it. The solution of Aᴴ x = e grows by 1.86 per row, so rounding
    // alone leaves a residual.
    let n = 60;
    let pattern = pattern_where(n, |i, j| i.abs_diff(j) <= 2);
    let value = |(column, row): (usize, usize)| match (row + 2).checked_sub(column) {
        Some(2) => 1.0,
        Some(3) => -1.7,
        Some(4) => -0.3,
        _ => 0.0,
    };
    let values = pattern.entries().map(value).collect();
    let matrix = CscMatrix::try_from_pattern_and_values(pattern, values).expect("one value an entry");
    let mut rhs = vec![0.0; n];
    rhs[n - 1] = 1.0;
    let solved =
        factored(Kind::General, &matrix).and_then(|f| f.solve_adjoint(&matrix, &rhs, &GO_ON)).expect("regular");
    assert!(solved.residual > 1e-10, "otherwise this tests nothing");
    assert!(solved.backward_error < 1e-15, "{}", solved.backward_error);
    let (mut before, mut exact) = (0.0, 1.0);
    for x in solved.x.iter().rev() {
        assert!((x / exact - 1.0).abs() < 1e-13, "{x} for {exact}");
        (before, exact) = (exact, 1.7 * exact + 0.3 * before);
    }
}

#[test]
fn a_right_hand_side_of_zeros_has_residual_zero() {
    let matrix = laplacian(&grid_pattern(4), 0.1, &mut Random(1));
    let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &[0.0; 16], &GO_ON)).expect("regular");
    assert_eq!((solved.residual, solved.x), (0.0, vec![0.0; 16]));
}

#[test]
fn a_path_and_a_star_are_factored() {
    // The deepest and the widest elimination tree.
    let n = 3000;
    let path = |i: usize, j: usize| i.abs_diff(j) <= 1;
    let star = |i: usize, j: usize| i == j || i == 0 || j == 0;
    for joined in [&path as &dyn Fn(usize, usize) -> bool, &star] {
        let pattern = pattern_where(n, joined);
        let matrix = laplacian(&pattern, 0.1, &mut Random(1));
        let rhs = vec![1.0; n];
        let solved = factored(Kind::General, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("regular");
        // Every row sums to −0.1.
        assert!(solved.x.iter().all(|x| (x + 10.0).abs() < 1e-9));
    }
}

#[test]
fn an_empty_system_has_an_empty_answer() {
    let matrix = CscMatrix::<f64>::zeros(0, 0);
    for kind in [Kind::General, Kind::Hermitian] {
        let solved = factored(kind, &matrix).and_then(|f| f.solve(&matrix, &[], &GO_ON)).expect("nothing to do");
        assert!(solved.x.is_empty());
    }
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
