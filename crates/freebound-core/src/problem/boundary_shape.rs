//! The convex shapes that a boundary is laid on, and how far apart its vertices lie there.

use std::borrow::Cow;

use super::{Labels, NamedOption};
use crate::geom::ConvexPolygon;

/// The shape that [`Method::Convex`](super::Method::Convex) and others lay a boundary on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum BoundaryShape {
    /// A circle.
    #[default]
    Circle,
    /// A square, its corners at vertices.
    Square,
    /// The hull of the boundary's projection to its best plane.
    Hull,
    /// A polygon of the user's, its corners at vertices.
    Polygon(ConvexPolygon),
}

impl BoundaryShape {
    /// How a polygon is written, in front of its corners.
    pub const POLYGON: &str = "polygon:";
}

impl NamedOption for BoundaryShape {
    const ALL: &'static [Self] = &[Self::Circle, Self::Square, Self::Hull, Self::Polygon(ConvexPolygon::HEXAGON)];

    fn labels(&self) -> Labels {
        match self {
            Self::Circle => Labels::new("circle", "Circle").about("a circle"),
            Self::Square => Labels::new("square", "Square").about("a square"),
            Self::Hull => Labels::new("hull", "Hull").about("the hull of the boundary's projection to its best plane"),
            Self::Polygon(_) => Labels::new("polygon:CORNERS", "Polygon").about("a convex polygon of yours"),
        }
    }

    fn written(&self) -> Cow<'static, str> {
        match self {
            Self::Polygon(polygon) => format!("{}{polygon}", Self::POLYGON).into(),
            named => named.name().into(),
        }
    }

    fn named(text: &str) -> Option<Self> {
        match text.strip_prefix(Self::POLYGON) {
            Some(corners) => ConvexPolygon::parse(corners).ok().map(Self::Polygon),
            None => Self::ALL.iter().find(|shape| shape.name() == text).cloned(),
        }
    }
}

/// How far apart vertices lie on the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// As far as in space, in proportion.
    #[default]
    Chord,
    /// All alike.
    Even,
}

impl NamedOption for Spacing {
    const ALL: &'static [Self] = &[Self::Chord, Self::Even];

    fn labels(&self) -> Labels {
        match self {
            Self::Chord => {
                Labels::new("chord", "By length").about("boundary vertices lie as far apart as in space, in proportion")
            }
            Self::Even => Labels::new("even", "Even").about("boundary vertices lie evenly along the shape"),
        }
    }
}
