//! Definite systems that need few digits: single-precision factors against double-precision solutions.

use std::sync::atomic::{AtomicBool, Ordering};

use freebound_core::linalg::{Analysis, FactorPrecision, Kind, LinalgError};
use nalgebra_sparse::CscMatrix;
use proptest::prelude::*;

use super::hermitian::{in_blocks, on_threads};
use super::matrices::{Draw, GO_ON, factored, grid_pattern, hermitian, laplacian, pattern_where, random_pattern};
use super::solvers::bits;
use freebound_testkit::Random;

/// Largest relative error of single precision in the norm of the matrix. The module requires it in the norm of its
/// factors, which is nearly equal.
const ROUGH: f64 = 2e-2;

fn positive_laplacian(side: usize, leak: f64) -> CscMatrix<f64> {
    let mut matrix = laplacian(&grid_pattern(side), leak, &mut Random(3));
    // Weights of both directions are drawn independently; their mean is symmetric.
    let other = matrix.transpose();
    let pairs: Vec<f64> = matrix.values().iter().zip(other.values()).map(|(a, b)| -0.5 * (a + b)).collect();
    matrix.values_mut().copy_from_slice(&pairs);
    let sums: Vec<f64> = matrix.col_iter().map(|column| column.values().iter().sum()).collect();
    for (row, sum) in sums.into_iter().enumerate() {
        set_diagonal(&mut matrix, row, |value| value - sum + leak);
    }
    matrix
}

fn set_diagonal(matrix: &mut CscMatrix<f64>, row: usize, to: impl Fn(f64) -> f64) {
    let Some(nalgebra_sparse::SparseEntryMut::NonZero(value)) = matrix.get_entry_mut(row, row) else {
        panic!("the diagonal is stored")
    };
    *value = to(*value);
}

/// Solves with factors of the given precision.
fn rough(matrix: &CscMatrix<f64>, rhs: &[f64], precision: FactorPrecision) -> Result<Vec<f64>, LinalgError> {
    let analysis = Analysis::new(Kind::Hermitian, matrix.pattern(), &GO_ON)?;
    analysis.factor_roughly(matrix.values(), precision, None, &GO_ON)?.solve(matrix.values(), rhs, &GO_ON)
}

/// Quadratic form xᵀ A x.
fn energy(matrix: &CscMatrix<f64>, x: &[f64]) -> f64 {
    matrix.triplet_iter().map(|(i, j, value)| x[i] * value * x[j]).sum()
}

/// Error of a solution relative to the refined solution, in the norm of the matrix.
fn error(matrix: &CscMatrix<f64>, rhs: &[f64], x: &[f64]) -> f64 {
    let best =
        factored(Kind::Hermitian, matrix).and_then(|f| f.solve_correction(matrix, rhs, &GO_ON)).expect("definite").x;
    let off: Vec<f64> = x.iter().zip(&best).map(|(x, best)| x - best).collect();
    (energy(matrix, &off) / energy(matrix, &best)).sqrt()
}

fn drawn(n: usize, random: &mut Random) -> Vec<f64> {
    (0..n).map(|_| f64::draw(random)).collect()
}

#[test]
fn single_precision_gives_the_digits_that_are_asked_for_and_double_all_of_them() {
    let matrix = positive_laplacian(40, 1e-3);
    let rhs = drawn(matrix.nrows(), &mut Random(4));
    for (precision, most) in [(FactorPrecision::Single, ROUGH), (FactorPrecision::Double, 1e-10)] {
        let x = rough(&matrix, &rhs, precision).expect("definite");
        let error = error(&matrix, &rhs, &x);
        assert!(error < most, "{precision:?}: {error:e}");
    }
}

#[test]
fn rows_of_any_size_are_within_reach_of_32_bits() {
    // Their squares are not: from 1e-30 to 1e30.
    let mut matrix = positive_laplacian(20, 0.1);
    let n = matrix.nrows();
    let scale = |row: usize| 10_f64.powi(i32::try_from(row % 31).expect("small") - 15);
    let places: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    for ((column, row), value) in places.into_iter().zip(matrix.values_mut()) {
        *value *= scale(row) * scale(column);
    }
    let rhs: Vec<f64> = drawn(n, &mut Random(5)).iter().enumerate().map(|(row, b)| b * scale(row)).collect();
    let x = rough(&matrix, &rhs, FactorPrecision::Single).expect("definite");
    let error = error(&matrix, &rhs, &x);
    assert!(error < ROUGH, "{error:e}");
}

#[test]
fn a_mode_that_rounding_to_32_bits_loses_is_found_all_the_same() {
    // The constant vector has 1e-9 of the energy of the others, so the matrix is singular in 32 bits.
    let matrix = positive_laplacian(30, 1e-9);
    let mut rhs = drawn(matrix.nrows(), &mut Random(6));
    // Adds a part along that mode, as large in the solution as all the rest.
    for b in &mut rhs {
        *b += 1e-4;
    }
    let x = rough(&matrix, &rhs, FactorPrecision::Single).expect("definite");
    let error = error(&matrix, &rhs, &x);
    assert!(error < ROUGH, "{error:e}");
}

