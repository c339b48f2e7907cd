//! Arguments of `compare`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;

use super::{MeshArguments, SolveArguments};
use crate::cli::typed::choice;
use crate::view::CellShading;
use freebound_core::problem::{Method, Settings, Variant};
use freebound_io::Column;

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// The mesh.
    #[command(flatten)]
    pub input: MeshArguments,
    /// Chart to compare, numbered from 0. Default: the chart with the most faces.
    #[arg(long, value_name = "N")]
    pub chart: Option<usize>,
    /// Methods to compare, separated by commas. Default: all methods that suit the pins.
    ///
    /// Each method is a name, optionally with weights and a boundary shape. Example:
    /// natural,natural/mean-value,convex/uniform@square.
    #[arg(long, value_name = "METHOD[/FAMILY][@BOUNDARY],…", value_delimiter = ',', value_parser = Variant::from_str)]
    pub methods: Vec<Variant>,
    /// Pins and settings.
    #[command(flatten)]
    pub solve: SolveArguments,
    /// Picture that u and v refer to (PNG, JPEG, or glTF with a picture). Only its aspect ratio is used.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Column to sort the table by, ascending. Default: the order of the methods.
    #[arg(long, value_name = "COLUMN", value_parser = choice::<Column>())]
    pub sort: Option<Column>,
    /// Write a report to this file (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Write the table to this file (CSV), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub csv: Option<PathBuf>,
    /// Write all steps of all methods to this file (CSV), or to standard output with `-`.
    ///
    /// Each row has the seconds, the energy and the stretch up to that step.
    #[arg(long, value_name = "FILE|-")]
    pub steps_csv: Option<PathBuf>,
    /// Draw the maps side by side into this file (PNG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub png: Option<PathBuf>,
    /// Draw the maps side by side into this file (SVG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Draw the maps side by side into this file (PDF), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub pdf: Option<PathBuf>,
    /// Animate a morph through the planar maps (animated PNG); `-` for standard output.
    ///
    /// Every frame is proved one-to-one. Two maps give a loop there and back. Methods without a planar map are left
    /// out.
    #[arg(long, value_name = "FILE|-")]
    pub morph: Option<PathBuf>,
    /// Number of frames from one map to the next, both included. Default: 49.
    #[arg(long, value_name = "N", requires = "morph", value_parser = clap::value_parser!(u16).range(3..=1000))]
    pub frames: Option<u16>,
    /// Colouring of the faces in pictures.
    #[arg(long, value_parser = choice::<CellShading>())]
    pub shading: Option<CellShading>,
}

/// Output file of `compare`, apart from the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonFile {
    /// Table of results (CSV).
    Table,
    /// Table of all steps (CSV).
    Steps,
    /// Embeddings side by side (PNG).
    Png,
    /// Embeddings side by side (SVG).
    Svg,
    /// Embeddings side by side (PDF).
    Pdf,
    /// Morph (animated PNG).
    Morph,
}

impl CompareArguments {
    /// Files to write, apart from the report, each with its option.
    pub fn outputs(&self) -> Vec<(ComparisonFile, &'static str, &Path)> {
        let asked = [
            (ComparisonFile::Table, "--csv", &self.csv),
            (ComparisonFile::Steps, "--steps-csv", &self.steps_csv),
            (ComparisonFile::Png, "--png", &self.png),
            (ComparisonFile::Svg, "--svg", &self.svg),
            (ComparisonFile::Pdf, "--pdf", &self.pdf),
            (ComparisonFile::Morph, "--morph", &self.morph),
        ];
        asked.into_iter().filter_map(|(file, option, path)| Some((file, option, path.as_deref()?))).collect()
    }

    /// Settings for all methods. Each method uses the settings that apply to it.
    pub fn settings(&self) -> Settings {
        self.solve.settings(Method::default())
    }
}
