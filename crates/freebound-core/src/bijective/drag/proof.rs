//! Proof of a frame, from that of the previous frame.
//!
//! # Theorem
//!
//! Let an embedding be planar, with positive faces, and let some vertices move. The new embedding is planar, with
//! positive faces, if
//!
//! 1. every face at a vertex that moved is positive, including the filling of holes, and so is every triangle at a
//!    convex corner of a polygon with such a face (all other faces have not moved); and
//! 2. the boundary is simple.
//!
//! This is the theorem of the exact verdict (see the module `verdict`), applied to the parts that could have changed.
//! Each of three arguments proves condition 2:
//!
//! * no boundary vertex moved;
//! * the outside is triangulated up to a frame, all its triangles were positive, and those at moved boundary vertices
//!   are still positive. Then mesh and outside together are a disk with positive faces, and its boundary is the frame,
//!   which is simple. The disk is one-to-one by the theorem, and so is the boundary within it;
//! * no two edges of the whole boundary meet.
//!
//! Every condition is decided exactly for the written numbers. The work of a frame is therefore that of the moved
//! region, and the answer is equal to the complete verdict.

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::geom::{Orientation, is_simple, orientation};
use crate::mesh::DiskMesh;
use crate::problem::Embedding;
use crate::verify::verdict::{in_f32, planar_sense, sense_of_surface};
use crate::verify::{UvFrame, Verdict};

/// Number of triangles per parallel task.
const TRIANGLES_PER_TASK: usize = 1024;

/// True if a triangle is positive, exactly.
pub(super) fn is_upright([a, b, c]: [DVec2; 3]) -> bool {
    orientation(a, b, c) == Some(Orientation::CounterClockwise)
}

/// True if all triangles are positive, exactly. Corners are indices into `places`.
pub(super) fn are_upright(triangles: &[[u32; 3]], places: &[DVec2]) -> bool {
    let is_so = |triangle: &[u32; 3]| is_upright(triangle.map(|corner| places[corner as usize]));
    triangles.par_iter().with_min_len(TRIANGLES_PER_TASK).all(is_so)
}

/// Argument that proves the boundary of an embedding simple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Boundary {
    /// No boundary vertex has moved.
    Stays,
    /// All triangles of the outside are positive.
    WithinFrame,
    /// The whole boundary was tested.
    Whole,
}

/// Region that moved, with its positions as written.
pub(super) struct MovedRegion<'a> {
    /// Faces, and ears of polygons.
    pub(super) faces: &'a [[u32; 3]],
    /// Triangles that fill holes.
    pub(super) filling: &'a [[u32; 3]],
    /// Triangles of the outside.
    pub(super) outside: &'a [[u32; 3]],
    /// True if some boundary vertex moved.
    pub(super) has_boundary: bool,
    /// True if the outside was positive before the move.
    pub(super) is_outside_positive: bool,
    pub(super) places: Vec<DVec2>,
}

impl MovedRegion<'_> {
    /// Proves the embedding planar, given that it was planar before the move. Returns the argument for its simple
    /// boundary; `None` if there is no proof. `boundary` provides the whole boundary loop as written.
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

    /// Region with another state of the outside before the move.
    pub(super) fn beside(self, is_outside_positive: bool) -> Self {
        Self { is_outside_positive, ..self }
    }

    /// Region with every number rounded to 32 bits.
    pub(super) fn in_f32(&self, is_outside_positive: bool) -> Self {
        let places = self.places.iter().map(|z| z.as_vec2().as_dvec2()).collect();
        Self { is_outside_positive, places, ..*self }
    }

    /// True if faces and ears are positive.
    pub(super) fn has_upright_faces(&self) -> bool {
        are_upright(self.faces, &self.places)
    }
}

/// Proof of a whole embedding as written: planar, with positive orientation, including the filling of holes. Returns
/// its state in 32 bits; `None` if there is no proof.
pub(super) fn whole_proof(mesh: &DiskMesh, embedding: &Embedding, sheet: &UvFrame) -> Option<InF32> {
    let written = sheet.written(embedding);
    let is_planar = planar_sense(mesh, &written) == Some(Orientation::CounterClockwise);
    is_planar.then(|| InF32::of(mesh, &written))
}

/// State of the written embedding with every number rounded to 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InF32 {
    /// Planar, with positive fillings of holes: the theorem applies to the next frame.
    Positive,
    /// Planar, but with a folded filling of a hole.
    Planar,
    Folded,
}

impl InF32 {
    /// Tests the whole written embedding.
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

/// Verdict on an embedding that is proved planar with positive orientation.
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
