//! Methods: their names, descriptions and traits.

use super::{BoundaryShape, Family, Labels, NamedOption, Settings, Stage};

/// Method that computes an embedding.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// Stages in order of their cost, until the embedding is proved planar and meets the constraints. Begins with the
    /// natural boundary and the mean-value iteration; later stages include the virtual boundary, Schnyder's grid and
    /// continuation.
    #[default]
    Auto,
    /// Natural boundary (paper §3.3): one solve with two gauge pins or the user's pins.
    Natural,
    /// Natural boundary, then mean-value iteration (paper §4).
    Iterate,
    /// Natural boundary, then a virtual boundary (paper §5).
    VirtualBoundary,
    /// Boundary on a convex shape, inner vertices at barycentres (Tutte 1963, Floater 1997).
    Convex(BoundaryShape),
    /// Boundary on a convex shape, weights divided by stretch solve after solve (Yoshizawa et al. 2004).
    Stretch(BoundaryShape),
    /// Layers of virtual triangles around the mesh, the outermost on a convex shape, peeled off after the solve (Lee
    /// et al. 2002).
    Lee(BoundaryShape),
    /// Least-squares conformal map (Lévy et al. 2002). Equal to natural with conformal weights.
    Lscm,
    /// Lévy's triangle equations summed around each vertex (paper §3.2).
    Levy,
    /// Scalable locally injective mappings (Rabinovich et al. 2017): lowers the energy of Tutte's map on a circle.
    Slim,
    /// Least conformal energy of all maps with one size of boundary (Mullen et al. 2008). Needs no pins.
    Spectral,
    /// Angle-based flattening: the planar angles nearest to the surface's, by a system of all angles (Sheffer, de
    /// Sturler 2001).
    Abf,
    /// Angle-based flattening with a reduced system, which has a fifth of the unknowns (Sheffer et al. 2005).
    AbfPlusPlus,
    /// Continuation from a planar embedding without constraints to their targets, one-to-one at every step.
    Continuation,
    /// Paths between the constraints on the mesh, with new vertices if they lack clearance, straightened in the
    /// plane.
    Matchmaker,
    /// Integer coordinates on a grid (Schnyder 1990), planar by theorem for every mesh; then relaxed.
    Schnyder,
}

impl Method {
    /// Traits of the method, in one table.
    pub const fn traits(&self) -> MethodTraits {
        const NONE: MethodTraits = MethodTraits::NONE;
        match self {
            Self::Auto => MethodTraits {
                families: FamilyChoice::ThreePoint,
                iterations: Some(Settings::MAX_STEPS),
                takes_steps: true,
                layouts: LayoutUse::Planar,
                bends_boundary: true,
                pins: PinUse::Constraints,
                begins_with_pins_held: true,
                ..NONE
            },
            Self::Natural => MethodTraits {
                families: FamilyChoice::ThreePoint,
                pins: PinUse::Constraints,
                begins_with_pins_held: true,
                ..NONE
            },
            Self::Iterate => MethodTraits {
                families: FamilyChoice::ThreePoint,
                iterations: Some(Settings::MAX_STEPS),
                takes_steps: true,
                layouts: LayoutUse::Any,
                pins: PinUse::Constraints,
                begins_with_pins_held: true,
                ..NONE
            },
            Self::VirtualBoundary => MethodTraits {
                families: FamilyChoice::ThreePoint,
                takes_steps: true,
                layouts: LayoutUse::Any,
                bends_boundary: true,
                pins: PinUse::Gauge,
                begins_with_pins_held: true,
                ..NONE
            },
            Self::Convex(_) => MethodTraits { families: FamilyChoice::Any, ..NONE },
            Self::Stretch(_) => MethodTraits { iterations: Some(Settings::MAX_STEPS), takes_steps: true, ..NONE },
            Self::Lee(_) => MethodTraits {
                families: FamilyChoice::Any,
                usual_family: Family::MeanValue,
                is_padded: true,
                pins: PinUse::Placing,
                ..NONE
            },
            Self::Lscm | Self::Levy => MethodTraits { pins: PinUse::Constraints, begins_with_pins_held: true, ..NONE },
            Self::Slim => {
                MethodTraits { iterations: Some(Self::SLIM_STEPS), takes_steps: true, pins: PinUse::Placing, ..NONE }
            }
            Self::Spectral | Self::Abf | Self::AbfPlusPlus => MethodTraits { pins: PinUse::Placing, ..NONE },
            Self::Continuation | Self::Matchmaker => MethodTraits {
                takes_steps: true,
                is_one_to_one: true,
                layouts: LayoutUse::Planar,
                pins: PinUse::Constraints,
                only_meets_constraints: true,
                ..NONE
            },
            Self::Schnyder => MethodTraits { takes_steps: true, pins: PinUse::Placing, ..NONE },
        }
    }

    /// Default limit of SLIM's iterations.
    const SLIM_STEPS: usize = 20;

    /// True if the method uses the chosen family of weights.
    pub const fn uses_family(&self) -> bool {
        !matches!(self.traits().families, FamilyChoice::None)
    }

