//! Planar morphs: every frame against the rational oracle or the verdict. Also the weights between two embeddings
//! against angles, and all routes on meshes that need them.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

use freebound_core::bijective::{Morph, MorphOptions, NoMorph, Route, morph, schnyder};
use freebound_core::flatten::Flattener;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{BoundaryShape, Control, Embedding, Family, Method, Pins, Settings};
use freebound_core::verify::verdict;
use glam::DVec2;

use crate::verify::verdict_cases::nearly_planar_case;
use freebound_testkit::oracle::examine;
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, data_entry, grid, quad_sheet};

/// Residual of a solved equation, relative to the sizes of its terms.
const SOLVED: f64 = 1e-9;

fn by(mesh: &DiskMesh, ends: [&Embedding; 2], routes: &[Route]) -> Result<Morph, NoMorph> {
    let options = MorphOptions { frame_count: 17, routes: routes.to_vec() };
    morph(mesh, ends, &options, Control::unattended())
}

/// Fails if a morph has wrong ends, a wrong number of frames, or a folded frame.
fn assert_planar(mesh: &DiskMesh, ends: [&Embedding; 2], found: &Morph) {
    assert_eq!((found.frames.len(), found.frames.first(), found.frames.last()), (17, Some(ends[0]), Some(ends[1])));
    let mirrored = verdict(mesh, ends[0]).mirrored;
    for (k, frame) in found.frames.iter().enumerate() {
        let verdict = verdict(mesh, frame);
        assert!(
            verdict.is_one_to_one() && verdict.mirrored == mirrored,
            "{:?}, frame {k}: {}",
            found.route,
            verdict.summary()
        );
    }
}

/// Rings around the origin up to radius 1, each with `sectors` vertices.
fn rings(count: u32, sectors: u32) -> (DiskMesh, Embedding) {
    let on_ring = |ring: u32, k: u32| 1 + (ring - 1) * sectors + k % sectors;
    let mut triangles: Vec<[u32; 3]> = (0..sectors).map(|k| [0, on_ring(1, k), on_ring(1, k + 1)]).collect();
    for (ring, k) in (1..count).flat_map(|ring| (0..sectors).map(move |k| (ring, k))) {
        let [a, b] = [on_ring(ring, k), on_ring(ring, k + 1)];
        let [c, d] = [on_ring(ring + 1, k), on_ring(ring + 1, k + 1)];
        triangles.extend([[a, c, d], [a, d, b]]);
    }
    let place = |ring: u32, k: u32| {
        DVec2::from_angle(TAU * f64::from(k) / f64::from(sectors)) * f64::from(ring) / f64::from(count)
    };
    let around = (1..=count).flat_map(|ring| (0..sectors).map(move |k| place(ring, k)));
    let embedding: Embedding = std::iter::once(DVec2::ZERO).chain(around).collect();
    let positions = embedding.iter().map(|z| z.extend(0.0)).collect();
    (DiskMesh::try_from(TriMesh::new(positions, &triangles)).unwrap(), embedding)
}

/// Rotates the inside of a disk by an angle that grows towards the middle.
fn swirled(embedding: &Embedding, by: f64) -> Embedding {
    embedding
        .iter()
        .map(|z| if z.length() > 1.0 - 1e-12 { *z } else { DVec2::from_angle(by * (1.0 - z.length())).rotate(*z) })
        .collect()
}

