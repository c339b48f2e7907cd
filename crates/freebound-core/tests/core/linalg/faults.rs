//! Errors of the factorizations for unsuitable matrices.

use std::sync::atomic::AtomicBool;

use freebound_core::linalg::{Analysis, Factor, Kind, LinalgError};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;

use super::matrices::{GO_ON, dominant, factored, grid_pattern, hermitian, laplacian, pattern_where, scale_rows};
use freebound_testkit::Random;

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
    let mut matrix: CscMatrix<Complex<f64>> = dominant(&pattern_where(5, |_, _| true), &mut Random(9));
    for column in 0..5 {
        let value = matrix.values()[5 * column + 1];
        matrix.values_mut()[5 * column + 3] = value;
    }
    assert!(matches!(factored(Kind::General, &matrix), Err(LinalgError::Singular { .. })));
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
fn a_pivot_is_named_alike_in_a_real_matrix_and_in_one_that_is_complex_elsewhere() {
    let mut real: CscMatrix<f64> = hermitian(&grid_pattern(30), 1.0, &mut Random(1));
    if let Some(nalgebra_sparse::SparseEntryMut::NonZero(value)) = real.get_entry_mut(700, 700) {
        *value = -*value;
    }
    let values = real.values().iter().map(|&value| Complex::new(value, 0.0)).collect();
    let mut complex = CscMatrix::try_from_pattern_and_values(real.pattern().clone(), values).expect("the same pattern");
    for (row, column, imaginary) in [(0, 1, 0.1), (1, 0, -0.1)] {
        if let Some(nalgebra_sparse::SparseEntryMut::NonZero(value)) = complex.get_entry_mut(row, column) {
            value.im = imaginary;
        }
    }
    let [error, other] = [factored(Kind::Hermitian, &real).err(), factored(Kind::Hermitian, &complex).err()];
    assert!(matches!(error, Some(LinalgError::NotPositiveDefinite { .. })), "{error:?}");
    assert_eq!(error, other);
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
    assert_eq!(factor.solve(&matrix, &rhs, &GO_ON).expect_err("infinite"), LinalgError::NotFinite { row: 5 });
}

#[test]
fn a_cancelled_factorization_stops() {
    let matrix = laplacian(&grid_pattern(20), 0.1, &mut Random(1));
    for kind in [Kind::General, Kind::Hermitian] {
        let analysis = Analysis::new(kind, matrix.pattern(), &AtomicBool::new(false)).expect("symmetric");
        assert_eq!(analysis.factor(&matrix, &AtomicBool::new(true)).expect_err("cancelled"), LinalgError::Cancelled);
    }
}

#[test]
fn a_cancelled_solve_stops() {
    let (matrix, raised): (CscMatrix<f64>, _) =
        (hermitian(&grid_pattern(20), 1.0, &mut Random(1)), AtomicBool::new(true));
    let rhs = vec![1.0; matrix.nrows()];
    for kind in [Kind::General, Kind::Hermitian] {
        let factor = factored(kind, &matrix).expect("regular");
        for answer in [Factor::solve, Factor::solve_adjoint, Factor::solve_correction, Factor::solve_columns] {
            assert_eq!(answer(&factor, &matrix, &rhs, &raised).expect_err("cancelled"), LinalgError::Cancelled);
        }
        assert_eq!(factor.substitute(&rhs, &raised), Err(LinalgError::Cancelled));
        assert_eq!(factor.substitute_adjoint(&mut rhs.clone(), &raised), Err(LinalgError::Cancelled));
    }
}

/// Chain of unknowns, long enough for dissection.
fn long_chain() -> SparsityPattern {
    let n = 60_000;
    let lanes: Vec<Vec<usize>> = (0..n).map(|k: usize| (k.saturating_sub(1)..(k + 2).min(n)).collect()).collect();
    let offsets = std::iter::once(0).chain(lanes.iter().scan(0, |end, lane| {
        *end += lane.len();
        Some(*end)
    }));
    SparsityPattern::try_from_offsets_and_indices(n, n, offsets.collect(), lanes.concat()).expect("a band")
}

#[test]
fn a_cancelled_analysis_stops() {
    for pattern in [grid_pattern(20), long_chain()] {
        for kind in [Kind::General, Kind::Hermitian] {
            let stopped = Analysis::new(kind, &pattern, &AtomicBool::new(true));
            assert_eq!(stopped.expect_err("cancelled"), LinalgError::Cancelled);
        }
    }
}

#[test]
fn a_pattern_that_is_dissected_is_solved_like_others() {
    // −1 2.5 −1, times 0 1 2 3 4 0 1 …
    let pattern = long_chain();
    let entry = |(row, column): (usize, usize)| if row == column { 2.5 } else { -1.0 };
    let columns = |column: usize| pattern.lane(column).iter().map(move |&row| (row, column));
    let values = (0..pattern.major_dim()).flat_map(columns).map(entry).collect();
    let wanted: Vec<f64> = (0..pattern.major_dim()).map(|k| (k % 5) as f64).collect();
    let at = |k: usize| wanted.get(k).copied().unwrap_or(0.0);
    let rhs: Vec<f64> = (0..wanted.len()).map(|k| 2.5 * at(k) - at(k.wrapping_sub(1)) - at(k + 1)).collect();
    let matrix = CscMatrix::try_from_pattern_and_values(pattern.clone(), values).expect("one value per entry");
    let solved =
        factored(Kind::Hermitian, &matrix).and_then(|factor| factor.solve(&matrix, &rhs, &GO_ON)).expect("solvable");
    let error = solved.x.iter().zip(&wanted).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(error < 1e-12, "{error}");
}

#[test]
fn a_pattern_without_its_mirror_image_or_diagonal_is_refused() {
    let alone = pattern_where(3, |column, row| row == column || (column, row) == (0, 2));
    let error = Analysis::new(Kind::General, &alone, &AtomicBool::new(false)).expect_err("(2, 0) stands alone");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 2, column: 0 });
    let hollow = pattern_where(3, |column, row| row == column && row != 1);
    let error = Analysis::new(Kind::General, &hollow, &AtomicBool::new(false)).expect_err("(1, 1) is missing");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 1, column: 1 });
}

#[test]
fn a_matrix_of_another_pattern_is_refused() {
    let analysis = Analysis::new(Kind::General, &grid_pattern(4), &AtomicBool::new(false)).expect("symmetric");
    let other = CscMatrix::<f64>::identity(16);
    assert_eq!(analysis.factor(&other, &AtomicBool::new(false)).expect_err("other"), LinalgError::OtherPattern);
}
