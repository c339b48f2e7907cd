//! SLIM: its proxy against the energy, its steps against an independently computed energy, and its ending.

use std::collections::BTreeMap;

use freebound_core::flatten::{Ending, Flattener, Step, solve_once};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::nonlinear::foldover_energy::{Element, Energy, Stiffness};
use freebound_core::nonlinear::slim::{Proxy, Slim};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, SolveError, Stage, hard_pins,
};
use freebound_testkit::BuiltIn;
use glam::{DMat2, DVec2};
use proptest::prelude::*;

use freebound_testkit::{
    Entry, Random, assert_message, corpus_disks, corpus_entry, corpus_test, data_disks, disk, grid, honeycomb,
    quad_sheet, tube,
};

fn run(mesh: &DiskMesh, settings: Settings) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| steps.push(step));
    (steps, ending.expect("solvable"))
}

fn slim() -> Settings {
    Settings::new(Method::Slim, Family::default())
}

fn tutte(mesh: &DiskMesh) -> Embedding {
    let settings = Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform);
    solve_once(mesh, &settings, &Pins::new(), Control::unattended()).expect("solvable").embedding
}

/// Twice the area of a face, and its Jacobian from space to the plane, by the sides from its first corner.
fn jacobian(mesh: &DiskMesh, embedding: &Embedding, [a, b, c]: [VertexId; 3]) -> (f64, DMat2) {
    let [first, second] = [b, c].map(|vertex| mesh.position(vertex) - mesh.position(a));
    let base = first.length();
    let (along, height) = (second.dot(first) / base, first.cross(second).length() / base);
    let at_rest = DMat2::from_cols(DVec2::new(base, 0.0), DVec2::new(along, height));
    let moved = DMat2::from_cols(embedding[b] - embedding[a], embedding[c] - embedding[a]);
    (base * height, moved * at_rest.inverse())
}

/// Area-weighted mean over the surface of |J|² + |J⁻¹|².
fn energy(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let square = |m: DMat2| m.x_axis.length_squared() + m.y_axis.length_squared();
    let (mut sum, mut total) = (0.0, 0.0);
    for face in mesh.real_faces() {
        let (double_area, map) = jacobian(mesh, embedding, mesh.face(face));
        sum += double_area * (square(map) + square(map.inverse()));
        total += double_area;
    }
    sum / total
}

/// Embedding scaled to the area of the surface.
fn at_equal_areas(mesh: &DiskMesh, embedding: &Embedding) -> Embedding {
    let areas = |face| {
        let (on_surface, map) = jacobian(mesh, embedding, face);
        DVec2::new(on_surface, on_surface * map.determinant())
    };
    let total: DVec2 = mesh.real_faces().map(|face| areas(mesh.face(face))).sum();
    embedding.iter().map(|z| (total.x / total.y).sqrt() * *z).collect()
}

fn least_determinant(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let determinant = |face| jacobian(mesh, embedding, mesh.face(face)).1.determinant();
    mesh.real_faces().map(determinant).fold(f64::INFINITY, f64::min)
}

/// Built-in meshes, and disks of `tests/data`.
fn meshes() -> Vec<(String, DiskMesh)> {
    let built_in = [BuiltIn::Dome, BuiltIn::BumpyCap, BuiltIn::Cube, BuiltIn::Face];
    let built_in = built_in.map(|example| (example.name().to_owned(), disk(example.mesh())));
    built_in.into_iter().chain(data_disks().iter().map(Entry::named_disk)).collect()
}

fn corpus_meshes() -> Vec<(String, DiskMesh)> {
    ["nefertiti_562.obj", "cathead.obj"].map(|file| corpus_entry(file).named_disk()).into()
}

/// Rest triangle, and a triangle that is not folded.
fn pair_of_triangles() -> impl Strategy<Value = (Element, [DVec2; 3])> {
    let point = || (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| DVec2::new(x, y));
    let triangle = move || {
        [point(), point(), point()].prop_filter_map("an area", |[a, b, c]| {
            let area = (b - a).perp_dot(c - a);
            (area.abs() > 0.05).then_some(if area > 0.0 { [a, b, c] } else { [a, c, b] })
        })
    };
    (triangle(), triangle(), 0.1..3.0_f64)
        .prop_map(|(rest, z, weight)| (Element::new([0, 1, 2], rest, Stiffness { weight, thinnest: 1e-9 }), z))
}

