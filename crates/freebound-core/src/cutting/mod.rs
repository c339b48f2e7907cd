//! Automatic seams: the shortest cut found whose map keeps the distortion below a bound.
//!
//! | file | contents |
//! |---|---|
//! | `surface.rs` | one connected part, its edges and boundary loops |
//! | `scale_factor.rs` | scale factors of the conformal map that is flat apart from the cut |
//! | `graph.rs` | cut graph: handles, boundary loops and cones joined by short seams |
//! | `mapping.rs` | maps along seams |
//! | `overlap.rs` | charts of a map that overlaps itself |
//! | `joining.rs` | charts joined with their neighbours |
//! | `rejoining.rs` | charts moved beside others that they can be joined with |
//! | `visibility.rs` | creases and hidden places, where a seam shows less |
//! | `search.rs` | search for the cheapest cut whose map meets a bound |

mod graph;
mod joining;
mod mapping;
mod overlap;
mod rejoining;
mod scale_factor;
mod search;
mod surface;
mod visibility;

pub(crate) use mapping::uncut_map;
pub use search::SeamOptions;
pub(crate) use search::{BestCut, PartCut, PartToCut};
pub(crate) use surface::EdgeCosts;
pub(crate) use visibility::costs_of_shape;
