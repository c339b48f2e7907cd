//! The last rungs of the ladder, where there are constraints: a planar start without them, continuation, new vertices.

use std::sync::Arc;

use glam::DVec2;

use super::continuation::{Accepted, Continuation};
use super::matchmaker::{Matched, matched, without_needless_vertices};
use super::relaxing::Relaxing;
use super::{
    Conflict, Control, Embedding, Ladder, Method, Outside, Pins, Progress, Settings, SolveError, Step, check_pins,
    conflicts, verdict,
};
use crate::geom::Similarity;
use crate::mesh::{DiskMesh, Refinement};

/// Rounds of relaxing before new vertices are looked at again, and how often they are at most.
const ROUNDS_BEFORE_REMOVAL: usize = 10;
const REMOVALS: usize = 4;

/// Another look at the new vertices is worthwhile where the last one took out so great a part of them.
const WORTHWHILE: f64 = 0.05;

/// Rungs 4 and 5 on the way.
#[derive(Debug)]
pub(super) struct ConstrainedRun {
    settings: Settings,
    pins: Pins,
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    /// Nothing is done yet.
    Begin,
    /// Rung 4, which may still arrive.
    Continuation(Box<Continuation>),
    /// Rung 4 cannot arrive, and new vertices are not wanted.
    Stuck,
    /// Rung 5 is next, from a planar embedding.
    Matchmaker(Embedding),
    /// The constraints are met with new vertices, some of which may be needless once the embedding has relaxed.
    Refined(Box<Matched>, usize),
    /// There is no further step.
    End,
}

/// A planar embedding that one of the rungs came to.
#[derive(Debug)]
pub(super) struct Reached {
    pub(super) rung: Method,
    pub(super) embedding: Embedding,
    pub(super) progress: Option<Progress>,
    pub(super) outside: Option<Arc<Outside>>,
    pub(super) refinement: Option<Arc<Refinement>>,
}

impl Reached {
    fn with_new_vertices(Matched { refinement, embedding }: Matched) -> Self {
        let (rung, refinement) = (Method::Matchmaker, Some(Arc::new(refinement)));
        Self { rung, embedding, progress: None, outside: None, refinement }
    }
}

impl ConstrainedRun {
    /// Nothing done yet. `pins` are held as the treatment holds them.
    pub(super) fn new(settings: &Settings, pins: &Pins) -> Self {
        Self { settings: *settings, pins: settings.held(pins), stage: Stage::Begin }
    }

    /// Whether there is no further step.
    pub(super) fn is_exhausted(&self) -> bool {
        matches!(self.stage, Stage::End)
    }

    /// The next planar embedding.
    pub(super) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Reached, SolveError> {
        match &mut self.stage {
            Stage::Begin => self.begin(mesh, control),
            Stage::Continuation(_) => self.go_on(mesh, control),
            Stage::Stuck => {
                self.stage = Stage::End;
                Err(SolveError::Unmet)
            }
            Stage::Matchmaker(start) => {
                let found = without_needless_vertices(mesh, matched(mesh, start, &self.pins, control)?);
                self.stage = Stage::Refined(Box::new(found.clone()), REMOVALS);
                Ok(Reached::with_new_vertices(found))
            }
            Stage::Refined(found, looks_left) => {
                let before = found.refinement.new_vertices().len();
                let found = without_needless_vertices(mesh, relaxed(found, &self.pins, control)?);
                let taken_out = before - found.refinement.new_vertices().len();
                let is_worthwhile = taken_out as f64 > WORTHWHILE * before as f64 && *looks_left > 1;
                let next = || Stage::Refined(Box::new(found.clone()), *looks_left - 1);
                self.stage = if is_worthwhile { next() } else { Stage::End };
                Ok(Reached::with_new_vertices(found))
            }
            Stage::End => Err(SolveError::Unmet),
        }
    }

