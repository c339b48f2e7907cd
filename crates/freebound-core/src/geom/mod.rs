//! The plane: exact predicates on points, segments and closed polygons, convex hulls, and pictures. Knows no mesh.
//!
//! | file | what |
//! |---|---|
//! | `orient.rs`, `along.rs` | the side of a line that a point lies on, and the order of points along a direction, exactly |
//! | `bounds.rs`, `clip.rs`, `box_tree.rs` | boxes; segments and polygons cut to one; which of many boxes meet |
//! | `polygon.rs`, `crossings.rs` | turning and winding numbers of a closed polygon; where it meets itself |
//! | `convex_polygon.rs` | a convex polygon that a person gives |
//! | `kernel.rs` | the points that see all of a polygon |
//! | `hull.rs`, `rectangle.rs` | the convex hull, and whether a point lies inside; the rectangle of the least area around points |
//! | `packing.rs` | boxes packed into a picture |
//! | `triangulation.rs` | triangulations of points, and of what lies outside a polygon |
//! | `similarity.rs` | the similarity that fits pairs of points best; whether pairs look mirrored |
//! | `power.rs` | powers of two as factors |
//! | `picture.rs`, `picture_frame.rs` | a picture, and how texture coordinates lie in the plane |

mod bounds;
mod box_tree;
mod clip;
mod convex_polygon;
mod crossings;
mod hull;
mod order_along_direction;
mod orient;
mod packing;
mod picture;
mod picture_frame;
mod polygon;
mod power;
mod random;
mod rectangle;
mod similarity;
mod triangulation;
mod visibility_kernel;

pub use bounds::Bounds;
pub use box_tree::{BoxTree, place_along_curve};
pub use clip::{clip_polygon, clip_segment};
pub use convex_polygon::{ConvexPolygon, PolygonFault};
pub use crossings::{CROSSINGS_LISTED, Crossings, crossings, folds_back, is_simple, segments_meet};
pub use hull::{convex_hull, is_inside_hull};
pub use order_along_direction::order_along;
pub use orient::{Orientation, double_area, orientation};
pub use packing::{Packed, Packing, PackingOptions, pack};
pub use picture::Picture;
pub use picture_frame::{PictureFrame, VAxis};
pub use polygon::{is_down, turning_number, winding_number};
pub use power::power_of_two_near;
pub use random::Random;
pub use rectangle::least_box_turn;
pub use similarity::{Similarity, look_mirrored};
pub use triangulation::{constrained_triangles, delaunay_triangles, outside_triangles};
pub use visibility_kernel::{centre_of_gravity, kernel};