fn moved(mut z: [DVec2; 3], coordinate: usize, by: f64) -> [DVec2; 3] {
    z[coordinate / 2][coordinate % 2] += by;
    z
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_gradient_of_the_proxy_is_that_of_the_energy_where_it_is_made((element, z) in pair_of_triangles()) {
        let proxy = Proxy::at(&element, z);
        let model = proxy.model(&element, z);
        let size = model.gradient.iter().map(|g| g.abs()).fold(1.0, f64::max);
        for (i, &gradient) in model.gradient.iter().enumerate() {
            let h = 1e-6;
            let [after, before] = [h, -h].map(|by| element.energy(moved(z, i, by), Energy::SymmetricDirichlet));
            let of_energy = (after - before) / (2.0 * h);
            let [after, before] = [h, -h].map(|by| proxy.value(&element, moved(z, i, by)));
            let of_proxy = (after - before) / (2.0 * h);
            prop_assert!((of_energy - gradient).abs() < 1e-3 * size, "{of_energy} {gradient}");
            prop_assert!((of_proxy - gradient).abs() < 1e-6 * size, "{of_proxy} {gradient}");
        }
        let exact = element.model(z, Energy::SymmetricDirichlet).gradient;
        for (gradient, exact) in model.gradient.iter().zip(exact) {
            prop_assert!((gradient - exact).abs() < 1e-9 * size, "{gradient} {exact}");
        }
    }

    #[test]
    fn the_hessian_of_the_proxy_makes_it_an_exact_quadratic((element, z) in pair_of_triangles(), by in prop::array::uniform6(-1.0..1.0_f64)) {
        let proxy = Proxy::at(&element, z);
        let model = proxy.model(&element, z);
        let there = [0, 1, 2].map(|k| z[k] + DVec2::new(by[2 * k], by[2 * k + 1]));
        let linear: f64 = model.gradient.iter().zip(by).map(|(g, by)| g * by).sum();
        let curved: f64 = model.hessian.iter().zip(by).map(|(row, by_row)| {
            by_row * row.iter().zip(by).map(|(h, by)| h * by).sum::<f64>()
        }).sum();
        let expected = proxy.value(&element, z) + linear + 0.5 * curved;
        let found = proxy.value(&element, there);
        prop_assert!((found - expected).abs() < 1e-9 * (1.0 + found.abs() + curved.abs()), "{found} {expected}");
        prop_assert!(curved >= -1e-9 * (1.0 + curved.abs()));
    }
}

#[test]
fn at_rest_the_weights_are_those_of_a_rotation() {
    let rest = [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(0.4, 1.5)];
    let element = Element::new([0, 1, 2], rest, Stiffness { weight: 1.0, thinnest: 1e-9 });
    for angle in [0.0, 0.7, 3.0] {
        let z = rest.map(|z| DVec2::from_angle(angle).rotate(z));
        let proxy = Proxy::at(&element, z);
        assert!(proxy.value(&element, z).abs() < 1e-24);
        // W² is 4 there: if stretched by 1 + h in both directions, the proxy is ½ · 4 · 2 h².
        let h = 1e-3;
        assert!((proxy.value(&element, z.map(|z| (1.0 + h) * z)) - 4.0 * h * h).abs() < 1e-12);
    }
}

/// Asserts that no face folds, and returns the reasons of the last steps: one of steps before the limit, and one of
/// the limit.
fn reasons_where_no_face_folds(meshes: Vec<(String, DiskMesh)>) -> String {
    let mut reasons = BTreeMap::new();
    for (name, mesh) in meshes {
        let (steps, _) = run(&mesh, slim());
        assert_eq!(
            steps[0].candidate.stage,
            Stage::Convex(BoundaryShape::Circle),
            "{name}: it begins with Tutte's map"
        );
        let start = Slim::new(&mesh, &tutte(&mesh), Control::unattended()).expect("planar").progress().energy;
        let said = steps[0].candidate.progress.expect("an energy").energy;
        assert!((said / start - 1.0).abs() < 1e-12, "{name}: {said} {start}");
        assert!((2..=21).contains(&steps.len()), "{name}: {}", steps.len());
        for step in &steps {
            assert!(step.verdict.flipped_faces.is_empty(), "{name}, step {}: {}", step.index, step.verdict.summary());
            assert!(step.candidate.progress.expect("a determinant").least_determinant > 0.0);
            assert!(step.candidate.stage == Stage::Slim || step.index == 0);
        }
        let (last, others) = steps.split_last().expect("a step");
        assert!(others.iter().all(|step| step.candidate.note.is_none()), "{name}");
        let note = last.candidate.note.clone().expect("a reason");
        assert_eq!(*reasons.entry(steps.len() == 21).or_insert_with(|| note.clone()), note, "{name}");
        assert!(!last.candidate.has_convex_boundary());
    }
    reasons.into_values().collect::<Vec<_>>().join("\n")
}

