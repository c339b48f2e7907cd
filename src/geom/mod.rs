//! The plane: exact predicates on points, segments and closed polygons, convex hulls, and pictures. Knows no mesh.
//!
//! | file | what |
//! |---|---|
//! | `orient.rs` | the side of a line that a point lies on, exactly |
//! | `bounds.rs` | boxes |
//! | `polygon.rs`, `crossings.rs` | turning and winding numbers of a closed polygon; where it meets itself |
//! | `hull.rs` | the convex hull |
//! | `delaunay.rs`, `outside.rs`, `spade_points.rs` | triangulations of points, and of what lies outside a polygon |
//! | `similarity.rs` | the similarity that fits pairs of points best |
//! | `picture.rs`, `picture_frame.rs` | a picture, and how texture coordinates lie in the plane |

mod bounds;
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

pub use bounds::Bounds;
pub use crossings::{CROSSINGS_LISTED, Crossings, crossings, segments_meet};
pub use delaunay::delaunay_triangles;
pub use hull::convex_hull;
pub use orient::{Orientation, orientation};
pub use outside::outside_triangles;
pub use picture::Picture;
pub use picture_frame::{PictureFrame, VAxis};
pub use polygon::{turning_number, winding_number};
pub use similarity::Similarity;
