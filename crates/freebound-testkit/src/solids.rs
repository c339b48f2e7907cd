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

/// Tube over a counter-clockwise polygon, with a bottom and without a top.
pub fn open_tube(base: &[DVec2], height: f64) -> PolygonMesh {
    let solid = prism(base, height);
    let positions: Vec<[f64; 3]> = solid.positions.iter().map(glam::DVec3::to_array).collect();
    // The second face is the top.
    let faces = (0..solid.face_count()).filter(|&face| face != 1);
    from_faces(&positions, faces.map(|face| solid.face(face).iter().map(|vertex| vertex.index()).collect()))
}

/// Plate with a row of square holes, of unit squares on both sides: each hole is one square, and one square lies around
/// and between the holes. Its genus is the number of holes.
pub fn plate_with_holes(holes: usize, thickness: f64) -> PolygonMesh {
    let (columns, rows) = (2 * holes + 1, 3);
    let is_solid = |i: usize, j: usize| i < columns && j < rows && !(j == 1 && i % 2 == 1);
    let at = |i: usize, j: usize, layer: usize| (layer * (rows + 1) + j) * (columns + 1) + i;
    let mut positions = Vec::new();
    for (layer, j) in (0..2_usize).flat_map(|layer| (0..=rows).map(move |j| (layer, j))) {
        positions.extend((0..=columns).map(|i| [i as f64, j as f64, thickness * layer as f64]));
    }
    let mut faces = Vec::new();
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))).filter(|&(i, j)| is_solid(i, j)) {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        faces.push(corners.iter().map(|&(i, j)| at(i, j, 1)).collect());
        faces.push(corners.iter().rev().map(|&(i, j)| at(i, j, 0)).collect());
        let beside = [(i, j.wrapping_sub(1)), (i + 1, j), (i, j + 1), (i.wrapping_sub(1), j)];
        for side in (0..4).filter(|&side| !is_solid(beside[side].0, beside[side].1)) {
            let [(i, j), (k, l)] = [corners[side], corners[(side + 1) % 4]];
            faces.push(vec![at(i, j, 0), at(k, l, 0), at(k, l, 1), at(i, j, 1)]);
        }
    }
    from_faces(&positions, faces.into_iter())
}

fn from_faces(positions: &[[f64; 3]], faces: impl Iterator<Item = Vec<usize>>) -> PolygonMesh {
    let number = |corner: usize| VertexId::from_index(corner).number();
    let faces: Vec<Vec<u32>> = faces.map(|face| face.into_iter().map(number).collect()).collect();
    PolygonMesh::from_arrays(positions, &faces.iter().map(Vec::as_slice).collect::<Vec<_>>())
}
