//! Watches a flattener step by step, with progress on standard error, and stops it after ten steps.

use std::sync::atomic::{AtomicBool, Ordering};

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Control, Phase, SolveError};
use freebound_core::{Flattener, Options};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A flat fan of six triangles whose boundary vertices are pinned to a hexagon half as large, turned by 40 degrees.
    let spoke = |k: u32, radius: f64, turn: f64| {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 6.0 + turn).sin_cos();
        [radius * cosine, radius * sine]
    };
    let rim = (0..6).map(|k| spoke(k, 1.0, 0.0)).map(|[x, y]| [x, y, 0.0]);
    let positions: Vec<[f64; 3]> = std::iter::once([0.0, 0.0, 0.0]).chain(rim).collect();
    let triangles: Vec<[u32; 3]> = (0..6).map(|k| [0, k + 1, (k + 1) % 6 + 1]).collect();
    let mesh = DiskMesh::try_from(TriMesh::from_arrays(&positions, &triangles))?;
    let options = (0..6).fold(Options::default(), |options, k| options.pinned(k + 1, spoke(k, 0.5, 0.7)));

    let cancel = AtomicBool::new(false);
    let report = |phase: Phase| eprintln!("  {}", phase.words());
    let control = Control::new(&cancel, &report);
    let mut flattener = Flattener::with_options(options);
    while flattener.ending().is_none() {
        match flattener.step(&mesh, control) {
            Ok(step) => println!("step {}, {}: {}", step.index, step.candidate.stage.words(), step.verdict.summary()),
            Err(SolveError::Cancelled) => break,
            Err(error) => return Err(error.into()),
        }
        cancel.store(flattener.step_count() >= 10, Ordering::Relaxed);
    }
    println!("ending: {:?}", flattener.ending());
    Ok(())
}
