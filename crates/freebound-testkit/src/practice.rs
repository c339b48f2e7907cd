//! Meshes of the tutorials that are no disks: a closed ball, a scan with holes and faults, a table of five boxes.

use std::collections::BTreeMap;

use freebound_core::mesh::{PolygonMesh, TriMesh, VertexId};
use glam::{DVec2, DVec3};

use super::caps::bumps;
use super::face::face;
use super::surfaces::without_faces;

/// Quads along a side of the cube that becomes the ball.
const BALL_CELLS: u32 = 14;

/// Centres of the holes of the scan, by x and y, and their radii.
const HOLES: [([f64; 2], f64); 3] = [([0.45, 0.55], 0.12), ([-0.5, -0.2], 0.1), ([0.1, -0.75], 0.08)];

/// Low and high corners of the boxes of the table: the top and four legs.
const BOXES: [[[f64; 3]; 2]; 5] = [
    [[-1.0, 0.7, -0.6], [1.0, 0.8, 0.6]],
    [[-0.95, 0.0, -0.55], [-0.85, 0.7, -0.45]],
    [[0.85, 0.0, -0.55], [0.95, 0.7, -0.45]],
    [[-0.95, 0.0, 0.45], [-0.85, 0.7, 0.55]],
    [[0.85, 0.0, 0.45], [0.95, 0.7, 0.55]],
];

/// A closed ball with bumps, of quads.
pub fn bumpy_ball() -> PolygonMesh {
    let mut numbers = BTreeMap::new();
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let middle = f64::from(BALL_CELLS) / 2.0;
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, BALL_CELLS)]) {
        for (a, b) in (0..BALL_CELLS).flat_map(|a| (0..BALL_CELLS).map(move |b| (a, b))) {
            let mut square = [[a, b], [a + 1, b], [a + 1, b + 1], [a, b + 1]];
            if side == 0 {
                square.reverse();
            }
            faces.push(square.map(|[a, b]| {
                let mut at = [0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, a, b);
                *numbers.entry(at).or_insert_with(|| {
                    let out = DVec3::from(at.map(|x| f64::from(x) - middle)).normalize_or_zero();
                    positions.push((out * bumps(out)).to_array());
                    u32::try_from(positions.len() - 1).expect("a small ball")
                })
            }));
        }
    }
    PolygonMesh::from_arrays(&positions, &faces)
}

/// The face with three holes, a duplicate face and unreferenced vertices.
pub fn scan() -> PolygonMesh {
    let TriMesh { positions, triangles, .. } = face();
    let mut mesh = PolygonMesh { positions, corners: triangles.into_iter().flatten().collect(), starts: None };
    let is_in_hole = |face: usize| {
        let middle =
            mesh.face(face).iter().map(|v: &VertexId| mesh.positions[v.index()].truncate()).sum::<DVec2>() / 3.0;
        HOLES.iter().any(|&(centre, radius)| middle.distance(centre.into()) < radius)
    };
    mesh = without_faces(&mesh, is_in_hole);
    let again: Vec<VertexId> = mesh.face(0).to_vec();
    mesh.corners.extend(again);
    mesh.starts.get_or_insert_default().push(u32::try_from(mesh.corners.len()).expect("a small scan"));
    mesh.positions.push(DVec3::new(0.0, 0.0, 3.0));
    mesh
}

/// A table: five closed boxes that do not touch in a vertex.
pub fn table() -> PolygonMesh {
    const SIDES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for corners in BOXES {
        let first = u32::try_from(positions.len()).expect("a small table");
        positions.extend((0..8_usize).map(|v| [0, 1, 2].map(|axis| corners[v >> axis & 1][axis])));
        faces.extend(SIDES.map(|side| side.map(|v| first + v)));
    }
    PolygonMesh::from_arrays(&positions, &faces)
}
