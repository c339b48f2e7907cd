//! Similarity between the ends of a morph: a shape that only lies elsewhere is turned, not deformed.
//!
//! The end is laid over the start, and the morph runs between these two. Its frame at time t is turned, scaled and
//! moved by the share t of the similarity. A similarity folds nothing, except for rounding.

use glam::DVec2;

use crate::geom::Similarity;
use crate::problem::Embedding;

/// Similarity that brings the start closest to the end, if there is one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn(Option<Similarity>);

impl Turn {
    /// No similarity: all points stay.
    pub(super) const NONE: Self = Self(None);

    /// Similarity from points of the start to those of the end. No similarity if they are equal.
    pub(super) fn between([from, to]: [&[DVec2]; 2]) -> Self {
        let pairs: Vec<[DVec2; 2]> = from.iter().zip(to).map(|(&a, &b)| [a, b]).collect();
        Self(if from == to { None } else { Similarity::laying_over(&pairs) })
    }

    /// The end laid over the start.
    pub(super) fn taken_back(&self, end: &Embedding) -> Embedding {
        let back = self.0.map(Similarity::inverse);
        end.iter().map(|&z| back.map_or(z, |back| back.apply(z))).collect()
    }

    /// Frame at time t, moved from over the start to its actual position.
    pub(super) fn along(&self, t: f64, frame: &Embedding) -> Embedding {
        let part = self.0.map(|turn| turn.part(t));
        frame.iter().map(|&z| part.map_or(z, |part| part.apply(z))).collect()
    }
}