    /// True if the method accepts families that need a convex boundary.
    pub const fn takes_any_family(&self) -> bool {
        matches!(self.traits().families, FamilyChoice::Any)
    }

    /// True if the method puts layers of virtual triangles around the mesh.
    pub const fn is_padded(&self) -> bool {
        self.traits().is_padded
    }

    /// Default family of weights.
    pub const fn usual_family(&self) -> Family {
        self.traits().usual_family
    }

    /// True if the method iterates, so that the step limit applies.
    pub const fn iterates(&self) -> bool {
        self.traits().iterations.is_some()
    }

    /// Default limit of iterations: mean-value iterations, solves for less stretch, or iterations of SLIM.
    pub const fn usual_steps(&self) -> usize {
        match self.traits().iterations {
            Some(most) => most,
            None => Settings::MAX_STEPS,
        }
    }

    /// True if the method takes more steps than one linear solve.
    pub const fn takes_steps(&self) -> bool {
        self.traits().takes_steps
    }

    /// True if every step towards the constraints is one-to-one.
    pub const fn is_one_to_one(&self) -> bool {
        self.traits().is_one_to_one
    }

    /// True if the method can continue from an existing layout.
    pub const fn continues_from_layout(&self) -> bool {
        !matches!(self.traits().layouts, LayoutUse::None)
    }

    /// True if the method can continue from one-to-one layouts only.
    pub const fn needs_planar_start(&self) -> bool {
        matches!(self.traits().layouts, LayoutUse::Planar)
    }

    /// True if the method may bend the boundary, so that [`Settings::growth`] applies.
    pub const fn bends_boundary(&self) -> bool {
        self.traits().bends_boundary
    }

    /// True if the method uses pins.
    pub const fn uses_pins(&self) -> bool {
        !matches!(self.traits().pins, PinUse::None)
    }

    /// Shape that the boundary is laid on, if the method has one.
    pub const fn boundary_shape(&self) -> Option<&BoundaryShape> {
        match self {
            Self::Convex(shape) | Self::Stretch(shape) | Self::Lee(shape) => Some(shape),
            _ => None,
        }
    }

    /// Shape that the boundary is laid on, mutable, if the method has one.
    pub const fn boundary_shape_mut(&mut self) -> Option<&mut BoundaryShape> {
        match self {
            Self::Convex(shape) | Self::Stretch(shape) | Self::Lee(shape) => Some(shape),
            _ => None,
        }
    }

    /// Method with another shape of the boundary. Unchanged if the method has no shape.
    #[must_use]
    pub fn on_shape(mut self, shape: BoundaryShape) -> Self {
        if let Some(own) = self.boundary_shape_mut() {
            *own = shape;
        }
        self
    }

    /// True if pins do not change the shape of the result. They only place it.
    pub const fn only_places_pins(&self) -> bool {
        matches!(self.traits().pins, PinUse::Placing)
    }

    /// True if the first step is one linear solve for positions, with the user's pins held.
    pub const fn begins_with_pins_held(&self) -> bool {
        self.traits().begins_with_pins_held
    }

    /// True if the method can meet constraints: pins beyond the two hard pins that fix the similarity.
    pub const fn takes_constraints(&self) -> bool {
        matches!(self.traits().pins, PinUse::Constraints)
    }

    /// True if the method has nothing to do without constraints.
    pub const fn only_meets_constraints(&self) -> bool {
        self.traits().only_meets_constraints
    }

    /// Lower-case words for messages.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Natural => Stage::Natural.words(),
            Self::Iterate => Stage::Iterate.words(),
            Self::VirtualBoundary => Stage::VirtualBoundary.words(),
            Self::Matchmaker => Stage::Matchmaker.words(),
            Self::Schnyder => Stage::Schnyder.words(),
            other => other.name(),
        }
    }
}

/// Traits of a method: the options that apply to it, its start and its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "independent traits: a table of them")]
pub struct MethodTraits {
    /// Families of weights that can be chosen.
    pub families: FamilyChoice,
    /// Default family of weights.
    pub usual_family: Family,
    /// Default limit of iterations. Absent if the method does not iterate.
    pub iterations: Option<usize>,
    /// True if the method takes more steps than one linear solve.
    pub takes_steps: bool,
    /// True if every step towards the constraints is one-to-one.
    pub is_one_to_one: bool,
    /// Layouts that the method can continue from.
    pub layouts: LayoutUse,
    /// True if the method may bend the boundary.
    pub bends_boundary: bool,
    /// True if the method puts layers of virtual triangles around the mesh.
    pub is_padded: bool,
    /// Effect of the user's pins.
    pub pins: PinUse,
    /// True if the first step is one linear solve with the user's pins held.
    pub begins_with_pins_held: bool,
    /// True if the method has nothing to do without constraints.
    pub only_meets_constraints: bool,
}

impl MethodTraits {
    /// Traits that an entry of the table leaves out.
    const NONE: Self = Self {
        families: FamilyChoice::None,
        usual_family: Family::Conformal,
        iterations: None,
        takes_steps: false,
        is_one_to_one: false,
        layouts: LayoutUse::None,
        bends_boundary: false,
        is_padded: false,
        pins: PinUse::None,
        begins_with_pins_held: false,
        only_meets_constraints: false,
    };
}

