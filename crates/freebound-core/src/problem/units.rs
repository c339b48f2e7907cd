//! Units of a solve: the solve is near the origin and near size 1, wherever the targets are.
//!
//! ```text
//! z = scale · (w + origin)        z in the plane, w in units of the solve
//! ```
//!
//! The scale is a power of two. The scale is 1 unless the targets are extremely large or small.
//!
//! The origin is 0 unless the targets are far from 0, compared to their extent, and on one side of 0. Then the origin
//! is the multiple of a grid step of about the extent that is nearest to the targets towards 0. Targets and origin
//! are multiples of one step, and a target is at least as far from 0 as the origin. So their difference has no more
//! digits than the target: the subtraction is exact, and so is its inverse.

use glam::DVec2;

use super::{Embedding, GaugeSize, Pin, Pins, Settings};
use crate::geom::{Bounds, power_of_two_near};
use crate::mesh::VertexId;

/// Sizes between the reciprocal of this number and the number are not scaled: their fourth powers are still normal
/// numbers.
const LARGE: f64 = (1_u128 << 100) as f64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    scale: f64,
    origin: DVec2,
}

/// Units of the plane itself.
impl Default for Units {
    fn default() -> Self {
        Self { scale: 1.0, origin: DVec2::ZERO }
    }
}

impl Units {
    /// Units for these pins. If the pins leave the size open, units for the box that the embedding fills.
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

    /// Units with the origin of the plane.
    pub(crate) fn about_origin(self) -> Self {
        Self { origin: DVec2::ZERO, ..self }
    }

    /// True if the units are those of the plane, as for ordinary targets.
    pub(crate) fn is_plane(&self) -> bool {
        *self == Self::default()
    }

    fn place(&self, z: DVec2) -> DVec2 {
        if self.is_plane() { z } else { z / self.scale - self.origin }
    }

    fn place_in_plane(&self, w: DVec2) -> DVec2 {
        // Adding zero would turn −0 into 0.
        if self.is_plane() { w } else { (w + self.origin) * self.scale }
    }

    pub(crate) fn pins(&self, pins: &Pins) -> Pins {
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { target: self.place(pin.target), ..*pin })).collect()
    }

    /// Settings in these units. The box keeps its position relative to the origin: only its size matters.
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

    /// Converts positions to the plane.
    pub(crate) fn places_to_plane(&self, places: &mut [DVec2]) {
        if !self.is_plane() {
            for w in places {
                *w = self.place_in_plane(*w);
            }
        }
    }

    /// Converts an embedding to the plane. Vertices at their targets get the exact numbers of `asked`. The conversion
    /// alone would lose digits of small targets beside large ones.
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

    /// Converts pins of a solve to the plane. Requested pins get the exact numbers of `asked`.
    pub(crate) fn pins_to_plane(&self, pins: &mut Pins, asked: &Pins) {
        for (vertex, pin) in pins {
            pin.target = match asked.get(vertex) {
                Some(asked) if self.place(asked.target) == pin.target => asked.target,
                _ => self.place_in_plane(pin.target),
            };
        }
    }
}

/// Power of two near an extremely large or small size; 1 for every other size.
fn middling(size: f64) -> f64 {
    if (LARGE.recip()..=LARGE).contains(&size) { 1.0 } else { power_of_two_near(size) }
}
