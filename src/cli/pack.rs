//! `freebound pack`: new places for the charts of an existing layout, without flattening.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use super::args::PackArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome, is_standard};
use super::flatten::refuse_unwritten_formats;
use super::places::OutputPaths;
use super::progress::{INTERRUPTED, ProgressLine, go_on};
use super::report_file::put_report;
use super::standard::read_typed;
use super::summary::{deliver, pack_summary};
use crate::session::Model;
use freebound_core::pipeline::RepackError;
use freebound_core::problem::{Control, SolveError};
use freebound_io::{LayoutToPackError, Materials, OutputKind, PictureFile, RepackedFile};

pub(super) fn run(arguments: &PackArguments) -> Result<CommandOutcome, CommandError> {
    refuse_unwritten_formats(arguments.output.as_deref())?;
    if arguments.copy_materials && arguments.output.as_deref().is_some_and(is_standard) {
        let text = "standard output: --copy-materials needs a folder for its files: name a file with -o";
        return Err(CommandError::Usage(text.to_owned()));
    }
    let places = OutputPaths::of_pack(arguments);
    places.keep_apart()?;
    places.spare(&arguments.mesh, "the mesh")?;
    if let Some(picture) = &arguments.picture {
        places.spare(picture, "the picture")?;
    }
    await_report(arguments.report.as_deref());
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let model = read_typed(&arguments.mesh, arguments.reading)?;
        places.spare_materials(&model.source, &arguments.mesh)?;
        if arguments.copy_materials {
            places.spare_copied_materials(arguments.output.as_deref(), &model.source, &arguments.mesh)?;
        }
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
    let materials = if arguments.copy_materials { Materials::Copied } else { Materials::Stay };
    match file {
        Ok(file) => Ok(RepackedFile { source_path: model.path.as_deref(), materials, ..file }),
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
    let mesh = outputs.iter().map(|&(kind, _)| kind).find(|kind| kind.is_mesh());
    file.round_to(arguments.precision, mesh.unwrap_or(OutputKind::Obj));
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
    let report = arguments.report.as_deref();
    let is_streamed = arguments.outputs().iter().any(|(_, path): &(OutputKind, &Path)| is_standard(path));
    if is_streamed {
        report.map_or(Ok(()), |path| put_report(&file.report, path))?;
    } else {
        deliver(&file.report, report, || {
            pack_summary(&file.report, file.repacked.verdict.as_ref().err().map(AsRef::as_ref))
        })?;
    }
    Ok(if file.repacked.is_planar() { CommandOutcome::Fine } else { CommandOutcome::FallsShort })
}
