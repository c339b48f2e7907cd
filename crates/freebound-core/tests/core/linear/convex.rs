//! Convex boundaries: the boundary on its shape, the inside at weighted means, and planar if the theorem applies.

#![allow(clippy::float_cmp, reason = "places on the outline are meant bit for bit")]

use freebound_core::flatten::{Flattener, Prepared, solve_once};
use freebound_core::geom::{Bounds, ConvexPolygon, convex_hull, turning_number};
use freebound_core::linear::convex_boundary;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, SolveError, Spacing, hard_pins,
};
use freebound_core::verify::verdict;
use freebound_core::weights::equations::Equations;
use freebound_core::weights::{equations, shape_preserving};
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};
use proptest::prelude::*;

use freebound_testkit::{Entry, corpus_disks, corpus_test, data_disks};

const FAMILIES: [Family; 5] =
    [Family::Uniform, Family::MeanValue, Family::ShapePreserving, Family::Conformal, Family::Wachspress];

/// Largest relative residual of a solve.
const RESIDUAL: f64 = 1e-10;

fn convex(shape: BoundaryShape, family: Family) -> Settings {
    Settings::new(Method::Convex(shape), family)
}

fn embed(mesh: &DiskMesh, settings: &Settings, name: &str) -> Embedding {
    let solution = solve_once(mesh, settings, &Pins::new(), Control::unattended())
        .unwrap_or_else(|error| panic!("{name}, {settings:?}: {error}"));
    assert!(
        solution.linear.unwrap().residual <= RESIDUAL,
        "{name}, {settings:?}: residual {:e}",
        solution.linear.unwrap().residual
    );
    solution.embedding
}

fn examples() -> Vec<(String, DiskMesh)> {
    BuiltIn::ALL
        .map(|e| (e.name().to_owned(), DiskMesh::try_from(e.mesh()).expect("well-formed by construction")))
        .to_vec()
}

#[test]
fn the_boundary_lies_on_a_circle_in_the_order_of_the_loop() {
    for (name, mesh) in examples() {
        let embedding = embed(&mesh, &convex(BoundaryShape::Circle, Family::Uniform), &name);
        let boundary = embedding.boundary(&mesh);
        let radius = boundary[0].length();
        assert!(boundary.iter().all(|z| (z.length() / radius - 1.0).abs() < 1e-14), "{name}");
        // Arcs are proportional to edge lengths and go around once.
        let lengths: Vec<f64> = edge_lengths(&mesh);
        let total: f64 = lengths.iter().sum();
        for (k, length) in lengths.iter().enumerate() {
            let arc = boundary[k].angle_to(boundary[(k + 1) % boundary.len()]);
            assert!((arc - length / total * std::f64::consts::TAU).abs() < 1e-12, "{name}: arc {k}");
        }
    }
}

fn edge_lengths(mesh: &DiskMesh) -> Vec<f64> {
    let boundary = mesh.boundary_loop();
    let next = boundary.iter().cycle().skip(1);
    boundary.iter().zip(next).map(|(&a, &b)| mesh.position(a).distance(mesh.position(b))).collect()
}

#[test]
fn the_boundary_lies_on_a_square_in_the_order_of_the_loop() {
    for (name, mesh) in examples() {
        let embedding = embed(&mesh, &convex(BoundaryShape::Square, Family::Uniform), &name);
        let side = mesh.boundary_loop().iter().map(|v| embedding[v].max_element()).fold(0.0, f64::max);
        let corners = [DVec2::ZERO, DVec2::new(side, 0.0), DVec2::splat(side), DVec2::new(0.0, side)];
        let boundary = embedding.boundary(&mesh);
        for corner in corners {
            assert!(boundary.contains(&corner), "{name}: no vertex at {corner}");
        }
        // Position along the outline, from 0 to 4.
        let along = |z: &DVec2| match *z / side {
            z if z.y == 0.0 => z.x,
            z if z.x == 1.0 => 1.0 + z.y,
            z if z.y == 1.0 => 3.0 - z.x,
            z if z.x == 0.0 => 4.0 - z.y,
            z => panic!("{name}: {z} is not on the square"),
        };
        let places: Vec<f64> = boundary.iter().map(along).collect();
        assert!(places.is_sorted_by(|a, b| a < b), "{name}: {places:?}");
    }
}

