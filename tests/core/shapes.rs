//! Irregular surfaces that are hard to flatten, made by the dozen.

use std::f64::consts::TAU;

use freebound::mesh::{DiskMesh, TriMesh, VertexId};
use freebound::solver::Embedding;
use glam::DVec3;

use crate::makers::Random;

/// A disk made of the faces of a closed surface but for some.
fn disk(positions: &[DVec3], triangles: &[[u32; 3]]) -> DiskMesh {
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

/// A cube of unit sides, every side cut into `cells` × `cells` jittered squares with random diagonals, opened by taking
/// away a random square of its bottom, a third of a side wide or more.
pub(crate) fn irregular_cube(cells: u32, random: &mut Random) -> DiskMesh {
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
                            // Jitter along the surface only: no coordinate that lies on a side moves off it.
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
                    // Seen from outside, counter-clockwise.
                    triangles.extend(halves.map(|[a, b, c]| if high { [a, b, c] } else { [a, c, b] }));
                }
            }
        }
    }
    disk(&positions, &triangles)
}

/// A tube of radius 1, closed at the far end, with jittered rings of `around` vertices: a conformal map shrinks it by e
/// for every radius of its length.
pub(crate) fn finger(rings: u32, around: u32, random: &mut Random) -> DiskMesh {
    let spacing = TAU / f64::from(around);
    let mut positions = Vec::new();
    for ring in 0..rings {
        for k in 0..around {
            let mut jitter = || 0.5 * (random.unit() - 0.5);
            let angle = spacing * (f64::from(k) + jitter() + 0.5 * f64::from(ring % 2));
            let height = spacing * 0.87 * (f64::from(ring) + if ring == 0 { 0.0 } else { jitter() });
            let radius = 1.0 + 0.2 * jitter();
            positions.push(DVec3::new(radius * angle.cos(), radius * angle.sin(), height));
        }
    }
    let tip = u32::try_from(positions.len()).unwrap();
    positions.push(DVec3::new(0.0, 0.0, spacing * 0.87 * f64::from(rings)));
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for k in 0..around {
            let [a, b] = [k, (k + 1) % around].map(|k| ring * around + k);
            if ring + 1 == rings {
                triangles.push([a, b, tip]);
                continue;
            }
            let [c, d] = [k, (k + 1) % around].map(|k| (ring + 1) * around + k);
            if ring % 2 == 0 {
                triangles.extend([[a, b, c], [b, d, c]]);
            } else {
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
    disk(&positions, &triangles)
}

/// Two different interior vertices.
pub(crate) fn interior_pair(mesh: &DiskMesh, random: &mut Random) -> [VertexId; 2] {
    let inside: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect();
    let mut pick = || inside[random.below(u32::try_from(inside.len()).unwrap()) as usize];
    let first = pick();
    loop {
        let second = pick();
        if second != first {
            return [first, second];
        }
    }
}

/// Areas of the faces of an embedding, the least and the greatest.
pub(crate) fn area_range(mesh: &DiskMesh, embedding: &Embedding) -> [f64; 2] {
    let area = |face| {
        let [a, b, c] = embedding.corners(mesh, face);
        (b - a).perp_dot(c - a).abs() / 2.0
    };
    mesh.faces().map(area).fold([f64::INFINITY, 0.0], |[low, high], area| [low.min(area), high.max(area)])
}
