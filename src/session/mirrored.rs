//! Whether the targets are mirrored: a reflection then fits them much better than a rotation.
//!
//! An embedding keeps the faces' orientation, so mirrored targets can hardly be met, and never well. What the targets are
//! compared with is the mesh flattened without pins, once, in the background.

use std::sync::Arc;

use glam::DVec2;

use super::{Job, JobContext, Poll, Session};
use crate::geom::Similarity;
use crate::solver::{Control, Embedding, Family, Method, Pins, Settings, SolveError, flatten};

/// With fewer pins either fits.
const LEAST_PINS: usize = 3;

/// A reflection fits much better where it leaves less than this part of what a rotation leaves.
const MUCH_BETTER: f64 = 0.5;

/// The mesh flattened without pins, by the mesh's revision.
#[derive(Default)]
pub(super) struct Undistorted {
    /// None where it cannot be flattened.
    embedding: Option<(u64, Option<Embedding>)>,
    job: Option<(u64, FlatJob)>,
}

/// Flattens in the background.
type FlatJob = Job<(), Result<Embedding, SolveError>>;

impl Session {
    /// Whether the targets of the document look mirrored: known only some time after there are enough of them.
    pub fn targets_look_mirrored(&self) -> bool {
        let (pins, uses_pins) = (self.document.pins(), self.document.settings.method.uses_pins());
        let Some((revision, Some(embedding))) = &self.undistorted.embedding else { return false };
        if *revision != self.model_revision || pins.len() < LEAST_PINS || !uses_pins {
            return false;
        }
        let pairs = pins.iter().filter_map(|(vertex, pin)| Some([*embedding.get(vertex.index())?, pin.target]));
        look_mirrored(&pairs.collect::<Vec<_>>())
    }

    /// Flattens the mesh where there are targets to compare with it, and takes in what was flattened.
    pub(super) fn poll_undistorted(&mut self) {
        if let Some((revision, job)) = &self.undistorted.job {
            let embedding = match job.poll() {
                Poll::Running => return,
                Poll::Lost => None,
                Poll::Done(embedding) => embedding.ok(),
            };
            self.undistorted = Undistorted { embedding: Some((*revision, embedding)), job: None };
        }
        let revision = self.model_revision;
        let is_known = self.undistorted.embedding.as_ref().is_some_and(|(of, _)| *of == revision);
        let disk = self.model.as_ref().and_then(|model| model.disk());
        let Some(disk) = disk.filter(|_| !is_known && self.document.targets.len() >= LEAST_PINS) else { return };
        let disk = Arc::clone(disk);
        let work = move |context: &JobContext<()>| {
            let control = Control::new(context.cancel_flag(), &|_| {});
            let settings = Settings::new(Method::Natural, Family::Conformal);
            flatten(&disk, &settings, &Pins::new(), control).map(|solution| solution.embedding)
        };
        self.undistorted = match Job::spawn("undistorted", self.waker(), work) {
            Ok(job) => Undistorted { embedding: self.undistorted.embedding.take(), job: Some((revision, job)) },
            // Without a thread nobody asks.
            Err(_) => Undistorted { embedding: Some((revision, None)), job: None },
        };
    }
}

/// Whether a reflection takes the first of each pair much nearer to the second than a rotation does.
fn look_mirrored(pairs: &[[DVec2; 2]]) -> bool {
    let mirrored: Vec<[DVec2; 2]> = pairs.iter().map(|[z, target]| [DVec2::new(-z.x, z.y), *target]).collect();
    Similarity::fitting(&mirrored).is_some_and(|best| best.error(&mirrored) < MUCH_BETTER * error_of(pairs))
}

/// What the similarity without reflection that fits best leaves; where none fits, what one place for all leaves.
fn error_of(pairs: &[[DVec2; 2]]) -> f64 {
    if let Some(best) = Similarity::fitting(pairs) {
        return best.error(pairs);
    }
    let middle = pairs.iter().map(|[_, target]| *target).sum::<DVec2>() / pairs.len() as f64;
    let squares: f64 = pairs.iter().map(|[_, target]| target.distance_squared(middle)).sum();
    (squares / pairs.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(1.9, 1.0), DVec2::new(-0.2, 1.3)];

    fn to(map: impl Fn(DVec2) -> DVec2) -> Vec<[DVec2; 2]> {
        CORNERS.iter().map(|&z| [z, map(z)]).collect()
    }

    #[test]
    fn what_is_turned_does_not_look_mirrored() {
        let turn = DVec2::new(0.3, -1.2);
        assert!(!look_mirrored(&to(|z| turn.rotate(z) + DVec2::ONE)));
    }

    #[test]
    fn what_is_mirrored_does() {
        let turn = DVec2::new(0.3, -1.2);
        assert!(look_mirrored(&to(|z| turn.rotate(DVec2::new(z.x, -z.y)))));
    }

    #[test]
    fn a_square_in_the_mirror_does_though_no_rotation_fits_it_at_all() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        assert!(look_mirrored(&square.map(|z| [z, DVec2::new(-z.x, z.y)])));
    }

    #[test]
    fn a_line_fits_both_ways() {
        let line = [0.0, 1.0, 2.5].map(|x| [DVec2::new(x, 0.0), DVec2::new(1.0, x)]);
        assert!(!look_mirrored(&line));
    }
}
