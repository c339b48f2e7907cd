//! Arguments for reading a mesh.

use clap::Args;

use freebound_io::{Instances, ReadOptions};

/// Limits and choices of reading a mesh.
#[derive(Clone, Copy, Debug, Args)]
pub struct ReadingArguments {
    /// Read the mesh even if that may need more than half of the machine's memory.
    #[arg(long, hide_short_help = true)]
    pub large: bool,
    /// Give each node of a glTF file a mesh and a map of its own.
    ///
    /// By default, nodes that show one mesh share its map: the mesh is read once, at its first node.
    #[arg(long, hide_short_help = true)]
    pub unique_instances: bool,
}

impl ReadingArguments {
    /// Options of the reader.
    pub fn options(self) -> ReadOptions {
        ReadOptions { instances: if self.unique_instances { Instances::Unique } else { Instances::Shared } }
    }
}
