//! Arguments for pins and settings of the solver.

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
use freebound_run::MethodOption;

/// Pins, and settings of the solver but for the method.
#[derive(Debug, Args)]
pub struct SolveArguments {
    /// Start from texture coordinates of the mesh file (`uv`) or of another file of the mesh.
    ///
    /// The layout becomes the first step. The method proves it unchanged and continues from it. Default: the method
    /// computes its first map from the surface alone.
    #[arg(long, value_name = "uv|FILE", value_parser = OsStringValueParser::new().map(StartOf::from))]
    pub start: Option<StartOf>,
    /// Weights: conformal, mean-value, wachspress or power:P.
    ///
    /// The methods `convex` and `lee` also support uniform and shape-preserving weights. Default: mean-value for
    /// `lee`, conformal for all others.
    #[arg(long, value_parser = Family::from_str, hide_short_help = true)]
    pub family: Option<Family>,
    /// Spacing of boundary vertices on the shape of `convex`, `stretch` and `lee`.
    ///
    /// Default: chord.
    #[arg(long, value_parser = choice::<Spacing>(), hide_short_help = true)]
    pub spacing: Option<Spacing>,
    /// Layers of virtual triangles around the mesh, for `lee`. Default: 2.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(Settings::MOST_LAYERS)), hide_short_help = true)]
    pub layers: Option<u16>,
    /// Pin a vertex, numbered from 0, to u,v. A weight makes the pin soft. Repeatable.
    #[arg(long = "pin", value_name = "V:U,V[:WEIGHT]", value_parser = parse_pin, allow_hyphen_values = true)]
    pub pins: Vec<(VertexId, Target)>,
    /// Pin the vertices in a file with lines `vertex u v [weight]`.
    ///
    /// Vertices are numbered from 0. A # starts a comment. A weight makes the pin soft.
    #[arg(long, value_name = "FILE")]
    pub constraints: Option<PathBuf>,
    /// Move the constraints to the landmarks of their names in this file (.pts), in pixels of the picture.
    ///
    /// Constraints whose names have no landmark stay where they are.
    #[arg(long, value_name = "FILE", requires = "constraints", hide_short_help = true)]
    pub landmarks: Option<PathBuf>,
    /// Aspect ratio of the picture that u and v refer to, width to height. Default: 1:1.
    ///
    /// Angles are preserved on the picture.
    #[arg(long, value_name = "W:H", value_parser = parse_aspect, conflicts_with = "picture", hide_short_help = true)]
    pub aspect: Option<f64>,
    /// Treatment of the equations of pinned vertices.
    ///
    /// Default: eliminate them for two pins; keep them (least squares) for more pins and in the iteration.
    #[arg(long, value_parser = choice::<Treatment>(), hide_short_help = true)]
    pub treatment: Option<Treatment>,
    /// Maximum number of iterations, for `auto`, `iterate`, `stretch` and `slim`.
    ///
    /// The limit counts mean-value iterations for `auto` and `iterate`, and solves after the first for `stretch`.
    /// Default: 60, or 20 for `slim`.
    #[arg(long, value_name = "N", hide_short_help = true)]
    pub max_steps: Option<usize>,
    /// Maximum number of rounds that lower the distortion of a planar map.
    ///
    /// Each round keeps the map one-to-one and the constraints met. Default: `auto` relaxes until the map is planar in
    /// 32 bits and its energy is moderate; a planar layout of `--start` is not relaxed.
    #[arg(long, value_name = "N")]
    pub relax: Option<usize>,
    /// Never split edges to satisfy constraints, for `auto`.
    ///
    /// The result is the best planar map. The summary lists the constraints that are not met.
    #[arg(long, hide_short_help = true)]
    pub no_new_vertices: bool,
    /// Growth of the pinned boundary, for `auto` and `virtual-boundary`.
    ///
    /// The virtual boundary pins more boundary vertices while the boundary crosses itself. Default: double.
    #[arg(long, value_parser = choice::<Growth>(), hide_short_help = true)]
    pub growth: Option<Growth>,
    /// Number of threads.
    #[command(flatten)]
    pub threads: ThreadArguments,
}

/// Value of `--start`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StartOf {
    /// Texture coordinates of the mesh file.
    Uv,
    /// Texture coordinates of another file.
    File(PathBuf),
}

impl From<OsString> for StartOf {
    fn from(text: OsString) -> Self {
        if text == "uv" { Self::Uv } else { Self::File(text.into()) }
    }
}

impl SolveArguments {
    /// Settings of the solver for a method.
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

    /// First given option that applies to none of the methods, with the reason for the first method.
    pub fn idle_option(&self, methods: &[Method]) -> Option<(&'static str, &'static str)> {
        let [first, others @ ..] = methods else { return None };
        let is_idle = |option: &str, method: &Method| self.idle_options(method).iter().any(|(idle, _)| *idle == option);
        let mut idle = self.idle_options(first).into_iter();
        idle.find(|(option, _)| others.iter().all(|method| is_idle(option, method)))
    }

    /// All given options that do not apply to a method, with the reasons.
    fn idle_options(&self, method: &Method) -> Vec<(&'static str, &'static str)> {
        let cases = [
            (self.spacing.is_some(), MethodOption::Spacing, "--spacing"),
            (self.layers.is_some(), MethodOption::Layers, "--layers"),
            (self.family.is_some(), MethodOption::Family, "--family"),
            (!self.pins.is_empty(), MethodOption::Pins, "--pin"),
            (self.constraints.is_some(), MethodOption::Pins, "--constraints"),
            (self.treatment.is_some(), MethodOption::Treatment, "--treatment"),
            (self.max_steps.is_some(), MethodOption::MaxSteps, "--max-steps"),
            (self.no_new_vertices, MethodOption::NewVertices, "--no-new-vertices"),
            (self.start.is_some(), MethodOption::Start, "--start"),
            (self.growth.is_some(), MethodOption::Growth, "--growth"),
        ];
        let given = cases.into_iter().filter(|(given, ..)| *given);
        given.filter_map(|(_, option, name)| Some((name, option.unused_by(method)?))).collect()
    }
}
