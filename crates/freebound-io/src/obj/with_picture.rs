//! An OBJ file with a picture: the mesh, a material library that names the picture, and the picture, side by side.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::Edits;
use super::beside::{Beside, begins_with, is_free, name_of, place_for, stem_of, without_blanks};
use super::write::write_obj_with;
use crate::mesh_file::{MeshFile, Statement, Texture};
use crate::{PictureFile, WriteError, is_same_file, write_atomically};

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
            is_free(place) || begins_with(place, head.as_bytes())
        })
    }

    /// Where the copy of the picture is to lie beside an OBJ file, if nothing else comes there; nowhere where it needs
    /// none. Nothing is written.
    ///
    /// # Errors
    ///
    /// The picture's file, where it cannot be read.
    pub fn copies_beside(&self, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        let mut beside = Beside::planning(path);
        put_picture(self, &mut beside)?;
        Ok(beside.planned())
    }

    /// Writes a mesh with texture coordinates, v up, whose only material shows this picture.
    ///
    /// Names in the files are relative and without blanks, which not all readers take. A picture that lies in the same
    /// folder already is named where it is; another one is copied byte for byte, and one that came from no file is written
    /// as a PNG. Files of others are never written over. The mesh comes last, so that what it names is there. Returns the
    /// files written, the mesh first.
    ///
    /// # Errors
    ///
    /// The file that cannot be written or, of the picture, read.
    pub(crate) fn write_beside(
        &self,
        path: &Path,
        mesh: &MeshFile,
        texture: &Texture,
    ) -> Result<Vec<PathBuf>, WriteError> {
        let mut beside = Beside::writing(path);
        let picture_name = put_picture(self, &mut beside)?;
        let library = Self::library_beside(path);
        let library_name = name_of(&library);
        write_atomically(&library, |out| {
            out.write_all(head_for(path).as_bytes())?;
            writeln!(out, "newmtl {MATERIAL}")?;
            writeln!(out, "Ka 0 0 0\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1")?;
            writeln!(out, "map_Kd {picture_name}")
        })?;
        let edits = with_material(mesh, &library_name);
        write_atomically(path, |out| write_obj_with(out, mesh, &edits, texture))?;
        Ok([path.to_owned(), library].into_iter().chain(beside.written()).collect())
    }
}

/// What makes this material that of all faces, and the only one.
fn with_material(mesh: &MeshFile, library: &str) -> Edits {
    let of_material = |statement: &Statement| matches!(statement.keyword(), b"mtllib" | b"usemtl");
    let dropped = mesh.statements.iter().enumerate().filter(|(_, statement)| of_material(statement));
    Edits {
        statements: dropped.map(|(place, _)| (place, Vec::new())).collect(),
        // A library is named before anything else, a material within the object that it is on.
        first: Some(format!("mtllib {library}").into_bytes()),
        before_faces: Some(format!("usemtl {MATERIAL}").into_bytes()),
    }
}

/// First line of the material library of an OBJ file. One of another mesh's begins otherwise: it may be in use.
fn head_for(path: &Path) -> String {
    format!("{HEAD}{}\n", name_of(path))
}

/// Puts a picture beside a mesh where it is not there yet, and returns its name.
fn put_picture(picture: &PictureFile, beside: &mut Beside<'_>) -> Result<String, WriteError> {
    let mesh = beside.mesh;
    let Some(source) = &picture.path else {
        let name = format!("{}-{MATERIAL}.png", stem_of(mesh));
        let mut bytes = Vec::new();
        let failed = |source| WriteError::writing(mesh.with_file_name(&name), source);
        crate::raster::write_png(&picture.pixels, &mut bytes).map_err(failed)?;
        return beside.put_under(&[name], &bytes);
    };
    let name = without_blanks(&name_of(source));
    if source.is_file() && is_same_file(source, &mesh.with_file_name(&name)) {
        return Ok(name);
    }
    let bytes = fs::read(source).map_err(|error| WriteError::reading(source, error))?;
    beside.put(&name, &bytes)
}
