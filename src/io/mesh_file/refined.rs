//! A file's mesh with new vertices, or with polygons cut into triangles: everything else as it was.

use std::collections::HashSet;

use super::{MeshFile, Statement};
use crate::mesh::{PolygonMesh, Refinement, VertexId};

/// The mesh of a file with the new vertices of a refinement of it.
///
/// Old vertices keep their numbers, new ones follow. Polygons that are whole in the refinement stay as they are; any
/// other is replaced by its triangles, in its place. Statements stay before the faces that they stood before. Texture coordinates
/// are left out: they belong to the mesh as it was.
///
/// # Panics
///
/// If the refinement is of another mesh, with more polygons than this one.
pub fn refined_obj(source: &MeshFile, refinement: &Refinement) -> MeshFile {
    let disk = refinement.disk();
    let old_count = refinement.old_vertex_count();
    let (mut corners, mut starts, mut face_of) = (Vec::new(), vec![0], Vec::new());
    let mut push = |polygon: &[VertexId], number: u32| {
        corners.extend_from_slice(polygon);
        starts.push(u32::try_from(corners.len()).expect("a mesh has fewer than 2^32 corners"));
        face_of.push(number);
        u32::try_from(face_of.len()).expect("a mesh has fewer than 2^32 faces")
    };
    let is_whole: HashSet<u32> = disk.polygons().map(|whole| disk.mesh().polygon(whole.first_face)).collect();
    let mut face_count = 0;
    // First of the faces that stand for a polygon of the file.
    let mut first_face = Vec::with_capacity(source.polygons.face_count());
    let mut faces = disk.faces().peekable();
    for (number, polygon) in (0..).zip(0..source.polygons.face_count()) {
        first_face.push(face_count);
        let mut triangles = Vec::new();
        while let Some(face) = faces.next_if(|&face| disk.mesh().polygon(face) == number) {
            triangles.push(disk.face(face));
        }
        let is_old = triangles.as_flattened().iter().all(|corner| corner.index() < old_count);
        if is_old && (triangles.len() <= 1 || is_whole.contains(&number)) {
            face_count = push(source.polygons.face(polygon), number);
        } else {
            for triangle in &triangles {
                face_count = push(triangle, number);
            }
        }
    }
    assert!(faces.next().is_none(), "a refinement of this mesh");
    let moved = |statement: &Statement| {
        let before_face = first_face.get(statement.before_face as usize).copied().unwrap_or(face_count);
        Statement { before_face, text: statement.text.clone() }
    };
    let mut positions = source.polygons.positions.clone();
    positions.extend(disk.mesh().positions[old_count..].iter().map(|&position| position * disk.unit()));
    let are_triangles = starts.windows(2).all(|bounds| bounds[1] - bounds[0] == 3);
    MeshFile {
        polygons: PolygonMesh { positions, corners, starts: (!are_triangles).then_some(starts) },
        texture: None,
        statements: source.statements.iter().map(moved).collect(),
        source: source.source.as_ref().map(|file| file.changed(&face_of, refinement.new_vertices())),
    }
}
