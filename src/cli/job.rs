//! Flattening without a screen, of one chart or several: solve, prove, write, print the summary.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::error::is_standard;
use super::error::{CommandError, CommandOutcome};
use super::opened::{disk_of, failure_of_layout};
use super::progress::{INTERRUPTED, ProgressLine, go_on};
use super::report_file::put_report;
use super::summary::{atlas_summary, deliver, ending_words, step_words, summary, warn_of};
use crate::session::{Model, SolvedModel, finished_atlas};
use freebound_core::flatten::Flattener;
use freebound_core::pipeline::{Fit, PipelineOptions, Problem, SolvedProblem};
use freebound_core::problem::{Control, Embedding, Phase, SolveError};
use freebound_core::verify::{Conflict, conflicts};
use freebound_io::{Materials, Output, OutputKind, PictureFile, Precision, SeamsReport, StepReport, StepsFolder};

/// Flattening without a screen of a mesh that is read.
pub(super) struct HeadlessJob<'a> {
    /// Options. Targets use the vertex numbers of the mesh, also with several charts.
    pub(super) options: PipelineOptions,
    /// Picture that is mapped onto the mesh.
    pub(super) picture: Option<Arc<PictureFile>>,
    /// Size of the texture coordinates.
    pub(super) fit: Fit,
    /// Size of the drawing.
    pub(super) svg_fit: Fit,
    pub(super) outputs: Vec<(OutputKind, &'a Path)>,
    pub(super) precision: Option<Precision>,
    pub(super) materials: Materials,
    pub(super) report: Option<&'a Path>,
    pub(super) steps: Option<&'a Path>,
    /// Numbers of the charts that stay where the layout to start from has them.
    pub(super) locked: BTreeSet<usize>,
}

impl HeadlessJob<'_> {
    /// Flattens, proves, writes, and prints the summary. `start` is the time when reading began.
    pub(super) fn run(
        &self,
        model: &Model,
        start: Instant,
        progress: &ProgressLine,
    ) -> Result<CommandOutcome, CommandError> {
        let read = start.elapsed().as_secs_f64();
        if model.prepared.chart.is_some() || self.options.packing.density.is_some() {
            return self.run_atlas(model, start, progress);
        }
        let mut folder = self.steps.map(StepsFolder::begin).transpose()?;
        let problem = self.options.problem();
        warn_of_conflicts(model, &problem)?;
        let SolvedChart { solved, records } = solve(model, problem, folder.as_mut(), progress)?;
        let mut output = model.finished(&solved.outcome, records, self.fit);
        report_seams(&mut output, model, read);
        self.write(&mut output, folder, start, progress)?;
        self.conclude(&output, || summary(&output.report, &ending_words(&solved, &output)))
    }

    /// Flattens a mesh whose charts are packed. They are solved in parallel.
    fn run_atlas(
        &self,
        model: &Model,
        start: Instant,
        progress: &ProgressLine,
    ) -> Result<CommandOutcome, CommandError> {
        let read = start.elapsed().as_secs_f64();
        self.refuse_idle_options(model)?;
        let models: Vec<Model> = (0..model.chart_count()).into_par_iter().map(|chart| model.of_chart(chart)).collect();
        let prepared: Vec<_> = models.iter().map(|model| &model.prepared).collect();
        let problems = self.options.problems(&prepared);
        models.iter().zip(&problems).try_for_each(|(model, problem)| warn_of_conflicts(model, problem))?;
        let work = models.par_iter().zip(problems);
        let solved: Vec<Result<SolvedChart, CommandError>> =
            work.map(|(model, problem)| solve(model, problem, None, progress)).collect();
        // Report the first failure in the order of the charts, independent of the threads.
        let solved: Vec<SolvedChart> = solved.into_iter().collect::<Result<_, _>>()?;
        progress.enter("packing");
        let layouts = self.layouts_of_locked(&models)?;
        let charts: Vec<SolvedModel<'_>> = models
            .iter()
            .zip(&solved)
            .enumerate()
            .map(|(number, (model, solved))| {
                let of = model.prepared.chart.as_ref();
                SolvedModel {
                    model,
                    outcome: &solved.solved.outcome,
                    steps: &solved.records,
                    size: of.map_or(1.0, |of| self.options.size_of(&of.charts, of.number)),
                    tile: of.and_then(|of| self.options.tile_of(&of.charts, of.number)),
                    locked: layouts.get(&number),
                    keeps_materials: self.keeps_materials(model),
                }
            })
            .collect();
        let before = Instant::now();
        let mut output = finished_atlas(&charts, self.options.packing, self.options.arrangement);
        report_seams(&mut output, model, read);
        if self.fit == Fit::True {
            let unequal = |error: std::io::Error| CommandError::Usage(format!("--fit true: {error}"));
            output.scale_to_true_size().map_err(unequal)?;
        }
        output.report.seconds.verify = before.elapsed().as_secs_f64();
        self.write(&mut output, None, start, progress)?;
        self.conclude(&output, || atlas_summary(&output.report))
    }

    /// True if every mesh that is written keeps the materials of the file: in the format of the file, and without a
    /// material of its own for a picture.
    fn keeps_materials(&self, model: &Model) -> bool {
        let own = if model.source.is_turned_over() { OutputKind::Glb } else { OutputKind::Obj };
        let mut meshes = self.outputs.iter().map(|&(kind, _)| kind).filter(|kind| kind.is_mesh());
        self.picture.is_none() && meshes.all(|kind| kind == own)
    }

    /// Layouts of the locked charts, by their numbers.
    fn layouts_of_locked(&self, models: &[Model]) -> Result<BTreeMap<usize, Embedding>, CommandError> {
        let layout = |&chart: &usize| {
            let model = &models[chart];
            Ok((chart, model.layout().map_err(|error| failure_of_layout(model, error))?))
        };
        self.locked.iter().map(layout).collect()
    }

    /// Rejects options that do not apply to packed charts.
    fn refuse_idle_options(&self, model: &Model) -> Result<(), CommandError> {
        let has_own_scales =
            !(self.options.targets.is_empty() && self.options.sizes.is_empty() && self.locked.is_empty());
        let own_scales = "charts with pins, locks or sizes have scales of their own";
        let is_true = self.fit == Fit::True;
        let cases = [
            (has_own_scales && is_true, "--fit true", own_scales),
            (is_true && self.options.packing.density.is_some(), "--fit true", "--density sets the size of the charts"),
            (is_true && self.options.packing.tiles > 1, "--fit true", "tiles are unit squares"),
            (has_own_scales && self.svg_fit == Fit::True, "--svg-scale true", own_scales),
            (self.steps.is_some(), "--steps", "it draws the steps of one chart"),
        ];
        match cases.into_iter().find(|(given, ..)| *given) {
            Some((_, option, why)) => {
                let has = if model.prepared.chart.is_some() {
                    "the mesh has several charts"
                } else {
                    "--density packs the mesh"
                };
                Err(CommandError::Usage(format!("{has}: remove {option}: {why}")))
            }
            None => Ok(()),
        }
    }

    /// Writes all files except the report.
    fn write<'b>(
        &'b self,
        output: &mut Output<'b>,
        folder: Option<StepsFolder>,
        start: Instant,
        progress: &ProgressLine,
    ) -> Result<(), CommandError> {
        let method = &self.options.settings.method;
        for chart in &output.charts {
            chart.coordinates.check_finite().map_err(|error| CommandError::of_method(method, error))?;
        }
        output.picture = self.picture.as_deref();
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
        let not_kept = self.outputs.iter().flat_map(|&(kind, _)| output.not_kept_in(kind));
        output.report.not_kept = not_kept.collect::<BTreeSet<_>>().into_iter().collect();
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

    /// Prints the summary and writes the report.
    fn conclude(&self, output: &Output<'_>, words: impl FnOnce() -> String) -> Result<CommandOutcome, CommandError> {
        let report = &output.report;
        if self.outputs.iter().any(|(_, path)| is_standard(path)) {
            self.report.map_or(Ok(()), |path| put_report(report, path))?;
        } else {
            deliver(report, self.report, words)?;
        }
        let of_charts = report.charts.iter().map(|chart| &chart.pins);
        let are_met = report.pins.iter().chain(of_charts).all(|pins| pins.unmet.is_empty());
        let has_density = report.packing.is_none_or(|packing| packing.unmet_density().is_none());
        Ok(if output.is_planar() && are_met && has_density { CommandOutcome::Fine } else { CommandOutcome::FallsShort })
    }
}

