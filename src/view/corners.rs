//! Corner normals: smooth over gentle bends, sharp over creases.

use glam::DVec3;

use crate::mesh::VertexId;

/// Cosine of the angle between two faces above which the edge between them shows, 70°: a cube has edges, and a
/// coarse nose has none.
const CREASE_COSINE: f64 = 0.34;

/// One normal per corner, in the order of the triangles' corners.
///
/// A corner's normal is the area-weighted mean over the faces around its vertex that bend away from its own face by
/// less than the crease angle. Faces without area take that of their neighbours.
pub fn crease_normals(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<DVec3> {
    let areas: Vec<DVec3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v.index()]);
            (b - a).cross(c - a)
        })
        .collect();
    let units: Vec<DVec3> = areas.iter().map(|a| a.normalize_or_zero()).collect();
    let (starts, faces) = faces_by_vertex(positions.len(), triangles);
    let mut normals = Vec::with_capacity(3 * triangles.len());
    for (triangle, &own) in triangles.iter().zip(&units) {
        for vertex in triangle {
            let around = &faces[starts[vertex.index()] as usize..starts[vertex.index() + 1] as usize];
            let gentle =
                around.iter().map(|&f| f as usize).filter(|&f| own == DVec3::ZERO || units[f].dot(own) > CREASE_COSINE);
            let sum: DVec3 = gentle.map(|f| areas[f]).sum();
            normals.push(sum.try_normalize().unwrap_or(own));
        }
    }
    normals
}

/// For each vertex the faces around it: where its list begins, and all lists one after the other.
fn faces_by_vertex(vertex_count: usize, triangles: &[[VertexId; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; vertex_count + 1];
    for vertex in triangles.iter().flatten() {
        starts[vertex.index() + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut cursor = starts.clone();
    let mut faces = vec![0_u32; 3 * triangles.len()];
    for (face, triangle) in (0_u32..).zip(triangles) {
        for vertex in triangle {
            let place = &mut cursor[vertex.index()];
            faces[*place as usize] = face;
            *place += 1;
        }
    }
    (starts, faces)
}
