//! Sides of a seam. At a cut a vertex of the file has several copies, one on each side, and each copy can be pinned.

use std::fmt;

use glam::DVec3;

use super::scene::MeshScene;
use crate::view::Ray;
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};

/// Side of a seam, named by a vertex of the file and a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) struct Side {
    of_file: VertexId,
    /// First face of the file at the copy of the vertex.
    face: u32,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of the file, on a seam, at the side of face {}", self.of_file, self.face)
    }
}

impl MeshScene {
    /// Side of a vertex, if the mesh is cut there.
    pub(in crate::ui) fn side_of(&self, vertex: VertexId) -> Option<Side> {
        let of_file = self.in_file.vertex(vertex).filter(|of| self.in_file.is_several(*of))?;
        Some(Side { of_file, face: faces_at(self.disk()?, vertex).map(|face| self.mesh().polygon(face)).min()? })
    }

    /// Copy of a vertex on the side of the seam that a ray meets. Returns the vertex itself if there is no cut.
    pub(in crate::ui) fn on_side_at(&self, vertex: VertexId, ray: Ray) -> VertexId {
        let of_file = self.in_file.vertex(vertex);
        let copies: Vec<VertexId> = of_file.into_iter().flat_map(|of| self.in_file.copies(of)).collect();
        let Some(disk) = self.disk().filter(|_| copies.len() > 1) else { return vertex };
        let positions = &self.mesh().positions;
        // If the ray misses the mesh: the point of the ray nearest to the vertex.
        let along = (positions[vertex.index()] - ray.origin).dot(ray.direction);
        let met = self.picker.hit(ray).map_or_else(|| ray.at(along), |hit| hit.point);
        let distance = |copy: &VertexId| {
            let corners = faces_at(disk, *copy).map(|face| disk.face(face).map(|corner| positions[corner.index()]));
            corners.map(|corners| distance_to(corners, met)).fold(f64::INFINITY, f64::min)
        };
        copies.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(vertex)
    }
}

/// Faces at a vertex, except those that fill holes.
fn faces_at(disk: &DiskMesh, vertex: VertexId) -> impl Iterator<Item = FaceId> + '_ {
    let faces = disk.outgoing(vertex).filter_map(|halfedge| disk.face_of(halfedge));
    faces.filter(|&face| !disk.is_virtual(face))
}

/// Distance of a point from a triangle.
fn distance_to(corners: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) && normal != DVec3::ZERO {
        return ((point - a).dot(normal) / normal.length()).abs();
    }
    let from_side = |from: DVec3, to: DVec3| {
        let side = to - from;
        let share = ((point - from).dot(side) / side.length_squared()).clamp(0.0, 1.0);
        point.distance(from + side * if share.is_finite() { share } else { 0.0 })
    };
    from_side(a, b).min(from_side(b, c)).min(from_side(c, a))
}
