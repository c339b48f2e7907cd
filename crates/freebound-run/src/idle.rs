//! Options that do not apply to a method.

use freebound_core::problem::Method;

/// Option of a run that applies to some methods only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodOption {
    /// Shape of the boundary.
    Boundary,
    /// Spacing of vertices on the shape.
    Spacing,
    /// Number of layers of virtual triangles.
    Layers,
    /// Family of weights.
    Family,
    /// Pinned vertices.
    Pins,
    /// Treatment of the equations of pinned vertices.
    Treatment,
    /// Largest number of iterations.
    MaxSteps,
    /// Permission to split edges.
    NewVertices,
    /// Layout to start from.
    Start,
    /// Growth of the pinned boundary.
    Growth,
}

impl MethodOption {
    /// Reason why a method does not use the option. `None` if it does.
    pub fn unused_by(self, method: &Method) -> Option<&'static str> {
        let of_shape = "only convex, stretch and lee have a boundary shape";
        let (is_used, why) = match self {
            Self::Boundary | Self::Spacing => (method.boundary_shape().is_some(), of_shape),
            Self::Layers => (method.is_padded(), "only lee puts layers around the mesh"),
            Self::Family if method.is_one_to_one() => (method.uses_family(), "it solves no weighted equations"),
            Self::Family => (method.uses_family(), "its weights are fixed"),
            Self::Pins => (method.uses_pins(), "it places the whole boundary itself"),
            Self::Treatment if method.uses_pins() => {
                (!method.only_places_pins(), "its equations do not depend on pins")
            }
            Self::Treatment => (false, "it places the whole boundary itself"),
            Self::MaxSteps => (method.iterates(), "it does not iterate"),
            Self::NewVertices if *method == Method::Matchmaker => (false, "it always adds vertices"),
            Self::NewVertices => (*method == Method::Auto, "only auto has this choice"),
            Self::Start => (method.continues_from_layout(), "it computes its map from the surface alone"),
            Self::Growth => (method.bends_boundary(), "only auto and virtual-boundary use it"),
        };
        (!is_used).then_some(why)
    }
}
