//! How much of mesh and embedding to show around a few vertices.

use glam::{DVec2, DVec3};

use crate::mesh::VertexId;
use crate::view::{PlaneBox, Sphere};

/// Half the width of what `Request::GoTo` shows, in lengths of the element's longest edge.
const GO_TO_MARGIN: f64 = 7.0;

/// Positions of those vertices that are there.
pub(super) fn positions_of(positions: &[DVec3], vertices: &[VertexId]) -> Vec<DVec3> {
    vertices.iter().filter_map(|v| positions.get(v.index()).copied()).collect()
}

/// A ball around a few points with some of the mesh around it.
pub(super) fn grown(points: &[DVec3], all: Sphere) -> Sphere {
    let tight = Sphere::around(points);
    let least = all.radius / 40.0;
    Sphere { center: tight.center, radius: (tight.radius * GO_TO_MARGIN).max(least).min(all.radius) }
}

/// A box around a few points of the embedding with some of it around.
pub(super) fn grown_box(embedding: &[DVec2], vertices: &[VertexId], all: PlaneBox) -> PlaneBox {
    let points: Vec<DVec2> = vertices.iter().filter_map(|v| embedding.get(v.index()).copied()).collect();
    let tight = PlaneBox::around(&points);
    let half = (tight.extent() * GO_TO_MARGIN / 2.0).max(all.extent() / 80.0).min(all.extent());
    let center = tight.center();
    PlaneBox { min: center - half, max: center + half }
}
