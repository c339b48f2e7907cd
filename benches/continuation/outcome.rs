//! Outcome of one run with a time limit.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Pins, Settings, SolveError};

use crate::common::stop::within;

/// Time limit of a run.
const LIMIT: Duration = Duration::from_mins(3);

/// True if every step is printed.
pub(crate) static SHOWS_STEPS: AtomicBool = AtomicBool::new(false);

/// Outcome of a run.
pub(crate) struct Outcome {
    /// Reason why the run ended, for the table.
    pub(crate) ending: String,
    /// First planar step with all hard pins on their targets, and the seconds until then.
    pub(crate) solved: Option<(f64, Step)>,
    /// The last step.
    pub(crate) last: Option<Step>,
    /// Number of steps, without those of the start phase before a planar embedding.
    pub(crate) steps: usize,
    /// Total seconds.
    pub(crate) seconds: f64,
}

impl Outcome {
    /// Runs the method of the settings to its end or to the time limit.
    pub(crate) fn of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Self {
        let cancel = AtomicBool::new(false);
        let silent = |_| {};
        let control = Control::new(&cancel, &silent);
        let start = Instant::now();
        let mut found = Self { ending: String::new(), solved: None, last: None, steps: 0, seconds: 0.0 };
        let (ending, _) = within(LIMIT, &cancel, || {
            let mut run = Flattener::new(settings, pins.clone());
            let take = |step: Step| {
                found.steps += usize::from(!step.is_of_planar_start());
                if SHOWS_STEPS.load(Ordering::Relaxed) {
                    show(&step);
                }
                if found.solved.is_none() && step.verdict.planar && step.unmet().is_empty() {
                    found.solved = Some((start.elapsed().as_secs_f64(), step.clone()));
                }
                found.last = Some(step);
            };
            catch_unwind(AssertUnwindSafe(|| run.finish(mesh, control, take)))
        });
        found.seconds = start.elapsed().as_secs_f64();
        found.ending = match ending {
            Ok(Ok(ending)) => format!("{ending:?}").to_lowercase(),
            Ok(Err(SolveError::Cancelled)) => format!("over {} s", LIMIT.as_secs()),
            Ok(Err(error)) => error.to_string(),
            Err(_) => "panic".to_owned(),
        };
        found
    }

    /// Number of new vertices of the solved step.
    pub(crate) fn new_vertices(&self) -> Option<usize> {
        let (_, step) = self.solved.as_ref()?;
        Some(step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices().len()))
    }

    /// Seconds until the solved step, or until the run ended without one.
    pub(crate) fn seconds_to_solve(&self) -> f64 {
        self.solved.as_ref().map_or(self.seconds, |&(seconds, _)| seconds)
    }
}

/// Prints a step on one line.
pub(crate) fn show(step: &Step) {
    let progress = step.candidate.progress.map_or_else(String::new, |progress| {
        format!(", energy {:.4}, distance left {:.3e}", progress.energy, progress.distance_left)
    });
    println!(
        "    {} {}: {:.3} s, {}{progress}",
        step.index,
        step.candidate.stage.name(),
        step.seconds(),
        step.verdict.summary()
    );
}
