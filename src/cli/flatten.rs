//! `freebound flatten`: read, solve, prove, write.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::args::{Fit, FlattenArguments};
use super::constraints::gather;
use super::progress::{Progress, interrupted, is_interrupted};
use super::{Failure, Status};
use crate::io::{OutputKind, PinsReport, Report, StepReport, StepsFolder};
use crate::mesh::DiskMesh;
use crate::session::{Document, Finished, Model, Outcome, OutputFit, PictureFile, Placement, Surface};
use crate::solver::{Control, Ending, Method, Phase, Run, SolveError, Step};

pub(super) fn run(arguments: &FlattenArguments) -> Result<Status, Failure> {
    if let Some((option, why)) = arguments.idle_option() {
        let name = arguments.settings().method.name();
        return Err(Failure::Usage(format!("--method {name} takes no {option}: {why}")));
    }
    if arguments.fit == Fit::True && (arguments.aspect.is_some() || arguments.picture.is_some()) {
        return Err(Failure::Usage(
            "--fit true makes no texture coordinates of a picture: leave out one of them".into(),
        ));
    }
    set_threads(arguments.threads)?;
    let picture = arguments.picture.as_deref().map(PictureFile::read).transpose()?;
    let fit = output_fit(arguments.fit);
    let progress = Progress::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let model = Model::read_until(&arguments.mesh, &is_interrupted)?;
        let pins = gather(arguments, disk_of(&model)?.vertex_count())?;
        let document = Document {
            pins,
            settings: arguments.settings(),
            picture: picture.map(Arc::new),
            aspect: arguments.aspect,
            ..Document::default()
        };
        let job = HeadlessJob {
            document,
            sizes: [fit, arguments.svg_scale.map_or(fit, output_fit)],
            outputs: [
                (OutputKind::Obj, arguments.output.as_deref()),
                (OutputKind::Svg, arguments.svg.as_deref()),
                (OutputKind::Png, arguments.png.as_deref()),
            ]
            .into_iter()
            .filter_map(|(kind, path)| Some((kind, path?)))
            .collect(),
            report: arguments.report.as_deref(),
            steps: arguments.steps.as_deref(),
        };
        job.run(&model, start, &progress)
    })
}

fn output_fit(fit: Fit) -> OutputFit {
    match fit {
        Fit::Unit => OutputFit::Unit,
        Fit::True => OutputFit::True,
    }
}

/// A flattening without a screen, the mesh already read.
pub(super) struct HeadlessJob<'a> {
    pub(super) document: Document,
    /// Size of the texture coordinates and of the drawing.
    pub(super) sizes: [OutputFit; 2],
    pub(super) outputs: Vec<(OutputKind, &'a Path)>,
    pub(super) report: Option<&'a Path>,
    pub(super) steps: Option<&'a Path>,
}

impl HeadlessJob<'_> {
    /// Flattens, proves, writes, and prints the summary. `start` is when reading began.
    pub(super) fn run(&self, model: &Model, start: Instant, progress: &Progress) -> Result<Status, Failure> {
        let mesh = disk_of(model)?;
        let read_seconds = start.elapsed().as_secs_f64();
        let mut folder = self.steps.map(StepsFolder::begin).transpose()?;
        let Solved { outcome, records, ending } = self.solve(mesh, folder.as_mut(), progress)?;
        let [fit, svg_fit] = self.sizes;
        let mut finished = Finished::new((model, mesh), &outcome, records, fit, read_seconds)
            .with_picture(self.document.picture.clone())
            .with_svg_fit(svg_fit);
        progress.enter("writing");
        let before_writing = Instant::now();
        go_on()?;
        if let Some(folder) = folder {
            folder.finish()?;
        }
        for (kind, path) in &self.outputs {
            go_on()?;
            finished.write(*kind, path)?;
        }
        finished.report.seconds.write = before_writing.elapsed().as_secs_f64();
        finished.report.seconds.total = start.elapsed().as_secs_f64();
        match self.report {
            Some(path) if path == Path::new("-") => print_report(&finished.report),
            Some(path) => finished.write(OutputKind::Json, path)?,
            None => {}
        }
        if self.report != Some(Path::new("-")) {
            let end = ending_words(&outcome, &finished, &ending);
            print_summary(&finished.report, &end);
        }
        Ok(if finished.verdict().planar && are_met(&finished.report) { Status::Fine } else { Status::FallsShort })
    }

    /// Takes all steps of the method.
    fn solve(
        &self,
        mesh: &DiskMesh,
        mut folder: Option<&mut StepsFolder>,
        progress: &Progress,
    ) -> Result<Solved, Failure> {
        let report_phase = |phase: Phase| progress.enter(phase.words());
        let control = Control::new(interrupted(), &report_phase);
        let document = &self.document;
        let settings = document.run_settings();
        let mut run = Run::new(settings, document.plane_pins());
        let placed = |step: Step| Outcome::new(mesh, settings, (document.frame(), document.pins.clone()), step);
        let mut records: Vec<StepReport> = Vec::new();
        let mut last: Option<Step> = None;
        loop {
            let step = match (run.step(mesh, control), last) {
                (Ok(step), _) => step,
                // A rung that gives nothing leaves the steps before it, which are written.
                (Err(error), Some(last)) if error != SolveError::Cancelled => {
                    return Ok(Solved { outcome: placed(last), records, ending: Err(error) });
                }
                (Err(error), _) => return Err(error.into()),
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
            last = Some(step);
        }
    }
}

