//! Plain data about a result: placement, pins, packing.

use crate::geom::{Packing, PackingOptions, Rotations, Stacking};
use crate::mesh::VertexId;
use crate::problem::{Labels, NamedOption, Treatment};

/// Placement of the written coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Placement {
    /// On the user's pins.
    Pins,
    /// Within the picture.
    Picture,
    /// In the unit square.
    Unit,
    /// Scaled to the area of the surface.
    True,
    /// Scaled by a power of two and not moved, because rounding in the unit square would fold faces.
    Unmoved,
    /// At the texture coordinates of the file.
    File,
    /// Packed into a picture with other charts.
    Packed,
    /// At given texture coordinates, with the other charts packed around it.
    Locked,
}

/// Packing of charts into a picture or several.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PackingSummary {
    /// Width and height of the picture, pixels.
    pub picture: [u32; 2],
    /// Least distance between charts, pixels.
    pub gap: u32,
    /// Pixels per unit of length on the surface, for charts of default size.
    pub density: f64,
    /// Density that was asked for. Larger than `density` if the charts do not fit into the largest picture.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub wanted_density: Option<f64>,
    /// Number of tiles that hold charts, each of them a picture.
    pub tiles: usize,
    /// Share of these tiles that the charts cover, from 0 to 1.
    pub covered: f64,
}

impl PackingSummary {
    /// Summary of a packing whose charts cover an area, in pixels, of this number of tiles.
    pub(super) fn new(packing: &Packing, options: PackingOptions, tiles: usize, area: f64) -> Self {
        let pixels = f64::from(packing.picture.x) * f64::from(packing.picture.y);
        Self {
            picture: packing.picture.to_array(),
            gap: options.gap,
            density: packing.scale,
            wanted_density: options.density,
            tiles,
            covered: area / (pixels * tiles.max(1) as f64),
        }
    }

    /// Density that was asked for, if the packed charts do not reach it.
    pub fn unmet_density(&self) -> Option<f64> {
        self.wanted_density.filter(|&wanted| self.density < wanted)
    }
}

/// Place of a chart that lies on another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StackedOn {
    /// Number of the other chart, from 0.
    #[cfg_attr(feature = "serde", serde(rename = "stacked_on"))]
    pub chart: usize,
    /// True if the chart is a mirror image of the other, so that all its faces are turned over.
    pub mirrored: bool,
}

/// Pins of a run and their errors. All distances are in texture coordinates.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PinsSummary {
    /// Treatment of the pinned vertices' equations in the written step.
    pub treatment: Treatment,
    /// Number of the user's pins.
    pub count: usize,
    /// Largest distance of a pinned vertex from its target.
    pub max_error: f64,
    /// Largest distance of a hard pin from its target. Absent if there are none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub max_hard_error: Option<f64>,
    /// Largest distance of a soft pin from its target. Absent if there are none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub max_soft_error: Option<f64>,
    /// Vertices of hard pins that are not at their targets.
    pub unmet: Vec<VertexId>,
    /// Soft pins, each with its error.
    pub soft: Vec<SoftPinSummary>,
}

impl PinsSummary {
    /// Copy with other vertex numbers.
    #[must_use]
    pub fn renumbered(mut self, number: impl Fn(VertexId) -> VertexId) -> Self {
        self.unmet.iter_mut().for_each(|vertex| *vertex = number(*vertex));
        self.soft.iter_mut().for_each(|pin| pin.vertex = number(pin.vertex));
        self
    }
}

/// A soft pin and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SoftPinSummary {
    /// Pinned vertex.
    pub vertex: VertexId,
    /// Weight of the pin.
    pub weight: f64,
    /// Distance of the vertex from its target.
    pub error: f64,
}

/// Size of an embedding that the user's pins do not fix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// Scaled uniformly into the unit square.
    #[default]
    Unit,
    /// Scaled to the area of the surface.
    True,
}

impl NamedOption for Rotations {
    const ALL: &'static [Self] = &[Self::Free, Self::Quarter, Self::None];

    fn labels(&self) -> Labels {
        match self {
            Self::Free => Labels::new("free", "Any").about("Charts may have any rotation"),
            Self::Quarter => Labels::new("quarter", "By 90°").about("Charts may be rotated by multiples of 90°"),
            Self::None => Labels::new("none", "None").about("Charts keep their orientation"),
        }
    }
}

impl NamedOption for Stacking {
    const ALL: &'static [Self] = &[Self::None, Self::Congruent, Self::Mirrored];

    fn labels(&self) -> Labels {
        match self {
            Self::None => Labels::new("none", "None").about("Every chart has a place of its own"),
            Self::Congruent => Labels::new("congruent", "Congruent").about("Congruent charts share a place"),
            Self::Mirrored => Labels::new("mirrored", "Mirrored").about("Congruent and mirrored charts share a place"),
        }
    }
}

impl NamedOption for Fit {
    const ALL: &'static [Self] = &[Self::Unit, Self::True];

    fn labels(&self) -> Labels {
        match self {
            Self::Unit => Labels::new("unit", "Unit square").about("Scales uniformly into the unit square"),
            Self::True => Labels::new("true", "True scale").about("Scales to the area of the surface"),
        }
    }
}
