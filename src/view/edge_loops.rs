//! Edge loops and rings of a mesh of polygons and triangles.
//!
//! A loop goes straight on at every vertex with an even number of edges: as many edges lie on its left as on its right. A
//! loop on the boundary follows the boundary. A ring goes from each edge of a quadrilateral to the opposite one.

use std::collections::{BTreeMap, BTreeSet};

use freebound_core::mesh::{DiskMesh, VertexId};

/// Edge by its ends, the lower number first.
type Edge = [VertexId; 2];

/// Cells of a surface: polygons, and triangles that belong to none.
#[derive(Debug)]
pub struct EdgeLoops {
    /// Corners of each cell, around it.
    cells: Vec<Vec<VertexId>>,
    /// Cells at each edge: one at the boundary, else two.
    at_edge: BTreeMap<Edge, Vec<usize>>,
    /// Edges at each vertex.
    at_vertex: BTreeMap<VertexId, Vec<Edge>>,
}

fn edge(a: VertexId, b: VertexId) -> Edge {
    if a < b { [a, b] } else { [b, a] }
}

impl EdgeLoops {
    /// Cells of the real faces of a disk.
    pub fn new(disk: &DiskMesh) -> Self {
        let mesh = disk.mesh();
        let mut is_part = vec![false; mesh.real_face_count()];
        let mut cells = Vec::new();
        for polygon in disk.polygons() {
            polygon.faces().for_each(|face| is_part[face.index()] = true);
            cells.push(polygon.corners.to_vec());
        }
        let triangles = mesh.real_triangles().iter().zip(&is_part);
        cells.extend(triangles.filter(|&(_, is_part)| !is_part).map(|(corners, _)| corners.to_vec()));
        Self::of_cells(cells)
    }

    fn of_cells(cells: Vec<Vec<VertexId>>) -> Self {
        let mut at_edge: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
        for (number, corners) in cells.iter().enumerate() {
            for (place, &corner) in corners.iter().enumerate() {
                at_edge.entry(edge(corner, corners[(place + 1) % corners.len()])).or_default().push(number);
            }
        }
        let mut at_vertex: BTreeMap<VertexId, Vec<Edge>> = BTreeMap::new();
        for &ends in at_edge.keys() {
            for end in ends {
                at_vertex.entry(end).or_default().push(ends);
            }
        }
        Self { cells, at_edge, at_vertex }
    }

    /// Edges between these vertices.
    fn edges_between(&self, vertices: &BTreeSet<VertexId>) -> BTreeSet<Edge> {
        let at = |vertex| self.at_vertex.get(vertex).into_iter().flatten().copied();
        let is_between = |ends: &Edge| ends.iter().all(|end| vertices.contains(end));
        vertices.iter().flat_map(at).filter(is_between).collect()
    }

    /// Ends of all edges of the loops through the edges between these vertices.
    pub fn loops(&self, vertices: &BTreeSet<VertexId>) -> BTreeSet<VertexId> {
        self.reached(vertices, |at| at.iter().filter_map(|&end| self.straight_on(*at, end)).collect())
    }

    /// Ends of all edges of the rings of the edges between these vertices.
    pub fn rings(&self, vertices: &BTreeSet<VertexId>) -> BTreeSet<VertexId> {
        self.reached(vertices, |at| self.at_edge[at].iter().filter_map(|&cell| self.opposite(*at, cell)).collect())
    }

    fn reached(&self, vertices: &BTreeSet<VertexId>, next: impl Fn(&Edge) -> Vec<Edge>) -> BTreeSet<VertexId> {
        let mut reached = self.edges_between(vertices);
        let mut pending: Vec<Edge> = reached.iter().copied().collect();
        while let Some(at) = pending.pop() {
            pending.extend(next(&at).into_iter().filter(|&other| reached.insert(other)));
        }
        reached.into_iter().flatten().collect()
    }

