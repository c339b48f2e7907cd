//! Disks whose inside is many rings away from a small boundary. Linear embeddings shrink the inside beyond all
//! digits.

use freebound_core::mesh::{TriMesh, VertexId};
use glam::DVec3;

use super::Random;
use super::plain::fan;

/// Triangle with vertices inserted one by one, each into an existing face, until there are `count` vertices. Only the
/// `newest` faces are candidates: the fewer, the deeper.
pub fn stacked(count: usize, newest: usize, random: &mut Random) -> TriMesh {
    let mut positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut triangles = vec![[0_u32, 1, 2]];
    while positions.len() < count {
        let first = triangles.len().saturating_sub(newest);
        let face = first + random.index(triangles.len() - first);
        let [a, b, c] = triangles[face];
        let top = u32::try_from(positions.len()).expect("a vertex fits");
        // Around an axis, so that no three vertices are collinear, however deep they are.
        positions.push(DVec3::new((2.4 * f64::from(top)).cos(), (2.4 * f64::from(top)).sin(), 0.1 * f64::from(top)));
        triangles[face] = [a, b, top];
        triangles.extend([[b, c, top], [c, a, top]]);
    }
    TriMesh::new(positions, &triangles)
}

/// Tube of `around` × `along` squares, open below, closed above by a point. Each row is as high as its squares are
/// wide.
pub fn tube(around: u32, along: u32) -> TriMesh {
    let step = std::f64::consts::TAU / f64::from(around);
    let mut positions = Vec::new();
    for row in 0..=along {
        positions.extend((0..around).map(|k| {
            let angle = step * f64::from(k);
            DVec3::new(angle.cos(), angle.sin(), step * f64::from(row))
        }));
    }
    let at = |k: u32, row: u32| row * around + k % around;
    let mut triangles = Vec::new();
    for row in 0..along {
        for k in 0..around {
            triangles.push([at(k, row), at(k + 1, row), at(k + 1, row + 1)]);
            triangles.push([at(k, row), at(k + 1, row + 1), at(k, row + 1)]);
        }
    }
    let top = u32::try_from(positions.len()).expect("a vertex fits");
    positions.push(DVec3::new(0.0, 0.0, step * (f64::from(along) + 0.5)));
    triangles.extend((0..around).map(|k| [at(k, along), at(k + 1, along), top]));
    TriMesh::new(positions, &triangles)
}

/// Palm of ten faces around a vertex. Every other face is drawn out to a finger of `joints` triangular rings.
pub fn hand(joints: u32) -> TriMesh {
    let mut mesh = fan(10);
    let mut triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(VertexId::number)).collect();
    for finger in 0..5 {
        for _ in 0..joints {
            let [a, b, c] = triangles[2 * finger];
            let base = u32::try_from(mesh.positions.len()).expect("a vertex fits");
            let [d, e, f] = [base, base + 1, base + 2];
            mesh.positions.extend([a, b, c].map(|v| mesh.positions[v as usize] + 0.3 * DVec3::Z));
            triangles[2 * finger] = [d, e, f];
            triangles.extend([[a, b, e], [a, e, d], [b, c, f], [b, f, e], [c, a, d], [c, d, f]]);
        }
    }
    TriMesh::new(mesh.positions, &triangles)
}
