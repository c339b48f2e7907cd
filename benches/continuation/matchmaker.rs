//! Number of new vertices, and distortion of maps that need them.
//!
//! The first cases are the constrained sets of the corpus with permuted targets. Others pin whole boundaries to
//! curves that cross themselves. The last ones are the unchanged sets, by stage 5 alone and by stage 4, which needs
//! no new vertex.

use std::f64::consts::TAU;
use std::path::Path;

use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Method, Pin, Pins, Settings, hard_pins};
use freebound_core::verify::distortion;
use glam::DVec2;

use crate::common::table::{Table, ratio, seconds};
use crate::corpus::{name_of, read_set, sets};
use crate::outcome::Outcome;
use crate::synthetic::{Cap, below};
use freebound_testkit::Random;

/// Vertices of the caps with pinned boundaries.
const CAPS: [usize; 3] = [300, 1_000, 4_000];

/// Closed curve that a boundary is pinned to.
#[derive(Clone, Copy)]
enum Course {
    /// Circle on which this number of pairs of neighbours have changed places.
    Swapped(usize),
    /// Lemniscate, which crosses itself once.
    Eight,
    /// Limaçon with an inner loop, which turns twice.
    Loop,
}

const COURSES: [Course; 3] = [Course::Swapped(8), Course::Eight, Course::Loop];

impl Course {
    fn name(self) -> String {
        match self {
            Self::Swapped(pairs) => format!("{pairs} pairs swapped"),
            Self::Eight => "figure eight".to_owned(),
            Self::Loop => "inner loop".to_owned(),
        }
    }

    /// Points of the boundary on the curve, counter-clockwise on a circle. The steps are offset so that no two
    /// points are symmetric; all points differ.
    fn places(self, count: usize) -> Vec<DVec2> {
        let turns = (0..count).map(|k| TAU * (k as f64 + 0.37) / count as f64);
        match self {
            Self::Swapped(pairs) => {
                let mut places: Vec<DVec2> = turns.map(DVec2::from_angle).collect();
                (0..pairs).map(|pair| pair * count / pairs).for_each(|at| places.swap(at, at + 1));
                places
            }
            Self::Eight => turns.map(|turn| DVec2::new(turn.cos(), turn.sin() * turn.cos())).collect(),
            Self::Loop => turns.map(|turn| (0.5 + turn.cos()) * DVec2::from_angle(turn)).collect(),
        }
    }
}

const HEADS: [&str; 10] =
    ["targets", "vertices", "pins", "rung", "new at first", "new", "s to first", "s", "energy", "end"];

pub(crate) fn run(is_quick: bool) {
    let mut table = Table::new("new vertices where pins are in each other's way; energy after all relaxing", &HEADS);
    let mut add = |row: Vec<String>| {
        println!("{}", row.join("  "));
        table.row(row);
    };
    let few = |path: &Path| !is_quick || name_of(path).starts_with("fran_face");
    for path in sets().iter().filter(|path| few(path)) {
        match read_set(path) {
            Ok((mesh, pins)) => {
                let name = format!("{} permuted", name_of(path));
                add(row(&name, &mesh, &permuted(&pins), Settings::default()));
            }
            Err(error) => println!("{}: {error}", name_of(path)),
        }
    }
    for &vertices in if is_quick { &CAPS[..1] } else { &CAPS[..] } {
        for course in COURSES {
            match Cap::of(vertices, 1) {
                Ok(cap) => {
                    let name = format!("boundary, {}", course.name());
                    add(row(&name, &cap.mesh, &held_boundary(&cap.mesh, course), Settings::default()));
                }
                Err(error) => println!("cap of {vertices} vertices: {error}"),
            }
        }
    }
    println!();
    table.print();
    beside_rung_4(&few);
}

/// Solves the unchanged sets by stage 5 and by stage 4.
fn beside_rung_4(few: &dyn Fn(&Path) -> bool) {
    let heads = ["set", "new", "s", "energy", "s by rung 4", "energy by rung 4", "times"];
    let mut table = Table::new("rung 5 on sets that rung 4 can do", &heads);
    for path in sets().iter().filter(|path| few(path)) {
        let Ok((mesh, pins)) = read_set(path) else { continue };
        let [five, four] = [Method::Matchmaker, Method::Continuation].map(|method| {
            let settings = Settings { method, ..Settings::default() };
            Outcome::of(&mesh, settings, &pins)
        });
        let [of_five, of_four] = [&five, &four].map(|found| energy(&mesh, found));
        let times = of_five.zip(of_four).map_or("–".to_owned(), |(five, four)| ratio(five / four));
        let [of_five, of_four] = [of_five, of_four].map(shown);
        let new = new_at_end(&five);
        let row = [name_of(path), new, seconds(five.seconds), of_five, seconds(four.seconds), of_four, times];
        println!("{}", row.join("  "));
        table.row(row);
    }
    println!();
    table.print();
}

fn row(name: &str, mesh: &DiskMesh, pins: &Pins, settings: Settings) -> Vec<String> {
    let found = Outcome::of(mesh, settings, pins);
    let step = found.solved.as_ref().map(|(_, step)| step);
    vec![
        name.to_owned(),
        mesh.vertex_count().to_string(),
        pins.len().to_string(),
        step.map_or("–", |step| step.candidate.stage.name()).to_owned(),
        found.new_vertices().map_or("–".to_owned(), |count| count.to_string()),
        new_at_end(&found),
        seconds(found.seconds_to_solve()),
        seconds(found.seconds),
        shown(energy(mesh, &found)),
        found.ending,
    ]
}

/// Number of new vertices of the last step if it meets the pins.
fn new_at_end(found: &Outcome) -> String {
    let solved = found.last.as_ref().filter(|step| step.verdict.planar && step.unmet().is_empty());
    let count =
        solved.map(|step| step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices().len()));
    count.map_or("–".to_owned(), |count| count.to_string())
}

/// Mean symmetric Dirichlet energy of the last step if it is planar and meets the pins.
fn energy(mesh: &DiskMesh, found: &Outcome) -> Option<f64> {
    let step = found.last.as_ref().filter(|step| step.verdict.planar && step.unmet().is_empty())?;
    Some(distortion(step.candidate.mesh(mesh), &step.candidate.solution.embedding).summary.symmetric_dirichlet.mean)
}

fn shown(energy: Option<f64>) -> String {
    energy.map_or("–".to_owned(), |energy| format!("{energy:.3}"))
}

/// Vertices with a cyclic permutation of their targets (Sattolo 1986).
fn permuted(pins: &Pins) -> Pins {
    let mut random = Random(16);
    let mut targets: Vec<DVec2> = pins.values().map(|pin| pin.target).collect();
    for last in (1..targets.len()).rev() {
        targets.swap(last, below(&mut random, last));
    }
    pins.iter().zip(targets).map(|((&vertex, pin), target)| (vertex, Pin { target, ..*pin })).collect()
}

/// Pins all vertices of the boundary to a curve.
fn held_boundary(mesh: &DiskMesh, course: Course) -> Pins {
    let boundary: &[VertexId] = mesh.boundary_loop();
    hard_pins(boundary.iter().copied().zip(course.places(boundary.len())))
}
