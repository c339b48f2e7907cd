//! Paths of files: which of them are one file, and the way from a folder to a file.

use std::borrow::Cow;
use std::fs;
#[cfg(unix)]
use std::fs::File;
#[cfg(unix)]
use std::os::fd::AsFd as _;
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

/// Whether writing to `place` would replace the file `other`. A device such as `/dev/null` takes any number of files.
pub fn would_replace(place: &Path, other: &Path) -> bool {
    let is_device = other.exists() && !other.is_file();
    !is_device && is_same_file(place, other)
}

/// Whether a path leads to the file that standard input comes from. Where the system does not tell it is another.
#[cfg(unix)]
pub fn is_standard_input(path: &Path) -> bool {
    let input = std::io::stdin().as_fd().try_clone_to_owned().and_then(|input| File::from(input).metadata());
    matches!((input, fs::metadata(path)), (Ok(input), Ok(file)) if input.is_file() && is_same_entry(&input, &file))
}

/// Whether a path leads to the file that standard input comes from. Where the system does not tell it is another.
#[cfg(not(unix))]
pub fn is_standard_input(_: &Path) -> bool {
    false
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

/// A path from the root, links followed as far as it is there: so that `..` in it means what it says.
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

/// The folder that a file is in, from the root, links followed.
pub(super) fn whole_folder_of(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    whole(absolute.parent().unwrap_or(&absolute))
}

/// The way from a folder to a file; `None` where they have no folder in common.
pub(super) fn relative(path: &Path, folder: &Path) -> Option<PathBuf> {
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().count() - shared;
    let down = path.components().skip(shared);
    (shared > 0).then(|| std::iter::repeat_n(Path::new("..").components(), up).flatten().chain(down).collect())
}

/// A path as files name it on every system, folders divided by slashes; none where it is not Unicode.
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

/// What Windows puts before a path whose links were followed, and few programs read.
const VERBATIM: &str = r"\\?\";

/// A path of Windows without the sign that it is meant to the letter, where it can do without.
fn plain(path: &str) -> Cow<'_, str> {
    let Some(rest) = path.strip_prefix(VERBATIM) else { return path.into() };
    if let Some(share) = rest.strip_prefix(r"UNC\") {
        return format!(r"\\{share}").into();
    }
    let is_of_drive = matches!(rest.as_bytes(), [drive, b':', b'\\', ..] if drive.is_ascii_alphabetic());
    if is_of_drive { rest.into() } else { path.into() }
}

/// A path of Windows with folders divided by slashes. One that is meant to the letter must keep its backslashes.
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
