//! The paper's open question (§7), by experiment: from where does the mean-value iteration converge to a planar map?
//!
//! Trials are drawn at random on a mesh, each from the study's seed and its own number: how many threads run them, and
//! in which order, changes nothing.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Study`]: all runs on a mesh; [`Limits`]: how long each may go on |
//! | `subject.rs` | [`StudySubject`]: the mesh, where pins can be, what of its form may count |
//! | `trial.rs` | [`Trial`]: pins, weights and treatment, drawn at random |
//! | `record.rs` | [`run`]: a trial run to its end; [`Record`]: what is kept of it |
//! | `summary.rs` | [`summary`]: runs in groups, how often and how fast they came to a planar map |

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

/// How many runs of a mesh there are, and what decides them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Study {
    /// How many runs.
    pub runs: u64,
    /// What all trials are drawn from.
    pub seed: u64,
    /// How long a run may go on.
    pub limits: Limits,
}

/// How long a run may go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most mean-value iterations of a run.
    pub max_steps: usize,
    /// What becomes of an iteration that gets no better.
    pub patience: Patience,
}

/// What becomes of an iteration that gets no better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Patience {
    /// It ends as stalled, as the method does by itself.
    #[default]
    OfMethod,
    /// It goes on until it is planar or has taken as many steps as it may.
    ToTheLimit,
}

impl Study {
    /// Runs all trials on a mesh, several at once, and calls `done` after each.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] at the caller's wish to stop.
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
