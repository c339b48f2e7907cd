//! Constraints of a project for another mesh.

use std::path::{Path, PathBuf};

use super::Model;
use super::opened::example_called;
use freebound_core::geom::VAxis;
use freebound_core::problem::{Control, SolveError};
use freebound_io::{
    CarriedConstraints, Constraints, ProjectError, ProjectFile, ProjectSource, ReadError, ReadOptions, Registration,
    carried_constraints,
};

/// Constraints of a project for the open mesh.
pub(super) struct CarriedPins {
    pub(super) carried: CarriedConstraints,
    /// True if the mesh of the project was moved and scaled to this one.
    pub(super) is_moved: bool,
}

/// Reason why the constraints of a project were not carried.
#[derive(Debug, thiserror::Error)]
pub(super) enum CarryError {
    /// The project cannot be read.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// The mesh of the project cannot be read.
    #[error("{}: {source}", path.display())]
    Mesh { path: PathBuf, source: ReadError },
    /// The project belongs to an unknown built-in mesh.
    #[error("the built-in mesh of the project is unknown: \"{0}\"")]
    NoExample(String),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] SolveError),
}

impl CarriedPins {
    /// Carries the constraints of a project to a mesh whose targets have this axis.
    pub(super) fn read(path: &Path, mesh: &Model, v_axis: VAxis, control: Control<'_>) -> Result<Self, CarryError> {
        let mut project = ProjectFile::read(path)?;
        if project.v_axis != v_axis {
            project.pins.targets.values_mut().for_each(|target| target.uv.y = 1.0 - target.uv.y);
        }
        let old = match project.mesh {
            ProjectSource::Example(name) => example_called(&name).ok_or(CarryError::NoExample(name))?.model(),
            ProjectSource::File { path, .. } => {
                Model::read_formless(&path, ReadOptions::default(), &|| control.go_on().is_err())
                    .map_err(|source| CarryError::Mesh { path, source })?
            }
        };
        control.go_on()?;
        let constraints =
            Constraints { targets: project.pins.targets, notes: project.pins.notes, ..Constraints::default() };
        let carry = |registration| carried_constraints(&constraints, &old.source, &mesh.source, registration);
        let carried = carry(Registration::AsTheyAre);
        if !carried.report.is_apart() {
            return Ok(Self { carried, is_moved: false });
        }
        control.go_on()?;
        let fitted = carry(Registration::ByBox);
        let is_moved = !fitted.report.is_apart();
        Ok(Self { carried: if is_moved { fitted } else { carried }, is_moved })
    }
}