/// Mean-value weights of an inner vertex from angles, normalised to sum 1.
fn weights_by_angles(mesh: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> Vec<f64> {
    let arms: Vec<DVec2> = mesh.outgoing(vertex).map(|h| embedding[mesh.head(h)] - embedding[vertex]).collect();
    let half_tangent = |k: usize| (arms[k % arms.len()].angle_to(arms[(k + 1) % arms.len()]) / 2.0).tan();
    let weight = |k: usize| (half_tangent(k + arms.len() - 1) + half_tangent(k)) / arms[k].length();
    let sum: f64 = (0..arms.len()).map(weight).sum();
    (0..arms.len()).map(|k| weight(k) / sum).collect()
}

#[test]
fn within_a_convex_boundary_frames_solve_the_mean_of_both_ends_weights_and_the_boundary_stays() {
    let (mesh, from) = rings(24, 12);
    let to = swirled(&from, 4.0);
    assert!(verdict(&mesh, &to).planar);
    for straight in [Route::Straight, Route::Turned] {
        assert_eq!(by(&mesh, [&from, &to], &[straight]), Err(NoMorph::NoWay), "straight lines go through the middle");
    }
    let found = by(&mesh, [&from, &to], &Route::ALL).unwrap();
    assert_eq!(found.route, Route::Boundary);
    assert_planar(&mesh, [&from, &to], &found);
    for (k, frame) in found.frames.iter().enumerate() {
        let t = k as f64 / 16.0;
        for vertex in mesh.vertices() {
            if mesh.boundary_place(vertex).is_some() {
                assert_eq!(frame[vertex], from[vertex]);
                continue;
            }
            let [first, second] = [&from, &to].map(|end| weights_by_angles(&mesh, end, vertex));
            let mean: DVec2 = mesh
                .outgoing(vertex)
                .zip(first.iter().zip(&second))
                .map(|(h, (a, b))| ((1.0 - t) * a + t * b) * frame[mesh.head(h)])
                .sum();
            assert!(
                mean.distance(frame[vertex]) < SOLVED,
                "{vertex} at {t}: off by {:.1e}",
                mean.distance(frame[vertex])
            );
        }
    }
}

#[test]
fn what_is_only_turned_and_scaled_is_turned_and_scaled_along() {
    let mesh = DiskMesh::try_from(grid(5, 3)).unwrap();
    let from: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    let to: Embedding = from.iter().map(|&z| DVec2::from_angle(3.0).rotate(z) * 4.0 + DVec2::new(7.0, -1.0)).collect();
    let found = by(&mesh, [&from, &to], &[Route::Turned]).unwrap();
    assert_planar(&mesh, [&from, &to], &found);
    let width = |embedding: &Embedding| embedding[VertexId::new(5)] - embedding[VertexId::new(0)];
    for (k, frame) in found.frames.iter().enumerate() {
        let t = k as f64 / 16.0;
        let expected = DVec2::from_angle(3.0 * t).rotate(width(&from)) * 4_f64.powf(t);
        assert!(width(frame).distance(expected) < 1e-12 * expected.length(), "{t}: {} and {expected}", width(frame));
    }
}

#[test]
fn a_map_and_its_half_turn_have_no_straight_way_however_few_frames_there_are() {
    let mesh = DiskMesh::try_from(grid(5, 3)).unwrap();
    let from: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    // Straight paths all meet in one point at t = 1/2.
    let to: Embedding = from.iter().map(|&z| DVec2::new(5.0, 3.0) - z).collect();
    let with = |frame_count: usize, routes: &[Route]| {
        let options = MorphOptions { frame_count, routes: routes.to_vec() };
        morph(&mesh, [&from, &to], &options, Control::unattended())
    };
    for frame_count in [2, 3, 4, 8, 9, 48] {
        assert_eq!(with(frame_count, &[Route::Straight]), Err(NoMorph::NoWay), "{frame_count} frames");
        let found = with(frame_count, &Route::ALL).unwrap();
        assert_eq!((found.route, found.frames.len()), (Route::Turned, frame_count));
        assert!(found.frames.iter().all(|frame| verdict(&mesh, frame).is_one_to_one()));
    }
}

/// Bar wound up by a number of turns: to the left if positive, to the right if negative.
fn wound(mesh: &DiskMesh, turns: f64) -> Embedding {
    let place = |p: &glam::DVec3| {
        let along = p.x / 60.0;
        let (angle, radius) = (TAU * turns * along, 10.0 - 6.0 * along);
        if turns > 0.0 {
            DVec2::from_angle(angle - PI / 2.0) * (radius - p.y)
        } else {
            DVec2::from_angle(angle + PI / 2.0) * (radius + p.y - 2.0)
        }
    };
    mesh.mesh().positions.iter().map(place).collect()
}

#[test]
fn a_spiral_is_unwound_and_wound_the_other_way_through_a_circle() {
    let mesh = DiskMesh::try_from(grid(60, 2)).unwrap();
    let [left, right] = [1.8, -1.8].map(|turns| wound(&mesh, turns));
    for end in [&left, &right] {
        assert!(verdict(&mesh, end).planar && !verdict(&mesh, end).mirrored, "{}", verdict(&mesh, end).summary());
    }
    let found = by(&mesh, [&left, &right], &Route::ALL).unwrap();
    assert_eq!(found.route, Route::Circle);
    assert_planar(&mesh, [&left, &right], &found);
    let middle = &found.frames[8];
    let places = middle.boundary(&mesh);
    let centre = places.iter().sum::<DVec2>() / places.len() as f64;
    let turns_left = |k: usize| {
        let [a, b, c] = [0, 1, 2].map(|i| places[(k + i) % places.len()]);
        (b - a).perp_dot(c - b) > 0.0
    };
    assert!((0..places.len()).all(turns_left), "around {centre} it is convex half way");
}

#[test]
fn between_boundaries_that_are_not_convex_weights_of_mesh_and_outside_serve() {
    let (mesh, round) = rings(16, 36);
    // A clover with its inside turned.
    let clover = |z: &DVec2| *z * (1.0 + 0.15 * z.length().powi(3) * (3.0 * z.to_angle()).sin());
    let from: Embedding = round.iter().map(clover).collect();
    let to: Embedding = swirled(&round, 4.0).iter().map(clover).collect();
    assert!(verdict(&mesh, &from).planar && verdict(&mesh, &to).planar);
    let found = by(&mesh, [&from, &to], &Route::ALL).unwrap();
    assert_eq!(found.route, Route::Outside);
    assert_planar(&mesh, [&from, &to], &found);
}

/// Another embedding of a mesh: a Schnyder drawing, or a uniform one on a circle.
fn other_embedding(mesh: &DiskMesh, round: usize) -> Embedding {
    if round.is_multiple_of(2) {
        return schnyder(mesh);
    }
    let settings = Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform);
    let mut last = None;
    Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    last.unwrap().candidate.solution.embedding
}