/// Reports the automatic seams of a mesh, which were found while it was read, within `read` seconds.
fn report_seams(output: &mut Output<'_>, model: &Model, read: f64) {
    let seams = model.automatic_seams();
    output.report.seams = seams.map(SeamsReport::of);
    output.report.seconds.cut = seams.map_or(0.0, |seams| seams.seconds);
    output.report.seconds.read = read - output.report.seconds.cut;
}

/// Warns of conflicting constraints on a mesh or chart.
fn warn_of_conflicts(model: &Model, problem: &Problem) -> Result<(), CommandError> {
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
    progress: &ProgressLine,
) -> Result<SolvedChart, CommandError> {
    let mesh = disk_of(model)?;
    let report_phase = |phase: Phase| progress.enter(phase.words());
    let control = Control::new(&INTERRUPTED, &report_phase);
    let method = problem.settings.method.clone();
    let options = model.flattener_options(&problem).map_err(|error| failure_of_layout(model, error))?;
    let flattener = Flattener::with_options(options);
    let mut records: Vec<StepReport> = Vec::new();
    let solved = problem.solve(mesh, flattener, control, |step| {
        progress.reach(step_words(step));
        records.push(StepReport::of(step));
        if let Some(folder) = folder.as_deref_mut() {
            progress.enter("drawing the step");
            folder.add(mesh, step).map_err(CommandError::from)?;
        }
        Ok(())
    });
    let in_file = |error: SolveError| error.renumbered(|vertex| model.vertex_in_file(vertex));
    match solved {
        Ok(solved) => Ok(SolvedChart { solved, records }),
        Err(CommandError::Solve(error)) if error != SolveError::Cancelled => {
            Err(CommandError::of_method(&method, in_file(error)))
        }
        Err(error) => Err(error),
    }
}

/// Chart at the end of its run.
struct SolvedChart {
    solved: SolvedProblem,
    /// Report on each step.
    records: Vec<StepReport>,
}
