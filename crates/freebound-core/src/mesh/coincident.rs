//! Coincident vertices of different parts of a mesh: faces that look connected and are not.
//!
//! Triangle soup is the extreme case: every face has its own three vertices.

use super::union::DisjointSets;
use super::{TriMesh, VertexId, place_key};

/// Vertices at the position of a lower-numbered vertex of another part, ascending.
///
/// Parts are connected across shared vertices. Seams within one part do not count: a cut surface has them.
pub(super) fn coincident_vertices(mesh: &TriMesh, triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    let mut parts = DisjointSets::new(mesh.vertex_count());
    let mut used = vec![false; mesh.vertex_count()];
    for corners in triangles {
        for corner in corners {
            parts.join(corners[0].number(), corner.number());
            used[corner.index()] = true;
        }
    }
    let bits = |v: VertexId| place_key(mesh.positions[v.index()]);
    let is_looked_at = |v: &VertexId| used[v.index()] && mesh.positions[v.index()].is_finite();
    let mut by_place: Vec<VertexId> = (0..mesh.vertex_count()).map(VertexId::from_index).filter(is_looked_at).collect();
    by_place.sort_by_cached_key(|&v| (bits(v), v));
    let mut found = Vec::new();
    for group in by_place.chunk_by(|&a, &b| bits(a) == bits(b)) {
        let first = parts.find(group[0].number());
        found.extend(group.iter().filter(|v| parts.find(v.number()) != first));
    }
    found.sort_unstable();
    found
}
