//! Arguments of `transfer` and `bake`.

use std::path::PathBuf;

use clap::Args;
use glam::UVec2;

use super::ReadingArguments;
use crate::cli::typed::{choice, parse_drawn_pixels};
use freebound_io::{BakeOptions, OutputKind, PictureFile, Precision};

/// Arguments of `transfer`.
#[derive(Debug, Args)]
pub struct TransferArguments {
    /// Mesh with the layout to copy: an OBJ, PLY, GLB or glTF file, or standard input with `-`.
    pub layout: PathBuf,
    /// Mesh that gets the layout: an OBJ, PLY, STL, OFF, GLB or glTF file, at the place and size of the other.
    pub mesh: PathBuf,
    /// Write the mesh with the layout to this file, or to standard output with `-`.
    ///
    /// Names that end in .ply or .glb give PLY or GLB; all others give OBJ. Input files are never overwritten.
    #[arg(short, long, value_name = "MESH|-")]
    pub output: Option<PathBuf>,
    /// Precision in which texture coordinates are proved and written. Default: 64 bits for OBJ, 32 bits for PLY and GLB.
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

impl TransferArguments {
    /// Kind of the file to write. Default: OBJ.
    pub fn kind(&self) -> OutputKind {
        self.output.as_deref().map_or(OutputKind::Obj, OutputKind::of_mesh)
    }
}

/// Arguments of `bake`.
#[derive(Debug, Args)]
pub struct BakeArguments {
    /// Mesh with the old layout, which the picture belongs to, or standard input with `-`.
    pub old: PathBuf,
    /// Mesh with the new layout, at the place and size of the old one.
    pub new: PathBuf,
    /// Picture of the old layout (PNG or JPEG). Default: the picture of the old mesh's materials.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Write the picture of the new layout to this file (PNG).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Size of the new picture, in pixels. Default: that of the old picture.
    #[arg(long, value_name = "WxH", value_parser = parse_drawn_pixels)]
    pub size: Option<UVec2>,
    /// Margin that continues the colours around the charts, in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = BakeOptions::DEFAULT_MARGIN, value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub margin: u32,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Limits and choices of reading.
    #[command(flatten)]
    pub reading: ReadingArguments,
}

impl BakeArguments {
    /// Size and margin of the new picture.
    pub fn options(&self, picture: &PictureFile) -> BakeOptions {
        let usual = [picture.pixels.width, picture.pixels.height];
        BakeOptions { pixels: self.size.map_or(usual, |size| size.to_array()), margin: self.margin }
    }
}
