//! Experiment on the paper's open question (§7): from which starts does the mean-value iteration converge to a planar
//! map?
//!
//! Trials are drawn at random on a mesh, each from the study's seed and its own number. Results do not depend on the
//! number or the order of threads.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`Study`]: all runs on a mesh; [`Limits`]: end of a run |
//! | `subject.rs` | [`StudySubject`]: the mesh, candidate vertices for pins, counts that convergence may depend on |
//! | `trial.rs` | [`Trial`]: pins, weights and treatment, drawn at random |
//! | `record.rs` | [`run`]: runs a trial to its end; [`Record`]: its results |
//! | `summary.rs` | [`summary`]: runs in groups, with the share and the speed of convergence to a planar map |

mod record;
mod subject;
mod summary;
mod trial;

use crate::parallel::prelude::*;

pub use record::{Defects, Record, StopReason, TrialOutcome, run};
pub use subject::{StudySubject, SystemForm};
pub use summary::{Group, Studied, summary};
pub use trial::Trial;

use crate::problem::{Control, SolveError};

/// Number of runs on a mesh, their seed and their limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Study {
    /// Number of runs.
    pub runs: u64,
    /// Seed of all trials.
    pub seed: u64,
    /// Limits of each run.
    pub limits: Limits,
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest number of mean-value iterations of a run.
    pub max_steps: usize,
    /// Treatment of an iteration that no longer improves.
    pub patience: Patience,
}

/// Treatment of an iteration that no longer improves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Patience {
    /// End as stalled, as the method itself does.
    #[default]
    OfMethod,
    /// Continue until the map is planar or the step limit is reached.
    ToTheLimit,
}

impl Study {
    /// Runs all trials on a mesh, several at once, and calls `done` after each.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the caller cancels.
    pub fn records(
        self,
        subject: &StudySubject<'_>,
        control: Control<'_>,
        done: impl Fn() + Sync,
    ) -> Result<Vec<Record>, SolveError> {
        let record = |number| {
            let record = run(subject, Trial::draw(subject, self.seed, number), self.limits, control)?;
            done();
            Ok(record)
        };
        let numbers: Vec<u64> = (0..self.runs).collect();
        numbers.into_par_iter().with_max_len(1).map(record).collect()
    }
}
