//! Connectivity and 3D positions of a triangle mesh. Independent of the plane.
//!
//! | file | contents |
//! |---|---|
//! | `ids.rs` | typed indices of vertices, halfedges, edges, faces |
//! | `parts.rs` | edge-connected parts of a surface, each with its boundary loops |
//! | `polygon.rs`, `triangulate.rs`, `blockers.rs` | polygons as given by a file, and their triangulation |
//! | `triangles.rs` | triangles that share vertices |
//! | `diagnosis.rs`, `fault.rs` | disk test and all faults of a mesh |
//! | `edges.rs`, `topology.rs`, `orientation.rs`, `coincident.rs`, `union.rs`, `area.rs` | tests of the diagnosis |
//! | `measure.rs` | unit of a disk, and mollified lengths if faces have no area |
//! | `scale.rs` | scaling of extremely large and small meshes to the middle of the range of numbers |
//! | `disk.rs` | a mesh proved to be a disk, with halfedges |
//! | `polygons.rs`, `diagonals.rs` | polygons that a disk's triangles are cut from, and their other diagonals |
//! | `congruence.rs` | isomorphism of two surfaces whose lengths agree |
//! | `holes.rs` | virtual faces, which fill holes |
//! | `repair/` | repair of faults, filling of holes, cutting of surfaces |
//! | `refinement.rs` | a disk with new vertices on its edges |
//! | `triangle_tree.rs` | nearest triangle, and triangles of a region, by a tree of boxes |
//! | `volume.rs` | outside of an open surface |

mod area;
mod blockers;
mod coincident;
mod congruence;
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
mod triangle_tree;
mod triangles;
mod triangulate;
pub(crate) mod union;
mod volume;

pub(crate) use area::is_zero_area;
pub(crate) use congruence::{MeasuredSurface, SurfaceFaces, SurfaceKey};
pub use diagnosis::{Diagnosis, diagnose};
pub use disk::DiskMesh;
pub use edges::EdgeTable;
pub use fault::{Elements, FaceList, Fault};
pub use holes::{FIRST_HOLE, Hole};
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub(crate) use measure::{THINNEST, laid_flat, triangle_of_sides};
pub use parts::{Part, parts};
pub use polygon::PolygonMesh;
pub(crate) use polygon::place_key;
pub use polygons::Polygon;
pub use refinement::{CutMesh, NewVertex, Refinement};
pub use repair::{
    Chart, Charts, Done, EdgePaths, HoleTreatment, PartFaces, PathTree, Preparation, Repair, Repaired, Repairs, Seams,
    WeldDistance, borders, creases, near_vertices, splits,
};
pub use triangle_tree::{NearestPoint, TriangleTree, nearest_point, point_at};
pub use triangles::TriMesh;
pub use volume::relative_volume;
