//! Reads any bytes as a mesh. Every chart of a readable, repaired mesh is flattened, and its verdict is checked
//! again.
#![no_main]

use freebound_core::mesh::Preparation;
use freebound_core::flatten::{Options, flatten};
use freebound_io::ReadOptions;
use freebound_run::Model;
use libfuzzer_sys::fuzz_target;

/// Face limit: larger meshes only take longer.
const MOST_FACES: usize = 120;

fuzz_target!(|bytes: &[u8]| {
    let Ok(model) = Model::read_stream("bytes", bytes, ReadOptions::default(), &|| false) else { return };
    let model = model.in_form(Preparation::default().with_all_repairs());
    if model.source.polygons.corners.len() > 3 * MOST_FACES {
        return;
    }
    for chart in 0..model.chart_count() {
        let chart = model.of_chart(chart);
        if let Some(disk) = chart.disk()
            && let Ok(step) = flatten(disk, &Options::default())
        {
            let mesh = step.candidate.mesh(disk);
            let embedding = &step.candidate.solution.embedding;
            assert_eq!(step.verdict.planar, freebound_core::verify::verdict(mesh, embedding).planar);
        }
    }
});
