//! The linear solve compared with related solves.

use std::sync::atomic::AtomicBool;

use freebound_core::flatten::Prepared;
use freebound_core::linalg::{Analysis, FactorStats, Kind};
use freebound_core::linear::FreeSystem;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Pins, Settings, fixed_pins, gauge_pins};
use freebound_core::weights::equations;
use glam::DVec2;
use nalgebra_sparse::{CooMatrix, CscMatrix};
use num_complex::Complex;

use crate::common::Times;
use crate::common::table::{Table, megabytes, ratio, seconds, target};
use crate::{COMMON_FACES, LARGE_FACES, disk_of_faces};

type C = Complex<f64>;

/// Runs of each job at the common size.
const ROUNDS: usize = 9;

/// Largest time of the whole solve, assembly included, relative to a real Laplacian Cholesky factorization.
const LAPLACIAN_TARGET: f64 = 2.5;

/// Largest time relative to the real 2n×2n solve; both count order, factor and solve.
const REAL_TARGET: f64 = 0.7;

/// Largest time of order, factor and solve relative to these of the Laplacian, with one right-hand side each.
const SOLVED_TARGET: f64 = 1.2;

static GO_ON: AtomicBool = AtomicBool::new(false);

/// Conformal natural boundary system of a mesh, and related real systems.
struct Systems {
    laplacian: CscMatrix<f64>,
    laplacian_rhs: Vec<f64>,
    complex: CscMatrix<C>,
    rhs: Vec<C>,
    /// System with x and y as unknowns and only the nonzero entries: only the boundary couples them.
    real: CscMatrix<f64>,
    /// System with x and y as unknowns and all entries of the normal equations of triangles (LSCM). Most of these
    /// cancel to zero.
    real_full: CscMatrix<f64>,
    real_rhs: Vec<f64>,
}

impl Systems {
    fn new(mesh: &DiskMesh) -> Self {
        let pins = gauge_pins(mesh);
        let system =
            FreeSystem::new(mesh, |v: VertexId| pins.contains_key(&v), Control::unattended()).expect("nobody stops it");
        let weights = equations::barycentric(mesh, 1.0, Control::unattended()).expect("weights are finite");
        let natural = equations::natural(mesh, 1.0, Control::unattended()).expect("weights are finite");
        let rhs: Vec<C> = system.pinned_terms(mesh, &natural, |v| C::new(pins[&v].x, pins[&v].y));
        let complex = system.negated_matrix(mesh, &natural, Control::unattended()).expect("nobody stops it");
        Self {
            laplacian: system.negated_matrix(mesh, &weights, Control::unattended()).expect("nobody stops it"),
            laplacian_rhs: rhs.iter().map(|z| z.re).collect(),
            real: realified(&complex, |value| value != 0.0),
            real_full: realified(&complex, |_| true),
            real_rhs: rhs.iter().flat_map(|z| [z.re, z.im]).collect(),
            complex,
            rhs,
        }
    }
}

/// Equivalent real matrix of twice the order: a + bi becomes (a −b; b a). Coupling entries ±b are included if
/// `coupled` returns true for b.
fn realified(matrix: &CscMatrix<C>, coupled: impl Fn(f64) -> bool) -> CscMatrix<f64> {
    let n = matrix.nrows();
    let mut entries = CooMatrix::new(2 * n, 2 * n);
    for (row, column, &value) in matrix.triplet_iter() {
        for k in 0..2 {
            entries.push(2 * row + k, 2 * column + k, value.re);
        }
        if coupled(value.im) {
            entries.push(2 * row + 1, 2 * column, value.im);
            entries.push(2 * row, 2 * column + 1, -value.im);
        }
    }
    CscMatrix::from(&entries)
}

/// Orders and factors, and solves if there is a right-hand side.
fn run<T: freebound_core::linalg::Scalar>(matrix: &CscMatrix<T>, rhs: Option<&[T]>) -> FactorStats {
    let analysis =
        Analysis::new(Kind::Hermitian, matrix.pattern(), &AtomicBool::new(false)).expect("a symmetric pattern");
    let factor = analysis.factor(matrix, &GO_ON).expect("positive definite");
    if let Some(rhs) = rhs {
        std::hint::black_box(factor.solve(matrix, rhs, &GO_ON).expect("a good answer"));
    }
    factor.stats()
}

/// Solves as the program does. The numeric peak is not measured.
fn flatten(mesh: &DiskMesh) -> FactorStats {
    let (settings, pins, control) = (Settings::default(), Pins::new(), Control::unattended());
    let prepared = Prepared::new(mesh, &settings, &pins, control).expect("a regular system");
    let solution = prepared.solve(mesh, &pins, control).expect("a good answer");
    let factor_bytes = solution.linear.expect("a linear method").factor_bytes;
    FactorStats { replaced_pivots: 0, factor_bytes, peak_bytes: 0 }
}

