//! Rung 4: a planar start without the constraints, moved to where it fits them best, then one-to-one on the way to them.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::plan::PlanarStart;
use super::rung::{Failure, Footing, Handover, Latest, Rung};
use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::geom::Similarity;
use crate::mesh::DiskMesh;
use crate::solver::continuation::Continuation;
use crate::solver::{Control, Embedding, Method, Pins, SolveError, is_one_to_one};

/// Rounds of relaxing that follow: the first answer is not the best. More where springs have yet to pull.
const ROUNDS: usize = 3;
const ROUNDS_WITH_SPRINGS: usize = 30;

fn rounds_after(task: &Task) -> usize {
    if task.held().values().any(|pin| !pin.hold.is_exact()) { ROUNDS_WITH_SPRINGS } else { ROUNDS }
}

/// The planar start, moved.
#[derive(Debug)]
pub(super) struct Fit {
    /// Kept from an earlier ladder; otherwise the latest step is the start.
    pub(super) start: Option<Arc<PlanarStart>>,
    pub(super) is_done: bool,
}

impl Rung for Fit {
    fn step(&mut self, Footing { task, mesh, latest }: Footing<'_>, _: Control<'_>) -> Result<Candidate, Failure> {
        let began = Instant::now();
        let of_latest = || {
            let embedding = latest?.embedding.clone();
            Some(Arc::new(PlanarStart { size: task.settings.size, embedding }))
        };
        let start = self.start.clone().or_else(of_latest).ok_or(SolveError::NotPlanar)?;
        let held = task.held();
        let embedding = fitted(mesh, start.embedding.clone(), &held);
        self.is_done = true;
        let progress = Continuation::new(mesh, embedding.clone(), &held).progress(mesh);
        let candidate = Candidate::one_to_one(Method::Continuation, embedding, &held);
        Ok(Candidate { progress: Some(progress), planar_start: Some(start), ..candidate.since(began) })
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, task: &Task, _: &Step) -> usize {
        rounds_after(task)
    }
}

/// An embedding moved by the similarity that fits the pins best; by a shift alone where none does, or where rounding
/// would fold it; not at all where even that would.
fn fitted(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Embedding {
    let pairs: Vec<[DVec2; 2]> = pins.iter().map(|(v, pin)| [embedding[v], pin.target]).collect();
    let holds = |embedding: &Embedding| is_one_to_one(mesh, embedding);
    let fit = |similarity: Similarity| embedding.iter().map(|&z| similarity.apply(z)).collect::<Embedding>();
    if let Some(embedding) = Similarity::fitting(&pairs).map(fit).filter(holds) {
        return embedding;
    }
    let shift = pairs.iter().map(|[is, wanted]| *wanted - *is).sum::<DVec2>() / pairs.len().max(1) as f64;
    let shifted = embedding.iter().map(|&z| z + shift).collect::<Embedding>();
    if holds(&shifted) { shifted } else { embedding }
}

#[derive(Debug, Default)]
pub(super) struct Continue {
    stage: Stage,
}

#[derive(Debug, Default)]
enum Stage {
    #[default]
    Begin,
    UnderWay(Box<Continuation>),
    /// No step leads nearer to the targets.
    Stuck,
}

impl Rung for Continue {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let Footing { task, mesh, latest } = from;
        let (began, held) = (Instant::now(), task.held());
        if let Stage::Begin = self.stage {
            let start = latest.ok_or(SolveError::NotPlanar)?.embedding.clone();
            self.stage = Stage::UnderWay(Box::new(Continuation::new(mesh, start, &held)));
        }
        let Stage::UnderWay(continuation) = &mut self.stage else { return Err(SolveError::Unmet.into()) };
        match continuation.step(mesh, control) {
            Ok(candidate) => return Ok(candidate.since(began)),
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
            // What cannot be solved is stuck, too.
            Err(_) => {}
        }
        let is_crushed = continuation.go_back_to_sound();
        let (embedding, progress) = (continuation.embedding.clone(), continuation.progress(mesh));
        self.stage = Stage::Stuck;
        if is_crushed && !task.adds_vertices() {
            let candidate = Candidate::one_to_one(Method::Continuation, embedding, &held).since(began);
            return Ok(Candidate { progress: Some(progress), ..candidate });
        }
        let handover = Handover { embedding: Some(embedding), ..Handover::default() };
        Err(Failure { error: SolveError::Unmet, handover: Some(handover) })
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        true
    }

    fn relax_rounds_after(&self, task: &Task, _: &Step) -> usize {
        rounds_after(task)
    }

    fn ending(&self, _: &Task) -> Ending {
        Ending::Unmet
    }
}
