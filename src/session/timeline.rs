//! Steps of a run, kept for later inspection.
//!
//! The numbers of every step are kept. Embeddings are kept within a memory budget. Priority: the first, the newest and
//! the best step, the steps on the screen, then planar steps, then an even sample of the others.

use std::collections::BTreeMap;
use std::sync::Arc;

use freebound_core::flatten::Step;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Progress;
use freebound_io::StepReport;

/// Memory budget for the steps of a run that are kept whole, bytes.
pub const TIMELINE_BUDGET: usize = 512_000_000;

/// Progress of a step towards the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDistortion {
    /// Progress of a continuation or a relaxation.
    pub progress: Option<Progress>,
    /// Number of hard pins that are not at their targets.
    pub unmet: usize,
    /// Number of vertices that the step added to the mesh.
    pub new_vertices: usize,
}

impl StepDistortion {
    fn of(step: &Step) -> Self {
        let new_vertices =
            step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices_of_surface().count());
        Self { progress: step.candidate.progress, unmet: step.unmet().len(), new_vertices }
    }
}

/// Steps of one run, in order.
#[derive(Clone, Debug)]
pub struct Timeline {
    budget: usize,
    records: Vec<StepReport>,
    standings: Vec<StepDistortion>,
    kept: BTreeMap<usize, Arc<Outcome>>,
    /// Total size of the steps in `kept`.
    bytes: usize,
    /// First step with the fewest defects.
    best: Option<usize>,
    shown: Option<usize>,
    compared: Option<usize>,
    /// True if the newest step is always shown.
    follows_newest: bool,
}

impl Default for Timeline {
    fn default() -> Self {
        Self::with_budget(TIMELINE_BUDGET)
    }
}

impl Timeline {
    /// Creates an empty timeline with a memory budget of `budget` bytes.
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

    /// Sets the memory budget, bytes.
    pub fn set_budget(&mut self, budget: usize) {
        self.budget = budget;
        self.thin();
    }

    /// Copy with a memory budget of `budget` bytes, without factors of linear solves. If the essential steps exceed the
    /// budget, only the newest and the shown step are kept.
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

    /// Creates an empty timeline with an equal budget.
    #[must_use]
    pub fn begun_anew(&self) -> Self {
        Self::with_budget(self.budget)
    }

    /// Numbers of every step.
    pub fn records(&self) -> &[StepReport] {
        &self.records
    }

    /// Progress of every step towards the constraints.
    pub fn standings(&self) -> &[StepDistortion] {
        &self.standings
    }

    /// Step with this index, if it is kept whole.
    pub fn outcome(&self, index: usize) -> Option<&Arc<Outcome>> {
        self.kept.get(&index)
    }

    /// Index of a step, if it belongs to this timeline and is kept whole.
    pub fn index_of(&self, outcome: &Arc<Outcome>) -> Option<usize> {
        let index = outcome.step.index;
        self.outcome(index).filter(|kept| Arc::ptr_eq(kept, outcome)).map(|_| index)
    }

    /// Steps that are kept whole, in order.
    pub fn kept(&self) -> impl DoubleEndedIterator<Item = (usize, &Arc<Outcome>)> {
        self.kept.iter().map(|(&index, outcome)| (index, outcome))
    }

    /// Index of the newest step.
    pub fn newest(&self) -> Option<usize> {
        self.records.len().checked_sub(1)
    }

    /// First step with the fewest defects.
    pub fn best(&self) -> Option<usize> {
        self.best
    }

    /// Index of the shown step, which is always kept whole.
    pub fn shown(&self) -> Option<usize> {
        self.shown
    }

    /// Index of the step that the shown one is compared with. It is always kept whole.
    pub fn compared(&self) -> Option<usize> {
        self.compared
    }

    /// First step after `index` that is kept whole.
    pub fn next_kept(&self, index: usize) -> Option<usize> {
        self.kept.range(index + 1..).next().map(|(&index, _)| index)
    }

    /// Last step before `index` that is kept whole.
    pub fn previous_kept(&self, index: usize) -> Option<usize> {
        self.kept.range(..index).next_back().map(|(&index, _)| index)
    }

    /// Memory of the steps that are kept whole, bytes.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Adds the next step. Returns true if the step is shown.
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

    /// Shows a step, or the nearest one before it that is kept whole. Returns true if the shown step changed. After the
    /// newest step was shown, each newer step is shown on arrival.
    pub fn show(&mut self, index: usize) -> bool {
        let Some(found) = self.kept_at_or_before(index) else { return false };
        self.follows_newest = Some(found) == self.newest();
        self.shown.replace(found) != Some(found)
    }

    /// Shows each new step on arrival from now on.
    pub fn follow_newest(&mut self) {
        self.follows_newest = true;
    }

    /// Compares the shown step with a step, or the nearest one before it that is kept whole. `None` ends the
    /// comparison.
    pub fn compare(&mut self, index: Option<usize>) {
        self.compared = index.and_then(|index| self.kept_at_or_before(index));
    }

    fn kept_at_or_before(&self, index: usize) -> Option<usize> {
        self.kept.range(..=index).next_back().map(|(&index, _)| index)
    }

    /// Drops whole steps until the others fit into the budget.
    fn thin(&mut self) {
        while self.bytes > self.budget {
            let expendable = self.most_expendable(|outcome| !outcome.step.verdict.planar);
            let Some(index) = expendable.or_else(|| self.most_expendable(|_| true)) else { return };
            if let Some(outcome) = self.kept.remove(&index) {
                self.bytes -= outcome.bytes();
            }
        }
    }

    /// Step of a kind whose kept neighbours are closest to each other, so that the others stay evenly spaced.
    fn most_expendable(&self, is_of_kind: impl Fn(&Outcome) -> bool) -> Option<usize> {
        let needed = [Some(0), self.newest(), self.best, self.shown, self.compared];
        let kept: Vec<(usize, &Arc<Outcome>)> = self.kept().collect();
        let inner = kept.windows(3).filter(|three| !needed.contains(&Some(three[1].0)) && is_of_kind(three[1].1));
        inner.min_by_key(|three| three[2].0 - three[0].0).map(|three| three[1].0)
    }
}
