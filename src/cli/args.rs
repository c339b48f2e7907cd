//! What can be typed. `freebound --help` is made from this.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::builder::{OsStringValueParser, TypedValueParser as _};
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::{DVec2, UVec2};

use super::typed::{
    ChartSize, Parts, choice, parse_aspect, parse_chart_size, parse_parts, parse_pin, parse_pixels, parse_seam_kind,
    parse_weld_distance,
};
use crate::geom::PackingOptions;
use crate::io::{OutputFit, OutputKind, PictureFile, Precision, Target};
use crate::mesh::{Form, HoleTreatment, Repairs, VertexId, WeldDistance};
use crate::session::Arrangement;
use crate::solver::{BoundaryShape, Choice as _, Family, Growth, Method, Settings, Start, Treatment};

/// Flattens 3D triangle meshes into the plane and proves what it made.
#[derive(Debug, Parser)]
#[command(name = "freebound", version, args_conflicts_with_subcommands = true, after_help = EXIT_HELP)]
pub struct Arguments {
    /// A mesh to open in the editor. Without one the built-in example opens.
    pub file: Option<PathBuf>,
    /// What to do without a screen.
    #[command(subcommand)]
    pub command: Option<Command>,
}

const EXIT_HELP: &str = "Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input, \
                         4 not planar, a constraint not met, or no result by this method, 130 interrupted.";

/// The commands that need no screen.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Flatten a mesh; prove the result; write it as texture coordinates.
    #[command(after_help = EXIT_HELP)]
    Flatten(Box<FlattenArguments>),
    /// Diagnose a mesh, and prove its texture coordinates where it has some.
    #[command(after_help = EXIT_HELP)]
    Check(CheckArguments),
    /// List methods and families with their sources.
    Methods,
    /// Compute the paper's figures again, as drawings (SVG), pictures (PNG) and a table (CSV).
    #[command(after_help = EXIT_HELP)]
    Figures(FiguresArguments),
}

