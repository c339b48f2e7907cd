//! Connectivity and 3D positions of a triangle mesh. Knows nothing of the plane.
//!
//! | file | what |
//! |---|---|
//! | `ids.rs` | typed indices of vertices, halfedges, edges, faces |
//! | `parts.rs` | the parts of a surface that hang together, each with its boundary loops |
//! | `polygon.rs`, `triangulate.rs`, `blockers.rs` | polygons as a file gives them, cut into triangles |
//! | `triangles.rs` | triangles that share vertices |
//! | `diagnosis.rs`, `fault.rs` | whether a mesh is a disk, and all that keeps it from being one |
//! | `edges.rs`, `topology.rs`, `orientation.rs`, `coincident.rs`, `union.rs`, `area.rs` | what the diagnosis looks at |
//! | `measure.rs` | a disk's unit, and lengths a little longer than in space where faces have no area |
//! | `unit.rs` | meshes of the largest and smallest sizes, brought to the middle of the range of numbers |
//! | `disk.rs` | a mesh proved to be a disk, with halfedges |
//! | `polygons.rs`, `diagonals.rs` | the polygons that a disk's triangles are cut from, and their other diagonals |
//! | `holes.rs` | virtual faces, which fill holes |
//! | `repair/` | what keeps a mesh from being a disk, mended; holes filled; surfaces cut open |
//! | `refinement.rs` | a disk with new vertices on its edges |
//! | `volume.rs` | which side of a surface is the outside |

mod area;
mod blockers;
mod coincident;
mod diagnosis;
mod diagonals;
mod disk;
mod edges;
mod fault;
mod holes;
mod ids;
mod measure;
mod orientation;
mod parts;
mod polygon;
mod polygons;
mod refinement;
mod repair;
mod scale;
mod topology;
mod triangles;
mod triangulate;
mod union;
mod volume;

pub use diagnosis::{Diagnosis, diagnose};
pub use disk::DiskMesh;
pub use edges::EdgeTable;
pub use fault::{Elements, FaceList, Fault};
pub use holes::{FIRST_HOLE, Hole};
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub(crate) use measure::triangle_of_sides;
pub use parts::{Part, parts};
pub use polygon::PolygonMesh;
pub use polygons::Polygon;
pub use refinement::{CutMesh, NewVertex, Refinement};
pub use repair::{
    Chart, Charts, Done, EdgePaths, HoleTreatment, PartFaces, PathTree, Preparation, Repair, Repaired, Repairs, Seams,
    WeldDistance, borders, creases, near_vertices,
};
pub use triangles::TriMesh;
pub use volume::relative_volume;
