//! An OBJ file with a picture: the mesh, a material library that names the picture, and the picture, side by side.

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::obj::{ObjMesh, Statement};
use super::output::TexturePicture;
use super::{WriteError, write_atomically, write_obj};

/// Name of the material.
const MATERIAL: &str = "picture";

/// First line of the material libraries written here, by which they are known again.
const HEAD: &str = "# Freebound: the picture of ";

/// Writes a mesh with texture coordinates, v up, whose only material shows a picture.
///
/// Names in the files are relative and without blanks, which not all readers take. A picture that lies in the same
/// folder already is named where it is; another one is copied byte for byte, and one that came from no file is written
/// as a PNG. The mesh comes last, so that what it names is there.
///
/// # Errors
///
/// The file that cannot be written or, of the picture, read.
pub(super) fn write_obj_with_picture(
    path: &Path,
    (mesh, coordinates): (&ObjMesh, &[DVec2]),
    picture: &TexturePicture,
) -> Result<(), WriteError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let picture_name = put_picture(folder, path, picture)?;
    let library = library_beside(path);
    let library_name = name_of(&library);
    write_atomically(&library, |out| {
        writeln!(out, "{HEAD}{}", name_of(path))?;
        writeln!(out, "newmtl {MATERIAL}")?;
        writeln!(out, "Ka 0 0 0\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1")?;
        writeln!(out, "map_Kd {picture_name}")
    })?;
    let textured = with_material(mesh, &library_name);
    write_atomically(path, |out| write_obj(out, &textured, coordinates))
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

/// The material library of an OBJ file: beside it, of its name, unless somebody else's has that.
fn library_beside(path: &Path) -> PathBuf {
    let stem = without_blanks(&path.file_stem().unwrap_or_default().to_string_lossy());
    let first = path.with_file_name(format!("{stem}.mtl"));
    if is_ours(&first) { first } else { path.with_file_name(format!("{stem}-{MATERIAL}.mtl")) }
}

/// Whether a material library was written here, or is none yet.
fn is_ours(library: &Path) -> bool {
    let Ok(file) = fs::File::open(library) else { return true };
    let mut head = Vec::new();
    let is_read = file.take(HEAD.len() as u64).read_to_end(&mut head).is_ok();
    is_read && head == HEAD.as_bytes()
}

/// Sees to it that a picture lies in a folder, and returns its name there.
fn put_picture(folder: &Path, mesh: &Path, picture: &TexturePicture) -> Result<String, WriteError> {
    let stem = without_blanks(&mesh.file_stem().unwrap_or_default().to_string_lossy());
    let Some(source) = picture.path else {
        let target = folder.join(format!("{stem}-{MATERIAL}.png"));
        write_atomically(&target, |out| picture.pixels.write_png(out).map_err(io::Error::other))?;
        return Ok(name_of(&target));
    };
    let name = name_of(source);
    let target = folder.join(without_blanks(&name));
    let is_there = |place: &Path| match (fs::canonicalize(source), fs::canonicalize(place)) {
        (Ok(source), Ok(place)) => source == place,
        _ => false,
    };
    if is_there(&target) {
        return Ok(name_of(&target));
    }
    let bytes = fs::read(source).map_err(|error| WriteError { path: source.to_owned(), source: error })?;
    let is_free = |place: &Path| fs::read(place).map_or(true, |present| present == bytes);
    // Another picture of the same name stays; a second copy is told apart by the mesh's name.
    let target = if is_free(&target) { target } else { folder.join(format!("{stem}-{}", without_blanks(&name))) };
    write_atomically(&target, |out| out.write_all(&bytes))?;
    Ok(name_of(&target))
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn without_blanks(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}
