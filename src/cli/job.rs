//! A flattening without a screen: solve, prove, write, sum up. One chart, or several.

use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;

use super::flatten::go_on;
use super::opened::{disk_of, failure_of_layout};
use super::progress::{INTERRUPTED, Progress};
use super::standard::is_standard;
use super::summary::{atlas_summary, deliver, ending_words, put_report, step_words, summary, warn_of};
use super::{Failure, Status};
use crate::geom::PackingOptions;
use crate::io::{Materials, Output, OutputFit, OutputKind, Precision, StepReport, StepsFolder, Targets};
use crate::session::{Arrangement, Document, Model, Outcome, Problem, SolvedChart, atlas};
use crate::solver::{Conflict, Control, Ending, Phase, SolveError, Step, conflicts};

/// A flattening without a screen, the mesh already read.
pub(super) struct HeadlessJob<'a> {
    /// Targets are of the vertices of the mesh, however many charts it has.
    pub(super) document: Document,
    /// Size of the texture coordinates.
    pub(super) fit: OutputFit,
    /// Size of the drawing.
    pub(super) svg_fit: OutputFit,
    /// How several charts are packed.
    pub(super) packing: PackingOptions,
    /// Whether they are packed at all.
    pub(super) arrangement: Arrangement,
    pub(super) outputs: Vec<(OutputKind, &'a Path)>,
    pub(super) precision: Precision,
    pub(super) materials: Materials,
    pub(super) report: Option<&'a Path>,
    pub(super) steps: Option<&'a Path>,
}

impl HeadlessJob<'_> {
    /// Flattens, proves, writes, and prints the summary. `start` is when reading began.
    pub(super) fn run(&self, model: &Model, start: Instant, progress: &Progress) -> Result<Status, Failure> {
        let read = start.elapsed().as_secs_f64();
        if model.chart.is_some() {
            return self.run_atlas(model, start, progress);
        }
        let mut folder = self.steps.map(StepsFolder::begin).transpose()?;
        let problem = self.document.problem();
        warn_of_conflicts(model, &problem)?;
        let mut solved = solve(model, problem, folder.as_mut(), progress)?;
        let records = std::mem::take(&mut solved.records);
        let mut output = solved.outcome.finished(model, records, self.fit);
        output.report.seconds.read = read;
        self.write(&mut output, folder, start, progress)?;
        self.conclude(&output, || summary(&output.report, &ending_words(&solved, &output)))
    }

    /// The same for a mesh of several charts, which are solved side by side.
    fn run_atlas(&self, model: &Model, start: Instant, progress: &Progress) -> Result<Status, Failure> {
        let read = start.elapsed().as_secs_f64();
        self.refuse_idle_options()?;
        let models: Vec<Model> = (0..model.chart_count()).into_par_iter().map(|chart| model.of_chart(chart)).collect();
        let problems = self.problems(&models);
        models.iter().zip(&problems).try_for_each(|(model, problem)| warn_of_conflicts(model, problem))?;
        let work = models.par_iter().zip(problems);
        let solved: Vec<Result<Solved, Failure>> =
            work.map(|(model, problem)| solve(model, problem, None, progress)).collect();
        // In the order of the charts: which of them fails first depends on the threads.
        let solved: Vec<Solved> = solved.into_iter().collect::<Result<_, _>>()?;
        progress.enter("packing");
        let charts: Vec<SolvedChart<'_>> = models
            .iter()
            .zip(&solved)
            .map(|(model, solved)| SolvedChart {
                model,
                outcome: &solved.outcome,
                steps: &solved.records,
                size: model.chart.as_ref().map_or(1.0, |of| self.document.size_of(&of.charts, of.number)),
            })
            .collect();
        let before = Instant::now();
        let mut output = atlas(&charts, self.packing, self.arrangement);
        output.report.seconds.read = read;
        output.report.seconds.verify = before.elapsed().as_secs_f64();
        self.write(&mut output, None, start, progress)?;
        self.conclude(&output, || atlas_summary(&output.report))
    }

    /// Refuses what means nothing to several charts.
    fn refuse_idle_options(&self) -> Result<(), Failure> {
        let of_size = self.fit == OutputFit::True || self.svg_fit == OutputFit::True;
        let cases = [
            (of_size, "--fit true and --svg-scale true", "they are packed into the unit square"),
            (self.steps.is_some(), "--steps", "it draws the steps of one"),
        ];
        match cases.into_iter().find(|(given, ..)| *given) {
            Some((_, option, why)) => {
                Err(Failure::Usage(format!("the mesh has several charts, which take no {option}: {why}")))
            }
            None => Ok(()),
        }
    }

    /// Writes all files but the report.
    fn write<'b>(
        &'b self,
        output: &mut Output<'b>,
        folder: Option<StepsFolder>,
        start: Instant,
        progress: &Progress,
    ) -> Result<(), Failure> {
        let method = self.document.settings.method;
        for chart in &output.charts {
            chart.coordinates.check_finite().map_err(|error| Failure::of_method(method, error))?;
        }
        output.picture = self.document.picture.as_deref();
        output.svg_fit = self.svg_fit;
        output.materials = self.materials;
        let mesh = self.outputs.iter().map(|&(kind, _)| kind).find(|kind| kind.is_mesh());
        output.round_to(self.precision, mesh.unwrap_or(OutputKind::Obj));
        progress.enter("writing");
        let before_writing = Instant::now();
        go_on()?;
        if let Some(folder) = folder {
            folder.finish()?;
        }
        for (kind, path) in &self.outputs {
            go_on()?;
            if is_standard(path) {
                output.write_to_standard_output(*kind)?;
            } else {
                output.write(*kind, path)?;
            }
        }
        output.report.seconds.write = before_writing.elapsed().as_secs_f64();
        output.report.seconds.total = start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Says what came of it, and writes the report.
    fn conclude(&self, output: &Output<'_>, words: impl FnOnce() -> String) -> Result<Status, Failure> {
        let report = &output.report;
        if self.outputs.iter().any(|(_, path)| is_standard(path)) {
            self.report.map_or(Ok(()), |path| put_report(report, path))?;
        } else {
            deliver(report, self.report, words)?;
        }
        let of_charts = report.charts.iter().map(|chart| &chart.pins);
        let are_met = report.pins.iter().chain(of_charts).all(|pins| pins.unmet.is_empty());
        Ok(if output.is_planar() && are_met { Status::Fine } else { Status::FallsShort })
    }

    /// The problem of each chart of a mesh, with the targets of its own vertices.
    fn problems(&self, charts: &[Model]) -> Vec<Problem> {
        let Problem { settings, frame, targets } = self.document.problem();
        let mut of_chart = vec![Targets::new(); charts.len()];
        let all = charts.first().and_then(|model| model.chart.as_ref()).map(|of| &of.charts);
        for (vertex, target) in targets {
            if let Some(number) = all.and_then(|all| all.chart_of_vertex(vertex))
                && let Some(own) = charts[number].vertex_of_file(vertex)
            {
                of_chart[number].insert(own, target);
            }
        }
        of_chart.into_iter().map(|targets| Problem { settings, frame, targets }).collect()
    }
}

