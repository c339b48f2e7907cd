//! Meshes of polygons with more than three corners, gentle to rough.

use freebound_core::mesh::{PolygonMesh, VertexId};
use glam::DVec3;

use super::Random;

/// Sheet of `columns` × `rows` unit quads, bent up in its middle, its vertices jittered by at most `roughness`.
pub fn quad_sheet(columns: u32, rows: u32, roughness: f64, random: &mut Random) -> PolygonMesh {
    let stride = columns + 1;
    let at = |x: u32, y: u32| [f64::from(x), f64::from(y)];
    let places = (0..=rows).flat_map(|y| (0..=columns).map(move |x| at(x, y))).collect();
    let faces = (0..rows * columns).map(|k| {
        let v = k / columns * stride + k % columns;
        vec![v, v + 1, v + stride + 1, v + stride]
    });
    polygon_mesh(places, faces, [f64::from(columns), f64::from(rows)], roughness, random)
}

/// Sheet of hexagons in a honeycomb, with a bend and a jitter like [`quad_sheet`].
pub fn honeycomb(columns: u32, rows: u32, roughness: f64, random: &mut Random) -> PolygonMesh {
    // Rows of zigzags: a cell has three vertices of the zigzag below it and three of the zigzag above it.
    let stride = 2 * columns + 2;
    let place = |x: u32, y: u32| {
        let up = if (x + y).is_multiple_of(2) { 0.0 } else { 1.0 / 3.0 };
        [f64::from(x) / 2.0, f64::from(y) + up]
    };
    let places = (0..=rows).flat_map(|y| (0..stride).map(move |x| place(x, y))).collect();
    let faces = (0..rows * columns).map(|k| {
        let (x, y) = (k % columns, k / columns);
        // The cell stands where the zigzag below has its low point in the middle.
        let v = y * stride + 2 * x + u32::from(y.is_multiple_of(2));
        vec![v, v + 1, v + 2, v + 2 + stride, v + 1 + stride, v + stride]
    });
    polygon_mesh(places, faces, [f64::from(columns), f64::from(rows)], roughness, random)
}

fn polygon_mesh(
    places: Vec<[f64; 2]>,
    faces: impl Iterator<Item = Vec<u32>>,
    size: [f64; 2],
    roughness: f64,
    random: &mut Random,
) -> PolygonMesh {
    let mut jitter = || roughness * random.between(-1.0, 1.0);
    let position = |[x, y]: [f64; 2]| {
        let bend = 8.0 * x * (size[0] - x) * y * (size[1] - y) / (size[0] * size[1]).powf(1.5);
        DVec3::new(x + jitter(), y + jitter(), bend + jitter())
    };
    let positions: Vec<DVec3> = places.into_iter().map(position).collect();
    let (mut corners, mut starts) = (Vec::new(), vec![0]);
    for face in faces {
        corners.extend(face);
        starts.push(u32::try_from(corners.len()).expect("a small mesh"));
    }
    keep_used(&positions, &corners, starts)
}

/// Mesh without the vertices that no polygon has.
fn keep_used(positions: &[DVec3], corners: &[u32], starts: Vec<u32>) -> PolygonMesh {
    let mut used = corners.to_vec();
    used.sort_unstable();
    used.dedup();
    let number = |corner: &u32| VertexId::from_index(used.binary_search(corner).expect("a corner is used"));
    PolygonMesh {
        corners: corners.iter().map(number).collect(),
        positions: used.iter().map(|&v| positions[v as usize]).collect(),
        starts: Some(starts),
    }
}
