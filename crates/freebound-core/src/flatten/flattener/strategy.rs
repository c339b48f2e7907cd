//! Strategy: the order of stages, chosen once from method and pins.
//!
//! A strategy has phases, a phase has sequences, a sequence has stages. After the last step of a stage, the next stage
//! of its sequence follows. A stage that fails, or that does not apply, leads to the next sequence. A phase ends when
//! its goal is reached and the embedding relaxed, or with its last sequence.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use super::relax::{Relax, Rounds};
use super::sequence::StageKind::{Continuation, Fit, Given, Iterate, Schnyder};
use super::sequence::{
    ANGLES, BENT, CONTINUED, CONTINUED_OR_MATCHED, CONTINUING, DRAWN, GIVEN, GIVEN_BENT, GIVEN_ITERATED, HELD,
    ITERATED, LADDER, LESS_ENERGETIC, LESS_STRETCHED, LINEAR, MATCHED, PADDED, SPECTRAL, Sequence, StageKind,
};
use super::single_step::Cut;
use super::stage::{Attained, PhaseGoal, RunStage, StepState};
use super::task::Task;
use super::{Ending, SolverCache, Step};
use crate::problem::{Embedding, Method, Pins, Settings, Stage};

/// Most rounds of relaxing until a planar embedding is usable.
const ROUNDS_UNTIL_IT_SERVES: usize = 60;

/// Rounds of relaxing to make polygons convex.
const ROUNDS_TO_CONVEX: usize = 30;

/// Remaining phases, the current one first.
#[derive(Debug)]
pub(super) struct Strategy {
    phases: VecDeque<PhaseState>,
}

impl Strategy {
    /// Strategy that starts from a layout in the plane, if there is one.
    pub(super) fn new(task: &Arc<Task>, cache: &SolverCache, layout: Option<&Arc<Embedding>>) -> Self {
        layout.map_or_else(|| Self::from_scratch(task, cache), |layout| Self::from_given(task, cache, layout))
    }

    fn from_given(task: &Arc<Task>, cache: &SolverCache, layout: &Arc<Embedding>) -> Self {
        // The layout is the planar start.
        let cache = SolverCache { planar_start: None, ..cache.clone() };
        let from_layout = |phase| PhaseState { is_from_layout: true, ..phase };
        let phase = |sequences| from_layout(PhaseState::new(task, PhaseGoal::Constraints, sequences, &cache));
        // Constraints are met from the unchanged layout.
        let start = || {
            let settings = Settings { size: task.settings.size, ..Settings::default() };
            let frame = Arc::clone(&task.frame);
            let start = Some(Arc::clone(layout));
            let task = Task { start, start_is_free: task.start_is_free, ..Task::new(settings, Pins::new(), frame) };
            from_layout(PhaseState::new(&Arc::new(task), PhaseGoal::PlanarStart, GIVEN, &cache))
        };
        let to_constraints = |sequences| {
            let as_it_lies = task.is_held_by_start().then(|| phase(CONTINUING));
            [start()].into_iter().chain(as_it_lies).chain([phase(sequences)]).collect()
        };
        let phases = match task.settings.method {
            Method::Iterate => [phase(GIVEN_ITERATED)].into(),
            Method::VirtualBoundary => [phase(GIVEN_BENT)].into(),
            Method::Auto if !task.is_constrained() => [phase(GIVEN)].into(),
            _ if task.is_met_by_start() => [phase(GIVEN)].into(),
            _ => to_constraints(Self::sequence_to_constraints(task)),
        };
        Self { phases }
    }

