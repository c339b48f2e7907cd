//! Random planar meshes that are not convex, laid into space for tests of reproduction.

use std::f64::consts::TAU;

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::Embedding;
use glam::{DMat3, DQuat, DVec2, DVec3};

use freebound_testkit::Random;

/// Planar mesh: its positions in the plane, and its image in space under a similarity.
pub(crate) struct Flat {
    pub(crate) name: String,
    pub(crate) plane: Embedding,
    pub(crate) mesh: DiskMesh,
}

impl Flat {
    /// Lays a planar mesh into a random plane of space, scaled and shifted.
    fn laid_out(name: String, plane: Embedding, triangles: &[[u32; 3]], random: &mut Random) -> Self {
        let turn = DQuat::from_axis_angle(direction(random), TAU * random.unit());
        let size = 10_f64.powf(4.0 * random.unit() - 2.0);
        let shift = direction(random) * size * 3.0;
        let frame = DMat3::from_quat(turn) * size;
        let positions = plane.iter().map(|p| frame * p.extend(0.0) + shift).collect();
        let mesh = TriMesh::new(positions, triangles);
        let mesh = DiskMesh::try_from(mesh).unwrap_or_else(|faults| panic!("{name}: {faults}"));
        Self { name, plane, mesh }
    }

    /// Meshes of three kinds, different for every seed.
    pub(crate) fn of_seed(seed: u64) -> [Self; 3] {
        let mut random = Random(seed);
        [notched_grid(&mut random), comb(&mut random, 3), blob(&mut random)]
    }

    /// Long thin meshes: a change at one end hardly affects the other.
    pub(crate) fn strips_of_seed(seed: u64) -> [Self; 2] {
        let mut random = Random(seed);
        [comb(&mut random, 16), spiral(&mut random)]
    }
}

/// Uniformly random direction.
fn direction(random: &mut Random) -> DVec3 {
    let z = 2.0 * random.unit() - 1.0;
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
}

/// Grid of the squares for which `keep` returns true, with vertices moved at random and random diagonals.
fn jittered(size: [u32; 2], keep: impl Fn(u32, u32) -> bool, random: &mut Random) -> (Embedding, Vec<[u32; 3]>) {
    let [columns, rows] = size;
    let mut number = vec![None; ((columns + 1) * (rows + 1)) as usize];
    let (mut plane, mut triangles) = (Vec::new(), Vec::new());
    for y in 0..rows {
        for x in (0..columns).filter(|&x| keep(x, y)) {
            let mut vertex = |x: u32, y: u32| {
                *number[(y * (columns + 1) + x) as usize].get_or_insert_with(|| {
                    let jitter = DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * 0.4;
                    plane.push(DVec2::new(f64::from(x), f64::from(y)) + jitter);
                    u32::try_from(plane.len() - 1).expect("well-formed by construction")
                })
            };
            let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            let squares = [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]];
            triangles.extend(squares[random.below(2) as usize]);
        }
    }
    (plane.into(), triangles)
}

/// Grid with a rectangular notch in its upper side.
fn notched_grid(random: &mut Random) -> Flat {
    let [columns, rows] = [8 + random.below(4), 5 + random.below(3)];
    let (left, bottom) = (2 + random.below(2), 2 + random.below(2));
    let (plane, triangles) = jittered([columns, rows], |x, y| !(y >= bottom && (left..left + 3).contains(&x)), random);
    Flat::laid_out(format!("grid {columns}×{rows} with a notch"), plane, &triangles, random)
}

/// Comb with teeth two squares wide, of this length, on a back of equal width.
fn comb(random: &mut Random, length: u32) -> Flat {
    let teeth = 2 + random.below(3);
    let (plane, triangles) = jittered([4 * teeth - 2, 2 + length], |x, y| y < 2 || x % 4 < 2, random);
    Flat::laid_out(format!("comb of {teeth} teeth of {length}"), plane, &triangles, random)
}

/// Rings around a centre, with a wavy rim.
fn blob(random: &mut Random) -> Flat {
    let (rings, sectors) = (5, 24 + random.below(12));
    let (lobes, depth) = (3 + random.below(3), 0.3 + 0.2 * random.unit());
    let turn = f64::from(sectors) / TAU;
    // On rays, so that every triangle between two rings is positive however steep the wave.
    let angles: Vec<f64> = (0..sectors).map(|sector| (f64::from(sector) + 0.5 * random.unit()) / turn).collect();
    let mut plane = vec![DVec2::ZERO];
    for ring in 1..=rings {
        for &angle in &angles {
            let wave = 1.0 + depth * (f64::from(lobes) * angle).sin();
            let radius = (f64::from(ring) + 0.3 * random.unit()) * wave;
            plane.push(DVec2::from_angle(angle) * radius);
        }
    }
    let at = |ring: u32, sector: u32| 1 + (ring - 1) * sectors + sector % sectors;
    let mut triangles: Vec<[u32; 3]> = (0..sectors).map(|s| [0, at(1, s), at(1, s + 1)]).collect();
    for ring in 1..rings {
        for s in 0..sectors {
            let [a, b, c, d] = [at(ring, s), at(ring + 1, s), at(ring + 1, s + 1), at(ring, s + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Flat::laid_out(format!("blob of {lobes} lobes"), plane.into(), &triangles, random)
}

/// Strip wound up nearly one and a half times.
fn spiral(random: &mut Random) -> Flat {
    let (length, width) = (60, 4);
    let (mut plane, triangles) = jittered([length, width], |_, _| true, random);
    for p in plane.iter_mut() {
        let angle = p.x / f64::from(length) * 1.4 * TAU;
        // Increasing x runs counter-clockwise and increasing y inwards, so faces keep their orientation.
        *p = DVec2::from_angle(angle) * (10.0 + 1.1 * angle - p.y);
    }
    Flat::laid_out("spiral".to_owned(), plane, &triangles, random)
}