/// Says which constraints on a mesh or chart contradict each other.
fn warn_of_conflicts(model: &Model, problem: &Problem) -> Result<(), Failure> {
    let Problem { settings, .. } = problem;
    if settings.method.uses_pins() && !problem.targets.is_empty() {
        let found = conflicts(disk_of(model)?, &settings.held(&problem.pins()));
        let in_file: Vec<Conflict> =
            found.into_iter().map(|conflict| conflict.renumbered(|vertex| model.vertex_in_file(vertex))).collect();
        warn_of(&model.path_words(), &in_file);
    }
    Ok(())
}

/// Takes all steps of the method.
fn solve(
    model: &Model,
    problem: Problem,
    mut folder: Option<&mut StepsFolder>,
    progress: &Progress,
) -> Result<Solved, Failure> {
    let mesh = disk_of(model)?;
    let report_phase = |phase: Phase| progress.enter(phase.words());
    let control = Control::new(&INTERRUPTED, &report_phase);
    let method = problem.settings.method;
    let mut run = problem.ladder_on(model).map_err(|error| failure_of_layout(model, error))?;
    let placed = |step: Step| Outcome::new(mesh, problem, step);
    let mut records: Vec<StepReport> = Vec::new();
    let mut last: Option<Step> = None;
    loop {
        let step = match run.step(mesh, control) {
            Ok(step) => step,
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
            // Where a rung fails, the steps before it are written.
            Err(error) => {
                let Some(before) = last else {
                    let in_file = error.renumbered(|vertex| model.vertex_in_file(vertex));
                    return Err(Failure::of_method(method, in_file));
                };
                return Ok(Solved { outcome: placed(before), records, ending: Err(error) });
            }
        };
        progress.reach(step_words(&step));
        records.push(StepReport::of(&step));
        if let Some(folder) = folder.as_deref_mut() {
            progress.enter("drawing the step");
            folder.add(mesh, &step)?;
        }
        if let Some(ending) = run.ending() {
            return Ok(Solved { outcome: placed(step), records, ending: Ok(ending) });
        }
        if !step.is_of_planar_start() {
            last = Some(step);
        }
    }
}

/// A run at its end.
pub(super) struct Solved {
    pub(super) outcome: Outcome,
    records: Vec<StepReport>,
    /// Why it ended; the error, where a rung failed.
    pub(super) ending: Result<Ending, SolveError>,
}
