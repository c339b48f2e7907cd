//! A mesh with new vertices on its edges: the same surface, split into more triangles.
//!
//! New vertices lie on *old* edges, the edges of the given mesh, and are numbered after the old vertices. A face with
//! new vertices on its sides is split into parts; all other faces stay unchanged. So the surface does not change, and
//! every old vertex keeps its number.

use std::collections::{BTreeMap, BTreeSet};

use super::measure::Measure;
use super::{Diagnosis, DiskMesh, FaceId, Polygon, TriMesh, VertexId};

/// A new vertex on an edge of the given mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewVertex {
    /// Ends of the edge, the lower number first.
    pub edge: [VertexId; 2],
    /// Parameter along the edge: 0 at its first end, 1 at its second, strictly between them.
    pub at: f64,
}

/// A mesh with new vertices, and the origin of each of its parts.
#[derive(Clone, Debug)]
pub struct Refinement {
    disk: DiskMesh,
    new_vertices: Vec<NewVertex>,
    /// Old face that each face is, or is a part of.
    source: Vec<FaceId>,
}

/// A mesh whose faces are split into parts, before its halfedges are joined.
#[derive(Debug)]
pub struct CutMesh {
    mesh: TriMesh,
    measure: Measure,
    /// Polygons of the given mesh, by their numbers in the file.
    old_polygons: BTreeSet<u32>,
    new_vertices: Vec<NewVertex>,
    source: Vec<FaceId>,
}

impl CutMesh {
    /// Joins the parts to a disk.
    ///
    /// # Errors
    ///
    /// The faults that keep the parts from being a disk.
    pub fn join(self) -> Result<Refinement, Box<Diagnosis>> {
        let Self { mesh, measure, old_polygons, new_vertices, source } = self;
        let old_count = mesh.vertex_count() - new_vertices.len();
        let disk = DiskMesh::of_topology(mesh)?.measured_by(measure);
        let is_whole = |polygon: &Polygon<'_>, of: &TriMesh| {
            let is_old = polygon.corners.iter().all(|corner| corner.index() < old_count);
            is_old && old_polygons.contains(&of.polygon(polygon.first_face))
        };
        Ok(Refinement { disk: disk.with_polygons_where(is_whole), new_vertices, source })
    }
}

impl Refinement {
    /// Splits faces of a mesh into parts. New vertices are numbered after the old ones. The parts of a face replace it
    /// in the face order; faces without an entry stay whole.
    ///
    /// # Errors
    ///
    /// The faults that keep the parts from being a disk.
    pub fn new(
        mesh: &DiskMesh,
        new_vertices: Vec<NewVertex>,
        parts: &BTreeMap<FaceId, Vec<[VertexId; 3]>>,
    ) -> Result<Self, Box<Diagnosis>> {
        Self::cut(mesh, new_vertices, parts).join()
    }

    /// Splits faces like [`Refinement::new`], without joining the parts to a disk.
    pub fn cut(mesh: &DiskMesh, new_vertices: Vec<NewVertex>, parts: &BTreeMap<FaceId, Vec<[VertexId; 3]>>) -> CutMesh {
        let (old, measure) = (mesh.mesh(), mesh.measure());
        let mut positions = old.positions.clone();
        positions.extend(new_vertices.iter().map(|new| {
            let [a, b] = new.edge.map(|v| mesh.position(v));
            a.lerp(b, new.at)
        }));
        let (mut triangles, mut source) = (Vec::new(), Vec::new());
        for face in mesh.faces() {
            let whole = [mesh.face(face)];
            let parts: &[[VertexId; 3]] = parts.get(&face).map_or(&whole, |parts| parts);
            triangles.extend_from_slice(parts);
            source.extend(std::iter::repeat_n(face, parts.len()));
        }
        let polygon_of = Some(source.iter().map(|&face| old.polygon(face)).collect());
        let old_polygons = mesh.polygons().map(|polygon| old.polygon(polygon.first_face)).collect();
        let mesh = TriMesh { positions, triangles, polygon_of };
        CutMesh { mesh, measure, old_polygons, new_vertices, source }
    }

    /// Returns a mesh without the polygons that begin with `first_faces`, ascending: only their triangles remain.
    ///
    /// # Errors
    ///
    /// None for a mesh proved to be a disk.
    pub fn of_cut_polygons(mesh: &DiskMesh, first_faces: &[FaceId]) -> Result<Self, Box<Diagnosis>> {
        Self::new(mesh, Vec::new(), &BTreeMap::new()).map(|whole| whole.without_polygons(first_faces))
    }

    /// Removes the polygons that begin with `first_faces`, ascending: only their triangles remain.
    #[must_use]
    pub fn without_polygons(self, first_faces: &[FaceId]) -> Self {
        let is_whole = |polygon: &Polygon<'_>, _: &TriMesh| first_faces.binary_search(&polygon.first_face).is_err();
        Self { disk: self.disk.with_polygons_where(is_whole), ..self }
    }

    /// The mesh with its new vertices, as a disk.
    pub fn disk(&self) -> &DiskMesh {
        &self.disk
    }

    /// New vertices, in the order of their numbers.
    pub fn new_vertices(&self) -> &[NewVertex] {
        &self.new_vertices
    }

    /// Number of vertices of the given mesh.
    pub fn old_vertex_count(&self) -> usize {
        self.disk.vertex_count() - self.new_vertices.len()
    }

    /// Old face that a face is, or is a part of.
    pub fn source_of(&self, face: FaceId) -> FaceId {
        self.source[face.index()]
    }

    /// Polygons of the given mesh that are triangulated here, by their numbers in the file.
    pub fn cut_polygons(&self, given: &DiskMesh) -> Vec<FaceId> {
        let numbers = |disk: &DiskMesh| -> BTreeSet<u32> {
            disk.polygons().map(|polygon| disk.mesh().polygon(polygon.first_face)).collect()
        };
        numbers(given).difference(&numbers(&self.disk)).copied().map(FaceId::new).collect()
    }

    /// New vertices on the surface, with their numbers. New vertices within holes are left out.
    pub fn new_vertices_of_surface(&self) -> impl Iterator<Item = (VertexId, &NewVertex)> {
        let numbers = (self.old_vertex_count()..).map(VertexId::from_index);
        numbers.zip(&self.new_vertices).filter(|(vertex, _)| !self.disk.is_virtual_vertex(*vertex))
    }

    /// Old edges that are split, each once, ascending. Edges within holes are included.
    pub fn split_edges(&self) -> Vec<[VertexId; 2]> {
        each_once(self.new_vertices.iter())
    }

    /// Old edges of the surface that are split, each once, ascending. Edges within holes are left out.
    pub fn split_edges_of_surface(&self) -> Vec<[VertexId; 2]> {
        each_once(self.new_vertices_of_surface().map(|(_, new)| new))
    }
}

fn each_once<'a>(new_vertices: impl Iterator<Item = &'a NewVertex>) -> Vec<[VertexId; 2]> {
    let mut edges: Vec<[VertexId; 2]> = new_vertices.map(|new| new.edge).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
