//! What can be typed. `freebound --help` is made from this.
//!
//! | file      | what it holds                                          |
//! |-----------|--------------------------------------------------------|
//! | `mod`     | commands; arguments of `check` and `figures`           |
//! | `mesh`    | which mesh, and in which form                          |
//! | `solve`   | what is solved: pins, and settings of the solver       |
//! | `flatten` | arguments of `flatten`                                 |
//! | `compare` | arguments of `compare`                                 |
//! | `shape`   | the shape of a boundary                                |
//! | `study`   | arguments of `study`                                   |
//! | `threads` | how many threads do the work                           |

mod compare;
mod flatten;
mod mesh;
mod shape;
mod solve;
mod study;
mod threads;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

pub use compare::{CompareArguments, ComparisonFile};
pub use flatten::FlattenArguments;
pub use mesh::{Cut, MeshArguments, SeamKind};
pub use shape::TypedShape;
pub use solve::{SolveArguments, StartOf};
pub use study::StudyArguments;
pub use threads::ThreadArguments;

/// Flattens 3D triangle meshes into the plane and proves what it made.
#[derive(Debug, Parser)]
#[command(name = "freebound", version, args_conflicts_with_subcommands = true, after_help = EXIT_HELP)]
pub struct Arguments {
    /// A mesh to open in the editor. Without one the built-in example opens.
    pub file: Option<PathBuf>,
    /// What to do without a screen.
    #[command(subcommand)]
    pub command: Option<Subcommands>,
}

const EXIT_HELP: &str = "Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input, \
                         4 not planar, a constraint not met, or no result by this method, 130 interrupted.";

const STUDY_HELP: &str = "Exit status: 0 all runs were made, whatever came of them, 1 internal error, 2 wrong use, \
                          3 unusable input, 130 interrupted.";

const COMPARE_HELP: &str = "Exit status: 0 all methods have run, whatever came of them, 1 internal error, 2 wrong use, \
                            3 unusable input, 130 interrupted.";

/// The commands that need no screen.
#[derive(Debug, Subcommand)]
pub enum Subcommands {
    /// Flatten a mesh; prove the result; write it as texture coordinates.
    #[command(after_help = EXIT_HELP)]
    Flatten(Box<FlattenArguments>),
    /// Run several methods on a mesh, one after the other, and set their results side by side.
    #[command(after_help = COMPARE_HELP)]
    Compare(Box<CompareArguments>),
    /// Diagnose a mesh, and prove its texture coordinates where it has some.
    #[command(after_help = EXIT_HELP)]
    Check(CheckArguments),
    /// List methods and families with their sources.
    Methods,
    /// Compute the paper's figures again, as drawings (SVG), pictures (PNG) and a table (CSV).
    #[command(after_help = EXIT_HELP)]
    Figures(FiguresArguments),
    /// Run the mean-value iteration on many random pins and constraints: how often and how fast it ends planar.
    #[command(after_help = STUDY_HELP)]
    Study(StudyArguments),
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
