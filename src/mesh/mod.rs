//! Connectivity and 3D positions of a triangle mesh. Knows nothing of the plane.

mod area;
mod diagnosis;
mod disk;
mod edges;
mod fault;
mod ids;
mod orientation;
mod polygon;
mod refinement;
mod topology;
mod triangles;
mod triangulate;
mod union;
mod volume;

pub use diagnosis::{Diagnosis, diagnose};
pub use disk::DiskMesh;
pub use edges::EdgeTable;
pub use fault::{Elements, FaceList, Fault};
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use polygon::PolygonMesh;
pub use refinement::{NewVertex, Refinement};
pub use triangles::TriMesh;
pub use volume::relative_volume;
