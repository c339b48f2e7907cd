//! Cholesky factorization: pairs of unknowns, large fronts, any number of threads, and matrices that are not
//! definite.

use std::sync::atomic::AtomicBool;

use freebound_core::linalg::{Analysis, Kind, LinalgError};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;
use proptest::prelude::*;

use super::matrices::{Draw, GO_ON, factored, grid_pattern, hermitian, pattern_where, random_pattern};
use super::solvers::{bits, dense, deviation};
use freebound_testkit::Random;

type C = Complex<f64>;

/// Tolerance relative to the largest entry of the solution; diagonals dominate their rows.
const TOLERANCE: f64 = 1e-11;

/// Pattern with a 2 × 2 block for every entry.
pub(crate) fn in_blocks(pattern: &SparsityPattern) -> SparsityPattern {
    let n = pattern.major_dim();
    let joined: std::collections::BTreeSet<(usize, usize)> = pattern.entries().collect();
    pattern_where(2 * n, |column, row| joined.contains(&(column / 2, row / 2)))
}

/// Runs `work` on a pool of `count` threads.
pub(crate) fn on_threads<R: Send>(count: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads").install(work)
}

#[test]
fn unknowns_in_pairs_are_analysed_as_pairs_and_solved_as_any() {
    let mut random = Random(5);
    let pattern = in_blocks(&grid_pattern(12));
    let matrix: CscMatrix<f64> = hermitian(&pattern, 1.0, &mut random);
    let rhs: Vec<f64> = (0..3 * matrix.nrows()).map(|_| f64::draw(&mut random)).collect();
    let factor = factored(Kind::Hermitian, &matrix).expect("definite");
    let solved = factor.solve(&matrix, &rhs, &GO_ON).expect("definite");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
    // Both columns of every pair are in one front, so the factor consists of whole blocks.
    assert_eq!(factor.stats().factor_bytes % (4 * size_of::<f64>()), 0);
}

#[test]
fn a_pattern_that_only_nearly_comes_in_pairs_is_solved_too() {
    let mut random = Random(6);
    let joined: std::collections::BTreeSet<(usize, usize)> = in_blocks(&grid_pattern(6)).entries().collect();
    let pattern = pattern_where(72, |column, row| {
        let pair = (column.min(row), column.max(row));
        pair != (0, 3) && joined.contains(&(column, row))
    });
    let matrix: CscMatrix<f64> = hermitian(&pattern, 1.0, &mut random);
    let rhs: Vec<f64> = (0..72).map(|_| f64::draw(&mut random)).collect();
    let solved = factored(Kind::Hermitian, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
}

#[test]
fn fronts_of_several_blocks_of_columns_agree_with_a_dense_solution() {
    let mut random = Random(7);
    let matrix: CscMatrix<C> = hermitian(&pattern_where(150, |_, _| true), -1.0, &mut random);
    let rhs: Vec<C> = (0..150).map(|_| C::draw(&mut random)).collect();
    let solved = factored(Kind::Hermitian, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mut random = Random(8);
    let matrix: CscMatrix<C> = hermitian(&grid_pattern(60), 1.0, &mut random);
    let rhs: Vec<C> = (0..matrix.nrows()).map(|_| C::draw(&mut random)).collect();
    let solve = || factored(Kind::Hermitian, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite").x;
    let alone = on_threads(1, solve);
    assert_eq!(bits(&alone), bits(&on_threads(2, solve)));
    assert_eq!(bits(&alone), bits(&on_threads(5, solve)));
}

#[test]
fn fronts_that_are_worth_several_threads_have_the_same_bits_on_any_number() {
    let mut random = Random(11);
    // Two cliques that share a third give fronts with many columns, and with many rows below them.
    let part = |i: usize| {
        if i < 150 {
            0
        } else if i < 300 {
            1
        } else {
            2
        }
    };
    let pattern = pattern_where(500, |i, j| part(i) == part(j) || part(i) == 2 || part(j) == 2);
    let matrix: CscMatrix<C> = hermitian(&pattern, 1.0, &mut random);
    let rhs: Vec<C> = (0..500).map(|_| C::draw(&mut random)).collect();
    let solve = || factored(Kind::Hermitian, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite").x;
    let alone = on_threads(1, solve);
    assert!(deviation(&dense(&matrix), &alone, &rhs) < TOLERANCE);
    for threads in [2, 5] {
        assert_eq!(bits(&alone), bits(&on_threads(threads, solve)));
    }
}

#[test]
fn the_row_without_a_positive_pivot_is_the_same_for_any_number_of_threads() {
    let mut matrix: CscMatrix<f64> = hermitian(&grid_pattern(40), 1.0, &mut Random(9));
    let n = matrix.nrows();
    for row in (5..n).step_by(97) {
        if let Some(nalgebra_sparse::SparseEntryMut::NonZero(value)) = matrix.get_entry_mut(row, row) {
            *value = -*value;
        }
    }
    let row = |threads| match on_threads(threads, || factored(Kind::Hermitian, &matrix).expect_err("not definite")) {
        LinalgError::NotPositiveDefinite { row } => row,
        other => panic!("{other}"),
    };
    let alone = row(1);
    for threads in [2, 3, 8] {
        assert_eq!(row(threads), alone);
    }
}

#[test]
fn a_similar_pattern_is_factored_in_the_order_of_the_first() {
    let mut random = Random(10);
    // The order of the third keeps no pairs together, although the next pattern has pairs.
    let uncoupled = pattern_where(12, |i, j| i == j || i % 2 == 0 && j % 2 == 0);
    for first in [in_blocks(&grid_pattern(9)), grid_pattern(18), uncoupled] {
        let n = first.major_dim();
        let joined: std::collections::BTreeSet<(usize, usize)> = first.entries().collect();
        // An extra edge between the first unknown and the last, with its block.
        let other = pattern_where(n, |i, j| {
            let (low, high) = (i.min(j), i.max(j));
            joined.contains(&(i, j)) || (low < 2 && high >= n - 2) || n == 12
        });
        let analysis = Analysis::new(Kind::Hermitian, &first, &AtomicBool::new(false)).expect("symmetric");
        let order = analysis.order().expect("that of a Hermitian matrix");
        let similar = Analysis::in_order(&order, &other, &AtomicBool::new(false)).expect("symmetric");
        let matrix: CscMatrix<f64> = hermitian(&other, 1.0, &mut random);
        let rhs: Vec<f64> = (0..n).map(|_| f64::draw(&mut random)).collect();
        let solved = similar.factor(&matrix, &GO_ON).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite");
        assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
    }
}

proptest! {
    #[test]
    fn pairs_on_any_pattern_agree_with_a_dense_solution(seed: u64, n in 1usize..25, density in 0.0..0.5) {
        let mut random = Random(seed);
        let pattern = in_blocks(&random_pattern(n, density, &mut random));
        let matrix: CscMatrix<f64> = hermitian(&pattern, 1.0, &mut random);
        let rhs: Vec<f64> = (0..2 * n).map(|_| f64::draw(&mut random)).collect();
        let solved = factored(Kind::Hermitian, &matrix).and_then(|f| f.solve(&matrix, &rhs, &GO_ON)).expect("definite");
        prop_assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
    }
}
