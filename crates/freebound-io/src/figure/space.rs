//! Mesh in space drawn into an area: lit faces, far ones first, and the boundary.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Ink, Page, colours};
use crate::raster::{Colour, View};
use freebound_core::geom::{Bounds, SpaceBounds};
use freebound_core::mesh::DiskMesh;

/// Margin around the mesh, relative to the area.
const MARGIN: f64 = 0.04;

/// Width of the edges of faces, points.
const EDGE: f64 = 0.35;

/// Width of the boundary, points.
const BOUNDARY: f64 = 2.0;

/// Direction from the mesh to the light, in the axes of the view: from the upper left.
const LIGHT: DVec3 = DVec3::new(-0.4, 0.6, 0.7);

/// Mesh in space in a panel.
#[derive(Clone, Debug)]
pub struct SpaceDrawing {
    /// The mesh.
    pub mesh: Arc<DiskMesh>,
    /// Direction of the view.
    pub view: View,
}

impl SpaceDrawing {
    /// Draws the mesh into an area.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        let seen = self.view.see(&self.mesh.mesh().positions);
        let bounds = SpaceBounds::of(seen.iter().copied());
        let (centre, extent) = (bounds.middle(), bounds.high - bounds.low);
        let scale = (area.size() / extent.truncate()).min_element() * (1.0 - 2.0 * MARGIN);
        let place = |p: DVec3| area.middle() + scale * DVec2::new(p.x - centre.x, centre.y - p.y);
        let depth = |corners: &[DVec3; 3]| corners.iter().map(|p| p.z).sum::<f64>();
        let mut faces: Vec<([DVec3; 3], [bool; 3])> = self
            .mesh
            .faces()
            .map(|face| {
                let corners = self.mesh.face(face);
                let is_outer = [0, 1, 2].map(|k| self.is_boundary(corners[k], corners[(k + 1) % 3]));
                (corners.map(|v| seen[v.index()]), is_outer)
            })
            .collect();
        faces.sort_by(|a, b| depth(&a.0).total_cmp(&depth(&b.0)));
        for (corners, is_outer) in faces {
            let ink = Ink::both(lit(corners), colours::EDGE, EDGE);
            page.outlines(vec![corners.map(place).to_vec()], ink, None);
            let sides = (0..3).filter(|&k| is_outer[k]).map(|k| [corners[k], corners[(k + 1) % 3]].map(place).to_vec());
            page.lines(sides.collect(), Ink::stroke(colours::INK, BOUNDARY), None);
        }
    }

    /// True if the side of a face from one corner to the next is on the boundary.
    fn is_boundary(&self, tail: freebound_core::mesh::VertexId, head: freebound_core::mesh::VertexId) -> bool {
        let count = self.mesh.boundary_loop().len();
        let places = [tail, head].map(|v| self.mesh.boundary_place(v));
        matches!(places, [Some(a), Some(b)] if (a + 1) % count == b)
    }
}

/// Colour of a face, with its corners in the axes of the view.
fn lit([a, b, c]: [DVec3; 3]) -> Colour {
    let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z);
    let is_front = normal.z > 0.0;
    let light = (if is_front { normal } else { -normal }).dot(LIGHT).max(0.0);
    let brightness = if is_front { 0.72 + 0.28 * light } else { 0.55 + 0.15 * light };
    colours::FACE.map(|channel| shade(channel, brightness))
}

fn shade(channel: u8, brightness: f64) -> u8 {
    let steps = (0..=u8::MAX).take_while(|&level| f64::from(level) <= f64::from(channel) * brightness);
    steps.last().unwrap_or(0)
}
