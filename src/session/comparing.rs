//! Methods that are compared on the shown mesh, one after the other in the background, with the document's pins and
//! settings. If pins or settings change, all methods run again. Their former results stay available until then.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Background, Compared, Model, Wake};
use freebound_core::pipeline::Problem;
use freebound_core::problem::{Control, Phase, SolveError, Variant};

/// Methods that are compared.
pub(super) struct Comparing {
    wake: Wake,
    contenders: Vec<Contender>,
    /// Revision of the mesh that the methods run on.
    model: Option<u64>,
    running: Option<Running>,
    /// Number of changes of the results.
    revision: u64,
}

/// A method in a comparison.
#[derive(Debug)]
pub struct Contender {
    variant: Variant,
    state: State,
    /// Last result. Its pins and settings may be outdated.
    found: Option<Arc<Compared>>,
}

/// Progress of a method with a problem.
#[derive(Debug)]
enum State {
    /// The method waits for its turn.
    Waiting,
    /// The method is running.
    Running,
    /// The method has ended. The result holds the problem.
    Done,
    /// The thread of this problem was lost, with this message.
    Lost(Box<Problem>, String),
}

/// State of a method relative to the document.
#[derive(Clone, Debug, PartialEq)]
pub enum ContenderState {
    /// The method waits for its turn.
    Waiting,
    /// The method is running, in this phase and with this number of finished steps.
    Running(Option<Phase>, usize),
    /// The result belongs to the document.
    Done,
    /// No result can be found, for this reason.
    Lost(String),
}

impl Contender {
    /// The method.
    pub fn variant(&self) -> Variant {
        self.variant.clone()
    }

    /// Last result. Unless the method is done, its pins and settings are outdated.
    pub fn found(&self) -> Option<&Arc<Compared>> {
        self.found.as_ref()
    }
}

/// A method that runs in the background.
struct Running {
    variant: Variant,
    job: Background<Problem, Result<Compared, SolveError>>,
    progress: Arc<Mutex<RunProgress>>,
}

/// Progress of the background thread.
#[derive(Clone, Copy, Debug, Default)]
struct RunProgress {
    phase: Option<Phase>,
    steps: usize,
}

impl Comparing {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { wake: Arc::clone(wake), contenders: Vec::new(), model: None, running: None, revision: 0 }
    }

    /// Sets the methods to compare, in this order. An empty list ends the comparison. Known results are kept.
    pub(super) fn choose(&mut self, variants: &[Variant]) {
        let mut before = std::mem::take(&mut self.contenders);
        for variant in variants {
            if self.contenders.iter().any(|contender| contender.variant == *variant) {
                continue;
            }
            let place = before.iter().position(|contender| contender.variant == *variant);
            let new = || Contender { variant: variant.clone(), state: State::Waiting, found: None };
            self.contenders.push(place.map_or_else(new, |place| before.swap_remove(place)));
        }
        self.running = self.running.take().filter(|running| variants.contains(&running.variant));
        self.revision += 1;
    }

    /// Drops all results if another mesh is open.
    pub(super) fn follow_mesh(&mut self, revision: u64) {
        if self.model.replace(revision) != Some(revision) {
            self.running = None;
            for contender in &mut self.contenders {
                (contender.state, contender.found) = (State::Waiting, None);
            }
            self.revision += 1;
        }
    }

    /// Marks the methods whose problem has changed to run again.
    pub(super) fn restart_outdated(&mut self, problem: &Problem) {
        let of = |variant: &Variant| problem.by(variant);
        let is_outdated = |running: &mut Running| {
            let is_of_problem = running.job.key().is_some_and(|key| key.has_steps_of(&of(&running.variant)));
            !is_of_problem
        };
        self.running.take_if(is_outdated);
        let running = self.running.as_ref().map(|running| running.variant.clone());
        for contender in &mut self.contenders {
            let wanted = of(&contender.variant);
            let is_right = match &contender.state {
                State::Waiting => true,
                State::Running => running == Some(contender.variant.clone()),
                State::Done => contender.found.as_ref().is_some_and(|found| found.problem.has_steps_of(&wanted)),
                State::Lost(lost, _) => lost.has_steps_of(&wanted),
            };
            if !is_right {
                contender.state = State::Waiting;
            }
        }
    }

    /// Stores the result of the run that has ended.
    pub(super) fn poll(&mut self) {
        let Some(running) = &mut self.running else { return };
        let Some((problem, outcome)) = running.job.poll() else { return };
        let variant = running.variant.clone();
        self.running = None;
        self.revision += 1;
        let Some(contender) = self.contenders.iter_mut().find(|contender| contender.variant == variant) else { return };
        (contender.state, contender.found) = match outcome {
            Ok(Ok(compared)) => (State::Done, Some(Arc::new(compared))),
            // Cancelled. Nothing waits for a cancelled run.
            Ok(Err(_)) => (State::Waiting, contender.found.take()),
            Err(failure) => (State::Lost(Box::new(problem), failure.words(variant.method.words())), None),
        };
    }

    /// Starts the next method, unless a method is running.
    pub(super) fn begin_next(&mut self, model: &Arc<Model>, problem: &Problem) {
        if self.running.is_some() {
            return;
        }
        let is_waiting = |contender: &&mut Contender| matches!(contender.state, State::Waiting);
        let Some(next) = self.contenders.iter_mut().find(is_waiting) else { return };
        next.state = State::Running;
        let (variant, problem, model) = (next.variant.clone(), problem.by(&next.variant), Arc::clone(model));
        let progress = Arc::new(Mutex::new(RunProgress::default()));
        let mut job = Background::new("compare", &self.wake);
        let (of_job, of_run, wake) = (Arc::clone(&progress), problem.clone(), Arc::clone(&self.wake));
        job.start(problem, move |cancel: &AtomicBool| {
            let note = |change: &dyn Fn(&mut RunProgress)| {
                change(&mut of_job.lock().unwrap_or_else(PoisonError::into_inner));
                wake();
            };
            let report = |phase: Phase| note(&|progress| progress.phase = Some(phase));
            Compared::run(&model, of_run, Control::new(cancel, &report), |_| note(&|progress| progress.steps += 1))
        });
        self.running = Some(Running { variant, job, progress });
        self.revision += 1;
    }

    /// Methods in the order in which they were chosen.
    pub(super) fn contenders(&self) -> &[Contender] {
        &self.contenders
    }

    /// Number of changes of the results.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// True if a method waits or is running.
    pub(super) fn is_open(&self) -> bool {
        self.contenders.iter().any(|contender| matches!(contender.state, State::Waiting | State::Running))
    }

    /// State of a method. A finished method counts as done only if `is_at_rest`.
    pub(super) fn state_of(&self, contender: &Contender, is_at_rest: bool) -> ContenderState {
        match &contender.state {
            State::Running => {
                let running = self.running.as_ref().filter(|of| of.variant == contender.variant);
                let progress = running.map(|of| *of.progress.lock().unwrap_or_else(PoisonError::into_inner));
                let RunProgress { phase, steps } = progress.unwrap_or_default();
                ContenderState::Running(phase, steps)
            }
            State::Done if is_at_rest => ContenderState::Done,
            State::Lost(_, words) => ContenderState::Lost(words.clone()),
            State::Done | State::Waiting => ContenderState::Waiting,
        }
    }
}
