//! `freebound flatten`: read, solve, prove, write.

use std::path::Path;
use std::time::Instant;

use super::args::{Fit, FlattenArguments};
use super::progress::{Progress, interrupted, is_interrupted};
use super::{Failure, Status};
use crate::io::{OutputKind, Report, StepReport};
use crate::mesh::DiskMesh;
use crate::session::{Finished, Model, Outcome, OutputFit, Surface};
use crate::solver::{Control, Phase, Pins, Run, Settings, SolveError};

pub(super) fn run(arguments: &FlattenArguments) -> Result<Status, Failure> {
    set_threads(arguments.threads)?;
    let job = HeadlessJob {
        settings: arguments.settings(),
        pins: pins(arguments)?,
        fit: match arguments.fit {
            Fit::Unit => OutputFit::Unit,
            Fit::True => OutputFit::True,
        },
        outputs: [
            (OutputKind::Obj, arguments.output.as_deref()),
            (OutputKind::Svg, arguments.svg.as_deref()),
            (OutputKind::Png, arguments.png.as_deref()),
        ]
        .into_iter()
        .filter_map(|(kind, path)| Some((kind, path?)))
        .collect(),
        report: arguments.report.as_deref(),
    };
    let progress = Progress::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let model = Model::read_until(&arguments.mesh, &is_interrupted)?;
        job.run(&model, start, &progress)
    })
}

/// A flattening without a screen, the mesh already read.
pub(super) struct HeadlessJob<'a> {
    pub(super) settings: Settings,
    pub(super) pins: Pins,
    pub(super) fit: OutputFit,
    pub(super) outputs: Vec<(OutputKind, &'a Path)>,
    pub(super) report: Option<&'a Path>,
}

impl HeadlessJob<'_> {
    /// Flattens, proves, writes, and prints the summary. `start` is when reading began.
    pub(super) fn run(&self, model: &Model, start: Instant, progress: &Progress) -> Result<Status, Failure> {
        let mesh = disk_of(model)?;
        let read_seconds = start.elapsed().as_secs_f64();
        let report_phase = |phase: Phase| progress.enter(phase.words());
        let control = Control::new(interrupted(), &report_phase);
        let mut run = Run::new(self.settings, self.pins.clone());
        let (mut last, mut records) = (None, Vec::new());
        run.finish(mesh, control, |step| {
            records.push(StepReport::of(&step));
            last = Some(step);
        })?;
        let outcome = Outcome::new(mesh, &run, last.expect("a run has a first step"));
        let mut finished = Finished::new((model, mesh), &outcome, records, self.fit, read_seconds);
        progress.enter("writing");
        let before_writing = Instant::now();
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
            print_summary(&finished.report, finished.verdict().summary().as_str());
        }
        Ok(if finished.verdict().planar { Status::Fine } else { Status::NotPlanar })
    }
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

fn pins(arguments: &FlattenArguments) -> Result<Pins, Failure> {
    let method = arguments.settings().method;
    if !arguments.pins.is_empty() && !method.uses_pins() {
        let name = method.name();
        return Err(Failure::Usage(format!("--method {name} takes no --pin: it places the whole boundary by itself")));
    }
    let mut pins = Pins::new();
    for &(vertex, target) in &arguments.pins {
        if pins.insert(vertex, target).is_some() {
            return Err(Failure::Usage(format!("vertex {vertex} is pinned twice: leave out one of the --pin")));
        }
    }
    Ok(pins)
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
