//! Spectral conformal maps: agreement with a dense eigensolver, no more energy than with pins, and no pin.

use freebound_core::flatten::{Flattener, Step, equation_of_step, solve_once};
use freebound_core::linear::spectral;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, NoEquation, Pins, Settings, SolveError, Stop, hard_pins,
};
use freebound_core::weights::equations;
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use num_complex::Complex;

use super::flat::Flat;
use super::reproduction::distance_up_to_similarity;
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, data_disks, disk, fan, sheet, stacked, steps, tube};

type C64 = Complex<f64>;

fn complex(z: DVec2) -> C64 {
    C64::new(z.x, z.y)
}

/// Matrix L as a dense matrix, over all vertices of a mesh without unused ones.
fn energy_matrix(mesh: &DiskMesh) -> DMatrix<C64> {
    let equations = equations::natural(mesh, Family::CONFORMAL_POWER, Control::unattended()).unwrap();
    let mut matrix = DMatrix::zeros(mesh.vertex_count(), mesh.vertex_count());
    for (link, &a) in mesh.links().zip(&equations.coefficients) {
        let (tail, head) = (mesh.tail(link).index(), mesh.head(link).index());
        matrix[(tail, tail)] += a;
        matrix[(tail, head)] -= a;
    }
    matrix
}

/// Energy z* L z, from the equations.
fn energy(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let equations = equations::natural(mesh, Family::CONFORMAL_POWER, Control::unattended()).unwrap();
    let work = |v: VertexId| -(complex(embedding[v]).conj() * equations.residual_of(mesh, embedding, v)).re;
    mesh.vertices().map(work).sum()
}

/// Energy at boundary norm 1, with the boundary centred at the origin.
fn energy_at_boundary_norm(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let boundary = embedding.boundary(mesh);
    let mean = boundary.iter().sum::<DVec2>() / boundary.len() as f64;
    let norm: f64 = boundary.iter().map(|z| z.distance_squared(mean)).sum();
    energy(mesh, embedding) / norm
}

/// Least eigenvalue except that of constants, and its eigenvector. With the inside eliminated, the problem is an
/// ordinary eigenproblem on the boundary.
fn dense_answer(mesh: &DiskMesh) -> (f64, Vec<C64>) {
    let matrix = energy_matrix(mesh);
    let boundary: Vec<usize> = mesh.boundary_loop().iter().map(|v| v.index()).collect();
    let inside: Vec<usize> = (0..mesh.vertex_count()).filter(|v| !boundary.contains(v)).collect();
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
    };
    let follow = if inside.is_empty() {
        DMatrix::zeros(0, boundary.len())
    } else {
        -part(&inside, &inside).lu().solve(&part(&inside, &boundary)).expect("definite")
    };
    let schur = part(&boundary, &boundary) + part(&boundary, &inside) * &follow;
    let schur = (&schur + schur.adjoint()) * C64::from(0.5);
    let far = 1e3 * schur.norm();
    let constants = DMatrix::from_element(boundary.len(), boundary.len(), C64::from(far / boundary.len() as f64));
    let eigen = SymmetricEigen::new(schur + constants);
    let least = eigen.eigenvalues.imin();
    let on_boundary: DVector<C64> = eigen.eigenvectors.column(least).into();
    let inner = follow * &on_boundary;
    let mut vector = vec![C64::ZERO; mesh.vertex_count()];
    boundary.iter().zip(on_boundary.iter()).for_each(|(&v, &z)| vector[v] = z);
    inside.iter().zip(inner.iter()).for_each(|(&v, &z)| vector[v] = z);
    (eigen.eigenvalues[least], vector)
}

fn curved_meshes() -> Vec<(String, DiskMesh)> {
    let mut random = Random(7);
    let mut meshes: Vec<(String, DiskMesh)> = vec![
        ("a sheet".into(), disk(sheet(6, 0.4))),
        ("a bent sheet".into(), disk(sheet(9, 1.5))),
        ("a tube".into(), disk(tube(5, 4))),
        ("a tube of triangles".into(), disk(tube(3, 7))),
        ("a dome".into(), DiskMesh::try_from(BuiltIn::Dome.mesh()).unwrap()),
    ];
    for count in [5, 9, 30] {
        let mut mesh = stacked(count, 4, &mut random);
        mesh.positions.iter_mut().for_each(|x| x.z += 0.2 * random.unit());
        meshes.push((format!("{count} stacked"), disk(mesh)));
    }
    meshes
}

