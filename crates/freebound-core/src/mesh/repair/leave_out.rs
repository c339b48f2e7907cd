//! Corners and faces that add nothing to the surface, and faces that repeat an earlier face.
//!
//! No repair removes area. A corner is removed if it repeats the vertex of the corner before it, or if the face runs
//! along a side and straight back. A face that still names a vertex twice encloses area, such as a polygon with a hole
//! whose inner and outer outline are joined by an edge: it stays.

use std::collections::{HashMap, HashSet};

use super::{Repair, Repaired, Repairs};
use crate::mesh::polygon::Walk;
use crate::mesh::{PolygonMesh, VertexId};

/// Fate of a face and its corners.
pub(super) enum Fate {
    /// Keep the corners at these positions of the face.
    Keep(Vec<usize>),
    /// Put the face in the place of another. Lists for each of its corners the corner that replaces it.
    Stack(Vec<u32>),
    /// Remove the face.
    Go,
}

/// Faces with equal vertices.
struct Equals {
    /// Corners of the first of them.
    first: Vec<VertexId>,
    /// Number of faces so far.
    count: usize,
}

impl Repaired {
    /// Removes repeated corners, and stacks duplicate faces, if allowed.
    pub(super) fn leave_out(&mut self, repairs: Repairs) {
        if repairs.allows(Repair::DropRepeatedCorners) {
            self.drop_repeated_corners(|_| true);
        }
        if stacks(repairs) {
            self.stack_duplicates(|_| true, |_, _| true);
        }
    }

    /// Removes repeated corners that joining vertices has created, and separates or stacks duplicate faces. Only faces at
    /// equal places in the given mesh, `source`, are stacked. Without a repair that allows it, faces that are degenerate or
    /// duplicate already in the given mesh stay.
    pub(super) fn leave_out_joined(&mut self, source: &PolygonMesh, repairs: Repairs) {
        let given = |own: &[u32]| -> Vec<VertexId> {
            let mut vertices: Vec<VertexId> = own.iter().map(|&corner| source.corners[corner as usize]).collect();
            vertices.sort_unstable();
            vertices
        };
        if !self.joined.is_empty() {
            self.drop_repeated_corners(|own| given(own).windows(2).all(|pair| pair[0] != pair[1]));
        }
        let mut seen = HashSet::new();
        if repairs.allows(Repair::SeparateDuplicates) {
            self.separate_duplicates(|_| true);
        } else if !self.joined.is_empty() {
            let place = |corner: u32| source.positions[source.corners[corner as usize].index()];
            let are_at_one_place = |own: u32, other: u32| place(own) == place(other);
            self.stack_duplicates(|own| stacks(repairs) || seen.insert(given(own)), are_at_one_place);
            seen.clear();
            self.separate_duplicates(|own| stacks(repairs) || seen.insert(given(own)));
        }
    }

    /// Removes repeated corners of the faces for which `is_looked_at` is true; its argument is their corners in the
    /// given mesh.
    fn drop_repeated_corners(&mut self, is_looked_at: impl Fn(&[u32]) -> bool) {
        let mut with_all_repairs = 0;
        let gone = self.decide(|corners, corner_of| {
            if !is_looked_at(corner_of) {
                return Fate::Keep((0..corners.len()).collect());
            }
            let kept = without_repeats(corners);
            with_all_repairs += usize::from(kept.len() < corners.len());
            if kept.len() < 3 { Fate::Go } else { Fate::Keep(kept) }
        });
        self.degenerate.extend(gone);
        self.degenerate.sort_unstable();
        self.note(Repair::DropRepeatedCorners, with_all_repairs);
    }

    /// Stacks duplicates among the faces for which `is_looked_at` is true if `may_share` is true for each pair of corners.
    /// The first predicate is called once per face, in order.
    fn stack_duplicates(&mut self, mut is_looked_at: impl FnMut(&[u32]) -> bool, may_share: impl Fn(u32, u32) -> bool) {
        // Maps the sorted vertices of a face to the first such face: its corners in the order of these vertices, and its
        // vertices in their own order.
        let mut seen: HashMap<Vec<VertexId>, (Vec<u32>, Vec<VertexId>)> =
            HashMap::with_capacity(self.polygons.face_count());
        let mut duplicates = 0;
        self.decide(|corners, corner_of| {
            if !is_looked_at(corner_of) {
                return Fate::Keep((0..corners.len()).collect());
            }
            let mut order: Vec<usize> = (0..corners.len()).collect();
            order.sort_unstable_by_key(|&k| corners[k]);
            let vertices: Vec<VertexId> = order.iter().map(|&k| corners[k]).collect();
            let Some((twins, first)) = seen.get(&vertices) else {
                let own = order.iter().map(|&k| corner_of[k]).collect();
                seen.insert(vertices, (own, corners.to_vec()));
                return Fate::Keep((0..corners.len()).collect());
            };
            let lies_there = Walk::between(corners, first).is_some();
            if !(lies_there && order.iter().zip(twins).all(|(&k, &twin)| may_share(corner_of[k], twin))) {
                return Fate::Keep((0..corners.len()).collect());
            }
            duplicates += 1;
            let mut stand_ins = vec![0; corners.len()];
            for (&k, &twin) in order.iter().zip(twins) {
                stand_ins[k] = twin;
            }
            Fate::Stack(stand_ins)
        });
        self.note(Repair::StackDuplicates, duplicates);
    }

