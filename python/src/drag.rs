//! Dragged pins: every frame is proved.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use freebound_core::bijective::DragSolver;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::{Problem, Target};
use freebound_core::problem::{Control, Embedding};
use freebound_core::verify::Verdict;
use glam::DVec2;
use numpy::PyArray2;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use super::job::{in_pool, interruptible};
use super::layout::Layout;
use super::{arrays, errors};

/// Largest number of frames of a move that names none.
const USUAL_FRAMES: usize = 200;

/// State of a drag.
struct State {
    problem: Problem,
    embedding: Embedding,
    solver: Option<DragSolver>,
}

/// Planar layout whose vertices can be dragged.
#[pyclass(frozen, module = "freebound", name = "_Drag", subclass)]
pub(crate) struct Drag {
    mesh: Arc<DiskMesh>,
    state: Mutex<State>,
    /// True if no vertex moved in the last frame.
    is_at_rest: AtomicBool,
    threads: usize,
}

#[pymethods]
impl Drag {
    /// Begins with a planar layout of one chart.
    #[new]
    #[pyo3(signature = (layout, threads=None))]
    fn new(py: Python<'_>, layout: &Layout, threads: Option<usize>) -> PyResult<Self> {
        let [chart] = &layout.inner.solved().charts[..] else {
            return Err(errors::option_error(py, "a layout of several charts cannot be dragged: flatten one of them"));
        };
        let problem = chart.solved.outcome.problem.clone();
        let threads = threads.unwrap_or(0);
        let begin = || {
            let output = layout.inner.output()?;
            let frame = problem.frame;
            let laid = output.charts.into_iter().next();
            let laid = laid.map(|laid| {
                let embedding: Embedding = laid.coordinates.iter().map(|&uv| frame.plane_from_uv(uv)).collect();
                (Arc::new(laid.mesh.clone()), embedding)
            });
            Ok::<_, std::io::Error>(laid)
        };
        let start = py.detach(|| in_pool(threads, begin)).map_err(PyRuntimeError::new_err)?;
        let Some((mesh, embedding)) = start.map_err(|error| errors::option_error(py, error))? else {
            return Err(errors::option_error(py, "the layout has no chart"));
        };
        let state = Mutex::new(State { problem, embedding, solver: None });
        Ok(Self { mesh, state, is_at_rest: AtomicBool::new(true), threads })
    }

    /// True if no vertex moved in the last frame.
    #[getter]
    fn at_rest(&self) -> bool {
        self.is_at_rest.load(Ordering::Relaxed)
    }

    /// Drags a vertex towards a place, until nothing moves or for some frames. Returns the coordinates (n, 2) and the
    /// verdict.
    #[pyo3(signature = (vertex, target, frames=None))]
    fn advance<'py>(
        &self,
        py: Python<'py>,
        vertex: u32,
        target: [f64; 2],
        frames: Option<usize>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyAny>)> {
        if vertex as usize >= self.mesh.real_vertex_count() {
            return Err(errors::option_error(py, format!("vertex {vertex} is not there")));
        }
        if !target.iter().all(|number| number.is_finite()) {
            return Err(errors::option_error(py, "the place is not finite"));
        }
        let (vertex, target) = (VertexId::new(vertex), DVec2::from_array(target));
        let count = self.mesh.real_vertex_count();
        let work = |control: Control<'_>| {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            let pull = Pull { vertex, target, frames: frames.unwrap_or(USUAL_FRAMES).max(1) };
            let (verdict, is_at_rest) = state.advance(&self.mesh, pull, control)?;
            self.is_at_rest.store(is_at_rest, Ordering::Relaxed);
            let frame = state.problem.frame;
            let coordinates: Vec<DVec2> = state.embedding[..count].iter().map(|&z| frame.uv_from_plane(z)).collect();
            Some((coordinates, verdict))
        };
        let moved = interruptible(py, self.threads, None, work)?;
        let Some((coordinates, verdict)) = moved else {
            return Err(errors::not_proved(py, "the layout is not planar, so it cannot be dragged", None));
        };
        Ok((arrays::points(py, &coordinates)?, errors::to_python(py, &verdict)?))
    }
}

/// Vertex that is dragged towards a place, for some frames.
#[derive(Clone, Copy)]
struct Pull {
    vertex: VertexId,
    target: DVec2,
    frames: usize,
}

impl State {
    /// Moves a vertex, and returns the verdict, and true if no vertex moved in the last frame. `None` if the layout is not
    /// planar.
    fn advance(&mut self, mesh: &DiskMesh, pull: Pull, control: Control<'_>) -> Option<(Verdict, bool)> {
        let Pull { vertex, target, frames } = pull;
        let is_same = self.solver.as_ref().is_some_and(|solver| solver.dragged() == [vertex]);
        if !is_same {
            let place = self.problem.frame.uv_from_plane(self.embedding[vertex]);
            self.problem.targets.insert(vertex, Target::hard(place));
            let aim = self.problem.drag_target();
            self.solver = DragSolver::new(mesh, self.embedding.clone(), &[vertex], aim);
        }
        self.problem.targets.insert(vertex, Target::hard(target));
        let (solver, aim) = (self.solver.as_mut()?, self.problem.drag_target());
        let mut last = None;
        for _ in 0..frames {
            let frame = solver.drag(mesh, &aim, control).ok()?;
            let is_at_rest = frame.is_at_rest;
            last = Some((frame.verdict, is_at_rest));
            if is_at_rest {
                break;
            }
        }
        self.embedding = solver.embedding().clone();
        last
    }
}
