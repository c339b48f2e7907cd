//! Level of a hierarchy: a disk with fewer vertices, each with its number in the input mesh.

use glam::DVec2;

use crate::mesh::{DiskMesh, FaceId, TriMesh, VertexId};
use crate::problem::{Embedding, Pins};

/// Disk over some vertices of a mesh.
#[derive(Debug)]
pub struct Level {
    /// The disk.
    pub disk: DiskMesh,
    /// Number of each vertex in the input mesh, ascending.
    pub vertices: Vec<VertexId>,
}

impl Level {
    /// Disk of triangles over some vertices of a mesh. The last triangles are the virtual faces of the mesh. `None` if
    /// they do not form a disk.
    pub(super) fn new(mesh: &DiskMesh, triangles: &[[u32; 3]]) -> Option<Self> {
        let mut place = vec![u32::MAX; mesh.vertex_count()];
        triangles.iter().flatten().for_each(|&v| place[v as usize] = 0);
        let mut vertices = Vec::new();
        for vertex in mesh.vertices().filter(|&vertex| place[vertex.index()] == 0).collect::<Vec<_>>() {
            place[vertex.index()] = VertexId::from_index(vertices.len()).number();
            vertices.push(vertex);
        }
        let positions = vertices.iter().map(|&vertex| mesh.position(vertex)).collect();
        let real_count = triangles.len() - virtual_face_count(mesh);
        let polygon_of = (real_count < triangles.len()).then(|| {
            let of_virtual = mesh.faces().skip(mesh.real_faces().len()).map(|face| mesh.mesh().polygon(face));
            (0..real_count).map(|face| FaceId::from_index(face).number()).chain(of_virtual).collect()
        });
        let triangles = triangles.iter().map(|t| t.map(|v| VertexId::new(place[v as usize]))).collect();
        let disk = DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of }).ok()?;
        Some(Self { disk, vertices })
    }

    /// Restriction of an embedding of the input mesh to this level.
    pub fn part_of(&self, points: &[DVec2]) -> Embedding {
        self.vertices.iter().map(|vertex| points[vertex.index()]).collect()
    }

    /// Restriction of pins of the input mesh to this level.
    pub fn pins_of(&self, pins: &Pins) -> Pins {
        let of = |(place, vertex): (usize, &VertexId)| Some((VertexId::from_index(place), *pins.get(vertex)?));
        self.vertices.iter().enumerate().filter_map(of).collect()
    }

    /// Writes the positions of this level's vertices into positions of the input mesh.
    pub(super) fn put_into(&self, embedding: &Embedding, points: &mut [DVec2]) {
        for (vertex, z) in self.vertices.iter().zip(embedding) {
            points[vertex.index()] = *z;
        }
    }
}

/// Number of faces that fill holes.
pub(super) fn virtual_face_count(mesh: &DiskMesh) -> usize {
    mesh.face_count() - mesh.real_faces().len()
}