#[test]
fn between_random_planar_embeddings_there_is_a_way_through_a_circle_that_the_oracle_finds_planar() {
    let mut random = Random(51);
    let mut found_count = 0;
    for round in 0..600 {
        let case = nearly_planar_case(&mut random);
        let mesh = case.mesh();
        let planar = verdict(&mesh, &case.embedding);
        if !planar.is_one_to_one() {
            continue;
        }
        let mut other = other_embedding(&mesh, round);
        if planar.mirrored {
            other.iter_mut().for_each(|z| z.x = -z.x);
        }
        if !verdict(&mesh, &other).is_one_to_one() {
            continue;
        }
        let options = MorphOptions { frame_count: 8, routes: vec![Route::Circle] };
        let found = morph(&mesh, [&case.embedding, &other], &options, Control::unattended());
        let found = found.unwrap_or_else(|none| panic!("{none}: {case:?}, {other:?}"));
        for frame in &found.frames {
            let answer = examine(&case.triangles, frame);
            assert!(answer.injective && answer.mirrored == planar.mirrored, "{case:?}, {frame:?}");
        }
        found_count += 1;
    }
    assert!(found_count > 60, "{found_count} pairs");
}

fn last_of(mesh: &DiskMesh, settings: Settings) -> Embedding {
    let mut last = None;
    Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    last.unwrap().candidate.solution.embedding
}

fn assert_real_disks_have_a_morph_between_their_natural_boundary_and_a_circle_by_straight_lines_and_by_weights(
    disks: Vec<Entry>,
) {
    for entry in disks {
        let mesh = entry.disk();
        let natural = last_of(&mesh, Settings::new(Method::Auto, Family::Conformal));
        let circle = last_of(&mesh, Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform));
        for route in [Route::Straight, Route::Outside, Route::Circle] {
            let found =
                by(&mesh, [&natural, &circle], &[route]).unwrap_or_else(|none| panic!("{}: {none}", entry.file));
            assert_planar(&mesh, [&natural, &circle], &found);
        }
    }
}

