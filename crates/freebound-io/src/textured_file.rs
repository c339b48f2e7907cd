//! Mesh file with new texture coordinates, ready to be written.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::finite::check_finite;
use super::gltf::{Shading, write_glb_with};
use super::obj::{Materials, copy_materials, relocated, write_obj_with};
use super::ply::write_ply;
use super::{MeshFile, OutputKind, Precision, Texture, WriteError, write_atomically, write_to_standard_output};

/// Mesh file with new texture coordinates, ready to be written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TexturedFile<'a> {
    /// Contents of the file as read.
    pub(crate) source: &'a MeshFile,
    /// File of the mesh; `None` for a stream.
    pub(crate) source_path: Option<&'a Path>,
    /// Treatment of its material libraries.
    pub(crate) materials: Materials,
    /// New texture coordinates.
    pub(crate) texture: &'a Texture,
    /// Precision of the numbers in the file.
    pub(crate) precision: Precision,
}

impl TexturedFile<'_> {
    /// Writes the mesh atomically. Copied material libraries are written first. Returns the files written, `path` first.
    pub(crate) fn write(&self, kind: OutputKind, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        check_finite(&self.texture.coordinates).map_err(|source| WriteError::writing(path, source))?;
        if kind == OutputKind::Obj && self.materials == Materials::Copied {
            let (edits, copies) = copy_materials(self.source, self.source_place(), path)?;
            write_atomically(path, |out| write_obj_with(out, self.source, &edits, self.texture))?;
            return Ok(std::iter::once(path.to_owned()).chain(copies).collect());
        }
        write_atomically(path, |out| self.write_to(kind, path, out))?;
        Ok(vec![path.to_owned()])
    }

    /// Writes the mesh to standard output.
    pub(crate) fn write_to_standard_output(&self, kind: OutputKind) -> Result<(), WriteError> {
        write_to_standard_output(|out| {
            check_finite(&self.texture.coordinates)?;
            self.write_to(kind, self.source_place(), out)
        })
    }

    fn write_to(&self, kind: OutputKind, path: &Path, mut out: &mut impl Write) -> io::Result<()> {
        match kind {
            OutputKind::Ply => write_ply(&mut out, self.source, self.texture, self.precision),
            OutputKind::Glb => {
                let shading = Shading::of_obj(self.source, self.source_path);
                write_glb_with(&mut out, self.source, self.texture, shading.as_ref())
            }
            _ => {
                let edits = relocated(self.source, self.source_place(), path);
                write_obj_with(&mut out, self.source, &edits, self.texture)
            }
        }
    }

    fn source_place(&self) -> &Path {
        self.source_path.unwrap_or(Path::new("-"))
    }
}
