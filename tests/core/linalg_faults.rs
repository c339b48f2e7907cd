//! What the factorizations say of matrices that they cannot take.

use std::sync::atomic::AtomicBool;

use freebound::linalg::{Analysis, Kind, LinalgError};
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use crate::linalg_matrices::{dominant, factored, grid_pattern, hermitian, laplacian, pattern_where, scale_rows};
use crate::makers::Random;

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
    assert_eq!(factor.solve(&matrix, &rhs).expect_err("infinite"), LinalgError::NotFinite { row: 5 });
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
fn a_pattern_without_its_mirror_image_or_diagonal_is_refused() {
    let alone = pattern_where(3, |column, row| row == column || (column, row) == (0, 2));
    let error = Analysis::new(Kind::General, &alone).expect_err("(2, 0) stands alone");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 2, column: 0 });
    let hollow = pattern_where(3, |column, row| row == column && row != 1);
    let error = Analysis::new(Kind::General, &hollow).expect_err("(1, 1) is missing");
    assert_eq!(error, LinalgError::PatternNotSymmetric { row: 1, column: 1 });
}

#[test]
fn a_matrix_of_another_pattern_is_refused() {
    let analysis = Analysis::new(Kind::General, &grid_pattern(4)).expect("symmetric");
    let other = CscMatrix::<f64>::identity(16);
    assert_eq!(analysis.factor(&other, &AtomicBool::new(false)).expect_err("other"), LinalgError::OtherPattern);
}
