//! How a command ends: exit status and last words.

use std::process::ExitCode;

use crate::io::{ConstraintsError, PictureError, ReadError, TextureError, WriteError};
use crate::mesh::Diagnosis;
use crate::solver::SolveError;

/// A command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Planar and proved, or nothing to object to.
    Fine,
    /// Finished and written, but not planar, or a constraint is not met.
    FallsShort,
}

/// A command that could not do its work.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The file cannot be read.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// The constraint file cannot be used.
    #[error("{0}")]
    Constraints(#[from] ConstraintsError),
    /// The picture cannot be read.
    #[error("{0}")]
    Picture(#[from] PictureError),
    /// The texture coordinates make no mesh.
    #[error("{0}: give every corner texture coordinates, or none")]
    Texture(#[from] TextureError),
    /// The mesh is not a disk.
    #[error("{path} cannot be flattened as it is\n{diagnosis}")]
    NotADisk {
        /// The file.
        path: String,
        /// Everything that is wrong with it.
        diagnosis: Box<Diagnosis>,
    },
    /// The solver gave no embedding.
    #[error("{0}")]
    Solve(#[from] SolveError),
    /// A result could not be written.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// Asked for something that cannot be.
    #[error("{0}")]
    Usage(String),
}

impl Failure {
    /// The exit status: 1 internal, 2 wrong use, 3 unusable input, 130 interrupted.
    pub fn code(&self) -> u8 {
        match self {
            Self::Read(ReadError::Cancelled) | Self::Solve(SolveError::Cancelled) => 130,
            Self::Read(_)
            | Self::Constraints(_)
            | Self::Picture(_)
            | Self::Texture(_)
            | Self::NotADisk { .. }
            | Self::Solve(SolveError::NotFinite { .. } | SolveError::TargetsTooNear { .. }) => 3,
            Self::Solve(
                SolveError::Singular { .. } | SolveError::ResidualTooLarge { .. } | SolveError::Linear { .. },
            )
            | Self::Write(_) => 1,
            Self::Solve(_) | Self::Usage(_) => 2,
        }
    }
}

/// Prints a failure and turns the outcome into the process's exit status.
pub(super) fn conclude(outcome: Result<Status, Failure>) -> ExitCode {
    match outcome {
        Ok(Status::Fine) => ExitCode::SUCCESS,
        Ok(Status::FallsShort) => ExitCode::from(4),
        Err(failure) => {
            eprintln!("freebound: {failure}");
            ExitCode::from(failure.code())
        }
    }
}
