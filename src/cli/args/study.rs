//! Arguments of `study`.

use std::path::PathBuf;

use clap::Args;

use super::ThreadArguments;
use freebound_core::pipeline::study::{Limits, Patience, Study};
use freebound_core::problem::Settings;

/// Runs on each mesh, where none is typed.
const RUNS: u64 = 100;

/// The seed, where none is typed.
const SEED: u64 = 1;

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// The meshes, each a disk: OBJ, PLY, STL, OFF, GLB or glTF files.
    #[arg(required_unless_present = "add", value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// How many runs on each mesh; 100 without it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub runs: Option<u64>,
    /// Fewer runs on large meshes: as many as have no more faces than this all together, but one at least.
    #[arg(long, value_name = "FACES", value_parser = clap::value_parser!(u64).range(1..))]
    pub most_faces: Option<u64>,
    /// What all trials are drawn from: the same seed gives the same runs, whatever the number of threads. 1 without it.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// The most mean-value iterations of a run; 60 without it.
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// Go on after a stall, to --max-steps: flatten ends there.
    #[arg(long)]
    pub past_stall: bool,
    /// Add the runs of a table that --csv wrote, of other meshes, with the same --max-steps and --past-stall. Repeatable.
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
    /// How many threads do the work.
    #[command(flatten)]
    pub threads: ThreadArguments,
}

impl StudyArguments {
    /// The runs on a mesh with so many faces.
    pub fn study(&self, faces: usize) -> Study {
        let most = self.most_faces.map_or(u64::MAX, |most| most / faces.max(1) as u64);
        let runs = self.runs.unwrap_or(RUNS).min(most).max(1);
        Study { runs, seed: self.seed.unwrap_or(SEED), limits: self.limits() }
    }

    /// How long a run may go on.
    pub fn limits(&self) -> Limits {
        let patience = if self.past_stall { Patience::ToTheLimit } else { Patience::OfMethod };
        Limits { max_steps: self.max_steps.unwrap_or(Settings::MAX_STEPS), patience }
    }

    /// An option that was given but means nothing without a mesh to run on.
    pub fn idle_option(&self) -> Option<&'static str> {
        let given = [
            ("--runs", self.runs.is_some()),
            ("--most-faces", self.most_faces.is_some()),
            ("--seed", self.seed.is_some()),
            ("--max-steps", self.max_steps.is_some()),
            ("--past-stall", self.past_stall),
            ("--large", self.large),
        ];
        given.into_iter().find(|&(_, is_given)| is_given && self.meshes.is_empty()).map(|(option, _)| option)
    }
}
