//! Arguments of `study`.

use std::path::PathBuf;

use clap::Args;

use crate::solver::Settings;
use crate::solver::study::{Patience, Study};

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// The meshes, each a disk: OBJ, PLY, STL, OFF, GLB or glTF files.
    #[arg(required_unless_present = "add", value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// How many runs on each mesh.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub runs: u64,
    /// Fewer runs on large meshes: as many as have no more faces than this all together, but one at least.
    #[arg(long, value_name = "FACES", value_parser = clap::value_parser!(u64).range(1..))]
    pub most_faces: Option<u64>,
    /// What all trials are drawn from: the same seed gives the same runs, whatever the number of threads.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// The most mean-value iterations of a run.
    #[arg(long, value_name = "N", default_value_t = Settings::MAX_STEPS)]
    pub max_steps: usize,
    /// Go on after a stall, to --max-steps: flatten ends there.
    #[arg(long)]
    pub past_stall: bool,
    /// Add the runs of a table that --csv wrote, of other meshes. Repeatable.
    #[arg(long, value_name = "FILE")]
    pub add: Vec<PathBuf>,
    /// Write a table with a row for each run here (CSV).
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw how often and how fast runs came to a planar map here (SVG).
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Read meshes even if that may take more than half of the machine's memory.
    #[arg(long)]
    pub large: bool,
    /// Threads to use; all cores without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl StudyArguments {
    /// The runs on a mesh with so many faces.
    pub fn study(&self, faces: usize) -> Study {
        let most = self.most_faces.map_or(u64::MAX, |most| most / faces.max(1) as u64);
        let patience = if self.past_stall { Patience::ToTheLimit } else { Patience::OfMethod };
        Study { runs: self.runs.min(most).max(1), seed: self.seed, max_steps: self.max_steps, patience }
    }
}
