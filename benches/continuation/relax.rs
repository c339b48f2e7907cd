//! Relaxation from the conformal map, without constraints, until it ends by itself.
//!
//! A round of relaxation takes Newton steps, at most five, until a step lowers the energy by less than a
//! ten-thousandth. A round that lowers the energy by less than a thousandth is the last. The cost of a step is its
//! share of its round: scaffold, elimination order, factorization, proof.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Family, Method, Phase, Pins, Settings, Stage};
use freebound_core::verify::distortion;
use freebound_io::peak_memory_bytes;

use crate::common::machine::processor_seconds;
use crate::common::table::{Table, megabytes, seconds, target};
use crate::outcome::{SHOWS_STEPS, show};
use crate::size::forget_peak;
use freebound_testkit::bumpy_cap_of;

/// Largest number of rounds.
const MOST_ROUNDS: usize = 30;

/// Targets for the number of Newton steps until relaxation ends, and for the seconds per step.
const STEPS_TARGET: f64 = 12.0;
const SECONDS_TARGET: f64 = 0.4;

/// Target for the memory, in millions of bytes.
const MEGABYTES_TARGET: f64 = 2000.0;

/// Numbers of faces, and the quantity with a target at each.
const SIZES: [(usize, Limited); 3] =
    [(20_000, Limited::Nothing), (100_000, Limited::Time), (1_000_000, Limited::Memory)];

#[derive(Clone, Copy, PartialEq)]
enum Limited {
    Nothing,
    Time,
    Memory,
}

pub(crate) fn run(is_quick: bool) {
    let heads = [
        "faces",
        "energy",
        "relaxed",
        "rounds",
        "steps",
        "target",
        "a step s",
        "target s",
        "cpu s",
        "peak MB",
        "target MB",
    ];
    let title = "relaxing from the conformal map; a step is one of Newton's, its seconds those of the slowest round";
    let mut table = Table::new(title, &heads);
    for &(faces, limited) in if is_quick { &SIZES[..1] } else { &SIZES[..] } {
        let mesh = DiskMesh::try_from(bumpy_cap_of(faces / 2, 1)).expect("a cap is a disk");
        let is_reset = forget_peak();
        let found = Relaxed::of(&mesh);
        let peak = peak_memory_bytes().filter(|_| is_reset).and_then(|bytes| usize::try_from(bytes).ok());
        let limit =
            |by: Limited, value: f64, most: f64| if limited == by { target(value, most) } else { String::new() };
        let a_step = found.rounds.iter().map(|round| round.seconds / round.steps as f64).fold(0.0, f64::max);
        let steps: usize = found.rounds.iter().map(|round| round.steps).sum();
        let processor: f64 = found.rounds.iter().map(|round| round.processor).sum();
        let row = [
            mesh.face_count().to_string(),
            format!("{:.3}", found.energy_before),
            format!("{:.4}", found.energy),
            found.rounds.len().to_string(),
            steps.to_string(),
            limit(Limited::Time, steps as f64, STEPS_TARGET),
            seconds(a_step),
            limit(Limited::Time, a_step, SECONDS_TARGET),
            seconds(processor / steps as f64),
            peak.map_or("–".to_owned(), megabytes),
            peak.map_or(String::new(), |peak| limit(Limited::Memory, peak as f64 / 1e6, MEGABYTES_TARGET)),
        ];
        println!("{}", row.join("  "));
        table.row(row);
    }
    println!();
    table.print();
}

/// Outcome of relaxation.
#[derive(Default)]
struct Relaxed {
    /// Mean symmetric Dirichlet energy of the conformal map, and at the end.
    energy_before: f64,
    energy: f64,
    rounds: Vec<Round>,
}

/// Round with its verdict.
struct Round {
    seconds: f64,
    processor: f64,
    /// Number of Newton steps.
    steps: usize,
}

impl Relaxed {
    fn of(mesh: &DiskMesh) -> Self {
        let settings =
            Settings { relax_rounds: Some(MOST_ROUNDS), ..Settings::new(Method::Natural, Family::Conformal) };
        let (cancel, newton_steps) = (AtomicBool::new(false), AtomicUsize::new(0));
        // Every Newton step enters this phase.
        let count = |phase| {
            newton_steps.fetch_add(usize::from(phase == Phase::Solve), Ordering::Relaxed);
        };
        let mut found = Self::default();
        let mut before = (Instant::now(), processor_seconds());
        let take = |step: Step| {
            let (seconds, processor) = (before.0.elapsed().as_secs_f64(), processor_seconds() - before.1);
            let steps = newton_steps.swap(0, Ordering::Relaxed);
            if SHOWS_STEPS.load(Ordering::Relaxed) {
                show(&step);
            }
            assert!(step.verdict.planar, "relaxing keeps it planar");
            if step.candidate.stage == Stage::Relax {
                found.rounds.push(Round { seconds, processor, steps });
                found.energy = step.candidate.progress.map_or(f64::NAN, |progress| progress.energy);
            } else {
                found.energy_before =
                    distortion(mesh, &step.candidate.solution.embedding).summary.symmetric_dirichlet.mean;
            }
            before = (Instant::now(), processor_seconds());
        };
        let ending = Flattener::new(settings, Pins::new()).finish(mesh, Control::new(&cancel, &count), take);
        ending.expect("relaxing does not fail");
        found
    }
}
