//! A method step by step.

use std::sync::{Arc, Mutex, PoisonError};

use freebound_core::flatten::{Flattener as CoreFlattener, Step};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::Control;
use freebound_io::{StepReport, verdict_as_in_file};
use freebound_run::RunError;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use super::job::{in_pool, interruptible};
use super::mesh::Mesh;
use super::options::{Lists, Options, of_json};
use super::{arrays, errors};

/// Method that is run step by step on a disk.
#[pyclass(frozen, module = "freebound", name = "_Flattener", subclass)]
pub(crate) struct Flattener {
    mesh: Arc<DiskMesh>,
    steps: Mutex<CoreFlattener>,
    threads: usize,
}

#[pymethods]
impl Flattener {
    #[new]
    fn new(py: Python<'_>, mesh: &Mesh, options: &str, lists: Lists<'_>) -> PyResult<Self> {
        let options: Options = of_json(py, options)?;
        let request = options.request(py, &lists)?;
        let threads = options.threads.map_or(0, usize::from);
        let model = mesh.model();
        let prepared = py.detach(|| in_pool(threads, || request.prepared(&model, Control::unattended())));
        let model = prepared.map_err(PyRuntimeError::new_err)?.map_err(|error| errors::of_run(py, &error))?;
        let Some(disk) = model.disk().filter(|_| model.chart_count() == 1) else {
            let faulty = match &model.prepared.surface {
                freebound_core::pipeline::Surface::Faulty(_, diagnosis) => diagnosis.as_ref().clone(),
                freebound_core::pipeline::Surface::Disk(_) => {
                    return Err(errors::option_error(py, "the mesh has several charts: pass one of them"));
                }
            };
            return Err(errors::of_run(py, &RunError::NotADisk(Box::new(faulty))));
        };
        let begin = || {
            let targets = request.targets_on(&model)?;
            model.flattener_options(&request.run.options.problem_with(targets)).map_err(RunError::Layout)
        };
        let options = py.detach(|| in_pool(threads, begin)).map_err(PyRuntimeError::new_err)?;
        let options = options.map_err(|error: RunError| errors::of_run(py, &error))?;
        let steps = Mutex::new(CoreFlattener::with_options(options));
        Ok(Self { mesh: Arc::clone(disk), steps, threads })
    }

    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Next step; None at the end of the method.
    fn __next__(&self, py: Python<'_>) -> PyResult<Option<FlattenerStep>> {
        let next = |control: Control<'_>| {
            let mut flattener = self.steps.lock().unwrap_or_else(PoisonError::into_inner);
            if flattener.ending().is_some() { None } else { Some(flattener.step(&self.mesh, control)) }
        };
        match interruptible(py, self.threads, None, next)? {
            None => Ok(None),
            Some(Ok(step)) => Ok(Some(FlattenerStep { mesh: Arc::clone(&self.mesh), step })),
            Some(Err(error)) => Err(errors::of_solve(py, &error)),
        }
    }

    /// Reason of the end; None while the method runs.
    #[getter]
    fn ending(&self, py: Python<'_>) -> Option<String> {
        let ending = py.detach(|| self.steps.lock().unwrap_or_else(PoisonError::into_inner).ending());
        ending.map(|ending| format!("{ending:?}").to_lowercase())
    }
}

/// Step of a method.
#[pyclass(frozen, module = "freebound", name = "Step")]
pub(crate) struct FlattenerStep {
    mesh: Arc<DiskMesh>,
    step: Step,
}

#[pymethods]
impl FlattenerStep {
    /// Number of the step, from 0.
    #[getter]
    fn index(&self) -> usize {
        self.step.index
    }

    /// Stage that made the step.
    #[getter]
    fn stage(&self) -> &'static str {
        self.step.candidate.stage.name()
    }

    /// Position of each vertex in the plane, shape (n, 2). New vertices come last.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let surface = self.step.candidate.mesh(&self.mesh).real_vertex_count();
        arrays::points(py, &self.step.candidate.solution.embedding[..surface])
    }

    /// Triangles of the step, shape (m, 3).
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let mesh = self.step.candidate.mesh(&self.mesh).mesh();
        let corners = mesh.real_triangles().iter().map(|corners| corners.map(|vertex| vertex.number().into()));
        arrays::table(py, corners)
    }

    /// True if the step is proved planar.
    #[getter]
    fn planar(&self) -> bool {
        self.step.verdict.planar
    }

    /// Flipped triangles.
    #[getter]
    fn flipped<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        arrays::list(py, self.step.verdict.flipped_faces.iter().map(|face| face.number().into()).collect())
    }

    /// Verdict as a dictionary. Faces have the numbers of the input.
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mesh = self.step.candidate.mesh(&self.mesh).mesh();
        errors::to_python(py, &verdict_as_in_file(&self.step.verdict, mesh))
    }

    /// Numbers of the step as the report has them.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        errors::to_python(py, &StepReport::of(&self.step))
    }

    fn __repr__(&self) -> String {
        let verdict = self.step.verdict.summary();
        format!("<freebound.Step {}: {}, {verdict}>", self.step.index, self.step.candidate.stage.name())
    }
}
