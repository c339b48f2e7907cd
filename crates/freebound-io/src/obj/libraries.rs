//! Material libraries of a mesh that is written into another folder: named from there, or copied along.

use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};

use super::Edits;
use super::beside::Beside;
use super::material::{Library, libraries_of, picture_argument, picture_within};
use crate::mesh_file::MeshFile;
use crate::paths::{named_in_files, relative, whole_folder_of};
use crate::{WriteError, is_same_file};

/// What becomes of material libraries where a mesh is written into another folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Materials {
    /// They stay, and the mesh names them where they are.
    #[default]
    Stay,
    /// They are copied beside the mesh, with the pictures that they name.
    Copied,
}

/// What becomes of the statements of the mesh that was read at `from`, in a file at `to`: material libraries that are
/// there are named from the new place, all else stays as it is.
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

/// As [`relocated`], and the libraries with their pictures are copied beside `to`, under other names where files of
/// others have theirs. What is there already with the same contents is left as it is. Returns the files written as well.
///
/// # Errors
///
/// The file that cannot be read or written.
pub(crate) fn copy_materials(mesh: &MeshFile, from: &Path, to: &Path) -> Result<(Edits, Vec<PathBuf>), WriteError> {
    let mut beside = Beside::writing(to);
    let edits = copy(mesh, from, &mut beside)?;
    Ok((edits, beside.written()))
}

/// Where the copies of the material libraries and their pictures are to lie beside `to`, if nothing else comes there.
/// Nothing is written.
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

/// A line of a library that names a picture, with the name of the copy; none where it names no picture that is there.
fn with_copied_picture(line: &[u8], library: &Path, beside: &mut Beside<'_>) -> Result<Option<String>, WriteError> {
    let Ok(text) = std::str::from_utf8(line) else { return Ok(None) };
    let Some(argument) = picture_argument(text) else { return Ok(None) };
    let Some(found) = picture_within(argument, library.parent().unwrap_or(Path::new(""))) else { return Ok(None) };
    let name = found.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = if is_beside(&found.path, beside.mesh) { name } else { beside.put(&name, &read(&found.path)?)? };
    // The argument is the end of the line, but for blanks.
    let (line, blanks) = text.split_at(text.trim_end().len());
    let before = &line[..line.len() - argument.len() + found.begin];
    Ok(Some(format!("{before}{name}{blanks}")))
}

/// Other names for the libraries that are there; where there is none, the name stays.
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
        // Each on a line of its own, for a name may hold blanks.
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
