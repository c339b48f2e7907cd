//! Sides of polygons, grouped by edge. A side has the number of the corner that it leaves.

use super::Repaired;
use crate::mesh::edges::EdgeTable;
use crate::mesh::union::{DisjointSets, ParitySets};
use crate::mesh::{PolygonMesh, VertexId};

/// Sides of a mesh.
pub(super) struct Sides<'a> {
    corners: &'a [VertexId],
    /// Face of each side.
    pub(super) face: Vec<u32>,
    /// Next side around the face of each side.
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

    /// Ends of a side, in the direction of its face.
    pub(super) fn ends(&self, side: u32) -> [VertexId; 2] {
        [side, self.next(side)].map(|corner| self.corners[corner as usize])
    }

    pub(super) fn next(&self, side: u32) -> u32 {
        self.next[side as usize]
    }

    /// Edge of the given mesh `source` for a side of `repaired`.
    pub(super) fn edge_in_file(&self, repaired: &Repaired, source: &PolygonMesh, side: u32) -> [VertexId; 2] {
        let ends = [side, self.next(side)].map(|corner| corner as usize);
        repaired.edge_in_file(source, self.face[side as usize] as usize, ends)
    }

    /// Corners that meet across an edge, in pairs.
    pub(super) fn across(&self, a: u32, b: u32) -> [[u32; 2]; 2] {
        let [tail, _] = self.ends(a);
        if tail == self.ends(b)[0] {
            [[a, b], [self.next(a), self.next(b)]]
        } else {
            [[a, self.next(b)], [self.next(a), b]]
        }
    }

    /// Fans of corners, connected across the edges for which `joins` is true.
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

    /// True for each face of a one-sided surface. Components are connected across edges with exactly two faces.
    pub(super) fn one_sided(&self) -> Vec<bool> {
        let count = self.face.last().map_or(0, |&last| last as usize + 1);
        let mut sets = ParitySets::new(count);
        let mut contradictions = Vec::new();
        for on in self.table.edges() {
            let &[a, b] = on else { continue };
            let [face, other] = [a, b].map(|side| self.face[side as usize]);
            if sets.relate(face, other, self.ends(a)[0] == self.ends(b)[0]) {
                contradictions.push(face);
            }
        }
        let mut is_one_sided = vec![false; count];
        for face in contradictions {
            is_one_sided[sets.find(face).0 as usize] = true;
        }
        (0..).take(count).map(|face| is_one_sided[sets.find(face).0 as usize]).collect()
    }
}

impl Repaired {
    /// Edge of the given mesh `source` for a side of a face, the smaller vertex first.
    ///
    /// Corners removed between the two ends repeat the vertex of a kept corner, so in the file they are ends of this
    /// side. The side's end is then the last removed corner.
    pub(super) fn edge_in_file(&self, source: &PolygonMesh, face: usize, side: [usize; 2]) -> [VertexId; 2] {
        let corner_of = &self.corner_of[self.polygons.corner_range(face)];
        let runs_back = matches!(corner_of, [.., before, last] if before > last);
        let [mut first, mut last] = side.map(|corner| self.corner_of(corner));
        if runs_back {
            std::mem::swap(&mut first, &mut last);
        }
        let range = source.corner_range(self.face_of[face] as usize);
        if self.keeps_last {
            last = if first + 1 == range.end { range.start } else { first + 1 };
        } else {
            first = if last == range.start { range.end - 1 } else { last - 1 };
        }
        ascending([first, last].map(|corner| source.corners[corner]))
    }
}

/// Ends of an edge, the smaller number first.
pub(super) fn ascending([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}
