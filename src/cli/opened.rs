//! The mesh of a run, opened: in its form, with the pins and the picture that are asked for.

use std::path::Path;

use super::Failure;
use super::args::{MeshArguments, SolveArguments};
use super::exit::Remedy;
use super::parts::with_parts;
use super::pins::targets_on;
use super::places::Places;
use super::progress::Progress;
use super::seams::formed;
use super::standard::{Sizes, read_model};
use crate::io::{LayoutError, PictureFile, Targets, TextureError};
use crate::mesh::{DiskMesh, Fault, WeldDistance};
use crate::session::{Model, Surface};

/// What is to be opened.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) input: &'a MeshArguments,
    pub(super) solve: &'a SolveArguments,
    pub(super) picture: Option<&'a Path>,
}

/// What is solved on.
pub(super) struct Opened {
    /// The mesh in its form: a disk, or several charts.
    pub(super) model: Model,
    pub(super) picture: Option<PictureFile>,
    /// By the vertices of the file.
    pub(super) targets: Targets,
}

impl Wanted<'_> {
    /// Opens it.
    ///
    /// # Errors
    ///
    /// A file that cannot be used or that the run would write over, a mesh that is no disk, pins that cannot be.
    pub(super) fn open(self, places: &Places, progress: &Progress) -> Result<Opened, Failure> {
        let Self { input, solve, picture } = self;
        progress.enter("reading");
        let read = read_model(&input.mesh, Sizes::typed(input.large))?;
        let model = with_parts(formed(&read, input)?, input.parts.as_ref())?;
        places.spare_materials(&model.source, &input.mesh)?;
        let picture = picture.map(PictureFile::read).transpose()?;
        disk_of(&model)?;
        let targets = targets_on(&model, &input.mesh, solve)?;
        Ok(Opened { model, picture, targets })
    }
}

/// Why a mesh or chart cannot be started from its file's layout, and what to do.
pub(super) fn failure_of_layout(model: &Model, error: LayoutError) -> Failure {
    let path = model.path_words();
    match error {
        LayoutError::Texture(error @ TextureError::Missing(_)) => Failure::Texture { path, error },
        LayoutError::Texture(error) => Failure::Usage(format!("{path}: {error}: leave out --start uv")),
        LayoutError::Torn { .. } => {
            let remedy =
                "cut the surface along the seams of its texture coordinates with --charts uv, or leave out --start uv";
            Failure::Usage(format!("{path}: {error}: {remedy}"))
        }
    }
}

/// The disk, or everything that keeps the mesh from being one.
pub(super) fn disk_of(model: &Model) -> Result<&DiskMesh, Failure> {
    match &model.surface {
        Surface::Disk(disk) => Ok(disk),
        Surface::Faulty(_, diagnosis) => {
            let distance = model.form.repair.weld_distance().map(WeldDistance::get);
            if let Some(distance) = distance.filter(|_| diagnosis.faults.contains(&Fault::NoFaces)) {
                let text =
                    format!("no face is left after joining vertices within {distance}: choose a smaller distance");
                return Err(Failure::Usage(format!("{}: {text}", model.path_words())));
            }
            let (diagnosis, remedy) = (Box::new(diagnosis.as_ref().clone()), Remedy::of(model));
            Err(Failure::NotADisk { path: model.path_words(), diagnosis, remedy })
        }
    }
}