    /// Strategy that starts from the surface alone.
    pub(super) fn from_scratch(task: &Arc<Task>, cache: &SolverCache) -> Self {
        let planar_start = cache.planar_start.clone().filter(|start| start.serves(task));
        let cache = SolverCache { planar_start, ..cache.clone() };
        let phase = |sequences| PhaseState::new(task, PhaseGoal::Constraints, sequences, &cache);
        let unconstrained = Settings { size: task.settings.size, ..Settings::default() };
        let start = || {
            let task = Task::new(unconstrained, Pins::new(), Arc::new(task.frame.without_pins()));
            PhaseState::new(&Arc::new(task), PhaseGoal::PlanarStart, LADDER, &cache)
        };
        let from_start = |sequences| cache.planar_start.is_none().then(start).into_iter().chain([phase(sequences)]);
        let phases = match task.settings.method {
            Method::Auto if !task.is_constrained() => [phase(LADDER)].into(),
            Method::Auto => {
                let first = [phase(ITERATED), phase(HELD)].into_iter();
                first.chain(from_start(Self::sequence_to_constraints(task))).collect()
            }
            Method::Continuation | Method::Matchmaker => from_start(Self::sequence_to_constraints(task)).collect(),
            Method::Iterate => [phase(ITERATED)].into(),
            Method::VirtualBoundary => [phase(BENT)].into(),
            Method::Schnyder => [phase(DRAWN)].into(),
            Method::Stretch(_) => [phase(LESS_STRETCHED)].into(),
            Method::Slim => [phase(LESS_ENERGETIC)].into(),
            Method::Lee(_) => [phase(PADDED)].into(),
            Method::Spectral => [phase(SPECTRAL)].into(),
            Method::Abf | Method::AbfPlusPlus => [phase(ANGLES)].into(),
            Method::Natural | Method::Convex(_) | Method::Lscm | Method::Levy => [phase(LINEAR)].into(),
        };
        Self { phases }
    }

    /// Strategy from a one-to-one embedding, not moved to fit, to the constraints. If it gets stuck, from the planar
    /// start.
    pub(super) fn continuing(task: &Arc<Task>, cache: &SolverCache) -> Self {
        let from_scratch_after =
            Self::from_scratch(task, cache).phases.into_iter().skip_while(|phase| phase.sequences == ITERATED);
        let continuing = PhaseState::new(task, PhaseGoal::Constraints, CONTINUING, cache);
        Self { phases: std::iter::once(continuing).chain(from_scratch_after).collect() }
    }

    /// Strategy paused between a planar start and the constraints, or at its end.
    pub(super) fn on_the_way(task: &Arc<Task>, cache: &SolverCache) -> Self {
        let phase = PhaseState::new(task, PhaseGoal::Constraints, Self::sequence_to_constraints(task), cache);
        // The fit is skipped.
        let at = StageIndex { sequence: 0, stage: 1 };
        Self { phases: [PhaseState { at, ..phase }].into() }
    }

    /// Sequences from a planar start to the constraints.
    fn sequence_to_constraints(task: &Task) -> Sequence {
        match task.settings.method {
            Method::Matchmaker => MATCHED,
            _ if task.adds_vertices() => CONTINUED_OR_MATCHED,
            _ => CONTINUED,
        }
    }

    pub(super) fn phase(&self) -> &PhaseState {
        &self.phases[0]
    }

    pub(super) fn phase_mut(&mut self) -> &mut PhaseState {
        &mut self.phases[0]
    }

    pub(super) fn has_next_phase(&self) -> bool {
        self.phases.len() > 1
    }

    pub(super) fn enter_next_phase(&mut self) {
        self.phases.pop_front();
    }

    /// True if the next phase follows once the current one has no further step.
    pub(super) fn leads_on(&self, latest: Option<&StepState>) -> bool {
        let is_end = self.phase().aim == PhaseGoal::Constraints && latest.is_some_and(StepState::is_solved);
        self.has_next_phase() && !is_end
    }
}

/// Stage, by its sequence and its place in the sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StageIndex {
    sequence: usize,
    stage: usize,
}

/// Next action of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NextStage {
    Stage(StageIndex),
    /// Relaxing, after the stages have reached the goal.
    Relax,
    /// Cut of polygons, after the stages have reached the goal except for concave polygons.
    Cut,
}

