//! Methods from settings and pins to proved steps; holes, harmless faults, starts from an embedding.

pub(crate) mod convex_polygons;
pub(crate) mod harmless;
pub(crate) mod holes;
pub(crate) mod ladder;
pub(crate) mod pins;
pub(crate) mod start;
