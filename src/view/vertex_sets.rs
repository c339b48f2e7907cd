//! Sets of vertices that follow from others: grown, shrunk, inverted. Triangles that are reached, or distorted.

use std::collections::BTreeSet;

use glam::DVec3;

use freebound_core::mesh::{EdgeTable, VertexId};

/// Triangles with the positions of their corners.
#[derive(Clone, Copy, Debug)]
pub struct VertexSets<'a> {
    /// Positions of all vertices.
    pub positions: &'a [DVec3],
    /// Triangles.
    pub triangles: &'a [[VertexId; 3]],
}

impl VertexSets<'_> {
    /// Corners of all triangles.
    pub fn all(self) -> BTreeSet<VertexId> {
        self.corners_of(|_| true)
    }

    /// The vertices, and those that share a triangle with one of them.
    pub fn grown(self, vertices: &BTreeSet<VertexId>) -> BTreeSet<VertexId> {
        let is_in = self.marked(vertices);
        let grown = self.corners_of(|face| self.triangles[face].iter().any(|vertex| is_in[vertex.index()]));
        &grown | vertices
    }

    /// The vertices that share triangles with these vertices only.
    pub fn shrunk(self, vertices: &BTreeSet<VertexId>) -> BTreeSet<VertexId> {
        let is_in = self.marked(vertices);
        let others = self.corners_of(|face| !self.triangles[face].iter().all(|vertex| is_in[vertex.index()]));
        vertices - &others
    }

    /// Corners of the triangles that are not among these vertices.
    pub fn inverted(self, vertices: &BTreeSet<VertexId>) -> BTreeSet<VertexId> {
        &self.all() - vertices
    }

    /// Sides of the edges with a single triangle.
    pub(super) fn single_sides(self) -> Vec<u32> {
        self.edges().edges().filter(|sides| sides.len() == 1).map(|sides| sides[0]).collect()
    }

    /// Triangles between the vertices; if there are none, those at the vertices.
    pub(super) fn faces_at(self, vertices: &BTreeSet<VertexId>) -> Vec<usize> {
        let is_in = self.marked(vertices);
        let count = |face: usize| self.triangles[face].iter().filter(|vertex| is_in[vertex.index()]).count();
        let with = |least: usize| (0..self.triangles.len()).filter(|&face| count(face) >= least).collect::<Vec<_>>();
        let between = with(3);
        if between.is_empty() { with(1) } else { between }
    }

    /// For each triangle: true if it is reached from others without crossing an edge whose faces meet at this angle or
    /// more.
    pub(super) fn faces_up_to_sharp_edges(self, mut pending: Vec<usize>, degrees: f64) -> Vec<bool> {
        let mut across = vec![[None; 3]; self.triangles.len()];
        for sides in self.edges().edges() {
            if let &[a, b] = sides
                && self.angle(a, b) < degrees
            {
                across[a as usize / 3][a as usize % 3] = Some(b as usize / 3);
                across[b as usize / 3][b as usize % 3] = Some(a as usize / 3);
            }
        }
        let mut is_reached = vec![false; self.triangles.len()];
        for &face in &pending {
            is_reached[face] = true;
        }
        while let Some(face) = pending.pop() {
            for next in across[face].into_iter().flatten() {
                if !std::mem::replace(&mut is_reached[next], true) {
                    pending.push(next);
                }
            }
        }
        is_reached
    }

    /// For each triangle: true if it is among those with the greatest values that together have this share of the area,
    /// at least one triangle.
    pub(super) fn greatest_faces(self, value: impl Fn(usize) -> f64, share: f64) -> Vec<bool> {
        let area = |face: usize| self.normal(face).length();
        let mut order: Vec<(f64, usize)> = (0..self.triangles.len()).map(|face| (value(face), face)).collect();
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut left = share * (0..self.triangles.len()).map(area).sum::<f64>();
        let mut is_taken = vec![false; self.triangles.len()];
        for (_, face) in order {
            is_taken[face] = true;
            left -= area(face);
            if left <= 0.0 {
                break;
            }
        }
        is_taken
    }

    /// Corners of the triangles that count.
    pub(super) fn corners_of(self, is_wanted: impl Fn(usize) -> bool) -> BTreeSet<VertexId> {
        let mut is_in = vec![false; self.positions.len()];
        for face in (0..self.triangles.len()).filter(|&face| is_wanted(face)) {
            self.triangles[face].iter().for_each(|vertex| is_in[vertex.index()] = true);
        }
        (0..self.positions.len()).filter(|&vertex| is_in[vertex]).map(VertexId::from_index).collect()
    }

    /// For each vertex: true if it is among these.
    pub(super) fn marked(self, vertices: &BTreeSet<VertexId>) -> Vec<bool> {
        let mut is_in = vec![false; self.positions.len()];
        for vertex in vertices.iter().filter(|vertex| vertex.index() < self.positions.len()) {
            is_in[vertex.index()] = true;
        }
        is_in
    }

    fn edges(self) -> EdgeTable {
        EdgeTable::new(self.positions.len(), self.triangles)
    }

    /// Ends of a side of the edge table.
    pub(super) fn ends(self, side: u32) -> [VertexId; 2] {
        let (corners, corner) = (self.triangles[side as usize / 3], side as usize % 3);
        [corners[corner], corners[(corner + 1) % 3]]
    }

    fn normal(self, face: usize) -> DVec3 {
        let [a, b, c] = self.triangles[face].map(|vertex| self.positions[vertex.index()]);
        (b - a).cross(c - a)
    }

    /// Angle between the normals of the triangles of two sides, degrees. 0 if one has no area.
    fn angle(self, a: u32, b: u32) -> f64 {
        let [a, b] = [a, b].map(|side| self.normal(side as usize / 3));
        a.cross(b).length().atan2(a.dot(b)).to_degrees()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freebound_core::mesh::TriMesh;
    use freebound_testkit::grid;

    fn sets(mesh: &TriMesh) -> VertexSets<'_> {
        VertexSets { positions: &mesh.positions, triangles: &mesh.triangles }
    }

    fn set(numbers: impl IntoIterator<Item = u32>) -> BTreeSet<VertexId> {
        numbers.into_iter().map(VertexId::new).collect()
    }

    #[test]
    fn growing_adds_the_neighbours_and_shrinking_takes_them_away() {
        let mesh = grid(6, 6);
        let sets = sets(&mesh);
        let middle = set([24]);
        let grown = sets.grown(&middle);
        assert_eq!(grown.len(), 7, "the diagonals of the squares run one way");
        assert_eq!(sets.shrunk(&grown), middle);
        assert!(sets.shrunk(&middle).is_empty());
        assert_eq!(sets.shrunk(&sets.all()), sets.all(), "nothing lies outside");
        assert_eq!(sets.grown(&set([])), set([]));
    }

    #[test]
    fn the_inverse_of_the_inverse_is_the_selection() {
        let mesh = grid(4, 3);
        let some = set([0, 3, 7, 19]);
        assert_eq!(sets(&mesh).inverted(&sets(&mesh).inverted(&some)), some);
        assert_eq!(sets(&mesh).inverted(&set([])), sets(&mesh).all());
    }
}