/// Phase: stages with one goal.
#[derive(Debug)]
pub(super) struct PhaseState {
    pub(super) aim: PhaseGoal,
    pub(super) task: Arc<Task>,
    pub(super) relax: Relax,
    cut: Cut,
    /// True if the phase continues from a given layout.
    pub(super) is_from_layout: bool,
    pub(super) sequences: Sequence,
    pub(super) stages: BTreeMap<StageKind, Box<dyn RunStage>>,
    /// Current stage.
    at: StageIndex,
    progress: PhaseProgress,
}

/// Steps that a phase has taken so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PhaseProgress {
    /// No step.
    NotBegun,
    /// A step of an earlier stage, and none of the current stage.
    StageEntered,
    /// A step of the current stage.
    StageStepped,
}

impl PhaseState {
    fn new(task: &Arc<Task>, aim: PhaseGoal, sequences: Sequence, cache: &SolverCache) -> Self {
        // The latest step of any phase can be iterated manually, or relaxed if it is one-to-one.
        let kinds = sequences.iter().copied().flatten().chain(&[Iterate]);
        let stages = kinds.map(|&kind| (kind, kind.stage(cache))).collect();
        Self {
            aim,
            task: Arc::clone(task),
            relax: Relax::of(aim),
            cut: Cut,
            is_from_layout: false,
            sequences,
            stages,
            at: StageIndex::default(),
            progress: PhaseProgress::NotBegun,
        }
    }

    fn kind(&self, at: StageIndex) -> StageKind {
        self.sequences[at.sequence][at.stage]
    }

    fn stage(&self, at: StageIndex) -> &dyn RunStage {
        &*self.stages[&self.kind(at)]
    }

    /// True if the phase is about to start, and not from the latest step.
    pub(super) fn begins_anew(&self) -> bool {
        self.aim == PhaseGoal::PlanarStart && self.progress == PhaseProgress::NotBegun
    }

    /// Next action. `None` at the end of the phase.
    pub(super) fn next(&self, latest: Option<&StepState>) -> Option<NextStage> {
        // The next step of the stage continues from its own previous step, not from a relaxed one.
        if self.stage(self.at).improves() {
            return Some(NextStage::Stage(self.at));
        }
        let relax = || self.relax.has_more(&self.task, latest).then_some(NextStage::Relax);
        if latest.is_some_and(StepState::is_solved) {
            return relax().or_else(|| self.drawing().filter(|_| self.is_too_fine()).map(NextStage::Stage));
        }
        // An embedding that is too fine for its place may fit there once it has relaxed.
        if latest.is_some_and(|latest| latest.attained == Attained::AllButPlace)
            && let Some(place) = relax()
        {
            return Some(place);
        }
        if latest.is_some_and(|latest| latest.attained == Attained::AllButPolygons) {
            let relaxes = self.relax.has_more(&self.task, latest).then_some(NextStage::Relax);
            let follows = relaxes.or_else(|| self.cut.has_more(&self.task, latest).then_some(NextStage::Cut));
            // Once constraints are met, no further stage follows.
            if follows.is_some() || self.task.is_constrained() {
                return follows;
            }
        }
        let (mut at, mut has_stepped) = (self.at, self.progress == PhaseProgress::StageStepped);
        while let Some(sequence) = self.sequences.get(at.sequence) {
            if self.stage(at).has_more(&self.task, latest) {
                return Some(NextStage::Stage(at));
            }
            let follows = has_stepped && at.stage + 1 < sequence.len();
            at = if follows {
                StageIndex { stage: at.stage + 1, ..at }
            } else {
                StageIndex { sequence: at.sequence + 1, stage: 0 }
            };
            has_stepped = false;
        }
        None
    }

    /// True if a planar embedding is too fine to be usable, however much it is relaxed.
    fn is_too_fine(&self) -> bool {
        self.rounds_until_it_serves() > 0 && self.relax.is_too_fine()
    }

