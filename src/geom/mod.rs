//! The plane: exact predicates on points, segments and closed polygons, convex hulls, and pictures. Knows no mesh.

mod crossings;
mod delaunay;
mod hull;
mod orient;
mod outside;
mod picture;
mod picture_frame;
mod polygon;
mod similarity;
mod spade_points;

pub use crossings::{CROSSINGS_LISTED, Crossings, crossings, segments_meet};
pub use delaunay::delaunay_triangles;
pub use hull::convex_hull;
pub use orient::{Orientation, orientation};
pub use outside::outside_triangles;
pub use picture::Picture;
pub use picture_frame::{PictureFrame, VAxis};
pub use polygon::{turning_number, winding_number};
pub use similarity::Similarity;
