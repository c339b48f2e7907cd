//! numpy arrays of results. Each owns its memory and is read-only.

use glam::{DVec2, DVec3};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;

/// Array of shape (n,).
pub(crate) fn list<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}

/// Array of shape (n, N).
pub(crate) fn table<T: Element, const N: usize>(
    py: Python<'_>,
    rows: impl ExactSizeIterator<Item = [T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    let mut values = Vec::with_capacity(count * N);
    rows.for_each(|row| values.extend(row));
    let array = PyArray1::from_vec(py, values).reshape([count, N])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// Array of shape (n, 2) of points in the plane.
pub(crate) fn points<'py>(py: Python<'py>, points: &[DVec2]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    table(py, points.iter().map(DVec2::to_array))
}

/// Array of shape (n, 3) of positions in space.
pub(crate) fn positions<'py>(py: Python<'py>, positions: &[DVec3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    table(py, positions.iter().map(DVec3::to_array))
}

/// Number of an element as numpy has it: −1 for `u32::MAX`, which stands for none.
pub(crate) fn number(number: u32) -> i64 {
    if number == u32::MAX { -1 } else { i64::from(number) }
}
