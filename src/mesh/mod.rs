//! Connectivity and 3D positions of a triangle mesh. Knows nothing of the plane.

mod disk;
mod edges;
mod ids;
mod polygon;
mod triangles;

pub use disk::DiskMesh;
pub use edges::EdgeTable;
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use polygon::PolygonMesh;
pub use triangles::TriMesh;
