//! Arguments of the program. clap generates `freebound --help` from them.
//!
//! | file      | content                                       |
//! |-----------|-----------------------------------------------|
//! | `mod`     | commands; arguments of `figures`              |
//! | `batch`   | arguments of `batch`                          |
//! | `check`   | arguments of `check`                          |
//! | `mesh`    | arguments for the mesh and its preparation    |
//! | `mesh_output` | arguments of commands that write a mesh      |
//! | `solve`   | arguments for pins and settings of the solver |
//! | `flatten` | arguments of `flatten`                        |
//! | `pack`    | arguments of `pack`                           |
//! | `pattern` | arguments for a cutting pattern               |
//! | `reading` | arguments for reading a mesh                  |
//! | `compare` | arguments of `compare`                        |
//! | `shape`   | value for the shape of a boundary             |
//! | `study`   | arguments of `study`                          |
//! | `transfer` | arguments of `transfer` and `bake`             |
//! | `threads` | argument for the number of threads            |

mod batch;
mod check;
mod compare;
mod flatten;
mod mesh;
mod mesh_output;
mod pack;
mod pattern;
mod reading;
mod shape;
mod solve;
mod study;
mod threads;
mod transfer;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::cli::progress::ProgressForm;
use crate::examples::ExampleFiles;

pub use batch::{BatchArguments, BatchCommand, BatchFormat};
pub(super) use check::{CheckArguments, Denied};
pub use compare::{CompareArguments, ComparisonFile};
pub use flatten::{FlattenArguments, UnwrapArguments};
pub use mesh::{Cut, MeshArguments};
pub(super) use mesh_output::MeshOutputArguments;
pub use pack::PackArguments;
pub use pattern::PatternArguments;
pub(super) use reading::ReadingArguments;
pub use shape::TypedShape;
pub use solve::{SolveArguments, StartOf};
pub use study::StudyArguments;
pub use threads::ThreadArguments;
pub use transfer::{BakeArguments, CarryArguments, TransferArguments};

/// Flattens 3D triangle meshes into the plane and proves the result.
#[derive(Debug, Parser)]
#[command(name = "freebound", version, args_conflicts_with_subcommands = true, after_help = EXIT_HELP)]
pub struct Arguments {
    /// Mesh to open in the editor. Default: the built-in example.
    pub file: Option<PathBuf>,
    /// Form of the progress on standard error.
    #[arg(long, global = true, value_enum, default_value_t, hide_short_help = true)]
    pub progress: ProgressForm,
    /// Command to run without a window.
    #[command(subcommand)]
    pub command: Option<Subcommands>,
}

const EXIT_HELP: &str = "Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input, \
                         4 not planar, a constraint not met, or the method failed, 130 interrupted.";

const FLATTEN_HELP: &str = "Example:
  freebound flatten mesh.obj -o flat.obj --png flat.png

Further options and examples: freebound flatten --help";

const FLATTEN_LONG_HELP: &str = "Examples:
  freebound flatten mesh.obj -o flat.obj --png flat.png
  freebound flatten head.obj --constraints landmarks.txt --picture face.png -o textured.obj
  freebound flatten box.obj --repair all --seams sharp=60 -o unfolded.obj
  freebound flatten closed.obj --repair all --cut auto --relax 20 -o unwrapped.glb
  freebound flatten - -o - <mesh.obj >flat.obj

Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input,
4 not planar, a constraint not met, or the method failed, 130 interrupted.";

const UNWRAP_HELP: &str = "Examples:
  freebound unwrap model.obj -o unwrapped.obj
  freebound unwrap model.glb -o unwrapped.glb --distortion 4.05

Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input,
4 not planar, a constraint not met, or the method failed, 130 interrupted.";

const PACK_HELP: &str = "Examples:
  freebound pack model.obj -o packed.obj --pack 2048x2048 --gap 8
  freebound pack model.glb -o packed.glb --keep-sizes --stack

Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input,
4 packed, but a chart folds or overlaps itself, 130 interrupted.";

const TRANSFER_HELP: &str = "Examples:
  freebound transfer detailed.obj coarse.obj -o coarse-uv.obj
  freebound transfer old-version.glb new-version.obj -o new-uv.glb

Exit status: 0 planar and proved, 1 internal error, 2 wrong use, 3 unusable input,
4 copied, but not planar, 130 interrupted.";

const BAKE_HELP: &str = "Examples:
  freebound unwrap model.obj -o unwrapped.obj
  freebound bake model.obj unwrapped.obj --picture skin.png -o new-skin.png

Exit status: 0 drawn, 1 internal error, 2 wrong use, 3 unusable input, 130 interrupted.";

const CARRY_HELP: &str = "Examples:
  freebound carry scan.obj finer-scan.obj --constraints face.txt -o finer-face.txt
  freebound carry head.obj other.obj --constraints face.txt -o other.txt --fit

