//! One run with a limit of time, and what it came to.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Pins, Settings, SolveError};

use crate::common::stop::within;

/// The longest that a run may take.
const LIMIT: Duration = Duration::from_mins(3);

/// Whether every step is shown.
pub(crate) static SHOWS_STEPS: AtomicBool = AtomicBool::new(false);

/// What a run came to.
pub(crate) struct Outcome {
    /// Why it ended, in words.
    pub(crate) ending: String,
    /// The first step that is planar with all exact pins on their targets, and the seconds until it was there.
    pub(crate) solved: Option<(f64, Step)>,
    /// The last step.
    pub(crate) last: Option<Step>,
    /// How many steps there were, those on the way to a planar start aside.
    pub(crate) steps: usize,
    /// Seconds in all.
    pub(crate) seconds: f64,
}

impl Outcome {
    /// Runs the method of the settings to its end, or to the limit.
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

    /// New vertices of the solved step.
    pub(crate) fn new_vertices(&self) -> Option<usize> {
        let (_, step) = self.solved.as_ref()?;
        Some(step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices().len()))
    }

    /// Seconds until the solved step, or until the run gave up.
    pub(crate) fn seconds_to_solve(&self) -> f64 {
        self.solved.as_ref().map_or(self.seconds, |&(seconds, _)| seconds)
    }
}

/// A step in a line.
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
