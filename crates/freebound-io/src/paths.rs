//! Paths of files: identity of files, and relative paths.

use std::borrow::Cow;
use std::fs;
#[cfg(unix)]
use std::fs::File;
#[cfg(unix)]
use std::os::fd::AsFd as _;
use std::path::{Path, PathBuf};

/// True if two paths lead to one file, also by symbolic or hard links. Two missing files are one if they would have
/// one name in one folder.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::metadata(a), fs::metadata(b)) {
        (Ok(of_a), Ok(of_b)) => is_same_entry(&of_a, &of_b) || is_same_whole_path(a, b),
        (Err(_), Err(_)) => whole(a) == whole(b),
        _ => false,
    }
}

/// True if writing to `place` would replace the file `other`. A device such as `/dev/null` is never replaced.
pub fn would_replace(place: &Path, other: &Path) -> bool {
    let is_device = other.exists() && !other.is_file();
    !is_device && is_same_file(place, other)
}

/// True if a path leads to the file that standard input comes from. False if the system does not tell.
#[cfg(unix)]
pub fn is_standard_input(path: &Path) -> bool {
    let input = std::io::stdin().as_fd().try_clone_to_owned().and_then(|input| File::from(input).metadata());
    matches!((input, fs::metadata(path)), (Ok(input), Ok(file)) if input.is_file() && is_same_entry(&input, &file))
}

/// Always false: the system does not tell the file of standard input.
#[cfg(not(unix))]
pub fn is_standard_input(_: &Path) -> bool {
    false
}

/// True if both are one file on the disk, whatever their names.
#[cfg(unix)]
fn is_same_entry(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Always false: the system does not tell the identity of a file.
#[cfg(not(unix))]
fn is_same_entry(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

fn is_same_whole_path(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// Absolute path with links followed as far as the path exists, so that `..` resolves to the true parent folder.
pub(super) fn whole(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if let Ok(found) = fs::canonicalize(&absolute) {
        return without_verbatim(found);
    }
    match (absolute.parent(), absolute.file_name()) {
        (Some(folder), Some(name)) => whole(folder).join(name),
        _ => absolute,
    }
}

/// Absolute path of the folder of a file, with links followed.
pub(super) fn whole_folder_of(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    whole(absolute.parent().unwrap_or(&absolute))
}

/// Relative path from a folder to a file; `None` if they have no folder in common.
pub(super) fn relative(path: &Path, folder: &Path) -> Option<PathBuf> {
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().count() - shared;
    let down = path.components().skip(shared);
    (shared > 0).then(|| std::iter::repeat_n(Path::new("..").components(), up).flatten().chain(down).collect())
}

/// Path as files name it on every system, with slashes between folders; `None` if it is not Unicode.
pub(super) fn named_in_files(path: &Path) -> Option<String> {
    let text = path.to_str()?;
    Some(if cfg!(windows) { slashed(text) } else { text.to_owned() })
}

fn without_verbatim(path: PathBuf) -> PathBuf {
    match path.to_str() {
        Some(text) if cfg!(windows) => plain(text).into_owned().into(),
        _ => path,
    }
}

/// Prefix that Windows puts before a path whose links were followed, and that few programs understand.
const VERBATIM: &str = r"\\?\";

/// Windows path without the [`VERBATIM`] prefix, if it is valid without.
fn plain(path: &str) -> Cow<'_, str> {
    let Some(rest) = path.strip_prefix(VERBATIM) else { return path.into() };
    if let Some(share) = rest.strip_prefix(r"UNC\") {
        return format!(r"\\{share}").into();
    }
    let is_of_drive = matches!(rest.as_bytes(), [drive, b':', b'\\', ..] if drive.is_ascii_alphabetic());
    if is_of_drive { rest.into() } else { path.into() }
}

/// Windows path with slashes between folders. A path that needs the [`VERBATIM`] prefix keeps its backslashes.
fn slashed(path: &str) -> String {
    let path = plain(path);
    if path.starts_with(VERBATIM) { path.into_owned() } else { path.replace('\\', "/") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_windows_are_named_as_other_programs_read_them() {
        for (path, named) in [
            (r"looks\m.mtl", "looks/m.mtl"),
            (r"..\in\looks\m.mtl", "../in/looks/m.mtl"),
            (r"D:\in\m.mtl", "D:/in/m.mtl"),
            (r"\\?\D:\in\m.mtl", "D:/in/m.mtl"),
            (r"\\?\UNC\server\share\m.mtl", "//server/share/m.mtl"),
            (r"\\server\share\m.mtl", "//server/share/m.mtl"),
            (r"\\?\Volume{b75e2c83}\m.mtl", r"\\?\Volume{b75e2c83}\m.mtl"),
        ] {
            assert_eq!(slashed(path), named);
        }
    }

    #[test]
    fn a_path_of_windows_is_plain_wherever_it_can_be() {
        for (path, expected) in [
            (r"\\?\C:\a\b", r"C:\a\b"),
            (r"\\?\UNC\server\share\a", r"\\server\share\a"),
            (r"C:\a", r"C:\a"),
            (r"\\?\Volume{b75e2c83}\a", r"\\?\Volume{b75e2c83}\a"),
            (r"\\?\pipe", r"\\?\pipe"),
        ] {
            assert_eq!(plain(path), expected);
        }
    }
}
