//! Choice of the equations that a free boundary leaves out. Regular grids and corridors are reproduced, and the
//! default equations stay if they suffice.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use freebound_core::flatten::{Prepared, solve_once};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, Phase, Pins, Settings, Solution, SolveError, Treatment, gauge_pins, hard_pins,
};
use freebound_core::verify::verdict;
use freebound_testkit::BuiltIn;
use glam::{DQuat, DVec2, DVec3};

use super::reproduction::{distance_up_to_similarity, extent, real_matrix};
use crate::weights::families::free_methods;
use freebound_testkit::{corpus_disks, corpus_test, disk, shaped};

/// Largest distance of a vertex from its true position, relative to the extent: the limit.
const TOLERANCE: f64 = 1e-9;

/// Flat mesh and its positions in the plane.
struct Sheet {
    name: String,
    mesh: DiskMesh,
    plane: Embedding,
}

#[derive(Clone, Copy, Debug)]
enum Diagonals {
    OneWay,
    /// Alternating, like a chess board.
    Alternating,
}

/// Regular grid in the plane; `shear` slants its squares.
fn regular(columns: u32, rows: u32, diagonals: Diagonals, shear: f64) -> TriMesh {
    let mut mesh = shaped(columns, rows, |x, y| DVec3::new(x + shear * y, y, 0.0));
    if let Diagonals::Alternating = diagonals {
        let stride = columns + 1;
        let mut triangles = Vec::new();
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            let [a, b] = [y * stride + x, y * stride + x + 1];
            let [c, d] = [b + stride, a + stride];
            triangles.extend(if (x + y) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
        mesh = TriMesh::new(mesh.positions, &triangles);
    }
    mesh
}

impl Sheet {
    /// Regular grid, rotated into space.
    fn new(columns: u32, rows: u32, diagonals: Diagonals, shear: f64) -> Self {
        let mut mesh = regular(columns, rows, diagonals, shear);
        let plane = mesh.positions.iter().map(|p| p.truncate()).collect();
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
        for p in &mut mesh.positions {
            *p = turn * *p;
        }
        Self { name: format!("{columns} × {rows}, {diagonals:?}, sheared by {shear}"), mesh: disk(mesh), plane }
    }

    fn solved(&self, settings: &Settings, pins: &Pins) -> Solution {
        solve_once(&self.mesh, settings, pins, Control::unattended())
            .unwrap_or_else(|error| panic!("{}, {settings:?}: {error}", self.name))
    }

    fn assert_comes_back_by(&self, methods: &[Settings]) {
        for settings in methods {
            let solution = self.solved(settings, &Pins::new());
            let error = distance_up_to_similarity(&self.plane, &solution.embedding);
            assert!(error <= TOLERANCE, "{}, {settings:?}: off by {error:e}", self.name);
            assert!(verdict(&self.mesh, &solution.embedding).planar, "{}, {settings:?}", self.name);
        }
    }

    /// Asserts that pins at their true positions reproduce all vertices.
    fn assert_pins_hold_it_in_place(&self, pinned: &[VertexId], methods: &[Settings]) {
        let pins = hard_pins(pinned.iter().map(|&v| (v, self.plane[v.index()])));
        for settings in methods {
            let solution = self.solved(settings, &pins);
            let off = solution.embedding.iter().zip(&self.plane).map(|(z, p)| z.distance(*p)).fold(0.0, f64::max);
            let error = off / extent(&self.plane);
            assert!(error <= TOLERANCE, "{}, {settings:?}, pins {pinned:?}: off by {error:e}", self.name);
        }
    }
}

fn natural(family: Family) -> Settings {
    Settings::new(Method::Natural, family)
}

/// Methods whose matrix is not Hermitian.
fn unsymmetric() -> Vec<Settings> {
    let is_hermitian = |s: &Settings| s.method != Method::Levy && s.family() == Family::Conformal;
    let powers = [natural(Family::Power(2.0)), natural(Family::Power(-1.5))];
    free_methods().into_iter().filter(|settings| !is_hermitian(settings)).chain(powers).collect()
}

fn levy() -> Settings {
    Settings { method: Method::Levy, ..Settings::default() }
}

/// Methods except Wachspress weights on squares with alternating diagonals, whose equations have a third solution:
/// see [`a_chess_board_has_a_third_solution_of_the_wachspress_equations`].
fn telling(diagonals: Diagonals, shear: f64) -> Vec<Settings> {
    let is_chess_board = matches!(diagonals, Diagonals::Alternating) && shear == 0.0;
    unsymmetric().into_iter().filter(|s| !(is_chess_board && s.family() == Family::Wachspress)).collect()
}

const DIAGONALS: [Diagonals; 2] = [Diagonals::OneWay, Diagonals::Alternating];

#[test]
fn regular_grids_come_back_in_every_family() {
    for (side, shear) in [(10, 0.0), (10, 0.4), (30, 0.0), (31, -0.7)] {
        for diagonals in DIAGONALS {
            Sheet::new(side, side, diagonals, shear).assert_comes_back_by(&telling(diagonals, shear));
        }
    }
}

#[test]
fn large_regular_grids_come_back() {
    for diagonals in DIAGONALS {
        Sheet::new(60, 60, diagonals, 0.0).assert_comes_back_by(&[natural(Family::Power(-0.5)), levy()]);
    }
    Sheet::new(100, 100, Diagonals::OneWay, 0.0).assert_comes_back_by(&[natural(Family::MeanValue)]);
    Sheet::new(100, 100, Diagonals::Alternating, 0.2).assert_comes_back_by(&[natural(Family::Power(0.5))]);
}

#[test]
fn thin_corridors_come_back_in_every_family() {
    for (columns, rows, shear) in [(200, 1, 0.0), (200, 2, 0.3), (300, 3, 0.0), (100, 12, 0.0)] {
        for diagonals in DIAGONALS {
            let sheet = Sheet::new(columns, rows, diagonals, shear);
            sheet.assert_comes_back_by(&telling(diagonals, shear));
            sheet.assert_comes_back_by(&[natural(Family::Conformal)]);
        }
    }
}

#[test]
fn a_chess_board_has_a_third_solution_of_the_wachspress_equations() {
    // An even vertex has no weight for its odd neighbours, whose corners are right angles: even and odd vertices
    // decouple.
    let third = |mesh: &DiskMesh, family| {
        let mut values: Vec<f64> = real_matrix(mesh, &natural(family)).singular_values().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        // Each complex singular value counts twice.
        values[4] / values[values.len() - 1]
    };
    let sheet = Sheet::new(8, 8, Diagonals::Alternating, 0.0);
    assert!(third(&sheet.mesh, Family::Wachspress) < 1e-14);
    for family in [Family::MeanValue, Family::Power(-0.5), Family::Power(-1.5)] {
        assert!(third(&sheet.mesh, family) > 1e-5, "{family}");
    }
    for leaning in [Sheet::new(8, 8, Diagonals::Alternating, 0.1), Sheet::new(8, 8, Diagonals::OneWay, 0.0)] {
        assert!(third(&leaning.mesh, Family::Wachspress) > 1e-5, "{}", leaning.name);
    }
}

#[test]
fn pins_anywhere_hold_a_grid_in_place() {
    for side in [30, 60] {
        let sheet = Sheet::new(side, side, Diagonals::OneWay, 0.0);
        let at = |x: u32, y: u32| VertexId::new(y * (side + 1) + x);
        let middle = side / 2;
        let sets: [&[VertexId]; 5] = [
            &[at(0, 0), at(side, side)],
            &[at(side, 0), at(0, side)],
            &[at(middle, middle), at(middle + 1, 3)],
            &[at(2, 2), at(middle, 0), at(side - 4, side)],
            &[at(1, 1), at(4, middle), at(middle, 7), at(side, side - 1), at(side - 3, 2)],
        ];
        let methods = if side == 30 { unsymmetric() } else { vec![natural(Family::MeanValue)] };
        for pinned in sets {
            sheet.assert_pins_hold_it_in_place(pinned, &methods);
        }
    }
}

#[test]
fn pins_anywhere_hold_a_corridor_in_place() {
    // With Wachspress weights and lower powers the remaining system can be singular unless all equations of pins are
    // kept.
    let is_higher = |s: &Settings| s.method == Method::Levy || s.family().power().is_some_and(|power| power > -1.0);
    let methods: Vec<Settings> = unsymmetric().into_iter().filter(is_higher).collect();
    for (columns, rows, diagonals) in
        [(300, 3, Diagonals::Alternating), (200, 1, Diagonals::Alternating), (200, 2, Diagonals::OneWay)]
    {
        let sheet = Sheet::new(columns, rows, diagonals, 0.0);
        let at = |x: u32, y: u32| VertexId::new(y * (columns + 1) + x);
        let sets: [&[VertexId]; 4] = [
            &[at(0, 0), at(columns, rows)],
            &[at(20, 0), at(30, 1)],
            &[at(20, 0), at(30, 1), at(100, 1)],
            &[at(0, 0), at(columns, 0), at(columns / 2, rows)],
        ];
        for pinned in sets {
            sheet.assert_pins_hold_it_in_place(pinned, &methods);
        }
    }
}

/// Number of factorizations of a solve, and its solution.
fn factored(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> (usize, Result<Solution, SolveError>) {
    let phases = Mutex::new(Vec::new());
    let listen = |phase| phases.lock().expect("no listener panics").push(phase);
    let solved = solve_once(mesh, settings, pins, Control::new(&AtomicBool::new(false), &listen));
    let phases = phases.into_inner().expect("no listener panics");
    (phases.iter().filter(|&&phase| phase == Phase::Factor).count(), solved)
}

fn assert_where_the_usual_pins_will_do_they_stay_and_nothing_is_factored_twice(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        for settings in unsymmetric().iter().take(5) {
            let (count, solution) = factored(&mesh, settings, &Pins::new());
            assert_eq!(count, 1, "{name}, {settings:?}");
            assert!(solution.expect("solvable").pins.keys().eq(gauge_pins(&mesh).keys()), "{name}, {settings:?}");
        }
    }
}

#[test]
fn where_the_usual_pins_will_do_they_stay_and_nothing_is_factored_twice() {
    let built_in = BuiltIn::ALL.into_iter().filter(|&example| example != BuiltIn::Spiral);
    let built_in = built_in.map(|example| (example.name().to_owned(), disk(example.mesh())));
    assert_where_the_usual_pins_will_do_they_stay_and_nothing_is_factored_twice(built_in.collect());
}

corpus_test! {
    fn where_the_usual_pins_will_do_they_stay_and_nothing_is_factored_twice_in_the_corpus() {
        let disks = corpus_disks().into_iter().filter(|entry| entry.file != "maze.obj");
        let small = disks.map(|entry| entry.named_disk()).filter(|(_, mesh)| mesh.vertex_count() < 3_300);
        assert_where_the_usual_pins_will_do_they_stay_and_nothing_is_factored_twice(small.collect());
    }
}

#[test]
fn on_a_grid_gauge_pins_move_to_where_the_equations_depend_on_each_other() {
    // Two factorizations if the default factors reveal the kernel; a further one if they are singular.
    for (side, most) in [(20, 2), (40, 3)] {
        let mesh = disk(regular(side, side, Diagonals::OneWay, 0.0));
        let (count, solution) = factored(&mesh, &natural(Family::MeanValue), &Pins::new());
        let solution = solution.expect("solvable");
        assert!((2..=most).contains(&count), "{side}: factored {count} times");
        assert!(solution.gauge_completed && !solution.linear.expect("linear").keeps_equations);
        // The default two are the corners with two triangles; the kernel is at those with one.
        let corner = |v: &VertexId| {
            let at = mesh.position(*v).truncate() / mesh.position(VertexId::new(side)).x * f64::from(side);
            [DVec2::ZERO, DVec2::splat(f64::from(side))].into_iter().any(|corner| corner.distance(at) < 1.5)
        };
        assert!(solution.pins.keys().all(corner), "{:?}", solution.pins);
        assert!(!solution.pins.keys().eq(gauge_pins(&mesh).keys()));
    }
}

#[test]
fn constraints_are_factored_once_where_their_equations_depend_on_the_others_and_again_on_a_grid() {
    let settings = natural(Family::MeanValue);
    let mesh = disk(BuiltIn::Face.mesh());
    let pins = |pinned: [usize; 3]| hard_pins(pinned.map(|v| (VertexId::from_index(v), DVec2::new(v as f64, 1.0))));
    let (count, solution) = factored(&mesh, &settings, &pins([3, 40, 90]));
    assert_eq!(count, 1);
    assert!(solution.expect("solvable").linear.expect("linear").keeps_equations);
    // The two corners of a grid without the kernel.
    let grid = disk(regular(20, 20, Diagonals::OneWay, 0.0));
    let (count, solution) = factored(&grid, &settings, &pins([20, 20 * 21, 220]));
    assert!((2..=3).contains(&count), "factored {count} times");
    assert!(solution.expect("solvable").linear.expect("linear").keeps_equations);
}

#[test]
fn two_pins_of_the_users_keep_all_equations_where_theirs_do_not_depend_on_the_others() {
    let sheet = Sheet::new(40, 40, Diagonals::OneWay, 0.0);
    let pins = hard_pins([40, 40 * 41].map(|v| (VertexId::from_index(v), sheet.plane[v])));
    let settings = natural(Family::MeanValue);
    assert!(sheet.solved(&settings, &pins).linear.expect("linear").keeps_equations);
    // If requested, their equations are left out nevertheless, and the error names the consequence.
    let asked = Settings { treatment: Some(Treatment::Eliminate), ..settings.clone() };
    let eliminated = solve_once(&sheet.mesh, &asked, &pins, Control::unattended());
    assert!(matches!(eliminated, Err(SolveError::Singular { .. })), "{eliminated:?}");
    // A small grid does not need it.
    let small = Sheet::new(6, 6, Diagonals::OneWay, 0.0);
    let pins = hard_pins([6, 42].map(|v| (VertexId::from_index(v), small.plane[v])));
    assert!(!small.solved(&settings, &pins).linear.expect("linear").keeps_equations);
}

#[test]
fn a_drag_of_two_pins_on_a_grid_is_linear_in_their_targets() {
    let sheet = Sheet::new(40, 40, Diagonals::OneWay, 0.0);
    let [first, second] = [40, 40 * 41].map(VertexId::from_index);
    let at = |target: DVec2| hard_pins([(first, DVec2::ZERO), (second, target)]);
    let (settings, control) = (natural(Family::MeanValue), Control::unattended());
    let prepared = Prepared::new(&sheet.mesh, &settings, &at(DVec2::ONE), control).expect("solvable");
    let [before, after] = [DVec2::new(30.0, 5.0), DVec2::new(32.0, 5.0)]
        .map(|target| prepared.solve(&sheet.mesh, &at(target), control).expect("solvable").embedding);
    let column = prepared.column(&sheet.mesh, &[second]).expect("solvable");
    let off =
        before.iter().zip(&after).zip(&column).map(|((a, b), c)| (*a + 2.0 * *c).distance(*b)).fold(0.0, f64::max);
    assert!(off <= 1e-11 * 40.0, "{off:e}");
}

#[test]
fn bumpy_grids_solve_and_hold_their_equations() {
    for side in [30, 60] {
        let mesh = disk(shaped(side, side, |x, y| DVec3::new(x, y, 0.8 * (1.1 * x).sin() * (0.9 * y + 0.3).cos())));
        for settings in [natural(Family::MeanValue), natural(Family::Wachspress), levy()] {
            let solution = solve_once(&mesh, &settings, &Pins::new(), Control::unattended())
                .unwrap_or_else(|error| panic!("{side}, {settings:?}: {error}"));
            let residual = solution.linear.expect("linear").residual;
            assert!(residual <= TOLERANCE, "{side}, {settings:?}: {residual:e}");
            assert!(solution.embedding.iter().all(|z| z.is_finite()));
        }
    }
}

#[test]
fn a_moved_gauge_gives_the_same_bytes_for_one_thread_and_for_two() {
    let mesh = disk(regular(35, 35, Diagonals::Alternating, 0.1));
    for settings in [natural(Family::MeanValue), levy()] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let solution = pool.install(|| solve_once(&mesh, &settings, &Pins::new(), Control::unattended()));
            solution.expect("solvable").embedding.iter().map(|z| z.to_array().map(f64::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(on(1), on(2), "{settings:?}");
    }
}
