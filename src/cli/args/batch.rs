//! Arguments of `batch`.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::typed::parse_memory;

/// Arguments of `batch`.
#[derive(Debug, Args)]
pub struct BatchArguments {
    /// Meshes, folders of meshes, or lists: text files (.txt) with a path in each line.
    ///
    /// Folders are searched with all folders in them. Results keep the folders of their meshes.
    #[arg(required = true, value_name = "LIST|FOLDER|MESH")]
    pub inputs: Vec<PathBuf>,
    /// Write the results into this folder. Each has a record beside it, NAME.freebound.json.
    #[arg(long, value_name = "DIR")]
    pub output_dir: PathBuf,
    /// Command to run on each mesh.
    #[arg(long, value_enum, default_value_t)]
    pub command: BatchCommand,
    /// Format of the results. Default: the format of the mesh, or OBJ if it cannot be written.
    #[arg(long, value_enum)]
    pub format: Option<BatchFormat>,
    /// Number of meshes at once. Default: one for each core.
    ///
    /// Each mesh has one thread, or more if there are fewer meshes at once than cores.
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroUsize>,
    /// Memory for all meshes at once, for example 4G. Default: half of the machine's memory.
    ///
    /// The need of a mesh is estimated from its file. A mesh that needs more than all of it runs alone.
    #[arg(long, value_name = "BYTES[K|M|G]", value_parser = parse_memory)]
    pub memory: Option<u64>,
    /// Keep the results of an earlier run whose meshes and options have not changed.
    #[arg(long)]
    pub resume: bool,
    /// Options of the command, after `--`.
    #[arg(last = true, value_name = "OPTIONS")]
    pub options: Vec<OsString>,
}

/// Command that a batch runs on each mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum BatchCommand {
    /// Cut any mesh open and flatten it
    #[default]
    Unwrap,
    /// Flatten disks and charts
    Flatten,
}

impl BatchCommand {
    /// Name of the command.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unwrap => "unwrap",
            Self::Flatten => "flatten",
        }
    }
}

/// Format of the results of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BatchFormat {
    /// OBJ
    Obj,
    /// PLY
    Ply,
    /// GLB
    Glb,
}

impl BatchFormat {
    /// Extension of the format.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Glb => "glb",
        }
    }
}
