//! An OBJ file with a picture: the mesh, a material library that names the picture, and the picture, side by side.

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::{ObjMesh, Statement, write_obj};
use crate::io::{PictureFile, WriteError, is_same_file, write_atomically};
use crate::solver::Embedding;

/// Name of the material.
const MATERIAL: &str = "picture";

/// How the material libraries written here begin, by which they are known again.
const HEAD: &str = "# Freebound: the picture of ";

impl PictureFile {
    /// Path of the material library of an OBJ file with a picture: beside it, of the same name, or another where that
    /// file is not ours.
    pub fn library_beside(path: &Path) -> PathBuf {
        let stem = stem_of(path);
        let head = head_for(path);
        place_for(path, &[format!("{stem}.mtl"), format!("{stem}-{MATERIAL}.mtl")], |place| {
            begins_with(place, head.as_bytes())
        })
    }

    /// Writes a mesh with texture coordinates, v up, whose only material shows this picture.
    ///
    /// Names in the files are relative and without blanks, which not all readers take. A picture that lies in the same
    /// folder already is named where it is; another one is copied byte for byte, and one that came from no file is written
    /// as a PNG. Files of others are never written over. The mesh comes last, so that what it names is there.
    ///
    /// # Errors
    ///
    /// The file that cannot be written or, of the picture, read.
    pub(in crate::io) fn write_beside(
        &self,
        path: &Path,
        mesh: &ObjMesh,
        coordinates: &Embedding,
    ) -> Result<(), WriteError> {
        let picture_name = put_picture(path, self)?;
        let library = Self::library_beside(path);
        let library_name = name_of(&library);
        write_atomically(&library, |out| {
            out.write_all(head_for(path).as_bytes())?;
            writeln!(out, "newmtl {MATERIAL}")?;
            writeln!(out, "Ka 0 0 0\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1")?;
            writeln!(out, "map_Kd {picture_name}")
        })?;
        let textured = with_material(mesh, &library_name);
        write_atomically(path, |out| write_obj(out, &textured, coordinates))
    }
}

/// The mesh with this material on all faces, and with no other.
fn with_material(mesh: &ObjMesh, library: &str) -> ObjMesh {
    let statement = |text: String| Statement { before_face: 0, text: text.into_bytes() };
    let of_material = |statement: &&Statement| matches!(statement.keyword(), b"mtllib" | b"usemtl");
    let kept = mesh.statements.iter().filter(|statement| !of_material(statement)).cloned();
    // A library is named before anything else, a material within the object that it is on.
    let (mut statements, mut later): (Vec<_>, Vec<_>) = kept.partition(|statement| statement.before_face == 0);
    statements.insert(0, statement(format!("mtllib {library}")));
    statements.push(statement(format!("usemtl {MATERIAL}")));
    statements.append(&mut later);
    ObjMesh { statements, ..mesh.clone() }
}

/// First line of the material library of an OBJ file. One of another mesh's begins otherwise: it may be in use.
fn head_for(path: &Path) -> String {
    format!("{HEAD}{}\n", name_of(path))
}

/// Puts a picture beside a mesh where it is not there yet, and returns its name.
fn put_picture(mesh: &Path, picture: &PictureFile) -> Result<String, WriteError> {
    let stem = stem_of(mesh);
    let Some(source) = &picture.path else {
        let name = format!("{stem}-{MATERIAL}.png");
        let mut bytes = Vec::new();
        let failed = |source| WriteError { path: mesh.with_file_name(&name), source };
        picture.pixels.write_png(&mut bytes).map_err(failed)?;
        return put(mesh, &[name], &bytes);
    };
    let name = without_blanks(&name_of(source));
    if source.is_file() && is_same_file(source, &mesh.with_file_name(&name)) {
        return Ok(name);
    }
    let bytes = fs::read(source).map_err(|error| WriteError { path: source.to_owned(), source: error })?;
    // Another picture of the same name stays; a second copy is told apart by the mesh's name.
    let second = format!("{stem}-{name}");
    put(mesh, &[name, second], &bytes)
}

/// Writes a file beside a mesh under the first of these names that may be used, and returns that name.
fn put(mesh: &Path, names: &[String], bytes: &[u8]) -> Result<String, WriteError> {
    let place = place_for(mesh, names, |place| holds(place, bytes));
    write_atomically(&place, |out| out.write_all(bytes))?;
    Ok(name_of(&place))
}

/// Where a file that belongs to a mesh may lie without harm to files of others: beside it, under the first of these
/// names that is free or whose file is ours; after the last of them with a number, from 2 on.
fn place_for(mesh: &Path, names: &[String], is_ours: impl Fn(&Path) -> bool) -> PathBuf {
    let last = names.last().map_or("", String::as_str);
    let further = (2_u64..).map(|number| numbered(last, number));
    let mut places = names.iter().cloned().chain(further).map(|name| mesh.with_file_name(name));
    places
        .find(|place| place != mesh && (is_free(place) || is_ours(place)))
        .expect("a folder has fewer files than there are numbers")
}

/// Whether no file is seen there. Where permission to look is missing, writing fails and says so.
fn is_free(place: &Path) -> bool {
    fs::symlink_metadata(place).is_err()
}

/// Whether a file begins so. Something that is no regular file, such as a pipe, is not opened: nothing may ever come.
fn begins_with(place: &Path, head: &[u8]) -> bool {
    if !place.is_file() {
        return false;
    }
    let Ok(file) = fs::File::open(place) else { return false };
    let mut found = Vec::new();
    file.take(head.len() as u64).read_to_end(&mut found).is_ok() && found == head
}

/// Whether a file has exactly these contents. It is only read where its length is the same.
fn holds(place: &Path, bytes: &[u8]) -> bool {
    fs::metadata(place).is_ok_and(|data| data.len() == bytes.len() as u64) && begins_with(place, bytes)
}

/// A file name with a number before its extension.
fn numbered(name: &str, number: u64) -> String {
    match name.rsplit_once('.') {
        Some((stem, extension)) => format!("{stem}-{number}.{extension}"),
        None => format!("{name}-{number}"),
    }
}

/// A mesh's name without its extension, for the names of the files beside it.
fn stem_of(mesh: &Path) -> String {
    without_blanks(&mesh.file_stem().unwrap_or_default().to_string_lossy())
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn without_blanks(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}
