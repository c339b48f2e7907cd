//! The ways to an embedding: all that is said of them by name stands here.

use super::{BoundaryShape, Choice, Family, NoEquation, Settings, WeightSource, Words};

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
    /// A planar embedding's distortion lowered, one-to-one throughout. A rung only: what follows a method.
    Relax,
    /// Polygons that cannot be convex, cut into triangles. A rung only, too.
    Cut,
    /// The layout that was given to start from, as it is. A rung only, too.
    Given,
}

impl Method {
    /// Whether the choice of family matters.
    pub const fn uses_family(self) -> bool {
        matches!(self, Self::Auto | Self::Natural | Self::Iterate | Self::VirtualBoundary) || self.takes_any_family()
    }

    /// Whether it goes with families that want a convex boundary.
    pub const fn takes_any_family(self) -> bool {
        matches!(self, Self::Convex(_) | Self::Lee(_))
    }

    /// Whether it puts layers of virtual triangles around the mesh.
    pub const fn is_padded(self) -> bool {
        matches!(self, Self::Lee(_))
    }

    /// The family, where nobody says.
    pub fn usual_family(self) -> Family {
        if matches!(self, Self::Lee(_)) { Family::MeanValue } else { Family::default() }
    }

    /// Whether it iterates, so that a limit of its steps matters.
    pub const fn iterates(self) -> bool {
        matches!(self, Self::Auto | Self::Iterate | Self::Stretch(_) | Self::Slim)
    }

    /// The most iterations, where nobody says: mean-value ones, solves of less stretch, or those of SLIM.
    pub const fn usual_steps(self) -> usize {
        if matches!(self, Self::Slim) { 20 } else { Settings::MAX_STEPS }
    }

    /// Whether it takes more steps than one linear solve.
    pub const fn takes_steps(self) -> bool {
        !matches!(
            self,
            Self::Natural
                | Self::Convex(_)
                | Self::Lee(_)
                | Self::Lscm
                | Self::Levy
                | Self::Spectral
                | Self::Abf
                | Self::AbfPlusPlus
        )
    }

    /// Whether it keeps every step one-to-one on the way to the constraints.
    pub const fn is_one_to_one(self) -> bool {
        matches!(self, Self::Continuation | Self::Matchmaker | Self::Relax | Self::Cut)
    }

    /// Whether it can go on from a layout that is there.
    pub const fn goes_on_from_layout(self) -> bool {
        matches!(
            self,
            Self::Auto | Self::Iterate | Self::VirtualBoundary | Self::Continuation | Self::Matchmaker | Self::Relax
        )
    }

    /// Whether it can do so only where that is one-to-one.
    pub const fn needs_one_to_one_start(self) -> bool {
        self.goes_on_from_layout() && !matches!(self, Self::Iterate | Self::VirtualBoundary)
    }

    /// Whether it may bend the boundary, so that the growth of the pinned vertices matters.
    pub const fn bends_boundary(self) -> bool {
        matches!(self, Self::Auto | Self::VirtualBoundary)
    }

    /// Whether pins matter.
    pub const fn uses_pins(self) -> bool {
        !matches!(self, Self::Convex(_) | Self::Stretch(_))
    }

    /// The shape that it lays a boundary on.
    pub fn boundary_shape(mut self) -> Option<BoundaryShape> {
        self.boundary_shape_mut().copied()
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
    pub const fn on_shape(mut self, shape: BoundaryShape) -> Self {
        if let Some(own) = self.boundary_shape_mut() {
            *own = shape;
        }
        self
    }

    /// Whether the shape does not depend on pins: they say at most where the embedding is to lie.
    pub const fn only_places_pins(self) -> bool {
        matches!(self, Self::Schnyder | Self::Lee(_) | Self::Slim | Self::Spectral | Self::Abf | Self::AbfPlusPlus)
    }

    /// Whether its first step is one linear solve for positions, with the user's pins held.
    pub const fn begins_with_pins_held(self) -> bool {
        matches!(self, Self::Auto | Self::Natural | Self::Iterate | Self::VirtualBoundary | Self::Lscm | Self::Levy)
    }

    /// Whether it can be asked to meet constraints: pins beyond the two exact ones that fix the similarity.
    pub const fn takes_constraints(self) -> bool {
        self.uses_pins() && !self.only_places_pins() && !matches!(self, Self::VirtualBoundary)
    }

    /// Whether it has nothing of its own to do where there are no constraints.
    pub const fn only_meets_constraints(self) -> bool {
        matches!(self, Self::Continuation | Self::Matchmaker)
    }

    /// What the weights of its vertices' equations are computed from.
    ///
    /// # Errors
    ///
    /// Why vertices have no equations with a barycentre.
    pub const fn weight_source(self) -> Result<WeightSource, NoEquation> {
        match self {
            Self::Auto | Self::Natural | Self::Convex(_) | Self::Lee(_) | Self::Lscm | Self::Spectral => {
                Ok(WeightSource::Surface)
            }
            Self::Iterate => Ok(WeightSource::StepBefore),
            Self::VirtualBoundary => Ok(WeightSource::Extended),
            Self::Levy => Err(NoEquation::OfTriangles),
            Self::Stretch(_) => Err(NoEquation::OfStretch),
            Self::Schnyder => Err(NoEquation::OnGrid),
            Self::Abf | Self::AbfPlusPlus => Err(NoEquation::OfAngles),
            Self::Slim | Self::Continuation | Self::Matchmaker | Self::Relax | Self::Cut => Err(NoEquation::OfEnergy),
            Self::Given => Err(NoEquation::OfFile),
        }
    }

    /// What it is called as a rung: the way to a step.
    pub fn as_rung(self) -> &'static str {
        match self {
            Self::Natural => "natural boundary",
            Self::Iterate => "iteration",
            other => other.as_short_rung(),
        }
    }