    /// One step of continuation; where it is stuck, what comes then.
    fn go_on(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Reached, SolveError> {
        let Stage::Continuation(continuation) = &mut self.stage else { return Err(SolveError::Unmet) };
        let rung = Method::Continuation;
        match continuation.step(mesh, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Ok(Some(Accepted { embedding, progress, outside })) => {
                if continuation.has_arrived() {
                    self.stage = Stage::End;
                }
                let (progress, outside) = (Some(progress), Some(outside));
                return Ok(Reached { rung, embedding, progress, outside, refinement: None });
            }
            // What cannot be solved is stuck, too.
            Ok(None) | Err(_) => {}
        }
        let is_crushed = continuation.go_back_to_sound();
        let (embedding, progress) = (continuation.embedding().clone(), Some(continuation.progress(mesh)));
        if self.settings.method == Method::Auto && self.settings.new_vertices {
            self.stage = Stage::Matchmaker(embedding);
            return self.step(mesh, control);
        }
        self.stage = Stage::Stuck;
        if !is_crushed {
            return self.step(mesh, control);
        }
        Ok(Reached { rung, embedding, progress, outside: None, refinement: None })
    }

    /// The planar start, moved to where it fits the targets best.
    fn begin(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Reached, SolveError> {
        check_pins(mesh, &self.pins)?;
        check_distances(mesh, &self.pins)?;
        let embedding = fitted(mesh, planar_start(mesh, &self.settings, control)?, &self.pins);
        let continuation = Continuation::new(mesh, embedding.clone(), &self.pins);
        let progress = Some(continuation.progress(mesh));
        self.stage = match self.settings.method {
            _ if continuation.has_arrived() => Stage::End,
            Method::Matchmaker => Stage::Matchmaker(embedding.clone()),
            _ => Stage::Continuation(Box::new(continuation)),
        };
        Ok(Reached { rung: Method::Continuation, embedding, progress, outside: None, refinement: None })
    }
}

/// The same with its embedding relaxed.
fn relaxed(found: &Matched, pins: &Pins, control: Control<'_>) -> Result<Matched, SolveError> {
    let disk = found.refinement.disk();
    let mut relaxing = Relaxing::new(disk, found.embedding.clone(), pins);
    let mut embedding = found.embedding.clone();
    for _ in 0..ROUNDS_BEFORE_REMOVAL {
        embedding = relaxing.round(disk, control)?.embedding;
        if relaxing.has_converged() {
            break;
        }
    }
    Ok(Matched { refinement: found.refinement.clone(), embedding })
}

/// Checks that no two exact targets are so near that numbers between them run out.
pub(super) fn check_distances(mesh: &DiskMesh, pins: &Pins) -> Result<(), SolveError> {
    for conflict in conflicts(mesh, pins) {
        if let Conflict::TooNear { vertices: [first, second] } = conflict {
            return Err(SolveError::TargetsTooNear { first, second });
        }
    }
    Ok(())
}

/// A planar embedding without the constraints, by the ladder.
fn planar_start(mesh: &DiskMesh, settings: &Settings, control: Control<'_>) -> Result<Embedding, SolveError> {
    let unconstrained = Settings { size: settings.size, ..Settings::default() };
    let mut planar: Option<Step> = None;
    let result = Ladder::new(unconstrained, Pins::new()).finish(mesh, control, |step| {
        if step.verdict.planar {
            planar = Some(step);
        }
    });
    match (result, planar) {
        (Err(SolveError::Cancelled), _) => Err(SolveError::Cancelled),
        (_, Some(step)) => Ok(step.solution.embedding),
        (Err(error), None) => Err(error),
        (Ok(_), None) => Err(SolveError::LadderExhausted),
    }
}

/// An embedding moved by the similarity that fits the pins best; by a shift alone where none does, or where rounding
/// would fold it; not at all where even that would.
fn fitted(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Embedding {
    let pairs: Vec<[DVec2; 2]> = pins.iter().map(|(v, pin)| [embedding[v], pin.target]).collect();
    let is_planar = |embedding: &Embedding| verdict(mesh, embedding).planar;
    let fit = |similarity: Similarity| embedding.iter().map(|&z| similarity.apply(z)).collect::<Embedding>();
    if let Some(embedding) = Similarity::fitting(&pairs).map(fit).filter(is_planar) {
        return embedding;
    }
    let shift = pairs.iter().map(|[is, wanted]| *wanted - *is).sum::<DVec2>() / pairs.len().max(1) as f64;
    let shifted = embedding.iter().map(|&z| z + shift).collect::<Embedding>();
    if is_planar(&shifted) { shifted } else { embedding }
}
