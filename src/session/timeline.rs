//! The steps of a run, kept to be looked at again.
//!
//! The numbers of every step stay. Embeddings stay as long as they fit into a budget of memory: the first, the last and
//! the best, those that the screen shows, then every one that is proved planar, then an even sample of the rest.

use std::collections::BTreeMap;
use std::sync::Arc;

use freebound_core::flatten::Step;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Progress;
use freebound_io::StepReport;

/// Bytes that the steps kept whole may take together.
pub const TIMELINE_BUDGET: usize = 512_000_000;

/// Where a step stands on the way to the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDistortion {
    /// The numbers of a continuation or a relaxing.
    pub progress: Option<Progress>,
    /// Exact pins that are not on their targets.
    pub unmet: usize,
    /// Vertices that its mesh has beyond those of the mesh as given.
    pub new_vertices: usize,
}

impl StepDistortion {
    fn of(step: &Step) -> Self {
        let new_vertices =
            step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices_of_surface().count());
        Self { progress: step.candidate.progress, unmet: step.unmet().len(), new_vertices }
    }
}

/// The steps of one run, in order.
#[derive(Clone, Debug)]
pub struct Timeline {
    budget: usize,
    records: Vec<StepReport>,
    standings: Vec<StepDistortion>,
    kept: BTreeMap<usize, Arc<Outcome>>,
    /// Sum over `kept`.
    bytes: usize,
    /// The first step with the fewest defects.
    best: Option<usize>,
    shown: Option<usize>,
    compared: Option<usize>,
    /// Whether the step shown is always the newest one.
    follows_newest: bool,
}

impl Default for Timeline {
    fn default() -> Self {
        Self::with_budget(TIMELINE_BUDGET)
    }
}

impl Timeline {
    /// A timeline without steps that keeps `budget` bytes of them whole.
    pub fn with_budget(budget: usize) -> Self {
        Self {
            budget,
            records: Vec::new(),
            standings: Vec::new(),
            kept: BTreeMap::new(),
            bytes: 0,
            best: None,
            shown: None,
            compared: None,
            follows_newest: true,
        }
    }

    /// From now on keeps `budget` bytes of steps whole.
    pub fn set_budget(&mut self, budget: usize) {
        self.budget = budget;
        self.thin();
    }

    /// The same with so many bytes of steps whole; where those that are needed take more, with the newest and the one on the
    /// screen alone. Factors of linear solves are left out.
    #[must_use]
    pub fn condensed(&self, budget: usize) -> Self {
        let mut condensed = self.clone();
        condensed.set_budget(budget);
        if condensed.bytes > budget {
            let needed = [self.newest(), self.shown];
            condensed.kept.retain(|index, _| needed.contains(&Some(*index)));
            condensed.bytes = condensed.kept.values().map(|outcome| outcome.bytes()).sum();
            condensed.compared = None;
        }
        for outcome in condensed.kept.values_mut().filter(|outcome| outcome.step.candidate.prepared.is_some()) {
            Arc::make_mut(outcome).step.candidate.prepared = None;
        }
        condensed
    }

    /// A timeline without steps and with the same budget.
    #[must_use]
    pub fn begun_anew(&self) -> Self {
        Self::with_budget(self.budget)
    }

    /// The numbers of every step.
    pub fn records(&self) -> &[StepReport] {
        &self.records
    }

    /// Where every step stands on the way to the constraints.
    pub fn standings(&self) -> &[StepDistortion] {
        &self.standings
    }

    /// A step, where it is kept whole.
    pub fn outcome(&self, index: usize) -> Option<&Arc<Outcome>> {
        self.kept.get(&index)
    }

    /// The place of a step, where it is one of these and kept whole.
    pub fn index_of(&self, outcome: &Arc<Outcome>) -> Option<usize> {
        let index = outcome.step.index;
        self.outcome(index).filter(|kept| Arc::ptr_eq(kept, outcome)).map(|_| index)
    }

