//! The similarity between the ends of a morph: what lies otherwise but has the same shape is turned, not deformed.
//!
//! The end is laid over the beginning, the morph is between these two, and what it is at time t is turned, scaled and moved by
//! the share t of the way there. A similarity folds nothing, but for rounding.

use glam::DVec2;

use crate::geom::Similarity;
use crate::problem::Embedding;

/// The similarity that takes the beginning nearest to the end; none where there is none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn(Option<Similarity>);

impl Turn {
    /// None of it: everything stays as it lies.
    pub(super) const NONE: Self = Self(None);

    /// That of points of the beginning to those of the end; none where they are the same.
    pub(super) fn between([from, to]: [&[DVec2]; 2]) -> Self {
        let pairs: Vec<[DVec2; 2]> = from.iter().zip(to).map(|(&a, &b)| [a, b]).collect();
        Self(if from == to { None } else { Similarity::laying_over(&pairs) })
    }

    /// The end as it lies over the beginning.
    pub(super) fn taken_back(&self, end: &Embedding) -> Embedding {
        let back = self.0.map(Similarity::inverse);
        end.iter().map(|&z| back.map_or(z, |back| back.apply(z))).collect()
    }

    /// A frame at time t, from over the beginning to where it belongs.
    pub(super) fn along(&self, t: f64, frame: &Embedding) -> Embedding {
        let part = self.0.map(|turn| turn.part(t));
        frame.iter().map(|&z| part.map_or(z, |part| part.apply(z))).collect()
    }
}
