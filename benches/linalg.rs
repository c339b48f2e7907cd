//! Times of the sparse factorizations: `cargo bench --bench linalg`, or `cargo bench --bench linalg -- 100000` for a
//! mesh with this number of vertices.
//!
//! The benchmark compares the Cholesky factorization of the conformal natural system with the LU of the mean-value
//! natural system. On one mesh both have equal pattern and order, so their times and memory are comparable. They run
//! alternately.

mod common;

use std::sync::atomic::AtomicBool;

use freebound_core::linalg::{Analysis, Factor, FactorStats, Kind, Solved};
use freebound_core::linear::FreeSystem;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, gauge_pins};
use freebound_core::weights::equations;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use common::machine::{print_machine, processor_seconds};
use common::table::{Table, megabytes, ratio, seconds, target};
use common::{Times, arguments};
use freebound_testkit::jittered_sheet;

type C = Complex<f64>;

/// Vertex counts of the meshes. Arguments override them.
const SIZES: [usize; 2] = [100_000, 500_000];

/// Largest ratios of LU to Cholesky.
const TIME_TARGET: f64 = 3.0;
const FACTORS_TARGET: f64 = 2.2;
const PEAK_TARGET: f64 = 3.5;

/// Largest relative residual.
const RESIDUAL_TARGET: f64 = 1e-12;

/// Time targets for factoring the LU, seconds, by vertices.
const LU_TARGETS: [(usize, f64); 2] = [(100_000, 1.0), (500_000, 8.0)];

static GO_ON: AtomicBool = AtomicBool::new(false);

/// Factorization under measurement.
struct Job {
    name: &'static str,
    kind: Kind,
    matrix: CscMatrix<C>,
    rhs: Vec<C>,
    analyze: Times,
    factor: Times,
    processor: f64,
    solve: Times,
    adjoint: Times,
    last: Option<(Solved<C>, FactorStats)>,
}

impl Job {
    fn new(name: &'static str, kind: Kind, mesh: &DiskMesh, power: f64) -> Self {
        let pins = gauge_pins(mesh);
        let system =
            FreeSystem::new(mesh, |v: VertexId| pins.contains_key(&v), Control::unattended()).expect("nobody stops it");
        let natural = equations::natural(mesh, power, Control::unattended()).expect("weights are finite");
        let rhs = system.pinned_terms(mesh, &natural, |v| C::new(pins[&v].x, pins[&v].y));
        let matrix = system.negated_matrix(mesh, &natural, Control::unattended()).expect("nobody stops it");
        let [analyze, factor, solve, adjoint] = <[Times; 4]>::default();
        Self { name, kind, matrix, rhs, analyze, factor, processor: f64::INFINITY, solve, adjoint, last: None }
    }

    /// Orders, factors and solves once; the result must be bitwise equal every time.
    fn run(&mut self) {
        let analysis = self.analyze.run(|| {
            Analysis::new(self.kind, self.matrix.pattern(), &AtomicBool::new(false)).expect("a symmetric pattern")
        });
        let before = processor_seconds();
        let factor: Factor<C> = self.factor.run(|| analysis.factor(&self.matrix, &GO_ON).expect("regular"));
        self.processor = self.processor.min(processor_seconds() - before);
        let solved = self.solve.run(|| factor.solve(&self.matrix, &self.rhs, &GO_ON).expect("a good answer"));
        let many: Vec<C> = self.rhs.iter().copied().cycle().take(8 * self.rhs.len()).collect();
        self.adjoint.run(|| factor.solve_adjoint(&self.matrix, &many, &GO_ON).expect("good answers"));
        let earlier = self.last.replace((solved, factor.stats()));
        let (solved, _) = self.last.as_ref().expect("just put there");
        assert!(earlier.is_none_or(|(earlier, _)| earlier.x == solved.x), "two factorizations of one matrix differ");
    }

    fn last(&self) -> &(Solved<C>, FactorStats) {
        self.last.as_ref().expect("it has run")
    }
}

fn measure(vertex_count: usize) {
    let cells = u32::try_from(vertex_count.isqrt() - 1).expect("a size that fits the memory");
    let mesh = DiskMesh::try_from(jittered_sheet(cells)).expect("a sheet is a disk");
    let mut jobs = [
        Job::new("LLT, conformal", Kind::Hermitian, &mesh, 1.0),
        Job::new("LU, mean value", Kind::General, &mesh, 0.0),
    ];
    let rounds = if vertex_count < 200_000 { 7 } else { 3 };
    for _ in 0..rounds {
        jobs.iter_mut().for_each(Job::run);
    }
    let heads = [
        "job",
        "analyze",
        "factor",
        "least",
        "processor",
        "solve",
        "8 adjoint",
        "steps",
        "residual",
        "replaced",
        "factors MB",
        "peak MB",
    ];
    let mut table = Table::new(format!("factorizations, n = {}", jobs[0].matrix.nrows()), &heads);
    for job in &jobs {
        let (solved, stats) = job.last();
        table.row([
            job.name.to_owned(),
            seconds(job.analyze.median()),
            seconds(job.factor.median()),
            seconds(job.factor.least()),
            format!("{:.2}", job.processor),
            seconds(job.solve.median()),
            seconds(job.adjoint.median()),
            solved.refinement_steps.to_string(),
            format!("{:.1e}", solved.residual),
            stats.replaced_pivots.to_string(),
            megabytes(stats.factor_bytes),
            megabytes(stats.peak_bytes),
        ]);
    }
    table.print();
    print_targets(vertex_count, &jobs);
}

fn print_targets(vertex_count: usize, [llt, lu]: &[Job; 2]) {
    let mut table = Table::new("LU beside LLT", &["what", "value", "target"]);
    let bytes = |of: fn(&FactorStats) -> usize| of(&lu.last().1) as f64 / of(&llt.last().1) as f64;
    for (what, value, at_most) in [
        ("time to factor, LU/LLT", lu.factor.median() / llt.factor.median(), TIME_TARGET),
        ("bytes of factors, LU/LLT", bytes(|stats| stats.factor_bytes), FACTORS_TARGET),
        ("peak while factoring, LU/LLT", bytes(|stats| stats.peak_bytes), PEAK_TARGET),
    ] {
        table.row([what.to_owned(), ratio(value), target(value, at_most)]);
    }
    let residual = lu.last().0.residual;
    table.row(["residual of the LU".to_owned(), format!("{residual:.1e}"), target(residual, RESIDUAL_TARGET)]);
    if let Some(&(_, at_most)) = LU_TARGETS.iter().find(|&&(size, _)| size == vertex_count) {
        let value = lu.factor.median();
        table.row(["time to factor, LU, seconds".to_owned(), seconds(value), target(value, at_most)]);
    }
    table.print();
}

fn main() {
    let sizes: Vec<usize> = arguments().iter().filter_map(|argument| argument.parse().ok()).collect();
    print_machine();
    for vertex_count in if sizes.is_empty() { SIZES.to_vec() } else { sizes } {
        measure(vertex_count);
    }
}
