//! Time from a request to cancel until a run stops: `cargo bench --bench cancel`.
//!
//! Every method that solves a system runs on a large mesh repeatedly. Runs are cancelled at moments spread over
//! their first seconds. The wait lasts from the request until the call has returned. Arguments after `--` select
//! methods by name; a number sets the faces.

mod common;

use std::f64::consts::{SQRT_2, TAU};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use freebound_core::flatten::Flattener;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, NamedOption as _, Phase, Pins, Settings, SolveError, hard_pins,
};
use glam::DVec2;

use common::machine::print_machine;
use common::stop::within;
use common::table::{Table, seconds, target};
use common::{Times, arguments};
use freebound_testkit::bumpy_cap_of;

const FACES: usize = 1_000_000;

/// Number of moments at which a run is cancelled.
const MOMENTS: u32 = 16;

/// Part of a longer run over which the moments are spread.
const SPREAD: Duration = Duration::from_secs(24);

/// Target for the longest wait, seconds.
const WANTED: f64 = 0.1;

/// Methods and families, and true if the pins are constraints with displaced targets.
const METHODS: [(Method, Family, bool); 11] = [
    (Method::Natural, Family::Conformal, false),
    (Method::Natural, Family::MeanValue, false),
    (Method::Natural, Family::MeanValue, true),
    (Method::Iterate, Family::Conformal, true),
    (Method::VirtualBoundary, Family::Conformal, false),
    (Method::Spectral, Family::Conformal, false),
    (Method::AbfPlusPlus, Family::Conformal, false),
    (Method::Slim, Family::Conformal, false),
    (Method::Continuation, Family::Conformal, true),
    (Method::Matchmaker, Family::Conformal, true),
    (Method::Auto, Family::Conformal, true),
];

fn main() {
    print_machine();
    let words = arguments();
    let faces = words.iter().find_map(|word| word.parse().ok()).unwrap_or(FACES);
    let mesh = DiskMesh::try_from(bumpy_cap_of(faces / 2, 1)).expect("a cap is a disk");
    let flat = flat(&mesh);
    let heads = ["method", "weights", "pins", "stopped", "median s", "longest s", "in the phase", "at s", "target s"];
    let mut table = Table::new(format!("stopping a run on {} faces", mesh.face_count()), &heads);
    let names: Vec<&String> = words.iter().filter(|word| word.parse::<usize>().is_err()).collect();
    for (method, family, is_constrained) in METHODS {
        if !names.is_empty() && !names.iter().any(|name| *name == method.name()) {
            continue;
        }
        let settings = Settings::new(method.clone(), family);
        let pins = if is_constrained { pins(&mesh, &flat) } else { Pins::new() };
        let waits = Waits::of(|control| {
            Flattener::new(settings.clone(), pins.clone()).finish(&mesh, control, |_| {}).map(|_| ())
        });
        let worst = waits.worst.as_ref();
        let row = [
            method.name().to_owned(),
            family.name().to_owned(),
            pins.len().to_string(),
            waits.stopped.to_string(),
            seconds(waits.times.median()),
            worst.map_or("–".to_owned(), |worst| seconds(worst.seconds)),
            worst.and_then(|worst| worst.phase).map_or("–", Phase::words).to_owned(),
            worst.map_or("–".to_owned(), |worst| seconds(worst.at)),
            worst.map_or("–".to_owned(), |worst| target(worst.seconds, WANTED)),
        ];
        println!("{}", row.join("  "));
        table.row(row);
    }
    println!();
    table.print();
}

/// Flattens the mesh without pins.
fn flat(mesh: &DiskMesh) -> Embedding {
    let step = Flattener::new(Settings::new(Method::Natural, Family::Conformal), Pins::new())
        .step(mesh, Control::unattended())
        .expect("a cap is flattened");
    step.candidate.solution.embedding
}

/// Eight constraints on a ring halfway out, each moved by a third of the size towards the second next.
fn pins(mesh: &DiskMesh, flat: &Embedding) -> Pins {
    let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let (middle, reach) = ((low + high) / 2.0, (high - low).min_element() / 4.0);
    let place = |k: u32| middle + reach * DVec2::from_angle(TAU * f64::from(k) / 8.0);
    let nearest = |to: DVec2| {
        let distance = |v: &VertexId| flat[*v].distance(to);
        mesh.vertices().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a mesh has vertices")
    };
    hard_pins((0..8).map(|k| (nearest(place(k)), place(k) + (place(k + 2) - place(k)) * (4.0 / 3.0 / SQRT_2))))
}

/// Waits of one method.
#[derive(Default)]
struct Waits {
    stopped: usize,
    times: Times,
    worst: Option<Wait>,
}

/// Wait of one cancelled run.
struct Wait {
    seconds: f64,
    /// Phase that was entered last, and the seconds since the start.
    phase: Option<Phase>,
    at: f64,
}

impl Waits {
    /// Runs the job repeatedly and cancels it. A run that finishes first shortens the spread of the moments.
    fn of(run: impl Fn(Control<'_>) -> Result<(), SolveError>) -> Self {
        let mut found = Self::default();
        let mut spread = SPREAD;
        for moment in 0..MOMENTS {
            // Starts at the last moment, so that the length of a short run is known first.
            let until = spread * (MOMENTS - moment) / MOMENTS;
            let start = Instant::now();
            match stopped(&run, until) {
                Some(wait) => found.add(wait),
                None => spread = spread.min(start.elapsed()),
            }
        }
        found
    }

    fn add(&mut self, wait: Wait) {
        self.stopped += 1;
        self.times.add(wait.seconds);
        if self.worst.as_ref().is_none_or(|worst| worst.seconds < wait.seconds) {
            self.worst = Some(wait);
        }
    }
}

/// Runs a job and cancels it after a while; `None` if it finished before. A job that finishes although it was
/// cancelled has kept its caller waiting too, and counts.
fn stopped(run: impl Fn(Control<'_>) -> Result<(), SolveError>, until: Duration) -> Option<Wait> {
    let (flag, phase) = (AtomicBool::new(false), Mutex::new(None));
    let report = |entered| *phase.lock().expect("nobody panics") = Some(entered);
    let (_, wait) = within(until, &flag, || run(Control::new(&flag, &report)));
    let phase = phase.into_inner().expect("nobody panics");
    Some(Wait { seconds: wait?.as_secs_f64(), phase, at: until.as_secs_f64() })
}
