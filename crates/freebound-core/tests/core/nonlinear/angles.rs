//! Angle-based flattening: the conditions in their published form, least energy, agreement of both systems,
//! reproduction of planes.

use std::f64::consts::{PI, TAU};

use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::nonlinear::{AngleMap, AngleSystem, angle_based};
use freebound_core::problem::{
    Control, Family, Method, NamedOption as _, Pins, Settings, SolveError, Stage, Stop, hard_pins,
};
use freebound_core::verify::verdict;
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};
use nalgebra::{DMatrix, DVector};

use crate::linear::flat::Flat;
use crate::linear::reproduction::distance_up_to_similarity;
use freebound_testkit::{
    Entry, Random, corpus_disks, corpus_test, data_disks, disk, fan, grid, shaped, sheet, stacked, steps, tube,
};

fn solved(mesh: &DiskMesh, system: AngleSystem, name: &str) -> AngleMap {
    angle_based(mesh, system, Control::unattended()).unwrap_or_else(|error| panic!("{name}, {system:?}: {error}"))
}

/// Surfaces whose least energy has positive angles.
fn curved_meshes() -> Vec<(String, DiskMesh)> {
    let mut random = Random(11);
    let pyramid = |sides: u32, height: f64| {
        let mut mesh = fan(sides);
        mesh.positions[0].z = height;
        disk(mesh)
    };
    vec![
        ("a sheet".into(), disk(sheet(6, 0.4))),
        ("a bent sheet".into(), disk(sheet(9, 1.5))),
        ("a tube".into(), disk(tube(5, 4))),
        ("a pyramid".into(), pyramid(5, 1.5)),
        ("a flat pyramid".into(), pyramid(9, 0.3)),
        ("a saddle".into(), disk(shaped(7, 5, |x, y| DVec3::new(x, y, 0.05 * (x - 3.0) * (y - 2.0))))),
        ("some stacked".into(), rough(5, &mut random)),
    ]
}

/// Surfaces whose least energy has angles of 0.
fn steep_meshes() -> Vec<(String, DiskMesh)> {
    let mut random = Random(12);
    let mut meshes = vec![("a tube of triangles".into(), disk(tube(3, 4)))];
    meshes.extend([9, 12].map(|count| (format!("{count} stacked"), rough(count, &mut random))));
    meshes
}

/// Stacked triangulation with vertices at random heights.
fn rough(count: usize, random: &mut Random) -> DiskMesh {
    let mut mesh = stacked(count, 9, random);
    mesh.positions.iter_mut().for_each(|x| x.z += 0.1 * random.unit());
    disk(mesh)
}

fn inner_vertices(mesh: &DiskMesh) -> Vec<VertexId> {
    mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect()
}

/// Angles on the surface, scaled to 2π around inner vertices.
fn targets(mesh: &DiskMesh) -> Vec<[f64; 3]> {
    let angle = |[a, b, c]: [DVec3; 3]| (b - a).angle_between(c - a);
    let of_face = |face: FaceId| {
        let x = mesh.mesh().corners(face);
        [0, 1, 2].map(|k| angle([x[k], x[(k + 1) % 3], x[(k + 2) % 3]]))
    };
    let on_surface: Vec<[f64; 3]> = mesh.faces().map(of_face).collect();
    let mut sums = vec![0.0; mesh.vertex_count()];
    for (face, angles) in mesh.faces().zip(&on_surface) {
        mesh.face(face).iter().zip(angles).for_each(|(v, angle)| sums[v.index()] += angle);
    }
    let scale = |v: &VertexId| if mesh.boundary_place(*v).is_none() { TAU / sums[v.index()] } else { 1.0 };
    let scaled = |(face, angles): (FaceId, &[f64; 3])| [0, 1, 2].map(|k| angles[k] * scale(&mesh.face(face)[k]));
    mesh.faces().zip(&on_surface).map(scaled).collect()
}

