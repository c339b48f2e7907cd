//! Arguments of `study`.

use std::path::PathBuf;

use clap::Args;

use super::ThreadArguments;
use freebound_core::pipeline::study::{Limits, Patience, Study};
use freebound_core::problem::Settings;

/// Default number of runs on each mesh.
const RUNS: u64 = 100;

/// Default seed.
const SEED: u64 = 1;

/// Arguments of `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Meshes to study, each a disk: OBJ, PLY, STL, OFF, GLB or glTF files.
    #[arg(required_unless_present = "add", value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// Number of runs on each mesh. Default: 100.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub runs: Option<u64>,
    /// Maximum number of faces over all runs on a mesh. Large meshes get fewer runs, at least one.
    #[arg(long, value_name = "FACES", value_parser = clap::value_parser!(u64).range(1..))]
    pub most_faces: Option<u64>,
    /// Seed of the random trials. Default: 1.
    ///
    /// Equal seeds give equal runs for any number of threads.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Maximum number of mean-value iterations of a run. Default: 60.
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// Continue up to --max-steps after a stall. `flatten` stops at a stall.
    #[arg(long)]
    pub past_stall: bool,
    /// Add the runs of a table that --csv wrote for other meshes. Repeatable.
    ///
    /// The table must have been made with equal --max-steps and --past-stall.
    #[arg(long, value_name = "FILE")]
    pub add: Vec<PathBuf>,
    /// Write a table to this file, with a row for each run (CSV).
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Plot the frequency and the speed of planar results into this file (SVG).
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Read meshes even if that may need more than half of the machine's memory.
    #[arg(long)]
    pub large: bool,
    /// Number of threads.
    #[command(flatten)]
    pub threads: ThreadArguments,
}

impl StudyArguments {
    /// Runs on a mesh with `faces` faces.
    pub fn study(&self, faces: usize) -> Study {
        let most = self.most_faces.map_or(u64::MAX, |most| most / faces.max(1) as u64);
        let runs = self.runs.unwrap_or(RUNS).min(most).max(1);
        Study { runs, seed: self.seed.unwrap_or(SEED), limits: self.limits() }
    }

    /// Limits of each run.
    pub fn limits(&self) -> Limits {
        let patience = if self.past_stall { Patience::ToTheLimit } else { Patience::OfMethod };
        Limits { max_steps: self.max_steps.unwrap_or(Settings::MAX_STEPS), patience }
    }

    /// First given option that has no effect without a mesh.
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