Exit status: 0 all carried, 1 internal error, 2 wrong use, 3 unusable input,
4 some constraints are lost, 130 interrupted.";

const BATCH_HELP: &str = "Examples:
  freebound batch models --output-dir unwrapped
  freebound batch scans.txt --output-dir out --resume --format glb -- --distortion 4.2

Exit status: 0 all planar and proved, 1 an internal error, 2 wrong use, 3 an unusable mesh,
4 a mesh that is not planar or misses a constraint, 130 interrupted. The worst one counts.";

const STUDY_HELP: &str = "Exit status: 0 all runs completed, with any results, 1 internal error, 2 wrong use, \
                          3 unusable input, 130 interrupted.";

const COMPARE_HELP: &str = "Exit status: 0 all methods completed, with any results, 1 internal error, 2 wrong use, \
                            3 unusable input, 130 interrupted.";

/// Commands that need no window.
#[derive(Debug, Subcommand)]
pub enum Subcommands {
    /// Flatten a mesh, prove the result, and write it as texture coordinates.
    #[command(after_help = FLATTEN_HELP, after_long_help = FLATTEN_LONG_HELP)]
    Flatten(Box<FlattenArguments>),
    /// Cut any mesh open along short seams, flatten it with little distortion, pack and prove its charts.
    ///
    /// All options are those of `flatten`. Other defaults: all repairs, automatic seams, and relaxing.
    #[command(after_help = UNWRAP_HELP)]
    Unwrap(Box<UnwrapArguments>),
    /// Pack the charts of existing texture coordinates again, without flattening.
    ///
    /// Every chart keeps its shape. Charts are the pieces of the layout that share edges.
    #[command(after_help = PACK_HELP)]
    Pack(Box<PackArguments>),
    /// Copy the texture coordinates of a mesh to another mesh of the surface, and prove them there.
    ///
    /// Meshes with equal faces are matched corner by corner. Others, such as levels of detail, are matched by nearest
    /// points: they must lie at one place, in one size.
    #[command(after_help = TRANSFER_HELP)]
    Transfer(Box<TransferArguments>),
    /// Draw the picture of an old layout for a new layout of the surface.
    ///
    /// Every pixel shows the point of the surface that the new layout has there. Use it for pictures of colours. A normal
    /// map depends on its layout: bake it in the program that made it.
    #[command(after_help = BAKE_HELP)]
    Bake(Box<BakeArguments>),
    /// Carry the constraints of a mesh to another mesh of the surface, and list both vertices of each.
    ///
    /// Vertices of meshes with equal faces keep their numbers. Otherwise each constraint goes to a corner of the nearest
    /// triangle on the same side of the surface, or to a free vertex near if other constraints have the corners.
    #[command(after_help = CARRY_HELP)]
    Carry(Box<CarryArguments>),
    /// Flatten or unwrap many meshes side by side.
    ///
    /// Prints one line of JSON for each mesh as it ends. A mesh that cannot be used stops nothing. The exit status is the
    /// worst of all meshes.
    #[command(after_help = BATCH_HELP)]
    Batch(Box<BatchArguments>),
    /// Run several methods on a mesh and compare their results.
    #[command(after_help = COMPARE_HELP)]
    Compare(Box<CompareArguments>),
    /// Diagnose a mesh, and verify its texture coordinates if it has any.
    #[command(after_help = EXIT_HELP)]
    Check(Box<CheckArguments>),
    /// Write the files of a built-in example, or list the examples.
    Example(ExampleArguments),
    /// List methods and families of weights with their sources.
    Methods,
    /// Print completions for a shell.
    Completions(CompletionsArguments),
    /// Write manual pages of all commands.
    Man(ManArguments),
    /// Recompute the figures of the paper: drawings (SVG), pictures (PNG) and a table (CSV).
    #[command(after_help = EXIT_HELP)]
    Figures(FiguresArguments),
    /// Run the mean-value iteration on random pins; count planar results and iterations.
    #[command(after_help = STUDY_HELP)]
    Study(StudyArguments),
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// Shell to write completions for.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Arguments of `man`.
#[derive(Debug, Args)]
pub struct ManArguments {
    /// Folder to write into, created if it is missing.
    pub folder: PathBuf,
}

/// Arguments of `example`.
#[derive(Debug, Args)]
pub struct ExampleArguments {
    /// Name of the example. Default: list all examples.
    #[arg(value_parser = clap::builder::PossibleValuesParser::new(ExampleFiles::ALL.map(|example| example.name)))]
    pub name: Option<String>,
    /// Folder to write into, created if it is missing.
    #[arg(default_value = ".")]
    pub folder: PathBuf,
}

/// Arguments of `figures`.
#[derive(Debug, Args)]
pub struct FiguresArguments {
    /// Folder to write into, created if it is missing.
    pub folder: PathBuf,
}
