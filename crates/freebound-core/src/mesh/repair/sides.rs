//! Sides of polygons, and which of them lie on one edge. A side has the number of the corner that it leaves.

use super::Repaired;
use crate::mesh::edges::EdgeTable;
use crate::mesh::union::{DisjointSets, ParitySets};
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

    /// The edge of the mesh as given, `source`, that a side of `repaired` is.
    pub(super) fn edge_in_file(&self, repaired: &Repaired, source: &PolygonMesh, side: u32) -> [VertexId; 2] {
        let ends = [side, self.next(side)].map(|corner| corner as usize);
        repaired.edge_in_file(source, self.face[side as usize] as usize, ends)
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

    /// For each face whether the surface has only one side there. What hangs together across edges of two faces counts as one.
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
    /// The edge of the mesh as given, `source`, that a side of a face is, the smaller vertex first. Where corners were left out
    /// between its two, the one that is kept is an end of another side: these repeat its vertex, and the last of them is the end.
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

/// An edge's ends, the smaller number first.
pub(super) fn ascending([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}
