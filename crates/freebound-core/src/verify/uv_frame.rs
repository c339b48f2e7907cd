//! Output coordinates of an embedding: the numbers that are written and proved.
//!
//! Texture coordinates of a picture that is not square differ from the plane's coordinates: x is divided by the
//! aspect, which rounds. If v runs down, y is turned over. Pins that are met have the numbers of their targets, not
//! of the plane.

use std::borrow::Cow;

use glam::DVec2;

use super::{is_one_to_one, is_planar};
use crate::geom::{PictureFrame, VAxis};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Embedding, Pin, PinPositions, Pins};

/// Conversion of an embedding to its output coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UvFrame {
    frame: PictureFrame,
    /// Texture coordinates of the hard pins, in the frame.
    targets: PinPositions,
}

impl UvFrame {
    /// Output frame of a picture. `targets` are the texture coordinates of the hard pins.
    pub fn new(frame: PictureFrame, targets: PinPositions) -> Self {
        Self { frame, targets }
    }

    /// Frame of the picture.
    pub(crate) fn frame(&self) -> PictureFrame {
        self.frame
    }

    /// Output frame without pins.
    pub(crate) fn without_pins(&self) -> Self {
        Self::new(self.frame, PinPositions::new())
    }

    /// Texture coordinates of an embedding as they are written, v up. Pins at their targets have the numbers of the
    /// targets.
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

    /// Output coordinates of a single position. `vertex` is the vertex at the position, if there is one.
    pub(crate) fn written_place(&self, vertex: Option<VertexId>, z: DVec2) -> DVec2 {
        if self.is_plain() {
            return z;
        }
        let target = vertex.and_then(|vertex| self.targets.get(&vertex).copied());
        let of_pin = target.filter(|&uv| z == self.frame.plane_from_uv(uv));
        let uv = of_pin.unwrap_or_else(|| self.frame.uv_from_plane(z));
        if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv }
    }

    /// True if output coordinates equal the plane's coordinates.
    pub(crate) fn is_plain(&self) -> bool {
        self.frame == PictureFrame::default()
    }

    /// Pins with their targets in output coordinates.
    pub(crate) fn written_pins(&self, pins: &Pins) -> Pins {
        let place = |vertex: &VertexId, pin: &Pin| {
            let uv = self.targets.get(vertex).copied().unwrap_or_else(|| self.frame.uv_from_plane(pin.target));
            if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv }
        };
        pins.iter().map(|(&vertex, pin)| (vertex, Pin { target: place(&vertex, pin), ..*pin })).collect()
    }

    /// Embedding with these output coordinates, hard pins at their targets.
    pub(crate) fn in_plane(&self, written: &Embedding, pins: &Pins) -> Embedding {
        let in_frame = |uv: DVec2| if self.frame.v_axis == VAxis::Down { upright(uv) } else { uv };
        let mut embedding: Embedding = written.iter().map(|&uv| self.frame.plane_from_uv(in_frame(uv))).collect();
        for (&vertex, pin) in pins.iter().filter(|(_, pin)| pin.kind.is_hard()) {
            embedding[vertex] = pin.target;
        }
        embedding
    }

    /// True if an embedding is one-to-one in output coordinates.
    pub(crate) fn is_one_to_one(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        is_one_to_one(mesh, &self.written(embedding))
    }

    /// True if an embedding is planar in output coordinates: one-to-one, without concave polygons.
    pub(crate) fn is_planar(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        is_planar(mesh, &self.written(embedding))
    }
}

/// Texture coordinates with v turned over: from down to up, or from up to down.
fn upright(uv: DVec2) -> DVec2 {
    DVec2::new(uv.x, 1.0 - uv.y)
}
