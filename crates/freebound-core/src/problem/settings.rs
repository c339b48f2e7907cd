//! Settings of a solve: everything but the mesh and the pins.

use super::pins::GAUGE_PINS;
use super::{Family, Labels, Method, NamedOption, Pin, PinKind, Pins, Spacing, Stage};
use crate::geom::Bounds;

/// Treatment of the equations of pinned vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Equations of pinned vertices are dropped (paper §3.3).
    Eliminate,
    /// All equations are kept and met in the least-squares sense, hard pins exactly (paper §6).
    LeastSquares,
    /// All equations are kept, and each pin adds another. Pins without a weight have [`Pin::DEFAULT_WEIGHT`] (paper
    /// §6).
    Weighted,
}

impl NamedOption for Treatment {
    const ALL: &'static [Self] = &[Self::Eliminate, Self::LeastSquares, Self::Weighted];

    fn labels(&self) -> Labels {
        match self {
            Self::Eliminate => Labels::new("eliminate", "Eliminate")
                .about("drops the equations of pinned vertices")
                .source("paper §3.3"),
            Self::LeastSquares => Labels::new("least-squares", "Least squares")
                .about("keeps all equations, solved by least squares; hard pins are met exactly")
                .source("paper §6"),
            Self::Weighted => Labels::new("weighted", "Weighted")
                .about("keeps all equations; every pin pulls by its weight")
                .source("paper §6"),
        }
    }
}

/// Growth of the set of pinned boundary vertices in [`Method::VirtualBoundary`], while the boundary is not simple.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Growth {
    /// Doubles the number of pinned vertices.
    #[default]
    Double,
    /// Adds one pinned vertex (paper §5).
    One,
}

impl NamedOption for Growth {
    const ALL: &'static [Self] = &[Self::Double, Self::One];

    fn labels(&self) -> Labels {
        match self {
            Self::Double => Labels::new("double", "Twice as many")
                .about("doubles the number of pinned boundary vertices each time: fast"),
            Self::One => Labels::new("one", "One more")
                .about("pins one more boundary vertex each time (paper §5): fewest pins, but slow"),
        }
    }
}

/// Size of an embedding that has fewer than two of the user's pins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GaugeSize {
    /// Area of the surface.
    #[default]
    TrueArea,
    /// Largest size that fits into a box, in its middle: the picture that the map is made for.
    Within(Bounds),
}

/// First step of a method that can continue from a layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Start {
    /// A map computed from the surface alone.
    #[default]
    FromScratch,
    /// The texture coordinates of the mesh file, unchanged.
    File,
}

impl NamedOption for Start {
    const ALL: &'static [Self] = &[Self::FromScratch, Self::File];

    fn labels(&self) -> Labels {
        match self {
            Self::FromScratch => {
                Labels::new("from-scratch", "From scratch").about("computes the map from the surface alone")
            }
            Self::File => Labels::new("file", "File's layout")
                .about("starts from the texture coordinates of the file, unchanged; they are the first step"),
        }
    }
}

/// Settings of a solve: everything but the mesh and the pins.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Method of the solve.
    pub method: Method,
    /// Family of weights, if the method has a choice. Default: [`Method::usual_family`].
    pub family: Option<Family>,
    /// Spacing of vertices on a convex shape, if the method lays the boundary on one.
    pub spacing: Spacing,
    /// Number of layers of virtual triangles that [`Method::Lee`] puts around the mesh, at least 1.
    pub layers: usize,
    /// Treatment of the equations of pinned vertices. Default: by stage and number of pins, see
    /// [`Settings::treatment_on`].
    pub treatment: Option<Treatment>,
    /// Largest number of iterations after a linear solve. A flattener that restarts counts anew. Default:
    /// [`Method::usual_steps`].
    pub max_steps: Option<usize>,
    /// Growth of the set of pinned boundary vertices in [`Method::VirtualBoundary`].
    pub growth: Growth,
    /// Size of the embedding, if the user's pins do not fix it.
    pub size: GaugeSize,
    /// Largest number of relaxing rounds after a planar end. Default: a few rounds after continuation, the
    /// matchmaker, Schnyder's grid and a bent boundary. `auto` also relaxes until the embedding holds in 32 bits at a
    /// moderate energy.
    pub relax_rounds: Option<usize>,
    /// True if edges may be split when the constraints cannot be met otherwise.
    pub new_vertices: bool,
    /// First step of the method.
    pub start: Start,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            family: None,
            spacing: Spacing::default(),
            layers: Self::LAYERS,
            treatment: None,
            max_steps: None,
            growth: Growth::default(),
            size: GaugeSize::default(),
            relax_rounds: None,
            new_vertices: true,
            start: Start::default(),
        }
    }
}

