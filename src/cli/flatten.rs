//! `freebound flatten`: read, solve, prove, write. And the main job without a screen: the built-in example, flattened
//! into a folder.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use super::args::FlattenArguments;
use super::exit::conclude;
use super::failed::await_report;
use super::places::Places;
use super::progress::{INTERRUPTED, Progress, is_interrupted, stop_on_interrupt};
use super::say::say;
use super::standard::{is_standard, name_of_input, read_model};
use super::summary::{deliver, ending_words, put_report, step_words, summary, warn_of};
use super::{Failure, Status};
use crate::examples::Example;
use crate::io::{
    Constraints, Materials, OutputFit, OutputKind, PictureFile, StepReport, StepsFolder, Target, Targets, WriteError,
};
use crate::mesh::{DiskMesh, VertexId};
use crate::session::{Document, Model, Outcome, Surface};
use crate::solver::{Choice as _, Control, Ending, Phase, SolveError, Step, conflicts};

/// Folder that the example is written into, in the current one.
const FOLDER: &str = "freebound-example";

pub(super) fn run(arguments: &FlattenArguments) -> Result<Status, Failure> {
    if let Some((option, why)) = arguments.idle_option() {
        let name = arguments.settings().method.name();
        return Err(Failure::Usage(format!("--method {name} takes no {option}: {why}")));
    }
    if arguments.fit == OutputFit::True && (arguments.aspect.is_some() || arguments.picture.is_some()) {
        return Err(Failure::Usage(
            "--fit true makes no texture coordinates of a picture: leave out one of them".into(),
        ));
    }
    let places = Places::of_flatten(arguments);
    refuse_clashes(arguments, &places)?;
    await_report(arguments.report.as_deref());
    set_threads(arguments.threads)?;
    let progress = Progress::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let model = read_model(&arguments.mesh, arguments.form())?;
        places.spare_materials(&model.source, &arguments.mesh)?;
        let picture = arguments.picture.as_deref().map(PictureFile::read).transpose()?;
        places.spare_copies(arguments, &model.source, picture.as_ref())?;
        disk_of(&model)?;
        let targets = gather(arguments, model.vertex_count())?;
        let document = Document {
            targets,
            settings: arguments.settings(),
            picture: picture.map(Arc::new),
            aspect: arguments.aspect,
            ..Document::default()
        };
        let job = HeadlessJob {
            document,
            fit: arguments.fit,
            svg_fit: arguments.svg_scale.unwrap_or(arguments.fit),
            outputs: arguments.outputs(),
            materials: if arguments.copy_materials { Materials::Copied } else { Materials::Stay },
            report: arguments.report.as_deref(),
            steps: arguments.steps.as_deref(),
        };
        job.run(&model, start, &progress)
    })
}

/// Refuses files that would be written over, by the run itself or as results of one another.
fn refuse_clashes(arguments: &FlattenArguments, places: &Places) -> Result<(), Failure> {
    places.keep_apart()?;
    places.spare(&arguments.mesh, "the mesh")?;
    for (file, what) in [(&arguments.constraints, "the constraints"), (&arguments.picture, "the picture")] {
        if let Some(path) = file {
            places.spare(path, what)?;
        }
    }
    let beside = [(arguments.picture.is_some(), "--picture"), (arguments.copy_materials, "--copy-materials")];
    match beside.into_iter().find(|(given, _)| *given && arguments.output.as_deref().is_some_and(is_standard)) {
        Some((_, option)) => {
            Err(Failure::Usage(format!("standard output: -o has no folder there for {option}: name a file")))
        }
        None => Ok(()),
    }
}

/// Flattens the built-in face and writes mesh, report and picture into a folder that it names.
pub fn run_example() -> ExitCode {
    stop_on_interrupt();
    conclude(flatten_example(), None)
}

fn flatten_example() -> Result<Status, Failure> {
    let folder = Path::new(FOLDER);
    std::fs::create_dir_all(folder).map_err(|source| WriteError::writing(folder, source))?;
    let [mesh, picture, report] = ["face.obj", "face.png", "face.json"].map(|name| folder.join(name));
    let job = HeadlessJob {
        document: Document::of_example(Example::Face),
        fit: OutputFit::Unit,
        svg_fit: OutputFit::Unit,
        outputs: vec![(OutputKind::Obj, &mesh), (OutputKind::Png, &picture)],
        materials: Materials::Stay,
        report: Some(&report),
        steps: None,
    };
    let progress = Progress::default();
    let status = progress.follow(|| job.run(&Model::example(Example::Face), Instant::now(), &progress))?;
    say(format_args!(
        "wrote face.obj with its material and picture, face.json and face.png (before and after) into {FOLDER}/"
    ))?;
    Ok(status)
}

