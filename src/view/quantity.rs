//! Numbers that faces are coloured by, on one scale for several embeddings.

use super::{Range, Scale};
use freebound_core::verify::{Distortion, FaceDistortion};

/// What is measured of a face's map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// σ₁/σ₂: 1 where angles are kept.
    #[default]
    Angle,
    /// Logarithm to base 2 of area in the plane over area on the surface.
    Area,
    /// Root mean square stretch.
    Stretch,
}

impl Quantity {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Angle, Self::Area, Self::Stretch];

    /// Its name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Angle => "Angle distortion",
            Self::Area => "Area distortion",
            Self::Stretch => "Stretch",
        }
    }

    /// The scale of its colours.
    pub const fn scale(self) -> Scale {
        match self {
            Self::Angle => Scale::Angle,
            Self::Area => Scale::Area,
            Self::Stretch => Scale::Stretch,
        }
    }

    /// Its value on a face.
    pub fn of(self, face: &FaceDistortion) -> f64 {
        match self {
            Self::Angle => face.angle,
            Self::Area => face.area.log2(),
            Self::Stretch => face.stretch_l2,
        }
    }

    /// Its values on all faces.
    pub fn values(self, distortion: &Distortion) -> Vec<f64> {
        distortion.faces.iter().map(|face| self.of(face)).collect()
    }

    /// One range for several embeddings: the upper median of the ranges that each of them would have, end by end. So at least
    /// half of them lie within, and one that is wild does not take the colours from the others. None of none.
    pub fn common_range<'a>(self, distortions: impl Iterator<Item = &'a Distortion>) -> Option<Range> {
        let ranges: Vec<Range> = distortions.map(|of| self.scale().robust_range(&self.values(of))).collect();
        let median = |mut ends: Vec<f64>| {
            ends.sort_by(f64::total_cmp);
            ends.get(ends.len() / 2).copied()
        };
        let low = median(ranges.iter().map(|range| -range.low).collect())?;
        Some(Range { low: -low, high: median(ranges.iter().map(|range| range.high).collect())? })
    }
}
