//! Removal of new vertices that are not needed.
//!
//! A new vertex is removed if the one or two old faces beside it can be triangulated without it. The region of its
//! triangles is then cut into other triangles, all positive in the plane and none degenerate on the surface. The other
//! faces stay, so the map stays one-to-one. On the boundary, the new edge must meet no other edge. All tests are
//! exact.

use std::collections::{BTreeMap, BTreeSet};

use super::triangulate::shortest_triangulation;
use super::{Control, Embedding, Matched, SolveError, refinement};
use crate::geom::{Orientation, orientation, segments_meet};
use crate::mesh::{DiskMesh, FaceId, HalfedgeId, NewVertex, VertexId};

/// Removes new vertices without which every face stays positive and the boundary simple. All other vertices stay
/// fixed.
///
/// # Errors
///
/// If the caller cancels.
pub fn simplified(mesh: &DiskMesh, matched: Matched, control: Control<'_>) -> Result<Matched, SolveError> {
    let mut removal = Removal::new(mesh, &matched);
    let old = matched.refinement.old_vertex_count();
    let mut waiting: BTreeSet<VertexId> = (old..matched.embedding.len()).map(VertexId::from_index).collect();
    while let Some(vertex) = waiting.pop_first() {
        control.go_on()?;
        if let Some(around) = removal.remove(vertex) {
            waiting.extend(around.into_iter().filter(|v| v.index() >= old));
        }
    }
    let Removal { parts, removed, .. } = removal;
    if removed.is_empty() { Ok(matched) } else { without(mesh, &matched, &removed, parts, control) }
}

/// Triangles by the old face that contains them.
pub(super) type Parts = BTreeMap<FaceId, Vec<[VertexId; 3]>>;

/// Present state of the refined mesh.
struct Removal<'a> {
    mesh: &'a DiskMesh,
    refined: &'a DiskMesh,
    new_vertices: &'a [NewVertex],
    embedding: &'a Embedding,
    /// Triangles of each old face that has, or had, new vertices.
    parts: Parts,
    /// Inner halfedge of each split old edge.
    sides: BTreeMap<[VertexId; 2], HalfedgeId>,
    /// Next boundary vertex after each boundary vertex.
    after: BTreeMap<VertexId, VertexId>,
    removed: BTreeSet<VertexId>,
}

/// Region of one old face that the triangles at a new vertex cover. Corners are counter-clockwise, without the vertex
/// itself, starting after it on its edge and ending before it.
struct Hole {
    face: FaceId,
    corners: Vec<VertexId>,
}

impl<'a> Removal<'a> {
    fn new(mesh: &'a DiskMesh, matched: &'a Matched) -> Self {
        let refinement = &matched.refinement;
        let refined = refinement.disk();
        let mut parts = Parts::new();
        for face in refined.faces() {
            parts.entry(refinement.source_of(face)).or_default().push(refined.face(face));
        }
        parts.retain(|&face, triangles| *triangles != [mesh.face(face)]);
        let side = |edge: [VertexId; 2]| {
            let h = mesh.outgoing(edge[0]).find(|&h| mesh.head(h) == edge[1]).expect("new vertices lie on edges");
            (edge, if mesh.is_outer(h) { mesh.twin(h) } else { h })
        };
        let sides = refinement.split_edges().into_iter().map(side).collect();
        let boundary = refined.boundary_loop();
        let after = boundary.iter().zip(boundary.iter().cycle().skip(1)).map(|(&v, &next)| (v, next)).collect();
        Self {
            mesh,
            refined,
            new_vertices: refinement.new_vertices(),
            embedding: &matched.embedding,
            parts,
            sides,
            after,
            removed: BTreeSet::new(),
        }
    }

    /// Removes a new vertex if possible. Returns its neighbours, some of which may have become removable.
    fn remove(&mut self, vertex: VertexId) -> Option<Vec<VertexId>> {
        let side = self.sides[&self.new_vertices[vertex.index() - self.mesh.vertex_count()].edge];
        let faces = [side, self.mesh.twin(side)].map(|h| self.mesh.face_of(h));
        let holes: Vec<Hole> = faces.into_iter().flatten().map(|face| self.hole(vertex, face)).collect();
        let filled: Option<Vec<Vec<[VertexId; 3]>>> = holes.iter().map(|hole| self.fill(hole)).collect();
        let filled = filled?;
        if let [Hole { corners, .. }] = holes.as_slice() {
            // The surface lies to the left of the boundary, and of this side.
            let (before, after) = (corners[corners.len() - 1], corners[0]);
            if !self.is_clear(before, vertex, after) {
                return None;
            }
            self.after.remove(&vertex);
            self.after.insert(before, after);
        }
        for (Hole { face, .. }, triangles) in holes.iter().zip(filled) {
            let parts = self.parts.get_mut(face).expect("a split face has parts");
            parts.retain(|triangle| !triangle.contains(&vertex));
            parts.extend(triangles);
        }
        self.removed.insert(vertex);
        Some(holes.into_iter().flat_map(|hole| hole.corners).collect())
    }

