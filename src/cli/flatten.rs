//! `freebound flatten`: read, solve, prove, write. The module also flattens the built-in example into a folder, which
//! the program does if no window can be opened.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use super::args::{FlattenArguments, MeshOutputArguments};
use super::awaited::await_report;
use super::error::is_standard;
use super::error::{CommandError, CommandOutcome};
use super::exit::conclude;
use super::job::HeadlessJob;
use super::opened::{InputSpec, LoadedMesh};
use super::pattern::PatternJob;
use super::places::OutputPaths;
use super::progress::{ProgressLine, stop_on_interrupt};
use super::say::say;
use super::threads::set_threads;
use super::tiles::ChartTiles;
use super::typed::ChartSize;
use crate::examples::Example;
use freebound_core::geom::{PackingOptions, PictureFrame};
use freebound_core::mesh::FaceId;
use freebound_core::pipeline::{Fit, PipelineOptions, Targets, hard_targets};
use freebound_core::problem::{NamedOption as _, Settings};
use freebound_io::{Materials, OutputKind, PictureFile, WriteError};
use freebound_run::{Model, RunRequest};

/// Folder for the example, relative to the current folder.
const FOLDER: &str = "freebound-example";

pub(super) fn run(arguments: &FlattenArguments) -> Result<CommandOutcome, CommandError> {
    run_with(arguments, None)
}

/// Runs `unwrap`.
pub(super) fn unwrap(arguments: &FlattenArguments) -> Result<CommandOutcome, CommandError> {
    run_with(arguments, Some(RunRequest::UNWRAP_ROUNDS))
}

/// Flattens a mesh. `usual_rounds` of relaxing follow if the arguments do not say otherwise and a part of the mesh has
/// no map from the search for automatic seams.
fn run_with(arguments: &FlattenArguments, usual_rounds: Option<usize>) -> Result<CommandOutcome, CommandError> {
    let FlattenArguments { input, solve, .. } = arguments;
    if let Some((option, why)) = arguments.idle_option() {
        let name = arguments.settings().method.name();
        return Err(CommandError::Usage(format!("--method {name} does not use {option}: {why}")));
    }
    refuse_idle_fit(arguments)?;
    refuse_unwritten_meshes(arguments)?;
    let pattern = PatternJob::typed(&arguments.cutting)?;
    let places = OutputPaths::of_flatten(arguments);
    refuse_clashes(arguments, &places)?;
    await_report(arguments.report.as_deref());
    set_threads(solve.threads)?;
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        let wanted = InputSpec { input, solve, picture: arguments.picture.as_deref() };
        let LoadedMesh { model, picture, targets } = wanted.open(&places, &progress)?;
        places.spare_copies(arguments, &model.source, picture.as_ref())?;
        let tiles = ChartTiles::new(arguments.tiles, &model)?;
        let packing = PackingOptions { tiles: tiles.count, ..arguments.packing(picture.as_ref()) };
        let locked = locked(&arguments.lock, &model)?;
        let aspect = picture.as_ref().map(PictureFile::aspect).or(solve.aspect);
        let settings = arguments.settings();
        let relax_rounds = settings.relax_rounds.or_else(|| model.usual_rounds(usual_rounds));
        let options = PipelineOptions {
            preparation: model.prepared.form.clone(),
            distortion: None,
            most_charts: None,
            seam_visibility: None,
            settings: Settings { relax_rounds, ..settings },
            frame: PictureFrame { aspect: aspect.unwrap_or(1.0), ..PictureFrame::default() },
            has_picture: aspect.is_some(),
            sizes: sizes(&arguments.chart_size, &model, &targets, &locked)?,
            tiles: tiles.of_chart,
            targets,
            packing,
            arrangement: arguments.arrangement(),
        };
        let job = HeadlessJob {
            options,
            picture: picture.map(Arc::new),
            fit: arguments.fit.unwrap_or_default(),
            svg_fit: arguments.svg_scale.or(arguments.fit).unwrap_or_default(),
            outputs: arguments.outputs(),
            precision: arguments.precision,
            materials: if arguments.copy_materials { Materials::Copied } else { Materials::Stay },
            report: arguments.report.as_deref(),
            steps: arguments.steps.as_deref(),
            pattern,
            flat_mesh: arguments.flat_mesh.as_deref(),
            locked,
        };
        job.run(&model, start, &progress)
    })
}

/// Rejects sizes that other options decide.
fn refuse_idle_fit(arguments: &FlattenArguments) -> Result<(), CommandError> {
    let solve = &arguments.solve;
    if arguments.fit == Some(Fit::True) && (solve.aspect.is_some() || arguments.picture.is_some()) {
        return Err(CommandError::Usage(
            "--fit true does not scale to a picture: remove --fit true, or --picture and --aspect".into(),
        ));
    }
    if solve.start.is_some() && arguments.fit == Some(Fit::Unit) {
        return Err(CommandError::Usage("--start keeps the position of the layout: remove --fit unit".into()));
    }
    Ok(())
}

/// Rejects meshes that cannot be written as requested.
fn refuse_unwritten_meshes(arguments: &FlattenArguments) -> Result<(), CommandError> {
    refuse_unwritten_formats("-o", arguments.output.as_deref())?;
    refuse_unwritten_formats("--flat-mesh", arguments.flat_mesh.as_deref())?;
    if arguments.flat_mesh.as_deref().is_some_and(is_standard) {
        return Err(CommandError::Usage("standard output: --flat-mesh writes a file: name one".to_owned()));
    }
    Ok(())
}

