//! OBJ file with a picture: the mesh, a material library that names the picture, and the picture, in one folder.

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

/// Beginning of the material libraries written here, which identifies them later.
const HEAD: &str = "# Freebound: the picture of ";

impl PictureFile {
    /// Path of the material library of an OBJ file with a picture, in its folder. It has its name, or another one if
    /// an unrelated file has that name.
    pub fn library_beside(path: &Path) -> PathBuf {
        let stem = stem_of(path);
        let head = head_for(path);
        place_for(path, &[format!("{stem}.mtl"), format!("{stem}-{MATERIAL}.mtl")], |place| {
            is_free(place) || begins_with(place, head.as_bytes())
        })
    }

    /// Path that the copy of the picture will have in the folder of an OBJ file, unless another file appears there in
    /// the meantime. Empty if no copy is needed. Nothing is written.
    ///
    /// # Errors
    ///
    /// The picture's file, if it cannot be read.
    pub fn copies_beside(&self, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        let mut beside = Beside::planning(path);
        put_picture(self, &mut beside)?;
        Ok(beside.planned())
    }

    /// Writes a mesh with texture coordinates, v up, whose only material shows this picture.
    ///
    /// Names in the files are relative and without blanks, which some readers do not accept. A picture in the mesh's
    /// folder is referenced directly; any other is copied byte for byte. A picture without a file is written as a
    /// PNG. Unrelated files are never overwritten. The mesh is written last, so that every file it names exists.
    /// Returns the files written, the mesh first.
    ///
    /// # Errors
    ///
    /// The file that cannot be written, or the picture file that cannot be read.
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

/// Edits that give this material to all faces and drop every other.
fn with_material(mesh: &MeshFile, library: &str) -> Edits {
    let of_material = |statement: &Statement| matches!(statement.keyword(), b"mtllib" | b"usemtl");
    let dropped = mesh.statements.iter().enumerate().filter(|(_, statement)| of_material(statement));
    Edits {
        statements: dropped.map(|(place, _)| (place, Vec::new())).collect(),
        // A library is named before anything else, a material inside the object that uses it.
        first: Some(format!("mtllib {library}").into_bytes()),
        before_faces: Some(format!("usemtl {MATERIAL}").into_bytes()),
    }
}

/// First line of the material library of an OBJ file. A library with another first line belongs to another mesh and
/// may be in use.
fn head_for(path: &Path) -> String {
    format!("{HEAD}{}\n", name_of(path))
}

/// Puts a picture into the mesh's folder, unless it is there already, and returns its name.
fn put_picture(picture: &PictureFile, beside: &mut Beside<'_>) -> Result<String, WriteError> {
    let mesh = beside.mesh;
    let Some(source) = picture.own_file() else {
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
