//! Joining of coincident vertices, splitting of vertices and edges, and flipping of faces.

use std::collections::{BTreeSet, HashMap};

use super::sides::Sides;
use super::{Repair, Repaired};
use crate::mesh::coincident::coincident_vertices;
use crate::mesh::edges::EdgeTable;
use crate::mesh::fault::Elements;
use crate::mesh::union::DisjointSets;
use crate::mesh::{FaceId, Fault, VertexId, diagnose, place_key};

impl Repaired {
    /// Joins vertices of different parts whose positions are equal to the bit.
    pub(super) fn weld(&mut self) {
        let mesh = self.polygons.triangulate();
        let found = coincident_vertices(&mesh, &mesh.triangles);
        if found.is_empty() {
            return;
        }
        let place = |v: VertexId| place_key(mesh.positions[v.index()]);
        let mut first: HashMap<[u64; 3], VertexId> = found.iter().map(|&v| (place(v), v)).collect();
        for &v in mesh.triangles.iter().flatten() {
            first.entry(place(v)).and_modify(|lowest| *lowest = v.min(*lowest));
        }
        let pairs = found.iter().map(|&vertex| (vertex, first[&place(vertex)]));
        self.joined.extend(pairs.filter(|(vertex, to)| vertex != to));
        for corner in &mut self.polygons.corners {
            *corner = self.joined.get(corner).copied().unwrap_or(*corner);
        }
        self.note(Repair::WeldVertices, found.len());
    }

    /// Gives the faces at edges with three or more faces separate edges.
    pub(super) fn split_edges(&mut self) {
        let sides = Sides::new(&self.polygons);
        let crowded = sides.table.edges().filter(|sides| sides.len() > 2).count();
        if crowded > 0 {
            let fans = sides.fans(|sides| sides.len() == 2);
            self.split_into(fans);
        }
        let mut count = crowded;
        // Polygons can be cut in another way once their neighbours are apart. Each round takes at least one polygon apart.
        loop {
            let diagonals = self.split_diagonals();
            if diagonals == 0 {
                break;
            }
            count += diagonals;
        }
        if count > 0 {
            self.note(Repair::SplitEdges, count);
        }
    }

    /// Takes polygons apart whose triangles meet at an edge of three or more triangles: narrow polygons along one chain of
    /// vertices can have the same diagonal. Returns the number of such edges.
    fn split_diagonals(&mut self) -> usize {
        if self.polygons.starts.is_none() {
            return 0;
        }
        let mesh = self.polygons.triangulate();
        let table = EdgeTable::new(mesh.vertex_count(), &mesh.triangles);
        let mut is_apart = vec![false; self.polygons.face_count()];
        let mut crowded = 0;
        for sides in table.edges().filter(|sides| sides.len() > 2) {
            crowded += 1;
            let polygons: BTreeSet<u32> = sides.iter().map(|&side| mesh.polygon(FaceId::new(side / 3))).collect();
            let is_triangle = |&polygon: &u32| self.polygons.face(polygon as usize).len() == 3;
            // One polygon can stay if it has the edge for itself then.
            let staying = usize::from(!polygons.iter().any(is_triangle));
            for polygon in polygons.into_iter().filter(|polygon| !is_triangle(polygon)).skip(staying) {
                is_apart[polygon as usize] = true;
            }
        }
        // Edges of triangles alone stay.
        if !is_apart.contains(&true) {
            return 0;
        }
        let sides = Sides::new(&self.polygons);
        let fans = sides.fans(|on| on.iter().all(|&side| !is_apart[sides.face[side as usize] as usize]));
        self.split_into(fans);
        crowded
    }

    /// Gives each fan of faces that meet only at a vertex its own vertex.
    pub(super) fn split_vertices(&mut self) {
        let fans = Sides::new(&self.polygons).fans(|_| true);
        let split = self.split_into(fans);
        self.note(Repair::SplitVertices, split);
    }

    /// Gives each fan of corners its own vertex. The first fan keeps the vertex; new vertices are numbered after all
    /// others. Returns the number of vertices that were split.
    pub(super) fn split_into(&mut self, mut fans: DisjointSets) -> usize {
        const NONE: u32 = u32::MAX;
        let mut fan_of_vertex = vec![NONE; self.polygons.positions.len()];
        let mut new_of_fan: HashMap<u32, VertexId> = HashMap::new();
        let mut split = BTreeSet::new();
        for (number, corner) in (0..).zip(&mut self.polygons.corners) {
            let fan = fans.find(number);
            let holder = &mut fan_of_vertex[corner.index()];
            if *holder == NONE {
                *holder = fan;
            } else if *holder != fan {
                let old = *corner;
                split.insert(old);
                *corner = *new_of_fan.entry(fan).or_insert_with(|| {
                    let position = self.polygons.positions[old.index()];
                    self.polygons.positions.push(position);
                    VertexId::from_index(self.polygons.positions.len() - 1)
                });
            }
        }
        split.len()
    }

    /// Flips the smaller set of faces of each part, so that all faces have a consistent orientation.
    pub(super) fn turn_faces(&mut self) {
        self.turn_faces_where(|_| true);
    }

    /// Flips faces like [`turn_faces`](Self::turn_faces), but only faces that were on a one-sided surface before it
    /// was cut: the surface may have two sides now.
    pub(super) fn turn_faces_that_were(&mut self, one_sided: &[bool]) {
        if one_sided.contains(&true) {
            self.turn_faces_where(|face| one_sided[face]);
        }
    }

    fn turn_faces_where(&mut self, may_turn: impl Fn(usize) -> bool) {
        let found = diagnose(&self.polygons.triangulate());
        let mixed = found.faults.iter().find(|fault| matches!(fault, Fault::MixedOrientation { .. }));
        let Some(Elements::Faces(faces)) = mixed.map(Fault::elements) else { return };
        let faces: Vec<usize> =
            faces.polygons.iter().map(|&face| face as usize).filter(|&face| may_turn(face)).collect();
        for &face in &faces {
            let range = self.polygons.corner_range(face);
            self.polygons.corners[range.clone()].reverse();
            self.corner_of[range].reverse();
        }
        self.note(Repair::TurnFaces, faces.len());
    }
}
