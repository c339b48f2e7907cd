//! What can be chosen: method, family of weights, shape of a convex boundary.

use std::fmt;
use std::str::FromStr;

/// A way to an embedding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Method {
    /// Natural boundary (paper §3.3): two pins or the user's, one solve.
    #[default]
    Natural,
    /// The boundary on a convex shape, the inside at barycentres (Tutte 1963, Floater 1997).
    Convex(BoundaryShape),
    /// Least-squares conformal map (Lévy et al. 2002); the same as natural with conformal weights.
    Lscm,
    /// Lévy's triangle equations summed around each vertex (paper §3.2).
    Levy,
}

impl Method {
    /// The name on the command line and in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Natural => "natural",
            Self::Convex(_) => "convex",
            Self::Lscm => "lscm",
            Self::Levy => "levy",
        }
    }

    /// Whether the choice of family matters.
    pub const fn uses_family(self) -> bool {
        matches!(self, Self::Natural | Self::Convex(_))
    }

    /// Whether pins matter.
    pub const fn uses_pins(self) -> bool {
        !matches!(self, Self::Convex(_))
    }
}

/// The shape that [`Method::Convex`] lays the boundary on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoundaryShape {
    /// A circle, arcs in proportion to edge lengths.
    #[default]
    Circle,
    /// A square, its corners at vertices, sides in proportion to edge lengths.
    Square,
}

/// A family of weights (paper §3.1): how the offset d depends on the edge length r.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Family {
    /// d = r: cotangents.
    #[default]
    Conformal,
    /// d = 1: always positive.
    MeanValue,
    /// d = 1/r.
    Wachspress,
    /// d = rᵖ: from Wachspress (−1) over mean value (0) to conformal (1), and beyond.
    Power(f64),
    /// All weights equal (Tutte); convex boundary only.
    Uniform,
    /// Floater 1997; convex boundary only.
    ShapePreserving,
}

impl Family {
    /// d = r.
    pub const CONFORMAL_POWER: f64 = 1.0;
    /// d = 1/r.
    pub const WACHSPRESS_POWER: f64 = -1.0;

    /// The power p of d = rᵖ; `None` for the families that are not three-point.
    pub const fn power(self) -> Option<f64> {
        match self {
            Self::Conformal => Some(Self::CONFORMAL_POWER),
            Self::MeanValue => Some(0.0),
            Self::Wachspress => Some(Self::WACHSPRESS_POWER),
            Self::Power(p) => Some(p),
            Self::Uniform | Self::ShapePreserving => None,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Conformal => f.write_str("conformal"),
            Self::MeanValue => f.write_str("mean-value"),
            Self::Wachspress => f.write_str("wachspress"),
            Self::Power(p) => write!(f, "power:{p}"),
            Self::Uniform => f.write_str("uniform"),
            Self::ShapePreserving => f.write_str("shape-preserving"),
        }
    }
}

impl FromStr for Family {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(match text {
            "conformal" => Self::Conformal,
            "mean-value" => Self::MeanValue,
            "wachspress" => Self::Wachspress,
            "uniform" => Self::Uniform,
            "shape-preserving" => Self::ShapePreserving,
            _ => {
                let power = text.strip_prefix("power:").and_then(|p| p.parse().ok());
                let Some(power) = power.filter(|p: &f64| p.is_finite()) else {
                    return Err(
                        "choose conformal, mean-value, wachspress, uniform, shape-preserving or power:P".to_owned()
                    );
                };
                Self::Power(power)
            }
        })
    }
}

/// Everything about a solve but the mesh and the pins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The way to the embedding.
    pub method: Method,
    /// The weights, where the method has a choice.
    pub family: Family,
}
