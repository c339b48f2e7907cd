//! Coarse to fine: solves a disk with fewer vertices first, then puts the other vertices back one-to-one.
//!
//! | file | contents |
//! |---|---|
//! | `hierarchy.rs` | [`Hierarchy`]: removal of vertices from a disk, round by round |
//! | `surface.rs` | triangles of a round with those of the outside, and the neighbours of each vertex |
//! | `collapse.rs` | choice of the neighbour that a vertex is moved onto |
//! | `level.rs` | [`Level`]: a disk of some of the vertices |
//! | `prolong.rs` | rounds in reverse: all vertices put back |
//! | `place.rs` | one vertex put back into the polygon that it left |
//! | `relaxation_sweep.rs` | vertices moved one after another to where their own triangles are least distorted |
//!
//! A vertex is removed by a collapse onto a neighbour that leaves all triangles of a planar embedding positive,
//! including those of the outside. Later it is put back into the polygon of its neighbours in another embedding of the
//! remaining disk. Because the triangles that fill this polygon are positive, the polygon is star-shaped, seen from
//! the collapse corner. Near that corner there is always room for the vertex, except for rounding. A planar embedding
//! of the coarse disk thus extends to the whole mesh.
//!
//! Without a planar embedding, vertices are removed by the shape of the surface alone. Then the coarse disk is the
//! place to find a planar embedding: all vertices can be put back into any such embedding.
//!
//! After L. Liu, C. Ye, R. Ni, X.-M. Fu, "Progressive parameterizations", 2018, and H. Shen, Z. Jiang, D. Zorin,
//! D. Panozzo, "Progressive embedding", 2019. Three things differ: an embedding that is planar already guides the
//! collapses, each round removes vertices that are far from each other, and the boundary is coarsened too.

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
