//! Cost of a further iteration compared with the first solve: `cargo bench --bench iterate`.
//!
//! `cargo bench --bench iterate -- VERTICES…` sets other sizes.

mod common;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use freebound_core::flatten::{largest_move, solve_once};
use freebound_core::linear::Iteration;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, SolveError, Treatment, fixed_pins};

use common::machine::{print_machine, processor_seconds};
use common::stop::within;
use common::table::{Table, seconds};
use common::{Times, arguments, time};
use freebound_testkit::sheet_of_faces;

/// Vertex counts of the meshes.
const SIZES: [usize; 3] = [20_000, 100_000, 500_000];

/// Rounds of every measurement.
const ROUNDS: usize = 5;

/// Number of moments, spread over a step, at which it is cancelled.
const CANCELS: u32 = 40;

/// Columns of the table. The first step of a run may search for a gauge; further steps know it. The last column
/// counts eliminating steps that are singular in 64 bits.
const HEADS: [&str; 11] = [
    "vertices",
    "first solve",
    "analysis",
    "eliminate",
    "first step",
    "least squares",
    "of it factoring",
    "CPU",
    "against the first",
    "move",
    "singular",
];

fn main() {
    print_machine();
    let wanted: Vec<usize> = arguments().iter().filter_map(|text| text.parse().ok()).collect();
    let sizes = if wanted.is_empty() { SIZES.to_vec() } else { wanted };
    let mut table = Table::new("one further iteration, seconds", &HEADS);
    for vertices in sizes {
        let mesh = DiskMesh::try_from(sheet_of_faces(2 * vertices)).expect("the sheet is a disk");
        let settings = Settings::new(Method::Natural, Family::Conformal);
        let mut first = Times::default();
        let mut steps = [Times::default(), Times::default()];
        let (mut first_step, mut factor) = (Times::default(), Times::default());
        let (mut analysis, mut moved, mut processor) = (0.0, 0.0, 0.0);
        let mut singular = 0;
        for _ in 0..ROUNDS {
            let solution =
                first.run(|| solve_once(&mesh, &settings, &Pins::new(), Control::unattended()).expect("solvable"));
            let folded = folded(&mesh, &solution.embedding);
            let pinned = held_in(&folded, &solution.pins);
            for (times, treatment) in steps.iter_mut().zip([Treatment::Eliminate, Treatment::LeastSquares]) {
                let (taken, mut iteration) = time(|| {
                    Iteration::new(&mesh, &folded, &pinned, treatment, Control::unattended()).expect("analysable")
                });
                analysis = taken;
                if treatment == Treatment::LeastSquares {
                    first_step.run(|| iteration.step(&mesh, &folded, Control::unattended()).expect("solvable"));
                }
                let before = processor_seconds();
                let step = times.run(|| iteration.step(&mesh, &folded, Control::unattended()));
                processor = processor_seconds() - before;
                match step {
                    Ok(step) => {
                        factor.add(step.seconds.factor);
                        moved = largest_move(&folded, &step.embedding);
                    }
                    // On a folded embedding the equations may be linearly dependent up to rounding.
                    Err(SolveError::Singular { .. }) if treatment == Treatment::Eliminate => singular += 1,
                    Err(error) => panic!("{error}"),
                }
            }
        }
        table.row([
            mesh.vertex_count().to_string(),
            seconds(first.median()),
            seconds(analysis),
            seconds(steps[0].median()),
            seconds(first_step.median()),
            seconds(steps[1].median()),
            seconds(factor.median()),
            seconds(processor),
            format!("{:.2} ×", steps[1].median() / first.median()),
            format!("{moved:.1e}"),
            singular.to_string(),
        ]);
    }
    table.print();
    cancelling();
}

/// Pins at the positions of an embedding.
fn held_in(embedding: &Embedding, pins: &Pins) -> Pins {
    fixed_pins(pins.keys().map(|&v| (v, embedding[v])))
}

/// Embedding with every fiftieth inner vertex pushed across a neighbour. The iteration would not change a planar
/// one.
fn folded(mesh: &DiskMesh, embedding: &Embedding) -> Embedding {
    let mut folded = embedding.clone();
    for v in mesh.vertices().step_by(50).filter(|&v| mesh.boundary_place(v).is_none()) {
        let neighbour = mesh.outgoing(v).next().map_or(v, |h| mesh.head(h));
        folded[v] += 1.5 * (embedding[neighbour] - embedding[v]);
    }
    folded
}

/// Measures the time from a cancellation until the step has stopped, at moments spread over the whole step.
fn cancelling() {
    let heads = ["vertices", "median", "longest"];
    let mut table = Table::new("cancelling a least-squares step, seconds until it has stopped", &heads);
    for vertices in [20_000, 100_000] {
        let mesh = DiskMesh::try_from(sheet_of_faces(2 * vertices)).expect("the sheet is a disk");
        let first = solve_once(&mesh, &Settings::default(), &Pins::new(), Control::unattended()).expect("solvable");
        let folded = folded(&mesh, &first.embedding);
        let pinned = held_in(&folded, &first.pins);
        let mut iteration = Iteration::new(&mesh, &folded, &pinned, Treatment::LeastSquares, Control::unattended())
            .expect("analysable");
        let (whole, _) = time(|| iteration.step(&mesh, &folded, Control::unattended()).expect("solvable"));
        let mut waits = Times::default();
        let mut longest = 0.0_f64;
        for k in 0..CANCELS {
            let flag = AtomicBool::new(false);
            let until = Duration::from_secs_f64(whole * f64::from(k) / f64::from(CANCELS));
            let control = Control::new(&flag, &|_| {});
            let (outcome, wait) = within(until, &flag, || iteration.step(&mesh, &folded, control));
            if let Some(wait) = wait.filter(|_| outcome.is_err()) {
                waits.add(wait.as_secs_f64());
                longest = longest.max(wait.as_secs_f64());
            }
        }
        table.row([mesh.vertex_count().to_string(), seconds(waits.median()), seconds(longest)]);
    }
    table.print();
}