    /// The same where there is little room.
    pub fn as_short_rung(self) -> &'static str {
        match self {
            Self::Iterate => "mean value",
            Self::VirtualBoundary => "virtual boundary",
            Self::Matchmaker => "new vertices",
            Self::Schnyder => "grid",
            Self::Relax => "relaxed",
            Self::Cut => "cut polygons",
            Self::Given => "file's layout",
            other => other.name(),
        }
    }
}

/// A convex boundary stands for all shapes, as does another method with one, for shapes are a choice of their own. Relaxing,
/// cutting and a layout that was given cannot be chosen: they are rungs only.
impl Choice for Method {
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
    fn words(self) -> Words {
        match self {
            Self::Auto => Words::new("auto", "Auto (ladder)")
                .about(
                    "one way after another, the least costly first, until the map is proved one-to-one and \
                     meets the constraints",
                )
                .source("paper §3.3, §4, §5, and beyond"),
            Self::Natural => Words::new("natural", "Natural boundary")
                .about("free boundary from two pins or yours, one linear solve")
                .source("paper §3.3, eq. 2 and 3"),
            Self::Iterate => Words::new("iterate", "Mean-value iteration")
                .about("natural boundary, then solved again and again with mean-value weights of its own embedding")
                .source("paper §4"),
            Self::VirtualBoundary => Words::new("virtual-boundary", "Virtual boundary")
                .about("natural boundary, then mesh and outside embedded together within a convex outline")
                .source("paper §5"),
            Self::Convex(_) => Words::new("convex", "Convex boundary")
                .about("boundary on a convex shape (--boundary), inside at barycentres")
                .source("Tutte 1963, Floater 1997"),
            Self::Stretch(_) => Words::new("stretch", "Stretch minimising")
                .about(
                    "convex boundary (--boundary), weights divided by stretch solve after solve, until the L² stretch \
                     no longer falls",
                )
                .source("Yoshizawa, Belyaev and Seidel 2004"),
            Self::Lee(_) => Words::new("lee", "Lee's virtual boundary")
                .about(
                    "layers of triangles around the mesh (--layers), the outermost on a convex shape (--boundary), peeled \
                     off after the solve; planar where weights are positive, but not even a flat mesh comes back",
                )
                .source("Lee, Kim and Lee 2002"),
            Self::Lscm => Words::new("lscm", "Least-squares conformal")
                .about("least-squares conformal map; equals natural with conformal weights")
                .source("Lévy et al. 2002"),
            Self::Levy => Words::new("levy", "Lévy, summed")
                .about("Lévy's triangle equations summed around each vertex")
                .source("paper §3.2"),
            Self::Slim => Words::new("slim", "SLIM")
                .about(
                    "symmetric Dirichlet energy lowered from Tutte's map on a circle, no face folded; its boundary may \
                     cross itself",
                )
                .source("Rabinovich et al. 2017"),
            Self::Spectral => Words::new("spectral", "Spectral conformal")
                .about("the least conformal energy of all maps with one size of boundary: no pins, an eigenvector")
                .source("Mullen et al. 2008"),
            Self::Abf => Words::new("abf", "Angle based")
                .about(
                    "the angles nearest to the surface's that make a plane, by a system of all angles and conditions",
                )
                .source("Sheffer, de Sturler 2001"),
            Self::AbfPlusPlus => Words::new("abf++", "Angle based, reduced")
                .about("the same angles by a system of two unknowns per inner vertex: many times faster")
                .source("Sheffer et al. 2005"),
            Self::Continuation => Words::new("continuation", "Continuation")
                .about("from a planar map without constraints to their targets, one-to-one all the way")
                .source("ours; energy of Garanzha et al. 2021"),
            Self::Matchmaker => Words::new("matchmaker", "Matchmaker")
                .about(
                    "paths between the constraints, with new vertices where they need room, made straight in the plane",
                )
                .source("Eckstein et al. 2001; Kraevoy et al. 2003"),
            Self::Schnyder => Words::new("schnyder", "Schnyder's grid")
                .about("whole numbers on a grid, planar by theorem whatever the mesh; then relaxed")
                .source("Schnyder 1990"),
            Self::Relax => Words::new("relax", "Relax")
                .about("lower distortion of a planar map, one-to-one throughout")
                .source("ours; energy of Garanzha et al. 2021"),
            Self::Cut => Words::new("cut", "Cut polygons")
                .about("polygons that cannot be convex, cut into triangles")
                .source("ours"),
            Self::Given => {
                Words::new("given", "File's layout").about("the texture coordinates of the mesh file, as they are")
            }
        }
    }
}
