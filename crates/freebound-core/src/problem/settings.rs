//! Everything about a solve but the mesh and the pins.

use super::pins::GAUGE_PINS;
use super::{Family, Labels, Method, NamedOption, Pin, PinKind, Pins, Spacing, Stage};
use crate::geom::Bounds;

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

impl NamedOption for Treatment {
    const ALL: &'static [Self] = &[Self::Eliminate, Self::LeastSquares, Self::Weighted];

    fn labels(&self) -> Labels {
        match self {
            Self::Eliminate => Labels::new("eliminate", "Eliminate")
                .about("the equations of pinned vertices are dropped")
                .source("paper §3.3"),
            Self::LeastSquares => Labels::new("least-squares", "Least squares")
                .about("all equations are kept and met as well as can be, the pins exactly")
                .source("paper §6"),
            Self::Weighted => Labels::new("weighted", "Weighted")
                .about("all equations are kept, and all pins pull by their weights")
                .source("paper §6"),
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

impl NamedOption for Growth {
    const ALL: &'static [Self] = &[Self::Double, Self::One];

    fn labels(&self) -> Labels {
        match self {
            Self::Double => Labels::new("double", "Twice as many").about("quick: as many again are bent each time"),
            Self::One => {
                Labels::new("one", "One more").about("as the paper's §5 has it: the least that is enough, found slowly")
            }
        }
    }
}

/// How large an embedding is that fewer than two pins of the user's do not fix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GaugeSize {
    /// As large as the surface.
    #[default]
    TrueArea,
    /// As large as fits into a box, in its middle: the picture that it is made for.
    Within(Bounds),
}

/// What the first step is of methods that can go on from a layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Start {
    /// A map computed from the surface alone.
    #[default]
    FromScratch,
    /// The texture coordinates of the mesh file, as they are.
    File,
}

impl NamedOption for Start {
    const ALL: &'static [Self] = &[Self::FromScratch, Self::File];

    fn labels(&self) -> Labels {
        match self {
            Self::FromScratch => Labels::new("afresh", "Afresh").about("the map is computed from the surface alone"),
            Self::File => Labels::new("file", "File's layout").about(
                "the texture coordinates of the file are the first step, as they are, and the method goes on from them",
            ),
        }
    }
}

/// Everything about a solve but the mesh and the pins.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The way to the embedding.
    pub method: Method,
    /// The weights, where the method has a choice; where nobody chose, [`Settings::family`] says.
    pub family: Option<Family>,
    /// How far apart vertices lie on a convex shape, where the method lays a boundary on one.
    pub spacing: Spacing,
    /// Layers of virtual triangles that [`Method::Lee`] puts around the mesh, 1 at least.
    pub layers: usize,
    /// What becomes of pinned vertices' equations; where nobody chose, [`Settings::treatment_on`] says.
    pub treatment: Option<Treatment>,
    /// The most iterations after a linear solve; a flattener that starts again counts anew. Where nobody says,
    /// [`Settings::max_steps`] does.
    pub max_steps: Option<usize>,
    /// How the virtual boundary goes on.
    pub growth: Growth,
    /// How large the embedding is where the user's pins do not say.
    pub size: GaugeSize,
    /// The most rounds of relaxing after a planar end; where nobody says, as many as `auto` needs until the embedding holds in
    /// 32 bits at a moderate energy, and a few after stages 4 and 5, the grid, and a boundary that was bent.
    pub relax_rounds: Option<usize>,
    /// Whether edges may be split where the constraints cannot be met otherwise.
    pub new_vertices: bool,
    /// What the first step is.
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
    /// The most iterations after a linear solve, where nobody says; see [`Method::usual_steps`].
    pub const MAX_STEPS: usize = 60;

    /// Layers of virtual triangles, where nobody says.
    pub const LAYERS: usize = 2;

    /// The most layers that can be asked for.
    pub const MOST_LAYERS: u16 = 100;