/// Conditions in published form, with products of sines: for faces, angle sums, and wheels.
fn conditions(mesh: &DiskMesh, angles: &[[f64; 3]]) -> Vec<f64> {
    let mut found: Vec<f64> = angles.iter().map(|face| face.iter().sum::<f64>() - PI).collect();
    for vertex in inner_vertices(mesh) {
        let (mut sum, mut next, mut previous) = (-TAU, 1.0, 1.0);
        for (face, angles) in mesh.faces().zip(angles) {
            if let Some(k) = mesh.face(face).iter().position(|&v| v == vertex) {
                sum += angles[k];
                next *= angles[(k + 1) % 3].sin();
                previous *= angles[(k + 2) % 3].sin();
            }
        }
        found.extend([sum, next - previous]);
    }
    found
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest, number| if number.abs() <= largest { largest } else { number.abs() })
}

#[test]
fn the_conditions_are_met_as_the_source_has_them() {
    for (name, mesh) in curved_meshes() {
        for system in [AngleSystem::Full, AngleSystem::Reduced] {
            let found = solved(&mesh, system, &name);
            let convergence = found.solution.convergence.unwrap();
            println!("{name}, {system:?}: {convergence:?}, energy {}, held {}", found.energy, found.held);
            assert_eq!((convergence.stop, found.held), (Stop::Converged, 0), "{name}, {system:?}: {convergence:?}");
            assert!(found.angles.as_flattened().iter().all(|&angle| angle > 0.0 && angle < PI), "{name}, {system:?}");
            let left = largest(&conditions(&mesh, &found.angles));
            assert!(left < 1e-11, "{name}, {system:?}: {left:e}");
            assert!(convergence.residual < 1e-11, "{name}, {system:?}: {convergence:?}");
        }
    }
}

#[test]
fn both_systems_give_the_same_angles() {
    for (name, mesh) in curved_meshes().into_iter().chain(steep_meshes()) {
        let [full, reduced] = [AngleSystem::Full, AngleSystem::Reduced].map(|system| solved(&mesh, system, &name));
        let off: Vec<f64> =
            full.angles.as_flattened().iter().zip(reduced.angles.as_flattened()).map(|(a, b)| a - b).collect();
        assert!(largest(&off) < 1e-8, "{name}: {:e}", largest(&off));
        assert!((full.energy - reduced.energy).abs() < 1e-8, "{name}: {} and {}", full.energy, reduced.energy);
        assert_eq!(full.held, reduced.held, "{name}");
    }
}

#[test]
fn where_the_least_energy_has_angles_of_0_a_barrier_keeps_them_positive() {
    for (name, mesh) in steep_meshes() {
        let found = solved(&mesh, AngleSystem::Reduced, &name);
        let convergence = found.solution.convergence.unwrap();
        println!("{name}: {convergence:?}, energy {}, held {}", found.energy, found.held);
        assert!(found.held > 0, "{name}: otherwise this tests nothing");
        let targets = targets(&mesh);
        let ratios =
            found.angles.as_flattened().iter().zip(targets.as_flattened()).map(|(angle, target)| angle / target);
        let least = ratios.fold(f64::INFINITY, f64::min);
        assert!(least > 1e-6 && least < 0.1, "{name}: {least:e} of what it is on the surface");
        assert!(largest(&conditions(&mesh, &found.angles)) < 1e-9, "{name}: {convergence:?}");
        let summary = verdict(&mesh, &found.solution.embedding);
        assert!(summary.flipped_faces.is_empty() && !summary.mirrored, "{name}: {}", summary.summary());
    }
}

/// Derivatives of the conditions by central differences.
fn jacobian(mesh: &DiskMesh, angles: &[[f64; 3]]) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let count = conditions(mesh, angles).len();
    let mut matrix = DMatrix::zeros(count, 3 * angles.len());
    for i in 0..3 * angles.len() {
        let shifted = |by: f64| {
            let mut angles = angles.to_vec();
            angles.as_flattened_mut()[i] += by;
            DVector::from_vec(conditions(mesh, &angles))
        };
        matrix.set_column(i, &((shifted(STEP) - shifted(-STEP)) / (2.0 * STEP)));
    }
    matrix
}