    /// Edge that goes on straight from an edge at one of its ends. `None` if there is none, or no single one.
    fn straight_on(&self, from: Edge, at: VertexId) -> Option<Edge> {
        let edges = &self.at_vertex[&at];
        let is_on_boundary = |ends: &&Edge| self.at_edge[*ends].len() == 1;
        if is_on_boundary(&&from) {
            let mut others = edges.iter().filter(is_on_boundary).filter(|&&ends| ends != from);
            return others.next().copied().filter(|_| others.next().is_none());
        }
        if edges.len() % 2 == 1 || edges.iter().any(|ends| is_on_boundary(&ends)) {
            return None;
        }
        // Around the vertex, cell by cell, to the edge halfway round.
        let mut cell = self.at_edge[&from][0];
        let mut now = from;
        for _ in 0..edges.len() / 2 {
            now = self.other_at(cell, now, at)?;
            cell = *self.at_edge[&now].iter().find(|&&other| other != cell)?;
        }
        Some(now)
    }

    /// The other edge of a cell at one of its corners.
    fn other_at(&self, cell: usize, ends: Edge, at: VertexId) -> Option<Edge> {
        let corners = &self.cells[cell];
        let place = corners.iter().position(|&corner| corner == at)?;
        let neighbours = [(place + 1) % corners.len(), (place + corners.len() - 1) % corners.len()];
        neighbours.map(|other| edge(at, corners[other])).into_iter().find(|&other| other != ends)
    }

    /// Opposite edge in a quadrilateral.
    fn opposite(&self, ends: Edge, cell: usize) -> Option<Edge> {
        let corners = self.cells[cell].as_slice();
        let &[_, _, _, _] = corners else { return None };
        let others: Vec<VertexId> = corners.iter().copied().filter(|corner| !ends.contains(corner)).collect();
        let &[a, b] = others.as_slice() else { return None };
        Some(edge(a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of quadrilaterals along a side.
    const SIDE: u32 = 4;

    fn v(x: u32, y: u32) -> VertexId {
        VertexId::new(y * (SIDE + 1) + x)
    }

    /// Square of quadrilaterals.
    fn squares() -> EdgeLoops {
        let cell = |x, y| vec![v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y + 1)];
        EdgeLoops::of_cells((0..SIDE * SIDE).map(|i| cell(i % SIDE, i / SIDE)).collect())
    }

    fn set(vertices: impl IntoIterator<Item = VertexId>) -> BTreeSet<VertexId> {
        vertices.into_iter().collect()
    }

    #[test]
    fn a_loop_of_squares_goes_from_side_to_side() {
        let loops = squares();
        assert_eq!(loops.loops(&set([v(1, 2), v(2, 2)])), set((0..=SIDE).map(|x| v(x, 2))));
        assert_eq!(loops.loops(&set([v(1, 0), v(1, 1)])), set((0..=SIDE).map(|y| v(1, y))));
        assert_eq!(loops.loops(&set([v(1, 2), v(3, 2)])), set([]), "no edge lies between them");
    }

    #[test]
    fn a_loop_on_the_boundary_goes_around_it() {
        let rim = |i: u32| [v(i, 0), v(i, SIDE), v(0, i), v(SIDE, i)];
        assert_eq!(squares().loops(&set([v(1, 0), v(2, 0)])), set((0..=SIDE).flat_map(rim)));
    }

    #[test]
    fn a_ring_of_squares_crosses_the_mesh() {
        let rungs = (0..=SIDE).flat_map(|y| [v(1, y), v(2, y)]);
        assert_eq!(squares().rings(&set([v(1, 3), v(2, 3)])), set(rungs));
    }

    #[test]
    fn a_loop_of_triangles_goes_straight_on_and_has_no_ring() {
        let halves = |x, y| [vec![v(x, y), v(x + 1, y), v(x + 1, y + 1)], vec![v(x, y), v(x + 1, y + 1), v(x, y + 1)]];
        let loops = EdgeLoops::of_cells((0..SIDE * SIDE).flat_map(|i| halves(i % SIDE, i / SIDE)).collect());
        assert_eq!(loops.loops(&set([v(1, 2), v(2, 2)])), set((0..=SIDE).map(|x| v(x, 2))));
        assert_eq!(loops.loops(&set([v(1, 1), v(2, 2)])), set((0..=SIDE).map(|i| v(i, i))), "along the diagonals");
        assert_eq!(loops.rings(&set([v(1, 2), v(2, 2)])), set([v(1, 2), v(2, 2)]));
    }
}
