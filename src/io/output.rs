//! The files that a finished flattening is written to, by their kind.

use std::path::Path;

use glam::DVec2;

use super::raster::picture_of_result;
use super::report::Report;
use super::svg::write_svg;
use super::{ObjMesh, WriteError, write_atomically, write_obj};
use crate::mesh::DiskMesh;
use crate::solver::Verdict;

/// Kinds of files that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// The mesh with its embedding as texture coordinates.
    Obj,
    /// A drawing of the layout.
    Svg,
    /// Mesh and layout side by side.
    Png,
    /// The report.
    Json,
}

impl OutputKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Obj, Self::Svg, Self::Png, Self::Json];

    /// The kind that a file name's extension asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|kind| kind.extension() == extension)
    }

    /// Extension of the file name.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Json => "json",
        }
    }
}

/// A flattening with everything that files say about it.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// The file's contents as read.
    pub source: &'a ObjMesh,
    /// Its triangles.
    pub mesh: &'a DiskMesh,
    /// One texture coordinate per vertex.
    pub coordinates: &'a [DVec2],
    /// The verdict on these coordinates.
    pub verdict: &'a Verdict,
    /// What the run has to say.
    pub report: &'a Report,
}

impl Output<'_> {
    /// Writes one file: aside first, then renamed, so that it is never half-written.
    ///
    /// # Errors
    ///
    /// Where the file cannot be written; the error names it.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<(), WriteError> {
        write_atomically(path, |out| match kind {
            OutputKind::Obj => write_obj(out, self.source, self.coordinates),
            OutputKind::Svg => write_svg(out, self.mesh, self.coordinates, self.verdict),
            OutputKind::Png => picture_of_result(self.mesh, self.coordinates, self.verdict)
                .write_png(out)
                .map_err(std::io::Error::other),
            OutputKind::Json => {
                serde_json::to_writer_pretty(&mut *out, self.report)?;
                writeln!(out)
            }
        })
    }
}