#[test]
fn what_is_not_positive_is_refused_in_either_precision() {
    for to in [-1.0, 0.0] {
        let mut matrix = positive_laplacian(12, 0.1);
        set_diagonal(&mut matrix, 77, |_| to);
        for precision in [FactorPrecision::Single, FactorPrecision::Double] {
            let answer = rough(&matrix, &drawn(144, &mut Random(7)), precision);
            assert!(matches!(answer, Err(LinalgError::NotPositiveDefinite { .. })), "{precision:?}: {answer:?}");
        }
    }
}

#[test]
fn values_that_do_not_belong_to_the_pattern_are_refused() {
    let matrix = positive_laplacian(8, 0.1);
    let analysis = Analysis::new(Kind::Hermitian, matrix.pattern(), &GO_ON).expect("symmetric");
    let factor = |values: &[f64]| analysis.factor_roughly(values, FactorPrecision::Single, None, &GO_ON).map(|_| ());
    assert_eq!(factor(&matrix.values()[1..]), Err(LinalgError::OtherPattern));
    let mut broken = matrix.values().to_vec();
    let place = broken.len() - 1;
    broken[place] = f64::NAN;
    assert_eq!(factor(&broken), Err(LinalgError::NotFinite { row: 63 }));
    let general = Analysis::new(Kind::General, matrix.pattern(), &GO_ON).expect("symmetric");
    let answer = general.factor_roughly(matrix.values(), FactorPrecision::Double, None, &GO_ON);
    assert!(matches!(answer, Err(LinalgError::OtherPattern)));
}

#[test]
fn the_memory_of_an_earlier_factor_leaves_no_trace() {
    let [first, second] = [0.1, 1e-3].map(|leak| positive_laplacian(25, leak));
    let analysis = Analysis::new(Kind::Hermitian, first.pattern(), &GO_ON).expect("symmetric");
    let rhs = drawn(first.nrows(), &mut Random(8));
    for earlier in [FactorPrecision::Single, FactorPrecision::Double] {
        for precision in [FactorPrecision::Single, FactorPrecision::Double] {
            let earlier = analysis.factor_roughly(first.values(), earlier, None, &GO_ON).expect("definite");
            let again = analysis.factor_roughly(second.values(), precision, Some(earlier), &GO_ON).expect("definite");
            let x = again.solve(second.values(), &rhs, &GO_ON).expect("definite");
            assert_eq!(bits(&x), bits(&rough(&second, &rhs, precision).expect("definite")));
        }
    }
}

#[test]
fn a_rough_answer_has_the_same_bits_on_any_number_of_threads() {
    // More rows than a single task sums.
    let matrix = positive_laplacian(80, 1e-4);
    let rhs = drawn(matrix.nrows(), &mut Random(9));
    let solve = || rough(&matrix, &rhs, FactorPrecision::Single).expect("definite");
    let alone = on_threads(1, solve);
    for threads in [2, 5] {
        assert_eq!(bits(&alone), bits(&on_threads(threads, solve)));
    }
}

#[test]
fn cancelling_ends_a_rough_solve() {
    let matrix = positive_laplacian(12, 0.1);
    let analysis = Analysis::new(Kind::Hermitian, matrix.pattern(), &GO_ON).expect("symmetric");
    let factor = analysis.factor_roughly(matrix.values(), FactorPrecision::Single, None, &GO_ON).expect("definite");
    let cancel = AtomicBool::new(false);
    cancel.store(true, Ordering::Relaxed);
    assert_eq!(factor.solve(matrix.values(), &[1.0; 144], &cancel), Err(LinalgError::Cancelled));
    let answer = analysis.factor_roughly(matrix.values(), FactorPrecision::Single, None, &cancel);
    assert!(matches!(answer, Err(LinalgError::Cancelled)));
}

#[test]
fn an_order_that_has_become_bad_is_given_up() {
    // A path in its natural order, closed to a star around its first vertex: eliminated in that order, the rest of
    // the star is a clique.
    let path = pattern_where(400, |i, j| i.abs_diff(j) <= 1);
    let order =
        Analysis::new(Kind::Hermitian, &path, &GO_ON).expect("symmetric").order().expect("that of a Hermitian matrix");
    let star = pattern_where(400, |i, j| i == j || i * j == 0);
    let matrix: CscMatrix<f64> = hermitian(&star, 1.0, &mut Random(10));
    let bytes = |analysis: Analysis| analysis.factor(&matrix, &GO_ON).expect("definite").stats().factor_bytes;
    let kept = bytes(Analysis::in_order(&order, &star, &GO_ON).expect("symmetric"));
    let fresh = bytes(Analysis::new(Kind::Hermitian, &star, &GO_ON).expect("symmetric"));
    assert_eq!(kept, fresh);
}

proptest! {
    #[test]
    fn rough_answers_on_any_pattern_are_near_the_best(seed: u64, n in 1usize..25, density in 0.0..0.5) {
        let mut random = Random(seed);
        let matrix: CscMatrix<f64> = hermitian(&in_blocks(&random_pattern(n, density, &mut random)), 1.0, &mut random);
        let rhs = drawn(2 * n, &mut random);
        let x = rough(&matrix, &rhs, FactorPrecision::Single).expect("definite");
        let error = error(&matrix, &rhs, &x);
        prop_assert!(error < ROUGH, "{error:e}");
    }
}
