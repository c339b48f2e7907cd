//! State of the open document: its project, its name, and its saved content.

use std::path::PathBuf;

use super::Document;
use freebound_io::{ProjectSource, ProjectView};

/// State of the open document apart from the edits. Edits are compared with it.
#[derive(Debug, Default)]
pub(super) struct OpenProject {
    /// Number of openings so far.
    pub(super) opening: u64,
    /// Name of a document that is named by neither a project nor a mesh.
    pub(super) name: Option<String>,
    /// Project that the document is saved to.
    pub(super) project: Option<PathBuf>,
    /// Document when it was opened or saved. `None` if it is not saved anywhere.
    pub(super) saved: Option<Document>,
    /// Constraint file that was imported last.
    pub(super) constraints: Option<PathBuf>,
    /// Picture of the project that could not be read. It stays in the project until another picture is set.
    pub(super) missing_picture: Option<ProjectSource>,
    /// View to be saved with the project.
    pub(super) view: ProjectView,
}
