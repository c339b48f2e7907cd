//! Meshes of several parts, for the tests of charts.

use freebound_core::mesh::{PolygonMesh, TriMesh, VertexId};
use glam::DVec3;

use crate::{Random, grid, honeycomb, quad_sheet};

/// Surface of squares that closes around both ways, at the positions that `place` returns.
fn wrapped(around: u32, along: u32, place: impl Fn(f64, f64) -> DVec3) -> TriMesh {
    let at = |x: u32, y: u32| (y % along) * around + x % around;
    let turn = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
    let positions = (0..around * along).map(|v| place(turn(v % around, around), turn(v / around, along))).collect();
    let squares = (0..around * along).flat_map(|k| {
        let (x, y) = (k % around, k / around);
        let square = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        [[square[0], square[1], square[2]], [square[0], square[2], square[3]]]
    });
    TriMesh::new(positions, &squares.collect::<Vec<_>>())
}

pub fn torus(around: u32, along: u32) -> TriMesh {
    wrapped(around, along, |a, b| DVec3::new((3.0 + a.cos()) * b.cos(), (3.0 + a.cos()) * b.sin(), a.sin()))
}

/// Ball of triangles between two poles.
pub fn ball(around: u32, rows: u32) -> TriMesh {
    let ring = |row: u32, x: u32| (row - 1) * around + x % around;
    let (south, north) = ((rows - 1) * around, (rows - 1) * around + 1);
    let mut positions = Vec::new();
    for (row, x) in (1..rows).flat_map(|row| (0..around).map(move |x| (row, x))) {
        let tilt = std::f64::consts::PI * f64::from(row) / f64::from(rows);
        let turn = std::f64::consts::TAU * f64::from(x) / f64::from(around);
        positions.push(DVec3::new(tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), -tilt.cos()));
    }
    positions.extend([-DVec3::Z, DVec3::Z]);
    let mut triangles = Vec::new();
    for x in 0..around {
        triangles.push([south, ring(1, x + 1), ring(1, x)]);
        triangles.push([north, ring(rows - 1, x), ring(rows - 1, x + 1)]);
        for row in 1..rows - 1 {
            let [a, b, c, d] = [ring(row, x), ring(row, x + 1), ring(row + 1, x + 1), ring(row + 1, x)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriMesh::new(positions, &triangles)
}

/// Meshes in one file, far from each other, with faces and vertices in random order.
pub fn interleaved(meshes: &[PolygonMesh], random: &mut Random) -> PolygonMesh {
    let mut positions = Vec::new();
    let mut faces: Vec<Vec<usize>> = Vec::new();
    for (number, mesh) in meshes.iter().enumerate() {
        let offset = positions.len();
        positions.extend(mesh.positions.iter().map(|p| *p + number as f64 * 100.0 * DVec3::X));
        faces.extend((0..mesh.face_count()).map(|f| mesh.face(f).iter().map(|v| offset + v.index()).collect()));
    }
    let mut number: Vec<usize> = (0..positions.len()).collect();
    shuffle(&mut number, random);
    shuffle(&mut faces, random);
    let mut placed = positions.clone();
    for (&to, &position) in number.iter().zip(&positions) {
        placed[to] = position;
    }
    let (mut corners, mut starts) = (Vec::new(), vec![0]);
    for face in &faces {
        corners.extend(face.iter().map(|&v| VertexId::from_index(number[v])));
        starts.push(u32::try_from(corners.len()).expect("few"));
    }
    PolygonMesh { positions: placed, corners, starts: Some(starts) }
}

fn shuffle<T>(list: &mut [T], random: &mut Random) {
    for last in (1..list.len()).rev() {
        list.swap(last, random.index(last + 1));
    }
}

/// Disks of triangles, quads and hexagons.
pub fn disks(random: &mut Random) -> Vec<PolygonMesh> {
    vec![
        (&grid(5, 4)).into(),
        quad_sheet(6, 4, 0.1, random),
        honeycomb(4, 3, 0.02, random),
        (&grid(1, 1)).into(),
        (&grid(9, 2)).into(),
    ]
}

/// Disks, and closed surfaces with and without handles.
pub fn surfaces(random: &mut Random) -> Vec<PolygonMesh> {
    let mut all = disks(random);
    all.extend([(&ball(8, 6)).into(), (&torus(7, 11)).into(), (&ball(5, 3)).into()]);
    all
}
