//! Natural boundary (paper §3.3) on the corpus, against independent solves; repeatability.

use std::sync::atomic::AtomicBool;

use faer::Mat;
use faer::linalg::solvers::Solve as _;
use freebound_core::flatten::{Flattener, Prepared, solve_once};
use freebound_core::linalg::{Analysis, Kind, LinalgError};
use freebound_core::linear::FreeSystem;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, NamedOption as _, Pins, Settings, SolveError, fixed_pins, gauge_pins, hard_pins,
};
use freebound_core::verify::verdict;
use freebound_core::weights::equations;
use freebound_core::weights::equations::Equations;
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};
use num_complex::Complex;

use super::reproduction::distance_up_to_similarity;
use crate::weights::families::free_methods;
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, data_disks, disk};

/// Largest relative residual of a solve: the limit.
const RESIDUAL: f64 = 1e-10;

/// Largest relative residual of the LU after refinement: the limit.
const LU_RESIDUAL: f64 = 1e-12;

/// The only disk of the corpus that the conformal natural boundary folds.
const FOLDED: &str = "cow_seamster.obj";

/// Largest residual of a flattening by LU, relative to the few entries that pins put on the right-hand side. These
/// few make ‖b‖ far smaller than ‖A‖ ‖z‖; the largest on the corpus is 2.5e-12.
const LU_RESIDUAL_OF_FLATTENING: f64 = 5e-12;

/// Largest error of manufactured solutions of size 1: ε times a condition number.
const MANUFACTURED: f64 = 1e-9;

/// Corridors two triangles wide, in total thousands of times longer than wide. The unsymmetric systems there are
/// singular in 64 bits for nearly all pairs of pins, the default ones included, and must fail with an error: see
/// `gauge`.
const CORRIDORS: &str = "maze.obj";

/// Largest mesh solved with a dense matrix, vertices.
const DENSE_LIMIT: usize = 1000;

fn natural(family: Family) -> Settings {
    Settings::new(Method::Natural, family)
}

fn extent(points: &[DVec2]) -> f64 {
    let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    (high - low).max_element()
}

/// Largest distance between two embeddings, relative to their extent.
fn distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / extent(b)
}

fn bits(embedding: &Embedding) -> Vec<[u64; 2]> {
    embedding.iter().map(|z| z.to_array().map(f64::to_bits)).collect()
}

fn built_in(examples: &[BuiltIn]) -> Vec<(String, DiskMesh)> {
    examples.iter().map(|example| (example.name().to_owned(), disk(example.mesh()))).collect()
}

corpus_test! {
    fn conformal_flattens_all_disks_of_the_corpus_and_proves_all_but_one() {
        for entry in corpus_disks() {
            let mesh = entry.disk();
            let solution = solve_once(&mesh, &natural(Family::Conformal), &Pins::new(), Control::unattended()).unwrap();
            assert!(solution.embedding.iter().all(|z| z.is_finite()), "{}", entry.file);
            assert!(
                solution.linear.unwrap().residual <= RESIDUAL,
                "{}: {:e}",
                entry.file,
                solution.linear.unwrap().residual
            );
            assert_eq!(
                (solution.linear.unwrap().replaced_pivots, solution.linear.unwrap().bounded_corners),
                (0, 0),
                "{}",
                entry.file
            );
            let verdict = verdict(&mesh, &solution.embedding);
            assert!(!verdict.mirrored, "{}", entry.file);
            if entry.file == FOLDED {
                assert!(!verdict.planar && !verdict.boundary_crossings.is_empty());
            } else {
                assert!(verdict.planar, "{}: {}", entry.file, verdict.summary());
                assert_eq!(verdict.turning_number, Some(1), "{}", entry.file);
            }
        }
    }
}

