//! Errors of the package. Their classes are those of `freebound._errors`.

use std::fmt::Display;

use freebound_core::problem::{Cause, SolveError};
use freebound_io::{FaultReport, ReadError};
use freebound_run::{RequestFault, RunError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Module that defines the classes of errors.
const MODULE: &str = "freebound._errors";

/// Error of a class of the package.
pub(crate) fn error(py: Python<'_>, class: &str, message: impl Display, fields: &[(&str, Py<PyAny>)]) -> PyErr {
    let make = || {
        let class = py.import(MODULE)?.getattr(class)?;
        let keywords = PyDict::new(py);
        for (name, value) in fields {
            keywords.set_item(name, value)?;
        }
        let instance = class.call(PyTuple::new(py, [message.to_string()])?, Some(&keywords))?;
        Ok(PyErr::from_value(instance))
    };
    make().unwrap_or_else(|error: PyErr| error)
}

/// Wrong options.
pub(crate) fn option_error(py: Python<'_>, message: impl Display) -> PyErr {
    error(py, "OptionError", message, &[])
}

/// Unusable input, with its faults.
pub(crate) fn input_error(py: Python<'_>, message: impl Display, faults: &[FaultReport]) -> PyErr {
    match to_python(py, faults) {
        Ok(faults) => error(py, "InputError", message, &[("faults", faults.unbind())]),
        Err(error) => error,
    }
}

/// Result that is not proved. `layout` is the layout, if there is one.
pub(crate) fn not_proved(py: Python<'_>, message: impl Display, layout: Option<Py<PyAny>>) -> PyErr {
    let layout = layout.unwrap_or_else(|| py.None());
    error(py, "NotProved", message, &[("layout", layout)])
}

/// Cancelled run.
pub(crate) fn cancelled(py: Python<'_>) -> PyErr {
    error(py, "Cancelled", "the run was cancelled", &[])
}

/// Error of a solve.
pub(crate) fn of_solve(py: Python<'_>, failure: &SolveError) -> PyErr {
    match failure.cause() {
        Cause::Cancelled => cancelled(py),
        Cause::Targets => input_error(py, failure, &[]),
        Cause::Method => not_proved(py, failure, None),
        Cause::Request => option_error(py, failure),
    }
}

/// Error of a run.
pub(crate) fn of_run(py: Python<'_>, failure: &RunError) -> PyErr {
    match failure {
        RunError::NotADisk(diagnosis) => input_error(py, failure, &FaultReport::of_diagnosis(diagnosis)),
        RunError::Solve(error) => of_solve(py, error),
        RunError::Request(RequestFault::Texture(error)) => input_error(py, failure, &FaultReport::of_texture(error)),
        RunError::Request(_) | RunError::TrueSize(_) => option_error(py, failure),
        _ => input_error(py, failure, &[]),
    }
}

/// Error of reading a file.
pub(crate) fn of_read(py: Python<'_>, path: &str, failure: &ReadError) -> PyErr {
    match failure {
        ReadError::Cancelled => cancelled(py),
        _ => input_error(py, format!("{path}: {failure}"), &FaultReport::of_file(failure)),
    }
}

/// Serializable value as Python lists, dictionaries, strings and numbers. Infinities become `None`.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &(impl serde::Serialize + ?Sized)) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| option_error(py, error))?;
    py.import("json")?.getattr("loads")?.call1((text,))
}
