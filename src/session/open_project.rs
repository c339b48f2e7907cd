//! State of what is open: its project, its name, and the document as it was saved.

use std::path::PathBuf;

use super::Document;
use freebound_io::{ProjectSource, ProjectView};

/// State of what is open, apart from what is edited: what an edit is compared with.
#[derive(Debug, Default)]
pub(super) struct OpenProject {
    /// Counts what was opened.
    pub(super) opening: u64,
    /// Name of work that no project and no mesh names.
    pub(super) name: Option<String>,
    /// The project that it is saved to.
    pub(super) project: Option<PathBuf>,
    /// The document as it was opened or saved; none where it is nowhere but here.
    pub(super) saved: Option<Document>,
    /// The file of constraints that was imported last.
    pub(super) constraints: Option<PathBuf>,
    /// The project's picture, where it could not be read: it stays in the project until there is another.
    pub(super) missing_picture: Option<ProjectSource>,
    /// View to be saved with it.
    pub(super) view: ProjectView,
}
