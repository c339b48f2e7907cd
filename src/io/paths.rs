//! Paths of files: which of them are one file, and the way from a folder to a file.

use std::fs;
use std::path::{Path, PathBuf};

/// Whether two paths lead to one file, by links of either kind too. Files that are not there are one where they would
/// have one name in one folder.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::metadata(a), fs::metadata(b)) {
        (Ok(of_a), Ok(of_b)) => is_same_entry(&of_a, &of_b) || is_same_whole_path(a, b),
        (Err(_), Err(_)) => whole(a) == whole(b),
        _ => false,
    }
}

/// Whether two files are one on the disk, under whatever names.
#[cfg(unix)]
fn is_same_entry(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// The system does not tell.
#[cfg(not(unix))]
fn is_same_entry(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

fn is_same_whole_path(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// A path from the root, links in its folder followed.
fn whole(path: &Path) -> PathBuf {
    let folder = whole_folder_of(path);
    path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name))
}

/// The folder that a file is in, from the root, links followed: so that `..` in it means what it says.
pub(super) fn whole_folder_of(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = whole.parent().unwrap_or(&whole);
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

/// The way from a folder to a file; `None` where they have no folder in common.
pub(super) fn relative(path: &Path, folder: &Path) -> Option<PathBuf> {
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().count() - shared;
    let down = path.components().skip(shared);
    (shared > 0).then(|| std::iter::repeat_n(Path::new("..").components(), up).flatten().chain(down).collect())
}