/// Families of weights that a method can be run with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FamilyChoice {
    /// No choice: the weights are the method's own.
    None,
    /// Three-point families, which keep a free boundary.
    ThreePoint,
    /// All families: the boundary is convex.
    Any,
}

/// Layouts that a method can continue from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutUse {
    /// No layout: the method starts from the surface alone.
    None,
    /// Planar layouts only.
    Planar,
    /// All layouts, also folded ones.
    Any,
}

/// Effect of the user's pins on a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinUse {
    /// No effect: the method places the whole boundary.
    None,
    /// Position and size of the result, not its shape.
    Placing,
    /// Fix the similarity, by up to two pins: they shape the first solve, but cannot be constraints.
    Gauge,
    /// Constraints: any number of pins.
    Constraints,
}

/// Each method with a boundary shape is listed once, on a circle: the shape is a separate option.
impl NamedOption for Method {
    const ALL: &'static [Self] = &[
        Self::Auto,
        Self::Natural,
        Self::Iterate,
        Self::VirtualBoundary,
        Self::Convex(BoundaryShape::Circle),
        Self::Stretch(BoundaryShape::Circle),
        Self::Lee(BoundaryShape::Circle),
        Self::Lscm,
        Self::Levy,
        Self::Slim,
        Self::Spectral,
        Self::Abf,
        Self::AbfPlusPlus,
        Self::Continuation,
        Self::Matchmaker,
        Self::Schnyder,
    ];

    fn labels(&self) -> Labels {
        match self {
            Self::Auto => Labels::new("auto", "Auto")
                .about("stages in order of cost, until the map is proved planar and meets the constraints")
                .source("paper §3.3, §4, §5, and beyond"),
            Self::Natural => Labels::new("natural", "Natural boundary")
                .about("free boundary with two pins, chosen or yours; one linear solve")
                .source("paper §3.3, eq. 2 and 3"),
            Self::Iterate => Labels::new("iterate", "Mean-value iteration")
                .about("natural boundary, then repeated solves with mean-value weights of the latest map")
                .source("paper §4"),
            Self::VirtualBoundary => Labels::new("virtual-boundary", "Virtual boundary")
                .about("natural boundary, then mesh and outside solved together within a convex outline")
                .source("paper §5"),
            Self::Convex(_) => Labels::new("convex", "Convex boundary")
                .about("boundary on a convex shape (--boundary), interior at barycentres")
                .source("Tutte 1963, Floater 1997"),
            Self::Stretch(_) => Labels::new("stretch", "Stretch minimising")
                .about("convex boundary (--boundary), weights divided by stretch until the L² stretch stops falling")
                .source("Yoshizawa, Belyaev and Seidel 2004"),
            Self::Lee(_) => Labels::new("lee", "Lee's virtual boundary")
                .about(
                    "layers of triangles (--layers) around the mesh, outermost on a convex shape (--boundary), removed \
                     after the solve; planar if weights are positive, but distorts even a flat mesh",
                )
                .source("Lee, Kim and Lee 2002"),
            Self::Lscm => Labels::new("lscm", "Least-squares conformal")
                .about("least-squares conformal map; equals natural with conformal weights")
                .source("Lévy et al. 2002"),
            Self::Levy => Labels::new("levy", "Lévy, summed")
                .about("Lévy's triangle equations summed around each vertex")
                .source("paper §3.2"),
            Self::Slim => Labels::new("slim", "SLIM")
                .about(
                    "lowers the symmetric Dirichlet energy of Tutte's map, no face flipped; the boundary may cross \
                     itself",
                )
                .source("Rabinovich et al. 2017"),
            Self::Spectral => Labels::new("spectral", "Spectral conformal")
                .about("least conformal energy at a fixed boundary size: an eigenvector, without pins")
                .source("Mullen et al. 2008"),
            Self::Abf => Labels::new("abf", "Angle based")
                .about("planar angles nearest to those of the surface, from a system of all angles and conditions")
                .source("Sheffer, de Sturler 2001"),
            Self::AbfPlusPlus => Labels::new("abf++", "Angle based, reduced")
                .about("angle-based flattening with two unknowns per inner vertex: many times faster")
                .source("Sheffer et al. 2005"),
            Self::Continuation => Labels::new("continuation", "Continuation")
                .about("moves a planar map to the targets of the constraints, one-to-one at every step")
                .source("ours; energy of Garanzha et al. 2021"),
            Self::Matchmaker => Labels::new("matchmaker", "Matchmaker")
                .about("straightens paths between the constraints in the plane, with new vertices if they need space")
                .source("Eckstein et al. 2001; Kraevoy et al. 2003"),
            Self::Schnyder => Labels::new("schnyder", "Schnyder's grid")
                .about("integer coordinates on a grid, planar by theorem for every mesh; then relaxed")
                .source("Schnyder 1990"),
        }
    }
}
