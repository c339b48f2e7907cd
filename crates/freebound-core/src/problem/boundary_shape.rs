//! Convex shapes for a boundary, and the spacing of its vertices on them.

use std::borrow::Cow;

use super::{Labels, NamedOption};
use crate::geom::ConvexPolygon;

/// Shape that [`Method::Convex`](super::Method::Convex) and other methods lay the boundary on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum BoundaryShape {
    /// A circle.
    #[default]
    Circle,
    /// A square with vertices at its corners.
    Square,
    /// Convex hull of the boundary's projection to its best plane.
    Hull,
    /// A polygon of the user's, with vertices at its corners.
    Polygon(ConvexPolygon),
}

impl BoundaryShape {
    /// Prefix of a written polygon, before its corners.
    pub const POLYGON: &str = "polygon:";
}

impl NamedOption for BoundaryShape {
    const ALL: &'static [Self] = &[Self::Circle, Self::Square, Self::Hull, Self::Polygon(ConvexPolygon::HEXAGON)];

    fn labels(&self) -> Labels {
        match self {
            Self::Circle => Labels::new("circle", "Circle").about("a circle"),
            Self::Square => Labels::new("square", "Square").about("a square"),
            Self::Hull => {
                Labels::new("hull", "Hull").about("the convex hull of the boundary, projected to its best plane")
            }
            Self::Polygon(_) => Labels::new("polygon:CORNERS", "Polygon").about("your convex polygon"),
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

/// Spacing of the boundary vertices on the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// In proportion to lengths in space.
    #[default]
    Chord,
    /// All distances equal.
    Even,
}

impl NamedOption for Spacing {
    const ALL: &'static [Self] = &[Self::Chord, Self::Even];

    fn labels(&self) -> Labels {
        match self {
            Self::Chord => Labels::new("chord", "By length")
                .about("distances between boundary vertices in proportion to their lengths in space"),
            Self::Even => {
                Labels::new("even", "Even").about("equal distances between boundary vertices along the shape")
            }
        }
    }
}
