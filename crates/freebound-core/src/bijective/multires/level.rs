//! A surface with fewer vertices: a disk of its own, whose vertices know their numbers in the mesh as given.

use glam::DVec2;

use crate::mesh::{DiskMesh, TriMesh, VertexId};
use crate::problem::{Embedding, Pins};

/// A disk of some of a mesh's vertices.
#[derive(Debug)]
pub struct Level {
    /// The disk.
    pub disk: DiskMesh,
    /// For each of its vertices the number in the mesh as given, ascending.
    pub vertices: Vec<VertexId>,
}

impl Level {
    /// Triangles over some of a mesh's vertices; `None` where they are no disk.
    pub(super) fn new(mesh: &DiskMesh, triangles: &[[u32; 3]]) -> Option<Self> {
        let mut place = vec![u32::MAX; mesh.vertex_count()];
        triangles.iter().flatten().for_each(|&v| place[v as usize] = 0);
        let mut vertices = Vec::new();
        for vertex in mesh.vertices().filter(|&vertex| place[vertex.index()] == 0).collect::<Vec<_>>() {
            place[vertex.index()] = VertexId::from_index(vertices.len()).number();
            vertices.push(vertex);
        }
        let positions = vertices.iter().map(|&vertex| mesh.position(vertex)).collect();
        let triangles = triangles.iter().map(|t| t.map(|v| VertexId::new(place[v as usize]))).collect();
        let disk = DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of: None }).ok()?;
        Some(Self { disk, vertices })
    }

    /// Its part of an embedding of the mesh as given.
    pub fn part_of(&self, points: &[DVec2]) -> Embedding {
        self.vertices.iter().map(|vertex| points[vertex.index()]).collect()
    }

    /// Its part of pins of the mesh as given.
    pub fn pins_of(&self, pins: &Pins) -> Pins {
        let of = |(place, vertex): (usize, &VertexId)| Some((VertexId::from_index(place), *pins.get(vertex)?));
        self.vertices.iter().enumerate().filter_map(of).collect()
    }

    /// Lays its vertices among those of the mesh as given.
    pub(super) fn put_into(&self, embedding: &Embedding, points: &mut [DVec2]) {
        for (vertex, z) in self.vertices.iter().zip(embedding) {
            points[vertex.index()] = *z;
        }
    }
}
