//! Which mesh, and in which form.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::{OsStringValueParser, TypedValueParser as _};
use clap::{Args, ValueEnum};

use crate::cli::typed::{Parts, parse_parts, parse_seam_kind, parse_weld_distance};
use freebound_core::mesh::{HoleTreatment, Preparation, Repairs, WeldDistance};

/// The mesh, and what is made of its faces.
#[derive(Debug, Args)]
pub struct MeshArguments {
    /// The mesh, an OBJ, PLY, STL, OFF, GLB or glTF file; standard input with `-`.
    pub mesh: PathBuf,
    /// What may be repaired before the mesh is flattened: nothing, what changes no visible surface, or all that can be.
    /// Any of them by its name does, too, with commas between: drop-repeated-corners, drop-duplicate-faces, weld-vertices,
    /// split-edges, turn-faces, split-vertices, fill-holes.
    #[arg(long, value_name = "none|safe|all|LIST", default_value_t)]
    pub repair: Repairs,
    /// Join vertices of faces that lie within this distance of each other, in the mesh's units; 0 joins those in one place.
    #[arg(long, value_name = "DISTANCE", value_parser = parse_weld_distance, allow_negative_numbers = true)]
    pub weld: Option<WeldDistance>,
    /// What becomes of holes: filled while the surface is flattened, or cut open where a surface is cut.
    #[arg(long, value_enum, default_value_t)]
    pub holes: Holes,
    /// Whether a surface that is no disk (closed, with handles, with one side only) is cut open until it is one: `none` leaves
    /// it, `auto` cuts along short ways, creases first; a file of edges, lines `a b` of two vertices numbered from 0, is cut along
    /// first, and then as `auto` does what is no disk yet.
    #[arg(long, value_name = "none|auto|FILE", default_value = "none", value_parser = OsStringValueParser::new().map(Cut::from))]
    pub cut: Cut,
    /// Cut along these edges, too: `sharp`, or `sharp=DEGREES`, where faces meet at that angle or more, 60 without a number;
    /// `materials` and `groups`, where faces of two of them meet. Several with commas between them.
    #[arg(long, value_name = "sharp[=DEGREES],materials,groups", value_delimiter = ',', value_parser = parse_seam_kind)]
    pub seams: Vec<SeamKind>,
    /// The parts of the mesh that are flattened, numbered from 0 in the order of their first faces, with commas between; or the
    /// largest alone. The others stay as they are.
    #[arg(long, value_name = "LIST|largest", value_parser = parse_parts)]
    pub parts: Option<Parts>,
    /// What the charts of the mesh are, which are flattened each by itself.
    #[arg(long, value_enum, default_value_t)]
    pub charts: ChartsOf,
    /// Read the mesh even if that may take more than half of the machine's memory.
    #[arg(long)]
    pub large: bool,
}

impl MeshArguments {
    /// What is to be made of the mesh's faces, seams along edges of the mesh aside.
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
}

/// What becomes of holes, as it is typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Holes {
    /// Filled with faces that no file gets, unless --repair is none
    #[default]
    Fill,
    /// Cut to the outside, with --cut auto
    Cut,
}

/// Whether a surface is cut open, as it is typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// No.
    None,
    /// Where it is no disk.
    Auto,
    /// Along the edges of a file, and then where it is no disk.
    Along(PathBuf),
}

impl From<OsString> for Cut {
    fn from(text: OsString) -> Self {
        match text.to_str() {
            Some("none") => Self::None,
            Some("auto") => Self::Auto,
            _ => Self::Along(text.into()),
        }
    }
}

/// Edges to cut along, as they are typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamKind {
    /// Where faces meet at an angle of so many degrees or more.
    Sharp(f64),
    /// Where faces of two materials meet.
    Materials,
    /// Where faces of two groups or objects meet.
    Groups,
}

/// What the charts of a mesh are, as it is typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ChartsOf {
    /// Its parts
    #[default]
    Parts,
    /// The charts of the file's texture coordinates: it is cut along their seams
    Uv,
}
