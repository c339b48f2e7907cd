//! Edge loops and rings of a disk of polygons and triangles.
//!
//! A loop continues straight at every vertex with an even number of edges: as many edges lie on its left as on its right.
//! A loop on the boundary follows the boundary. A ring leads from each edge of a quadrilateral to the opposite one.
//! Diagonals, which cut polygons into triangles, are no edges. The cost is that of the result, not of the mesh.

use std::collections::BTreeSet;

use super::elements::{MeshEdge, ascending};
use freebound_core::mesh::{DiskMesh, FaceId, HalfedgeId, VertexId};

/// Edge loops and rings of a disk. Faces that fill holes do not count.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeLoops<'a>(pub(super) &'a DiskMesh);

impl EdgeLoops<'_> {
    /// Edges of the loops through these edges.
    pub(super) fn loops(self, edges: &BTreeSet<MeshEdge>) -> BTreeSet<MeshEdge> {
        self.reached(edges, |side| [side, self.0.twin(side)].map(|side| self.straight_on(side)))
    }

    /// Edges of the rings of these edges.
    pub(super) fn rings(self, edges: &BTreeSet<MeshEdge>) -> BTreeSet<MeshEdge> {
        self.reached(edges, |side| [side, self.0.twin(side)].map(|side| self.opposite(side)))
    }

    /// True if an edge leads from a vertex to one that counts.
    pub(super) fn leads_from(self, vertex: VertexId, counts: impl Fn(VertexId) -> bool) -> bool {
        vertex.index() < self.0.vertex_count() && self.edges_at(vertex).any(|side| counts(self.0.head(side)))
    }

    /// True if an edge lies between a face and another one that counts.
    pub(super) fn borders(self, face: FaceId, counts: impl Fn(FaceId) -> bool) -> bool {
        if face.index() >= self.0.mesh().real_face_count() {
            return false;
        }
        let [a, b, c] = self.0.face(face);
        let sides = [[a, b], [b, c], [c, a]].into_iter().filter_map(|ends| self.side_of(ends));
        let faces = sides.flat_map(|side| [side, self.0.twin(side)]).filter_map(|side| self.face(side));
        faces.into_iter().any(|other| other != face && counts(other))
    }

    /// Side of an edge; `None` if the disk has no such edge.
    fn side_of(self, [tail, head]: MeshEdge) -> Option<HalfedgeId> {
        if tail.index() >= self.0.vertex_count() {
            return None;
        }
        self.edges_at(tail).find(|&side| self.0.head(side) == head)
    }

    fn ends(self, side: HalfedgeId) -> MeshEdge {
        ascending([self.0.tail(side), self.0.head(side)])
    }

    /// Sides of the edges that leave a vertex, counter-clockwise.
    fn edges_at(self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> {
        self.0.outgoing(vertex).filter(move |&side| self.is_edge(side))
    }

    /// Face at a side, unless it fills a hole.
    fn face(self, side: HalfedgeId) -> Option<FaceId> {
        self.0.face_of(side).filter(|&face| !self.0.is_virtual(face))
    }

    /// True for an edge of the surface, false for a diagonal and for an edge within a filled hole.
    fn is_edge(self, side: HalfedgeId) -> bool {
        let faces = [side, self.0.twin(side)].map(|side| self.face(side));
        let [a, b] = faces.map(|face| self.0.polygon_of(face?));
        faces != [None, None] && (a.is_none() || a != b)
    }

    fn is_on_boundary(self, side: HalfedgeId) -> bool {
        self.face(side).is_none() || self.face(self.0.twin(side)).is_none()
    }

    fn reached(
        self,
        edges: &BTreeSet<MeshEdge>,
        next: impl Fn(HalfedgeId) -> [Option<HalfedgeId>; 2],
    ) -> BTreeSet<MeshEdge> {
        let of_edge = |side| self.0.halfedge(self.0.edge_of(side));
        let sides = edges.iter().filter_map(|&edge| self.side_of(edge));
        let mut reached: BTreeSet<HalfedgeId> = sides.map(of_edge).collect();
        let mut pending: Vec<HalfedgeId> = reached.iter().copied().collect();
        while let Some(side) = pending.pop() {
            let others = next(side).into_iter().flatten().map(of_edge);
            pending.extend(others.filter(|&other| reached.insert(other)));
        }
        reached.into_iter().map(|side| self.ends(side)).collect()
    }

    /// Edge that continues straight at the head of a side. `None` if there is none, or no single one.
    fn straight_on(self, side: HalfedgeId) -> Option<HalfedgeId> {
        let back = self.0.twin(side);
        let around: Vec<HalfedgeId> = self.edges_at(self.0.head(side)).collect();
        if self.is_on_boundary(side) {
            let mut others = around.into_iter().filter(|&other| other != back && self.is_on_boundary(other));
            return others.next().filter(|_| others.next().is_none());
        }
        let is_inside = around.len().is_multiple_of(2) && !around.iter().any(|&other| self.is_on_boundary(other));
        let place = around.iter().position(|&other| other == back).filter(|_| is_inside)?;
        Some(around[(place + around.len() / 2) % around.len()])
    }

    /// Opposite side in the quadrilateral at a side.
    fn opposite(self, side: HalfedgeId) -> Option<HalfedgeId> {
        let corners = self.0.polygon_of(self.face(side)?)?.corners;
        let ends = [self.0.tail(side), self.0.head(side)];
        let others: Vec<VertexId> = corners.iter().copied().filter(|corner| !ends.contains(corner)).collect();
        let &[a, b] = others.as_slice() else { return None };
        self.edges_at(a).find(|&other| self.0.head(other) == b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freebound_core::mesh::PolygonMesh;
    use freebound_testkit::disk;

    /// Number of quadrilaterals along a side.
    const SIDE: u32 = 4;

    fn v(x: u32, y: u32) -> VertexId {
        VertexId::new(y * (SIDE + 1) + x)
    }

    /// Square whose faces have these corners, for each square at a column and a row.
    fn square(faces: impl Fn(u32, u32) -> Vec<Vec<VertexId>>) -> DiskMesh {
        let positions: Vec<[f64; 3]> =
            (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| [f64::from(x), f64::from(y), 0.0])).collect();
        let all = (0..SIDE * SIDE).flat_map(|i| faces(i % SIDE, i / SIDE));
        let all: Vec<Vec<u32>> = all.map(|corners| corners.into_iter().map(VertexId::number).collect()).collect();
        disk(PolygonMesh::from_arrays(&positions, &all).triangulate())
    }

    fn squares() -> DiskMesh {
        square(|x, y| vec![vec![v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y + 1)]])
    }

    fn set(vertices: impl IntoIterator<Item = VertexId>) -> BTreeSet<VertexId> {
        vertices.into_iter().collect()
    }

    /// Ends of the loop through the edge of two vertices.
    fn loops(mesh: &DiskMesh, ends: MeshEdge) -> BTreeSet<VertexId> {
        EdgeLoops(mesh).loops(&[ends].into()).into_iter().flatten().collect()
    }

    /// Edges of the ring of the edge of two vertices.
    fn rings(mesh: &DiskMesh, ends: MeshEdge) -> BTreeSet<MeshEdge> {
        EdgeLoops(mesh).rings(&[ends].into())
    }

    #[test]
    fn a_loop_of_squares_goes_from_side_to_side() {
        let mesh = squares();
        assert_eq!(loops(&mesh, [v(1, 2), v(2, 2)]), set((0..=SIDE).map(|x| v(x, 2))));
        assert_eq!(loops(&mesh, [v(1, 0), v(1, 1)]), set((0..=SIDE).map(|y| v(1, y))));
        assert_eq!(loops(&mesh, [v(1, 2), v(3, 2)]), set([]), "no edge lies between them");
        for diagonal in [[v(0, 0), v(1, 1)], [v(1, 0), v(0, 1)]] {
            assert!(loops(&mesh, diagonal).is_empty(), "diagonals are no edges");
        }
    }

    #[test]
    fn a_loop_on_the_boundary_goes_around_it() {
        let rim = |i: u32| [v(i, 0), v(i, SIDE), v(0, i), v(SIDE, i)];
        assert_eq!(loops(&squares(), [v(1, 0), v(2, 0)]), set((0..=SIDE).flat_map(rim)));
    }

    #[test]
    fn a_ring_of_squares_crosses_the_mesh() {
        let rungs: BTreeSet<MeshEdge> = (0..=SIDE).map(|y| [v(1, y), v(2, y)]).collect();
        assert_eq!(rings(&squares(), [v(1, 3), v(2, 3)]), rungs, "without the edges between its rungs");
    }

    #[test]
    fn a_loop_of_triangles_goes_straight_on_and_has_no_ring() {
        let mesh = square(|x, y| {
            vec![vec![v(x, y), v(x + 1, y), v(x + 1, y + 1)], vec![v(x, y), v(x + 1, y + 1), v(x, y + 1)]]
        });
        assert_eq!(loops(&mesh, [v(1, 2), v(2, 2)]), set((0..=SIDE).map(|x| v(x, 2))));
        assert_eq!(loops(&mesh, [v(1, 1), v(2, 2)]), set((0..=SIDE).map(|i| v(i, i))), "along the diagonals");
        assert_eq!(rings(&mesh, [v(1, 2), v(2, 2)]), BTreeSet::from([[v(1, 2), v(2, 2)]]));
    }
}
