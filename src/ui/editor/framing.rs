//! How much of mesh and embedding to show around a few vertices.

use glam::{DVec2, DVec3};

use crate::mesh::VertexId;
use crate::solver::Embedding;
use crate::view::{PlaneBox, Sphere};

/// Half the width of what `Request::GoTo` shows, in lengths of the element's longest edge.
const GO_TO_MARGIN: f64 = 7.0;

/// A single vertex is shown with this part of the whole around it.
const LEAST_PART: f64 = 12.0;

/// Positions of those vertices that are there.
pub(super) fn positions_of(positions: &[DVec3], vertices: &[VertexId]) -> Vec<DVec3> {
    vertices.iter().filter_map(|v| positions.get(v.index()).copied()).collect()
}

/// A ball around a few points with some of the mesh around it.
pub(super) fn grown(points: &[DVec3], all: Sphere) -> Sphere {
    let center = Sphere::around(points).center;
    // The ball of a single point has a made-up size, so the points are asked.
    let radius = points.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
    let least = all.radius / LEAST_PART;
    Sphere { center, radius: (radius * GO_TO_MARGIN).max(least).min(all.radius) }
}

/// A box around a few points of the embedding with some of it around.
pub(super) fn grown_box(embedding: &Embedding, vertices: &[VertexId], all: PlaneBox) -> PlaneBox {
    let points: Vec<DVec2> = vertices.iter().filter_map(|v| embedding.get(v.index()).copied()).collect();
    let tight = PlaneBox::around(&points);
    let reach = (tight.max - tight.min).max_element();
    let half = (reach * GO_TO_MARGIN / 2.0).max(all.extent() / LEAST_PART).min(all.extent());
    let center = tight.center();
    PlaneBox { min: center - half, max: center + half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_vertex_is_shown_from_near_by() {
        let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
        let near = grown(&[DVec3::X], all);
        assert!(near.center == DVec3::X && near.radius < 0.2 * all.radius, "{near:?}");
        let whole = PlaneBox { min: DVec2::ZERO, max: DVec2::splat(3.0) };
        let part = grown_box(&vec![DVec2::ONE].into(), &[VertexId::new(0)], whole);
        assert!(part.center() == DVec2::ONE && part.extent() < 0.2 * whole.extent(), "{part:?}");
    }

    #[test]
    fn nothing_wider_than_the_whole_is_shown() {
        let all = Sphere { center: DVec3::ZERO, radius: 2.0 };
        let shown = grown(&[DVec3::X * -2.0, DVec3::X * 2.0], all);
        assert!((shown.radius - all.radius).abs() < 1e-12, "{shown:?}");
    }
}
