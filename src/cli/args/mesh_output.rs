//! Arguments of commands that write a mesh with new texture coordinates.

use std::path::PathBuf;

use clap::Args;

use super::ReadingArguments;
use crate::cli::typed::choice;
use freebound_io::{Materials, OutputKind, Precision};

/// Arguments of commands that write a mesh with new texture coordinates.
#[derive(Debug, Args)]
pub struct MeshOutputArguments {
    /// Write the mesh with its new texture coordinates to this file, or to standard output with `-`.
    ///
    /// Names that end in .ply or .glb give PLY or GLB; all others give OBJ. Input files are never overwritten.
    #[arg(short, long, value_name = "MESH|-")]
    pub output: Option<PathBuf>,
    /// Precision in which texture coordinates are proved and written. Default: 64 bits for OBJ, 32 bits for PLY and GLB.
    ///
    /// PLY files of 32 bits have the form that most programs read: `s` and `t` as float, and a copy of each vertex on a
    /// seam. Those of 64 bits keep the vertices and list the coordinates of corners; a map that 32 bits would fold gets
    /// them by default. GLB files always hold 32 bits.
    #[arg(long, value_parser = choice::<Precision>())]
    pub precision: Option<Precision>,
    /// Copy the mesh's material libraries and their pictures beside the OBJ file.
    ///
    /// Default: the OBJ file refers to them in their present place.
    #[arg(long, requires = "output")]
    pub copy_materials: bool,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Limits and choices of reading.
    #[command(flatten)]
    pub reading: ReadingArguments,
}

impl MeshOutputArguments {
    /// Kind of the mesh file to write. Default: OBJ.
    pub fn kind(&self) -> OutputKind {
        self.output.as_deref().map_or(OutputKind::Obj, OutputKind::of_mesh)
    }

    /// Treatment of the material libraries.
    pub fn materials(&self) -> Materials {
        if self.copy_materials { Materials::Copied } else { Materials::Stay }
    }
}
