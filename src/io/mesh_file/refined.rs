//! A file's mesh with new vertices, or with polygons cut into triangles: everything else as it was.

use std::collections::HashSet;

use super::{MeshFile, NO_TEXTURE, Statement, Texture};
use crate::mesh::{NewVertex, PolygonMesh, Refinement, Repaired, VertexId};
use crate::solver::Embedding;

/// The mesh of a file with the new vertices of a refinement of it.
#[derive(Debug)]
pub struct Refined {
    /// Vertices of the file keep their numbers, new ones follow. Polygons that are whole in the refinement stay as they are; any
    /// other is replaced by its triangles, in its place. Statements stay before the faces that they stood before. Texture coordinates
    /// are left out: they belong to the mesh as it was.
    pub mesh: MeshFile,
    /// For each corner the vertex of the refinement there, or [`NO_TEXTURE`].
    corners: Vec<u32>,
    /// For each vertex of the refinement whether it only fills a hole.
    is_virtual: Vec<bool>,
}

impl Refined {
    /// The mesh of a file, `source`, by a refinement of it, or of its repairs.
    ///
    /// # Panics
    ///
    /// If the refinement is of another mesh, with more polygons than this one.
    pub fn new(source: &MeshFile, repaired: Option<&Repaired>, refinement: &Refinement) -> Self {
        let disk = refinement.disk();
        let mut faces = Faces::of(source, repaired, refinement);
        let mut first_face = Vec::with_capacity(source.polygons.face_count());
        let mut triangles = disk.real_faces().peekable();
        for (number, polygon) in (0..).zip(0..source.polygons.face_count()) {
            first_face.push(faces.count());
            let mut own = Vec::new();
            while let Some(face) = triangles.next_if(|&face| disk.mesh().polygon(face) == number) {
                own.push(disk.face(face));
            }
            faces.push(polygon, number, &own);
        }
        assert!(triangles.next().is_none(), "a refinement of this mesh");
        let moved = |statement: &Statement| {
            let before_face = first_face.get(statement.before_face as usize).copied().unwrap_or(faces.count());
            Statement { before_face, text: statement.text.clone() }
        };
        let statements = source.statements.iter().map(moved).collect();
        let mut positions = source.polygons.positions.clone();
        positions.extend(refinement.new_vertices_of_surface().map(|(vertex, _)| disk.position(vertex) * disk.unit()));
        let mut is_virtual = vec![false; disk.vertex_count()];
        disk.virtual_vertices().into_iter().for_each(|vertex| is_virtual[vertex.index()] = true);
        let Faces { corners, textured, starts, face_of, new_vertices, .. } = faces;
        let are_triangles = starts.windows(2).all(|bounds| bounds[1] - bounds[0] == 3);
        let mesh = MeshFile {
            polygons: PolygonMesh { positions, corners, starts: (!are_triangles).then_some(starts) },
            texture: None,
            statements,
            source: source.source.as_ref().map(|file| file.changed(&face_of, &new_vertices)),
        };
        Self { mesh, corners: textured, is_virtual }
    }

    /// The coordinates of the refinement's vertices, one each, at the corners of the mesh.
    pub fn texture(&self, coordinates: &Embedding) -> Texture {
        let mut number_of = vec![NO_TEXTURE; self.is_virtual.len()];
        let mut kept = Vec::with_capacity(coordinates.len());
        for (vertex, &coordinate) in coordinates.iter().enumerate().filter(|(vertex, _)| !self.is_virtual[*vertex]) {
            number_of[vertex] = u32::try_from(kept.len()).expect("a mesh has fewer than 2^32 vertices");
            kept.push(coordinate);
        }
        let corners = self.corners.iter().map(|&of| number_of.get(of as usize).copied().unwrap_or(NO_TEXTURE));
        Texture { corners: corners.collect(), coordinates: kept }
    }
}

