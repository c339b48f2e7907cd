//! `freebound transfer` and `freebound bake`: the layout of a mesh on another mesh, and its picture in another layout.

use std::path::Path;
use std::time::Instant;

use super::args::{BakeArguments, TransferArguments};
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome, is_standard, name_of_input};
use super::flatten::refuse_unwritten_mesh;
use super::places::OutputPaths;
use super::progress::{INTERRUPTED, ProgressLine, go_on};
use super::say::warn;
use super::standard::read_typed;
use super::summary::{bake_summary, deliver, deliver_beside, transfer_summary};
use crate::session::Model;
use freebound_core::problem::{Control, SolveError};
use freebound_io::raster::write_png;
use freebound_io::{
    MeshReport, PaintedSurface, PictureFile, Report, Seconds, TextureMesh, TransferError, TransferredFile, bake,
    material_pictures, write_atomically,
};

pub(super) fn run(arguments: &TransferArguments) -> Result<CommandOutcome, CommandError> {
    refuse_unwritten_mesh(&arguments.result)?;
    refuse_two_streams(&arguments.layout, &arguments.mesh)?;
    let places = OutputPaths::of_transfer(arguments);
    places.keep_apart()?;
    places.spare(&arguments.layout, "the layout")?;
    places.spare(&arguments.mesh, "the mesh")?;
    await_report(arguments.result.report.as_deref());
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let layout = read_typed(&arguments.layout, arguments.result.reading)?;
        let mesh = read_typed(&arguments.mesh, arguments.result.reading)?;
        places.spare_materials(&layout.source, &arguments.layout)?;
        places.spare_materials_and_copies(&arguments.result, &mesh.source, &arguments.mesh)?;
        let read = start.elapsed().as_secs_f64();
        go_on()?;
        progress.enter("copying");
        let mut file = transferred(arguments, &layout, &mesh)?;
        file.report.seconds.read = read;
        go_on()?;
        write(arguments, &mut file, start, &progress)?;
        conclude(arguments, &file)
    })
}

/// Refuses two inputs from standard input.
pub(super) fn refuse_two_streams(first: &Path, second: &Path) -> Result<(), CommandError> {
    if is_standard(first) && is_standard(second) {
        let text = "standard input: it cannot be both meshes: name a file for one of them";
        return Err(CommandError::Usage(text.to_owned()));
    }
    Ok(())
}

fn transferred<'a>(
    arguments: &'a TransferArguments,
    layout: &Model,
    mesh: &'a Model,
) -> Result<TransferredFile<'a>, CommandError> {
    let control = Control::new(&INTERRUPTED, &|_| {});
    match TransferredFile::new(&layout.source, &mesh.source, arguments.options(), control) {
        Ok(mut file) => {
            file.report.mesh.path = mesh.path_words();
            (file.source_path, file.materials) = (mesh.path.as_deref(), arguments.result.materials());
            Ok(file)
        }
        Err(TransferError::Cancelled) => Err(SolveError::Cancelled.into()),
        Err(error @ TransferError::NoFaces) => Err(CommandError::Transfer { path: mesh.path_words(), error }),
        Err(error) => Err(CommandError::Transfer { path: layout.path_words(), error }),
    }
}