#[test]
fn no_face_folds_and_the_last_step_says_why_it_is_the_last() {
    assert_message("slim-reasons", &reasons_where_no_face_folds(meshes()));
}

corpus_test! {
    fn no_face_folds_and_the_last_step_says_why_it_is_the_last_in_the_corpus() {
        assert!(!reasons_where_no_face_folds(corpus_meshes()).is_empty());
    }
}

fn assert_energy_and_determinant_that_are_said_are_those_at_equal_total_areas(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        let start = tutte(&mesh);
        let mut slim = Slim::new(&mesh, &start, Control::unattended()).expect("planar");
        for _ in 0..3 {
            let embedding = slim.embedding();
            let before = energy(&mesh, &embedding);
            let (said, found) = (slim.progress(), at_equal_areas(&mesh, &embedding));
            assert!((energy(&mesh, &found) / said.energy - 1.0).abs() < 1e-9, "{name}: {said:?}");
            let least = least_determinant(&mesh, &found);
            assert!((least / said.least_determinant - 1.0).abs() < 1e-6, "{name}: {least} {said:?}");
            slim.step(Control::unattended()).expect("solvable").expect("it falls");
            let after = energy(&mesh, &slim.embedding());
            assert!(after < before, "{name}: at the size that it has come to, {after} after {before}");
        }
    }
}

#[test]
fn energy_and_determinant_that_are_said_are_those_at_equal_total_areas() {
    assert_energy_and_determinant_that_are_said_are_those_at_equal_total_areas(meshes());
}

corpus_test! {
    fn energy_and_determinant_that_are_said_are_those_at_equal_total_areas_in_the_corpus() {
        assert_energy_and_determinant_that_are_said_are_those_at_equal_total_areas(corpus_meshes());
    }
}

#[test]
fn a_flat_mesh_comes_back_in_the_end() {
    let mesh = disk(BuiltIn::Ell.mesh());
    let (steps, _) = run(&mesh, Settings { max_steps: Some(200), ..slim() });
    let last = steps.last().expect("a step");
    let energy = last.candidate.progress.expect("an energy").energy;
    assert!(energy < 4.0 + 1e-3, "{energy} after {} steps", steps.len());
    assert!(last.verdict.planar, "{}", last.verdict.summary());
    assert!(steps.len() < 200, "it ends by itself");
    assert_message("slim-flat-mesh", last.candidate.note.as_deref().expect("a reason"));
}

#[test]
fn a_limit_of_iterations_ends_it() {
    let mesh = disk(grid(6, 4));
    let mut reasons = Vec::new();
    for limit in 0..3 {
        let (steps, _) = run(&mesh, Settings { max_steps: Some(limit), ..slim() });
        assert_eq!(steps.len(), limit + 1);
        reasons.push(steps[limit].candidate.note.clone().expect("a reason"));
    }
    assert_message("slim-limits", &reasons.join("\n"));
}

#[test]
fn where_rounding_folds_tuttes_map_it_begins_with_the_first_planar_map_of_the_ladder() {
    // Each ring of the tube is a third of the one before; the innermost exceed 64-bit precision.
    let mesh = disk(tube(3, 80));
    assert_eq!(
        Slim::new(&mesh, &tutte(&mesh), Control::unattended()).err(),
        Some(SolveError::NotPlanar),
        "nothing to test"
    );
    let (steps, ending) = run(&mesh, Settings { max_steps: Some(3), ..slim() });
    let first = steps.iter().position(|step| step.candidate.stage == Stage::Slim).expect("an iteration");
    let (way, iterations) = steps.split_at(first);
    assert!(way.len() > 1 && way[0].candidate.stage == Stage::Convex(BoundaryShape::Circle));
    for (number, step) in way.iter().enumerate() {
        assert_ne!(step.candidate.stage, Stage::Relax, "lowering the energy is SLIM's");
        assert_eq!(step.verdict.is_one_to_one(), number + 1 == first, "step {number}: {}", step.verdict.summary());
        assert_eq!(step.candidate.progress.is_some(), number + 1 == first, "the energy of the start");
    }
    assert_eq!((iterations.len(), ending), (3, Ending::Planar));
    let energies: Vec<f64> =
        steps[first - 1..].iter().map(|step| step.candidate.progress.expect("an energy").energy).collect();
    assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
    assert!(iterations.iter().all(|step| step.candidate.stage == Stage::Slim && step.verdict.flipped_faces.is_empty()));
    let reasons = [&way[0], &iterations[2]].map(|step| step.candidate.note.as_deref().expect("a reason"));
    assert_message("slim-start-of-the-ladder", &reasons.join("\n"));
}

