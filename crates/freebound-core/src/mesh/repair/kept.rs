//! Parts to keep, and parts to leave out.

use std::collections::BTreeSet;

use super::charts::parts_of;
use super::leave_out::Fate;
use super::sides::Sides;
use super::{Repair, Repaired};

/// An edge-connected part of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartFaces {
    /// Number of the part's first face in the file.
    pub first_face: u32,
    /// Number of faces.
    pub count: usize,
}

impl Repaired {
    /// Edge-connected parts, in the order of their first faces.
    pub(super) fn parts(&self) -> Vec<PartFaces> {
        let parts = parts_of(&self.polygons, &Sides::new(&self.polygons));
        let part = |faces: &Vec<u32>| PartFaces { first_face: self.face_of[faces[0] as usize], count: faces.len() };
        parts.iter().map(part).collect()
    }

    /// Leaves out the parts with these first faces, by their numbers in the file. Does nothing if no part would
    /// remain.
    pub(super) fn leave_parts_out(&mut self, first_faces: &BTreeSet<u32>) {
        if first_faces.is_empty() || !self.is_sound() {
            return;
        }
        let parts = parts_of(&self.polygons, &Sides::new(&self.polygons));
        let is_unwanted = |part: &&Vec<u32>| first_faces.contains(&self.face_of[part[0] as usize]);
        let unwanted: Vec<&Vec<u32>> = parts.iter().filter(is_unwanted).collect();
        if unwanted.is_empty() || unwanted.len() == parts.len() {
            return;
        }
        let mut goes = vec![false; self.polygons.face_count()];
        for &face in unwanted.iter().copied().flatten() {
            goes[face as usize] = true;
        }
        let mut fates = goes.into_iter();
        let gone = self.decide(|corners, _| match fates.next() {
            Some(true) => Fate::Go,
            _ => Fate::Keep((0..corners.len()).collect()),
        });
        self.left_out.extend(gone);
        self.note(Repair::LeaveOutParts, unwanted.len());
    }

    /// Faces of the parts that were left out, by their numbers in the file.
    pub fn left_out(&self) -> &[u32] {
        &self.left_out
    }
}