/// Arguments of `flatten`.
#[derive(Debug, Args)]
pub struct FlattenArguments {
    /// The mesh, an OBJ, PLY, STL, OFF, GLB or glTF file; standard input with `-`.
    pub mesh: PathBuf,
    /// Write the mesh with texture coordinates here (PLY or GLB where the name ends so, or else OBJ), or to standard output with `-`. The mesh that is read, or
    /// anything else that is, is never written over.
    #[arg(short, long, value_name = "MESH|-")]
    pub output: Option<PathBuf>,
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
    /// What the first step is, where it is not a map of the surface alone: proved as it is, and the method goes on from it.
    #[arg(long, value_enum)]
    pub start: Option<StartOf>,
    /// How to flatten.
    #[arg(long, value_parser = choice::<Method>(), default_value = Method::Auto.name())]
    pub method: Method,
    /// The shape of the boundary, for `--method convex`; a circle without it.
    #[arg(long, value_parser = choice::<BoundaryShape>())]
    pub boundary: Option<BoundaryShape>,
    /// The weights: conformal, mean-value, wachspress, power:P, and for `--method convex` uniform, shape-preserving;
    /// conformal without it.
    #[arg(long, value_parser = Family::from_str)]
    pub family: Option<Family>,
    /// Pin a vertex, numbered from 0, at u,v: exactly, or pulled there by a weight. Repeatable.
    #[arg(long = "pin", value_name = "V:U,V[:WEIGHT]", value_parser = parse_pin, allow_hyphen_values = true)]
    pub pins: Vec<(VertexId, Target)>,
    /// Pin vertices as a file says: lines `vertex u v [weight]`, vertices numbered from 0, comments behind a #.
    #[arg(long, value_name = "FILE")]
    pub constraints: Option<PathBuf>,
    /// The picture that u and v are for, width to height: angles are kept on it. 1:1 without it.
    #[arg(long, value_name = "W:H", value_parser = parse_aspect, conflicts_with = "picture")]
    pub aspect: Option<f64>,
    /// Map this picture (PNG or JPEG) on the mesh: its aspect counts, and it goes beside the OBJ file, with a material.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Copy the mesh's material libraries and the pictures that they name beside the OBJ file. Without it they stay, and
    /// the OBJ file names them where they are.
    #[arg(long, requires = "output", conflicts_with = "picture")]
    pub copy_materials: bool,
    /// What becomes of the pinned vertices' equations. Without it: of two pins eliminated, of more kept, and kept in
    /// the iteration.
    #[arg(long, value_parser = choice::<Treatment>())]
    pub treatment: Option<Treatment>,
    /// The most mean-value iterations, for `auto` and `iterate`; 60 without it.
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// After a planar end, lower the distortion in at most this many rounds, one-to-one throughout, constraints kept.
    /// Without it `auto` does so until the map serves; a planar layout that `--start uv` goes on from stays as it is.
    #[arg(long, value_name = "N")]
    pub relax: Option<usize>,
    /// Do not split edges where the constraints cannot be met otherwise, for `auto` and `continuation`: keep the best
    /// planar embedding instead, and name the constraints that are not met.
    #[arg(long)]
    pub no_new_vertices: bool,
    /// How the virtual boundary pins more of the boundary while it crosses itself, for `auto` and `virtual-boundary`.
    #[arg(long, value_parser = choice::<Growth>())]
    pub growth: Option<Growth>,
    /// Size of an embedding without pins: fit into the unit square, or keep the area of the surface; into the unit square
    /// without it. With `--start uv` the embedding stays as large as it was, and where it was, without it.
    #[arg(long, value_enum)]
    pub fit: Option<OutputFit>,
    /// Size of the picture that several charts are packed into, in pixels; without it that of `--picture`, or 1024x1024.
    #[arg(long, value_name = "WxH", value_parser = parse_pixels, conflicts_with_all = ["aspect", "picture"])]
    pub pack: Option<UVec2>,
    /// The least distance between packed charts, in pixels of that picture; 4 without it.
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub gap: Option<u32>,
    /// How many times as large as the others charts are packed: numbers of charts, as the report counts them from 0, each with
    /// its size, for example `0=2,3=0.5`.
    #[arg(long, value_name = "CHART=SIZE,…", value_delimiter = ',', value_parser = parse_chart_size)]
    pub chart_size: Vec<ChartSize>,
    /// How many bits the numbers of texture coordinates have, as they are proved and written. GLB files always hold 32.
    #[arg(long, value_enum, default_value_t)]
    pub precision: Precision,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Draw the layout here (SVG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub svg: Option<PathBuf>,
    /// Size of the drawing: the unit square (the picture, where there is one) is the page, or lengths are as on the
    /// surface, a unit of the drawing for a unit of the mesh. As `--fit` without it.
    #[arg(long, value_enum, requires = "svg")]
    pub svg_scale: Option<OutputFit>,
    /// Draw the mesh and the layout side by side here (PNG), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub png: Option<PathBuf>,
    /// Draw every step into this folder (SVG), with a table of their numbers (steps.csv). The steps of an earlier run in
    /// it are replaced.
    #[arg(long, value_name = "DIR")]
    pub steps: Option<PathBuf>,
    /// Read the mesh even if that may take more than half of the machine's memory.
    #[arg(long)]
    pub large: bool,
    /// Threads to use; all cores without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
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

/// Where the first step comes from, as it is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StartOf {
    /// The texture coordinates of the mesh file
    Uv,
}

impl FlattenArguments {
    /// What is to be made of the mesh's faces, seams along edges of the mesh aside.
    pub fn form(&self) -> Form {
        let repair = self.repair.welding(self.weld);
        let holes = match self.holes {
            Holes::Fill => HoleTreatment::Fill,
            Holes::Cut => HoleTreatment::Cut,
        };
        let mut form = Form { repair, holes, cut: self.cut != Cut::None, ..Form::default() };
        form.seams.of_texture = self.charts == ChartsOf::Uv;
        form
    }

