//! Errors of reading a project file.

use std::io;
use std::path::PathBuf;

use super::PROJECT_VERSION;

/// Failure to read a project file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// The file cannot be read.
    #[error("{}: the project cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is not a project.
    #[error("{}: not a Freebound project", path.display())]
    NotAProject {
        /// The file.
        path: PathBuf,
    },
    /// The file has a newer format.
    #[error(
        "{}: project format {version} is too new: formats up to {PROJECT_VERSION} are supported",
        path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Version of its format.
        version: u64,
    },
    /// A field is invalid.
    #[error("{}: line {line}, {field}: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Field, such as `pins[3].hold`.
        field: String,
        /// Fault of the field.
        reason: String,
    },
}

impl ProjectError {
    /// Remedy for the error.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::File { .. } => "check the path and the permissions",
            Self::NotAProject { .. } => "choose a project file that Freebound has saved",
            Self::Newer { .. } => "open it with a newer version of Freebound",
            Self::Malformed { .. } => "correct this line in a text editor",
        }
    }
}
