//! The matrices of the paper.

use freebound_core::mesh::HalfedgeId;
use freebound_core::problem::{Control, Family, NamedOption as _};
use freebound_core::weights::equations::{barycentric, natural};
use numpy::{Complex64, PyArray1};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use super::job::in_pool;
use super::mesh::Mesh;
use super::{arrays, errors};

/// Rows, columns and values of the vertex equations.
type Entries<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<Complex64>>);

/// Vertex equations of a disk: one row for each vertex. With a free boundary the rows of boundary vertices are those of
/// the natural boundary (paper, eq. 3).
#[pyfunction]
pub(crate) fn equations<'py>(py: Python<'py>, mesh: &Mesh, family: &str, free: bool) -> PyResult<Entries<'py>> {
    let power = Family::named(family).and_then(Family::power);
    let Some(power) = power else {
        let message = format!("family: \"{family}\" is no family with an offset: choose one of {}", Family::names());
        return Err(errors::option_error(py, message));
    };
    let model = mesh.model();
    let work = || {
        let model = model.in_form(freebound_core::mesh::Preparation::default());
        let disk = model.disk().filter(|_| model.chart_count() == 1).cloned().ok_or(None)?;
        let control = Control::unattended();
        let coefficients = if free {
            natural(&disk, power, control).map_err(Some)?.coefficients
        } else {
            barycentric(&disk, power, control).map_err(Some)?.to_complex().coefficients
        };
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut put = |row: i64, column: i64, value: Complex64| {
            rows.push(row);
            columns.push(column);
            values.push(value);
        };
        for vertex in disk.vertices() {
            let row = i64::from(vertex.number());
            let mut sum = Complex64::default();
            disk.links_from(vertex).for_each(|link: HalfedgeId| {
                let value = coefficients[link.index()];
                sum += value;
                put(row, disk.head(link).number().into(), value);
            });
            put(row, row, -sum);
        }
        Ok((rows, columns, values))
    };
    match py.detach(|| in_pool(0, work)).map_err(PyRuntimeError::new_err)? {
        Ok((rows, columns, values)) => {
            Ok((arrays::list(py, rows), arrays::list(py, columns), arrays::list(py, values)))
        }
        Err(Some(error)) => Err(errors::of_solve(py, &error)),
        Err(None) => {
            Err(errors::input_error(py, "the mesh is not one disk: unwrap it, or pass one of its charts", &[]))
        }
    }
}
