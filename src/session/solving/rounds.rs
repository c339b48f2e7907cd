//! Relaxation rounds that the user requested, and their progress.

/// Relaxation rounds after the end of the run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rounds {
    /// Number of requested rounds, without those that were cut short.
    asked: usize,
    latest: Option<Latest>,
    /// Number of rounds that were cut short. The stopped run can still take them.
    cut: usize,
}

/// Last request of rounds.
#[derive(Clone, Copy, Debug)]
struct Latest {
    /// Index of the step before the rounds.
    after: usize,
    rounds: usize,
}

impl Rounds {
    /// Rounds that were taken in an earlier run.
    pub(super) fn taken(asked: usize) -> Self {
        Self { asked, ..Self::default() }
    }

    pub(super) fn asked(&self) -> usize {
        self.asked
    }

    /// Starts rounds after the step `newest`. They replace rounds that were cut short.
    pub(super) fn begin(&mut self, rounds: usize, newest: usize) {
        self.cut = 0;
        self.go_on(rounds, newest);
    }

    fn go_on(&mut self, rounds: usize, newest: usize) {
        self.asked = self.asked.saturating_add(rounds);
        self.latest = Some(Latest { after: newest, rounds });
    }

    /// Ends the rounds, because the run has ended by itself.
    pub(super) fn end(&mut self) {
        self.latest = None;
    }

    /// Cuts short the rounds that were not taken when the run stopped. Returns their number.
    pub(super) fn cut_short(&mut self, newest: usize) -> usize {
        let Some(Latest { after, rounds }) = self.latest.take() else { return 0 };
        let left = rounds.saturating_sub(newest.saturating_sub(after));
        self.asked = self.asked.saturating_sub(left);
        self.cut += left;
        left
    }

    /// Resumes at most `most` rounds that were cut short. Returns their number.
    pub(super) fn resume(&mut self, most: usize, newest: usize) -> usize {
        let rounds = self.cut.min(most);
        if rounds > 0 {
            self.cut -= rounds;
            self.go_on(rounds, newest);
        }
        rounds
    }
}
