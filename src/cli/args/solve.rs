//! What is solved: pins, and settings of the solver.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser as _};

use super::ThreadArguments;
use crate::cli::typed::{choice, parse_aspect, parse_pin};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Growth, Method, Settings, Spacing, Start, Treatment};

/// Why a shape's options mean nothing to other methods.
pub(super) const ONLY_ON_SHAPES: &str = "only convex, stretch and lee lay a boundary on a shape";

/// Pins, and settings of the solver but for the method.
#[derive(Debug, Args)]
pub struct SolveArguments {
    /// What the first step is, where it is not a map of the surface alone: the texture coordinates of the mesh file with `uv`, or
    /// those of another file of the same mesh. Proved as it is, and the method goes on from it.
    #[arg(long, value_name = "uv|FILE", value_parser = OsStringValueParser::new().map(StartOf::from))]
    pub start: Option<StartOf>,
    /// The weights: conformal, mean-value, wachspress, power:P, and for `convex` and `lee` uniform, shape-preserving;
    /// without it mean-value for `lee`, conformal for others.
    #[arg(long, value_parser = Family::from_str)]
    pub family: Option<Family>,
    /// How far apart boundary vertices lie on a convex shape, for `convex`, `stretch` and `lee`: by their lengths, or evenly;
    /// by their lengths without it.
    #[arg(long, value_parser = choice::<Spacing>())]
    pub spacing: Option<Spacing>,
    /// Layers of virtual triangles around the mesh, for `lee`; 2 without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(Settings::MOST_LAYERS)))]
    pub layers: Option<u16>,
    /// Pin a vertex, numbered from 0, at u,v: exactly, or pulled there by a weight. Repeatable.
    #[arg(long = "pin", value_name = "V:U,V[:WEIGHT]", value_parser = parse_pin, allow_hyphen_values = true)]
    pub pins: Vec<(VertexId, Target)>,
    /// Pin vertices as a file says: lines `vertex u v [weight]`, vertices numbered from 0, comments behind a #.
    #[arg(long, value_name = "FILE")]
    pub constraints: Option<PathBuf>,
    /// The picture that u and v are for, width to height: angles are kept on it. 1:1 without it.
    #[arg(long, value_name = "W:H", value_parser = parse_aspect, conflicts_with = "picture")]
    pub aspect: Option<f64>,
    /// What becomes of the pinned vertices' equations. Without it: of two pins eliminated, of more kept, and kept in
    /// the iteration.
    #[arg(long, value_parser = choice::<Treatment>())]
    pub treatment: Option<Treatment>,
    /// The most mean-value iterations, for `auto` and `iterate`, or solves after the first, for `stretch`; 60 without it. For
    /// `slim` its iterations; 20 without it.
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// After a planar end, lower the distortion in at most this many rounds, one-to-one throughout, constraints kept.
    /// Without it `auto` does so until the map serves; a planar layout that `--start` goes on from stays as it is.
    #[arg(long, value_name = "N")]
    pub relax: Option<usize>,
    /// Do not split edges where the constraints cannot be met otherwise, for `auto` and `continuation`: keep the best
    /// planar embedding instead, and name the constraints that are not met.
    #[arg(long)]
    pub no_new_vertices: bool,
    /// How the virtual boundary pins more of the boundary while it crosses itself, for `auto` and `virtual-boundary`.
    #[arg(long, value_parser = choice::<Growth>())]
    pub growth: Option<Growth>,
    /// How many threads do the work.
    #[command(flatten)]
    pub threads: ThreadArguments,
}

/// Where the first step comes from, as it is typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StartOf {
    /// The texture coordinates of the mesh file.
    Uv,
    /// Those of another file.
    File(PathBuf),
}

impl From<OsString> for StartOf {
    fn from(text: OsString) -> Self {
        if text == "uv" { Self::Uv } else { Self::File(text.into()) }
    }
}

impl SolveArguments {
    /// The solver's settings for a method.
    pub fn settings(&self, method: Method) -> Settings {
        Settings {
            treatment: self.treatment,
            spacing: self.spacing.unwrap_or_default(),
            layers: self.layers.map_or(Settings::LAYERS, usize::from),
            max_steps: self.max_steps,
            growth: self.growth.unwrap_or_default(),
            relax_rounds: self.relax,
            new_vertices: !self.no_new_vertices,
            start: if self.start.is_some() { Start::File } else { Start::FromScratch },
            method,
            family: self.family,
            ..Settings::default()
        }
    }

    /// An option that was given but means nothing to any of the methods, and why not to the first.
    pub fn idle_option(&self, methods: &[Method]) -> Option<(&'static str, &'static str)> {
        let [first, others @ ..] = methods else { return None };
        let is_idle = |option: &str, method: &Method| self.idle_options(method).iter().any(|(idle, _)| *idle == option);
        let mut idle = self.idle_options(first).into_iter();
        idle.find(|(option, _)| others.iter().all(|method| is_idle(option, method)))
    }

    /// All options that were given but mean nothing to a method, and why.
    fn idle_options(&self, method: &Method) -> Vec<(&'static str, &'static str)> {
        let splits = *method == Method::Auto;
        let of_family =
            if method.is_one_to_one() { "it solves no weighted equations" } else { "its weights are its own" };
        let treats_pins = method.uses_pins() && !method.only_places_pins();
        let of_treatment = if method.uses_pins() {
            "no equation of its depends on a pin"
        } else {
            "it places the whole boundary by itself"
        };
        let of_splits = match method {
            Method::Matchmaker => "it meets constraints by nothing else",
            _ => "only auto goes on to them",
        };
        let cases = [
            (self.spacing.is_some(), method.boundary_shape().is_some(), "--spacing", ONLY_ON_SHAPES),
            (self.layers.is_some(), method.is_padded(), "--layers", "only lee puts layers around the mesh"),
            (self.family.is_some(), method.uses_family(), "--family", of_family),
            (!self.pins.is_empty(), method.uses_pins(), "--pin", "it places the whole boundary by itself"),
            (self.constraints.is_some(), method.uses_pins(), "--constraints", "it places the whole boundary by itself"),
            (self.treatment.is_some(), treats_pins, "--treatment", of_treatment),
            (self.max_steps.is_some(), method.iterates(), "--max-steps", "it does not iterate"),
            (self.no_new_vertices, splits, "--no-new-vertices", of_splits),
            (
                self.start.is_some(),
                method.continues_from_layout(),
                "--start",
                "it computes its map from the surface alone",
            ),
            (self.growth.is_some(), method.bends_boundary(), "--growth", "only auto and virtual-boundary pin more"),
        ];
        cases
            .into_iter()
            .filter(|(given, applies, ..)| *given && !applies)
            .map(|(_, _, option, why)| (option, why))
            .collect()
    }
}