    /// How several charts are packed, into this picture where there is one.
    pub fn packing(&self, picture: Option<&PictureFile>) -> PackingOptions {
        let options = PackingOptions::default();
        let options = PackingOptions { gap: self.gap.unwrap_or(options.gap), ..options };
        let of_picture = picture.map(|picture| UVec2::new(picture.pixels.width, picture.pixels.height));
        let of_aspect = self
            .aspect
            .map(|aspect| UVec2::from_array(options.picture).as_dvec2() * DVec2::new(aspect, 1.0) / aspect.max(1.0));
        let of_aspect = of_aspect.map(|size| size.round().max(DVec2::ONE).as_u64vec2().as_uvec2());
        let picture = self.pack.or(of_picture).or(of_aspect).map_or(options.picture, |size| size.to_array());
        PackingOptions { picture, ..options }
    }

    /// Where charts go: they stay where the file has them, where nothing else is asked for.
    pub fn arrangement(&self) -> Arrangement {
        let is_packed = self.pack.is_some() || self.gap.is_some();
        if self.start.is_some() && !is_packed { Arrangement::AsGiven } else { Arrangement::Packed }
    }

    /// The files to write, apart from the report.
    pub fn outputs(&self) -> Vec<(OutputKind, &Path)> {
        // The mesh comes last, so that what it names is there.
        let mesh = self.output.as_deref().map_or(OutputKind::Obj, OutputKind::of_mesh);
        let paths = [(OutputKind::Svg, &self.svg), (OutputKind::Png, &self.png), (mesh, &self.output)].into_iter();
        paths.filter_map(|(kind, path)| Some((kind, path.as_deref()?))).collect()
    }

    /// The solver's settings.
    pub fn settings(&self) -> Settings {
        let method = match (self.method, self.boundary) {
            (Method::Convex(_), Some(shape)) => Method::Convex(shape),
            (method, _) => method,
        };
        Settings {
            treatment: self.treatment,
            max_steps: self.max_steps.unwrap_or(Settings::MAX_STEPS),
            growth: self.growth.unwrap_or_default(),
            relax_rounds: self.relax,
            new_vertices: !self.no_new_vertices,
            start: if self.start.is_some() { Start::File } else { Start::Afresh },
            ..Settings::new(method, self.family.unwrap_or_default())
        }
    }

    /// An option that was given but means nothing to the method, and why.
    pub fn idle_option(&self) -> Option<(&'static str, &'static str)> {
        let method = self.settings().method;
        let is_convex = matches!(method, Method::Convex(_));
        let splits = method == Method::Auto;
        let of_family =
            if method.is_one_to_one() { "it solves no weighted equations" } else { "its weights are its own" };
        let of_splits = match method {
            Method::Matchmaker => "it meets constraints by nothing else",
            _ => "only auto goes on to them",
        };
        let cases = [
            (self.boundary.is_some(), is_convex, "--boundary", "only convex lays the boundary on a shape"),
            (self.family.is_some(), method.uses_family(), "--family", of_family),
            (!self.pins.is_empty(), method.uses_pins(), "--pin", "it places the whole boundary by itself"),
            (self.constraints.is_some(), method.uses_pins(), "--constraints", "it places the whole boundary by itself"),
            (self.treatment.is_some(), method.uses_pins(), "--treatment", "it places the whole boundary by itself"),
            (self.max_steps.is_some(), method.iterates(), "--max-steps", "only auto and iterate do iterate"),
            (self.no_new_vertices, splits, "--no-new-vertices", of_splits),
            (
                self.start.is_some(),
                method.goes_on_from_layout(),
                "--start",
                "it computes its map from the surface alone",
            ),
            (self.growth.is_some(), method.bends_boundary(), "--growth", "only auto and virtual-boundary pin more"),
        ];
        cases.into_iter().find(|(given, applies, ..)| *given && !applies).map(|(_, _, option, why)| (option, why))
    }
}

/// Arguments of `figures`.
#[derive(Debug, Args)]
pub struct FiguresArguments {
    /// The folder to write into; made where it is missing.
    pub folder: PathBuf,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The mesh, an OBJ, PLY, STL, OFF, GLB or glTF file; standard input with `-`.
    pub mesh: PathBuf,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Read the mesh even if that may take more than half of the machine's memory.
    #[arg(long)]
    pub large: bool,
}
