//! Methods whose embeddings stay one-to-one.
//!
//! | file | contents |
//! |---|---|
//! | `virtual_boundary`, `lee` | mesh and outside embedded together (paper §5); layers around the mesh |
//! | `continuation/`, `relaxing/`, `advance` | moving to the constraints; lowering distortion; result of both |
//! | `matchmaker/`, `clearance` | new vertices along paths; new vertices inside a pinned boundary |
//! | `convexity` | concave polygons of a one-to-one map made convex |
//! | `multires/` | coarsening of a disk, and prolongation back to the mesh |
//! | `drag/` | an embedding under a dragged pin or a brush, proved at every frame |
//! | `morph/` | a planar morph between two embeddings |
//! | `schnyder` | a grid drawing, planar by theorem |

mod advance;
pub(crate) mod clearance;
pub(crate) mod continuation;
pub(crate) mod convexity;
mod drag;
mod lee;
pub(crate) mod matchmaker;
mod morph;
pub mod multires;
pub(crate) mod relaxing;
mod schnyder;
mod virtual_boundary;

pub(crate) use advance::Advance;
pub use drag::{Blocker, Brush, BrushFrame, BrushKind, BrushSolver, DragFrame, DragSolver, DragTarget};
pub use lee::Padded;
pub use matchmaker::{Matched, matched, simplified, with_clearance};
pub use morph::{Morph, MorphOptions, NoMorph, Route, morph};
pub use schnyder::schnyder;
pub use virtual_boundary::{Extended, Outline, VirtualBoundary};
