//! Lanczos method against a dense eigensolver.

use std::convert::Infallible;

use freebound_core::linalg::{EigenLimits, Eigenpair, greatest_eigenpair};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use proptest::prelude::*;

use super::matrices::Draw as _;
use freebound_testkit::Random;

type C64 = Complex<f64>;

const LIMITS: EigenLimits = EigenLimits { tolerance: 1e-13, applications: 80 };

fn random_vector(n: usize, random: &mut Random) -> Vec<C64> {
    (0..n).map(|_| C64::draw(random)).collect()
}

/// Random Hermitian matrix with given eigenvalues, and its eigenvectors.
fn hermitian(eigenvalues: &[f64], random: &mut Random) -> (DMatrix<C64>, DMatrix<C64>) {
    let n = eigenvalues.len();
    let vectors = DMatrix::from_vec(n, n, random_vector(n * n, random)).qr().q();
    let diagonal = DMatrix::from_diagonal(&DVector::from_iterator(n, eigenvalues.iter().map(|&e| C64::from(e))));
    (&vectors * diagonal * vectors.adjoint(), vectors)
}

fn greatest(matrix: &DMatrix<C64>, start: &[C64], limits: EigenLimits) -> Eigenpair {
    let apply = |x: &[C64]| Ok::<_, Infallible>((matrix * DVector::from_column_slice(x)).as_slice().to_vec());
    greatest_eigenpair(start, limits, apply).unwrap()
}

proptest! {
    #[test]
    fn the_greatest_eigenpair_is_that_of_the_matrix(seed: u64, n in 1usize..40, gap in 1e-3..10.0) {
        let mut random = Random(seed);
        let mut eigenvalues: Vec<f64> = (0..n).map(|_| random.unit()).collect();
        eigenvalues[0] = 1.0 + gap;
        let (matrix, vectors) = hermitian(&eigenvalues, &mut random);
        let found = greatest(&matrix, &random_vector(n, &mut random), LIMITS);
        prop_assert!((found.value - eigenvalues[0]).abs() < 1e-12, "{} for {}", found.value, eigenvalues[0]);
        let along = vectors.column(0).dotc(&DVector::from_vec(found.vector.clone())).norm();
        prop_assert!((along - 1.0).abs() < 1e-9, "{along} of the eigenvector");
        let image = &matrix * DVector::from_vec(found.vector.clone());
        let left = (image - DVector::from_vec(found.vector) * C64::from(found.value)).norm() / found.value;
        prop_assert!(left < 1e-12, "{left:e}");
        prop_assert!(found.applications <= n);
    }
}

#[test]
fn two_equal_eigenvalues_are_one_to_it() {
    let mut random = Random(2);
    let (matrix, _) = hermitian(&[2.0, 2.0, 1.0, 0.5, 0.25, 0.0], &mut random);
    let found = greatest(&matrix, &random_vector(6, &mut random), LIMITS);
    assert!((found.value - 2.0).abs() < 1e-13 && found.residual <= LIMITS.tolerance, "{found:?}");
    assert!(found.applications <= 5, "five different eigenvalues make a space of five vectors: {found:?}");
}

#[test]
fn an_eigenvector_to_start_from_is_the_answer_at_once() {
    let mut random = Random(3);
    let (matrix, vectors) = hermitian(&[3.0, 1.0, -2.0], &mut random);
    let found = greatest(&matrix, vectors.column(0).as_slice(), LIMITS);
    assert_eq!(found.applications, 1);
    assert!((found.value - 3.0).abs() < 1e-14);
}

#[test]
fn it_ends_at_its_limit_and_says_how_far_it_is() {
    let mut random = Random(4);
    let eigenvalues: Vec<f64> = (0..60).map(|k| 1.0 - 1e-4 * f64::from(k)).collect();
    let (matrix, _) = hermitian(&eigenvalues, &mut random);
    let limits = EigenLimits { applications: 5, ..LIMITS };
    let found = greatest(&matrix, &random_vector(60, &mut random), limits);
    let image = &matrix * DVector::from_vec(found.vector.clone());
    let left = (image - DVector::from_vec(found.vector) * C64::from(found.value)).norm() / found.value;
    assert_eq!(found.applications, 5);
    assert!(found.residual > 1e-6 && (left / found.residual - 1.0).abs() < 1e-6, "{left:e}, {:e}", found.residual);
}

#[test]
fn numbers_that_overflow_end_it() {
    let apply = |_: &[C64]| Ok::<_, Infallible>(vec![C64::new(f64::INFINITY, f64::NAN); 2]);
    let found = greatest_eigenpair(&[C64::ONE, C64::ONE], LIMITS, apply).unwrap();
    assert!(found.value.is_nan() && found.residual.is_nan());
}
