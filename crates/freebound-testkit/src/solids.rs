//! Closed solids whose developments are known: prisms, cones and frustums with polygonal faces.

use freebound_core::mesh::{PolygonMesh, VertexId};
use glam::DVec2;

/// Regular polygon of a radius around the origin, counter-clockwise.
pub fn regular_polygon(corners: usize, radius: f64) -> Vec<DVec2> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64;
    (0..corners).map(|k| radius * DVec2::from_angle(angle(k))).collect()
}

/// Prism over a counter-clockwise polygon: two polygons and a quad per side. A regular polygon of many corners makes a
/// cylinder with caps.
pub fn prism(base: &[DVec2], height: f64) -> PolygonMesh {
    frustum(base, base, height)
}

/// Solid between two polygons with equally many corners, at heights 0 and `height`.
pub fn frustum(base: &[DVec2], top: &[DVec2], height: f64) -> PolygonMesh {
    let count = base.len();
    let at = |height: f64| move |corner: &DVec2| [corner.x, corner.y, height];
    let positions: Vec<[f64; 3]> = base.iter().map(at(0.0)).chain(top.iter().map(at(height))).collect();
    let caps = [(0..count).rev().collect(), (count..2 * count).collect()];
    let side = |k: usize| vec![k, (k + 1) % count, count + (k + 1) % count, count + k];
    from_faces(&positions, caps.into_iter().chain((0..count).map(side)))
}

/// Cone over a counter-clockwise polygon, with its apex above the origin.
pub fn cone(base: &[DVec2], height: f64) -> PolygonMesh {
    let count = base.len();
    let apex = [0.0, 0.0, height];
    let positions: Vec<[f64; 3]> = base.iter().map(|corner| [corner.x, corner.y, 0.0]).chain([apex]).collect();
    let sides = (0..count).map(|k| vec![k, (k + 1) % count, count]);
    from_faces(&positions, std::iter::once((0..count).rev().collect()).chain(sides))
}

fn from_faces(positions: &[[f64; 3]], faces: impl Iterator<Item = Vec<usize>>) -> PolygonMesh {
    let number = |corner: usize| VertexId::from_index(corner).number();
    let faces: Vec<Vec<u32>> = faces.map(|face| face.into_iter().map(number).collect()).collect();
    PolygonMesh::from_arrays(positions, &faces.iter().map(Vec::as_slice).collect::<Vec<_>>())
}