/// A run at its end.
struct Solved {
    outcome: Outcome,
    records: Vec<StepReport>,
    /// Why it ended; the error of the rung that gave nothing, where it could not go on.
    ending: Result<Ending, SolveError>,
}

/// A rung in words.
fn rung_words(rung: Method) -> &'static str {
    match rung {
        Method::Natural => "natural boundary",
        Method::Iterate => "iteration",
        Method::VirtualBoundary => "virtual boundary",
        other => other.name(),
    }
}

/// What a step reached, for the line that follows the work.
fn step_words(step: &Step) -> String {
    let number = if step.rung == Method::Iterate { format!(" {}", step.index) } else { String::new() };
    format!("{}{number}: {}", rung_words(step.rung), step.verdict.summary())
}

/// The verdict, and after how many steps and on which rung a run of several came to it.
fn ending_words(outcome: &Outcome, finished: &Finished, ending: &Result<Ending, SolveError>) -> String {
    let mut words = finished.verdict().summary();
    let step = &outcome.step;
    if outcome.settings.method.takes_steps() {
        let count = finished.report.steps.len();
        let boundary = if step.has_convex_boundary() { ", boundary convex" } else { "" };
        let why = match ending {
            Ok(Ending::Planar | Ending::Done) => String::new(),
            Ok(Ending::Unmet) => ", constraints not met".to_owned(),
            Ok(Ending::Stalled) => ", which gets no better".to_owned(),
            Ok(Ending::Limit) => ", as many as it may take".to_owned(),
            Err(error) => format!("; the next gave nothing: {error}"),
        };
        let steps = if count == 1 { "step" } else { "steps" };
        let rung = rung_words(step.rung);
        words = format!("{words} after {count} {steps} ({rung}{boundary}{why})");
    }
    if finished.report.placement == Some(Placement::Unmoved.name()) {
        words += "; not moved into the unit square, whose numbers would fold it";
    } else if step.verdict.planar && !finished.verdict().planar {
        words += "; it was planar before it was brought to this size: try --fit true";
    }
    words
}

/// Writes a report to standard output, which must then hold nothing else.
pub(super) fn print_report(report: &Report) {
    println!("{}", serde_json::to_string_pretty(report).expect("a report is plain data"));
}

/// An error where the user asked to stop.
pub(super) fn go_on() -> Result<(), SolveError> {
    if is_interrupted() { Err(SolveError::Cancelled) } else { Ok(()) }
}

/// The disk, or everything that keeps the mesh from being one.
pub(super) fn disk_of(model: &Model) -> Result<&DiskMesh, Failure> {
    match &model.surface {
        Surface::Disk(disk) => Ok(disk),
        Surface::Faulty(_, diagnosis) => {
            Err(Failure::NotADisk { path: model.path_words(), diagnosis: Box::new(diagnosis.as_ref().clone()) })
        }
    }
}

/// Whether every constraint that is to be met exactly is.
fn are_met(report: &Report) -> bool {
    report.pins.as_ref().and_then(|pins| pins.max_hard_error).is_none_or(|error| error == 0.0)
}

/// What became of the user's pins.
fn pins_words(pins: &PinsReport) -> Option<String> {
    let hard = pins.max_hard_error.map(|error| {
        let count = pins.count - pins.weighted.len();
        let how = if error == 0.0 { "met exactly".to_owned() } else { format!("missed by up to {error:.1e}") };
        format!("{count} hard {how}")
    });
    let worst = pins.weighted.iter().max_by(|a, b| a.error.total_cmp(&b.error));
    let weighted = worst.map(|worst| {
        let count = pins.weighted.len();
        format!("{count} weighted met within {:.1e} (the farthest is vertex {})", worst.error, worst.vertex)
    });
    let parts: Vec<String> = hard.into_iter().chain(weighted).collect();
    (!parts.is_empty()).then(|| format!("constraints: {}", parts.join(", ")))
}

fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(count) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count.into())
        .build_global()
        .map_err(|error| Failure::Usage(format!("cannot run {count} threads: {error}")))
}

fn print_summary(report: &Report, verdict: &str) {
    let mesh = &report.mesh;
    println!(
        "{}: {} vertices, {} faces, {} on the boundary, {} dividing edges, {} ears",
        mesh.path, mesh.vertices, mesh.faces, mesh.boundary_vertices, mesh.dividing_edges, mesh.ears
    );
    let family = report.family.as_deref().map(|family| format!(", {family} weights")).unwrap_or_default();
    let residual = report.steps.last().map_or(0.0, |step| step.residual);
    println!("{}{family}: {verdict}; residual {residual:.1e}", report.method.unwrap_or("check"));
    if let Some(words) = report.pins.as_ref().and_then(pins_words) {
        println!("{words}");
    }
    if let Some(distortion) = &report.distortion {
        println!(
            "angle distortion {:.3} mean, {:.3} p99; area {:.3} mean; stretch L² {:.3}, L∞ {:.3}",
            distortion.angle.mean,
            distortion.angle.p99,
            distortion.area.mean,
            distortion.stretch_l2,
            distortion.stretch_linf
        );
    }
    let seconds = &report.seconds;
    println!(
        "{:.3} s: read {:.3}, solve {:.3}, verify {:.3}, write {:.3}",
        seconds.total, seconds.read, seconds.solve, seconds.verify, seconds.write
    );
}
