//! Closed head of quads that looks to the front, along +z.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use freebound_core::mesh::{PolygonMesh, VertexId};

/// Head of 6 `cells`² quads: a blown-up cube, with a nose and eye sockets.
pub fn head(cells: u32) -> PolygonMesh {
    let mut numbers = BTreeMap::new();
    let mut mesh = PolygonMesh { starts: Some(vec![0]), ..PolygonMesh::default() };
    let middle = f64::from(cells) / 2.0;
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, cells)]) {
        for (a, b) in (0..cells).flat_map(|a| (0..cells).map(move |b| (a, b))) {
            let mut square = [[a, b], [a + 1, b], [a + 1, b + 1], [a, b + 1]];
            if side == 0 {
                square.reverse();
            }
            for [a, b] in square {
                let mut at = [0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, a, b);
                let number = *numbers.entry(at).or_insert_with(|| {
                    let out = DVec3::from(at.map(|x| f64::from(x) - middle)).normalize_or_zero();
                    mesh.positions.push(featured(out));
                    VertexId::from_index(mesh.positions.len() - 1)
                });
                mesh.corners.push(number);
            }
            let end = u32::try_from(mesh.corners.len()).expect("a small head");
            mesh.starts.get_or_insert_default().push(end);
        }
    }
    mesh
}

/// Position on the head of a point of the unit sphere.
fn featured(out: DVec3) -> DVec3 {
    let skull = out * DVec3::new(0.75, 1.0, 0.9);
    if out.z <= 0.0 {
        return skull;
    }
    let bump = |x: f64, y: f64, width: f64, height: f64| {
        (-((out.truncate() - DVec2::new(x, y)) / DVec2::new(width, height)).length_squared()).exp()
    };
    let eyes = bump(0.35, 0.2, 0.15, 0.1) + bump(-0.35, 0.2, 0.15, 0.1);
    skull + DVec3::Z * out.z * (0.2 * bump(0.0, -0.05, 0.14, 0.22) - 0.08 * eyes)
}
