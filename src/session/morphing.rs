//! Planar morph between the maps of two compared methods. The background finds and proves it once both methods have run
//! and nothing else is running. If a method is solved again, its morph is dropped and found again.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Background, Compared, MORPH_FRAMES, MissingLeg, Model, MorphShortage, MorphStops, MorphTour, Wake};
use freebound_core::problem::{Control, Phase, Variant};

/// Results of the methods at both ends of a morph.
pub(super) type Ends = [Arc<Compared>; 2];

/// State of the requested morph.
#[derive(Clone, Debug, Default)]
pub enum MorphState {
    /// No morph is requested, or its methods have not run yet.
    #[default]
    Waiting,
    /// The morph is being found: the current phase, and the number of frames verified so far on all routes.
    Running(Option<Phase>, usize),
    /// The morph is found: a tour between the two maps.
    Done(Arc<MorphTour>),
    /// There is no morph, for this reason.
    Failed(String),
    /// The morph is not computed, because its frames would take too much memory.
    TooLarge(MorphShortage),
}

/// Requested morph.
pub(super) struct Morphing {
    wake: Wake,
    between: Option<[Variant; 2]>,
    /// Ends that the state belongs to.
    ends: Option<Ends>,
    job: Background<(), Result<MorphTour, MissingLeg>>,
    progress: Arc<Mutex<Progress>>,
    state: MorphState,
}

/// Progress of the background thread.
#[derive(Clone, Copy, Debug, Default)]
struct Progress {
    phase: Option<Phase>,
    frames: usize,
}

impl Morphing {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            wake: Arc::clone(wake),
            between: None,
            ends: None,
            job: Background::new("morph", wake),
            progress: Arc::default(),
            state: MorphState::Waiting,
        }
    }

    pub(super) fn is_running(&self) -> bool {
        self.job.is_busy()
    }

    /// Drops the morph and cancels its search.
    fn forget(&mut self) {
        self.job.cancel();
        (self.ends, self.state) = (None, MorphState::Waiting);
    }

    /// Stores the result of the search.
    pub(super) fn poll(&mut self) {
        let Some(((), outcome)) = self.job.poll() else { return };
        self.state = match outcome {
            Ok(Ok(tour)) => MorphState::Done(Arc::new(tour)),
            Ok(Err(missing)) => MorphState::Failed(missing.reason.to_string()),
            Err(failure) => MorphState::Failed(failure.words("the morph")),
        };
    }

    /// Starts the search for a morph between two maps of a model's disk.
    pub(super) fn begin(&mut self, model: Arc<Model>, ends: Ends) {
        let progress = Arc::new(Mutex::new(Progress::default()));
        let (of_job, wake) = (Arc::clone(&progress), Arc::clone(&self.wake));
        let maps = ends.clone();
        self.job.start((), move |cancel: &AtomicBool| {
            let report = |phase: Phase| {
                let mut progress = of_job.lock().unwrap_or_else(PoisonError::into_inner);
                progress.phase = Some(phase);
                progress.frames += usize::from(phase == Phase::Verify);
                drop(progress);
                wake();
            };
            let mesh = model.disk().expect("methods run on disks only");
            let stops = MorphStops::of(&[&maps[0], &maps[1]]);
            MorphTour::through(mesh, stops, MORPH_FRAMES, Control::new(cancel, &report))
        });
        (self.progress, self.ends) = (progress, Some(ends));
    }

    /// The state of the morph.
    pub(super) fn state(&self) -> MorphState {
        if self.is_running() {
            let Progress { phase, frames } = *self.progress.lock().unwrap_or_else(PoisonError::into_inner);
            return MorphState::Running(phase, frames);
        }
        self.state.clone()
    }

    /// Methods at the ends of the requested morph.
    pub(super) fn between(&self) -> Option<[Variant; 2]> {
        self.between.clone()
    }

    /// Requests the morph between two methods, or ends it.
    pub(super) fn want(&mut self, between: Option<[Variant; 2]>) {
        if self.between != between {
            self.between = between;
            self.forget();
        }
    }

    /// Drops the morph unless it belongs to these ends.
    pub(super) fn keep_of(&mut self, now: Option<&Ends>) {
        let is_of = |[a, b]: &Ends, [c, d]: &Ends| Arc::ptr_eq(a, c) && Arc::ptr_eq(b, d);
        if self.ends.as_ref().is_some_and(|of| now.is_none_or(|now| !is_of(of, now))) {
            self.forget();
        }
    }

    /// True if the morph was neither begun nor refused.
    pub(super) fn is_open(&self) -> bool {
        self.ends.is_none()
    }

    /// Stores the reason for not computing the morph.
    pub(super) fn refuse(&mut self, state: MorphState, ends: Ends) {
        (self.state, self.ends) = (state, Some(ends));
    }
}

/// Reason for not computing a morph within half of `memory`, bytes. `None` if it can be computed.
pub(super) fn refused(model: &Model, ends: &Ends, memory: Option<u64>) -> Option<MorphState> {
    let stops = MorphStops::of(&[&ends[0], &ends[1]]);
    if let Some(left_out) = stops.left_out.first() {
        return Some(MorphState::Failed(format!("{}: {}", left_out.name, left_out.why)));
    }
    stops.check_memory(model.disk()?, MORPH_FRAMES, memory).err().map(MorphState::TooLarge)
}
