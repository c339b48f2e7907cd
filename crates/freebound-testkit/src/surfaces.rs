//! Surfaces that several tests share.

use glam::DVec3;

use crate::Random;
use freebound_core::mesh::{DiskMesh, PolygonMesh, TriMesh};

/// Mesh without the polygons that are left out.
pub fn without_faces(mesh: &PolygonMesh, is_left_out: impl Fn(usize) -> bool) -> PolygonMesh {
    let (mut corners, mut starts) = (Vec::new(), vec![0]);
    for face in (0..mesh.face_count()).filter(|&face| !is_left_out(face)) {
        corners.extend_from_slice(mesh.face(face));
        starts.push(u32::try_from(corners.len()).unwrap());
    }
    PolygonMesh { positions: mesh.positions.clone(), corners, starts: Some(starts) }
}

/// Cube of unit sides, every side cut into `cells` × `cells` jittered squares with random diagonals. A random square
/// of its bottom is removed, at least a third of a side wide.
pub fn irregular_cube(cells: u32, random: &mut Random) -> DiskMesh {
    let mut positions: Vec<DVec3> = Vec::new();
    let mut number = std::collections::BTreeMap::new();
    let mut triangles = Vec::new();
    let from = random.below(cells / 3 + 1);
    let to = from + cells.div_ceil(3) + random.below(cells - from - cells.div_ceil(3) + 1);
    for axis in 0..3 {
        for high in [false, true] {
            for i in 0..cells {
                for j in 0..cells {
                    if axis == 2 && !high && (from..to).contains(&i) && (from..to).contains(&j) {
                        continue;
                    }
                    let corner = |di: u32, dj: u32| {
                        let mut at = [0; 3];
                        at[axis] = if high { cells } else { 0 };
                        at[(axis + 1) % 3] = i + di;
                        at[(axis + 2) % 3] = j + dj;
                        at
                    };
                    let mut weld = |at: [u32; 3]| {
                        *number.entry(at).or_insert_with(|| {
                            // Jitter along the surface only: a coordinate on a side of the cube stays.
                            let moved = at.map(|c| {
                                let inside = c > 0 && c < cells;
                                let jitter = if inside { 0.7 * (random.unit() - 0.5) } else { 0.0 };
                                (f64::from(c) + jitter) / f64::from(cells)
                            });
                            positions.push(DVec3::from(moved));
                            u32::try_from(positions.len() - 1).unwrap()
                        })
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(&mut weld);
                    let halves = if random.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                    // Counter-clockwise, seen from outside.
                    triangles.extend(halves.map(|[a, b, c]| if high { [a, b, c] } else { [a, c, b] }));
                }
            }
        }
    }
    disk(&positions, &triangles)
}

/// A bumpy sheet of a few hundred vertices, no two edges alike.
pub fn bump(columns: u32) -> TriMesh {
    let mut random = Random(3);
    let mut mesh = crate::grid(columns, columns);
    for x in &mut mesh.positions {
        let jitter = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
        *x += 0.3 * jitter + DVec3::Z * (0.5 * x.x).sin() * (0.4 * x.y).cos() * 2.0;
    }
    mesh
}

/// Disk of these faces, without unreferenced vertices.
pub fn disk(positions: &[DVec3], triangles: &[[u32; 3]]) -> DiskMesh {
    let mut number = vec![u32::MAX; positions.len()];
    let mut used = Vec::new();
    let renumbered: Vec<[u32; 3]> = triangles
        .iter()
        .map(|t| {
            t.map(|v| {
                let held = &mut number[v as usize];
                if *held == u32::MAX {
                    *held = u32::try_from(used.len()).unwrap();
                    used.push(positions[v as usize]);
                }
                *held
            })
        })
        .collect();
    DiskMesh::try_from(TriMesh::new(used, &renumbered)).unwrap_or_else(|faults| panic!("{faults}"))
}
