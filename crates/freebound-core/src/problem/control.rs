//! How a caller watches a solve and stops it.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::parallel::prelude::*;

use super::SolveError;

/// Vertices, faces or links between two looks at the flag: up to some hundredths of a second where memory is slow.
const AT_ONCE: usize = 1 << 14;

/// Those that share what they work in.
const AT_LEAST: usize = 1 << 10;

/// What a solve is busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Computing weights and the matrix.
    Assemble,
    /// Ordering the unknowns and planning the factorization.
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

/// The caller's hand on a running solve: a flag to stop it, and a place to hear how far it is.
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

/// Never raised.
static GO_ON: AtomicBool = AtomicBool::new(false);

impl<'a> Control<'a> {
    /// Stops when `cancel` is raised; calls `report` at the start of each phase.
    pub fn new(cancel: &'a AtomicBool, report: &'a (dyn Fn(Phase) + Sync)) -> Self {
        Self { cancel, report }
    }

    /// Runs to the end in silence.
    pub fn unattended() -> Control<'static> {
        Control { cancel: &GO_ON, report: &|_| {} }
    }

    /// The flag that stops the work.
    pub fn cancel(&self) -> &'a AtomicBool {
        self.cancel
    }

    /// Announces a phase.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] where the caller asked to stop.
    pub fn enter(&self, phase: Phase) -> Result<(), SolveError> {
        self.go_on()?;
        (self.report)(phase);
        Ok(())
    }

    /// Looks at the flag. To be asked for all some hundredths of a second, so that a caller never waits for long.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] where the caller asked to stop.
    pub fn go_on(&self) -> Result<(), SolveError> {
        if self.cancel.load(Ordering::Relaxed) { Err(SolveError::Cancelled) } else { Ok(()) }
    }

    /// The numbers below `count` in runs, the flag looked at before each: an error is the last.
    pub(crate) fn runs(self, count: usize) -> impl Iterator<Item = Result<Range<usize>, SolveError>> + use<'a> {
        let run = move |first| self.go_on().map(|()| first..count.min(first + AT_ONCE));
        (0..count).step_by(AT_ONCE).map(run)
    }

    /// What each of the numbers below `count` gives, in their order: found side by side, some at a time.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(crate) fn each<T: Send>(self, count: usize, of: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, SolveError> {
        let mut found = Vec::with_capacity(count);
        self.extend(&mut found, count, of)?;
        Ok(found)
    }

    /// The same, put behind what is there.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
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

    /// The same with something to work in, made by `begin` once for many numbers.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
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