/// The targets of all pins, for a mesh with so many vertices.
///
/// # Errors
///
/// A file that cannot be used, or a pin that clashes with another one; where that stands in the file, with its line.
fn gather(arguments: &FlattenArguments, vertex_count: usize) -> Result<Targets, Failure> {
    let file = match &arguments.constraints {
        Some(path) => Constraints::read(path, vertex_count)?,
        None => Constraints::default(),
    };
    let place = arguments.constraints.as_deref().unwrap_or(Path::new(""));
    let mut targets = file.targets.clone();
    for (vertex, target) in &arguments.pins {
        if let Some(line) = file.lines.get(vertex) {
            let text = format!("line {line}: vertex {vertex} is pinned by --pin, too: leave out one of them");
            return Err(Failure::Usage(format!("{}: {text}", place.display())));
        }
        if let Some(first) = in_the_way(&file.targets, target) {
            let line = file.lines[&first];
            let text = format!("line {line}: vertex {first} has the target that --pin gives to vertex {vertex}");
            return Err(Failure::Usage(format!("{}: {text}: move one of them, or give a weight", place.display())));
        }
        if targets.insert(*vertex, *target).is_some() {
            let mesh = name_of_input(&arguments.mesh);
            return Err(Failure::Usage(format!("{mesh}: vertex {vertex} is pinned twice: leave out one of the --pin")));
        }
    }
    Ok(targets)
}

/// The exact pin that has the target of another exact one.
fn in_the_way(targets: &Targets, target: &Target) -> Option<VertexId> {
    let clashes = |other: &Target| target.hold.is_exact() && other.hold.is_exact() && other.uv == target.uv;
    targets.iter().find(|(_, other)| clashes(other)).map(|(&vertex, _)| vertex)
}

/// A flattening without a screen, the mesh already read.
struct HeadlessJob<'a> {
    document: Document,
    /// Size of the texture coordinates.
    fit: OutputFit,
    /// Size of the drawing.
    svg_fit: OutputFit,
    outputs: Vec<(OutputKind, &'a Path)>,
    materials: Materials,
    report: Option<&'a Path>,
    steps: Option<&'a Path>,
}

impl HeadlessJob<'_> {
    /// Flattens, proves, writes, and prints the summary. `start` is when reading began.
    fn run(&self, model: &Model, start: Instant, progress: &Progress) -> Result<Status, Failure> {
        let read_seconds = start.elapsed().as_secs_f64();
        let mut folder = self.steps.map(StepsFolder::begin).transpose()?;
        let mut solved = self.solve(model, folder.as_mut(), progress)?;
        let records = std::mem::take(&mut solved.records);
        let mut output = solved.outcome.finished(model, records, self.fit);
        output.coordinates.check_finite().map_err(|error| Failure::of_method(self.document.settings.method, error))?;
        output.report.seconds.read = read_seconds;
        output.picture = self.document.picture.as_deref();
        output.svg_fit = self.svg_fit;
        output.materials = self.materials;
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
        let report = &output.report;
        if self.outputs.iter().any(|(_, path)| is_standard(path)) {
            self.report.map_or(Ok(()), |path| put_report(report, path))?;
        } else {
            deliver(report, self.report, || summary(report, &ending_words(&solved, &output)))?;
        }
        let are_met = output.report.pins.as_ref().is_none_or(|pins| pins.unmet.is_empty());
        Ok(if output.verdict.planar && are_met { Status::Fine } else { Status::FallsShort })
    }

    /// Takes all steps of the method.
    fn solve(
        &self,
        model: &Model,
        mut folder: Option<&mut StepsFolder>,
        progress: &Progress,
    ) -> Result<Solved, Failure> {
        let mesh = disk_of(model)?;
        let report_phase = |phase: Phase| progress.enter(phase.words());
        let control = Control::new(&INTERRUPTED, &report_phase);
        let problem = self.document.problem();
        let (settings, pins) = (problem.settings, problem.pins());
        if settings.method.uses_pins() {
            warn_of(&model.path_words(), &conflicts(mesh, &settings.held(&pins)));
        }
        let mut run = problem.ladder();
        let placed = |step: Step| Outcome::new(mesh, problem, step);
        let mut records: Vec<StepReport> = Vec::new();
        let mut last: Option<Step> = None;
        loop {
            let step = match run.step(mesh, control) {
                Ok(step) => step,
                Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
                // Where a rung fails, the steps before it are written.
                Err(error) => match last {
                    Some(before) => return Ok(Solved { outcome: placed(before), records, ending: Err(error) }),
                    None => return Err(Failure::of_method(settings.method, error)),
                },
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
}

/// A run at its end.
pub(super) struct Solved {
    pub(super) outcome: Outcome,
    records: Vec<StepReport>,
    /// Why it ended; the error, where a rung failed.
    pub(super) ending: Result<Ending, SolveError>,
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
            let remedy = model.remedy.as_ref().map(|remedy| remedy.done().to_vec());
            Err(Failure::NotADisk { path: model.path_words(), diagnosis: Box::new(diagnosis.as_ref().clone()), remedy })
        }
    }
}

fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(count) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count.into())
        .build_global()
        .map_err(|error| Failure::Usage(format!("cannot run {count} threads: {error}")))
}