/// Prints the time of the whole solve relative to real systems on one mesh.
pub(crate) fn against_laplacian() {
    for (faces, rounds) in [(COMMON_FACES, ROUNDS), (LARGE_FACES, 5)] {
        against_laplacian_of(&disk_of_faces(faces), rounds);
    }
}

fn against_laplacian_of(mesh: &DiskMesh, rounds: usize) {
    let systems = Systems::new(mesh);
    let jobs: [(&str, &dyn Fn() -> FactorStats); 7] = [
        ("real n×n Laplacian: order, factor", &|| run(&systems.laplacian, None)),
        ("real n×n Laplacian: order, factor, solve", &|| run(&systems.laplacian, Some(&systems.laplacian_rhs))),
        ("complex n×n: order, factor", &|| run(&systems.complex, None)),
        ("complex n×n: order, factor, solve", &|| run(&systems.complex, Some(&systems.rhs))),
        ("complex n×n: assemble, order, factor, solve", &|| flatten(mesh)),
        ("real 2n×2n, boundary coupled: order, factor, solve", &|| run(&systems.real, Some(&systems.real_rhs))),
        ("real 2n×2n, LSCM's pattern: order, factor, solve", &|| run(&systems.real_full, Some(&systems.real_rhs))),
    ];
    let stats: Vec<FactorStats> = jobs.iter().map(|(_, job)| job()).collect();
    let mut times: [Times; 7] = Default::default();
    for _ in 0..rounds {
        for ((_, job), times) in jobs.iter().zip(&mut times) {
            times.run(job);
        }
    }
    let title = format!("conformal natural boundary, {} faces, n = {}", mesh.face_count(), systems.complex.nrows());
    let heads = ["job", "seconds", "least", "of Laplacian", "factors MB", "numeric peak MB"];
    let mut table = Table::new(title, &heads);
    let medians = times.each_ref().map(Times::median);
    for (((name, _), times), stats) in jobs.iter().zip(&times).zip(&stats) {
        table.row([
            (*name).to_owned(),
            seconds(times.median()),
            seconds(times.least()),
            ratio(times.median() / medians[0]),
            megabytes(stats.factor_bytes),
            if stats.peak_bytes > 0 { megabytes(stats.peak_bytes) } else { "-".to_owned() },
        ]);
    }
    table.print();
    let mut targets = Table::new("the solve by what it is measured by", &["quotient", "value", "target"]);
    for (name, value, at_most) in [
        ("complex, with assembly and solve / real Laplacian without", medians[4] / medians[0], LAPLACIAN_TARGET),
        ("complex / real Laplacian: order, factor, solve", medians[3] / medians[1], SOLVED_TARGET),
        ("complex / real 2n×2n, boundary coupled", medians[3] / medians[5], REAL_TARGET),
        ("complex / real 2n×2n, LSCM's pattern", medians[3] / medians[6], REAL_TARGET),
    ] {
        targets.row([name.to_owned(), ratio(value), target(value, at_most)]);
    }
    targets.print();
}

/// Prints the savings from a known symbolic analysis, and from known factors.
pub(crate) fn again() {
    let heads = ["faces", "n", "analyze", "factor", "fresh", "again/fresh", "first solve", "drag"];
    let mut table = Table::new("factoring again, and solving again for other targets (a drag)", &heads);
    for (faces, rounds) in [(COMMON_FACES, ROUNDS), (LARGE_FACES, 3)] {
        let mesh = disk_of_faces(faces);
        let matrix = Systems::new(&mesh).complex;
        let new_analysis =
            || Analysis::new(Kind::Hermitian, matrix.pattern(), &AtomicBool::new(false)).expect("a symmetric pattern");
        let [mut analyze, mut factor, mut fresh, mut first, mut drag] = <[Times; 5]>::default();
        let control = Control::unattended();
        let mut pins = fixed_pins(gauge_pins(&mesh));
        let settings = Settings::default();
        let prepared = Prepared::new(&mesh, &settings, &pins, control).expect("a regular system");
        for _ in 0..rounds {
            let analysis = analyze.run(new_analysis);
            drop(factor.run(|| analysis.factor(&matrix, &GO_ON).expect("positive definite")));
            drop(fresh.run(|| new_analysis().factor(&matrix, &GO_ON).expect("positive definite")));
            first.run(|| flatten(&mesh));
            let moved = pins.values_mut().next_back().expect("there are two");
            moved.target += DVec2::new(0.01, 0.02);
            drag.run(|| prepared.solve(&mesh, &pins, control).expect("a good answer"));
        }
        table.row([
            mesh.face_count().to_string(),
            matrix.nrows().to_string(),
            seconds(analyze.median()),
            seconds(factor.median()),
            seconds(fresh.median()),
            ratio(factor.median() / fresh.median()),
            seconds(first.median()),
            seconds(drag.median()),
        ]);
    }
    table.print();
}
