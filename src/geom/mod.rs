//! The plane: exact predicates on points, segments and closed polygons. Knows no mesh.

mod crossings;
mod orient;
mod polygon;

pub use crossings::{CROSSINGS_LISTED, Crossings, crossings, segments_meet};
pub use orient::{Orientation, orientation};
pub use polygon::{turning_number, winding_number};