/// Writes the mesh.
fn write(
    arguments: &TransferArguments,
    file: &mut TransferredFile<'_>,
    start: Instant,
    progress: &ProgressLine,
) -> Result<(), CommandError> {
    progress.enter("writing");
    let before_writing = Instant::now();
    if let Some(path) = arguments.result.output.as_deref() {
        let kind = arguments.result.kind();
        file.report.not_kept = file.not_kept_in(kind);
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
fn conclude(arguments: &TransferArguments, file: &TransferredFile<'_>) -> Result<CommandOutcome, CommandError> {
    let is_streamed = arguments.result.output.as_deref().is_some_and(is_standard);
    let words = || transfer_summary(&file.report);
    deliver_beside(is_streamed, &file.report, arguments.result.report.as_deref(), words)?;
    Ok(CommandOutcome::of(file.is_planar()))
}

pub(super) fn run_bake(arguments: &BakeArguments) -> Result<CommandOutcome, CommandError> {
    refuse_two_streams(&arguments.old, &arguments.new)?;
    if is_standard(&arguments.output) {
        let text = "standard output: a picture cannot be written there: name a file with -o";
        return Err(CommandError::Usage(text.to_owned()));
    }
    if !arguments.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        let text = format!("{}: the picture is written as PNG: end the name in .png", arguments.output.display());
        return Err(CommandError::Usage(text));
    }
    let places = OutputPaths::of_bake(arguments);
    places.keep_apart()?;
    places.spare(&arguments.old, "the old mesh")?;
    places.spare(&arguments.new, "the new mesh")?;
    if let Some(picture) = &arguments.picture {
        places.spare(picture, "the picture")?;
    }
    await_report(arguments.report.as_deref());
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let old = read_typed(&arguments.old, arguments.reading)?;
        let new = read_typed(&arguments.new, arguments.reading)?;
        places.spare_materials(&old.source, &arguments.old)?;
        places.spare_materials(&new.source, &arguments.new)?;
        let picture = picture_of(arguments, &old)?;
        let [old_layout, new_layout] = [layout_of(&old)?, layout_of(&new)?];
        let read = start.elapsed().as_secs_f64();
        go_on()?;
        progress.enter("drawing");
        let painted = PaintedSurface { layout: old_layout.surface(), picture: &picture.pixels };
        let control = Control::new(&INTERRUPTED, &|_| {});
        let baked = bake(painted, new_layout.surface(), arguments.options(&picture), control)?;
        let solve = start.elapsed().as_secs_f64() - read;
        progress.enter("writing");
        let before_writing = Instant::now();
        write_atomically(&arguments.output, |out| write_png(&baked.picture, out))?;
        let write = before_writing.elapsed().as_secs_f64();
        let mesh = mesh_as_read(&new, new_layout.mesh.face_count());
        let total = start.elapsed().as_secs_f64();
        let seconds = Seconds { read, solve, write, total, ..Seconds::default() };
        let report = Report { baked: Some(baked.report), seconds, ..Report::of_mesh(mesh) };
        let size = [baked.picture.width, baked.picture.height];
        deliver(&report, arguments.report.as_deref(), || bake_summary(&report, &arguments.output, size))?;
        Ok(CommandOutcome::Fine)
    })
}

/// Report of a mesh that is neither repaired nor flattened, with this number of faces.
pub(super) fn mesh_as_read(model: &Model, faces: usize) -> MeshReport {
    let (vertices, warnings) = (model.source.polygons.positions.len(), model.source.warnings.clone());
    MeshReport { path: model.path_words(), vertices, faces, warnings, ..MeshReport::default() }
}

/// Picture of the old layout: the requested one, or that of the materials.
fn picture_of(arguments: &BakeArguments, old: &Model) -> Result<PictureFile, CommandError> {
    let is_stream = is_standard(&arguments.old);
    let of_materials = || if is_stream { Vec::new() } else { material_pictures(&old.source, &arguments.old) };
    let pictures = arguments.picture.clone().map_or_else(of_materials, |picture| vec![picture]);
    if let [first, others @ ..] = pictures.as_slice()
        && !others.is_empty()
    {
        let name = name_of_input(&arguments.old);
        let count = pictures.len();
        let drawn = first.display();
        warn(format_args!("{name}: its materials show {count} pictures: choose one with --picture; drawn: {drawn}"));
    }
    let Some(path) = pictures.first() else {
        let text = format!("{}: its materials name no picture: add --picture FILE", name_of_input(&arguments.old));
        return Err(CommandError::Usage(text));
    };
    Ok(PictureFile::read_for(&old.source, &arguments.old, path)?)
}

/// Faces of a file that have texture coordinates.
fn layout_of(model: &Model) -> Result<TextureMesh, CommandError> {
    match model.source.partial_texture_mesh() {
        Ok((layout, _)) => Ok(layout),
        Err(error) => Err(CommandError::Transfer { path: model.path_words(), error: error.into() }),
    }
}
