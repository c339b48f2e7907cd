//! The last rungs of the ladder, where there are constraints: a planar start without them, continuation, new vertices.

use std::sync::Arc;

use glam::DVec2;

use super::continuation::{Accepted, Continuation};
use super::matchmaker::{Matched, matched};
use super::{Control, Method, Outside, Pins, Progress, Run, Settings, SolveError, Step};
use crate::geom::Similarity;
use crate::mesh::{DiskMesh, Refinement};

/// Rungs 4 and 5 on the way.
#[derive(Debug)]
pub(super) struct ConstrainedRun {
    settings: Settings,
    pins: Pins,
    continuation: Option<Continuation>,
    is_exhausted: bool,
}

/// A planar embedding that one of the rungs came to.
#[derive(Debug)]
pub(super) struct Reached {
    pub(super) rung: Method,
    pub(super) embedding: Vec<DVec2>,
    pub(super) progress: Option<Progress>,
    pub(super) outside: Option<Arc<Outside>>,
    pub(super) refinement: Option<Arc<Refinement>>,
}

impl ConstrainedRun {
    /// Nothing done yet. `pins` are held as the treatment holds them.
    pub(super) fn new(settings: &Settings, pins: &Pins) -> Self {
        Self { settings: *settings, pins: settings.held(pins), continuation: None, is_exhausted: false }
    }

    /// Whether there is no further step.
    pub(super) fn is_exhausted(&self) -> bool {
        self.is_exhausted
    }

    /// The next planar embedding.
    pub(super) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Reached, SolveError> {
        if self.settings.method == Method::Matchmaker {
            let start = fitted(planar_start(mesh, &self.settings, control)?, &self.pins);
            let Matched { refinement, embedding } = matched(mesh, &start, &self.pins, control)?;
            self.is_exhausted = true;
            let (rung, refinement) = (Method::Matchmaker, Some(Arc::new(refinement)));
            return Ok(Reached { rung, embedding, progress: None, outside: None, refinement });
        }
        let Some(continuation) = &mut self.continuation else {
            let start = planar_start(mesh, &self.settings, control)?;
            let embedding = fitted(start, &self.pins);
            self.continuation = Some(Continuation::new(mesh, embedding.clone(), &self.pins));
            let rung = Method::Continuation;
            return Ok(Reached { rung, embedding, progress: None, outside: None, refinement: None });
        };
        if let Some(Accepted { embedding, progress, outside }) = continuation.step(mesh, control)? {
            self.is_exhausted = continuation.has_arrived();
            let (progress, outside) = (Some(progress), Some(outside));
            return Ok(Reached { rung: Method::Continuation, embedding, progress, outside, refinement: None });
        }
        self.is_exhausted = true;
        Err(SolveError::Unmet)
    }
}

/// A planar embedding without the constraints, by the ladder.
fn planar_start(mesh: &DiskMesh, settings: &Settings, control: Control<'_>) -> Result<Vec<DVec2>, SolveError> {
    let unconstrained = Settings { size: settings.size, ..Settings::default() };
    let mut last: Option<Step> = None;
    Run::new(unconstrained, Pins::new()).finish(mesh, control, |step| last = Some(step))?;
    match last {
        Some(step) if step.verdict.planar => Ok(step.solution.embedding),
        _ => Err(SolveError::LadderExhausted),
    }
}

/// An embedding moved by the similarity that fits the pins best; by a shift alone where none does.
fn fitted(embedding: Vec<DVec2>, pins: &Pins) -> Vec<DVec2> {
    let pairs: Vec<[DVec2; 2]> = pins.iter().map(|(v, pin)| [embedding[v.index()], pin.target]).collect();
    if let Some(similarity) = Similarity::fitting(&pairs) {
        return embedding.into_iter().map(|z| similarity.apply(z)).collect();
    }
    let shift = pairs.iter().map(|[is, wanted]| *wanted - *is).sum::<DVec2>() / pairs.len().max(1) as f64;
    embedding.into_iter().map(|z| z + shift).collect()
}
