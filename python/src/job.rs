//! A run on a thread of its own, with a thread pool of its own.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use freebound_core::flatten::Step;
use freebound_core::problem::{Control, Phase, SolveError};
use freebound_run::{MeshLayout, Model, RunError, RunRequest};
use pyo3::exceptions::{PyRuntimeError, PyTimeoutError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors;
use super::layout::Layout;
use super::mesh::Mesh;
use super::options::{Lists, Options, of_json};

/// Interval of checks for signals while the caller waits.
const TICK: Duration = Duration::from_millis(50);

/// Time for a cancelled run to end by itself. The caller does not wait longer.
const GRACE: Duration = Duration::from_millis(80);

/// Reason why a run has no layout.
enum Failure {
    Run(RunError),
    /// Thread or pool that could not be made, or a panic.
    Internal(String),
}

/// Progress of a run.
#[derive(Clone, Copy, Default)]
struct Progress {
    phase: &'static str,
    stage: &'static str,
    steps: usize,
    is_planar: bool,
}

/// State that the run shares with its caller.
#[derive(Default)]
struct Shared {
    cancel: AtomicBool,
    progress: Mutex<Progress>,
    ended: OnceLock<Result<Arc<MeshLayout>, Failure>>,
    gate: Mutex<()>,
    end: Condvar,
}

/// Run in the background.
#[pyclass(frozen, module = "freebound")]
pub(crate) struct Job {
    shared: Arc<Shared>,
    start: Instant,
    /// Process whose thread works.
    process: u32,
}

/// Runs work in a pool of its own, and turns a panic into a message.
pub(crate) fn in_pool<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    catch_unwind(AssertUnwindSafe(|| pool.install(work))).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        format!("internal error, please report it: {}", text.unwrap_or("no message"))
    })
}

/// Runs work in a pool of its own. A signal cancels it, and so does `stop`, a function of Python, if it returns true.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    threads: usize,
    stop: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Control<'_>) -> T + Send,
) -> PyResult<T> {
    let cancel = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (done, wait) = sync_channel(1);
        let cancel = &cancel;
        let run = move || done.send(in_pool(threads, || work(Control::new(cancel, &|_| {})))).ok();
        let thread = std::thread::Builder::new().name("freebound".to_owned()).spawn_scoped(scope, run);
        thread.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let mut wait = wait;
        loop {
            let (back, received) = py.detach(move || {
                let received = wait.recv_timeout(TICK);
                (wait, received)
            });
            wait = back;
            match received {
                Ok(found) => return found.map_err(PyRuntimeError::new_err),
                Err(RecvTimeoutError::Timeout) => {
                    let asked =
                        py.check_signals().and_then(|()| stop.map_or(Ok(false), |stop| stop.call0()?.is_truthy()));
                    if !matches!(asked, Ok(false)) {
                        cancel.store(true, Ordering::Relaxed);
                        py.detach(move || wait.recv().map(drop).ok());
                        return Err(asked.err().unwrap_or_else(|| errors::cancelled(py)));
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(PyRuntimeError::new_err("the thread has ended")),
            }
        }
    })
}

impl Shared {
    fn run(&self, request: &RunRequest, model: &Model, threads: usize) {
        let report = |phase: Phase| self.note(|progress| progress.phase = phase.words());
        let control = Control::new(&self.cancel, &report);
        let observe = |_: &_, step: &Step| {
            self.note(|progress| {
                progress.steps += 1;
                progress.stage = step.candidate.stage.name();
                progress.is_planar = step.verdict.planar;
            });
            Ok::<(), std::convert::Infallible>(())
        };
        let found = in_pool(threads, || request.run_with(model, control, observe));
        let ended = match found {
            Ok(Ok(layout)) => Ok(Arc::new(layout)),
            Ok(Err(error)) => Err(Failure::Run(error)),
            Err(message) => Err(Failure::Internal(message)),
        };
        self.finish(ended);
    }

    fn finish(&self, ended: Result<Arc<MeshLayout>, Failure>) {
        let gate = self.gate.lock().unwrap_or_else(PoisonError::into_inner);
        // Only the first end counts.
        self.ended.set(ended).ok();
        self.end.notify_all();
        drop(gate);
    }

