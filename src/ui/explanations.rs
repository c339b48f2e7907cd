//! Explanations of the measures that the window shows: formula, and the value of a perfect map. Every panel takes them
//! from here.
//!
//! The singular values σ₁ ≥ σ₂ are those of the map of a face from the surface to the plane, at equal total areas.

use freebound_io::Column;

use super::state::ShadingMode;

/// Mean energy up to which a map counts as hardly distorted.
pub(in crate::ui) const GOOD_ENERGY: f64 = 4.1;

/// Measure that explains itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Ratio of the singular values.
    Angle,
    /// Ratio of areas.
    Area,
    /// Root mean square stretch.
    StretchL2,
    /// Greatest stretch.
    StretchLinf,
    /// Symmetric Dirichlet energy.
    Energy,
    /// Mean over the surface.
    Mean,
    /// 99th percentile.
    P99,
    /// Greatest value.
    Max,
    /// Weights of the vertex equations.
    Weights,
}

impl Measure {
    /// Explanation: meaning, formula, and range.
    pub const fn tip(self) -> &'static str {
        match self {
            Self::Angle => {
                "Change of angles: σ₁/σ₂ of each face, its greater stretch over its smaller.\n\
                 From 1 (perfect, angles are kept) to ∞."
            }
            Self::Area => {
                "Change of areas: σ₁σ₂ of each face or its inverse, whichever is greater.\n\
                 From 1 (perfect, areas are kept) to ∞."
            }
            Self::StretchL2 => {
                "L² stretch from the plane to the surface: root mean square of 1/σ₁ and 1/σ₂.\n\
                 1 is perfect at equal total areas; ∞ if a face collapses (Sander et al. 2001)."
            }
            Self::StretchLinf => {
                "L∞ stretch: the greatest 1/σ₂ of all faces, so the worst place of the map.\n\
                 1 is perfect at equal total areas; ∞ if a face collapses (Sander et al. 2001)."
            }
            Self::Energy => {
                "Symmetric Dirichlet energy: mean of σ₁² + σ₂² + 1/σ₁² + 1/σ₂².\n\
                 From 4 (perfect, all lengths are kept) to ∞."
            }
            Self::Mean => "Mean over the surface: a face counts by its area in space.",
            Self::P99 => {
                "99th percentile: 99 % of the surface, by area, has at most this value.\n\
                 A few bad faces do not change it."
            }
            Self::Max => "Greatest value of all faces: the worst face alone.",
            Self::Weights => {
                "Weights w of the equation of each vertex: Σ w (z_neighbour − z) = 0.\n\
                 Conformal keeps angles. Mean value is always above 0, which avoids folds."
            }
        }
    }

    /// Measure with this name in a table of two steps.
    pub fn called(name: &str) -> Option<Self> {
        let names =
            [("Angle", Self::Angle), ("Area", Self::Area), ("Stretch", Self::StretchL2), ("Energy", Self::Energy)];
        names.into_iter().find(|(of, _)| *of == name).map(|(_, measure)| measure)
    }

    /// Measure of a column of the comparison.
    pub const fn of_column(column: Column) -> Option<Self> {
        match column {
            Column::Angle => Some(Self::Angle),
            Column::AngleP99 => Some(Self::P99),
            Column::Area => Some(Self::Area),
            Column::StretchL2 => Some(Self::StretchL2),
            Column::StretchLinf => Some(Self::StretchLinf),
            Column::Energy => Some(Self::Energy),
            _ => None,
        }
    }

    /// Measure that a shading shows.
    pub const fn of_shading(shading: ShadingMode) -> Option<Self> {
        match shading {
            ShadingMode::Angle => Some(Self::Angle),
            ShadingMode::Area => Some(Self::Area),
            ShadingMode::Stretch => Some(Self::StretchL2),
            _ => None,
        }
    }
}
