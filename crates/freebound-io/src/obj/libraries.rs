//! Material libraries of a mesh that is written into another folder: referenced from there, or copied.

use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};

use super::Edits;
use super::beside::Beside;
use super::material::{Library, libraries_of, picture_argument, picture_within};
use crate::mesh_file::MeshFile;
use crate::paths::{named_in_files, relative, whole_folder_of};
use crate::{WriteError, is_same_file};

/// Treatment of material libraries if a mesh is written into another folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Materials {
    /// The libraries stay, and the mesh refers to them at their old place.
    #[default]
    Stay,
    /// The libraries are copied into the mesh's folder, with the pictures that they name.
    Copied,
}

/// Edits of the statements of a mesh that was read at `from`, for a file at `to`. Existing material libraries are
/// named relative to the new folder; everything else stays unchanged.
pub(crate) fn relocated(mesh: &MeshFile, from: &Path, to: &Path) -> Edits {
    let (old, new) = (whole_folder_of(from), whole_folder_of(to));
    if old == new {
        return Edits::default();
    }
    let name_from_new = |library: &Library| {
        if library.path == Path::new(&library.name) && library.path.is_absolute() {
            return None;
        }
        let folder = whole_folder_of(&library.path);
        let whole = folder.join(library.path.file_name()?);
        named_in_files(&relative(&whole, &new).unwrap_or(whole))
    };
    let Ok(edits) = with_libraries(mesh, &old, |library| Ok::<_, Infallible>(name_from_new(library)));
    edits
}

/// Copies the libraries and their pictures into the folder of `to`, and returns the edits that refer to the copies,
/// with the files written. If an unrelated file has a name already, the copy gets another name. Existing files with
/// equal contents are reused.
///
/// # Errors
///
/// The file that cannot be read or written.
pub(crate) fn copy_materials(mesh: &MeshFile, from: &Path, to: &Path) -> Result<(Edits, Vec<PathBuf>), WriteError> {
    let mut beside = Beside::writing(to);
    let edits = copy(mesh, from, &mut beside)?;
    Ok((edits, beside.written()))
}

/// Paths of the future copies of the material libraries and their pictures in the folder of `to`. They change if
/// other files appear there in the meantime. Nothing is written.
///
/// # Errors
///
/// The file that cannot be read.
pub fn copies_of_materials(mesh: &MeshFile, from: &Path, to: &Path) -> Result<Vec<PathBuf>, WriteError> {
    let mut beside = Beside::planning(to);
    copy(mesh, from, &mut beside)?;
    Ok(beside.planned())
}

fn copy(mesh: &MeshFile, from: &Path, beside: &mut Beside<'_>) -> Result<Edits, WriteError> {
    with_libraries(mesh, &whole_folder_of(from), |library| {
        let name = library.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if is_beside(&library.path, beside.mesh) {
            return Ok(Some(name));
        }
        let text = read(&library.path)?;
        let mut copy = Vec::with_capacity(text.len());
        for line in text.split_inclusive(|&byte| byte == b'\n') {
            match with_copied_picture(line, &library.path, beside)? {
                Some(changed) => copy.extend_from_slice(changed.as_bytes()),
                None => copy.extend_from_slice(line),
            }
        }
        beside.put(&name, &copy).map(Some)
    })
}

/// Line of a library with the name of the copied picture; `None` if the line names no existing picture.
fn with_copied_picture(line: &[u8], library: &Path, beside: &mut Beside<'_>) -> Result<Option<String>, WriteError> {
    let Ok(text) = std::str::from_utf8(line) else { return Ok(None) };
    let Some(argument) = picture_argument(text) else { return Ok(None) };
    let Some(found) = picture_within(argument, library.parent().unwrap_or(Path::new(""))) else { return Ok(None) };
    let name = found.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = if is_beside(&found.path, beside.mesh) { name } else { beside.put(&name, &read(&found.path)?)? };
    // The argument is the end of the line, except for trailing blanks.
    let (line, blanks) = text.split_at(text.trim_end().len());
    let before = &line[..line.len() - argument.len() + found.begin];
    Ok(Some(format!("{before}{name}{blanks}")))
}

/// New names for the libraries that exist; missing libraries keep their names.
fn with_libraries<E>(
    mesh: &MeshFile,
    folder: &Path,
    mut name_of: impl FnMut(&Library) -> Result<Option<String>, E>,
) -> Result<Edits, E> {
    let mut edits = Edits::default();
    for (place, statement) in mesh.statements.iter().enumerate() {
        let libraries = match statement.keyword() {
            b"mtllib" => libraries_of(statement, folder),
            _ => Vec::new(),
        };
        // Each library gets its own line, because a name may contain blanks.
        let (mut lines, mut is_changed) = (Vec::new(), false);
        for library in libraries {
            let renamed = if library.path.is_file() { name_of(&library)? } else { None };
            is_changed |= renamed.as_ref().is_some_and(|name| *name != library.name);
            lines.push(format!("mtllib {}", renamed.unwrap_or(library.name)).into_bytes());
        }
        if is_changed {
            edits.statements.insert(place, lines);
        }
    }
    Ok(edits)
}

fn is_beside(file: &Path, mesh: &Path) -> bool {
    is_same_file(&whole_folder_of(file), &whole_folder_of(mesh))
}

fn read(path: &Path) -> Result<Vec<u8>, WriteError> {
    fs::read(path).map_err(|source| WriteError::reading(path, source))
}