#[test]
fn it_is_the_eigenvector_that_a_dense_solver_finds() {
    for (name, mesh) in curved_meshes().into_iter().filter(|(_, mesh)| mesh.vertex_count() < 400) {
        let found = spectral(&mesh, Control::unattended()).unwrap();
        let (eigenvalue, vector) = dense_answer(&mesh);
        let off = (found.eigenvalue - eigenvalue).abs();
        assert!(off < 1e-9 * eigenvalue + 1e-13, "{name}: {} for {eigenvalue}", found.eigenvalue);
        let plane: Vec<DVec2> = vector.iter().map(|z| DVec2::new(z.re, z.im)).collect();
        let error = distance_up_to_similarity(&plane, &found.solution.embedding);
        assert!(error < 1e-8, "{name}: off by {error:e}");
        let linear = found.solution.linear.unwrap();
        assert!(linear.residual < 1e-12, "{name}: {:e}", linear.residual);
        let convergence = found.solution.convergence.unwrap();
        assert_eq!(convergence.stop, Stop::Converged, "{name}: {convergence:?}");
        assert!(convergence.steps <= 40, "{name}: {convergence:?}");
    }
}

#[test]
fn it_has_its_boundary_around_the_origin_at_norm_one_and_the_energy_that_it_says() {
    for (name, mesh) in curved_meshes() {
        let found = spectral(&mesh, Control::unattended()).unwrap();
        let boundary = found.solution.embedding.boundary(&mesh);
        let norm: f64 = boundary.iter().map(|z| z.length_squared()).sum();
        let mean = boundary.iter().sum::<DVec2>() / boundary.len() as f64;
        assert!((norm - 1.0).abs() < 1e-12 && mean.length() < 1e-12, "{name}: {norm}, {mean}");
        let energy = energy(&mesh, &found.solution.embedding);
        assert!((energy - found.eigenvalue).abs() <= 1e-12, "{name}: {energy} for {}", found.eigenvalue);
    }
}

#[test]
fn no_two_pins_give_a_map_of_less_energy() {
    let mut random = Random(3);
    for (name, mesh) in curved_meshes() {
        let found = spectral(&mesh, Control::unattended()).unwrap();
        let mut pairs = vec![Pins::new()];
        for _ in 0..6 {
            let count = u32::try_from(mesh.vertex_count()).unwrap();
            let first = random.below(count);
            let second = (first + 1 + random.below(count - 1)) % count;
            pairs.push(hard_pins([(VertexId::new(first), DVec2::ZERO), (VertexId::new(second), DVec2::X)]));
        }
        for pins in pairs {
            let settings = Settings::new(Method::Natural, Family::Conformal);
            let natural = solve_once(&mesh, &settings, &pins, Control::unattended()).unwrap().embedding;
            let energy = energy_at_boundary_norm(&mesh, &natural);
            assert!(
                energy >= found.eigenvalue * (1.0 - 1e-9),
                "{name}: {energy} with pins, {} without",
                found.eigenvalue
            );
        }
    }
}

#[test]
fn planar_meshes_come_back_up_to_similarity() {
    for seed in 0..6 {
        for flat in Flat::of_seed(seed).into_iter().chain(Flat::strips_of_seed(seed)) {
            let found = spectral(&flat.mesh, Control::unattended()).unwrap();
            let error = distance_up_to_similarity(&flat.plane, &found.solution.embedding);
            assert!(error < 1e-9, "{}: off by {error:e}, {:?}", flat.name, found.solution.convergence);
            assert!(found.eigenvalue < 1e-14, "{}: {}", flat.name, found.eigenvalue);
        }
    }
}

#[test]
fn the_smallest_disks_have_one() {
    for (name, mesh) in [("a triangle", disk(stacked(3, 1, &mut Random(0)))), ("a fan", disk(fan(3)))] {
        let found = spectral(&mesh, Control::unattended()).unwrap();
        assert!(found.solution.embedding.check_finite().is_ok() && found.eigenvalue < 1e-14, "{name}: {found:?}");
    }
}