#[test]
fn two_pins_say_where_it_lies_and_more_are_refused() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let [a, b, c] = [0, 5, 10].map(|k| mesh.boundary_loop()[k]);
    let targets = [(a, DVec2::new(3.0, 1.0)), (b, DVec2::new(4.0, -1.0)), (c, DVec2::ZERO)];
    let mut steps = Vec::new();
    let two = hard_pins(targets[..2].iter().copied());
    Flattener::new(slim(), two.clone())
        .finish(&mesh, Control::unattended(), |step| steps.push(step))
        .expect("solvable");
    for step in &steps {
        assert!(two.iter().all(|(v, pin)| step.candidate.solution.embedding[*v] == pin.target), "step {}", step.index);
    }
    let refused = Flattener::new(slim(), hard_pins(targets)).step(&mesh, Control::unattended()).err();
    assert_eq!(refused, Some(SolveError::TooManyPins { method: "SLIM", count: 3, most: 2 }));
}

corpus_test! {
    #[ignore = "all disks of the corpus take minutes without optimisation"]
    fn every_disk_of_the_corpus_ends_with_less_energy_and_an_honest_verdict() {
        for entry in corpus_disks() {
            let mesh = entry.disk();
            let start = std::time::Instant::now();
            let (steps, _) = run(&mesh, slim());
            let energies: Vec<f64> =
                steps.iter().filter_map(|step| step.candidate.progress).map(|progress| progress.energy).collect();
            let energies = [energies.first(), energies.last()].map(Option::<&f64>::copied);
            let last = steps.last().expect("a step");
            println!(
                "{}: {} faces, {} steps, energy {:?}, {:.2} s, {}, {}",
                entry.file,
                mesh.face_count(),
                steps.len(),
                energies,
                start.elapsed().as_secs_f64(),
                last.verdict.summary(),
                last.candidate.note.as_deref().unwrap_or_default()
            );
            let mut iterations = steps.iter().filter(|step| step.candidate.stage == Stage::Slim);
            assert!(iterations.all(|step| step.verdict.flipped_faces.is_empty()), "{}", entry.file);
            let [Some(before), Some(after)] = energies else { panic!("{}: no energy", entry.file) };
            assert!(steps.len() == 1 || after < before, "{}: {before} to {after}", entry.file);
            assert!(last.candidate.note.is_some(), "{}: it says why it ends", entry.file);
        }
    }
}

#[test]
fn relaxing_waits_for_the_last_iteration_where_polygons_are_concave_on_the_way() {
    let mut waited = 0;
    let mut random = Random(5);
    let sheets = [0.3, 0.6].map(|roughness| quad_sheet(5, 5, roughness, &mut random));
    for sheet in [honeycomb(4, 3, 0.3, &mut random)].into_iter().chain(sheets) {
        let mesh = disk(sheet.triangulate());
        let settings = Settings { relax_rounds: Some(2), max_steps: Some(6), ..slim() };
        let (steps, _) = run(&mesh, settings);
        let last = steps.iter().rposition(|step| step.candidate.stage == Stage::Slim).expect("an iteration");
        assert!(
            steps[1..=last].iter().all(|step| step.candidate.stage == Stage::Slim),
            "SLIM continues from its own steps alone"
        );
        let is_concave = |step: &&Step| step.verdict.is_one_to_one() && !step.verdict.concave_polygons.is_empty();
        waited += steps[..last].iter().filter(is_concave).count();
    }
    assert!(waited > 0, "nothing to test");
}
