//! Quantities that colour faces, on one scale for several embeddings.

use super::{Range, Scale};
use freebound_core::verify::{Distortion, FaceDistortion};

/// Distortion measured per face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// σ₁/σ₂: 1 if angles are preserved.
    #[default]
    Angle,
    /// Logarithm to base 2 of area in the plane over area on the surface.
    Area,
    /// Root mean square stretch.
    Stretch,
}

impl Quantity {
    /// All quantities, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Angle, Self::Area, Self::Stretch];

    /// Title for menus and legends.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Angle => "Angle distortion",
            Self::Area => "Area distortion",
            Self::Stretch => "Stretch",
        }
    }

    /// Colour scale of the quantity.
    pub const fn scale(self) -> Scale {
        match self {
            Self::Angle => Scale::Angle,
            Self::Area => Scale::Area,
            Self::Stretch => Scale::Stretch,
        }
    }

    /// Value on a face.
    pub fn of(self, face: &FaceDistortion) -> f64 {
        match self {
            Self::Angle => face.angle,
            Self::Area => face.area.log2(),
            Self::Stretch => face.stretch_l2,
        }
    }

    /// Values on all faces.
    pub fn values(self, distortion: &Distortion) -> Vec<f64> {
        distortion.faces.iter().map(|face| self.of(face)).collect()
    }

    /// Common range of several embeddings: the median of the low ends and the median of the high ends of their own
    /// ranges. Of an even number of ends the wider middle one is taken. At least half of the ranges fit at each end,
    /// and an outlier does not flatten the colours of the others. `None` for no embeddings.
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
