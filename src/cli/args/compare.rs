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
    /// The chart whose maps are compared, where the mesh has several, numbered from 0; the one with the most faces without it.
    #[arg(long, value_name = "N")]
    pub chart: Option<usize>,
    /// The methods, with commas between: each by its name, perhaps with weights and the shape of the boundary, for example
    /// `natural,natural/mean-value,convex/uniform@square`. All that go with the pins without it.
    #[arg(long, value_name = "METHOD[/FAMILY][@BOUNDARY],…", value_delimiter = ',', value_parser = Variant::from_str)]
    pub methods: Vec<Variant>,
    /// Pins and settings.
    #[command(flatten)]
    pub solve: SolveArguments,
    /// The picture that u and v are for (PNG or JPEG): its aspect counts.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// The column that the table is sorted by, less first; in the order of the methods without it.
    #[arg(long, value_name = "COLUMN", value_parser = choice::<Column>())]
    pub sort: Option<Column>,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Write the table here (CSV), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub csv: Option<PathBuf>,
    /// Write every step of every method here (CSV), with seconds, energy and stretch by then, or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub steps_csv: Option<PathBuf>,
    /// Draw the embeddings side by side here (PNG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub png: Option<PathBuf>,
    /// The same as a drawing (SVG).
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Glide from each planar map to the next here, between two there and back, every frame proved one-to-one (animated PNG), or to standard output with
    /// `-`. Methods without a planar map are left out.
    #[arg(long, value_name = "FILE|-")]
    pub morph: Option<PathBuf>,
    /// Frames from one map to the next, both included; 49 without it.
    #[arg(long, value_name = "N", requires = "morph", value_parser = clap::value_parser!(u16).range(3..=1000))]
    pub frames: Option<u16>,
    /// What the faces are coloured by in pictures.
    #[arg(long, value_parser = choice::<CellShading>())]
    pub shading: Option<CellShading>,
}

/// What `compare` writes, apart from its report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonFile {
    /// The table.
    Table,
    /// Every step.
    Steps,
    /// The picture.
    Png,
    /// The same as a drawing.
    Svg,
    /// The animated picture of the morph.
    Morph,
}

impl CompareArguments {
    /// The files to write, apart from the report, each with its option.
    pub fn outputs(&self) -> Vec<(ComparisonFile, &'static str, &Path)> {
        let asked = [
            (ComparisonFile::Table, "--csv", &self.csv),
            (ComparisonFile::Steps, "--steps-csv", &self.steps_csv),
            (ComparisonFile::Png, "--png", &self.png),
            (ComparisonFile::Svg, "--svg", &self.svg),
            (ComparisonFile::Morph, "--morph", &self.morph),
        ];
        asked.into_iter().filter_map(|(file, option, path)| Some((file, option, path.as_deref()?))).collect()
    }

    /// The solver's settings, whatever the method: it takes of them what means something to it.
    pub fn settings(&self) -> Settings {
        self.solve.settings(Method::default())
    }
}
