//! Search for a file that was moved or renamed, by its stamp.

use std::collections::VecDeque;
use std::fs::{self, DirEntry};
use std::path::{Path, PathBuf};

use crate::FileStamp;

/// Depth of the folders that are searched, below each given folder.
const DEPTH: usize = 3;

/// Greatest number of files and folders that are looked at.
const MOST_ENTRIES: usize = 20_000;

/// Greatest number of bytes that are read.
const MOST_BYTES: u64 = 2 << 30;

/// Finds a missing file by its stamp, in folders and the folders within them.
///
/// Folders that are given first, and folders less deep, come first; in each folder the old name comes first. Hidden
/// folders, links and folders that cannot be read are skipped. Only files of the right length are read. The search ends
/// after 20,000 entries or 2 GiB.
pub fn find_nearby(missing: &Path, stamp: &FileStamp, folders: &[PathBuf]) -> Option<PathBuf> {
    let mut queue: VecDeque<(usize, PathBuf)> = folders.iter().map(|folder| (0, folder.clone())).collect();
    let (mut left, mut bytes) = (MOST_ENTRIES, MOST_BYTES);
    while let Some((depth, folder)) = queue.pop_front() {
        for entry in entries_of(&folder, missing, left) {
            left -= 1;
            let Ok(kind) = entry.file_type() else { continue };
            if kind.is_dir() && depth < DEPTH && !entry.file_name().to_string_lossy().starts_with('.') {
                queue.push_back((depth + 1, entry.path()));
            } else if kind.is_file() && entry.metadata().is_ok_and(|data| data.len() == stamp.bytes) {
                bytes = bytes.checked_sub(stamp.bytes)?;
                if FileStamp::read(&entry.path()).is_ok_and(|found| found == *stamp) {
                    return Some(entry.path());
                }
            }
        }
    }
    None
}

/// Entries of a folder, at most `most`: the name of the missing file first, then by name.
fn entries_of(folder: &Path, missing: &Path, most: usize) -> Vec<DirEntry> {
    let Ok(found) = fs::read_dir(folder) else { return Vec::new() };
    let mut entries: Vec<DirEntry> = found.flatten().take(most).collect();
    entries.sort_by_key(|entry| (missing.file_name() != Some(&*entry.file_name()), entry.file_name()));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Folder with files, and the stamp of the first one.
    fn folder_with(files: &[(&str, &str)]) -> (tempfile::TempDir, FileStamp) {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
            fs::write(path, text).expect("written");
        }
        let stamp = FileStamp::read(&folder.path().join(files[0].0)).expect("read");
        (folder, stamp)
    }

    #[test]
    fn a_renamed_file_is_found_by_its_content() {
        let (folder, stamp) = folder_with(&[("a/b/head.obj", "v 1"), ("a/other.obj", "v 2"), ("long.obj", "v 123")]);
        let found = find_nearby(Path::new("head.obj"), &stamp, &[folder.path().to_owned()]);
        assert_eq!(found, Some(folder.path().join("a/b/head.obj")));
    }

    #[test]
    fn the_nearest_copy_of_a_file_is_found() {
        let (folder, stamp) = folder_with(&[("z/head.obj", "v 1"), ("a/b/head.obj", "v 1")]);
        assert_eq!(
            find_nearby(Path::new("head.obj"), &stamp, &[folder.path().to_owned()]),
            Some(folder.path().join("z/head.obj"))
        );
        let near = [folder.path().join("a"), folder.path().to_owned()];
        assert_eq!(
            find_nearby(Path::new("head.obj"), &stamp, &near),
            Some(folder.path().join("a/b/head.obj")),
            "its folder is given first"
        );
    }

    #[test]
    fn the_old_name_comes_first() {
        let (folder, stamp) = folder_with(&[("z.obj", "v 1"), ("a.obj", "v 1"), ("m.obj", "v 1")]);
        let found = |name: &str| find_nearby(Path::new(name), &stamp, &[folder.path().to_owned()]);
        assert_eq!(found("elsewhere/m.obj"), Some(folder.path().join("m.obj")));
        assert_eq!(found("other.obj"), Some(folder.path().join("a.obj")));
    }

    #[test]
    fn hidden_and_deep_folders_are_not_searched() {
        let (folder, stamp) = folder_with(&[(".trash/head.obj", "v 1"), ("a/b/c/d/head.obj", "v 1")]);
        assert_eq!(find_nearby(Path::new("head.obj"), &stamp, &[folder.path().to_owned()]), None);
        assert_eq!(find_nearby(Path::new("head.obj"), &stamp, &[folder.path().join("missing")]), None);
    }
}
