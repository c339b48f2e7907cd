//! The ways to an embedding: all that is said of them by name stands here.

use super::{BoundaryShape, Family, Labels, NamedOption, Settings, Stage};

/// A way to an embedding.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// The flattener: natural boundary, mean-value iteration, virtual boundary, until the embedding is proved planar.
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
    /// The same with weights divided by stretch, solve after solve (Yoshizawa et al. 2004).
    Stretch(BoundaryShape),
    /// Layers of virtual triangles around the mesh, the outermost on a convex shape, peeled afterwards (Lee et al. 2002).
    Lee(BoundaryShape),
    /// Least-squares conformal map (Lévy et al. 2002); the same as natural with conformal weights.
    Lscm,
    /// Lévy's triangle equations summed around each vertex (paper §3.2).
    Levy,
    /// Scalable locally injective mappings (Rabinovich et al. 2017): Tutte's map on a circle, its energy lowered.
    Slim,
    /// The least conformal energy of all maps with one size of boundary (Mullen et al. 2008): no pins.
    Spectral,
    /// The angles nearest to those of the surface that make a plane, by a system of all of them (Sheffer, de Sturler 2001).
    Abf,
    /// The same angles by a system of a fifth of the unknowns (Sheffer et al. 2005).
    AbfPlusPlus,
    /// From a planar embedding without the constraints, one-to-one all the way to their targets.
    Continuation,
    /// Paths between the constraints on the mesh, with new vertices where they need room, straightened in the plane.
    Matchmaker,
    /// Whole numbers on a grid (Schnyder 1990), planar by theorem whatever the mesh; then relaxed.
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

    /// True if the chosen family of weights counts.
    pub const fn uses_family(&self) -> bool {
        !matches!(self.traits().families, FamilyChoice::None)
    }

    /// True if families that need a convex boundary can be chosen.
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

    /// True if the method iterates, so that a limit of its steps counts.
    pub const fn iterates(&self) -> bool {
        self.traits().iterations.is_some()
    }

    /// Default limit of iterations: mean-value ones, solves of less stretch, or those of SLIM.
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

    /// True if every step on the way to the constraints is one-to-one.
    pub const fn is_one_to_one(&self) -> bool {
        self.traits().is_one_to_one
    }

    /// True if the method can continue from an existing layout.
    pub const fn continues_from_layout(&self) -> bool {
        !matches!(self.traits().layouts, LayoutUse::None)
    }

    /// True if the method can continue from a layout only if that is one-to-one.
    pub const fn needs_planar_start(&self) -> bool {
        matches!(self.traits().layouts, LayoutUse::Planar)
    }

    /// True if the method may bend the boundary, so that the growth of the pinned vertices counts.
    pub const fn bends_boundary(&self) -> bool {
        self.traits().bends_boundary
    }

    /// True if pins count.
    pub const fn uses_pins(&self) -> bool {
        !matches!(self.traits().pins, PinUse::None)
    }

    /// The shape that it lays a boundary on.
    pub const fn boundary_shape(&self) -> Option<&BoundaryShape> {
        match self {
            Self::Convex(shape) | Self::Stretch(shape) | Self::Lee(shape) => Some(shape),
            _ => None,
        }
    }

    /// The same, to be changed.
    pub const fn boundary_shape_mut(&mut self) -> Option<&mut BoundaryShape> {
        match self {
            Self::Convex(shape) | Self::Stretch(shape) | Self::Lee(shape) => Some(shape),
            _ => None,
        }
    }

    /// The same with this shape, if it lays a boundary on one.
    #[must_use]
    pub fn on_shape(mut self, shape: BoundaryShape) -> Self {
        if let Some(own) = self.boundary_shape_mut() {
            *own = shape;
        }
        self
    }

    /// True if pins do not change the shape: they say at most where the embedding lies.
    pub const fn only_places_pins(&self) -> bool {
        matches!(self.traits().pins, PinUse::Placing)
    }

    /// True if the first step is one linear solve for positions, with the user's pins held.
    pub const fn begins_with_pins_held(&self) -> bool {
        self.traits().begins_with_pins_held
    }

    /// True if the method can meet constraints: pins beyond the two exact ones that fix the similarity.
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

