//! What can be chosen: method, family of weights, shape of a convex boundary.

use std::fmt;
use std::str::FromStr;

use glam::DVec2;

use super::{Hold, Pin, Pins};

/// A way to an embedding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Method {
    /// The ladder: natural boundary, mean-value iteration, virtual boundary, until the embedding is proved planar.
    #[default]
    Auto,
    /// Natural boundary (paper §3.3): two pins or the user's, one solve.
    Natural,
    /// Natural boundary, then mean-value iteration (paper §4).
    Iterate,
    /// Natural boundary, then a virtual boundary (paper §5).
    VirtualBoundary,
    /// The boundary on a convex shape, the inside at barycentres (Tutte 1963, Floater 1997).
    Convex(BoundaryShape),
    /// Least-squares conformal map (Lévy et al. 2002); the same as natural with conformal weights.
    Lscm,
    /// Lévy's triangle equations summed around each vertex (paper §3.2).
    Levy,
    /// From a planar embedding without the constraints, one-to-one all the way to their targets.
    Continuation,
    /// Paths between the constraints on the mesh, with new vertices where they need room, straightened in the plane.
    Matchmaker,
    /// A planar embedding's distortion lowered, one-to-one throughout. A rung only: what follows a method.
    Relax,
}

impl Method {
    /// The name on the command line and in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Natural => "natural",
            Self::Iterate => "iterate",
            Self::VirtualBoundary => "virtual-boundary",
            Self::Convex(_) => "convex",
            Self::Lscm => "lscm",
            Self::Levy => "levy",
            Self::Continuation => "continuation",
            Self::Matchmaker => "matchmaker",
            Self::Relax => "relax",
        }
    }

    /// Whether the choice of family matters.
    pub const fn uses_family(self) -> bool {
        !matches!(self, Self::Lscm | Self::Levy | Self::Continuation | Self::Matchmaker | Self::Relax)
    }

    /// Whether it iterates, so that a limit of its steps matters.
    pub const fn iterates(self) -> bool {
        matches!(self, Self::Auto | Self::Iterate)
    }

    /// Whether it takes more steps than one linear solve.
    pub const fn takes_steps(self) -> bool {
        !matches!(self, Self::Natural | Self::Convex(_) | Self::Lscm | Self::Levy)
    }

    /// Whether it keeps every step one-to-one on the way to the constraints.
    pub const fn is_one_to_one(self) -> bool {
        matches!(self, Self::Continuation | Self::Matchmaker | Self::Relax)
    }

    /// Whether it may bend the boundary, so that the growth of the pinned vertices matters.
    pub const fn bends_boundary(self) -> bool {
        matches!(self, Self::Auto | Self::VirtualBoundary)
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

/// How the equations of pinned vertices are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// They are dropped (paper §3.3).
    Eliminate,
    /// All equations are kept and met as well as can be, the pins exactly (paper §6).
    LeastSquares,
    /// All equations are kept, and pins are further equations: those without a weight of their own have
    /// [`Pin::DEFAULT_WEIGHT`] (paper §6).
    Weighted,
}

impl Treatment {
    /// The name on the command line and in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Eliminate => "eliminate",
            Self::LeastSquares => "least-squares",
            Self::Weighted => "weighted",
        }
    }
}

/// How many boundary vertices the virtual boundary pins next where the boundary is not simple.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Growth {
    /// Twice as many.
    #[default]
    Double,
    /// One more, as the paper's §5 has it.
    One,
}

/// How large an embedding is that fewer than two pins of the user's do not fix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GaugeSize {
    /// As large as the surface.
    #[default]
    TrueArea,
    /// As large as fits into a box, in its middle: the picture that it is made for.
    Within {
        /// The box's lower left corner.
        low: DVec2,
        /// Its upper right corner.
        high: DVec2,
    },
}

/// Everything about a solve but the mesh and the pins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The way to the embedding.
    pub method: Method,
    /// The weights, where the method has a choice.
    pub family: Family,
    /// What becomes of pinned vertices' equations; where nobody chose, [`Settings::treatment_of`] says.
    pub treatment: Option<Treatment>,
    /// The most mean-value iterations after a linear solve; a ladder that starts again counts anew.
    pub max_steps: usize,
    /// How the virtual boundary goes on.
    pub growth: Growth,
    /// How large the embedding is where the user's pins do not say.
    pub size: GaugeSize,
    /// The most rounds of relaxing after a planar end; where nobody says, a few after rungs 4 and 5 and after the boundary
    /// was bent, else none.
    pub relax_rounds: Option<usize>,
    /// Whether edges may be split where the constraints cannot be met otherwise.
    pub new_vertices: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            family: Family::default(),
            treatment: None,
            max_steps: Self::MAX_STEPS,
            growth: Growth::default(),
            size: GaugeSize::default(),
            relax_rounds: None,
            new_vertices: true,
        }
    }
}

impl Settings {
    /// The most mean-value iterations after a linear solve, where nobody says.
    pub const MAX_STEPS: usize = 60;

    /// A method and a family, everything else as it is by default.
    pub fn new(method: Method, family: Family) -> Self {
        Self { method, family, ..Self::default() }
    }

    /// How the linear solve treats the equations of so many pins of the user's. Two only fix the similarity and are
    /// eliminated, so that conformal weights give the least-squares conformal map; more are constraints.
    pub fn treatment_of(&self, pin_count: usize) -> Treatment {
        let by_count = if pin_count > 2 { Treatment::LeastSquares } else { Treatment::Eliminate };
        self.treatment.unwrap_or(by_count)
    }

    /// How a rung treats the equations of the pinned vertices, with so many pins of the user's. A boundary that the
    /// solver places is always eliminated; its own gauge pins are, unless another treatment was asked for.
    pub fn treatment_on(&self, rung: Method, pin_count: usize) -> Treatment {
        match rung {
            // By hand after a convex boundary, all of which is pinned.
            Method::Iterate if matches!(self.method, Method::Convex(_)) => Treatment::Eliminate,
            Method::Iterate => self.treatment.unwrap_or(Treatment::LeastSquares),
            Method::VirtualBoundary | Method::Convex(_) => Treatment::Eliminate,
            _ if pin_count < 2 => self.treatment.unwrap_or(Treatment::Eliminate),
            _ => self.treatment_of(pin_count),
        }
    }

    /// Whether this treatment meets the targets of such pins to the last bit.
    pub fn is_exact(&self, hold: Hold) -> bool {
        hold.is_exact() && self.treatment != Some(Treatment::Weighted)
    }

    /// How this treatment holds a pin: it may weigh one that is to be met exactly.
    pub fn hold_of(&self, asked: Hold) -> Hold {
        let is_weighed = asked.is_exact() && !self.is_exact(asked);
        if is_weighed { Hold::Weighted(Pin::DEFAULT_WEIGHT) } else { asked }
    }

    /// The user's pins as this treatment holds them.
    pub fn held(&self, pins: &Pins) -> Pins {
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { hold: self.hold_of(pin.hold), ..*pin })).collect()
    }
}
