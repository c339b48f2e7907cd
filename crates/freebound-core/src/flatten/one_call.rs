//! Single call: a disk in, a proved embedding out, or the reason why there is none.

use super::{Flattener, Options, Step};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, SolveError};

/// Reason why [`flatten`] returns no proved embedding, with the last step.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlattenError {
    /// No step could be taken.
    #[error(transparent)]
    Solve(#[from] SolveError),

    /// The method ended before the embedding was planar.
    #[error("not planar: {}; method auto continues until it is planar", .0.verdict.summary())]
    NotPlanar(Box<Step>),

    /// The embedding is planar, but does not meet all hard pins.
    #[error("planar, but pinned vertices are not on their targets: {}", listed(&.0.unmet()))]
    Unmet(Box<Step>),
}

/// Flattens a disk: takes all steps of a method and returns the last one, proved planar, with its hard pins on their
/// targets to the last bit.
///
/// [`Candidate::mesh`](super::Candidate::mesh) returns the mesh of the embedding. Edges may have been split for the
/// pins, and polygons cut, unless [`new_vertices`](crate::problem::Settings::new_vertices) is false. Use a [`Flattener`]
/// to observe or cancel the steps.
///
/// # Errors
///
/// If pins or settings are invalid, or the method does not end planar with the pins met. With `auto` and without pins,
/// the method always ends planar.
pub fn flatten(mesh: &DiskMesh, options: &Options) -> Result<Step, FlattenError> {
    let mut last = None;
    let mut flattener = Flattener::with_options(options.clone());
    let ending = flattener.finish(mesh, Control::unattended(), |step| last = Some(step));
    match (last, ending) {
        (Some(step), _) if !step.verdict.planar => Err(FlattenError::NotPlanar(Box::new(step))),
        (Some(step), _) if !step.unmet().is_empty() => Err(FlattenError::Unmet(Box::new(step))),
        // A proved step stays valid if a further step that was to improve it failed.
        (Some(step), _) => Ok(step),
        (None, ending) => Err(ending.err().unwrap_or(SolveError::NotPlanar).into()),
    }
}

fn listed(vertices: &[VertexId]) -> String {
    vertices.iter().map(VertexId::to_string).collect::<Vec<_>>().join(", ")
}
