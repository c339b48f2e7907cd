//! Why a file did not become a project.

use std::io;
use std::path::PathBuf;

use super::PROJECT_VERSION;

/// Why a file did not become a project.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// The file cannot be read.
    #[error("{}: the project cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The file is something else.
    #[error("{}: this is no Freebound project", path.display())]
    NotAProject {
        /// The file.
        path: PathBuf,
    },
    /// The file has a later format.
    #[error(
        "{}: a newer Freebound wrote this project: its format is {version}, this one reads up to {PROJECT_VERSION}",
        path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its format.
        version: u64,
    },
    /// A field that cannot be.
    #[error("{}: line {line}, {field}: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The field, such as `pins[3].hold`.
        field: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl ProjectError {
    /// What to do about it.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::File { .. } => "check the path and the permissions",
            Self::NotAProject { .. } => "choose a file that Freebound has saved as a project",
            Self::Newer { .. } => "open it with a newer version of Freebound",
            Self::Malformed { .. } => "mend this line in a text editor",
        }
    }
}
