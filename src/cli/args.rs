//! What can be typed. `freebound --help` is made from this.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::DVec2;

use crate::mesh::VertexId;
use crate::solver::{BoundaryShape, Family, Growth, Method, Settings, Treatment};

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
                         4 finished but not planar, 130 interrupted.";

/// The commands that need no screen.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Flatten a mesh; prove the result; write it as texture coordinates.
    #[command(after_help = EXIT_HELP)]
    Flatten(FlattenArguments),
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
    /// The mesh, an OBJ file.
    pub mesh: PathBuf,
    /// Write the mesh with texture coordinates here (OBJ).
    #[arg(short, long, value_name = "OBJ")]
    pub output: Option<PathBuf>,
    /// How to flatten.
    #[arg(long, value_enum, default_value_t = MethodName::Auto)]
    pub method: MethodName,
    /// The shape of the boundary, for `--method convex`; a circle without it.
    #[arg(long, value_enum)]
    pub boundary: Option<BoundaryName>,
    /// The weights: conformal, mean-value, wachspress, power:P, and for `--method convex` uniform, shape-preserving;
    /// conformal without it.
    #[arg(long, value_parser = Family::from_str)]
    pub family: Option<Family>,
    /// Pin a vertex, numbered from 0, at u,v. Repeatable.
    #[arg(long = "pin", value_name = "V:U,V", value_parser = parse_pin, allow_hyphen_values = true)]
    pub pins: Vec<(VertexId, DVec2)>,
    /// What becomes of the pinned vertices' equations. Without it: of two pins eliminated, of more kept, and kept in
    /// the iteration.
    #[arg(long, value_enum)]
    pub treatment: Option<TreatmentName>,
    /// The most mean-value iterations, for `auto` and `iterate`; 60 without it.
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// How the virtual boundary pins more of the boundary while it crosses itself, for `auto` and `virtual-boundary`.
    #[arg(long, value_enum)]
    pub growth: Option<GrowthName>,
    /// Size of an embedding without pins: fit into the unit square, or keep the area of the surface.
    #[arg(long, value_enum, default_value_t = Fit::Unit)]
    pub fit: Fit,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
    /// Draw the layout here (SVG).
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Draw the mesh and the layout side by side here (PNG).
    #[arg(long, value_name = "FILE")]
    pub png: Option<PathBuf>,
    /// Draw every step into this folder (SVG), with a table of their numbers (steps.csv). The steps of an earlier run in
    /// it are replaced.
    #[arg(long, value_name = "DIR")]
    pub steps: Option<PathBuf>,
    /// Threads to use; all cores without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl FlattenArguments {
    /// The solver's settings.
    pub fn settings(&self) -> Settings {
        let method = match self.method {
            MethodName::Auto => Method::Auto,
            MethodName::Natural => Method::Natural,
            MethodName::Iterate => Method::Iterate,
            MethodName::VirtualBoundary => Method::VirtualBoundary,
            MethodName::Convex => Method::Convex(match self.boundary {
                Some(BoundaryName::Square) => BoundaryShape::Square,
                Some(BoundaryName::Circle) | None => BoundaryShape::Circle,
            }),
            MethodName::Lscm => Method::Lscm,
            MethodName::Levy => Method::Levy,
        };
        let treatment = self.treatment.map(|name| match name {
            TreatmentName::Eliminate => Treatment::Eliminate,
            TreatmentName::LeastSquares => Treatment::LeastSquares,
            TreatmentName::Weighted => Treatment::Weighted,
        });
        let growth = match self.growth {
            Some(GrowthName::One) => Growth::One,
            Some(GrowthName::Double) | None => Growth::Double,
        };
        let max_steps = self.max_steps.unwrap_or(Settings::MAX_STEPS);
        Settings { treatment, max_steps, growth, ..Settings::new(method, self.family.unwrap_or_default()) }
    }

    /// An option that was given but means nothing to the method, and why.
    pub fn idle_option(&self) -> Option<(&'static str, &'static str)> {
        let method = self.settings().method;
        let is_convex = matches!(method, Method::Convex(_));
        let cases = [
            (self.boundary.is_some(), is_convex, "--boundary", "only convex lays the boundary on a shape"),
            (self.family.is_some(), method.uses_family(), "--family", "its weights are its own"),
            (!self.pins.is_empty(), method.uses_pins(), "--pin", "it places the whole boundary by itself"),
            (self.treatment.is_some(), method.uses_pins(), "--treatment", "it places the whole boundary by itself"),
            (self.max_steps.is_some(), method.iterates(), "--max-steps", "only auto and iterate do iterate"),
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
    /// The mesh, an OBJ file.
    pub mesh: PathBuf,
    /// Write a report here (JSON), or to standard output with `-`.
    #[arg(long, value_name = "FILE|-")]
    pub report: Option<PathBuf>,
}

/// Names of the methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// The ladder: natural, iterate, virtual-boundary, until planar
    Auto,
    /// Natural boundary (paper §3.3)
    Natural,
    /// Natural boundary, then mean-value iteration (paper §4)
    Iterate,
    /// Natural boundary, then a virtual boundary (paper §5)
    VirtualBoundary,
    /// Boundary on a convex shape (Tutte, Floater)
    Convex,
    /// Least-squares conformal map
    Lscm,
    /// Lévy's equations summed around vertices (paper §3.2)
    Levy,
}

/// Names of the treatments of pinned vertices' equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TreatmentName {
    /// Leave them out (paper §3.3)
    Eliminate,
    /// Keep all, meet them as well as can be (paper §6)
    LeastSquares,
    /// Keep all, and let pins pull by their weights (paper §6)
    Weighted,
}

/// Names of the ways to pin more of the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GrowthName {
    /// Twice as many each time
    Double,
    /// One more each time (paper §5)
    One,
}

/// Names of the convex shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BoundaryName {
    /// A circle
    Circle,
    /// A square
    Square,
}

/// Size of an embedding that the user's pins do not fix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Fit {
    /// Uniformly into the unit square
    Unit,
    /// The area of the surface
    True,
}

fn parse_pin(text: &str) -> Result<(VertexId, DVec2), String> {
    let parsed = || {
        let (vertex, place) = text.split_once(':')?;
        let (u, v) = place.split_once(',')?;
        Some((VertexId::new(vertex.trim().parse().ok()?), DVec2::new(u.trim().parse().ok()?, v.trim().parse().ok()?)))
    };
    parsed().ok_or_else(|| "write VERTEX:U,V, for example 12:0.25,0.75".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_hold_together() {
        use clap::CommandFactory as _;
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_pin_is_a_vertex_and_two_numbers() {
        assert_eq!(parse_pin("7:0.5,-2").unwrap(), (VertexId::new(7), DVec2::new(0.5, -2.0)));
        for wrong in ["", "7", "7:1", "7:1,x", "-1:0,0", "7:1,2,3"] {
            assert!(parse_pin(wrong).is_err(), "{wrong}");
        }
    }
}