/// Positions of the boundary at the shape's own size and place.
fn laid(mesh: &DiskMesh, shape: &BoundaryShape, spacing: Spacing) -> Vec<DVec2> {
    let places = convex_boundary(mesh, shape, spacing).expect("a boundary of many vertices");
    mesh.boundary_loop().iter().map(|v| places[v]).collect()
}

/// Asserts that a boundary runs around a convex polygon once, counter-clockwise. Its corners are those of its hull,
/// and the points between lie in order on the hull's sides.
fn assert_runs_around(places: &[DVec2], name: &str) {
    let hull: Vec<usize> = convex_hull(places);
    let size = Bounds::of(places.iter().copied()).diameter();
    assert!(turning_number(places) == Some(1), "{name}: turns {:?}", turning_number(places));
    let first = (0..hull.len()).min_by_key(|&k| hull[k]).expect("a hull has corners");
    let corners: Vec<usize> = (0..hull.len()).map(|k| hull[(first + k) % hull.len()]).collect();
    assert!(corners.is_sorted(), "{name}: the hull goes around as the loop does");
    for (k, &from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % corners.len()];
        let steps = (to + places.len() - from - 1) % places.len() + 1;
        let way = places[to] - places[from];
        let mut before = 0.0;
        for place in (1..steps).map(|step| places[(from + step) % places.len()]) {
            let along = (place - places[from]).dot(way) / way.length_squared();
            let off = (place - places[from]).perp_dot(way).abs() / way.length();
            assert!(off < 1e-12 * size && along > before && along < 1.0, "{name}: {place} on a way of {way}");
            before = along;
        }
    }
}

/// A kite, and a pentagon with sides of very different lengths.
fn polygons() -> [ConvexPolygon; 2] {
    ["0 0; 2 -1; 3 0; 2 1", "0 0; 10 0; 10.1 0.2; 9 4; 1 2"].map(|text| ConvexPolygon::parse(text).expect("convex"))
}

#[test]
fn the_boundary_lies_on_a_polygon_with_vertices_on_its_corners() {
    for (name, mesh) in examples() {
        for polygon in polygons() {
            for spacing in [Spacing::Chord, Spacing::Even] {
                let places = laid(&mesh, &BoundaryShape::Polygon(polygon.clone()), spacing);
                assert_runs_around(&places, &name);
                for corner in polygon.corners() {
                    assert!(places.contains(corner), "{name}: no vertex at {corner}");
                }
            }
        }
    }
}

#[test]
fn a_square_of_the_users_is_the_square() {
    for (name, mesh) in examples() {
        let polygon = ConvexPolygon::parse("0 0; 1 0; 1 1; 0 1").expect("convex");
        for spacing in [Spacing::Chord, Spacing::Even] {
            let own = laid(&mesh, &BoundaryShape::Polygon(polygon.clone()), spacing);
            assert_eq!(own, laid(&mesh, &BoundaryShape::Square, spacing), "{name}");
        }
    }
}

#[test]
fn vertices_lie_evenly_where_that_is_asked_for() {
    for (name, mesh) in examples() {
        let count = mesh.boundary_loop().len();
        let on_circle = laid(&mesh, &BoundaryShape::Circle, Spacing::Even);
        for (k, z) in on_circle.iter().enumerate() {
            let angle = k as f64 / count as f64 * std::f64::consts::TAU;
            assert!(z.distance(DVec2::from_angle(angle)) < 1e-14, "{name}: place {k}");
        }
        // On a shape with corners the vertices of each side are evenly spaced.
        for shape in [BoundaryShape::Square, BoundaryShape::Hull, BoundaryShape::Polygon(polygons()[0].clone())] {
            let places = laid(&mesh, &shape.clone(), Spacing::Even);
            let turns = |k: usize| {
                let [a, b, c] = [k + count - 1, k, k + 1].map(|k| places[k % count]);
                ((b - a).perp_dot(c - b) / ((b - a).length() * (c - b).length())).abs() > 1e-6
            };
            for k in (0..count).filter(|&k| !turns(k)) {
                let [a, b, c] = [k + count - 1, k, k + 1].map(|k| places[k % count]);
                assert!((a.distance(b) - b.distance(c)).abs() < 1e-12, "{name}, {shape:?}: place {k}");
            }
        }
    }
}