fn assert_lscm_is_the_conformal_natural_boundary(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        let [lscm, natural] = [Method::Lscm, Method::Natural].map(|method| {
            let settings = Settings::new(method, Family::Conformal);
            solve_once(&mesh, &settings, &Pins::new(), Control::unattended()).unwrap().embedding
        });
        let error = distance(&lscm, &natural);
        // The system of the corridors is nearly singular. Both formulas round its entries differently, and this
        // alone moves the solution by 3e-8.
        let limit = if entry.file == CORRIDORS { 1e-7 } else { 1e-9 };
        assert!(error <= limit, "{}: {error:e}", entry.file);
    }
}

#[test]
fn lscm_is_the_conformal_natural_boundary() {
    assert_lscm_is_the_conformal_natural_boundary(data_disks());
}

corpus_test! {
    fn lscm_is_the_conformal_natural_boundary_in_the_corpus() {
        assert_lscm_is_the_conformal_natural_boundary(corpus_disks());
    }
}

fn assert_the_conformal_matrix_is_hermitian_bit_for_bit(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        let equations = equations::natural(&mesh, Family::CONFORMAL_POWER, Control::unattended()).unwrap();
        let pins = fixed_pins(gauge_pins(&mesh));
        let matrix = FreeSystem::new(&mesh, |v| pins.contains_key(&v), Control::unattended())
            .unwrap()
            .negated_matrix(&mesh, &equations, Control::unattended())
            .unwrap();
        for (row, column, value) in matrix.triplet_iter() {
            let mirror = matrix.get_entry(column, row).expect("the pattern is symmetric").into_value();
            // Adding zero gives both zeros one bit pattern.
            let same = (mirror.re + 0.0).to_bits() == (value.re + 0.0).to_bits()
                && (-mirror.im + 0.0).to_bits() == (value.im + 0.0).to_bits();
            assert!(same, "{name}: entry ({row}, {column}) is {value}, its mirror {mirror}");
        }
    }
}

#[test]
fn the_conformal_matrix_is_hermitian_bit_for_bit() {
    assert_the_conformal_matrix_is_hermitian_bit_for_bit(built_in(&BuiltIn::ALL));
}

corpus_test! {
    fn the_conformal_matrix_is_hermitian_bit_for_bit_in_the_corpus() {
        assert_the_conformal_matrix_is_hermitian_bit_for_bit(corpus_disks().iter().map(Entry::named_disk).collect());
    }
}

/// Contribution of a corner to the family's identity (DESIGN §1), term by term from the angle: factors of z₀, z₁,
/// z₂.
pub(crate) fn corner_terms(x: [DVec3; 3], settings: &Settings) -> [Complex<f64>; 3] {
    let (u, w) = (x[1] - x[0], x[2] - x[0]);
    let (r1, r2, angle) = (u.length(), w.length(), u.angle_between(w));
    if settings.method == Method::Levy {
        let (of1, of2) = (-Complex::from_polar(1.0, angle), Complex::from(r1 / r2));
        return [-of1 - of2, of1, of2];
    }
    let power = settings.family().power().expect("well-formed by construction");
    let (d1, d2) = (r1.powf(power), r2.powf(power));
    let (sin, cot) = (angle.sin(), 1.0 / angle.tan());
    let of1 = Complex::new((d2 / sin - d1 * cot) / r1, -d1 / r1);
    let of2 = Complex::new((d1 / sin - d2 * cot) / r2, d2 / r2);
    [-of1 - of2, of1, of2]
}

