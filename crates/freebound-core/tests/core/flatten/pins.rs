//! Pins: met exactly, completed if there are too few, refused if impossible.

#![allow(clippy::float_cmp, reason = "the unit square is filled bit for bit")]

use std::f64::consts::TAU;

use freebound_core::flatten::{solve_once, to_true_area, to_unit_square};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, NamedOption as _, Pins, Settings, SolveError, farthest_pair,
    gauge_pins, hard_pins,
};
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};

use crate::weights::families::free_methods;
use freebound_testkit::{Random, corpus_disks, corpus_test, data_disks, disk, fan, grid};

fn dome() -> DiskMesh {
    disk(BuiltIn::Dome.mesh())
}

fn pins(list: &[(u32, [f64; 2])]) -> Pins {
    hard_pins(list.iter().map(|&(v, place)| (VertexId::new(v), place.into())))
}

fn solve(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> Result<Embedding, SolveError> {
    solve_once(mesh, settings, pins, Control::unattended()).map(|solution| solution.embedding)
}

/// Signed total area of the embedding's faces.
fn signed_area(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    mesh.faces()
        .map(|face| {
            let [a, b, c] = embedding.corners(mesh, face);
            (b - a).perp_dot(c - a) / 2.0
        })
        .sum()
}

#[test]
fn pins_are_met_bit_for_bit() {
    let mesh = dome();
    let wanted = pins(&[(3, [0.1, -0.7]), (17, [1e-17, 2.0 / 3.0]), (40, [-3.3, 1.1]), (55, [-0.0, 5e-324])]);
    for settings in free_methods() {
        let solution = solve_once(&mesh, &settings, &wanted, Control::unattended()).unwrap();
        for (vertex, target) in &wanted {
            let found = solution.embedding[vertex];
            assert_eq!(
                found.to_array().map(f64::to_bits),
                target.target.to_array().map(f64::to_bits),
                "{settings:?} {vertex}"
            );
        }
        assert_eq!(solution.pins, wanted);
        assert!(!solution.gauge_completed);
    }
}

#[test]
fn one_pin_moves_the_default_solution_onto_its_target() {
    let mesh = dome();
    let (vertex, target) = (VertexId::new(23), DVec2::new(7.25, -3.5));
    for settings in free_methods() {
        let free = solve(&mesh, &settings, &Pins::new()).unwrap();
        let pinned = solve_once(&mesh, &settings, &hard_pins([(vertex, target)]), Control::unattended()).unwrap();
        let shift = target - free[vertex.index()];
        assert_eq!(pinned.embedding[vertex], target);
        assert!(pinned.gauge_completed);
        for (moved, z) in pinned.embedding.iter().zip(&free) {
            assert!(
                moved.distance(*z + shift) <= 1e-14 * target.length(),
                "{settings:?}: {moved} is not {}",
                *z + shift
            );
        }
    }
}

#[test]
fn the_default_gauge_lies_on_the_x_axis_from_the_lower_id_at_the_origin() {
    let mesh = dome();
    let gauge = gauge_pins(&mesh);
    let [(&low, &origin), (&high, &other)] = [gauge.first_key_value().unwrap(), gauge.last_key_value().unwrap()];
    assert_eq!(gauge.len(), 2);
    assert_eq!(origin, DVec2::ZERO);
    assert_eq!(other, DVec2::new(mesh.position(low).distance(mesh.position(high)), 0.0));
    assert!(mesh.boundary_place(low).is_some() && mesh.boundary_place(high).is_some());
    for settings in free_methods() {
        let embedding = solve(&mesh, &settings, &Pins::new()).unwrap();
        assert_eq!(embedding[low], DVec2::ZERO, "scaling keeps the origin");
        let other = embedding[high];
        assert!(other.x > 0.0 && other.y == 0.0, "{settings:?}: {other}");
    }
}

#[test]
fn without_pins_the_embedding_has_the_area_of_the_surface() {
    for example in BuiltIn::ALL {
        let mesh = disk(example.mesh());
        let embedding = solve(&mesh, &Settings::default(), &Pins::new()).unwrap();
        let flat: f64 = mesh
            .faces()
            .map(|face| {
                let [a, b, c] = embedding.corners(&mesh, face);
                (b - a).perp_dot(c - a).abs() / 2.0
            })
            .sum();
        let surface = mesh.mesh().area();
        assert!((flat / surface - 1.0).abs() < 1e-12, "{}: {flat} is not {surface}", example.name());
    }
}

#[test]
fn true_area_holds_at_sizes_whose_squares_no_double_holds() {
    for scale in [1e-150, 1e150] {
        let mesh = grid(3, 2);
        let positions = mesh.positions.iter().map(|&p| p * scale).collect();
        let mesh = disk(TriMesh { positions, ..mesh });
        let mut embedding: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate() * 1e-9).collect();
        to_true_area(&mesh, &mut embedding);
        let corner = embedding[3].x * (mesh.unit() / scale);
        assert!((corner - 3.0).abs() < 1e-12, "scale {scale}: {corner}");
    }
}

#[test]
fn fitting_fills_the_unit_square_and_keeps_the_shape() {
    let mesh = dome();
    let free = solve(&mesh, &Settings::default(), &Pins::new()).unwrap();
    let mut fitted = free.clone();
    to_unit_square(&mut fitted);
    let low = fitted.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = fitted.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    assert_eq!(low, DVec2::ZERO);
    assert!(high.max_element() == 1.0 && high.min_element() > 0.5, "{high}");
    let factor = (signed_area(&mesh, &free) / signed_area(&mesh, &fitted)).sqrt();
    for (z, f) in free.iter().zip(&fitted) {
        let (before, after) = (*z - free[0], (*f - fitted[0]) * factor);
        assert!(before.distance(after) < 1e-11 * factor, "{before} became {after}");
    }
}