/// The faces as they are put together.
struct Faces<'a> {
    source: &'a PolygonMesh,
    /// The vertex of the refinement at each corner of the file, where that is not the file's own.
    vertices_at_corners: Option<Vec<Option<VertexId>>>,
    /// The file's polygons that are whole in the refinement.
    whole: HashSet<u32>,
    /// The number in the file of each vertex of the refinement; of a virtual one any.
    file_vertex: Vec<VertexId>,
    /// How many vertices the refinement begins with that are not new.
    old_count: usize,
    /// With ends as the file numbers them.
    new_vertices: Vec<NewVertex>,
    corners: Vec<VertexId>,
    /// For each corner the vertex of the refinement, or [`NO_TEXTURE`].
    textured: Vec<u32>,
    starts: Vec<u32>,
    /// For each face the file's face that it is or is a part of.
    face_of: Vec<u32>,
}

impl<'a> Faces<'a> {
    fn of(source: &'a MeshFile, repaired: Option<&Repaired>, refinement: &Refinement) -> Self {
        let disk = refinement.disk();
        let source = &source.polygons;
        let own = || source.positions.iter().enumerate().map(|(vertex, _)| VertexId::from_index(vertex)).collect();
        let mut file_vertex = repaired.map_or_else(own, |repaired| repaired.vertices_of(source));
        file_vertex.resize(disk.vertex_count(), VertexId::default());
        let mut new_vertices = Vec::new();
        for (vertex, new) in refinement.new_vertices_of_surface() {
            file_vertex[vertex.index()] = VertexId::from_index(source.positions.len() + new_vertices.len());
            let [a, b] = new.edge.map(|end| file_vertex[end.index()]);
            new_vertices.push(if a <= b {
                NewVertex { edge: [a, b], at: new.at }
            } else {
                NewVertex { edge: [b, a], at: 1.0 - new.at }
            });
        }
        Self {
            source,
            vertices_at_corners: repaired.map(|repaired| repaired.vertices_at_corners(source)),
            whole: disk.polygons().map(|whole| disk.mesh().polygon(whole.first_face)).collect(),
            file_vertex,
            old_count: refinement.old_vertex_count(),
            new_vertices,
            corners: Vec::new(),
            textured: Vec::new(),
            starts: vec![0],
            face_of: Vec::new(),
        }
    }

    fn count(&self) -> u32 {
        u32::try_from(self.face_of.len()).expect("a mesh has fewer than 2^32 faces")
    }

    /// One polygon of the file, which these triangles of the refinement are parts of.
    fn push(&mut self, polygon: usize, number: u32, triangles: &[[VertexId; 3]]) {
        let range = self.source.corner_range(polygon);
        let is_old = triangles.as_flattened().iter().all(|corner| corner.index() < self.old_count);
        // One that has lost a corner by repairs is no longer whole.
        let is_whole = triangles.len() + 2 == range.len() && (triangles.len() == 1 || self.whole.contains(&number));
        if triangles.is_empty() || (is_old && is_whole) {
            self.corners.extend_from_slice(&self.source.corners[range.clone()]);
            self.textured.extend(range.map(|corner| self.vertex_at(corner)).collect::<Vec<u32>>());
            self.end_face(number);
            return;
        }
        for triangle in triangles {
            for vertex in triangle {
                let own = range.clone().find(|&corner| self.vertex_at(corner) == vertex.number());
                let in_place = self.file_vertex[vertex.index()];
                self.corners.push(own.map_or(in_place, |corner| self.source.corners[corner]));
            }
            self.textured.extend(triangle.map(VertexId::number));
            self.end_face(number);
        }
    }

    /// The vertex of the refinement at a corner of the file.
    fn vertex_at(&self, corner: usize) -> u32 {
        match &self.vertices_at_corners {
            None => self.source.corners[corner].number(),
            Some(vertices) => vertices[corner].map_or(NO_TEXTURE, VertexId::number),
        }
    }

    fn end_face(&mut self, number: u32) {
        self.starts.push(u32::try_from(self.corners.len()).expect("a mesh has fewer than 2^32 corners"));
        self.face_of.push(number);
    }
}
