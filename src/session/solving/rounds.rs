//! Rounds of relaxing that a person has asked for, and how far the run has come with them.

/// Rounds beyond the run's own end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rounds {
    /// How many the run was asked for, but for those that were cut short.
    asked: usize,
    latest: Option<Latest>,
    /// How many were cut short: the run at rest would still take them.
    cut: usize,
}

/// Rounds that were asked for last.
#[derive(Clone, Copy, Debug)]
struct Latest {
    /// The step that they follow.
    after: usize,
    rounds: usize,
}

impl Rounds {
    pub(super) fn asked(&self) -> usize {
        self.asked
    }

    /// So many are asked for after a step, in the place of those that were cut short.
    pub(super) fn begin(&mut self, rounds: usize, newest: usize) {
        self.cut = 0;
        self.go_on(rounds, newest);
    }

    fn go_on(&mut self, rounds: usize, newest: usize) {
        self.asked = self.asked.saturating_add(rounds);
        self.latest = Some(Latest { after: newest, rounds });
    }

    /// The run has come to its own end: it takes no further one of them.
    pub(super) fn end(&mut self) {
        self.latest = None;
    }

    /// The run has come to rest before: rounds that were not taken are cut short. Returns how many.
    pub(super) fn cut_short(&mut self, newest: usize) -> usize {
        let Some(Latest { after, rounds }) = self.latest.take() else { return 0 };
        let left = rounds.saturating_sub(newest.saturating_sub(after));
        self.asked = self.asked.saturating_sub(left);
        self.cut += left;
        left
    }

    /// Takes up rounds that were cut short, so many at most. Returns how many.
    pub(super) fn resume(&mut self, most: usize, newest: usize) -> usize {
        let rounds = self.cut.min(most);
        if rounds > 0 {
            self.cut -= rounds;
            self.go_on(rounds, newest);
        }
        rounds
    }
}
