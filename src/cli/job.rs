//! Flattening without a screen, of one chart or several: solve, prove, write, print the summary.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use super::error::is_standard;
use super::error::{CommandError, CommandOutcome};
use super::opened::disk_of;
use super::pattern::PatternJob;
use super::progress::{INTERRUPTED, ProgressLine, go_on};
use super::summary::{atlas_summary, deliver_beside, ending_words, step_words, summary, warn_of};
use freebound_core::pipeline::{Fit, PipelineOptions, Problem};
use freebound_core::problem::{Control, Phase, SolveError};
use freebound_core::verify::{Conflict, conflicts};
use freebound_io::{Materials, Output, OutputKind, PictureFile, Precision, StepsFolder};
use freebound_run::{ChartProblem, Model, Run, RunError, SolvedRun};

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
    pub(super) pattern: Option<PatternJob<'a>>,
    /// File for the flat mesh.
    pub(super) flat_mesh: Option<&'a Path>,
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
        let run = Run {
            options: self.options.clone(),
            fit: self.fit,
            locked: self.locked.clone(),
            keeps_materials: self.keeps_materials(model),
        };
        let is_packed = run.is_packed(model);
        if is_packed {
            self.refuse_idle_options(model)?;
        }
        let folder = self.steps.map(StepsFolder::begin).transpose()?.map(Mutex::new);
        let charts = run.problems(model);
        charts.iter().try_for_each(|chart| warn_of_conflicts(&chart.model, &chart.problem))?;
        let solved = solve(&run, charts, folder.as_ref(), progress).map_err(|error| match error {
            RunError::Solve(error) if error != SolveError::Cancelled => {
                CommandError::of_method(&self.options.settings.method, error)
            }
            error => CommandError::of_run(model, error),
        })?;
        progress.enter("packing");
        let mut output = solved.output(&run).map_err(|error| CommandError::of_run(model, RunError::TrueSize(error)))?;
        output.report.seconds.read = read - output.report.seconds.cut;
        let folder = folder.and_then(|folder| folder.into_inner().ok());
        self.write(&mut output, folder, start, progress)?;
        let name = model.name.as_str();
        let pattern = self.pattern.map(|pattern| pattern.write(&output, name)).transpose()?;
        self.conclude(
            &output,
            || match &solved.charts[..] {
                [chart] if !is_packed => summary(&output.report, &ending_words(&chart.solved, &output)),
                _ => atlas_summary(&output.report),
            },
            pattern.as_deref(),
        )
    }

    /// True if every mesh that is written keeps the materials of the file: in the format of the file, and without a
    /// material of its own for a picture.
    fn keeps_materials(&self, model: &Model) -> bool {
        let own = if model.source.is_turned_over() { OutputKind::Glb } else { OutputKind::Obj };
        let mut meshes = self.outputs.iter().map(|&(kind, _)| kind).filter(|kind| kind.is_mesh());
        self.picture.is_none() && meshes.all(|kind| kind == own)
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
        if let Some(path) = self.flat_mesh {
            go_on()?;
            output.write_flat_mesh(path)?;
        }
        output.report.seconds.write = before_writing.elapsed().as_secs_f64();
        output.report.seconds.total = start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Prints the summary and writes the report.
    fn conclude(
        &self,
        output: &Output<'_>,
        words: impl FnOnce() -> String,
        pattern: Option<&str>,
    ) -> Result<CommandOutcome, CommandError> {
        let report = &output.report;
        let is_streamed = self.outputs.iter().any(|(_, path)| is_standard(path));
        let words = || words() + &pattern.map(|words| format!("\npattern: {words}")).unwrap_or_default();
        deliver_beside(is_streamed, report, self.report, words)?;
        Ok(CommandOutcome::of(output.is_planar() && report.meets_request()))
    }
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

/// Takes all steps of the method on all charts.
fn solve(
    run: &Run,
    charts: Vec<ChartProblem>,
    folder: Option<&Mutex<StepsFolder>>,
    progress: &ProgressLine,
) -> Result<SolvedRun, RunError<CommandError>> {
    let report_phase = |phase: Phase| progress.enter(phase.words());
    let control = Control::new(&INTERRUPTED, &report_phase);
    run.solve(charts, control, |mesh, step| {
        progress.reach_step(step, step_words(step));
        if let Some(mut folder) = folder.and_then(|folder| folder.lock().ok()) {
            progress.enter("drawing the step");
            folder.add(mesh, step)?;
        }
        Ok(())
    })
}
