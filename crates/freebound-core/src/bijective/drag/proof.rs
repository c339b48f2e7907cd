//! The proof of a frame, from that of the one before.
//!
//! # Theorem
//!
//! Let an embedding be planar, with positive faces, and let some vertices move. It is planar again, with positive faces, if
//!
//! 1. every face at a vertex that moved is positive, what fills holes included, and so is every triangle at a convex
//!    corner of a polygon that has such a face: the others have not moved; and
//! 2. the boundary is simple.
//!
//! This is the theorem of the exact verdict (see the module `verdict`), of which only what could have changed is asked anew.
//! For 2 one of these is enough:
//!
//! * no boundary vertex moved;
//! * the outside is triangulated up to a frame, all its triangles were positive, and those at boundary vertices that
//!   moved are positive still. Then mesh and outside together are a disk in which all faces are positive and whose
//!   boundary is the frame, which is simple: they are one-to-one by the theorem, and so is the boundary within;
//! * no two of its edges meet, which is asked of the whole boundary.
//!
//! All of it is decided exactly in the numbers that are written. So the work of a frame is that of the region that
//! moves, and the answer is the same as that of the whole verdict.

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::geom::{Orientation, is_simple, orientation};
use crate::mesh::DiskMesh;
use crate::problem::Embedding;
use crate::verify::verdict::{in_f32, planar_sense, sense_of_surface};
use crate::verify::{UvFrame, Verdict};

/// Triangles that share the work of one task.
const TRIANGLES_PER_TASK: usize = 1024;

/// Whether a triangle is positive, exactly.
pub(super) fn is_upright([a, b, c]: [DVec2; 3]) -> bool {
    orientation(a, b, c) == Some(Orientation::CounterClockwise)
}

/// Whether all these triangles over some places are positive, exactly.
pub(super) fn are_upright(triangles: &[[u32; 3]], places: &[DVec2]) -> bool {
    let is_so = |triangle: &[u32; 3]| is_upright(triangle.map(|corner| places[corner as usize]));
    triangles.par_iter().with_min_len(TRIANGLES_PER_TASK).all(is_so)
}

/// How the boundary of an embedding is proved simple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Boundary {
    /// It has not moved.
    Stays,
    /// The outside is positive.
    WithinFrame,
    /// It has been looked at as a whole.
    Whole,
}

/// What moved, with its places as they are written.
pub(super) struct MovedRegion<'a> {
    /// Faces and ears of polygons.
    pub(super) faces: &'a [[u32; 3]],
    /// What fills holes.
    pub(super) filling: &'a [[u32; 3]],
    /// Triangles outside.
    pub(super) outside: &'a [[u32; 3]],
    /// Whether some boundary vertex is among what moves, and whether the outside was positive before.
    pub(super) has_boundary: bool,
    pub(super) is_outside_positive: bool,
    pub(super) places: Vec<DVec2>,
}

impl MovedRegion<'_> {
    /// Whether the embedding is planar where it was so before, and how its boundary is known to be simple. `boundary` gives
    /// all of that as it is written.
    pub(super) fn proof(&self, boundary: impl FnOnce() -> Vec<DVec2>) -> Option<Boundary> {
        if !are_upright(self.faces, &self.places) || !are_upright(self.filling, &self.places) {
            return None;
        }
        if !self.has_boundary {
            return Some(Boundary::Stays);
        }
        if self.is_outside_positive && are_upright(self.outside, &self.places) {
            return Some(Boundary::WithinFrame);
        }
        is_simple(&boundary()).then_some(Boundary::Whole)
    }

    /// The same where the outside was positive before, or not.
    pub(super) fn beside(self, is_outside_positive: bool) -> Self {
        Self { is_outside_positive, ..self }
    }

    /// The same in 32 bits of every number.
    pub(super) fn in_f32(&self, is_outside_positive: bool) -> Self {
        let places = self.places.iter().map(|z| z.as_vec2().as_dvec2()).collect();
        Self { is_outside_positive, places, ..*self }
    }

    /// Whether faces and ears are positive.
    pub(super) fn has_upright_faces(&self) -> bool {
        are_upright(self.faces, &self.places)
    }
}

/// Whether an embedding is planar as it lies, what fills holes positive, in the numbers that are written; and if so, whether
/// in 32 bits, too.
pub(super) fn whole_proof(mesh: &DiskMesh, embedding: &Embedding, sheet: &UvFrame) -> Option<InF32> {
    let written = sheet.written(embedding);
    let is_planar = planar_sense(mesh, &written) == Some(Orientation::CounterClockwise);
    is_planar.then(|| InF32::of(mesh, &written))
}

/// What is written, in 32 bits of every number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InF32 {
    /// Planar, and what fills holes positive: the theorem goes on from it.
    Positive,
    /// Planar, but for what fills holes.
    Planar,
    Folded,
}

impl InF32 {
    /// Looks at all of what is written.
    pub(super) fn of(mesh: &DiskMesh, written: &Embedding) -> Self {
        let rounded = in_f32(written);
        let upright = Some(Orientation::CounterClockwise);
        if planar_sense(mesh, &rounded) == upright {
            Self::Positive
        } else if sense_of_surface(mesh, &rounded) == upright {
            Self::Planar
        } else {
            Self::Folded
        }
    }
}

/// The verdict on an embedding that is proved planar as it lies.
pub(super) fn verdict_of_planar(planar_in_f32: bool) -> Verdict {
    Verdict {
        planar: true,
        flipped_faces: Vec::new(),
        concave_polygons: Vec::new(),
        crossed_holes: Vec::new(),
        is_filling_folded: false,
        boundary_crossings: Vec::new(),
        more_crossings: false,
        overwound_vertices: Vec::new(),
        turning_number: Some(1),
        zero_area_faces: 0,
        mirrored: false,
        planar_in_f32,
    }
}