#[test]
fn the_hull_is_that_of_the_projection_along_which_the_boundary_extends_least() {
    for (name, mesh) in examples() {
        assert_runs_around(&laid(&mesh, &BoundaryShape::Hull, Spacing::Chord), &name);
    }
    // A slightly rough ellipse, tilted in space: all vertices are corners, spaced as on the ellipse.
    let ring: Vec<DVec2> = (0..30).map(|k| DVec2::from_angle(f64::from(k) * 0.2) * DVec2::new(3.0, 2.0)).collect();
    let [x, y, z] =
        [DVec3::new(2.0, -1.0, 2.0), DVec3::new(2.0, 2.0, -1.0), DVec3::new(-1.0, 2.0, 2.0)].map(|a| a / 3.0);
    let rough = |k: usize| if k.is_multiple_of(3) { 1e-3 } else { -1e-3 };
    let mesh = fan_of(&ring, |k, p| x * p.x + y * p.y + z * rough(k));
    let places = laid(&mesh, &BoundaryShape::Hull, Spacing::Chord);
    let boundary: Vec<DVec2> = mesh.boundary_loop().iter().map(|v| ring[v.index() - 1]).collect();
    let unit = places[0].distance(places[10]) / boundary[0].distance(boundary[10]);
    for k in 0..30 {
        for l in 0..k {
            let ratio = places[k].distance(places[l]) / boundary[k].distance(boundary[l]) / unit;
            assert!((ratio - 1.0).abs() < 1e-3, "{k} {l}: {ratio}");
        }
    }
}

#[test]
fn a_flat_convex_boundary_comes_back_on_its_hull() {
    // A tilted hexagon keeps its corners, rotated into the plane. Mean-value weights then reproduce the whole mesh.
    let flat = fan_of(ConvexPolygon::HEXAGON.corners(), |_, p| DVec3::new(p.x, 0.6 * p.y, 0.8 * p.y));
    let places = laid(&flat, &BoundaryShape::Hull, Spacing::Chord);
    for k in 0..6 {
        for l in 0..6 {
            let boundary = flat.boundary_loop();
            let in_space = flat.position(boundary[k]).distance(flat.position(boundary[l]));
            let unit = places[0].distance(places[1]);
            assert!((places[k].distance(places[l]) / unit - in_space).abs() < 1e-12, "{k} {l}");
        }
    }
    let embedding = embed(&flat, &convex(BoundaryShape::Hull, Family::MeanValue), "hexagon");
    assert!(verdict(&flat, &embedding).planar);
}

#[test]
fn a_boundary_that_crosses_itself_in_projection_lies_on_a_convex_outline_all_the_same() {
    // A strip with a loop: seen along its best plane's normal it is a figure eight.
    let along = |t: f64| DVec3::new(2.0 * t.sin(), (2.0 * t).sin(), 0.3 * t.cos());
    let rim: Vec<DVec3> = (0..40).map(|k| along(f64::from(k) / 40.0 * std::f64::consts::TAU)).collect();
    let positions: Vec<DVec3> = std::iter::once(DVec3::new(0.0, 0.0, 2.0)).chain(rim).collect();
    let triangles: Vec<[u32; 3]> = (0..40).map(|k| [0, 1 + k, 1 + (k + 1) % 40]).collect();
    let mesh = DiskMesh::try_from(TriMesh::new(positions, &triangles)).expect("a disk");
    let places = laid(&mesh, &BoundaryShape::Hull, Spacing::Chord);
    assert_runs_around(&places, "eight");
    let embedding = embed(&mesh, &convex(BoundaryShape::Hull, Family::Uniform), "eight");
    assert!(verdict(&mesh, &embedding).planar);
}

