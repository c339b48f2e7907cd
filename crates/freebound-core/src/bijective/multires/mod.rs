//! Coarse to fine: a disk with fewer vertices is solved first, and the others are put back one-to-one.
//!
//! | file | holds |
//! |---|---|
//! | `hierarchy.rs` | [`Hierarchy`]: vertices taken from a disk, round by round |
//! | `surface.rs` | the triangles of a round with those of the outside, and the neighbours of each vertex |
//! | `collapse.rs` | which neighbour a vertex may be moved onto |
//! | `level.rs` | [`Level`]: a disk of some of the vertices |
//! | `lift.rs` | the rounds backwards: all vertices put back |
//! | `place.rs` | one vertex put back into the polygon that it left |
//! | `sweep.rs` | vertices moved one after another to where their own triangles are least distorted |
//!
//! A vertex is taken by moving it onto a neighbour, where that leaves all triangles positive in a planar embedding, those of
//! the outside included. It is put back into the polygon of its neighbours in another embedding of what is left. That
//! polygon is star-shaped, seen from the corner that the vertex was moved onto, for the triangles that fill it are
//! positive: near that corner there is always room for it, but for rounding. So a planar embedding of the coarse disk
//! becomes one of the whole mesh.
//!
//! Where there is no planar embedding yet, vertices are taken by the shape of the surface alone, and the coarse disk is the
//! place to find one: whatever its embedding, if it is planar, all vertices can be put back.
//!
//! After L. Liu, C. Ye, R. Ni, X.-M. Fu, "Progressive parameterizations", 2018, and H. Shen, Z. Jiang, D. Zorin,
//! D. Panozzo, "Progressive embedding", 2019, from whom it differs in what guides the collapses (an embedding that is
//! planar already), in rounds of vertices that are far from each other, and in the boundary, which is made coarser too.

mod collapse;
mod hierarchy;
mod level;
mod place;
mod prolong;
mod relaxation_sweep;
mod surface;

pub use hierarchy::Hierarchy;
pub use level::Level;
pub use prolong::FineLevel;
