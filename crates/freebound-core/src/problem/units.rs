//! The units of a solve: what is to be computed lies near the origin and near size 1, wherever the targets are.
//!
//! ```text
//! z = scale · (w + origin)        z in the plane, w in units of the solve
//! ```
//!
//! The scale is a power of two, 1 but for the largest and smallest targets. The origin is 0 but for targets far away, beside
//! their extent, on one side of 0: then it is the number on a grid as wide as the extent that lies nearest to them towards
//! 0. Targets and origin are thus multiples of the same step, a target is at least as far from 0, and their
//! difference has no more digits than the target: it is exact, and so is the way back.

use glam::DVec2;

use super::{Embedding, GaugeSize, Pin, Pins, Settings};
use crate::geom::{Bounds, power_of_two_near};
use crate::mesh::VertexId;

/// Sizes from its reciprocal up to this are left as they are: fourth powers of them are still normal numbers.
const LARGE: f64 = (1_u128 << 100) as f64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    scale: f64,
    origin: DVec2,
}

/// The plane itself.
impl Default for Units {
    fn default() -> Self {
        Self { scale: 1.0, origin: DVec2::ZERO }
    }
}

impl Units {
    /// Those of pins; where they leave the size open, those of the box that the embedding is to fill.
    pub(crate) fn of(pins: &Pins, size: GaugeSize) -> Self {
        let targets = || pins.values().map(|pin| pin.target);
        let scale = match size {
            _ if pins.len() > 1 => middling(targets().map(|z| z.abs().max_element()).fold(0.0, f64::max)),
            GaugeSize::TrueArea => 1.0,
            GaugeSize::Within(bounds) => middling(bounds.size().max_element()),
        };
        let Bounds { low, high } = Bounds::of(targets().map(|z| z / scale));
        let extent = (high - low).max_element();
        if pins.is_empty() || !extent.is_finite() {
            return Self { scale, origin: DVec2::ZERO };
        }
        let step = 2.0 * power_of_two_near(extent);
        let nearest = low.max(DVec2::ZERO) + high.min(DVec2::ZERO);
        Self { scale, origin: (nearest / step).trunc() * step }
    }

    /// The same with the plane's origin.
    pub(crate) fn about_origin(self) -> Self {
        Self { origin: DVec2::ZERO, ..self }
    }

    /// Whether they change nothing, as for ordinary targets.
    pub(crate) fn is_plane(&self) -> bool {
        *self == Self::default()
    }

    fn place(&self, z: DVec2) -> DVec2 {
        if self.is_plane() { z } else { z / self.scale - self.origin }
    }

    fn place_in_plane(&self, w: DVec2) -> DVec2 {
        // Adding nothing would still make a zero of a negative zero.
        if self.is_plane() { w } else { (w + self.origin) * self.scale }
    }

    pub(crate) fn pins(&self, pins: &Pins) -> Pins {
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { target: self.place(pin.target), ..*pin })).collect()
    }

    /// Settings, whose box keeps its place relative to the origin: only its size matters.
    pub(crate) fn settings(&self, settings: Settings) -> Settings {
        let size = match settings.size {
            GaugeSize::Within(Bounds { low, high }) => {
                GaugeSize::Within(Bounds { low: low / self.scale, high: high / self.scale })
            }
            GaugeSize::TrueArea => GaugeSize::TrueArea,
        };
        Settings { size, ..settings }
    }

    pub(crate) fn embedding(&self, embedding: &Embedding) -> Embedding {
        embedding.iter().map(|&z| self.place(z)).collect()
    }

    pub(crate) fn length_in_plane(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Takes places to the plane.
    pub(crate) fn places_to_plane(&self, places: &mut [DVec2]) {
        if !self.is_plane() {
            for w in places {
                *w = self.place_in_plane(*w);
            }
        }
    }

    /// Takes an embedding to the plane, and vertices on their targets to the numbers given: those of the smallest targets
    /// beside large ones would not come back.
    pub(crate) fn embedding_to_plane(&self, embedding: &mut Embedding, asked: &Pins) {
        if self.is_plane() {
            return;
        }
        let is_met = |(vertex, pin): &(&VertexId, &Pin)| embedding[*vertex] == self.place(pin.target);
        let met: Vec<(VertexId, DVec2)> =
            asked.iter().filter(is_met).map(|(&vertex, pin)| (vertex, pin.target)).collect();
        self.places_to_plane(embedding);
        for (vertex, target) in met {
            embedding[vertex] = target;
        }
    }

    /// Takes pins in force to the plane: those asked for to the numbers given.
    pub(crate) fn pins_to_plane(&self, pins: &mut Pins, asked: &Pins) {
        for (vertex, pin) in pins {
            pin.target = match asked.get(vertex) {
                Some(asked) if self.place(asked.target) == pin.target => asked.target,
                _ => self.place_in_plane(pin.target),
            };
        }
    }
}

/// The power of two that takes a size to the middle of the range of numbers; 1 where it lies there.
fn middling(size: f64) -> f64 {
    if (LARGE.recip()..=LARGE).contains(&size) { 1.0 } else { power_of_two_near(size) }
}