/// Rejects names of formats that can be read but not written.
pub(super) fn refuse_unwritten_formats(option: &str, output: Option<&Path>) -> Result<(), CommandError> {
    let extension = output.and_then(Path::extension).unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if matches!(extension.as_str(), "gltf" | "off" | "stl") {
        let text = format!("{option}: .{extension} files cannot be written: end the name in .obj, .ply or .glb");
        return Err(CommandError::Usage(text));
    }
    Ok(())
}

/// Rejects meshes that cannot be written as requested: formats without a writer, and a stream with files beside it.
pub(super) fn refuse_unwritten_mesh(result: &MeshOutputArguments) -> Result<(), CommandError> {
    refuse_unwritten_formats("-o", result.output.as_deref())?;
    refuse_files_beside_stream(result.output.as_deref(), [(result.copy_materials, "--copy-materials")])
}

/// Rejects options that write files beside the mesh if the mesh goes to standard output.
fn refuse_files_beside_stream(
    output: Option<&Path>,
    options: impl IntoIterator<Item = (bool, &'static str)>,
) -> Result<(), CommandError> {
    match options.into_iter().find(|(given, _)| *given && output.is_some_and(is_standard)) {
        Some((_, option)) => Err(CommandError::Usage(format!(
            "standard output: {option} needs a folder for its files: name a file with -o"
        ))),
        None => Ok(()),
    }
}

/// Numbers of locked charts.
fn locked(given: &[usize], model: &Model) -> Result<BTreeSet<usize>, CommandError> {
    let count = model.chart_count();
    match given.iter().find(|&&chart| chart >= count) {
        Some(&chart) => Err(CommandError::no_such_chart("--lock", chart, count)),
        None => Ok(given.iter().copied().collect()),
    }
}

/// Relative sizes of charts, by their first faces. Sizes of charts with targets and of locked charts are rejected,
/// because these charts are not packed.
fn sizes(
    given: &[ChartSize],
    model: &Model,
    targets: &Targets,
    locked: &BTreeSet<usize>,
) -> Result<BTreeMap<FaceId, f64>, CommandError> {
    let count = model.chart_count();
    let charts = model.prepared.chart.as_ref().map(|of| &of.charts);
    let first_face = |chart: usize| {
        charts.filter(|charts| chart < charts.count()).map(|charts| charts.first_face(chart)).ok_or_else(|| {
            let why = if count == 1 {
                "one chart, which fills the square".into()
            } else {
                format!("charts 0 to {}", count - 1)
            };
            CommandError::Usage(format!("--chart-size {chart}: the mesh has {why}"))
        })
    };
    let held: BTreeSet<usize> =
        targets.keys().filter_map(|&vertex| charts.and_then(|charts| charts.chart_of_vertex(vertex))).collect();
    let mut sizes = BTreeMap::new();
    for &ChartSize { chart, size } in given {
        let is_twice = sizes.insert(first_face(chart)?, size).is_some();
        let faults = [
            (is_twice, "the chart has two sizes: remove one of them"),
            (locked.contains(&chart), "the chart is locked, so it is not packed: remove its size or its lock"),
            (held.contains(&chart), "the chart is pinned, so it is not packed: remove its size or its pins"),
        ];
        if let Some((_, why)) = faults.into_iter().find(|(is_so, _)| *is_so) {
            return Err(CommandError::Usage(format!("--chart-size {chart}: {why}")));
        }
    }
    Ok(sizes)
}

/// Rejects outputs that would overwrite an input or another output.
fn refuse_clashes(arguments: &FlattenArguments, places: &OutputPaths) -> Result<(), CommandError> {
    places.keep_apart()?;
    places.spare_inputs(&arguments.input, &arguments.solve)?;
    let polygon = arguments.boundary.as_ref().and_then(|typed| typed.file.as_deref());
    for (file, what) in [(arguments.picture.as_deref(), "the picture"), (polygon, "the polygon")] {
        if let Some(path) = file {
            places.spare(path, what)?;
        }
    }
    let beside = [(arguments.picture.is_some(), "--picture"), (arguments.copy_materials, "--copy-materials")];
    refuse_files_beside_stream(arguments.output.as_deref(), beside)
}

/// Flattens the built-in face and writes mesh, report and picture into the folder `freebound-example`.
pub fn run_example() -> ExitCode {
    stop_on_interrupt();
    conclude(flatten_example(), None)
}

fn flatten_example() -> Result<CommandOutcome, CommandError> {
    let folder = Path::new(FOLDER);
    std::fs::create_dir_all(folder).map_err(|source| WriteError::writing(folder, source))?;
    let [mesh, picture, report] = ["face.obj", "face.png", "face.json"].map(|name| folder.join(name));
    let landmarks = Example::Face.landmarks().into_iter();
    let picture_of_face = Example::Face.picture_file().expect("the face has a portrait");
    let job = HeadlessJob {
        options: PipelineOptions {
            frame: PictureFrame { aspect: picture_of_face.aspect(), ..PictureFrame::default() },
            has_picture: true,
            targets: hard_targets(landmarks.map(|landmark| (landmark.vertex, landmark.target.into()))),
            ..PipelineOptions::default()
        },
        picture: Some(picture_of_face),
        fit: Fit::Unit,
        svg_fit: Fit::Unit,
        outputs: vec![(OutputKind::Obj, &mesh), (OutputKind::Png, &picture)],
        precision: None,
        materials: Materials::Stay,
        report: Some(&report),
        steps: None,
        pattern: None,
        flat_mesh: None,
        locked: BTreeSet::new(),
    };
    let progress = ProgressLine::default();
    let status = progress.follow(|| job.run(&Example::Face.model(), Instant::now(), &progress))?;
    say(format_args!(
        "wrote face.obj with its material and picture, face.json and face.png (before and after) into {FOLDER}/"
    ))?;
    Ok(status)
}