    /// Region of a face that the triangles at a vertex cover.
    fn hole(&self, vertex: VertexId, face: FaceId) -> Hole {
        let sides: BTreeMap<VertexId, VertexId> = self.parts[&face]
            .iter()
            .filter_map(|t| t.iter().position(|&v| v == vertex).map(|k| (t[(k + 1) % 3], t[(k + 2) % 3])))
            .collect();
        let first = sides.keys().find(|v| !sides.values().any(|w| w == *v)).copied();
        let corners = std::iter::successors(first, |v| sides.get(v).copied()).collect();
        Hole { face, corners }
    }

    /// Triangles without the vertex, if possible.
    fn fill(&self, hole: &Hole) -> Option<Vec<[VertexId; 3]>> {
        let Hole { face, corners } = hole;
        let on: Vec<u8> = corners.iter().map(|&v| sides_of(self.mesh, self.new_vertices, *face, v)).collect();
        let position = |i: usize| self.refined.position(corners[i]);
        let length = |i: usize, j: usize| position(i).distance_squared(position(j));
        let is_bad = |i: usize, j: usize, k: usize| {
            let [a, b, c] = [i, j, k].map(|corner| self.embedding[corners[corner]]);
            on[i] & on[j] & on[k] != 0 || orientation(a, b, c) != Some(Orientation::CounterClockwise)
        };
        let triangles = shortest_triangulation(corners.len(), length, is_bad)?;
        Some(triangles.into_iter().map(|t| t.map(|i| corners[i])).collect())
    }

    /// True if the boundary may bypass a vertex: the line meets no edges except the two beside it, at its ends.
    fn is_clear(&self, before: VertexId, vertex: VertexId, after: VertexId) -> bool {
        let line = [before, after].map(|v| self.embedding[v]);
        self.after.iter().filter(|(from, _)| **from != before && **from != vertex).all(|(&from, &to)| {
            let edge = [from, to].map(|v| self.embedding[v]);
            match (to == before, from == after) {
                (false, false) => !segments_meet(line, edge),
                // Both share an end. They share more only if the other end of either lies on the other.
                (true, _) => !segments_meet(line, [edge[0]; 2]) && !segments_meet(edge, [line[1]; 2]),
                (_, true) => !segments_meet(line, [edge[1]; 2]) && !segments_meet(edge, [line[0]; 2]),
            }
        })
    }
}

/// Sides of an old face that a vertex lies on, as bits.
pub(super) fn sides_of(mesh: &DiskMesh, new_vertices: &[NewVertex], face: FaceId, vertex: VertexId) -> u8 {
    let corners = mesh.face(face);
    let is_on = |k: usize| {
        let side = [corners[k], corners[(k + 1) % 3]];
        match vertex.index().checked_sub(mesh.vertex_count()) {
            Some(new) => new_vertices[new].edge.iter().all(|end| side.contains(end)),
            None => side.contains(&vertex),
        }
    };
    (0..3).map(|k| u8::from(is_on(k)) << k).sum()
}

/// Result without the removed new vertices.
///
/// # Errors
///
/// If the caller cancels.
pub(super) fn without(
    mesh: &DiskMesh,
    matched: &Matched,
    removed: &BTreeSet<VertexId>,
    parts: Parts,
    control: Control<'_>,
) -> Result<Matched, SolveError> {
    let old = mesh.vertex_count();
    let kept: Vec<VertexId> = matched.refinement.disk().vertices().filter(|v| !removed.contains(v)).collect();
    let mut number = vec![VertexId::default(); matched.embedding.len()];
    for (place, v) in kept.iter().enumerate() {
        number[v.index()] = VertexId::from_index(place);
    }
    let embedding = kept.iter().map(|v| matched.embedding[v]).collect();
    let new_vertices = kept[old..].iter().map(|v| matched.refinement.new_vertices()[v.index() - old]).collect();
    let renumbered = |t: [VertexId; 3]| t.map(|v| number[v.index()]);
    let parts = parts.into_iter().map(|(face, parts)| (face, parts.into_iter().map(renumbered).collect())).collect();
    Ok(Matched { refinement: refinement(mesh, new_vertices, &parts, control)?, embedding })
}
