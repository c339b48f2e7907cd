//! What one further iteration costs beside the first solve: `cargo bench --bench iterate`.
//!
//! `cargo bench --bench iterate -- VERTICES…` takes other sizes.

mod common;

use freebound::mesh::DiskMesh;
use freebound::solver::{
    Control, Family, Iteration, Method, Pins, Settings, Treatment, flatten, gauge_pins, largest_move,
};

use common::machine::{print_machine, processor_seconds};
use common::sheet::sheet_of_faces;
use common::table::{Table, seconds};
use common::{Times, arguments, time};

/// Vertices of the meshes.
const SIZES: [usize; 3] = [20_000, 100_000, 500_000];

/// Rounds of every measurement.
const ROUNDS: usize = 5;

fn main() {
    print_machine();
    let wanted: Vec<usize> = arguments().iter().filter_map(|text| text.parse().ok()).collect();
    let sizes = if wanted.is_empty() { SIZES.to_vec() } else { wanted };
    let heads = [
        "vertices",
        "first solve",
        "analysis",
        "eliminate",
        "least squares",
        "of it factoring",
        "CPU",
        "against the first",
        "move",
    ];
    let mut table = Table::new("one further iteration, seconds", &heads);
    for vertices in sizes {
        let mesh = DiskMesh::try_from(sheet_of_faces(2 * vertices)).expect("the sheet is a disk");
        let settings = Settings::new(Method::Natural, Family::Conformal);
        let mut first = Times::default();
        let mut steps = [Times::default(), Times::default()];
        let mut factor = Times::default();
        let (mut analysis, mut moved, mut processor) = (0.0, 0.0, 0.0);
        for _ in 0..ROUNDS {
            let solution =
                first.run(|| flatten(&mesh, &settings, &Pins::new(), Control::unattended()).expect("solvable"));
            let pins: Pins = gauge_pins(&mesh).into_keys().map(|v| (v, solution.embedding[v.index()])).collect();
            for (times, treatment) in steps.iter_mut().zip([Treatment::Eliminate, Treatment::LeastSquares]) {
                let (taken, iteration) =
                    time(|| Iteration::new(&mesh, &pins, treatment, Control::unattended()).expect("analysable"));
                analysis = taken;
                let before = processor_seconds();
                let step =
                    times.run(|| iteration.step(&mesh, &solution.embedding, Control::unattended()).expect("solvable"));
                processor = processor_seconds() - before;
                factor.add(step.seconds.factor);
                moved = largest_move(&solution.embedding, &step.embedding);
            }
        }
        table.row([
            mesh.vertex_count().to_string(),
            seconds(first.median()),
            seconds(analysis),
            seconds(steps[0].median()),
            seconds(steps[1].median()),
            seconds(factor.median()),
            seconds(processor),
            format!("{:.2} ×", steps[1].median() / first.median()),
            format!("{moved:.1e}"),
        ]);
    }
    table.print();
}