    /// A method and a family, everything else as it is by default for the method.
    pub fn new(method: Method, family: Family) -> Self {
        Self { method, family: Some(family), ..Self::default() }
    }

    /// The same by another method. What was asked for stays, but for weights that do not go with it.
    #[must_use]
    pub fn by(self, method: Method) -> Self {
        let family = self.family.filter(|family| family.goes_with(&method));
        Self { method, family, ..self }
    }

    /// The weights that were asked for, or those that are usual for the method.
    pub fn family(&self) -> Family {
        self.family.unwrap_or_else(|| self.method.usual_family())
    }

    /// The most iterations that were asked for, or as many as are usual for the method.
    pub fn max_steps(&self) -> usize {
        self.max_steps.unwrap_or_else(|| self.method.usual_steps())
    }

    /// Whether both ask for the same, be it in words or as what is usual.
    pub fn resolves_to(&self, other: &Self) -> bool {
        let in_words = |settings: &Self| Self {
            family: Some(settings.family()),
            max_steps: Some(settings.max_steps()),
            ..settings.clone()
        };
        in_words(self) == in_words(other)
    }

    /// Whether the first step is one linear solve for positions, with the user's pins held: what can follow a pin.
    pub fn begin_with_pins_held(&self) -> bool {
        self.start == Start::FromScratch && self.method.begins_with_pins_held()
    }

    /// How a stage treats the equations of the pinned vertices, with so many pins of the user's. A boundary that the solver
    /// places is always eliminated. Up to two pins only fix the similarity and are eliminated, unless another treatment was
    /// asked for, so that conformal weights give the least-squares conformal map; more are constraints.
    pub fn treatment_on(&self, stage: &Stage, pin_count: usize) -> Treatment {
        match stage {
            // By hand after a convex boundary, all of which is pinned.
            Stage::Iterate if !self.method.uses_pins() => Treatment::Eliminate,
            Stage::Iterate => self.treatment.unwrap_or(Treatment::LeastSquares),
            Stage::VirtualBoundary | Stage::Convex(_) | Stage::Stretch(_) => Treatment::Eliminate,
            stage if stage.only_places_pins() => Treatment::Eliminate,
            _ if pin_count > 2 => self.treatment.unwrap_or(Treatment::LeastSquares),
            _ => self.treatment.unwrap_or(Treatment::Eliminate),
        }
    }

    /// Whether pins are constraints: up to two exact ones only fix the similarity.
    pub fn are_constraints(&self, pins: &Pins) -> bool {
        let is_hard = || pins.values().all(|pin| self.is_hard(pin.kind));
        pins.len() > GAUGE_PINS || (pins.len() == GAUGE_PINS && !is_hard())
    }

    /// Whether the method continues from a one-to-one embedding to the constraints, and these pins are some.
    pub fn continues(&self, pins: &Pins) -> bool {
        matches!(self.method, Method::Auto | Method::Continuation) && self.are_constraints(pins)
    }

    /// Whether this treatment meets the targets of such pins to the last bit.
    pub fn is_hard(&self, kind: PinKind) -> bool {
        kind.is_hard() && self.treatment != Some(Treatment::Weighted)
    }

    /// How this treatment holds a pin: it may weigh one that is to be met exactly, and no pin is weighed so lightly or so
    /// heavily that it makes no difference any more.
    pub fn kind_of(&self, asked: PinKind) -> PinKind {
        match asked {
            PinKind::Soft(weight) if asked.invalid_weight().is_none() => {
                PinKind::Soft(weight.clamp(Pin::LEAST_WEIGHT, Pin::GREATEST_WEIGHT))
            }
            _ if asked.is_hard() && !self.is_hard(asked) => PinKind::Soft(Pin::DEFAULT_WEIGHT),
            _ => asked,
        }
    }

    /// The user's pins as this treatment holds them.
    pub fn held(&self, pins: &Pins) -> Pins {
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { kind: self.kind_of(pin.kind), ..*pin })).collect()
    }
}
