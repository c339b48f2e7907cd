//! Mathematics between the document and its pixels: cameras, picking, draw arrays, colour scales.
//!
//! Here f64 becomes f32. This module depends on neither screen nor graphics card, so all of it is tested without
//! them.
//!
//! | file | content |
//! |---|---|
//! | `space.rs` | extents, and unit space |
//! | `elements.rs` | sets of vertices, edges or faces, and the element under a point |
//! | `vertex_sets.rs` | sets of vertices that follow from others, such as grown ones |
//! | `edge_loops.rs` | edge loops and rings |
//! | `orbit.rs`, `plane.rs` | the cameras of the two panes |
//! | `pick.rs`, `ray_hit.rs`, `kdtree.rs` | picking under the pointer, and its searches |
//! | `draw.rs`, `picture.rs` | arrays for the graphics card, and normals; pictures with their smaller sizes |
//! | `colour.rs` | scales of colours with their legends; the colours of the panes |
//! | `beside.rs` | embeddings side by side, under one camera |
//! | `comparison.rs` | the picture of several methods side by side |
//! | `morph.rs` | a morph through the maps of several methods, as an animated picture |
//! | `quantity.rs` | numbers that faces are coloured by, on one scale for several embeddings |
//!
//! Spaces, as named in the code:
//!
//! | space     | meaning                                                                                  |
//! |-----------|-----------------------------------------------------------------------------------------|
//! | world     | the mesh's own units, f64                                                               |
//! | embedding | the plane's own units, f64                                                              |
//! | unit      | world or embedding moved and scaled into [−1, 1], as the GPU holds it, f32               |
//! | clip      | clip space of the graphics card: x, y in [−1, 1], y up, z in [0, 1]                      |
//! | pane      | points from a pane's upper left corner, y down                                          |

mod beside;
mod colour;
mod comparison;
mod draw;
mod edge_loops;
mod elements;
mod kdtree;
mod morph;
mod orbit;
mod pick;
mod picture;
mod plane;
mod quantity;
mod ray_hit;
mod space;
mod vertex_sets;

pub use beside::{CellFrame, CellFrames};
pub use colour::{Palette, Range, Scale, Srgb, Tick, nice_step_at_least};
pub use comparison::{CellShading, ComparisonPicture};
pub use draw::{DrawnFaces, EdgeList, FacePaint, MeshArrays, PlaneArrays, Revision, crease_normals};
use edge_loops::EdgeLoops;
pub use elements::{ElementKind, ElementMesh, ElementSet, MeshEdge, MeshElement, MeshPart, distance_to_segment};
pub use kdtree::PlanePicker;
pub use morph::{MorphPicture, MorphPlace, MorphSight};
pub use orbit::{OrbitCamera, Ray, UpAxis};
pub use pick::{PICK_RADIUS, SurfaceHit, SurfacePicker, VertexPick, Visibility, snapped};
pub use picture::PictureQuad;
pub use plane::{GridLines, PlaneCamera};
pub use quantity::Quantity;
#[cfg(feature = "gui")]
pub(crate) use space::split_point;
pub use space::{Sphere, UnitPlane, bounds_of, part_around};
pub use vertex_sets::VertexSets;