/// Traits of a method: the options that count for it, and how it starts and ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "independent traits: a table of them")]
pub struct MethodTraits {
    /// Families of weights that can be chosen.
    pub families: FamilyChoice,
    /// Default family of weights.
    pub usual_family: Family,
    /// Default limit of iterations; none for a method that does not iterate.
    pub iterations: Option<usize>,
    /// True if the method takes more steps than one linear solve.
    pub takes_steps: bool,
    /// True if every step on the way to the constraints is one-to-one.
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
    /// Traits that an entry of the table does not name.
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
    /// None: the weights are the method's own.
    None,
    /// Three-point families, which keep a free boundary.
    ThreePoint,
    /// All families: the boundary is convex.
    Any,
}

/// Layouts that a method can continue from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutUse {
    /// None: the method starts from the surface alone.
    None,
    /// One-to-one layouts only.
    Planar,
    /// All layouts, folded ones too.
    Any,
}

/// Effect of the user's pins on a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinUse {
    /// None: the method places the whole boundary.
    None,
    /// Position and size of the result, not its shape.
    Placing,
    /// The similarity, by up to two pins: they shape the first solve, but cannot be constraints.
    Gauge,
    /// Constraints: any number of pins.
    Constraints,
}

/// A convex boundary stands for all shapes, as does another method with one, for shapes are a choice of their own.
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

    #[expect(clippy::too_many_lines, reason = "a table: an entry for each method")]
    fn labels(&self) -> Labels {
        match self {
            Self::Auto => Labels::new("auto", "Auto (ladder)")
                .about(
                    "one way after another, the least costly first, until the map is proved one-to-one and \
                     meets the constraints",
                )
                .source("paper §3.3, §4, §5, and beyond"),
            Self::Natural => Labels::new("natural", "Natural boundary")
                .about("free boundary from two pins or yours, one linear solve")
                .source("paper §3.3, eq. 2 and 3"),
            Self::Iterate => Labels::new("iterate", "Mean-value iteration")
                .about("natural boundary, then solved again and again with mean-value weights of its own embedding")
                .source("paper §4"),
            Self::VirtualBoundary => Labels::new("virtual-boundary", "Virtual boundary")
                .about("natural boundary, then mesh and outside embedded together within a convex outline")
                .source("paper §5"),
            Self::Convex(_) => Labels::new("convex", "Convex boundary")
                .about("boundary on a convex shape (--boundary), inside at barycentres")
                .source("Tutte 1963, Floater 1997"),
            Self::Stretch(_) => Labels::new("stretch", "Stretch minimising")
                .about(
                    "convex boundary (--boundary), weights divided by stretch solve after solve, until the L² stretch \
                     no longer falls",
                )
                .source("Yoshizawa, Belyaev and Seidel 2004"),
            Self::Lee(_) => Labels::new("lee", "Lee's virtual boundary")
                .about(
                    "layers of triangles around the mesh (--layers), the outermost on a convex shape (--boundary), peeled \
                     off after the solve; planar where weights are positive, but not even a flat mesh comes back",
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
                    "symmetric Dirichlet energy lowered from Tutte's map on a circle, no face folded; its boundary may \
                     cross itself",
                )
                .source("Rabinovich et al. 2017"),
            Self::Spectral => Labels::new("spectral", "Spectral conformal")
                .about("the least conformal energy of all maps with one size of boundary: no pins, an eigenvector")
                .source("Mullen et al. 2008"),
            Self::Abf => Labels::new("abf", "Angle based")
                .about(
                    "the angles nearest to the surface's that make a plane, by a system of all angles and conditions",
                )
                .source("Sheffer, de Sturler 2001"),
            Self::AbfPlusPlus => Labels::new("abf++", "Angle based, reduced")
                .about("the same angles by a system of two unknowns per inner vertex: many times faster")
                .source("Sheffer et al. 2005"),
            Self::Continuation => Labels::new("continuation", "Continuation")
                .about("from a planar map without constraints to their targets, one-to-one all the way")
                .source("ours; energy of Garanzha et al. 2021"),
            Self::Matchmaker => Labels::new("matchmaker", "Matchmaker")
                .about(
                    "paths between the constraints, with new vertices where they need room, made straight in the plane",
                )
                .source("Eckstein et al. 2001; Kraevoy et al. 2003"),
            Self::Schnyder => Labels::new("schnyder", "Schnyder's grid")
                .about("whole numbers on a grid, planar by theorem whatever the mesh; then relaxed")
                .source("Schnyder 1990"),
        }
    }
}