#[test]
fn a_boundary_without_a_hull_is_refused_by_name() {
    for way in [DVec3::X, DVec3::new(0.3, -0.7, 1.9)] {
        let line = [0.0, 1.0, 3.0, 2.0].map(|t| way * t).to_vec();
        let mesh = DiskMesh::try_from(TriMesh::new(line, &[[0, 1, 3], [1, 2, 3]])).expect("mollified");
        assert_eq!(convex_boundary(&mesh, &BoundaryShape::Hull, Spacing::Chord), Err(SolveError::NoHull));
    }
}

#[test]
fn a_polygon_of_the_users_is_not_turned_and_its_corners_stay_in_their_order() {
    let mesh = DiskMesh::try_from(BuiltIn::Face.mesh()).expect("well-formed by construction");
    let polygon = polygons()[1].clone();
    let settings = convex(BoundaryShape::Polygon(polygon.clone()), Family::Uniform);
    let step = Flattener::new(settings, Pins::new()).step(&mesh, Control::unattended()).expect("solvable");
    let places = step.candidate.solution.embedding.boundary(&mesh);
    let [low, high] =
        [Bounds::of(places.iter().copied()), Bounds::of(polygon.corners().iter().copied())].map(Bounds::size);
    assert!((low.x / low.y - high.x / high.y).abs() < 1e-9, "as wide and as high as it was given");
}

/// Weights of the family, as in the solver's own tests of weights.
fn weights(mesh: &DiskMesh, family: Family) -> Equations<f64> {
    match family {
        Family::Uniform => equations::uniform(mesh),
        Family::ShapePreserving => shape_preserving(mesh),
        three_point => equations::barycentric(
            mesh,
            three_point.power().expect("well-formed by construction"),
            Control::unattended(),
        )
        .expect("well-formed by construction"),
    }
}

#[test]
fn every_interior_vertex_lies_at_its_weighted_mean() {
    for (name, mesh) in examples() {
        for shape in [BoundaryShape::Circle, BoundaryShape::Square] {
            for family in FAMILIES {
                let embedding = embed(&mesh, &convex(shape.clone(), family), &name);
                let weights = weights(&mesh, family).coefficients;
                for v in mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()) {
                    let arm = |h| embedding[mesh.head(h)] - embedding[v];
                    let sum: DVec2 = mesh.outgoing(v).map(|h| weights[h.index()] * arm(h)).sum();
                    let size: f64 = mesh.outgoing(v).map(|h| weights[h.index()].abs()).sum();
                    // Relative to the whole, since all neighbours of a vertex may be very near.
                    let whole = embedding.iter().map(|z| z.length()).fold(0.0, f64::max);
                    assert!(sum.length() <= 1e-12 * size * whole, "{name}, {shape:?}, {family}: {v} is off by {sum}");
                }
            }
        }
    }
}

fn assert_positive_weights_on_a_circle_are_proved_planar_without_dividing_edges(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        if !mesh.dividing_edges().is_empty() {
            continue;
        }
        for family in [Family::Uniform, Family::MeanValue, Family::ShapePreserving] {
            let embedding = embed(&mesh, &convex(BoundaryShape::Circle, family), &entry.file);
            let verdict = verdict(&mesh, &embedding);
            assert!(verdict.planar, "{}, {family}: {}", entry.file, verdict.summary());
        }
    }
}

#[test]
fn positive_weights_on_a_circle_are_proved_planar_without_dividing_edges() {
    assert_positive_weights_on_a_circle_are_proved_planar_without_dividing_edges(data_disks());
}

corpus_test! {
    fn positive_weights_on_a_circle_are_proved_planar_without_dividing_edges_in_the_corpus() {
        assert_positive_weights_on_a_circle_are_proved_planar_without_dividing_edges(corpus_disks());
    }
}

