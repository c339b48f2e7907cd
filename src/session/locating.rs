//! Missing files of projects: search in nearby folders.

use std::path::{Path, PathBuf};

use super::{Message, MessagePlace};
use freebound_io::{ProjectSource, find_nearby};

/// Source of a project, with the new path of a file that was moved. A moved file is found by its stamp: in the folders
/// of the project and of the file, in the folders within them, and beside the project's folder.
pub(super) fn located(
    source: ProjectSource,
    project: Option<&Path>,
    place: MessagePlace,
    remarks: &mut Vec<Message>,
) -> ProjectSource {
    let ProjectSource::File { path, stamp: Some(stamp) } = &source else { return source };
    if path.exists() {
        return source;
    }
    let Some(found) = find_nearby(path, stamp, &folders_near(project, path)) else { return source };
    let text = format!("{}: moved, and found as {}", path.display(), found.display());
    remarks.push(Message::note(place, text).with_remedy("save the project to keep the new place"));
    ProjectSource::File { path: found, stamp: Some(stamp.clone()) }
}

/// Folders in which a missing file is searched.
fn folders_near(project: Option<&Path>, missing: &Path) -> Vec<PathBuf> {
    // The folder of a relative path is known only then.
    let project = project.and_then(|project| std::path::absolute(project).ok());
    let folder = project.as_deref().and_then(Path::parent);
    let of_file = missing.ancestors().skip(1).take(2).find(|folder| folder.is_dir());
    let beside = folder.and_then(Path::parent);
    let mut folders: Vec<PathBuf> = Vec::new();
    for folder in [folder, of_file, beside].into_iter().flatten() {
        if !folder.as_os_str().is_empty() && !folders.iter().any(|other| other == folder) {
            folders.push(folder.to_owned());
        }
    }
    folders
}
