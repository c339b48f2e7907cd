//! Arguments of `transfer`, `bake` and `carry`.

use std::path::PathBuf;

use clap::Args;
use glam::UVec2;

use super::{MeshOutputArguments, ReadingArguments};
use crate::cli::typed::parse_drawn_pixels;
use freebound_io::{BakeOptions, FileForm, PictureFile, Registration, TransferOptions};

/// Arguments of `transfer`.
#[derive(Debug, Args)]
pub struct TransferArguments {
    /// Mesh with the layout to copy: an OBJ, PLY, GLB or glTF file, or standard input with `-`.
    pub layout: PathBuf,
    /// Mesh that gets the layout: an OBJ, PLY, STL, OFF, GLB or glTF file, at the place and size of the other.
    pub mesh: PathBuf,
    /// Move and scale the first mesh into the box of the second before nearest points are sought.
    #[arg(long)]
    pub fit: bool,
    /// Files and their form.
    #[command(flatten)]
    pub result: MeshOutputArguments,
}

impl TransferArguments {
    /// Choices of the copy.
    pub fn options(&self) -> TransferOptions {
        let form = FileForm { kind: self.result.kind(), precision: self.result.precision };
        TransferOptions { registration: Registration::of(self.fit), form }
    }
}

/// Arguments of `bake`.
#[derive(Debug, Args)]
pub struct BakeArguments {
    /// Mesh with the old layout, which the picture belongs to, or standard input with `-`.
    pub old: PathBuf,
    /// Mesh with the new layout, at the place and size of the old one.
    pub new: PathBuf,
    /// Picture of the old layout (PNG, JPEG, or glTF with a picture). Default: the picture of the old mesh's materials.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Write the picture of the new layout to this file (PNG).
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Size of the new picture, in pixels, up to 16384x16384. Default: that of the old picture.
    #[arg(long, value_name = "WxH", value_parser = parse_drawn_pixels)]
    pub size: Option<UVec2>,
    /// Move and scale the old mesh into the box of the new one before nearest points are sought.
    #[arg(long)]
    pub fit: bool,
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
        let pixels = self.size.map_or_else(|| BakeOptions::size_for(&picture.pixels), |size| size.to_array());
        BakeOptions { pixels, margin: self.margin, registration: Registration::of(self.fit) }
    }
}

/// Arguments of `carry`.
#[derive(Debug, Args)]
pub struct CarryArguments {
    /// Mesh that the constraints are for, or standard input with `-`.
    pub old: PathBuf,
    /// Mesh that gets the constraints, at the place and size of the old one.
    pub new: PathBuf,
    /// Constraints of the old mesh: a vertex, u, v, and a weight if it is soft, on each line.
    #[arg(short, long, value_name = "FILE")]
    pub constraints: PathBuf,
    /// Write the constraints for the new mesh to this file, or to standard output with `-`.
    #[arg(short, long, value_name = "FILE|-")]
    pub output: PathBuf,
    /// Move and scale the old mesh into the box of the new one before nearest points are sought.
    #[arg(long)]
    pub fit: bool,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Limits and choices of reading.
    #[command(flatten)]
    pub reading: ReadingArguments,
}
