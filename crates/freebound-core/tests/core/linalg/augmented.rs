//! Augmented least-squares matrices, `[−E A; Aᴴ F]` in pairs, against dense and general factorizations.

use freebound_core::linalg::{Kind, LinalgError};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;
use proptest::prelude::*;

use super::matrices::{Draw, GO_ON, dominant, factored, grid_pattern, pattern_where, random_pattern};
use super::solvers::{dense, deviation};
use freebound_testkit::Random;

/// Tolerance relative to the largest entry of the solution. A's diagonal dominates its rows.
const TOLERANCE: f64 = 1e-9;

/// Random augmented matrix whose A has the first `pairs` columns of the pattern; `share` of F's diagonal is
/// positive.
fn augmented(pattern: &SparsityPattern, pairs: usize, share: f64, random: &mut Random) -> CscMatrix<Complex<f64>> {
    let order = pattern.major_dim() + pairs;
    let vertex = |row: usize| if row < 2 * pairs { row / 2 } else { row - pairs };
    let is_move = |row: usize| row < 2 * pairs && row % 2 == 1;
    let a: CscMatrix<Complex<f64>> = dominant(pattern, random);
    let a = dense(&a);
    let joined = dense(&CscMatrix::try_from_pattern_and_values(pattern.clone(), vec![1.0; pattern.nnz()]).unwrap());
    let expanded = pattern_where(order, |i, j| joined[(vertex(i), vertex(j))] == 1.0);
    let e: Vec<f64> = (0..order).map(|_| 0.5 + random.unit()).collect();
    let f: Vec<f64> = (0..order).map(|_| if random.unit() < share { random.unit() } else { 0.0 }).collect();
    let value = |(column, row): (usize, usize)| match (is_move(row), is_move(column)) {
        (false, true) => a[(vertex(row), vertex(column))],
        (true, false) => a[(vertex(column), vertex(row))].conj(),
        _ if row != column => Complex::ZERO,
        (true, true) => f[row].into(),
        (false, false) => (-e[row]).into(),
    };
    let values = expanded.entries().map(value).collect();
    CscMatrix::try_from_pattern_and_values(expanded, values).unwrap()
}

proptest! {
    #[test]
    fn an_augmented_matrix_is_solved_as_a_dense_one(seed: u64, n in 1usize..30, density in 0.0..0.4, share in 0.0..1.0) {
        let mut random = Random(seed);
        let pattern = random_pattern(n, density, &mut random);
        let pairs = n - n / 3;
        let matrix = augmented(&pattern, pairs, share, &mut random);
        let factor = factored(Kind::Augmented { pairs }, &matrix).expect("A has full column rank");
        let rhs: Vec<_> = (0..6 * matrix.nrows()).map(|_| Complex::draw(&mut random)).collect();
        let solved = factor.solve(&matrix, &rhs, &GO_ON).expect("regular");
        prop_assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
        prop_assert!(solved.residual < 1e-12, "{}", solved.residual);
    }
}

#[test]
fn the_factors_take_little_more_than_half_the_memory_of_an_lu() {
    let mut random = Random(3);
    let pattern = grid_pattern(30);
    let pairs = 800;
    let matrix = augmented(&pattern, pairs, 0.1, &mut random);
    let [augmented, general] = [Kind::Augmented { pairs }, Kind::General]
        .map(|kind| factored(kind, &matrix).expect("regular").stats().factor_bytes as f64);
    assert!(augmented < 0.65 * general, "{augmented} of {general} bytes");
}

#[test]
fn a_row_without_a_coefficient_of_its_own_has_its_pivot_replaced_and_the_answer_is_as_good() {
    // Each vertex of a clique has a leaf, which is eliminated first and has no pivot then.
    let (clique, pairs) = (12, 24);
    let pattern = pattern_where(pairs, |i, j| i == j || (i < clique && j < clique) || i.abs_diff(j) == clique);
    let mut random = Random(8);
    let mut matrix = augmented(&pattern, pairs, 0.0, &mut random);
    let entries: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    for (&(column, row), value) in entries.iter().zip(matrix.values_mut()) {
        if row != column && row / 2 == column / 2 && row / 2 >= clique {
            *value = Complex::ZERO;
        }
    }
    let factor = factored(Kind::Augmented { pairs }, &matrix).expect("regular");
    assert!(factor.stats().replaced_pivots > 0, "otherwise this tests nothing");
    let rhs: Vec<_> = (0..matrix.nrows()).map(|_| Complex::draw(&mut random)).collect();
    let solved = factor.solve(&matrix, &rhs, &GO_ON).expect("regular");
    assert!(deviation(&dense(&matrix), &solved.x, &rhs) < TOLERANCE);
}

#[test]
fn an_augmented_matrix_with_an_empty_row_is_singular_and_the_row_is_named() {
    let pattern = grid_pattern(5);
    let mut matrix = augmented(&pattern, 20, 0.0, &mut Random(1));
    let entries: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    for (&(column, row), value) in entries.iter().zip(matrix.values_mut()) {
        if column == 13 || row == 13 {
            *value = Complex::ZERO;
        }
    }
    let error = factored(Kind::Augmented { pairs: 20 }, &matrix).expect_err("a zero row");
    assert_eq!(error, LinalgError::Singular { row: 13 });
}
