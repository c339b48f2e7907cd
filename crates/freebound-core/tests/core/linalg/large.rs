//! Systems large enough for dissection: known solutions, and equal results on any number of threads.

use freebound_core::linalg::{Kind, Scalar};
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;
use num_complex::Complex;
use rayon::ThreadPoolBuilder;

use super::matrices::{Draw, GO_ON, dominant, factored, hermitian, laplacian, scale_rows};
use super::solvers::bits;
use freebound_testkit::Random;

/// Side of a grid of 25,600 unknowns, which is split in two.
const SIDE: usize = 160;

/// Scattered number of a grid vertex.
fn number(x: usize, y: usize) -> usize {
    (y * SIDE + x) * 7919 % (SIDE * SIDE)
}

/// Pattern of a grid with one diagonal per cell and scattered vertex numbers.
fn pattern() -> SparsityPattern {
    let count = SIDE * SIDE;
    let mut columns: Vec<Vec<usize>> = (0..count).map(|k| vec![k]).collect();
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        for (u, v) in [(x + 1, y), (x, y + 1), (x + 1, y + 1)].into_iter().filter(|&(u, v)| u < SIDE && v < SIDE) {
            columns[number(x, y)].push(number(u, v));
            columns[number(u, v)].push(number(x, y));
        }
    }
    let (mut offsets, mut rows) = (vec![0], Vec::new());
    for mut column in columns {
        column.sort_unstable();
        rows.extend(column);
        offsets.push(rows.len());
    }
    SparsityPattern::try_from_offsets_and_indices(count, count, offsets, rows).expect("sorted and in range")
}

/// Product A x, entry by entry.
fn product<T: Scalar>(matrix: &CscMatrix<T>, x: &[T]) -> Vec<T> {
    let mut product = vec![T::ZERO; x.len()];
    for (row, column, &value) in matrix.triplet_iter() {
        product[row] += value * x[column];
    }
    product
}

/// Solves for three known solutions on 1, 2 and 4 threads. Asserts that they are recovered up to `tolerance`,
/// equally on all thread counts. Returns the memory of the factors, bytes.
fn known_answers_come_back<T: Draw>(kind: Kind, matrix: &CscMatrix<T>, tolerance: f64) -> usize {
    let mut random = Random(11);
    let n = matrix.nrows();
    let known: Vec<T> = (0..3 * n).map(|_| T::draw(&mut random)).collect();
    let rhs: Vec<T> = known.chunks_exact(n).flat_map(|x| product(matrix, x)).collect();
    let solve = || {
        let factor = factored(kind, matrix).expect("regular");
        let x = factor.solve(matrix, &rhs, &GO_ON).expect("regular").x;
        let adjoint = factor.solve_adjoint(matrix, &rhs, &GO_ON).expect("regular");
        assert_eq!(adjoint.refinement_steps, 0, "substitution alone leaves {:e}", adjoint.backward_error);
        (x, adjoint.x, factor.stats().factor_bytes)
    };
    let on_threads = |count| ThreadPoolBuilder::new().num_threads(count).build().expect("a few threads").install(solve);
    let [one, two, four] = [1, 2, 4].map(on_threads);
    assert!(bits(&one.0) == bits(&two.0) && bits(&one.0) == bits(&four.0), "threads make a difference");
    assert!(bits(&one.1) == bits(&two.1) && bits(&one.1) == bits(&four.1), "threads make a difference");
    let worst = one.0.iter().zip(&known).map(|(&x, &known)| (x - known).size()).fold(0.0, f64::max);
    assert!(worst < tolerance, "off by {worst}");
    // Aᴴ y = b with an unchanged b, checked by its product.
    let back: Vec<T> = one.1.chunks_exact(n).flat_map(|x| product(&matrix.transpose(), &conjugate(x))).collect();
    let off = back.iter().zip(&rhs).map(|(&back, &b)| (back - b.conjugate()).size()).fold(0.0, f64::max);
    let largest = rhs.iter().map(|b| b.size()).fold(0.0, f64::max);
    assert!(off < tolerance * largest, "the adjoint system is off by {off}");
    one.2
}

fn conjugate<T: Scalar>(x: &[T]) -> Vec<T> {
    x.iter().map(|x| x.conjugate()).collect()
}

