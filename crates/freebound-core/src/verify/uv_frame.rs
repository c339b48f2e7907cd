//! The numbers that are written of an embedding: what a proof is of.
//!
//! Texture coordinates of a picture that is not square are not the plane's: x is divided by its aspect, which rounds, and
//! where v runs down it is turned over. Pins that are met have their own numbers there, not those of the plane.

use std::borrow::Cow;

use glam::DVec2;

use super::{is_one_to_one, is_planar};
use crate::geom::{PictureFrame, VAxis};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Embedding, Pin, PinPositions, Pins};

/// How an embedding is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UvFrame {
    frame: PictureFrame,
    /// Texture coordinates of the exact pins, in the frame.
    targets: PinPositions,
}

impl UvFrame {
    /// A sheet under a picture, whose exact pins have these texture coordinates.
    pub fn new(frame: PictureFrame, targets: PinPositions) -> Self {
        Self { frame, targets }
    }

    /// The picture.
    pub(crate) fn frame(&self) -> PictureFrame {
        self.frame
    }

    /// The same sheet without pins.
    pub(crate) fn without_pins(&self) -> Self {
        Self::new(self.frame, PinPositions::new())
    }

    /// The texture coordinates of an embedding as they are written, v up. Pins that lie on their targets have the numbers
    /// that they were given.
    pub fn written<'a>(&self, embedding: &'a Embedding) -> Cow<'a, Embedding> {
        if self.is_plain() {
            return Cow::Borrowed(embedding);
        }
        let mut coordinates: Embedding = embedding.iter().map(|&z| self.frame.uv_from_plane(z)).collect();
        for (&vertex, &uv) in &self.targets {
            if embedding[vertex] == self.frame.plane_from_uv(uv) {
                coordinates[vertex] = uv;
            }
        }
        if self.frame.v_axis == VAxis::Down {
            coordinates.iter_mut().for_each(|uv| *uv = upright(*uv));
        }
        Cow::Owned(coordinates)
    }

    /// The same for a place alone, of a vertex where it is one.
    pub(crate) fn written_place(&self, vertex: Option<VertexId>, z: DVec2) -> DVec2 {
        if self.is_plain() {
            return z;
        }
        let target = vertex.and_then(|vertex| self.targets.get(&vertex).copied());
        let of_pin = target.filter(|&uv| z == self.frame.plane_from_uv(uv));
        let uv = of_pin.unwrap_or_else(|| self.frame.uv_from_plane(z));
        if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv }
    }

    /// Whether the plane's numbers are those that are written.
    pub(crate) fn is_plain(&self) -> bool {
        self.frame == PictureFrame::default()
    }

    /// Pins where they are to be in what is written.
    pub(crate) fn written_pins(&self, pins: &Pins) -> Pins {
        let place = |vertex: &VertexId, pin: &Pin| {
            let uv = self.targets.get(vertex).copied().unwrap_or_else(|| self.frame.uv_from_plane(pin.target));
            if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv }
        };
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { target: place(&vertex, pin), ..*pin })).collect()
    }

    /// The embedding that coordinates are written of, its exact pins on their targets.
    pub(crate) fn in_plane(&self, written: &Embedding, pins: &Pins) -> Embedding {
        let in_frame = |uv: DVec2| if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv };
        let mut embedding: Embedding = written.iter().map(|&uv| self.frame.plane_from_uv(in_frame(uv))).collect();
        for (&vertex, pin) in pins.iter().filter(|(_, pin)| pin.kind.is_hard()) {
            embedding[vertex] = pin.target;
        }
        embedding
    }

    /// Whether an embedding is one-to-one as it is written.
    pub(crate) fn is_one_to_one(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        is_one_to_one(mesh, &self.written(embedding))
    }

    /// The same, with convex polygons.
    pub(crate) fn is_planar(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        is_planar(mesh, &self.written(embedding))
    }
}

/// Texture coordinates with v up of those with v down, and the other way round.
fn upright(uv: DVec2) -> DVec2 {
    DVec2::new(uv.x, 1.0 - uv.y)
}
