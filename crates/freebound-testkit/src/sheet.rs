//! Irregular disk meshes of any size.

use freebound_core::mesh::TriMesh;
use glam::DVec3;

use super::Random;

/// Largest move of a vertex, in cells. From a quarter on, cells could turn over.
const JITTER: f64 = 0.2;

/// A bulging, bumpy sheet with a bowed outline and about `faces` faces.
pub fn sheet_of_faces(faces: usize) -> TriMesh {
    jittered_sheet((faces as f64 / 2.0).sqrt().round() as u32)
}

/// The sheet of `cells` × `cells` cells: each vertex jittered, each cell cut by a random diagonal, so that interior
/// vertices have from 4 to 8 neighbours. Vertices are numbered row by row.
pub fn jittered_sheet(cells: u32) -> TriMesh {
    let mut random = Random(u64::from(cells));
    let stride = cells + 1;
    let mut positions = Vec::with_capacity((stride * stride) as usize);
    for row in 0..stride {
        for column in 0..stride {
            let [u, v] = [column, row].map(|step| {
                let moved = f64::from(step) + JITTER * (2.0 * random.unit() - 1.0);
                2.0 * moved / f64::from(cells) - 1.0
            });
            positions.push(on_surface(u, v));
        }
    }
    let mut triangles = Vec::with_capacity(2 * (cells * cells) as usize);
    for row in 0..cells {
        for column in 0..cells {
            let a = row * stride + column;
            let [b, c, d] = [a + 1, a + stride + 1, a + stride];
            triangles.extend(if random.bits() & 1 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    TriMesh::new(positions, &triangles)
}

/// A dome with waves a tenth of its height.
fn on_surface(u: f64, v: f64) -> DVec3 {
    let bowed = |along: f64, across: f64| along * (1.0 - 0.15 * across * across);
    let dome = 0.5 * (1.0 - 0.5 * (u * u + v * v));
    let waves = 0.05 * (7.0 * u + 1.0).sin() * (9.0 * v - 2.0).cos();
    DVec3::new(bowed(u, v), bowed(v, u), dome + waves)
}
