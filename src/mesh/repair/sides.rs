//! Sides of polygons, and which of them lie on one edge. A side has the number of the corner that it leaves.

use crate::mesh::edges::EdgeTable;
use crate::mesh::union::DisjointSets;
use crate::mesh::{PolygonMesh, VertexId};

/// The sides of a mesh.
pub(super) struct Sides<'a> {
    corners: &'a [VertexId],
    /// The face that each side belongs to.
    pub(super) face: Vec<u32>,
    /// The side that follows around its face.
    next: Vec<u32>,
    pub(super) table: EdgeTable,
}

impl<'a> Sides<'a> {
    pub(super) fn new(polygons: &'a PolygonMesh) -> Self {
        let corners = &polygons.corners[..];
        let count = u32::try_from(corners.len()).expect("a mesh has fewer than 2^32 corners");
        let mut face = vec![0; corners.len()];
        let mut next: Vec<u32> = (1..=count).collect();
        for (number, polygon) in (0..).zip(0..polygons.face_count()) {
            let range = polygons.corner_range(polygon);
            face[range.clone()].fill(number);
            next[range.end - 1] = u32::try_from(range.start).expect("a corner fits");
        }
        let ends = |side: u32| (corners[side as usize], corners[next[side as usize] as usize]);
        let table = EdgeTable::of_sides(polygons.positions.len(), count, ends);
        Self { corners, face, next, table }
    }

    /// The ends of a side, in the direction of its face.
    pub(super) fn ends(&self, side: u32) -> [VertexId; 2] {
        [side, self.next(side)].map(|corner| self.corners[corner as usize])
    }

    pub(super) fn next(&self, side: u32) -> u32 {
        self.next[side as usize]
    }

    /// The corners that meet across an edge, in pairs.
    pub(super) fn across(&self, a: u32, b: u32) -> [[u32; 2]; 2] {
        let [tail, _] = self.ends(a);
        if tail == self.ends(b)[0] {
            [[a, b], [self.next(a), self.next(b)]]
        } else {
            [[a, self.next(b)], [self.next(a), b]]
        }
    }

    /// The corners in fans: those that hang together across edges whose sides `joins`.
    pub(super) fn fans(&self, joins: impl Fn(&[u32]) -> bool) -> DisjointSets {
        let mut fans = DisjointSets::new(self.corners.len());
        for sides in self.table.edges().filter(|sides| joins(sides)) {
            for pair in sides.windows(2) {
                for [a, b] in self.across(pair[0], pair[1]) {
                    fans.join(a, b);
                }
            }
        }
        fans
    }
}
