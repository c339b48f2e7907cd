//! Corners and faces that add nothing to the surface are left out.

use std::collections::HashSet;

use super::{Repair, Repaired};
use crate::mesh::VertexId;

impl Repaired {
    /// Leaves out repeated corners, then duplicate faces.
    pub(super) fn leave_out(&mut self) {
        let mut mended = 0;
        self.keep_corners(|corners| {
            let kept = Some(without_repeats(corners)).filter(|kept| kept.len() >= 3 && !has_repeats(corners, kept));
            mended += usize::from(kept.as_ref().is_none_or(|kept| kept.len() < corners.len()));
            kept.unwrap_or_default()
        });
        self.note(Repair::DropRepeatedCorners, mended);

        let mut seen = HashSet::with_capacity(self.polygons.face_count());
        let mut duplicates = 0;
        self.keep_corners(|corners| {
            let mut sorted = corners.to_vec();
            sorted.sort_unstable();
            let is_new = seen.insert(sorted);
            duplicates += usize::from(!is_new);
            if is_new { (0..corners.len()).collect() } else { Vec::new() }
        });
        self.note(Repair::DropDuplicateFaces, duplicates);
    }

    /// Keeps those corners of each face that are chosen; a face with none goes.
    fn keep_corners(&mut self, mut chosen: impl FnMut(&[VertexId]) -> Vec<usize>) {
        let (mut corners, mut corner_of, mut face_of) = (Vec::new(), Vec::new(), Vec::new());
        let mut starts = vec![0];
        for (face, &of) in self.face_of.iter().enumerate() {
            let range = self.polygons.corner_range(face);
            let kept = chosen(self.polygons.face(face));
            if kept.is_empty() {
                continue;
            }
            corners.extend(kept.iter().map(|&k| self.polygons.corners[range.start + k]));
            corner_of.extend(kept.iter().map(|&k| self.corner_of[range.start + k]));
            face_of.push(of);
            starts.push(u32::try_from(corners.len()).expect("fewer corners than before"));
        }
        let are_triangles = starts.windows(2).all(|bounds| bounds[1] - bounds[0] == 3);
        self.polygons.starts = (!are_triangles).then_some(starts);
        (self.polygons.corners, self.corner_of, self.face_of) = (corners, corner_of, face_of);
    }
}

/// The places of corners that differ from the one before, around the face.
fn without_repeats(corners: &[VertexId]) -> Vec<usize> {
    let count = corners.len();
    (0..count).filter(|&k| corners[k] != corners[(k + count - 1) % count]).collect()
}

/// Whether a face still names a vertex twice.
fn has_repeats(corners: &[VertexId], kept: &[usize]) -> bool {
    let mut sorted: Vec<VertexId> = kept.iter().map(|&k| corners[k]).collect();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}