    fn note(&self, change: impl FnOnce(&mut Progress)) {
        change(&mut self.progress.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Waits for the end, at most for a time. Returns true if the run has ended.
    fn wait(&self, time: Duration) -> bool {
        let gate = self.gate.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.end.wait_timeout_while(gate, time, |()| self.ended.get().is_none());
        drop(waited);
        self.ended.get().is_some()
    }
}

#[pymethods]
impl Job {
    /// Starts a run. `options` is a JSON object, `lists` a dictionary of arrays.
    #[new]
    fn new(py: Python<'_>, mesh: &Mesh, options: &str, lists: Lists<'_>) -> PyResult<Self> {
        let options: Options = of_json(py, options)?;
        let request = options.request(py, &lists)?;
        let (model, threads) = (mesh.model(), options.threads.map_or(0, usize::from));
        let shared = Arc::new(Shared::default());
        let of_thread = Arc::clone(&shared);
        let work = move || of_thread.run(&request, &model, threads);
        let thread = std::thread::Builder::new().name("freebound".to_owned()).spawn(work);
        thread.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self { shared, start: Instant::now(), process: std::process::id() })
    }

    /// Asks the run to stop.
    fn cancel(&self) {
        self.shared.cancel.store(true, Ordering::Relaxed);
    }

    /// Waits for the end, at most for some seconds. Returns true if the run has ended. Signals interrupt it.
    #[pyo3(signature = (timeout=None))]
    fn wait(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<bool> {
        let limit = timeout.map(|seconds| Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or(Duration::MAX));
        let start = Instant::now();
        let mut cancelled: Option<Instant> = None;
        loop {
            if self.process != std::process::id() && self.shared.ended.get().is_none() {
                return Err(PyRuntimeError::new_err("the run belongs to the process before the fork"));
            }
            if self.shared.cancel.load(Ordering::Relaxed)
                && cancelled.get_or_insert_with(Instant::now).elapsed() >= GRACE
            {
                // The thread ends at its next check, and nobody sees its result.
                self.shared.finish(Err(Failure::Run(SolveError::Cancelled.into())));
            }
            let left = limit.map_or(TICK, |limit| limit.saturating_sub(start.elapsed()).min(TICK));
            if py.detach(|| self.shared.wait(left)) {
                return Ok(true);
            }
            py.check_signals()?;
            if limit.is_some_and(|limit| start.elapsed() >= limit) {
                return Ok(false);
            }
        }
    }

    /// Layout of the run. Waits for it, at most for some seconds.
    #[pyo3(signature = (timeout=None))]
    fn result(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Layout> {
        if !self.wait(py, timeout)? {
            return Err(PyTimeoutError::new_err("the run has not ended yet"));
        }
        match self.shared.ended.get() {
            Some(Ok(layout)) => {
                let layout = Layout::of(Arc::clone(layout));
                if layout.is_fine() {
                    return Ok(layout);
                }
                let message = layout.shortfall();
                let layout = Py::new(py, layout)?.into_any();
                Err(errors::not_proved(py, message, Some(layout)))
            }
            Some(Err(Failure::Run(error))) => Err(errors::of_run(py, error)),
            Some(Err(Failure::Internal(message))) => Err(PyRuntimeError::new_err(message.clone())),
            None => Err(PyTimeoutError::new_err("the run has not ended yet")),
        }
    }

    /// True if the run has ended.
    #[getter]
    fn done(&self) -> bool {
        self.shared.ended.get().is_some()
    }

    /// Progress: the stage, its phase, the number of steps, if the last step is planar, and the seconds since the start.
    #[getter]
    fn progress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Progress { phase, stage, steps, is_planar } =
            *self.shared.progress.lock().unwrap_or_else(PoisonError::into_inner);
        let found = PyDict::new(py);
        found.set_item("stage", stage)?;
        found.set_item("phase", phase)?;
        found.set_item("steps", steps)?;
        found.set_item("planar", is_planar)?;
        found.set_item("seconds", self.start.elapsed().as_secs_f64())?;
        Ok(found)
    }
}

impl Drop for Job {
    /// A run that nobody waits for stops.
    fn drop(&mut self) {
        self.cancel();
    }
}