/// Neighbours of the origin, counter-clockwise, every gap under π.
fn closed_ring() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((1.0..3.0, 0.1..10.0), 5..12).prop_map(|spokes: Vec<(f64, f64)>| {
        let total: f64 = spokes.iter().map(|(gap, _)| gap).sum();
        let mut angle = 0.0;
        spokes
            .into_iter()
            .map(|(gap, radius)| {
                angle += gap / total * std::f64::consts::TAU;
                radius * DVec2::from_angle(angle)
            })
            .collect()
    })
}

/// Fan around vertex 0 with the given ring, mapped to space by `place`.
fn fan_of(ring: &[DVec2], place: impl Fn(usize, DVec2) -> DVec3) -> DiskMesh {
    let rim = ring.iter().enumerate().map(|(k, &p)| place(k, p));
    let positions = std::iter::once(DVec3::ZERO).chain(rim).collect();
    let count = u32::try_from(ring.len()).expect("well-formed by construction");
    let triangles: Vec<[u32; 3]> = (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect();
    DiskMesh::try_from(TriMesh::new(positions, &triangles)).expect("well-formed by construction")
}

/// Weight of each neighbour of vertex 0, in the order of the ring.
fn ring_weights(mesh: &DiskMesh) -> Vec<f64> {
    let equations = shape_preserving(mesh);
    assert_eq!(equations.bounded_corners, 0);
    let mut weights = vec![0.0; mesh.vertex_count() - 1];
    for h in mesh.outgoing(VertexId::new(0)) {
        weights[mesh.head(h).index() - 1] = equations.coefficients[h.index()];
    }
    weights
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn shape_preserving_weights_are_positive_and_sum_to_one(
        ring in closed_ring(), heights in prop::collection::vec(-3.0..3.0, 12),
    ) {
        let weights = ring_weights(&fan_of(&ring, |k, p| p.extend(heights[k])));
        prop_assert!(weights.iter().all(|&w| w > 0.0), "{weights:?}");
        prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{weights:?}");
    }

    #[test]
    fn shape_preserving_weights_reproduce_planar_rings(ring in closed_ring()) {
        let tilted = |_: usize, p: DVec2| DVec3::new(2.0, -1.0, 2.0) * p.x + DVec3::new(2.0, 2.0, -1.0) * p.y;
        let weights = ring_weights(&fan_of(&ring, tilted));
        let centre: DVec2 = ring.iter().zip(&weights).map(|(p, w)| *p * *w).sum();
        let size: f64 = ring.iter().zip(&weights).map(|(p, w)| p.length() * w).sum();
        prop_assert!(centre.length() < 1e-13 * size, "{centre}");
    }
}

#[test]
fn shape_preserving_weights_of_a_regular_ring_are_equal() {
    // Even counts put a neighbour exactly opposite each other one: the borderline of which triangle contains the
    // centre.
    for sides in 3..12 {
        let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        let ring: Vec<DVec2> = (0..sides).map(|k| DVec2::from_angle(angle(k))).collect();
        for weight in ring_weights(&fan_of(&ring, |_, p| p.extend(0.0))) {
            assert!((weight - 1.0 / f64::from(sides)).abs() < 1e-14, "{sides} sides: {weight}");
        }
    }
}

#[test]
fn a_pin_that_is_dragged_moves_nothing_within_a_convex_boundary() {
    let mesh = DiskMesh::try_from(BuiltIn::Dome.mesh()).expect("well-formed by construction");
    let settings = convex(BoundaryShape::Circle, Family::Uniform);
    let vertex = VertexId::new(3);
    let pins = hard_pins([(vertex, DVec2::ONE)]);
    let prepared = Prepared::new(&mesh, &settings, &pins, Control::unattended()).expect("solvable");
    let column = prepared.column(&mesh, &[vertex]).expect("solvable");
    assert!(column.iter().all(|way| *way == DVec2::ZERO));
}
