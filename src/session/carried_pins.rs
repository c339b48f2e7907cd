//! Constraints of a project for another mesh.

use std::path::Path;

use super::locating::located;
use super::opened::{OpenError, project_mesh};
use super::{MessagePlace, Model};
use freebound_core::geom::VAxis;
use freebound_core::mesh::PolygonMesh;
use freebound_core::problem::{Control, SolveError};
use freebound_io::{CarriedConstraints, CarryReport, Constraints, ProjectFile, Registration, carried_constraints};

/// Constraints of a project for the open mesh.
pub(super) struct CarriedPins {
    pub(super) carried: CarriedConstraints,
    /// True if the mesh of the project was moved and scaled to this one.
    pub(super) is_moved: bool,
    /// Side of the picture with v = 0, in the project.
    pub(super) v_axis: VAxis,
}

/// Reason why the constraints of a project were not carried.
#[derive(Debug, thiserror::Error)]
pub(super) enum CarryError {
    /// The project or its mesh cannot be read.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The mesh of the project has changed, so that its pins may be on other vertices.
    #[error("the mesh of the project has changed since the project was saved")]
    Changed,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] SolveError),
}

impl CarryError {
    /// Action that the message suggests.
    pub(super) fn remedy(&self) -> &'static str {
        match self {
            Self::Open(OpenError::NoMesh { .. }) => "restore the mesh beside the project, then import again",
            Self::Open(error) => error.remedy(),
            Self::Changed => "restore the mesh that the project was saved with, then import again",
            Self::Cancelled(_) => "import again",
        }
    }
}

impl CarriedPins {
    /// Carries the constraints of a project to a mesh. At most half of `memory`, bytes, may be used.
    pub(super) fn read(
        path: &Path,
        mesh: &Model,
        memory: Option<u64>,
        control: Control<'_>,
    ) -> Result<Self, CarryError> {
        let project = ProjectFile::read(path).map_err(OpenError::from)?;
        let source = located(project.mesh.clone(), Some(path), MessagePlace::Mesh, &mut Vec::new());
        control.go_on()?;
        let (old, change) = project_mesh(&source, project.form(), memory)?;
        if change.is_some() {
            return Err(CarryError::Changed);
        }
        control.go_on()?;
        let v_axis = project.v_axis;
        let constraints =
            Constraints { targets: project.pins.targets, notes: project.pins.notes, ..Constraints::default() };
        let [old, new] = [&old, mesh].map(whole);
        let carry = |registration| carried_constraints(&constraints, old, new, registration);
        let carried = carry(Registration::AsTheyAre);
        if !carried.report.is_apart() {
            return Ok(Self { carried, is_moved: false, v_axis });
        }
        control.go_on()?;
        let fitted = carry(Registration::ByBox);
        let is_moved = misfit(&fitted.report) < misfit(&carried.report);
        Ok(Self { carried: if is_moved { fitted } else { carried }, is_moved, v_axis })
    }
}

/// Faces of the whole mesh, repaired and cut: pins have the numbers of its vertices.
fn whole(model: &Model) -> &PolygonMesh {
    model.whole_repaired().map_or(&model.source.polygons, |repaired| repaired.polygons())
}

/// Number of lost constraints, and the distance of the surfaces in millionths of the diagonal.
fn misfit(report: &CarryReport) -> (usize, u64) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share, at most a large number")]
    let gap = (1e4 * report.percent(report.largest_gap.unwrap_or(0.0))) as u64;
    (report.lost().len(), gap)
}