    /// The steps kept whole, in order.
    pub fn kept(&self) -> impl DoubleEndedIterator<Item = (usize, &Arc<Outcome>)> {
        self.kept.iter().map(|(&index, outcome)| (index, outcome))
    }

    /// The newest step.
    pub fn newest(&self) -> Option<usize> {
        self.records.len().checked_sub(1)
    }

    /// The first step with the fewest defects.
    pub fn best(&self) -> Option<usize> {
        self.best
    }

    /// The step on the screen. It is always kept whole.
    pub fn shown(&self) -> Option<usize> {
        self.shown
    }

    /// The step that the one on the screen is compared with. It is always kept whole.
    pub fn compared(&self) -> Option<usize> {
        self.compared
    }

    /// The next step after `index` that is kept whole.
    pub fn next_kept(&self, index: usize) -> Option<usize> {
        self.kept.range(index + 1..).next().map(|(&index, _)| index)
    }

    /// The last step before `index` that is kept whole.
    pub fn previous_kept(&self, index: usize) -> Option<usize> {
        self.kept.range(..index).next_back().map(|(&index, _)| index)
    }

    /// Bytes of the steps kept whole.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Takes in the next step. Returns whether it is now the one on the screen.
    ///
    /// # Panics
    ///
    /// If the step is not the next one of its run.
    pub fn push(&mut self, outcome: Arc<Outcome>) -> bool {
        let index = self.records.len();
        assert_eq!(outcome.step.index, index, "steps come in order");
        let record = StepReport::of(&outcome.step);
        if self.best.is_none_or(|best| record.defect_count() < self.records[best].defect_count()) {
            self.best = Some(index);
        }
        self.records.push(record);
        self.standings.push(StepDistortion::of(&outcome.step));
        self.bytes += outcome.bytes();
        self.kept.insert(index, outcome);
        if self.follows_newest {
            self.shown = Some(index);
        }
        self.thin();
        self.follows_newest
    }

    /// Puts a step on the screen, or the nearest one before it that is kept whole. Returns whether that is another one
    /// than before. Whoever looks at the newest step sees the next one as soon as it is there.
    pub fn show(&mut self, index: usize) -> bool {
        let Some(found) = self.kept_at_or_before(index) else { return false };
        self.follows_newest = Some(found) == self.newest();
        self.shown.replace(found) != Some(found)
    }

    /// From now on the newest step is on the screen as soon as it is there.
    pub fn follow_newest(&mut self) {
        self.follows_newest = true;
    }

    /// Compares the step on the screen with another one, or the nearest one before it that is kept whole; or with none.
    pub fn compare(&mut self, index: Option<usize>) {
        self.compared = index.and_then(|index| self.kept_at_or_before(index));
    }

    fn kept_at_or_before(&self, index: usize) -> Option<usize> {
        self.kept.range(..=index).next_back().map(|(&index, _)| index)
    }

    /// Lets go of whole steps until the rest fits into the budget.
    fn thin(&mut self) {
        while self.bytes > self.budget {
            let expendable = self.most_expendable(|outcome| !outcome.step.verdict.planar);
            let Some(index) = expendable.or_else(|| self.most_expendable(|_| true)) else { return };
            if let Some(outcome) = self.kept.remove(&index) {
                self.bytes -= outcome.bytes();
            }
        }
    }

    /// Of the steps of some kind, the one whose neighbours are nearest to each other: what remains is even.
    fn most_expendable(&self, is_of_kind: impl Fn(&Outcome) -> bool) -> Option<usize> {
        let needed = [Some(0), self.newest(), self.best, self.shown, self.compared];
        let kept: Vec<(usize, &Arc<Outcome>)> = self.kept().collect();
        let inner = kept.windows(3).filter(|three| !needed.contains(&Some(three[1].0)) && is_of_kind(three[1].1));
        inner.min_by_key(|three| three[2].0 - three[0].0).map(|three| three[1].0)
    }
}
