//! The easy call: a disk in, a proved embedding out, or the reason why there is none.

use super::{Flattener, Options, Step};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, SolveError};

/// Why [`flatten`] gives nothing that is proved, with the last step that it took.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlattenError {
    /// No step could be taken.
    #[error(transparent)]
    Solve(#[from] SolveError),

    /// The method came to its end before the embedding was one-to-one.
    #[error("not planar: {}; method auto goes on until it is", .0.verdict.summary())]
    NotPlanar(Box<Step>),

    /// The embedding is one-to-one, but does not meet all exact pins.
    #[error("planar, but pinned vertices are not on their targets: {}", listed(&.0.unmet()))]
    Unmet(Box<Step>),
}

/// Flattens a disk: takes all steps of the method, and gives the last one, proved one-to-one with its exact pins on their
/// targets to the last bit. [`Candidate::mesh`](super::Candidate::mesh) is the mesh that it is of: edges may have been
/// split for the pins, and polygons cut, unless [`Settings::new_vertices`] says no.
///
/// To watch or to stop it, climb a [`Flattener`].
///
/// # Errors
///
/// Pins or settings that cannot be, or a method that does not end planar with the pins met: `auto` without pins always
/// does.
pub fn flatten(mesh: &DiskMesh, options: &Options) -> Result<Step, FlattenError> {
    let mut last = None;
    let mut flattener = Flattener::with_options(options.clone());
    let ending = flattener.finish(mesh, Control::unattended(), |step| last = Some(step));
    match (last, ending) {
        (Some(step), _) if !step.verdict.planar => Err(FlattenError::NotPlanar(Box::new(step))),
        (Some(step), _) if !step.unmet().is_empty() => Err(FlattenError::Unmet(Box::new(step))),
        // What is proved stays so where a further step, to make it better, has failed.
        (Some(step), _) => Ok(step),
        (None, ending) => Err(ending.err().unwrap_or(SolveError::NotPlanar).into()),
    }
}

fn listed(vertices: &[VertexId]) -> String {
    vertices.iter().map(VertexId::to_string).collect::<Vec<_>>().join(", ")
}
