//! Predicates, polygons and packing in the plane.

pub(crate) mod closed_polygon;
pub(crate) mod convex_polygon;
pub(crate) mod offset;
pub(crate) mod packing;
pub(crate) mod plane;
pub(crate) mod rectangle;
