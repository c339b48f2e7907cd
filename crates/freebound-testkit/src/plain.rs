//! Small meshes with known numbers.

use std::path::Path;

use std::collections::BTreeMap;

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_io::MeshFile;
use glam::DVec3;

/// A flat grid of `columns` × `rows` unit squares, each cut along the diagonal from its lower left corner.
pub fn grid(columns: u32, rows: u32) -> TriMesh {
    let stride = columns + 1;
    let mut positions = Vec::new();
    for y in 0..=rows {
        positions.extend((0..=columns).map(|x| DVec3::new(f64::from(x), f64::from(y), 0.0)));
    }
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            let v = y * stride + x;
            triangles.push([v, v + 1, v + stride + 1]);
            triangles.push([v, v + stride + 1, v + stride]);
        }
    }
    TriMesh::new(positions, &triangles)
}

/// A flat strip of unit squares rolled up in square turns, with a gap of one square between them. `sides` is the number
/// of straight parts.
pub fn rolled_strip(sides: u32) -> TriMesh {
    let mut cells = vec![[0_i32, 0]];
    let ways = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    for side in 0..sides {
        let [x, y] = ways[side as usize % 4];
        for _ in 0..2 + side / 2 * 2 {
            let [from_x, from_y] = cells[cells.len() - 1];
            cells.push([from_x + x, from_y + y]);
        }
    }
    let (mut positions, mut triangles, mut numbers) = (Vec::new(), Vec::new(), BTreeMap::new());
    for [x, y] in cells {
        let [a, b, c, d] = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|[x, y]| {
            *numbers.entry([x, y]).or_insert_with(|| {
                positions.push(DVec3::new(f64::from(x), f64::from(y), 0.0));
                u32::try_from(positions.len() - 1).expect("vertices fit")
            })
        });
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    TriMesh::new(positions, &triangles)
}

/// Grid with its vertices moved, each from its x and y.
pub fn shaped(columns: u32, rows: u32, place: impl Fn(f64, f64) -> DVec3) -> TriMesh {
    let mut mesh = grid(columns, rows);
    for p in &mut mesh.positions {
        *p = place(p.x, p.y);
    }
    mesh
}

/// The grid of `side` × `side` squares on the unit square, bent up by `height` in its middle; flat for 0.
pub fn sheet(side: u32, height: f64) -> TriMesh {
    shaped(side, side, |x, y| {
        let [x, y] = [x, y].map(|k| k / f64::from(side));
        DVec3::new(x, y, height * 16.0 * x * (1.0 - x) * y * (1.0 - y))
    })
}

/// Flat sheet of 8 × 8 squares with a thin tower, which no map without cuts flattens without shrinking it.
pub fn tower() -> TriMesh {
    shaped(8, 8, |x, y| {
        let is_on_top = [x, y].iter().all(|k| (3.0..=5.0).contains(k));
        DVec3::new(x / 8.0, y / 8.0, if is_on_top { 2000.0 } else { 0.0 })
    })
}

/// A closed fan: vertex 0 in the middle of a regular polygon with `sides` corners.
pub fn fan(sides: u32) -> TriMesh {
    let on_rim = |k| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let positions = std::iter::once(DVec3::ZERO).chain((0..sides).map(on_rim)).collect();
    let triangles: Vec<[u32; 3]> = (0..sides).map(|k| [0, 1 + k, 1 + (k + 1) % sides]).collect();
    TriMesh::new(positions, &triangles)
}

/// A tetrahedron, closed, its faces counter-clockwise seen from outside.
pub fn tetrahedron() -> TriMesh {
    let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(DVec3::from).to_vec();
    TriMesh::new(positions, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
}

/// Band of squares around a ring of `length`, closed straight or twisted.
pub fn band(length: u32, twisted: u32) -> TriMesh {
    let at = |k: u32, side: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(length);
        let tilt = angle / 2.0 * f64::from(twisted);
        let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
        out * 3.0 + (out * tilt.cos() + DVec3::Z * tilt.sin()) * (f64::from(side) - 0.5)
    };
    let positions = (0..length).flat_map(|k| [at(k, 0), at(k, 1)]).collect();
    let squares = (0..length).flat_map(|k| {
        let [a, b] = [2 * k, 2 * k + 1];
        let [mut c, mut d] = [2 * ((k + 1) % length), 2 * ((k + 1) % length) + 1];
        if k + 1 == length && twisted == 1 {
            std::mem::swap(&mut c, &mut d);
        }
        [[a, b, d], [a, d, c]]
    });
    TriMesh::new(positions, &squares.collect::<Vec<_>>())
}

/// Disk of a mesh that is known to be one.
pub fn disk(mesh: TriMesh) -> DiskMesh {
    DiskMesh::try_from(mesh).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Writes a mesh to a file, with all digits.
pub fn write_obj(path: &Path, mesh: &TriMesh) {
    let mut text = Vec::new();
    freebound_io::write_obj(&mut text, &MeshFile::from(mesh), &freebound_io::Texture::default())
        .expect("memory takes it");
    std::fs::write(path, text).expect("a folder for files");
}