impl Settings {
    /// Default limit of iterations after a linear solve; see [`Method::usual_steps`].
    pub const MAX_STEPS: usize = 60;

    /// Default number of layers of virtual triangles.
    pub const LAYERS: usize = 2;

    /// Largest number of layers.
    pub const MOST_LAYERS: u16 = 100;

    /// Settings of a method and a family. Default for all other settings: [`Settings::default`].
    pub fn new(method: Method, family: Family) -> Self {
        Self { method, family: Some(family), ..Self::default() }
    }

    /// Settings for another method. Requested settings stay, except a family that does not go with the method.
    #[must_use]
    pub fn by(self, method: Method) -> Self {
        let family = self.family.filter(|family| family.goes_with(&method));
        Self { method, family, ..self }
    }

    /// Requested family, or the default of the method.
    pub fn family(&self) -> Family {
        self.family.unwrap_or_else(|| self.method.usual_family())
    }

    /// Requested limit of iterations, or the default of the method.
    pub fn max_steps(&self) -> usize {
        self.max_steps.unwrap_or_else(|| self.method.usual_steps())
    }

    /// True if both resolve to the same settings once defaults are filled in.
    pub fn resolves_to(&self, other: &Self) -> bool {
        let in_words = |settings: &Self| Self {
            family: Some(settings.family()),
            max_steps: Some(settings.max_steps()),
            ..settings.clone()
        };
        in_words(self) == in_words(other)
    }

    /// True if the first step is one linear solve for positions, with the user's pins held. Such a solve can follow a
    /// moving pin.
    pub fn begin_with_pins_held(&self) -> bool {
        self.start == Start::FromScratch && self.method.begins_with_pins_held()
    }

    /// Treatment of the equations of pinned vertices in a stage, with this number of the user's pins. A boundary that
    /// the solver places is always eliminated. Up to two pins only fix the similarity and are eliminated by default.
    /// So conformal weights give the least-squares conformal map. More pins are constraints: their equations are kept
    /// by default (least squares).
    pub fn treatment_on(&self, stage: &Stage, pin_count: usize) -> Treatment {
        match stage {
            // Iteration on request, after a convex boundary: all boundary vertices are pinned.
            Stage::Iterate if !self.method.uses_pins() => Treatment::Eliminate,
            Stage::Iterate => self.treatment.unwrap_or(Treatment::LeastSquares),
            Stage::VirtualBoundary | Stage::Convex(_) | Stage::Stretch(_) => Treatment::Eliminate,
            stage if stage.only_places_pins() => Treatment::Eliminate,
            _ if pin_count > 2 => self.treatment.unwrap_or(Treatment::LeastSquares),
            _ => self.treatment.unwrap_or(Treatment::Eliminate),
        }
    }

    /// True if pins are constraints. Up to two hard pins only fix the similarity.
    pub fn are_constraints(&self, pins: &Pins) -> bool {
        let is_hard = || pins.values().all(|pin| self.is_hard(pin.kind));
        pins.len() > GAUGE_PINS || (pins.len() == GAUGE_PINS && !is_hard())
    }

    /// True if the method continues from a one-to-one embedding to the constraints, and these pins are constraints.
    pub fn continues(&self, pins: &Pins) -> bool {
        matches!(self.method, Method::Auto | Method::Continuation) && self.are_constraints(pins)
    }

    /// True if this treatment meets the targets of this kind of pin to the last bit.
    pub fn is_hard(&self, kind: PinKind) -> bool {
        kind.is_hard() && self.treatment != Some(Treatment::Weighted)
    }

    /// Kind of a pin under this treatment. The treatment may turn a hard pin into a soft pin. Weights are clamped to
    /// the range in which they make a difference.
    pub fn kind_of(&self, asked: PinKind) -> PinKind {
        match asked {
            PinKind::Soft(weight) if asked.invalid_weight().is_none() => {
                PinKind::Soft(weight.clamp(Pin::LEAST_WEIGHT, Pin::GREATEST_WEIGHT))
            }
            _ if asked.is_hard() && !self.is_hard(asked) => PinKind::Soft(Pin::DEFAULT_WEIGHT),
            _ => asked,
        }
    }

    /// The user's pins with their kinds under this treatment.
    pub fn held(&self, pins: &Pins) -> Pins {
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { kind: self.kind_of(pin.kind), ..*pin })).collect()
    }
}
