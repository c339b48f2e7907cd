//! Arguments for a cutting pattern.

use std::path::PathBuf;

use clap::Args;

use crate::cli::typed::{choice, parse_millimetres};
use freebound_io::{AllowanceJoins, LengthUnit, PatternOptions, PatternPaper};

/// Arguments for a cutting pattern.
#[derive(Debug, Args)]
pub struct PatternArguments {
    /// Draw a cutting pattern in true size into this file: PDF, SVG or DXF, by the end of its name.
    ///
    /// Each chart is a piece with its cutting line (solid), its sewing line (dashed), its number, and numbered notches that
    /// meet on both sides of a seam. The change of the lengths of edges is printed.
    #[arg(long, value_name = "FILE")]
    pub pattern: Option<PathBuf>,
    /// Unit of the mesh on the pattern. Default: mm.
    #[arg(long, value_parser = choice::<LengthUnit>(), requires = "pattern", hide_short_help = true)]
    pub unit: Option<LengthUnit>,
    /// Seam allowance of the pattern in millimetres; 0 for none. Default: 10.
    #[arg(long, value_name = "MM", value_parser = parse_millimetres, requires = "pattern", hide_short_help = true)]
    pub allowance: Option<f64>,
    /// Shape of the seam allowance at corners. Default: round.
    #[arg(long, value_parser = choice::<AllowanceJoins>(), requires = "pattern", hide_short_help = true)]
    pub joins: Option<AllowanceJoins>,
    /// Distance between notches along the seams of the pattern in millimetres; 0 for none. Default: 50.
    #[arg(long, value_name = "MM", value_parser = parse_millimetres, requires = "pattern", hide_short_help = true)]
    pub notches: Option<f64>,
    /// Pages of a pattern in PDF: one sheet, or overlapping pages after an overview. Default: sheet.
    #[arg(long, value_parser = choice::<PatternPaper>(), requires = "pattern", hide_short_help = true)]
    pub paper: Option<PatternPaper>,
    /// Width of the sheet that the pieces of the pattern are laid on, in millimetres. Default: a sheet nearly square.
    #[arg(long, value_name = "MM", value_parser = parse_millimetres, requires = "pattern", hide_short_help = true)]
    pub sheet_width: Option<f64>,
}

impl PatternArguments {
    /// Options of the pattern.
    pub fn options(&self) -> PatternOptions {
        let usual = PatternOptions::default();
        PatternOptions {
            unit: self.unit.unwrap_or(usual.unit),
            allowance: self.allowance.unwrap_or(usual.allowance),
            joins: self.joins.unwrap_or(usual.joins),
            notches: self.notches.unwrap_or(usual.notches),
            paper: self.paper.unwrap_or(usual.paper),
            sheet_width: self.sheet_width,
        }
    }
}
