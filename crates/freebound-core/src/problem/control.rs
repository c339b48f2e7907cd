//! Progress and cancellation of a solve.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::parallel::prelude::*;

use super::SolveError;

/// Number of vertices, faces or links between two checks of the cancel flag: up to some hundredths of a second if
/// memory is slow.
const AT_ONCE: usize = 1 << 14;

/// Least number of items that share one working buffer.
const AT_LEAST: usize = 1 << 10;

/// Phase of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Computing weights and the matrix.
    Assemble,
    /// Ordering the unknowns and analysing the factorization.
    Analyze,
    /// Factoring the matrix.
    Factor,
    /// Solving and refining.
    Solve,
    /// Taking the exact verdict.
    Verify,
}

impl Phase {
    /// Lower-case words for the screen and the terminal.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Assemble => "assembling",
            Self::Analyze => "ordering",
            Self::Factor => "factoring",
            Self::Solve => "solving",
            Self::Verify => "proving",
        }
    }
}

/// Control of a running solve by its caller: a flag that cancels it, and a callback for its phases.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    cancel: &'a AtomicBool,
    report: &'a (dyn Fn(Phase) + Sync),
}

impl std::fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Control").field("cancel", &self.cancel).finish_non_exhaustive()
    }
}

/// Flag that is never raised.
static GO_ON: AtomicBool = AtomicBool::new(false);

impl<'a> Control<'a> {
    /// Makes a control. The solve stops when `cancel` is raised, and calls `report` at the start of each phase.
    pub fn new(cancel: &'a AtomicBool, report: &'a (dyn Fn(Phase) + Sync)) -> Self {
        Self { cancel, report }
    }

    /// Control of a solve that runs to the end without reports.
    pub fn unattended() -> Control<'static> {
        Control { cancel: &GO_ON, report: &|_| {} }
    }

    /// Flag that cancels the solve.
    pub fn cancel(&self) -> &'a AtomicBool {
        self.cancel
    }

    /// Enters a phase: checks for cancellation, then reports the phase.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the flag is raised.
    pub fn enter(&self, phase: Phase) -> Result<(), SolveError> {
        self.go_on()?;
        (self.report)(phase);
        Ok(())
    }

    /// Checks the cancel flag. Call it every few hundredths of a second, so that a caller never waits for long.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the flag is raised.
    pub fn go_on(&self) -> Result<(), SolveError> {
        if self.cancel.load(Ordering::Relaxed) { Err(SolveError::Cancelled) } else { Ok(()) }
    }

    /// Consecutive ranges that cover the numbers below `count`. The flag is checked before each range. Stop at the
    /// first error.
    pub(crate) fn runs(self, count: usize) -> impl Iterator<Item = Result<Range<usize>, SolveError>> + use<'a> {
        let run = move |first| self.go_on().map(|()| first..count.min(first + AT_ONCE));
        (0..count).step_by(AT_ONCE).map(run)
    }

    /// Values of `of` at the numbers below `count`, in order. Each range of numbers is computed in parallel.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the flag is raised.
    pub(crate) fn each<T: Send>(self, count: usize, of: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, SolveError> {
        let mut found = Vec::with_capacity(count);
        self.extend(&mut found, count, of)?;
        Ok(found)
    }

    /// Appends the values of `of` at the numbers below `count` to `found`. Each range of numbers is computed in
    /// parallel.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the flag is raised.
    pub(crate) fn extend<T: Send>(
        self,
        found: &mut Vec<T>,
        count: usize,
        of: impl Fn(usize) -> T + Sync,
    ) -> Result<(), SolveError> {
        for run in self.runs(count) {
            found.par_extend(run?.into_par_iter().map(&of));
        }
        Ok(())
    }

    /// Values of `of` at the numbers below `count`, in order. `begin` makes a working buffer that many numbers share.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the flag is raised.
    pub(crate) fn each_with<W, T: Send>(
        self,
        count: usize,
        begin: impl Fn() -> W + Sync,
        of: impl Fn(&mut W, usize) -> T + Sync,
    ) -> Result<Vec<T>, SolveError> {
        let mut found = Vec::with_capacity(count);
        for run in self.runs(count) {
            found.par_extend(run?.into_par_iter().with_min_len(AT_LEAST).map_init(&begin, &of));
        }
        Ok(found)
    }
}
