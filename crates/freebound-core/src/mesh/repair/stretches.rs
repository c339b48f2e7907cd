//! Seams as lines: the stretches of seams through a vertex, and the path along seams between two vertices.
//!
//! Seams can so be removed stretch by stretch, independent of the path that would be shortest now.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::{Repaired, Seams};
use crate::mesh::{PolygonMesh, VertexId};

impl Seams {
    /// Edges of the stretches through a vertex, each up to an end or a junction of seams. Empty if no listed edge has
    /// this vertex.
    pub fn stretches_through(&self, vertex: VertexId) -> Vec<[VertexId; 2]> {
        let neighbours = self.neighbours();
        let mut edges = BTreeSet::new();
        for &first in neighbours.get(&vertex).into_iter().flatten() {
            let mut edge = [vertex, first];
            while edges.insert([edge[0].min(edge[1]), edge[0].max(edge[1])]) {
                let [before, at] = edge;
                // An end has one neighbour; a junction has more than two.
                let [a, b] = neighbours[&at][..] else { break };
                edge = [at, if a == before { b } else { a }];
            }
        }
        edges.into_iter().collect()
    }

    /// Shortest chain of listed edges from one vertex to another, by number of edges; `None` if they are not
    /// connected.
    pub fn way(&self, from: VertexId, to: VertexId) -> Option<Vec<[VertexId; 2]>> {
        let neighbours = self.neighbours();
        let mut back = BTreeMap::from([(to, to)]);
        let mut queue = VecDeque::from([to]);
        while let Some(at) = queue.pop_front().filter(|_| !back.contains_key(&from)) {
            for &next in neighbours.get(&at).into_iter().flatten() {
                back.entry(next).or_insert_with(|| {
                    queue.push_back(next);
                    at
                });
            }
        }
        let step = |at: &VertexId| back.get(at).copied().filter(|next| next != at);
        let way: Vec<VertexId> = std::iter::successors(back.contains_key(&from).then_some(from), step).collect();
        (!way.is_empty()).then(|| way.windows(2).map(|edge| [edge[0], edge[1]]).collect())
    }

    /// Other ends of the listed edges at each vertex, ascending.
    fn neighbours(&self) -> BTreeMap<VertexId, Vec<VertexId>> {
        let mut neighbours: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for &[a, b] in self.edges() {
            neighbours.entry(a).or_default().push(b);
            neighbours.entry(b).or_default().push(a);
        }
        neighbours
    }
}

impl Repaired {
    /// Sides that are listed or automatic edges of the given mesh `source`: both sides of each edge, by vertices of
    /// the repaired mesh.
    pub fn seam_sides(&self, seams: &Seams, source: &PolygonMesh) -> Vec<[VertexId; 2]> {
        let mut is_on_seam = vec![false; source.positions.len()];
        let is_seam = |edge: &[VertexId; 2]| seams.edges().contains(edge) || seams.automatic().contains(edge);
        let ends =
            seams.edges().iter().chain(seams.automatic()).flatten().filter(|end| end.index() < source.positions.len());
        ends.for_each(|end| is_on_seam[end.index()] = true);
        let mut sides = Vec::new();
        for face in 0..self.polygons.face_count() {
            let corners = self.polygons.corner_range(face);
            for corner in corners.clone() {
                let side = [corner, if corner + 1 < corners.end { corner + 1 } else { corners.start }];
                let edge = self.edge_in_file(source, face, side);
                if edge.iter().all(|end| is_on_seam[end.index()]) && is_seam(&edge) {
                    sides.push(side.map(|corner| self.polygons.corners[corner]));
                }
            }
        }
        sides
    }
}