#[test]
fn no_angles_near_by_that_meet_the_conditions_have_less_energy() {
    for (name, mesh) in curved_meshes().into_iter().filter(|(_, mesh)| mesh.face_count() < 150) {
        let found = solved(&mesh, AngleSystem::Reduced, &name);
        let targets = targets(&mesh);
        let pairs = || found.angles.as_flattened().iter().zip(targets.as_flattened());
        let energy: f64 = pairs().map(|(angle, target)| (angle / target - 1.0).powi(2)).sum();
        assert!((energy - found.energy).abs() < 1e-9 * (1.0 + energy), "{name}: {energy} and {}", found.energy);
        let gradient = pairs().map(|(angle, target)| 2.0 * (angle / target - 1.0) / target);
        let gradient = DVector::from_iterator(3 * mesh.face_count(), gradient);
        // Component of the gradient that the conditions leave free; it would lower the energy.
        let conditions = jacobian(&mesh, &found.angles);
        let multipliers =
            (&conditions * conditions.transpose()).cholesky().expect("independent").solve(&(&conditions * &gradient));
        let free = &gradient - conditions.transpose() * multipliers;
        assert!(free.norm() < 1e-7 * (1.0 + gradient.norm()), "{name}: {:e} of {}", free.norm(), gradient.norm());
    }
}

#[test]
fn the_layout_has_these_angles_and_every_face_is_positive() {
    for (name, mesh) in curved_meshes() {
        let found = solved(&mesh, AngleSystem::Reduced, &name);
        let embedding = &found.solution.embedding;
        let summary = verdict(&mesh, embedding);
        assert!(summary.flipped_faces.is_empty() && !summary.mirrored, "{name}: {}", summary.summary());
        for (face, angles) in mesh.faces().zip(&found.angles) {
            let z = embedding.corners(&mesh, face);
            for k in 0..3 {
                let angle = (z[(k + 1) % 3] - z[k]).angle_to(z[(k + 2) % 3] - z[k]);
                assert!((angle - angles[k]).abs() < 1e-8, "{name}, face {face}: {angle} for {}", angles[k]);
            }
        }
    }
}

#[test]
fn planar_meshes_come_back_up_to_similarity() {
    for seed in 0..6 {
        for flat in Flat::of_seed(seed).into_iter().chain(Flat::strips_of_seed(seed)) {
            for system in [AngleSystem::Full, AngleSystem::Reduced] {
                let found = solved(&flat.mesh, system, &flat.name);
                let error = distance_up_to_similarity(&flat.plane, &found.solution.embedding);
                let convergence = found.solution.convergence.unwrap();
                assert!(error < 1e-9, "{}, {system:?}: off by {error:e}, {convergence:?}", flat.name);
                assert_eq!(convergence.stop, Stop::Converged);
                assert!(convergence.steps <= 2 && found.energy < 1e-15, "{}: {convergence:?}", flat.name);
            }
        }
    }
}

#[test]
fn disks_without_an_inner_vertex_keep_every_angle() {
    let mut bent = grid(1, 6);
    bent.positions.iter_mut().for_each(|x| x.z = (3.0 * x.y).sin());
    let folded = disk(bent);
    let triangle = disk(stacked(3, 1, &mut Random(0)));
    for (name, mesh) in [("a folded strip", folded), ("a triangle", triangle)] {
        for system in [AngleSystem::Full, AngleSystem::Reduced] {
            let found = solved(&mesh, system, name);
            let off: Vec<f64> =
                found.angles.as_flattened().iter().zip(targets(&mesh).as_flattened()).map(|(a, b)| a - b).collect();
            assert!(largest(&off) < 1e-7 && found.energy < 1e-14, "{name}, {system:?}: {:e}", largest(&off));
        }
    }
}

#[test]
fn as_methods_they_are_one_step_with_a_note_and_a_verdict() {
    let mesh = disk(sheet(8, 0.5));
    for (method, stage) in [(Method::Abf, Stage::Abf), (Method::AbfPlusPlus, Stage::AbfPlusPlus)] {
        let steps = steps(&mesh, method, Pins::new()).unwrap();
        assert_eq!((steps.len(), steps[0].candidate.stage.clone()), (1, stage));
        assert!(steps[0].verdict.planar && !steps[0].verdict.mirrored, "{}", steps[0].verdict.summary());
        let candidate = &steps[0].candidate;
        assert_eq!(candidate.solution.convergence.map(|found| found.stop), Some(Stop::Converged));
        assert!(candidate.note.is_some());
    }
}