#[test]
fn the_order_of_vertices_is_no_matter() {
    let mesh = sheet(7, 0.6);
    let expected = spectral(&disk(mesh.clone()), Control::unattended()).unwrap();
    let count = mesh.vertex_count();
    // Multiplies every number by 5, modulo the number of vertices, which 5 does not divide.
    let number = |v: usize| 5 * v % count;
    assert!(!count.is_multiple_of(5));
    let mut renumbered = mesh.clone();
    for (v, &x) in mesh.positions.iter().enumerate() {
        renumbered.positions[number(v)] = x;
    }
    for corner in renumbered.triangles.iter_mut().flatten() {
        *corner = VertexId::from_index(number(corner.index()));
    }
    let found = spectral(&disk(renumbered), Control::unattended()).unwrap();
    assert!((found.eigenvalue / expected.eigenvalue - 1.0).abs() < 1e-9);
    let plane: Vec<DVec2> = (0..count).map(|v| found.solution.embedding[number(v)]).collect();
    let error = distance_up_to_similarity(&plane, &expected.solution.embedding);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn as_a_method_it_is_one_step_with_a_note_and_a_verdict() {
    let steps = steps(&disk(sheet(8, 0.5)), Method::Spectral, Pins::new()).unwrap();
    assert_eq!(steps.len(), 1);
    assert!(steps[0].verdict.planar && !steps[0].verdict.mirrored, "{}", steps[0].verdict.summary());
    let candidate = &steps[0].candidate;
    assert_eq!(candidate.solution.convergence.map(|found| found.stop), Some(Stop::Converged));
    assert!(candidate.note.is_some());
}

#[test]
fn two_pins_only_place_it_and_three_are_refused() {
    let mesh = disk(sheet(8, 0.5));
    let targets = [(0, [0.25, 0.5]), (44, [-3.0, 0.125]), (80, [1.0, 1.0])];
    let pins = |count: usize| hard_pins(targets[..count].iter().map(|&(v, at)| (VertexId::new(v), DVec2::from(at))));
    let free = &steps(&mesh, Method::Spectral, Pins::new()).unwrap()[0];
    for count in [1, 2] {
        let placed = &steps(&mesh, Method::Spectral, pins(count)).unwrap()[0];
        for (vertex, target) in &targets[..count] {
            assert_eq!(placed.candidate.solution.embedding[*vertex as usize], DVec2::from(*target));
        }
        let error = distance_up_to_similarity(&free.candidate.solution.embedding, &placed.candidate.solution.embedding);
        assert!(error < 1e-12, "{count} pins changed the shape by {error:e}");
    }
    assert_eq!(
        steps(&mesh, Method::Spectral, pins(3)).err(),
        Some(SolveError::TooManyPins { method: "Spectral conformal", count: 3, most: 2 })
    );
    let beyond = hard_pins([(VertexId::new(999), DVec2::ZERO)]);
    assert_eq!(steps(&mesh, Method::Spectral, beyond).err().map(|error| error.name()), Some("no-such-vertex"));
}

#[test]
fn a_raised_flag_stops_it() {
    let flag = std::sync::atomic::AtomicBool::new(true);
    let outcome = spectral(&disk(sheet(4, 0.5)), Control::new(&flag, &|_| {}));
    assert_eq!(outcome.err(), Some(SolveError::Cancelled));
}

fn assert_every_disk_has_one_of_no_more_energy_than_two_pins_give(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        let found = spectral(&mesh, Control::unattended()).unwrap_or_else(|error| panic!("{}: {error}", entry.file));
        let (linear, convergence) = (found.solution.linear.unwrap(), found.solution.convergence.unwrap());
        println!(
            "{}: {:.3e}, {convergence:?}, {:.1e}, {:.2} s",
            entry.file,
            found.eigenvalue,
            linear.residual,
            found.solution.seconds.total()
        );
        assert!(linear.residual < 1e-10, "{}: {:e}", entry.file, linear.residual);
        assert_eq!(convergence.stop, Stop::Converged, "{}: {convergence:?}", entry.file);
        let settings = Settings::new(Method::Natural, Family::Conformal);
        let natural = solve_once(&mesh, &settings, &Pins::new(), Control::unattended()).unwrap().embedding;
        let energy = energy_at_boundary_norm(&mesh, &natural);
        // The energy of a flat disk is zero up to rounding, of either sign.
        let rounding = 1e-15;
        assert!(
            energy >= found.eigenvalue * (1.0 - 1e-6) - rounding,
            "{}: {energy} for {}",
            entry.file,
            found.eigenvalue
        );
    }
}

#[test]
fn every_disk_of_tests_data_has_one_of_no_more_energy_than_two_pins_give() {
    assert_every_disk_has_one_of_no_more_energy_than_two_pins_give(data_disks());
}

corpus_test! {
    fn every_disk_of_the_corpus_has_one_of_no_more_energy_than_two_pins_give() {
        assert_every_disk_has_one_of_no_more_energy_than_two_pins_give(corpus_disks());
    }
}

/// First step of method auto.
fn auto(mesh: &DiskMesh, pins: &Pins) -> Step {
    Flattener::new(Settings::default(), pins.clone()).step(mesh, Control::unattended()).expect("solvable")
}