    /// Gives duplicates among the faces for which `is_looked_at` is true their own vertices. Duplicates that run alike
    /// form a sheet of connected faces: the second sides of faces that are there from both sides, for one.
    fn separate_duplicates(&mut self, mut is_looked_at: impl FnMut(&[u32]) -> bool) {
        let mut seen: HashMap<Vec<VertexId>, Equals> = HashMap::with_capacity(self.polygons.face_count());
        // Copies of a vertex, by the number of equal faces before and the direction: `None` if the vertices have another
        // order.
        let mut copies: HashMap<(VertexId, usize, Option<bool>), VertexId> = HashMap::new();
        let mut duplicates = 0;
        for face in 0..self.polygons.face_count() {
            let range = self.polygons.corner_range(face);
            if !is_looked_at(&self.corner_of[range.clone()]) {
                continue;
            }
            let corners = self.polygons.face(face).to_vec();
            let mut vertices = corners.clone();
            vertices.sort_unstable();
            let Some(equals) = seen.get_mut(&vertices) else {
                seen.insert(vertices, Equals { first: corners, count: 1 });
                continue;
            };
            let direction = Walk::between(&corners, &equals.first).map(|walk| walk.runs_against);
            for corner in &mut self.polygons.corners[range] {
                let vertex = *corner;
                *corner = *copies.entry((vertex, equals.count, direction)).or_insert_with(|| {
                    self.polygons.positions.push(self.polygons.positions[vertex.index()]);
                    VertexId::from_index(self.polygons.positions.len() - 1)
                });
            }
            equals.count += 1;
            duplicates += 1;
        }
        self.note(Repair::SeparateDuplicates, duplicates);
    }

    /// Applies `fate` to each face, and returns the faces of the given mesh that go. The arguments of `fate` are the
    /// face's vertices and its corners in the given mesh.
    pub(super) fn decide(&mut self, mut fate: impl FnMut(&[VertexId], &[u32]) -> Fate) -> Vec<u32> {
        let (mut corners, mut corner_of, mut face_of) = (Vec::new(), Vec::new(), Vec::new());
        let (mut starts, mut gone) = (vec![0], Vec::new());
        for (face, &of) in self.face_of.iter().enumerate() {
            let own = &self.corner_of[self.polygons.corner_range(face)];
            let vertices = self.polygons.face(face);
            match fate(vertices, own) {
                Fate::Go => gone.push(of),
                Fate::Stack(stand_ins) => {
                    self.stand_ins.extend(own.iter().zip(stand_ins).map(|(&own, other)| [own, other]));
                }
                Fate::Keep(kept) => {
                    self.stand_ins.extend(left_out(&kept, own));
                    corners.extend(kept.iter().map(|&k| vertices[k]));
                    corner_of.extend(kept.iter().map(|&k| own[k]));
                    face_of.push(of);
                    starts.push(u32::try_from(corners.len()).expect("no more corners than before"));
                }
            }
        }
        let are_triangles = starts.windows(2).all(|bounds| bounds[1] - bounds[0] == 3);
        self.polygons.starts = (!are_triangles).then_some(starts);
        (self.polygons.corners, self.corner_of, self.face_of) = (corners, corner_of, face_of);
        gone
    }
}

/// True if duplicate faces share a place.
fn stacks(repairs: Repairs) -> bool {
    repairs.allows(Repair::StackDuplicates) && !repairs.allows(Repair::SeparateDuplicates)
}

/// Removed corners of a face, each with the kept corner before it, in whose place it is written.
fn left_out(kept: &[usize], own: &[u32]) -> Vec<[u32; 2]> {
    if kept.len() == own.len() {
        return Vec::new();
    }
    let mut before = kept[kept.len() - 1];
    let mut next = kept.iter().peekable();
    let mut found = Vec::new();
    for k in 0..own.len() {
        match next.next_if(|&&kept| kept == k) {
            Some(_) => before = k,
            None => found.push([own[k], own[before]]),
        }
    }
    found
}

/// Positions of the corners that remain without repeats: corners with the vertex of the previous corner, and two
/// corners that run along a side and back.
fn without_repeats(corners: &[VertexId]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::with_capacity(corners.len());
    for (place, &corner) in corners.iter().enumerate() {
        match kept[..] {
            [.., last] if corners[last] == corner => {}
            [.., before, _] if corners[before] == corner => {
                kept.pop();
            }
            _ => kept.push(place),
        }
    }
    // The last corners meet the first.
    let mut kept = &kept[..];
    loop {
        kept = match kept {
            [first, .., last] if corners[*first] == corners[*last] => &kept[1..],
            [_, second, .., last] if corners[*second] == corners[*last] => &kept[2..],
            [first, .., before, _] if corners[*first] == corners[*before] => &kept[1..kept.len() - 1],
            _ => return kept.to_vec(),
        };
    }
}
