//! Edge-connected parts of a surface, each with its boundary loops: the charts of a layout.
//!
//! Fans of faces that meet only at a vertex are not connected by it: each fan has its own copy of the vertex.

use std::collections::HashSet;

use super::edges::EdgeTable;
use super::polygons::{Polygon, Polygons};
use super::union::DisjointSets;
use super::{Diagnosis, FaceId, Fault, TriMesh, VertexId, diagnose};

/// A connected part of a mesh: an oriented surface without handles, with one or more boundary loops.
#[derive(Clone, Debug)]
pub struct Part {
    mesh: TriMesh,
    vertex_of: Vec<VertexId>,
    face_of: Vec<FaceId>,
    loops: Vec<Vec<VertexId>>,
    polygons: Polygons,
}

/// Returns the parts of a mesh, in the order of their first faces.
///
/// # Errors
///
/// The faults that keep a part from being an oriented surface with a boundary and without handles.
pub fn parts(mesh: &TriMesh) -> Result<Vec<Part>, Box<Diagnosis>> {
    let mut diagnosis = diagnose(mesh);
    // A part may have holes, and the mesh may have several parts.
    diagnosis.faults.retain(|fault| !fault.is_harmless() && !is_of_parts(fault));
    if diagnosis.faults.is_empty() { Ok(split(mesh)) } else { Err(Box::new(diagnosis)) }
}

/// True if a fault is acceptable in parts.
fn is_of_parts(fault: &Fault) -> bool {
    matches!(
        fault,
        Fault::CoincidentVertices(_)
            | Fault::SeveralComponents { .. }
            | Fault::SeveralBoundaryLoops(_)
            | Fault::NonManifoldVertices(_)
    )
}

fn split(mesh: &TriMesh) -> Vec<Part> {
    const NONE: u32 = u32::MAX;
    let table = EdgeTable::new(mesh.vertex_count(), &mesh.triangles);
    let (mut faces, mut fans) = (DisjointSets::new(mesh.face_count()), DisjointSets::new(3 * mesh.face_count()));
    let following = |side: u32| side - side % 3 + (side + 1) % 3;
    for sides in table.edges() {
        if let &[a, b] = sides {
            faces.join(a / 3, b / 3);
            fans.join(a, following(b));
            fans.join(following(a), b);
        }
    }
    let mut part_of_root = vec![NONE; mesh.face_count()];
    let mut vertex_of_fan = vec![VertexId::new(NONE); 3 * mesh.face_count()];
    let mut parts: Vec<Part> = Vec::new();
    for (number, face) in (0..).zip(&mesh.triangles) {
        let part = &mut part_of_root[faces.find(number) as usize];
        if *part == NONE {
            *part = u32::try_from(parts.len()).expect("no more parts than faces");
            parts.push(Part::default());
        }
        let part = &mut parts[*part as usize];
        let corners = [0, 1, 2].map(|k| {
            let vertex = &mut vertex_of_fan[fans.find(3 * number + k) as usize];
            if vertex.number() == NONE {
                *vertex = VertexId::from_index(part.vertex_of.len());
                let of = face[k as usize];
                part.vertex_of.push(of);
                part.mesh.positions.push(mesh.positions[of.index()]);
            }
            *vertex
        });
        part.push(mesh, FaceId::new(number), corners);
    }
    for sides in table.edges().filter(|sides| sides.len() == 1) {
        let face = sides[0] / 3;
        let part = part_of_root[faces.find(face) as usize];
        let ends = [sides[0], following(sides[0])].map(|corner| vertex_of_fan[fans.find(corner) as usize]);
        parts[part as usize].loops.push(ends.to_vec());
    }
    parts.iter_mut().for_each(Part::finish);
    parts
}

impl Default for Part {
    fn default() -> Self {
        let mesh = TriMesh { polygon_of: Some(Vec::new()), ..TriMesh::default() };
        let (vertex_of, face_of, loops) = (Vec::new(), Vec::new(), Vec::new());
        Self { mesh, vertex_of, face_of, loops, polygons: Polygons::default() }
    }
}

impl Part {
    fn push(&mut self, whole: &TriMesh, face: FaceId, corners: [VertexId; 3]) {
        self.face_of.push(face);
        self.mesh.triangles.push(corners);
        self.mesh.polygon_of.get_or_insert_default().push(whole.polygon(face));
    }

    /// Joins the boundary edges, which `loops` holds until now, and finds the polygons.
    fn finish(&mut self) {
        let mut next = vec![None; self.vertex_of.len()];
        for edge in &self.loops {
            next[edge[0].index()] = Some(edge[1]);
        }
        self.loops.clear();
        for start in 0..next.len() {
            let mut found = Vec::new();
            let mut at = VertexId::from_index(start);
            while let Some(head) = next[at.index()].take() {
                found.push(at);
                at = head;
            }
            if !found.is_empty() {
                self.loops.push(found);
            }
        }
        self.polygons = Polygons::of(&self.mesh);
    }

    /// Triangles of the part, over its own vertices.
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Vertex of the whole mesh for each vertex of the part, which may be a copy.
    pub fn vertex_of(&self) -> &[VertexId] {
        &self.vertex_of
    }

    /// Face of the whole mesh for each face of the part.
    pub fn face_of(&self) -> &[FaceId] {
        &self.face_of
    }

    /// Boundary loops of the part: the surface lies to the left of each.
    pub fn loops(&self) -> &[Vec<VertexId>] {
        &self.loops
    }

    /// Keeps only the polygons with these numbers; of all others only the triangles remain.
    pub fn keep_polygons(&mut self, whole: &HashSet<u32>) {
        let mesh = &self.mesh;
        self.polygons.retain(|polygon| whole.contains(&mesh.polygon(polygon.first_face)));
    }

    /// Polygons with more than three corners that the part's triangles are cut from.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = Polygon<'_>> + Clone {
        self.polygons.iter()
    }
}
