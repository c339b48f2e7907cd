//! Geometry of the plane: exact predicates on points, segments and closed polygons, convex hulls, packing and
//! pictures. Knows no mesh.
//!
//! | file | contents |
//! |---|---|
//! | `orient.rs`, `order_along_direction.rs` | orientation of three points, order of points along a direction; exact |
//! | `bounds.rs`, `clip.rs`, `box_tree.rs` | boxes; segments and polygons clipped to a box; pairs of boxes that meet |
//! | `overlaps.rs` | pairs of triangles whose insides meet; exact |
//! | `polygon.rs`, `crossings.rs` | turning and winding numbers of a closed polygon; pairs of its edges that meet |
//! | `convex_polygon.rs` | convex polygon given by the user |
//! | `visibility_kernel.rs` | kernel of a polygon: the points that see all of it |
//! | `hull.rs`, `rectangle.rs` | convex hull and point-in-hull test; rectangle of least area around points |
//! | `offset.rs`, `pole.rs` | outline at a distance around a region; point of a region farthest from its outline |
//! | `packing/` | shapes of charts packed into a picture |
//! | `triangulation.rs` | triangulations of points and of the outside of a polygon |
//! | `similarity.rs` | similarity that best fits pairs of points; test for mirrored pairs |
//! | `power.rs` | powers of two as factors |
//! | `picture.rs`, `picture_frame.rs` | picture in memory; map between texture coordinates and the plane |
//! | `random.rs` | reproducible pseudo-random numbers |

mod bounds;
mod box_tree;
mod clip;
mod convex_polygon;
mod crossings;
mod hull;
mod offset;
mod order_along_direction;
mod orient;
mod overlaps;
mod packing;
mod picture;
mod picture_frame;
mod pole;
mod polygon;
mod power;
mod random;
mod rectangle;
mod similarity;
mod triangulation;
mod visibility_kernel;

pub use bounds::{Bounds, SpaceBounds};
pub use box_tree::{BoxTree, place_along_curve};
pub use clip::{clip_polygon, clip_segment};
pub use convex_polygon::{ConvexPolygon, PolygonFault};
pub use crossings::{CROSSINGS_LISTED, Crossings, crossings, folds_back, is_simple, segments_meet};
pub use hull::{convex_hull, is_inside_hull};
pub use offset::{OffsetJoins, OffsetOptions, offset_outward};
pub use order_along_direction::order_along;
pub(crate) use orient::point_key;
pub use orient::{Orientation, double_area, orientation};
pub(crate) use overlaps::overlaps;
pub use packing::{
    ChartShape, FIRST_UDIM_TILE, Packed, Packing, PackingInput, PackingOptions, Rotations, Stacking, corner_of_tile,
    pack,
};
pub use picture::Picture;
pub use picture_frame::{PictureFrame, VAxis};
pub use pole::{Pole, distance_to_loop, pole};
pub use polygon::{is_down, turning_number, winding_number};
pub use power::power_of_two_near;
pub use random::Random;
pub use rectangle::least_box_turn;
pub use similarity::{Similarity, look_mirrored};
pub use triangulation::{constrained_triangles, delaunay_triangles, outside_triangles};
pub use visibility_kernel::{centre_of_gravity, kernel};
