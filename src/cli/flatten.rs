//! `freebound flatten`: read, solve, prove, write. And the main job without a screen: the built-in example, flattened
//! into a folder.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use super::args::{FlattenArguments, ThreadArguments};
use super::exit::conclude;
use super::failed::await_report;
use super::job::HeadlessJob;
use super::opened::{Opened, Wanted};
use super::places::Places;
use super::progress::{Progress, is_interrupted, stop_on_interrupt};
use super::say::say;
use super::standard::is_standard;
use super::typed::ChartSize;
use super::{Failure, Status};
use crate::examples::Example;
use crate::geom::PackingOptions;
use crate::io::{Materials, OutputFit, OutputKind, Precision, Targets, WriteError};
use crate::mesh::FaceId;
use crate::session::{Arrangement, Document, Model};
use crate::solver::{Choice as _, SolveError};

/// Folder that the example is written into, in the current one.
const FOLDER: &str = "freebound-example";

pub(super) fn run(arguments: &FlattenArguments) -> Result<Status, Failure> {
    let FlattenArguments { input, solve, .. } = arguments;
    if let Some((option, why)) = arguments.idle_option() {
        let name = arguments.settings().method.name();
        return Err(Failure::Usage(format!("--method {name} takes no {option}: {why}")));
    }
    if arguments.fit == Some(OutputFit::True) && (solve.aspect.is_some() || arguments.picture.is_some()) {
        return Err(Failure::Usage(
            "--fit true makes no texture coordinates of a picture: leave out one of them".into(),
        ));
    }
    if solve.start.is_some() && arguments.fit == Some(OutputFit::Unit) {
        return Err(Failure::Usage("--start keeps the place of the layout: leave out --fit unit".into()));
    }
    refuse_unwritten_formats(arguments.output.as_deref())?;
    let places = Places::of_flatten(arguments);
    refuse_clashes(arguments, &places)?;
    await_report(arguments.report.as_deref());
    set_threads(solve.threads)?;
    let progress = Progress::default();
    progress.follow(|| {
        let start = Instant::now();
        let wanted = Wanted { input, solve, picture: arguments.picture.as_deref() };
        let Opened { model, picture, targets } = wanted.open(&places, &progress)?;
        places.spare_copies(arguments, &model.source, picture.as_ref())?;
        let packing = arguments.packing(picture.as_ref());
        let document = Document {
            sizes: sizes(&arguments.chart_size, &model, &targets)?,
            targets,
            settings: arguments.settings(),
            picture: picture.map(Arc::new),
            aspect: solve.aspect,
            ..Document::default()
        };
        let job = HeadlessJob {
            document,
            fit: arguments.fit.unwrap_or_default(),
            svg_fit: arguments.svg_scale.or(arguments.fit).unwrap_or_default(),
            packing,
            arrangement: arguments.arrangement(),
            outputs: arguments.outputs(),
            precision: arguments.precision,
            materials: if arguments.copy_materials { Materials::Copied } else { Materials::Stay },
            report: arguments.report.as_deref(),
            steps: arguments.steps.as_deref(),
        };
        job.run(&model, start, &progress)
    })
}

/// Refuses names that belong to formats which are read and not written.
fn refuse_unwritten_formats(output: Option<&Path>) -> Result<(), Failure> {
    let extension = output.and_then(Path::extension).unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if matches!(extension.as_str(), "gltf" | "off" | "stl") {
        let text = format!("-o: .{extension} files are not written: end the name in .obj, .ply or .glb");
        return Err(Failure::Usage(text));
    }
    Ok(())
}

/// How many times as large as the others charts are packed, by their first faces. Those with targets are not packed.
fn sizes(given: &[ChartSize], model: &Model, targets: &Targets) -> Result<BTreeMap<FaceId, f64>, Failure> {
    let count = model.chart_count();
    let charts = model.chart.as_ref().map(|of| &of.charts);
    let first_face = |chart: usize| {
        charts.filter(|charts| chart < charts.count()).map(|charts| charts.first_face(chart)).ok_or_else(|| {
            let why = if count == 1 {
                "one chart, which fills the square".into()
            } else {
                format!("charts 0 to {}", count - 1)
            };
            Failure::Usage(format!("--chart-size {chart}: the mesh has {why}"))
        })
    };
    let held: BTreeSet<usize> =
        targets.keys().filter_map(|&vertex| charts.and_then(|charts| charts.chart_of_vertex(vertex))).collect();
    let mut sizes = BTreeMap::new();
    for &ChartSize { chart, size } in given {
        let is_twice = sizes.insert(first_face(chart)?, size).is_some();
        let faults = [
            (is_twice, "the chart has a size twice: leave out one of them"),
            (held.contains(&chart), "pins hold the chart, and it is not packed: leave out its size or its pins"),
        ];
        if let Some((_, why)) = faults.into_iter().find(|(is_so, _)| *is_so) {
            return Err(Failure::Usage(format!("--chart-size {chart}: {why}")));
        }
    }
    Ok(sizes)
}

/// Refuses files that would be written over, by the run itself or as results of one another.
fn refuse_clashes(arguments: &FlattenArguments, places: &Places) -> Result<(), Failure> {
    places.keep_apart()?;
    places.spare_inputs(&arguments.input, &arguments.solve)?;
    let polygon = arguments.boundary.as_ref().and_then(|typed| typed.file.as_deref());
    for (file, what) in [(arguments.picture.as_deref(), "the picture"), (polygon, "the polygon")] {
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
        packing: PackingOptions::default(),
        arrangement: Arrangement::Packed,
        outputs: vec![(OutputKind::Obj, &mesh), (OutputKind::Png, &picture)],
        precision: Precision::default(),
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

/// An error where the user asked to stop.
pub(super) fn go_on() -> Result<(), SolveError> {
    if is_interrupted() { Err(SolveError::Cancelled) } else { Ok(()) }
}

/// Has all work done by so many threads.
pub(super) fn set_threads(threads: ThreadArguments) -> Result<(), Failure> {
    let Some(count) = threads.count else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count.into())
        .build_global()
        .map_err(|error| Failure::Usage(format!("cannot run {count} threads: {error}")))
}
