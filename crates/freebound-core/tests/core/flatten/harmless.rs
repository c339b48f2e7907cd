//! Meshes with harmless faults only (degenerate faces, unreferenced vertices) flatten without repair.

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, Fault, TriMesh, VertexId, diagnose};
use freebound_core::problem::{
    Control, Embedding, Family, Method, NamedOption as _, Pins, Settings, SolveError, hard_pins,
};
use freebound_core::verify::distortion;
use glam::{DVec2, DVec3};

use freebound_testkit::{Random, corpus_entry, corpus_test, disk, fan, grid, sheet};

/// Last step of a run.
fn last_step(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> Step {
    let mut last = None;
    Flattener::new(settings.clone(), pins.clone())
        .finish(mesh, Control::unattended(), |step| last = Some(step))
        .unwrap_or_else(|error| panic!("{settings:?}: {error}"));
    last.expect("a step")
}

fn method(method: Method) -> Settings {
    Settings::new(method, Family::default())
}

/// Inserts an unreferenced, distant vertex at index `number`; later vertices move up by one.
fn with_stray(mut mesh: TriMesh, number: u32) -> TriMesh {
    mesh.positions.insert(number as usize, DVec3::new(1e3, -2e200, 5e2));
    for corner in mesh.triangles.iter_mut().flatten() {
        *corner = VertexId::new(moved_up(corner.number(), number));
    }
    mesh
}

fn moved_up(vertex: u32, number: u32) -> u32 {
    vertex + u32::from(vertex >= number)
}

fn without(embedding: &Embedding, number: u32) -> Vec<DVec2> {
    let mut places = embedding.to_vec();
    places.remove(number as usize);
    places
}

#[test]
fn a_vertex_of_no_face_changes_no_bit_of_an_embedding() {
    let last = u32::try_from(sheet(6, 0.4).vertex_count()).expect("few");
    for way in Method::ALL {
        let expected = last_step(&disk(sheet(6, 0.4)), &method(way.clone()), &Pins::new());
        for number in [0, 17, last] {
            let strange = disk(with_stray(sheet(6, 0.4), number));
            assert!(!strange.is_used(VertexId::new(number)));
            let found = last_step(&strange, &method(way.clone()), &Pins::new());
            let found = without(&found.candidate.solution.embedding, number);
            assert_eq!(found, expected.candidate.solution.embedding.to_vec(), "{}, stray vertex {number}", way.name());
        }
    }
}

#[test]
fn a_vertex_of_no_face_changes_no_bit_where_pins_need_every_rung() {
    // Four corners of the sheet with two of them swapped: only new vertices can meet that.
    let corners = [(0, [0.0, 0.0]), (6, [0.0, 1.0]), (24, [0.4, 0.6]), (42, [1.0, 0.0]), (48, [1.0, 1.0])];
    for number in [3, 49] {
        let pins = |number: u32| -> Pins {
            hard_pins(corners.iter().map(|&(v, uv)| (VertexId::new(moved_up(v, number)), DVec2::from(uv))))
        };
        for way in [Method::Auto, Method::Matchmaker] {
            let expected = last_step(&disk(sheet(6, 0.4)), &method(way.clone()), &pins(u32::MAX));
            let found = last_step(&disk(with_stray(sheet(6, 0.4), number)), &method(way.clone()), &pins(number));
            assert!(expected.verdict.planar && found.verdict.planar, "{}", way.name());
            let [expected, found] = [expected, found].map(|step| step.candidate.solution.embedding);
            assert_eq!(without(&found, number), expected.to_vec(), "{}, stray vertex {number}", way.name());
        }
    }
}

#[test]
fn a_pin_on_a_vertex_of_no_face_is_refused_by_its_number() {
    let mesh = disk(with_stray(grid(2, 2), 4));
    let pins = hard_pins([(VertexId::new(4), DVec2::ZERO)]);
    let refused =
        Flattener::new(Settings::default(), pins).step(&mesh, Control::unattended()).expect_err("no pin there");
    assert_eq!(refused, SolveError::UnusedVertex { vertex: VertexId::new(4) });
}

/// Sheet with degenerate faces of all kinds: a vertex in the middle of a neighbour's edge, two coinciding vertices,
/// and a whole fan on one line.
fn with_flat_faces() -> TriMesh {
    let mut mesh = sheet(8, 0.3);
    let at = |column: usize, row: usize| 9 * row + column;
    mesh.positions[at(3, 3)] = mesh.positions[at(2, 3)].midpoint(mesh.positions[at(3, 2)]);
    mesh.positions[at(5, 5)] = mesh.positions[at(6, 5)];
    for row in 1..8 {
        mesh.positions[at(7, row)] = mesh.positions[at(7, 1)];
    }
    mesh
}

#[test]
fn every_method_flattens_faces_without_area() {
    let mesh = with_flat_faces();
    let found = diagnose(&mesh);
    assert!(matches!(&found.faults[..], [Fault::ZeroArea(faces)] if faces.triangles.len() > 10), "{found}");
    let mesh = disk(mesh);
    for way in Method::ALL.iter().cloned() {
        let step = last_step(&mesh, &method(way.clone()), &Pins::new());
        assert!(step.candidate.solution.embedding.check_finite().is_ok(), "{}", way.name());
        if matches!(way, Method::Auto | Method::VirtualBoundary | Method::Schnyder) {
            assert!(step.verdict.planar, "{}: {}", way.name(), step.verdict.summary());
        }
    }
}

#[test]
fn faces_without_area_flatten_with_constraints_too() {
    let mesh = disk(with_flat_faces());
    let targets = [(0, [0.0, 0.0]), (8, [1.0, 0.1]), (40, [0.7, 0.3]), (72, [0.1, 1.0]), (80, [1.0, 0.9])];
    let pins = hard_pins(targets.map(|(v, uv)| (VertexId::new(v), DVec2::from(uv))));
    let step = last_step(&mesh, &Settings::default(), &pins);
    assert!(step.verdict.planar && step.unmet().is_empty(), "{}", step.verdict.summary());
}

corpus_test! {
    fn every_bad_file_without_other_faults_ends_planar() {
        let entry = corpus_entry("bad/degenerate_capsule.obj");
        let step = last_step(&entry.disk(), &Settings::default(), &Pins::new());
        assert!(step.verdict.planar, "{}: {}", entry.file, step.verdict.summary());
    }
}

#[test]
fn mollified_triangles_have_the_sides_and_the_margin_that_the_source_asks_for() {
    let mesh = disk(with_flat_faces());
    let by = mesh.mollification();
    let sides = |[a, b, c]: [DVec3; 3]| [a.distance(b), b.distance(c), c.distance(a)];
    let mut mean = 0.0;
    let mut least_margin = f64::INFINITY;
    for face in mesh.faces() {
        let (before, after) = (sides(mesh.mesh().corners(face)), sides(mesh.shape(mesh.face(face))));
        mean += before.iter().sum::<f64>() / 3.0 / mesh.face_count() as f64;
        for (before, after) in before.iter().zip(after) {
            assert!((after - before - by).abs() < 1e-12, "{before} became {after}, not longer by {by}");
        }
        let longest = after.into_iter().fold(0.0, f64::max);
        least_margin = least_margin.min(after.iter().sum::<f64>() - 2.0 * longest);
    }
    // The least ε: the margin is reached, without excess.
    assert!((least_margin - 1e-5 * mean).abs() < 1e-12, "{least_margin} for {mean}");
}

#[test]
fn a_mesh_whose_faces_all_have_an_area_keeps_its_lengths() {
    let mut random = Random(5);
    for mut mesh in [fan(7), sheet(5, 0.5)] {
        mesh.positions.iter_mut().for_each(|p| *p += DVec3::splat(1e-3 * random.unit()));
        let mesh = disk(mesh);
        assert_eq!(mesh.mollification().to_bits(), 0.0_f64.to_bits());
        for face in mesh.faces() {
            assert_eq!(mesh.shape(mesh.face(face)), mesh.mesh().corners(face));
        }
    }
}

#[test]
fn a_flat_face_counts_in_the_distortion_as_the_triangle_that_it_is_taken_for() {
    let mesh = disk(with_flat_faces());
    let step = last_step(&mesh, &Settings::default(), &Pins::new());
    let summary = distortion(&mesh, &step.candidate.solution.embedding).summary;
    assert!(summary.symmetric_dirichlet.mean.is_finite() && summary.angle.max.is_finite(), "{summary:?}");
}
