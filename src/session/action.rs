//! Something the user asked for. [`Session::handle`](super::Session::handle) carries it out.

use std::path::PathBuf;

use glam::DVec2;

use super::{SaveRequest, StopConditions};
use crate::examples::Example;
use crate::mesh::VertexId;
use crate::solver::Settings;

/// One request.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Opens a mesh file.
    Open(PathBuf),
    /// Opens a built-in mesh.
    OpenExample(Example),
    /// Forgets the files opened last.
    ClearRecent,
    /// Pins vertices where they lie.
    Fix(Vec<VertexId>),
    /// Moves a pin, as part of a drag. A gauge pin becomes the user's, with all others.
    MovePin {
        /// The pinned vertex.
        vertex: VertexId,
        /// Where it is to go, in the plane of the embedding.
        target: DVec2,
    },
    /// Ends a drag.
    EndGesture,
    /// Gives a drag up: everything is as it was before it.
    GiveUpGesture,
    /// Frees vertices.
    Unpin(Vec<VertexId>),
    /// Frees all vertices.
    UnpinAll,
    /// Chooses method and weights.
    SetSettings(Settings),
    /// Chooses method and weights as part of a drag of a slider.
    SlideSettings(Settings),
    /// Takes back the last edit.
    Undo,
    /// Repeats the last edit taken back.
    Redo,
    /// Solves again.
    Solve,
    /// Takes one further step.
    Step,
    /// Goes on until a stop condition holds or the method has ended.
    Run,
    /// Stops what is going on in the background. The steps that there are stay.
    Cancel,
    /// Puts a step on the screen.
    ShowStep(usize),
    /// Compares the step on the screen with another one, or with none.
    Compare(Option<usize>),
    /// Chooses where a run comes to rest.
    SetStop(StopConditions),
    /// Writes a file.
    Save(SaveRequest),
    /// Says that a name does not tell what kind of file to write.
    RefuseName(PathBuf),
    /// Takes a message off the screen.
    Dismiss(u64),
}
