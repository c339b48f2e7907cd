//! Arguments of `check`.

use std::path::PathBuf;

use clap::Args;
use glam::{DVec2, UVec2};

use super::ReadingArguments;
use crate::cli::typed::{parse_code, parse_denied, parse_pixels};
use freebound_core::verify::{FindingCode, FindingSeverity, LayoutOptions, PixelGap};

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Mesh to read: an OBJ, PLY, STL, OFF, GLB or glTF file, or standard input with `-`.
    pub mesh: PathBuf,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Accept charts and faces that cover exactly one region, as `--stack` lays them out.
    ///
    /// Charts with equal boundaries, bit for bit, count as one when charts are tested for overlaps, as do faces with
    /// equal corners. Mirror images are accepted, too.
    #[arg(long)]
    pub stacked: bool,
    /// Test faces of different materials for overlaps, too.
    ///
    /// By default a material has a picture of its own, and its faces overlap no face of another material.
    #[arg(long)]
    pub across_materials: bool,
    /// Smallest distance of two charts, in pixels of a picture of `--size`. Default: not tested.
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub gap: Option<u32>,
    /// Size of the picture that fills the unit square, in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_pixels, default_value = "1024x1024", requires = "gap")]
    pub size: UVec2,
    /// Findings to leave out, by their codes. They do not affect the exit status.
    ///
    /// Errors: not-finite, flipped, degenerate, concave-polygon, overlap, overlap-of-charts, overlap-mirrored, stacked.
    /// Warnings: no-coordinates, no-place, duplicate, outside, far-away, scale, gap. Notes: mirrored, turned, tiles. Separate codes
    /// by commas.
    #[arg(long, value_name = "CODES", value_delimiter = ',', value_parser = parse_code)]
    pub ignore: Vec<FindingCode>,
    /// Findings that count as errors, by their codes, or all `warnings`.
    #[arg(long, value_name = "CODES|warnings", value_delimiter = ',', value_parser = parse_denied)]
    pub deny: Vec<Denied>,
    /// Limits and choices of reading.
    #[command(flatten)]
    pub reading: ReadingArguments,
}

/// Findings that count as errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Denied {
    /// Findings with one code.
    Code(FindingCode),
    /// All warnings.
    Warnings,
}

impl CheckArguments {
    /// Tests of the layout.
    pub fn options(&self) -> LayoutOptions {
        let picture = DVec2::new(f64::from(self.size.x), f64::from(self.size.y));
        let gap = self.gap.map(|gap| PixelGap { least: f64::from(gap), picture });
        LayoutOptions { accepts_stacks: self.stacked, gap, ..LayoutOptions::default() }
    }

    /// Codes of all findings that count as errors.
    pub fn denied_codes(&self) -> Vec<FindingCode> {
        let is_denied = |code: &FindingCode| {
            let is_of_all = code.severity() == FindingSeverity::Warning && self.deny.contains(&Denied::Warnings);
            is_of_all || self.deny.contains(&Denied::Code(*code))
        };
        FindingCode::ALL.into_iter().filter(is_denied).collect()
    }
}
