//! Methods that run independently on one mesh, each from its beginning to its end. No method reuses results of another,
//! so that their times can be compared.

use std::sync::Arc;
use std::time::Instant;

use super::Model;
use super::numbers::error_in_file;
use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::pipeline::{Outcome, Problem, pins_summary};
use freebound_core::problem::{Control, SolveError, Variant};
use freebound_io::{
    ChartNumber, ComparisonReport, MeshReport, MethodError, MethodReport, MethodSeconds, ResultReport, StepReport,
    TimedStep, VerdictCounts,
};

/// Method that has ended, with its result.
#[derive(Clone, Debug)]
pub struct Compared {
    /// Problem that the method solved.
    pub problem: Problem,
    /// Last step that is not part of a planar start, if there is one.
    pub outcome: Option<Arc<Outcome>>,
    /// Reason for the end of the run, or the error of a stage that failed.
    pub ending: Result<Ending, SolveError>,
    /// Report on the method. Vertices are numbered as in the file of the model.
    pub report: MethodReport,
}

impl Compared {
    /// Runs a problem's method to its end and passes the numbers of each step to `take`. The run starts from the layout
    /// of the file if the problem asks for it and the layout exists.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the caller cancels. All other errors end the method and are part of the result.
    ///
    /// # Panics
    ///
    /// If the model is not a disk.
    pub fn run(
        model: &Model,
        problem: Problem,
        control: Control<'_>,
        mut take: impl FnMut(&TimedStep),
    ) -> Result<Self, SolveError> {
        let mesh = model.disk().expect("only a disk is solved");
        let mut ladder =
            Flattener::with_options(model.flattener_options(&problem).unwrap_or_else(|_| problem.options()));
        let (mut seconds, mut steps, mut last) = (MethodSeconds::default(), Vec::new(), None);
        let mut since = Instant::now();
        let ending = ladder.finish(mesh, control, |step| {
            seconds.verify += step.verify_seconds;
            // The verdict and the hull condition inform the user. They are no part of the method.
            let aside = step.verify_seconds + step.hull_seconds;
            seconds.solve += (since.elapsed().as_secs_f64() - aside).max(0.0);
            let outcome = Outcome::new(mesh, problem.clone(), step);
            let timed = timed(&outcome, seconds);
            take(&timed);
            steps.push(timed);
            if !outcome.step.is_of_planar_start() {
                last = Some(Arc::new(outcome));
            }
            // Time spent on the comparison itself is not counted.
            since = Instant::now();
        });
        // Time of failed attempts is counted, too.
        seconds.solve += since.elapsed().as_secs_f64();
        if ending == Err(SolveError::Cancelled) {
            return Err(SolveError::Cancelled);
        }
        let numbers = Numbers { ending: ending.clone(), steps, seconds };
        let report = numbers.report(model, &problem, last.as_deref());
        Ok(Self { problem, outcome: last, ending, report })
    }
}

/// Report on methods that have run on a model, in their order.
///
/// # Panics
///
/// If the model is not a disk.
pub fn comparison_report(model: &Model, methods: &[&Compared]) -> ComparisonReport {
    let disk = model.disk().expect("methods run on disks only");
    let mesh = MeshReport::new(model.path_words(), disk).prepared(&model.source, &model.prepared);
    let chart = model.prepared.chart.as_ref().map(|of| ChartNumber { number: of.number, of: of.charts.count() });
    let aspect = methods.first().map_or(1.0, |method| method.problem.frame.aspect);
    let mut report = ComparisonReport::new(mesh, chart, aspect);
    report.methods = methods.iter().map(|method| method.report.clone()).collect();
    report
}

/// Numbers of a run, without its embedding.
struct Numbers {
    /// Ending, or the error of a stage that failed.
    ending: Result<Ending, SolveError>,
    steps: Vec<TimedStep>,
    seconds: MethodSeconds,
}

impl Numbers {
    fn report(self, model: &Model, problem: &Problem, outcome: Option<&Outcome>) -> MethodReport {
        let settings = &problem.settings;
        let variant = Variant::of(settings);
        let shape = settings.method.boundary_shape();
        MethodReport {
            name: variant.to_string(),
            title: variant.title(),
            method: settings.method.clone(),
            family: variant.family,
            shape: shape.cloned(),
            ending: self.ending.as_ref().map_or("failed", |ending| ending.name()),
            error: self.ending.as_ref().err().map(|error| MethodError::from(&error_in_file(model, error))),
            result: outcome.map(|outcome| result(model, outcome)),
            seconds: self.seconds,
            factor_bytes: self.steps.iter().map(|timed| timed.step.factor_bytes).filter(|&bytes| bytes > 0).max(),
            steps: self.steps,
        }
    }
}

/// Numbers of a step, with the time elapsed.
fn timed(outcome: &Outcome, seconds: MethodSeconds) -> TimedStep {
    let summary = &outcome.distortion.summary;
    TimedStep {
        step: StepReport::of(&outcome.step),
        elapsed: seconds.total(),
        energy: summary.symmetric_dirichlet.mean,
        stretch_l2: summary.stretch_l2,
        stretch_linf: summary.stretch_linf,
    }
}

fn result(model: &Model, outcome: &Outcome) -> ResultReport {
    let step: &Step = &outcome.step;
    let frame = outcome.problem.frame;
    let coordinates = step.candidate.solution.embedding.iter().map(|&z| frame.uv_from_plane(z)).collect();
    ResultReport {
        verdict: VerdictCounts::from(&step.verdict),
        boundary: if step.candidate.has_convex_boundary() { "convex" } else { "free" },
        pins: pins_summary(outcome, &coordinates).renumbered(|vertex| model.vertex_in_file(vertex)),
        distortion: outcome.distortion.summary,
        new_vertices: outcome.new_vertex_count(),
    }
}
