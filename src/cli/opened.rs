//! The mesh of a run, opened: in its form, with the pins and the picture that are asked for.

use std::path::Path;

use super::args::{MeshArguments, SolveArguments, StartOf};
use super::error::CommandError;
use super::error::Remedy;
use super::error::{is_standard, name_of_input};
use super::parts::with_parts;
use super::pins::targets_on;
use super::places::OutputPaths;
use super::progress::ProgressLine;
use super::seams::formed;
use super::standard::{MemoryLimit, read_model};
use crate::session::Model;
use freebound_core::mesh::{DiskMesh, Fault, WeldDistance};
use freebound_core::pipeline::{Surface, Targets};
use freebound_io::{LayoutError, PictureFile, TextureError};

/// What is to be opened.
#[derive(Clone, Copy)]
pub(super) struct InputSpec<'a> {
    pub(super) input: &'a MeshArguments,
    pub(super) solve: &'a SolveArguments,
    pub(super) picture: Option<&'a Path>,
}

/// What is solved on.
pub(super) struct LoadedMesh {
    /// The mesh in its form: a disk, or several charts.
    pub(super) model: Model,
    pub(super) picture: Option<PictureFile>,
    /// By the vertices of the file.
    pub(super) targets: Targets,
}

impl InputSpec<'_> {
    /// Opens it.
    ///
    /// # Errors
    ///
    /// A file that cannot be used or that the run would write over, a mesh that is no disk, pins that cannot be.
    pub(super) fn open(self, places: &OutputPaths, progress: &ProgressLine) -> Result<LoadedMesh, CommandError> {
        let Self { input, solve, picture } = self;
        let is_layout_of_stream = matches!(&solve.start, Some(StartOf::File(layout)) if is_standard(layout));
        if is_layout_of_stream && is_standard(&input.mesh) {
            let text = "standard input: the mesh and --start cannot both come from there: name a file for one of them";
            return Err(CommandError::Usage(text.to_owned()));
        }
        progress.enter("reading");
        let read = read_model(&input.mesh, MemoryLimit::typed(input.large))?;
        let model = with_parts(formed(&read, input)?, input.parts.as_ref())?;
        places.spare_materials(&model.source, &input.mesh)?;
        let picture = picture.map(PictureFile::read).transpose()?;
        disk_of(&model)?;
        let targets = targets_on(&model, &input.mesh, solve)?;
        let model = match &solve.start {
            Some(StartOf::File(layout)) => starting_from(model, layout, input)?,
            Some(StartOf::Uv) | None => model,
        };
        Ok(LoadedMesh { model, picture, targets })
    }
}

/// The mesh with the texture coordinates of another file to start from.
fn starting_from(model: Model, path: &Path, input: &MeshArguments) -> Result<Model, CommandError> {
    let layout = read_model(path, MemoryLimit::typed(input.large))?.source;
    let path = name_of_input(path);
    model.with_layout_of(path.clone(), &layout).map_err(|error| failure_of_other_layout(path, error))
}

/// Why a mesh or chart cannot be started from its layout, and what to do.
pub(super) fn failure_of_layout(model: &Model, error: LayoutError) -> CommandError {
    if let Some(file) = &model.layout_file {
        return failure_of_other_layout(file.path.clone(), error);
    }
    let path = model.path_words();
    match error {
        LayoutError::Texture(error @ TextureError::Missing(_)) => CommandError::Texture { path, error },
        LayoutError::Torn { .. } => {
            let remedy =
                "cut the surface along the seams of its texture coordinates with --charts uv, or leave out --start uv";
            CommandError::Usage(format!("{path}: {error}: {remedy}"))
        }
        LayoutError::Texture(_) | LayoutError::NoVertex { .. } => {
            CommandError::Usage(format!("{path}: {error}: leave out --start uv"))
        }
    }
}

/// The same of the layout of another file.
fn failure_of_other_layout(path: String, error: LayoutError) -> CommandError {
    let remedy = match error {
        LayoutError::Texture(error @ TextureError::Missing(_)) => return CommandError::Texture { path, error },
        LayoutError::Texture(_) => "name a file that has them, or leave out --start",
        LayoutError::Torn { .. } => {
            "flatten this file itself, along the seams of its texture coordinates, with --charts uv --start uv"
        }
        LayoutError::NoVertex { .. } => "name a layout of this very mesh, with the same numbers of vertices",
    };
    CommandError::Usage(format!("{path}: {error}: {remedy}"))
}

/// The disk, or everything that keeps the mesh from being one.
pub(super) fn disk_of(model: &Model) -> Result<&DiskMesh, CommandError> {
    match &model.prepared.surface {
        Surface::Disk(disk) => Ok(disk),
        Surface::Faulty(_, diagnosis) => {
            let distance = model.prepared.form.repair.weld_distance().map(WeldDistance::get);
            if let Some(distance) = distance.filter(|_| diagnosis.faults.contains(&Fault::NoFaces)) {
                let text =
                    format!("no face is left after joining vertices within {distance}: choose a smaller distance");
                return Err(CommandError::Usage(format!("{}: {text}", model.path_words())));
            }
            let (diagnosis, remedy) = (Box::new(diagnosis.as_ref().clone()), Remedy::of(model));
            Err(CommandError::NotADisk { path: model.path_words(), diagnosis, remedy })
        }
    }
}
