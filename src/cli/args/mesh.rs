//! Arguments for the mesh and its preparation.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr as _;

use clap::builder::{OsStringValueParser, TypedValueParser as _};
use clap::{Args, ValueEnum};

use super::ReadingArguments;
use crate::cli::typed::{parse_distortion, parse_visibility, parse_weld_distance};
use freebound_core::mesh::{HoleTreatment, Preparation, Repairs, WeldDistance};
use freebound_run::{AutomaticCut, PartChoice, SeamKind};

/// The mesh, and what is made of its faces.
#[derive(Debug, Args)]
pub struct MeshArguments {
    /// Mesh to read: an OBJ, PLY, STL, OFF, GLB or glTF file, or standard input with `-`.
    pub mesh: PathBuf,
    /// Repairs that are allowed: none, safe (no visible change), all, or a list.
    ///
    /// A list has names separated by commas: drop-repeated-corners, stack-duplicates, separate-duplicates,
    /// weld-vertices, split-edges, turn-faces, split-vertices, fill-holes. Faces with the vertices of an earlier face
    /// share its place with `safe` and `all`; add `separate-duplicates` for places of their own.
    #[arg(long, value_name = "none|safe|all|LIST", default_value_t)]
    pub repair: Repairs,
    /// Join vertices of faces within this distance of each other, in units of the mesh.
    ///
    /// With 0 only vertices at equal positions are joined.
    #[arg(long, value_name = "DISTANCE", value_parser = parse_weld_distance, allow_negative_numbers = true, hide_short_help = true)]
    pub weld: Option<WeldDistance>,
    /// Treatment of holes.
    #[arg(long, value_enum, default_value_t, hide_short_help = true)]
    pub holes: Holes,
    /// Cut surfaces that are not disks: never, automatically, or along the edges of a file.
    ///
    /// `auto` finds short seams whose map meets the bound of `--distortion`. `shortest` only makes disks: it cuts along
    /// short paths, creases first. A file has lines `a b`, two vertices numbered from 0. Its edges are cut first; then
    /// `auto` cuts the rest if needed.
    #[arg(long, value_name = "none|auto|shortest|FILE", default_value = "none", value_parser = OsStringValueParser::new().map(Cut::from))]
    pub cut: Cut,
    /// Largest mean symmetric Dirichlet energy of each part, for `--cut auto`; 4 is an isometric map.
    ///
    /// Seams become longer until the map meets this bound. Default: 4.1, or none for a disk without
    /// holes.
    #[arg(long, value_name = "ENERGY", value_parser = parse_distortion)]
    pub distortion: Option<f64>,
    /// Costs of edges for `--cut auto`: a file with lines `a b cost`, vertices numbered from 0.
    ///
    /// A seam costs its length times the cost of its edges, from 0.001 to 1000000. Seams avoid edges with a cost of 1000
    /// or more. Default of an edge: 1.
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub cut_weights: Option<PathBuf>,
    /// Most charts, for `--cut auto`. Default: no limit.
    ///
    /// A part whose map would overlap itself is divided into charts. With a limit such charts are joined again, with
    /// more distortion. Parts that are not connected, and regions between other seams, keep one chart each.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), hide_short_help = true)]
    pub max_charts: Option<u32>,
    /// Weight of what a seam shows, for `--cut auto`: a number from 0 to 1. Default: 0.5.
    ///
    /// Seams prefer creases, and places that the rest of their part hides. At 0 only their length counts.
    #[arg(long, value_name = "W", value_parser = parse_visibility, hide_short_help = true)]
    pub seam_visibility: Option<f64>,
    /// Cut along these edges too: sharp edges, borders of materials or groups, splits.
    ///
    /// `sharp` takes edges with an angle of 60 degrees or more between the faces; `sharp=DEGREES` sets the angle.
    /// `splits` takes edges that `--repair all` or `--weld` joins: where another program has split the mesh at its seams.
    /// Separate several kinds by commas.
    #[arg(long, value_name = "sharp[=DEGREES],materials,groups,splits", value_delimiter = ',', value_parser = SeamKind::from_str)]
    pub seams: Vec<SeamKind>,
    /// Parts of the mesh to flatten: numbers separated by commas, or `largest`. Default: all.
    ///
    /// Parts are numbered from 0 in the order of their first faces. Other parts stay unchanged.
    #[arg(long, value_name = "LIST|largest", value_parser = PartChoice::from_str, hide_short_help = true)]
    pub parts: Option<PartChoice>,
    /// Charts of the mesh. Each chart is flattened separately.
    #[arg(long, value_enum, default_value_t, hide_short_help = true)]
    pub charts: ChartsOf,
    /// Limits and choices of reading.
    #[command(flatten)]
    pub reading: ReadingArguments,
}

impl MeshArguments {
    /// Preparation of the mesh, without seams along edges of the mesh.
    pub fn form(&self) -> Preparation {
        let repair = self.repair.welding(self.weld);
        let holes = match self.holes {
            Holes::Fill => HoleTreatment::Fill,
            Holes::Cut => HoleTreatment::Cut,
        };
        let mut form = Preparation { repair, holes, cut: self.cut != Cut::None, ..Preparation::default() };
        form.seams.of_texture = self.charts == ChartsOf::Uv;
        form
    }

    /// Search for automatic seams.
    pub fn automatic_cut(&self) -> AutomaticCut {
        let most_charts = self.max_charts.map(|most| usize::try_from(most).unwrap_or(usize::MAX));
        AutomaticCut { distortion: self.distortion, most_charts, visibility: self.seam_visibility }
    }
}

/// Value of `--holes`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Holes {
    /// Fill holes during flattening, unless --repair is none; no file gets the extra faces
    #[default]
    Fill,
    /// Cut holes open to the outer boundary, with --cut auto
    Cut,
}

/// Value of `--cut`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The surface is not cut.
    None,
    /// The surface is cut along short seams of low distortion if it is not a disk.
    Auto,
    /// The surface is cut along short paths if it is not a disk.
    Shortest,
    /// The surface is cut along the edges of a file, then if it is not a disk.
    Along(PathBuf),
}

impl From<OsString> for Cut {
    fn from(text: OsString) -> Self {
        match text.to_str() {
            Some("none") => Self::None,
            Some("auto") => Self::Auto,
            Some("shortest") => Self::Shortest,
            _ => Self::Along(text.into()),
        }
    }
}

/// Value of `--charts`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ChartsOf {
    /// Parts of the mesh
    #[default]
    Parts,
    /// Charts of the file's texture coordinates; the mesh is cut along their seams
    Uv,
}
