//! The planar morph between the maps of two methods that are compared: found and proved in the background, once both have run
//! and nothing else does. It belongs to these very maps: where one of them is solved again, the morph goes, and is found anew.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Background, Compared, MORPH_FRAMES, MissingLeg, Model, MorphShortage, MorphStops, MorphTour, Wake};
use freebound_core::problem::{Control, Phase, Variant};

/// The maps of a morph.
pub(super) type Ends = [Arc<Compared>; 2];

/// What is known of the morph that is wanted.
#[derive(Clone, Debug, Default)]
pub enum MorphState {
    /// None is wanted, or its methods have yet to run.
    #[default]
    Waiting,
    /// It is being found: what is done, and how many frames were looked at so far, on whatever way.
    Running(Option<Phase>, usize),
    /// It is there: a tour from the one map to the other.
    Done(Arc<MorphTour>),
    /// There is none, for this reason.
    Failed(String),
    /// It is not sought: its frames would take too much memory.
    TooLarge(MorphShortage),
}

/// The morph that is wanted.
pub(super) struct Morphing {
    wake: Wake,
    between: Option<[Variant; 2]>,
    /// The maps that the state is of.
    ends: Option<Ends>,
    job: Background<(), Result<MorphTour, MissingLeg>>,
    progress: Arc<Mutex<Progress>>,
    state: MorphState,
}

/// What the background does.
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

    /// Drops what was found, or is being found.
    fn forget(&mut self) {
        self.job.cancel();
        (self.ends, self.state) = (None, MorphState::Waiting);
    }

    /// Takes in what the background has found.
    pub(super) fn poll(&mut self) {
        let Some(((), outcome)) = self.job.poll() else { return };
        self.state = match outcome {
            Ok(Ok(tour)) => MorphState::Done(Arc::new(tour)),
            Ok(Err(missing)) => MorphState::Failed(missing.reason.to_string()),
            Err(failure) => MorphState::Failed(failure.words("the morph")),
        };
    }

    /// Finds the morph between two maps of a model's disk.
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

    /// The methods whose maps are wanted as ends.
    pub(super) fn between(&self) -> Option<[Variant; 2]> {
        self.between.clone()
    }

    /// Wants the morph between two methods, or none any more.
    pub(super) fn want(&mut self, between: Option<[Variant; 2]>) {
        if self.between != between {
            self.between = between;
            self.forget();
        }
    }

    /// Drops what belongs to other maps than these.
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

    /// Refuses the morph between two maps.
    pub(super) fn refuse(&mut self, state: MorphState, ends: Ends) {
        (self.state, self.ends) = (state, Some(ends));
    }
}

/// Why no morph between two maps is sought within half of this memory, bytes; none where one is.
pub(super) fn refused(model: &Model, ends: &Ends, memory: Option<u64>) -> Option<MorphState> {
    let stops = MorphStops::of(&[&ends[0], &ends[1]]);
    if let Some(left_out) = stops.left_out.first() {
        return Some(MorphState::Failed(format!("{}: {}", left_out.name, left_out.why)));
    }
    stops.check_memory(model.disk()?, MORPH_FRAMES, memory).err().map(MorphState::TooLarge)
}