#[test]
fn pins_that_cannot_be_are_named() {
    let mesh = dome();
    let error = |list: &[(u32, [f64; 2])]| solve(&mesh, &Settings::default(), &pins(list)).unwrap_err();
    let v = VertexId::new;
    let coincident = SolveError::CoincidentPins { first: v(4), second: v(9) };
    assert_eq!(error(&[(4, [1.0, 2.0]), (5, [0.0, 0.0]), (9, [1.0, 2.0])]), coincident);
    assert_eq!(error(&[(4, [0.0, -0.0]), (9, [-0.0, 0.0])]), coincident);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(error(&[(1, [0.0, 1.0]), (2, [bad, 0.0])]), SolveError::TargetNotFinite { vertex: v(2) });
        assert_eq!(error(&[(2, [0.0, bad])]), SolveError::TargetNotFinite { vertex: v(2) });
    }
    let count = mesh.vertex_count();
    let beyond = u32::try_from(count).unwrap();
    assert_eq!(error(&[(beyond, [0.0, 0.0])]), SolveError::NoSuchVertex { vertex: v(beyond), count });
}

#[test]
fn choices_that_do_not_go_together_are_named() {
    let triangle = disk(TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]));
    let square = Settings::new(Method::Convex(BoundaryShape::Square), Family::Uniform);
    let too_short = solve(&triangle, &square, &Pins::new());
    assert!(matches!(too_short, Err(SolveError::BoundaryTooShort { found: 3, needed: 4, .. })), "{too_short:?}");
    let circle = Settings { method: Method::Convex(BoundaryShape::Circle), ..square };
    assert!(solve(&triangle, &circle, &Pins::new()).is_ok(), "a circle takes a single triangle");
    for family in [Family::Uniform, Family::ShapePreserving] {
        let error = solve(&dome(), &Settings::new(Method::Natural, family), &Pins::new()).unwrap_err();
        let SolveError::FamilyNotApplicable { method: "Natural boundary", remedy, .. } = error else {
            panic!("{error}")
        };
        let is_named = |other: &&Method| remedy.contains(other.labels().title);
        let named: Vec<Method> = Method::ALL.iter().filter(is_named).cloned().collect();
        let wanted: Vec<Method> = Method::ALL.iter().filter(|other| other.takes_any_family()).cloned().collect();
        assert_eq!(named, wanted, "{remedy}");
    }
}

#[test]
fn a_single_triangle_and_all_vertices_pinned_are_no_special_cases() {
    let triangle = disk(TriMesh::new(vec![DVec3::ZERO, DVec3::X * 2.0, DVec3::Y], &[[0, 1, 2]]));
    for settings in free_methods() {
        let flat = solve(&triangle, &settings, &Pins::new()).unwrap();
        let edges: Vec<f64> = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| flat[a].distance(flat[b])).to_vec();
        for (found, expected) in edges.iter().zip([2.0, 5_f64.sqrt(), 1.0]) {
            assert!((found - expected).abs() < 1e-12, "{settings:?}: {edges:?}");
        }
        let everywhere = pins(&[(0, [5.0, 5.0]), (1, [6.0, 5.0]), (2, [9.0, -5.0])]);
        let placed = solve(&triangle, &settings, &everywhere).unwrap_or_else(|error| panic!("{settings:?}: {error}"));
        assert!(everywhere.values().map(|pin| pin.target).eq(placed.iter().copied()), "{settings:?}: {placed:?}");
    }
}

/// Largest distance between two boundary vertices, over all pairs.
fn farthest_distance(mesh: &DiskMesh) -> f64 {
    let boundary = mesh.boundary_loop();
    let distance = |a: VertexId, b: VertexId| mesh.position(a).distance_squared(mesh.position(b));
    boundary.iter().flat_map(|&a| boundary.iter().map(move |&b| distance(a, b))).fold(0.0, f64::max)
}

fn assert_farthest(mesh: &DiskMesh) {
    let [a, b] = farthest_pair(mesh);
    assert!(a != b && mesh.boundary_place(a).is_some() && mesh.boundary_place(b).is_some());
    let found = mesh.position(a).distance_squared(mesh.position(b));
    assert_eq!(found.to_bits(), farthest_distance(mesh).to_bits());
}

#[test]
fn the_farthest_pair_is_that_of_all_pairs() {
    let mut random = Random(5);
    for sides in [3, 4, 5, 8, 9, 17, 64, 301] {
        assert_farthest(&disk(fan(sides)));
        for squash in [1.0, 0.1, 1e-6] {
            let mut mesh = fan(sides);
            for p in &mut mesh.positions[1..] {
                let radius = 0.5 + random.unit();
                *p = DVec3::new(p.x * radius, p.y * radius * squash, random.unit() - 0.5);
            }
            assert_farthest(&disk(mesh));
        }
    }
    for entry in data_disks() {
        assert_farthest(&entry.disk());
    }
}

corpus_test! {
    fn the_farthest_pair_is_that_of_all_pairs_in_the_corpus() {
        for entry in corpus_disks().iter().filter(|entry| entry.number("boundary_edges") < Some(1000)) {
            assert_farthest(&entry.disk());
        }
    }
}

#[test]
fn a_circle_of_a_hundred_thousand_vertices_has_its_farthest_pair_at_once() {
    let sides = 100_000;
    let mesh = disk(fan(sides));
    let [a, b] = farthest_pair(&mesh);
    let apart = f64::from(b.number().abs_diff(a.number())) / f64::from(sides) * TAU;
    assert!((apart - TAU / 2.0).abs() < 1e-3, "{apart}");
    assert!(mesh.position(a).distance(mesh.position(b)) >= 2.0 - 1e-15);
}