#[test]
fn a_large_definite_system_is_solved_alike_on_any_number_of_threads() {
    let mut random = Random(5);
    let matrix = laplacian(&pattern(), 0.01, &mut random);
    let mut symmetric = &matrix + &matrix.transpose();
    symmetric.values_mut().iter_mut().for_each(|value| *value *= 0.5);
    // The mean of two Laplacians has rows that do not sum to 0; the diagonal compensates.
    let bytes = {
        let n = symmetric.nrows();
        let mut sums = vec![0.0; n];
        symmetric
            .triplet_iter()
            .filter(|(row, column, _)| row != column)
            .for_each(|(row, _, value)| sums[row] += value);
        let places: Vec<(usize, usize)> = symmetric.pattern().entries().collect();
        for (&(column, row), value) in places.iter().zip(symmetric.values_mut()) {
            if row == column {
                *value = -sums[row] - 0.01;
            }
        }
        known_answers_come_back(Kind::Hermitian, &symmetric, 1e-9)
    };
    // George 1973: nested dissection of a grid fills at most 31/4 n log₂ n.
    let n = symmetric.nrows() as f64;
    assert!((bytes / size_of::<f64>()) as f64 <= 31.0 / 4.0 * n * n.log2(), "{bytes} bytes");
}

#[test]
fn a_large_complex_system_is_solved_alike_on_any_number_of_threads() {
    let matrix: CscMatrix<Complex<f64>> = hermitian(&pattern(), -1.0, &mut Random(6));
    known_answers_come_back(Kind::Hermitian, &matrix, 1e-12);
}

#[test]
fn a_large_unsymmetric_system_is_solved_alike_on_any_number_of_threads() {
    let mut matrix = laplacian(&pattern(), 0.01, &mut Random(7));
    scale_rows(&mut matrix, |row| 1.0 + (row % 17) as f64);
    known_answers_come_back(Kind::General, &matrix, 1e-8);
}

/// Removes the imaginary parts except between vertices of the grid's first row, as in the equations of a free
/// boundary.
fn complex_along_one_side(matrix: &CscMatrix<Complex<f64>>) -> CscMatrix<Complex<f64>> {
    let mut is_of_side = vec![false; matrix.nrows()];
    (0..SIDE).for_each(|x| is_of_side[number(x, 0)] = true);
    let entries: Vec<(usize, usize)> = matrix.pattern().entries().collect();
    let mut partly = matrix.clone();
    for (&(column, row), value) in entries.iter().zip(partly.values_mut()) {
        if !(is_of_side[column] && is_of_side[row]) {
            value.im = 0.0;
        }
    }
    partly
}

/// Asserts that factors use complex memory only at complex entries, with equal accuracy.
fn only_one_side_takes_the_memory_of_complex_numbers(kind: Kind, whole: &CscMatrix<Complex<f64>>) {
    let partly = complex_along_one_side(whole);
    let in_pattern = |values: Vec<f64>| {
        CscMatrix::try_from_pattern_and_values(whole.pattern().clone(), values).expect("one value an entry")
    };
    let real = in_pattern(whole.values().iter().map(|value| value.re).collect());
    let mut without = whole.clone();
    without.values_mut().iter_mut().for_each(|value| value.im = 0.0);
    let of_whole = known_answers_come_back(kind, whole, 1e-12);
    let of_partly = known_answers_come_back(kind, &partly, 1e-12);
    let of_real = known_answers_come_back(kind, &real, 1e-12);
    assert_eq!(of_whole, 2 * of_real);
    assert_eq!(
        known_answers_come_back(kind, &without, 1e-12),
        of_real,
        "no imaginary part is stored where there is none"
    );
    // A grid split into 4^k squares has 2^k at the side: at every depth of the tree most fronts are real.
    assert!(of_real < of_partly && 4 * of_partly < 3 * of_whole, "{of_real} < {of_partly} < 3/4 of {of_whole} bytes");
}

#[test]
fn a_definite_system_that_is_complex_along_one_side_takes_the_memory_of_a_real_one_elsewhere() {
    let whole = hermitian(&pattern(), 1.0, &mut Random(8));
    only_one_side_takes_the_memory_of_complex_numbers(Kind::Hermitian, &whole);
}

#[test]
fn an_unsymmetric_system_that_is_complex_along_one_side_takes_the_memory_of_a_real_one_elsewhere() {
    let whole = dominant(&pattern(), &mut Random(9));
    only_one_side_takes_the_memory_of_complex_numbers(Kind::General, &whole);
}
