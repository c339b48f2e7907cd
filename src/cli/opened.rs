//! Loading of a run's mesh in its preparation, with the requested pins and picture.

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
use super::standard::read_typed;
use freebound_core::mesh::{DiskMesh, Fault, WeldDistance};
use freebound_core::pipeline::{Surface, Targets};
use freebound_io::PictureFile;
use freebound_run::Model;

/// Files to load.
#[derive(Clone, Copy)]
pub(super) struct InputSpec<'a> {
    pub(super) input: &'a MeshArguments,
    pub(super) solve: &'a SolveArguments,
    pub(super) picture: Option<&'a Path>,
}

/// Input of a solve.
pub(super) struct LoadedMesh {
    /// Mesh in its preparation: a disk, or several charts.
    pub(super) model: Model,
    pub(super) picture: Option<PictureFile>,
    /// Targets by the vertices of the file.
    pub(super) targets: Targets,
}

impl InputSpec<'_> {
    /// Loads the files.
    ///
    /// # Errors
    ///
    /// [`CommandError`] if a file cannot be used or an output would overwrite it, if the mesh is not a disk, or if pins
    /// are invalid.
    pub(super) fn open(self, places: &OutputPaths, progress: &ProgressLine) -> Result<LoadedMesh, CommandError> {
        let Self { input, solve, picture } = self;
        let is_layout_of_stream = matches!(&solve.start, Some(StartOf::File(layout)) if is_standard(layout));
        if is_layout_of_stream && is_standard(&input.mesh) {
            let text = "standard input: it cannot be both the mesh and --start: name a file for one of them";
            return Err(CommandError::Usage(text.to_owned()));
        }
        progress.enter("reading");
        let read = read_typed(&input.mesh, input.reading)?;
        let model = with_parts(formed(&read, input, progress)?, input.parts.as_ref())?;
        places.spare_materials(&model.source, &input.mesh)?;
        let picture = picture.map(PictureFile::read).transpose()?;
        disk_of(&model)?;
        let targets = targets_on(&model, &input.mesh, solve, picture.as_ref())?;
        let model = match &solve.start {
            Some(StartOf::File(layout)) => starting_from(model, layout, input)?,
            Some(StartOf::Uv) | None => model,
        };
        Ok(LoadedMesh { model, picture, targets })
    }
}

/// Mesh that starts from the texture coordinates of another file.
fn starting_from(model: Model, path: &Path, input: &MeshArguments) -> Result<Model, CommandError> {
    let layout = read_typed(path, input.reading)?.source;
    let path = name_of_input(path);
    model.with_layout_of(path.clone(), &layout).map_err(|error| CommandError::of_other_layout(path, error))
}

/// Disk of the mesh, or an error with all faults that prevent it from being a disk.
pub(super) fn disk_of(model: &Model) -> Result<&DiskMesh, CommandError> {
    match &model.prepared.surface {
        Surface::Disk(disk) => Ok(disk),
        Surface::Faulty(_, diagnosis) => {
            let distance = model.prepared.form.repair.weld_distance().map(WeldDistance::get);
            if let Some(distance) = distance.filter(|_| diagnosis.faults.contains(&Fault::NoFaces)) {
                let text = format!(
                    "--weld: no face is left if vertices within {distance} are joined: choose a smaller distance"
                );
                return Err(CommandError::Usage(format!("{}: {text}", model.path_words())));
            }
            let (diagnosis, remedy) = (Box::new(diagnosis.as_ref().clone()), Remedy::of(model));
            Err(CommandError::NotADisk { path: model.path_words(), diagnosis, remedy })
        }
    }
}