#[test]
fn two_pins_only_place_it_and_three_are_refused() {
    let mesh = disk(sheet(8, 0.5));
    let targets = [(0, [0.25, 0.5]), (44, [-3.0, 0.125]), (80, [1.0, 1.0])];
    let pins = |count: usize| hard_pins(targets[..count].iter().map(|&(v, at)| (VertexId::new(v), DVec2::from(at))));
    for method in [Method::Abf, Method::AbfPlusPlus] {
        let free = &steps(&mesh, method.clone(), Pins::new()).unwrap()[0];
        for count in [1, 2] {
            let placed = &steps(&mesh, method.clone(), pins(count)).unwrap()[0];
            for (vertex, target) in &targets[..count] {
                assert_eq!(placed.candidate.solution.embedding[*vertex as usize], DVec2::from(*target));
            }
            let error =
                distance_up_to_similarity(&free.candidate.solution.embedding, &placed.candidate.solution.embedding);
            assert!(error < 1e-12, "{count} pins changed the shape by {error:e}");
        }
        assert_eq!(
            steps(&mesh, method.clone(), pins(3)).err(),
            Some(SolveError::TooManyPins { method: method.labels().title, count: 3, most: 2 })
        );
    }
}

#[test]
fn a_raised_flag_stops_it() {
    let flag = std::sync::atomic::AtomicBool::new(true);
    let outcome = angle_based(&disk(sheet(4, 0.5)), AngleSystem::Reduced, Control::new(&flag, &|_| {}));
    assert_eq!(outcome.err(), Some(SolveError::Cancelled));
}

fn assert_every_disk_has_an_honest_end(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        let start = std::time::Instant::now();
        let found = solved(&mesh, AngleSystem::Reduced, &entry.file);
        let convergence = found.solution.convergence.unwrap();
        let summary = verdict(&mesh, &found.solution.embedding).summary();
        println!(
            "{}: {convergence:?}, energy {:.3e}, held {}, {:.1} s: {summary}",
            entry.file,
            found.energy,
            found.held,
            start.elapsed().as_secs_f64()
        );
        assert!(found.solution.embedding.check_finite().is_ok(), "{}", entry.file);
        let is_met = convergence.residual < 1e-8;
        assert!(is_met || convergence.stop != Stop::Converged, "{}: {convergence:?}", entry.file);
        assert!(found.angles.as_flattened().iter().all(|&angle| angle > 0.0 && angle < PI), "{}", entry.file);
    }
}

#[test]
fn every_disk_of_tests_data_has_an_honest_end() {
    assert_every_disk_has_an_honest_end(data_disks());
}

corpus_test! {
    fn every_disk_of_the_corpus_has_an_honest_end() {
        assert_every_disk_has_an_honest_end(corpus_disks());
    }
}

#[test]
fn angles_of_a_bumpy_cap_are_nearer_to_the_surface_than_conformal_ones() {
    let mesh = disk(BuiltIn::BumpyCap.mesh());
    let found = solved(&mesh, AngleSystem::Reduced, "a bumpy cap");
    let settings = Settings::new(Method::Natural, Family::Conformal);
    let natural =
        freebound_core::flatten::solve_once(&mesh, &settings, &Pins::new(), Control::unattended()).unwrap().embedding;
    let targets = targets(&mesh);
    let energy: f64 = mesh
        .faces()
        .zip(&targets)
        .map(|(face, targets)| {
            let z = natural.corners(&mesh, face);
            let angle = |k: usize| (z[(k + 1) % 3] - z[k]).angle_to(z[(k + 2) % 3] - z[k]);
            (0..3).map(|k| (angle(k) / targets[k] - 1.0).powi(2)).sum::<f64>()
        })
        .sum();
    assert!(found.energy < energy, "{} and {energy}", found.energy);
}