#[test]
fn without_pins_method_auto_begins_with_it_found_with_factors_of_two_pins() {
    let built_in = [BuiltIn::Face, BuiltIn::BumpyCap].map(|built_in| disk(built_in.mesh()));
    for (name, mesh) in curved_meshes().into_iter().chain(built_in.map(|mesh| ("built-in".to_owned(), mesh))) {
        let found = spectral(&mesh, Control::unattended()).unwrap();
        let step = auto(&mesh, &Pins::new());
        let (solution, other) = (&step.candidate.solution, &found.solution.embedding);
        let error = distance_up_to_similarity(&solution.embedding, other);
        assert!(error < 1e-6, "{name}: off by {error:e}");
        let linear = solution.linear.unwrap();
        assert!(linear.residual < 1e-7, "{name}: {:e}", linear.residual);
        let convergence = solution.convergence.unwrap();
        assert!(convergence.stop == Stop::Converged && convergence.steps <= 40, "{name}: {convergence:?}");
    }
}

#[test]
fn its_boundary_has_no_equation_of_its_own_and_its_inside_has() {
    let mesh = disk(sheet(6, 0.4));
    let step = auto(&mesh, &Pins::new());
    assert!(step.is_spectral());
    for vertex in mesh.vertices() {
        let equation = equation_of_step(&mesh, &step, None, vertex);
        if mesh.boundary_place(vertex).is_some() {
            assert_eq!(equation.map(|_| ()), Err(NoEquation::OfEigenvector), "{vertex}");
        } else {
            equation.expect("an inner vertex has one");
        }
    }
}

#[test]
fn a_single_pin_only_places_the_map_of_method_auto() {
    for (name, mesh) in curved_meshes() {
        let free = auto(&mesh, &Pins::new());
        let vertex = VertexId::from_index(mesh.vertex_count() / 2);
        let target = DVec2::new(-3.0, 7.5);
        let pinned = auto(&mesh, &hard_pins([(vertex, target)]));
        assert_eq!(pinned.candidate.solution.embedding[vertex], target, "{name}");
        let by = target - free.candidate.solution.embedding[vertex];
        for (&free, pinned) in free.candidate.solution.embedding.iter().zip(pinned.candidate.solution.embedding.iter())
        {
            assert!((free + by).distance(*pinned) < 1e-9, "{name}: {free} and {pinned}");
        }
    }
}

/// Sheet that is its own mirror image for x → −x, with the reflection of each vertex.
fn mirror_symmetric(half: u32, rows: u32) -> (DiskMesh, Vec<usize>) {
    let width = 2 * half + 1;
    let (mut positions, mut triangles, mut mirror) = (Vec::new(), Vec::<[u32; 3]>::new(), Vec::new());
    for row in 0..=rows {
        for column in 0..width {
            let (x, y) = (f64::from(column) - f64::from(half), f64::from(row));
            let height = 1.5 * (0.9 * x.abs() + 0.4 * y).sin() + 0.03 * x * x * y;
            positions.push(DVec3::new(x * (1.0 + 0.1 * y), y, height));
            mirror.push((row * width + width - 1 - column) as usize);
        }
    }
    for row in 0..rows {
        for column in 0..width - 1 {
            let a = row * width + column;
            let (b, c, d) = (a + 1, a + width + 1, a + width);
            let of_right = [[a, b, c], [a, c, d]];
            let of_left = [[a, b, d], [b, c, d]];
            triangles.extend(if column < half { of_left } else { of_right });
        }
    }
    (disk(TriMesh::new(positions, &triangles)), mirror)
}

#[test]
fn a_mirror_symmetric_mesh_has_a_mirror_symmetric_map_by_default() {
    for (half, rows) in [(1, 3), (4, 6), (7, 3), (20, 30)] {
        let (mesh, mirror) = mirror_symmetric(half, rows);
        let embedding = auto(&mesh, &Pins::new()).candidate.solution.embedding;
        let reflected: Vec<DVec2> =
            mirror.iter().map(|&v| embedding[VertexId::from_index(v)] * DVec2::new(-1.0, 1.0)).collect();
        let error = distance_up_to_similarity(&reflected, &embedding);
        assert!(error < 1e-6, "{half} and {rows}: off by {error:e}");
    }
}

#[test]
fn flat_sheets_keep_the_map_with_two_pins_to_rounding() {
    for mesh in [disk(sheet(5, 0.0)), disk(sheet(20, 0.0))] {
        let plane: Vec<DVec2> = mesh.mesh().positions.iter().map(|x| x.truncate()).collect();
        let natural = Settings::new(Method::Natural, Family::default());
        let pinned = solve_once(&mesh, &natural, &Pins::new(), Control::unattended()).expect("solvable");
        let step = auto(&mesh, &Pins::new());
        let [with, without] = [&pinned.embedding, &step.candidate.solution.embedding]
            .map(|embedding| distance_up_to_similarity(&plane, embedding));
        assert!(without < 3.0 * with + 1e-14, "off by {without:e} instead of {with:e}");
    }
}