/// Solves with a dense matrix, assembled corner by corner.
fn dense_solution(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> Embedding {
    let n = mesh.vertex_count();
    let mut matrix = Mat::<Complex<f64>>::zeros(n, n);
    for face in mesh.faces() {
        let v = mesh.face(face);
        for k in 0..3 {
            let corner = [v[k], v[(k + 1) % 3], v[(k + 2) % 3]];
            let terms = corner_terms(corner.map(|v| mesh.position(v)), settings);
            for (of, term) in corner.iter().zip(terms) {
                matrix[(corner[0].index(), of.index())] += term;
            }
        }
    }
    let mut right = Mat::<Complex<f64>>::zeros(n, 1);
    for (vertex, pin) in pins {
        let row = vertex.index();
        matrix.row_mut(row).fill(Complex::ZERO);
        matrix[(row, row)] = Complex::ONE;
        right[(row, 0)] = Complex::new(pin.target.x, pin.target.y);
    }
    for row in 0..n {
        let largest = (0..n).map(|column| matrix[(row, column)].norm()).fold(0.0, f64::max);
        for column in 0..n {
            matrix[(row, column)] /= largest;
        }
        right[(row, 0)] /= largest;
    }
    let solved = matrix.partial_piv_lu().solve(&right);
    (0..n).map(|row| DVec2::new(solved[(row, 0)].re, solved[(row, 0)].im)).collect()
}

fn assert_a_dense_solve_written_corner_by_corner_agrees(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes.into_iter().filter(|(_, mesh)| mesh.vertex_count() <= DENSE_LIMIT) {
        let pins = fixed_pins(gauge_pins(&mesh));
        for settings in free_methods() {
            let found = solve_once(&mesh, &settings, &pins, Control::unattended()).unwrap().embedding;
            let error = distance(&found, &dense_solution(&mesh, &settings, &pins));
            assert!(error <= 1e-9, "{name}, {settings:?}: {error:e}");
        }
    }
}

#[test]
fn a_dense_solve_written_corner_by_corner_agrees() {
    assert_a_dense_solve_written_corner_by_corner_agrees(built_in(&[BuiltIn::Dome, BuiltIn::Ell]));
}

corpus_test! {
    fn a_dense_solve_written_corner_by_corner_agrees_in_the_corpus() {
        assert_a_dense_solve_written_corner_by_corner_agrees(corpus_disks().iter().map(Entry::named_disk).collect());
    }
}

/// Unsymmetric systems with a free boundary.
fn unsymmetric(mesh: &DiskMesh) -> [(&'static str, Equations<Complex<f64>>); 3] {
    [
        ("mean value", equations::natural(mesh, 0.0, Control::unattended()).expect("well-formed by construction")),
        ("Wachspress", equations::natural(mesh, -1.0, Control::unattended()).expect("well-formed by construction")),
        ("Lévy", equations::levy(mesh, Control::unattended()).expect("well-formed by construction")),
    ]
}

corpus_test! {
    fn the_lu_finds_manufactured_solutions_on_the_disks_of_the_corpus() {
        for entry in corpus_disks() {
            let mesh = entry.disk();
            let pins = fixed_pins(gauge_pins(&mesh));
            let system = FreeSystem::new(&mesh, |v| pins.contains_key(&v), Control::unattended()).unwrap();
            let analysis = Analysis::new(Kind::General, &system.pattern(), &AtomicBool::new(false)).unwrap();
            let mut random = Random(11);
            let wanted: Vec<Complex<f64>> =
                system.free().iter().map(|_| Complex::new(random.unit() - 0.5, random.unit() - 0.5)).collect();
            for (name, equations) in unsymmetric(&mesh) {
                let matrix = system.negated_matrix(&mesh, &equations, Control::unattended()).unwrap();
                let mut right = vec![Complex::ZERO; wanted.len()];
                for (row, column, value) in matrix.triplet_iter() {
                    right[row] += value * wanted[column];
                }
                let solved = analysis
                    .factor(&matrix, &AtomicBool::new(false))
                    .and_then(|f| f.solve(&matrix, &right, &AtomicBool::new(false)));
                if entry.file == CORRIDORS {
                    assert!(matches!(solved, Err(LinalgError::Singular { .. })), "{name}: {solved:?}");
                    continue;
                }
                let solved = solved.unwrap_or_else(|error| panic!("{}, {name}: {error}", entry.file));
                let error = solved.x.iter().zip(&wanted).map(|(x, w)| (x - w).norm()).fold(0.0, f64::max);
                assert!(solved.residual <= LU_RESIDUAL, "{}, {name}: residual {:e}", entry.file, solved.residual);
                assert!(error <= MANUFACTURED, "{}, {name}: off by {error:e}", entry.file);
            }
        }
    }
}

corpus_test! {
    fn the_free_unsymmetric_methods_solve_the_disks_of_the_corpus() {
        let families = [Family::MeanValue, Family::Wachspress].map(natural);
        let levy = Settings { method: Method::Levy, ..Settings::default() };
        for entry in corpus_disks() {
            let mesh = entry.disk();
            for settings in families.clone().into_iter().chain([levy.clone()]) {
                let solved = solve_once(&mesh, &settings, &Pins::new(), Control::unattended());
                // Its squares add a solution of the Wachspress equations, as alternating diagonals do: see `gauge`.
                if entry.file == CORRIDORS && settings.family() == Family::Wachspress {
                    assert!(matches!(solved, Err(SolveError::Singular { .. })), "{settings:?}");
                    continue;
                }
                let solution = solved.unwrap_or_else(|error| panic!("{}, {settings:?}: {error}", entry.file));
                assert!(solution.embedding.iter().all(|z| z.is_finite()), "{}, {settings:?}", entry.file);
                assert!(
                    solution.linear.unwrap().residual <= LU_RESIDUAL_OF_FLATTENING,
                    "{}, {settings:?}: {:e}",
                    entry.file,
                    solution.linear.unwrap().residual
                );
            }
        }
    }
}

fn face() -> DiskMesh {
    DiskMesh::try_from(BuiltIn::Face.mesh()).expect("well-formed by construction")
}

#[test]
fn a_preparation_used_again_gives_the_bits_of_a_fresh_solve() {
    let mesh = face();
    let at = |targets: [[f64; 2]; 3]| -> Pins {
        hard_pins([3, 500, 999].map(VertexId::new).into_iter().zip(targets.map(DVec2::from)))
    };
    let first = at([[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]]);
    let second = at([[0.1, 0.0], [-1.0, 5.0], [0.3, -0.8]]);
    for settings in free_methods() {
        let prepared = Prepared::new(&mesh, &settings, &first, Control::unattended()).unwrap();
        assert!(prepared.serves(&settings, &second));
        for pins in [&first, &second, &first] {
            let again = prepared.solve(&mesh, pins, Control::unattended()).unwrap();
            let fresh = solve_once(&mesh, &settings, pins, Control::unattended()).unwrap();
            assert_eq!(bits(&again.embedding), bits(&fresh.embedding), "{settings:?}");
            assert_eq!(
                again.linear.unwrap().residual.to_bits(),
                fresh.linear.unwrap().residual.to_bits(),
                "{settings:?}"
            );
        }
    }
}

#[test]
fn a_preparation_serves_only_its_own_settings_and_vertices() {
    let mesh = face();
    let pins =
        |list: &[u32]| -> Pins { hard_pins(list.iter().map(|&v| (VertexId::new(v), DVec2::new(f64::from(v), 1.0)))) };
    let settings = natural(Family::Conformal);
    let prepared = Prepared::new(&mesh, &settings, &pins(&[1, 5]), Control::unattended()).unwrap();
    assert!(prepared.serves(&settings, &pins(&[1, 5])));
    for others in [&[1, 6][..], &[1], &[], &[1, 5, 7]] {
        assert!(!prepared.serves(&settings, &pins(others)), "{others:?}");
    }
    assert!(!prepared.serves(&natural(Family::MeanValue), &pins(&[1, 5])));
    assert!(!prepared.serves(&Settings { method: Method::Lscm, ..settings }, &pins(&[1, 5])));
}

#[test]
fn two_runs_have_the_same_bits() {
    let mesh = face();
    for settings in free_methods() {
        let [a, b] = [(); 2].map(|()| solve_once(&mesh, &settings, &Pins::new(), Control::unattended()).unwrap());
        assert_eq!(bits(&a.embedding), bits(&b.embedding), "{settings:?}");
        assert_eq!(a.linear.unwrap().residual.to_bits(), b.linear.unwrap().residual.to_bits(), "{settings:?}");
    }
}

#[test]
fn a_flag_raised_before_stops_the_solve() {
    let (mesh, raised) = (face(), AtomicBool::new(true));
    let control = Control::new(&raised, &|_| {});
    for settings in free_methods() {
        let stopped = Prepared::new(&mesh, &settings, &Pins::new(), control).unwrap_err();
        assert_eq!(stopped, SolveError::Cancelled);
        let prepared = Prepared::new(&mesh, &settings, &Pins::new(), Control::unattended()).unwrap();
        assert_eq!(prepared.solve(&mesh, &Pins::new(), control).unwrap_err(), SolveError::Cancelled);
    }
}

#[test]
fn a_raised_flag_stops_the_sums_of_equations_and_the_making_of_their_system() {
    let (mesh, raised) = (face(), AtomicBool::new(true));
    let (stopped, free) = (Control::new(&raised, &|_| {}), Control::unattended());
    for power in [Family::CONFORMAL_POWER, 0.0] {
        assert_eq!(equations::natural(&mesh, power, stopped), Err(SolveError::Cancelled));
    }
    assert_eq!(equations::levy(&mesh, stopped), Err(SolveError::Cancelled));
    assert_eq!(equations::lscm(&mesh, stopped), Err(SolveError::Cancelled));
    let equations = equations::natural(&mesh, 0.0, free).unwrap();
    let flat = Embedding::from(vec![DVec2::ZERO; mesh.vertex_count()]);
    assert_eq!(equations.residual(&mesh, &flat, |_| true, stopped), Err(SolveError::Cancelled));
    assert_eq!(FreeSystem::new(&mesh, |_| false, stopped).unwrap_err(), SolveError::Cancelled);
    let system = FreeSystem::new(&mesh, |_| false, free).unwrap();
    assert_eq!(system.negated_matrix(&mesh, &equations, stopped), Err(SolveError::Cancelled));
}

#[test]
fn a_flag_raised_in_any_phase_stops_the_solve_there() {
    use std::sync::atomic::Ordering;
    let mesh = face();
    for settings in free_methods() {
        let phases = std::sync::Mutex::new(Vec::new());
        let listen = |phase| phases.lock().unwrap().push(phase);
        solve_once(&mesh, &settings, &Pins::new(), Control::new(&AtomicBool::new(false), &listen)).unwrap();
        let phases = phases.into_inner().unwrap();
        assert!(phases.len() >= 3, "{phases:?}");
        for last in &phases {
            let raised = AtomicBool::new(false);
            let hear = |phase| {
                raised.fetch_or(phase == *last, Ordering::Relaxed);
            };
            let stopped = solve_once(&mesh, &settings, &Pins::new(), Control::new(&raised, &hear)).unwrap_err();
            assert_eq!(stopped, SolveError::Cancelled, "{settings:?}, raised while {}", last.words());
        }
    }
}

#[test]
fn a_single_solve_is_the_first_step_of_its_method_or_refused() {
    let mesh = disk(BuiltIn::Dome.mesh());
    for method in Method::ALL {
        let settings = Settings { method: method.clone(), ..Settings::default() };
        let solved = solve_once(&mesh, &settings, &Pins::new(), Control::unattended());
        if method.is_one_to_one() {
            assert_eq!(solved, Err(SolveError::NoLinearSolve { method: method.labels().title }));
            continue;
        }
        let first = Flattener::new(settings.clone(), Pins::new()).step(&mesh, Control::unattended()).expect("solvable");
        let off = distance_up_to_similarity(&first.candidate.solution.embedding, &solved.expect("solvable").embedding);
        assert!(off < 1e-9, "{method:?}: {off:.1e}");
        let prepared = Prepared::new(&mesh, &settings, &Pins::new(), Control::unattended());
        assert_eq!(prepared.is_err(), method.only_places_pins(), "{method:?} has factors that serve pins, or none");
    }
    let three = hard_pins((0..3).map(|k| (mesh.boundary_loop()[3 * k], DVec2::new(k as f64, (k * k) as f64))));
    let settings = Settings::new(Method::Slim, Family::default());
    let refused = solve_once(&mesh, &settings, &three, Control::unattended());
    assert_eq!(refused, Err(SolveError::TooManyPins { method: "SLIM", count: 3, most: 2 }));
}
