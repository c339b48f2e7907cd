//! `freebound pack`: new places for the charts of an existing layout, without flattening.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use super::args::PackArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome, is_standard};
use super::flatten::refuse_unwritten_mesh;
use super::places::OutputPaths;
use super::progress::{INTERRUPTED, ProgressLine, go_on};
use super::standard::read_typed;
use super::summary::{deliver_beside, pack_summary};
use crate::session::Model;
use freebound_core::pipeline::RepackError;
use freebound_core::problem::{Control, SolveError};
use freebound_io::{LayoutToPackError, OutputKind, PictureFile, RepackedFile};

pub(super) fn run(arguments: &PackArguments) -> Result<CommandOutcome, CommandError> {
    refuse_unwritten_mesh(&arguments.result)?;
    let places = OutputPaths::of_pack(arguments);
    places.keep_apart()?;
    places.spare(&arguments.mesh, "the mesh")?;
    if let Some(picture) = &arguments.picture {
        places.spare(picture, "the picture")?;
    }
    await_report(arguments.result.report.as_deref());
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let model = read_typed(&arguments.mesh, arguments.result.reading)?;
        places.spare_materials_and_copies(&arguments.result, &model.source, &arguments.mesh)?;
        let picture = arguments.picture.as_deref().map(PictureFile::read).transpose()?;
        let read = start.elapsed().as_secs_f64();
        go_on()?;
        progress.enter("packing");
        let mut file = packed(arguments, &model, picture.as_ref())?;
        file.report.seconds.read = read;
        go_on()?;
        write(arguments, &mut file, start, &progress)?;
        conclude(arguments, &file)
    })
}

fn packed<'a>(
    arguments: &PackArguments,
    model: &'a Model,
    picture: Option<&PictureFile>,
) -> Result<RepackedFile<'a>, CommandError> {
    let path = model.path_words();
    let control = Control::new(&INTERRUPTED, &|_| {});
    let file = RepackedFile::new(&model.source, path.clone(), &arguments.packing(picture), control);
    match file {
        Ok(file) => {
            let materials = arguments.result.materials();
            Ok(RepackedFile { source_path: model.path.as_deref(), materials, ..file })
        }
        Err(LayoutToPackError::Repack(RepackError::NoSuchChart { chart, count })) => {
            Err(CommandError::no_such_chart("--lock", chart, count))
        }
        Err(LayoutToPackError::Repack(RepackError::Cancelled)) => Err(SolveError::Cancelled.into()),
        Err(error) => Err(CommandError::LayoutToPack { path, error }),
    }
}

/// Writes all files except the report.
fn write(
    arguments: &PackArguments,
    file: &mut RepackedFile<'_>,
    start: Instant,
    progress: &ProgressLine,
) -> Result<(), CommandError> {
    let outputs = arguments.outputs();
    file.round_to(arguments.result.precision, arguments.result.kind());
    let not_kept = outputs.iter().flat_map(|&(kind, _)| file.not_kept_in(kind));
    file.report.not_kept = not_kept.collect::<BTreeSet<_>>().into_iter().collect();
    progress.enter("writing");
    let before_writing = Instant::now();
    for (kind, path) in outputs {
        go_on()?;
        if is_standard(path) {
            file.write_to_standard_output(kind)?;
        } else {
            file.write(kind, path)?;
        }
    }
    file.report.seconds.write = before_writing.elapsed().as_secs_f64();
    file.report.seconds.total = start.elapsed().as_secs_f64();
    Ok(())
}

/// Prints the summary and writes the report.
fn conclude(arguments: &PackArguments, file: &RepackedFile<'_>) -> Result<CommandOutcome, CommandError> {
    let is_streamed = arguments.outputs().iter().any(|(_, path): &(OutputKind, &Path)| is_standard(path));
    let faults = file.repacked.verdict.as_ref().err().map(AsRef::as_ref);
    let words = || pack_summary(&file.report, faults);
    deliver_beside(is_streamed, &file.report, arguments.result.report.as_deref(), words)?;
    Ok(CommandOutcome::of(file.repacked.is_planar()))
}