    /// Grid drawing, if the phase has it and it is still to come: no face of it is fine.
    fn drawing(&self) -> Option<StageIndex> {
        let sequence = self.sequences.iter().position(|sequence| sequence[0] == Schnyder)?;
        let at = StageIndex { sequence, stage: 0 };
        self.stage(at).has_more(&self.task, None).then_some(at)
    }

    /// Enters the stage of an action.
    pub(super) fn enter(&mut self, place: NextStage) -> &mut dyn RunStage {
        let at = match place {
            NextStage::Relax => return &mut self.relax,
            NextStage::Cut => return &mut self.cut,
            NextStage::Stage(at) => at,
        };
        if at != self.at {
            self.go_to(at);
        }
        self.stage_of(self.kind(at))
    }

    fn go_to(&mut self, at: StageIndex) {
        self.at = at;
        if self.progress == PhaseProgress::StageStepped {
            self.progress = PhaseProgress::StageEntered;
        }
    }

    /// Stage that continues from the latest step on a manual request, even after the end of the phase.
    pub(super) fn by_hand(&mut self) -> &mut dyn RunStage {
        match self.kind(StageIndex::default()) {
            Fit | Continuation => &mut self.relax,
            // A layout that meets constraints is one-to-one.
            Given if self.task.is_constrained() => &mut self.relax,
            _ => self.stage_of(Iterate),
        }
    }

    fn stage_of(&mut self, kind: StageKind) -> &mut dyn RunStage {
        &mut **self.stages.get_mut(&kind).expect("a phase has all stages of its sequences")
    }

    /// Enters the next sequence. Returns false if there is none.
    pub(super) fn leave_sequence(&mut self, place: NextStage) -> bool {
        let has_next = matches!(place, NextStage::Stage(_)) && self.at.sequence + 1 < self.sequences.len();
        if has_next {
            self.go_to(StageIndex { sequence: self.at.sequence + 1, stage: 0 });
        }
        has_next
    }

    /// Records a step of this phase, or the adopted step of another flattener.
    pub(super) fn observe(&mut self, step: &Step) {
        self.progress = PhaseProgress::StageStepped;
        for stage in self.stages.values_mut() {
            stage.observe(step);
        }
        if step.candidate.stage == Stage::Relax {
            self.relax.observe(step);
        } else {
            let own = || {
                let method = &self.task.settings.method;
                let is_for_planar = *method == Method::Auto || method.is_one_to_one();
                let is_start = self.aim == PhaseGoal::PlanarStart;
                // The map of automatic seams has only polygons that cannot be convex, which are cut.
                let is_cut = step.candidate.stage == Stage::Seams && self.task.cuts_polygons();
                let keeps_concave = !is_for_planar || is_start || is_cut || step.verdict.concave_polygons.is_empty();
                let to_convex = if keeps_concave { 0 } else { ROUNDS_TO_CONVEX };
                self.stage(self.at).relax_rounds_after(&self.task, step).max(to_convex)
            };
            let always = self.task.settings.relax_rounds.unwrap_or_else(own);
            // An embedding in its requested place is not relaxed, to stay close to the layout.
            let is_in_place = step.is_of_planar_start() || step.unmet().is_empty();
            let stays = self.is_from_layout && is_in_place && !self.task.start_is_free;
            let until_it_serves = if stays { 0 } else { self.rounds_until_it_serves() };
            self.relax.begin(Rounds { always, until_it_serves });
            self.relax.look_at_start(step);
        }
    }

    /// Most rounds of relaxing until a planar end is usable. 0 if none are wanted.
    pub(super) fn rounds_until_it_serves(&self) -> usize {
        let settings = &self.task.settings;
        let is_wanted = settings.method == Method::Auto && settings.relax_rounds.is_none();
        if is_wanted { ROUNDS_UNTIL_IT_SERVES } else { 0 }
    }

    /// Reason for the end of the flattener if this is its last phase and its goal is not reached.
    pub(super) fn ending(&self) -> Ending {
        let last = self.sequences.iter().copied().flatten().last().expect("a phase has stages");
        self.stages[last].ending(&self.task)
    }
}
