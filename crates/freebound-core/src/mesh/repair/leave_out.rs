//! Removal of corners and faces that add nothing to the surface.

use std::collections::{HashMap, HashSet};

use super::{Repair, Repaired, Repairs};
use crate::mesh::{PolygonMesh, VertexId};

/// Fate of a face and its corners.
pub(super) enum Fate {
    /// Keep the corners at these positions of the face.
    Keep(Vec<usize>),
    /// Remove the face. Lists for each of its corners the corner of another face that replaces it; may be empty.
    Go(Vec<u32>),
}

impl Repaired {
    /// Removes repeated corners, then duplicate faces, if allowed.
    pub(super) fn leave_out(&mut self, repairs: Repairs) {
        if repairs.allows(Repair::DropRepeatedCorners) {
            self.drop_repeated_corners(|_| true);
        }
        if repairs.allows(Repair::DropDuplicateFaces) {
            self.drop_duplicate_faces(|_| true);
        }
    }

    /// Removes repeated corners and duplicate faces that joining vertices has created. Faces that are degenerate or
    /// duplicate already in the given mesh, `source`, stay.
    pub(super) fn leave_out_joined(&mut self, source: &PolygonMesh) {
        if self.joined.is_empty() {
            return;
        }
        let given = |own: &[u32]| -> Vec<VertexId> {
            let mut vertices: Vec<VertexId> = own.iter().map(|&corner| source.corners[corner as usize]).collect();
            vertices.sort_unstable();
            vertices
        };
        self.drop_repeated_corners(|own| given(own).windows(2).all(|pair| pair[0] != pair[1]));
        let mut seen = HashSet::new();
        self.drop_duplicate_faces(|own| seen.insert(given(own)));
    }

    /// Removes repeated corners of the faces for which `is_looked_at` is true; its argument is their corners in the
    /// given mesh.
    fn drop_repeated_corners(&mut self, is_looked_at: impl Fn(&[u32]) -> bool) {
        let mut with_all_repairs = 0;
        self.decide(|corners, corner_of| {
            if !is_looked_at(corner_of) {
                return Fate::Keep((0..corners.len()).collect());
            }
            let kept = Some(without_repeats(corners)).filter(|kept| kept.len() >= 3 && !has_repeats(corners, kept));
            with_all_repairs += usize::from(kept.as_ref().is_none_or(|kept| kept.len() < corners.len()));
            kept.map_or(Fate::Go(Vec::new()), Fate::Keep)
        });
        self.note(Repair::DropRepeatedCorners, with_all_repairs);
    }

    /// Removes duplicates among the faces for which `is_looked_at` is true. The predicate is called once per face, in
    /// order.
    fn drop_duplicate_faces(&mut self, mut is_looked_at: impl FnMut(&[u32]) -> bool) {
        // Maps the sorted vertices of a face to the corners of the first such face, in the order of these vertices.
        let mut seen: HashMap<Vec<VertexId>, Vec<u32>> = HashMap::with_capacity(self.polygons.face_count());
        let mut duplicates = 0;
        self.decide(|corners, corner_of| {
            if !is_looked_at(corner_of) {
                return Fate::Keep((0..corners.len()).collect());
            }
            let mut order: Vec<usize> = (0..corners.len()).collect();
            order.sort_unstable_by_key(|&k| corners[k]);
            let vertices: Vec<VertexId> = order.iter().map(|&k| corners[k]).collect();
            let Some(twins) = seen.get(&vertices) else {
                seen.insert(vertices, order.iter().map(|&k| corner_of[k]).collect());
                return Fate::Keep((0..corners.len()).collect());
            };
            duplicates += 1;
            let mut stand_ins = vec![0; corners.len()];
            for (&k, &twin) in order.iter().zip(twins) {
                stand_ins[k] = twin;
            }
            Fate::Go(stand_ins)
        });
        self.note(Repair::DropDuplicateFaces, duplicates);
    }

    /// Applies `fate` to each face. The arguments of `fate` are the face's vertices and its corners in the given mesh.
    pub(super) fn decide(&mut self, mut fate: impl FnMut(&[VertexId], &[u32]) -> Fate) {
        let (mut corners, mut corner_of, mut face_of) = (Vec::new(), Vec::new(), Vec::new());
        let mut starts = vec![0];
        for (face, &of) in self.face_of.iter().enumerate() {
            let own = &self.corner_of[self.polygons.corner_range(face)];
            let vertices = self.polygons.face(face);
            match fate(vertices, own) {
                Fate::Go(stand_ins) => {
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
    }
}

/// Removed corners of a face, each with the kept corner before it, whose vertex it repeats.
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

/// Positions of corners that differ from the previous corner around the face.
fn without_repeats(corners: &[VertexId]) -> Vec<usize> {
    let count = corners.len();
    (0..count).filter(|&k| corners[k] != corners[(k + count - 1) % count]).collect()
}

/// True if the kept corners of a face still name a vertex twice.
fn has_repeats(corners: &[VertexId], kept: &[usize]) -> bool {
    let mut sorted: Vec<VertexId> = kept.iter().map(|&k| corners[k]).collect();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}