#[test]
fn real_disks_have_a_morph_between_their_natural_boundary_and_a_circle_by_straight_lines_and_by_weights() {
    assert_real_disks_have_a_morph_between_their_natural_boundary_and_a_circle_by_straight_lines_and_by_weights(
        ["small-cap", "open-cube", "quads"].map(data_entry).into(),
    );
}

corpus_test! {
    fn real_disks_have_a_morph_between_their_natural_boundary_and_a_circle_by_straight_lines_and_by_weights_in_the_corpus()
     {
        let is_small = |entry: &Entry| entry.number("F").is_some_and(|faces| faces < 1_000);
        let small = corpus_disks().into_iter().filter(is_small);
        assert_real_disks_have_a_morph_between_their_natural_boundary_and_a_circle_by_straight_lines_and_by_weights(
            small.collect(),
        );
    }
}

#[test]
fn meshes_of_polygons_and_without_inner_vertices_have_morphs_too() {
    let mut random = Random(52);
    let sheet = DiskMesh::try_from(quad_sheet(5, 5, 0.0, &mut random).triangulate()).unwrap();
    let fan = DiskMesh::try_from(grid(7, 1)).unwrap();
    for mesh in [sheet, fan] {
        let from: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
        let to: Embedding = from.iter().map(|z| DVec2::new(z.x + 0.1 * z.y * z.y, z.y + 0.05 * z.x * z.x)).collect();
        assert!(verdict(&mesh, &to).is_one_to_one());
        for route in [Route::Straight, Route::Outside, Route::Circle] {
            let found = by(&mesh, [&from, &to], &[route]).unwrap_or_else(|none| panic!("{route:?}: {none}"));
            assert_planar(&mesh, [&from, &to], &found);
        }
    }
}

#[test]
fn mirror_images_morph_into_each_other_and_not_into_others() {
    let (mesh, from) = rings(4, 8);
    let to = swirled(&from, 0.5);
    let mirrored = |embedding: &Embedding| -> Embedding { embedding.iter().map(|z| DVec2::new(-z.x, z.y)).collect() };
    let (from_mirrored, to_mirrored) = (mirrored(&from), mirrored(&to));
    for route in Route::ALL {
        let found = by(&mesh, [&from, &to], &[route]).unwrap();
        let turned_over = by(&mesh, [&from_mirrored, &to_mirrored], &[route]).unwrap();
        assert_planar(&mesh, [&from_mirrored, &to_mirrored], &turned_over);
        assert_eq!(turned_over.frames[5], mirrored(&found.frames[5]), "{route:?}");
    }
    assert_eq!(by(&mesh, [&from, &to_mirrored], &Route::ALL), Err(NoMorph::Mirrored));
}

#[test]
fn there_is_no_morph_where_an_end_folds_or_somebody_cancels() {
    let (mesh, from) = rings(4, 8);
    let mut folded = from.clone();
    folded[VertexId::new(3)] = DVec2::new(0.0, 5.0);
    assert_eq!(by(&mesh, [&from, &folded], &Route::ALL), Err(NoMorph::EndFolds));
    assert_eq!(by(&mesh, [&folded, &from], &Route::ALL), Err(NoMorph::EndFolds));
    let cancelled = AtomicBool::new(true);
    let control = Control::new(&cancelled, &|_| {});
    let to = swirled(&from, 1.0);
    assert_eq!(morph(&mesh, [&from, &to], &MorphOptions::default(), control), Err(NoMorph::Cancelled));
}

#[test]
fn a_morph_has_the_same_bits_whatever_the_number_of_threads() {
    let (mesh, from) = rings(14, 24);
    let to = swirled(&from, 4.0);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| [Route::Boundary, Route::Circle].map(|route| by(&mesh, [&from, &to], &[route]).unwrap()))
    };
    assert_eq!(on(1), on(3));
}
