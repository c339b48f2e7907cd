//! A planar start without the constraints, moved to where it fits them best.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::continuation::relax_rounds_after_continuation;
use super::plan::PlanarStart;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::geom::Similarity;
use crate::mesh::DiskMesh;
use crate::solver::continuation::Continuation;
use crate::solver::{Control, Embedding, Method, Pins, SolveError, verdict};

#[derive(Debug)]
pub(super) struct Fit {
    task: Arc<Task>,
    /// Kept from an earlier ladder; otherwise the latest step is the start.
    start: Option<Arc<PlanarStart>>,
    is_done: bool,
}

impl Fit {
    pub(super) fn new(task: Arc<Task>, start: Option<Arc<PlanarStart>>) -> Self {
        Self { task, start, is_done: false }
    }
}

impl Rung for Fit {
    fn step(&mut self, Footing { mesh, latest }: Footing<'_>, _: Control<'_>) -> Result<Candidate, Failure> {
        let began = Instant::now();
        let of_latest = || {
            let embedding = latest?.embedding.clone();
            Some(Arc::new(PlanarStart { size: self.task.settings.size, embedding }))
        };
        let start = self.start.clone().or_else(of_latest).ok_or(SolveError::NotPlanar)?;
        let held = self.task.held();
        let embedding = fitted(mesh, start.embedding.clone(), &held);
        self.is_done = true;
        let progress = Continuation::new(mesh, embedding.clone(), &held).progress(mesh);
        let candidate = Candidate::one_to_one(Method::Continuation, embedding, &held);
        Ok(Candidate { progress: Some(progress), planar_start: Some(start), ..candidate.since(began) })
    }

    fn has_more(&self, _: Option<&Latest>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, _: &Step) -> usize {
        relax_rounds_after_continuation(&self.task)
    }

    fn ending(&self) -> Ending {
        Ending::Unmet
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
