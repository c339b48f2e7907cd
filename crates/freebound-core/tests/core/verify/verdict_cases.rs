//! Small disks and their maps into the plane, for the tests of the verdict.

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::Embedding;
use glam::{DVec2, DVec3};

use freebound_testkit::Random;

/// Random integer in `low..=high`.
fn integer(random: &mut Random, low: i32, high: i32) -> i32 {
    low + i32::try_from(random.below(high.abs_diff(low) + 1)).expect("a small range")
}

/// Point with integer coordinates from 0 to `size`.
fn grid_point(random: &mut Random, size: i32) -> DVec2 {
    DVec2::new(f64::from(integer(random, 0, size)), f64::from(integer(random, 0, size)))
}

/// Map of a disk into the plane.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) embedding: Embedding,
}

impl Case {
    /// Disk in space. Its shape is arbitrary, but no three vertices are collinear.
    pub(crate) fn mesh(&self) -> DiskMesh {
        let on_a_curve = |i: usize| DVec3::new(i as f64, (i * i) as f64, (i * i * i) as f64);
        let positions = (0..self.embedding.len()).map(on_a_curve).collect();
        DiskMesh::try_from(TriMesh::new(positions, &self.triangles)).expect("the cases are disks")
    }
}

/// Fan of vertex 0 in the middle of the given link.
pub(crate) fn fan(middle: DVec2, link: &[DVec2]) -> Case {
    let count = u32::try_from(link.len()).expect("few vertices");
    let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
    Case { triangles, embedding: std::iter::once(middle).chain(link.iter().copied()).collect() }
}

/// Strip of triangles between two rows of vertices, even numbers below, odd ones above.
pub(crate) fn strip(embedding: Embedding) -> Case {
    let last = u32::try_from(embedding.len()).expect("few vertices") - 2;
    let triangles = (0..last).map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] }).collect();
    Case { triangles, embedding }
}

/// Random triangulation of a polygon without new vertices.
fn triangulated(random: &mut Random, corner_count: u32) -> Vec<[u32; 3]> {
    let mut corners: Vec<u32> = (0..corner_count).collect();
    let mut triangles = Vec::new();
    while corners.len() > 2 {
        let i = random.index(corners.len());
        let (before, after) = ((i + corners.len() - 1) % corners.len(), (i + 1) % corners.len());
        triangles.push([corners[before], corners[i], corners[after]]);
        corners.remove(i);
    }
    triangles
}

/// Flips some interior edges.
fn turn_edges(random: &mut Random, triangles: &mut [[u32; 3]]) {
    for _ in 0..4 {
        let (face, other) = (random.index(triangles.len()), random.index(triangles.len()));
        let turn = random.index(3);
        triangles[face].rotate_left(turn);
        let [tail, head, apex] = triangles[face];
        let from_head = |k: usize| triangles[other][k] == head && triangles[other][(k + 1) % 3] == tail;
        let Some(corner) = (0..3).find(|&k| from_head(k)) else { continue };
        let far = triangles[other][(corner + 2) % 3];
        let joined = triangles.iter().any(|t| t.contains(&apex) && t.contains(&far));
        if !joined {
            triangles[face] = [apex, far, head];
            triangles[other] = [far, apex, tail];
        }
    }
}

/// Random disk with a convex embedding and some inner vertices.
fn convex(random: &mut Random) -> Case {
    let corner_count = integer(random, 3, 6);
    let mut triangles = triangulated(random, corner_count.unsigned_abs());
    let turn = random.unit();
    let corner = |i: i32| {
        let angle = std::f64::consts::TAU * (f64::from(i) + turn) / f64::from(corner_count);
        DVec2::new(4.0 * angle.cos(), 3.0 * angle.sin())
    };
    let mut embedding: Vec<DVec2> = (0..corner_count).map(corner).collect();
    for _ in 0..random.index(3) {
        let inserted = u32::try_from(embedding.len()).expect("few vertices");
        let face = random.index(triangles.len());
        let [a, b, c] = triangles[face];
        let shares = [0, 1, 2].map(|_| 0.1 + random.unit());
        let sum: DVec2 = (0..3).map(|k| embedding[triangles[face][k] as usize] * shares[k]).sum();
        embedding.push(sum / shares.iter().sum::<f64>());
        triangles[face] = [a, b, inserted];
        triangles.extend([[b, c, inserted], [c, a, inserted]]);
    }
    Case { triangles, embedding: embedding.into() }
}

/// Fan whose link goes around once or twice, sometimes folded.
fn star(random: &mut Random) -> Case {
    let turns = integer(random, 1, 2);
    let count = integer(random, 3 * turns, 4 + 2 * turns);
    let spoke = |i: i32| {
        let angle = std::f64::consts::TAU * f64::from(turns * i) / f64::from(count);
        DVec2::from_angle(angle) * (1.0 + 3.0 * random.unit())
    };
    fan(DVec2::ZERO, &(0..count).map(spoke).collect::<Vec<_>>())
}

/// Random disk on integer coordinates: almost never one-to-one, often degenerate.
pub(crate) fn grid_case(random: &mut Random) -> Case {
    let size = integer(random, 1, 6);
    let mut case = match random.index(3) {
        0 => star(random),
        1 => {
            let count = random.index(4) + 3;
            strip(vec![DVec2::ZERO; count].into())
        }
        _ => {
            let mut case = convex(random);
            turn_edges(random, &mut case.triangles);
            case
        }
    };
    case.embedding.fill_with(|| grid_point(random, size));
    case
}

/// Disk embedded one-to-one, or nearly: some vertices moved, the whole sometimes mirrored.
pub(crate) fn nearly_planar_case(random: &mut Random) -> Case {
    let mut case = match random.index(3) {
        0 => star(random),
        1 => {
            let count = integer(random, 3, 7);
            strip((0..count).map(|i| DVec2::new(f64::from(i - i % 2), f64::from(3 * (i % 2)))).collect())
        }
        _ => convex(random),
    };
    if random.index(2) == 0 {
        // Integer coordinates turn nearly degenerate cases into degenerate ones.
        case.embedding.iter_mut().for_each(|p| *p = (*p * 2.0).round());
    }
    for _ in 0..random.index(3) {
        let moved = random.index(case.embedding.len());
        case.embedding[moved] = grid_point(random, 8) - DVec2::splat(4.0);
    }
    if random.index(4) == 0 {
        case.embedding.iter_mut().for_each(|p| p.x = -p.x);
    }
    case
}

/// Moves every coordinate by a few units in its last place.
pub(crate) fn nudge(random: &mut Random, embedding: &mut Embedding) {
    for point in embedding.iter_mut() {
        for coordinate in [&mut point.x, &mut point.y] {
            for _ in 0..random.index(3) {
                *coordinate = if random.index(2) == 0 { coordinate.next_up() } else { coordinate.next_down() };
            }
        }
    }
}
