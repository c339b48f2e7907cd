//! Time and memory by the number of faces: ten pins displaced by a tenth of the size, and eight by a third.

use std::fs;

use freebound_core::problem::Settings;
use freebound_io::peak_memory_bytes;

use crate::common::table::{Table, megabytes, seconds, target};
use crate::outcome::Outcome;
use crate::synthetic::{Cap, Change};
use freebound_testkit::Random;

/// Pins displaced by a part of the size, and numbers of faces with their time targets in seconds on two cores.
struct Growth {
    pins: usize,
    part: f64,
    faces: &'static [(usize, f64)],
}

const NEAR: Growth = Growth { pins: 10, part: 0.1, faces: &[(5_000, 1.0), (20_000, 5.0), (100_000, 40.0)] };
const FAR: Growth =
    Growth { pins: 8, part: 1.0 / 3.0, faces: &[(20_000, 1.5), (50_000, 4.0), (100_000, 10.0), (1_000_000, 150.0)] };

/// Target for the memory at every size, in millions of bytes.
const MOST_MEGABYTES: f64 = 2000.0;

pub(crate) fn run(is_quick: bool) {
    for growth in [NEAR, FAR] {
        growth.run(is_quick);
    }
}

impl Growth {
    fn run(&self, is_quick: bool) {
        let heads = ["faces", "planar", "rung", "steps", "new", "s", "target s", "peak MB", "target MB", "end"];
        let title = format!("auto with {} hard pins displaced by {:.0} % of the size", self.pins, 100.0 * self.part);
        let mut table = Table::new(&title, &heads);
        for &(faces, at_most) in if is_quick { &self.faces[..1] } else { self.faces } {
            let row = self.row(faces, at_most).unwrap_or_else(|error| {
                let mut cells = heads.map(|_| "–".to_owned());
                (cells[0], cells[heads.len() - 1]) = (faces.to_string(), error);
                cells
            });
            println!("{}", row.join("  "));
            table.row(row);
        }
        println!();
        table.print();
    }

    fn row(&self, faces: usize, at_most: f64) -> Result<[String; 10], String> {
        let cap = Cap::of(faces / 2, 1)?;
        let pins = cap.pins(self.pins, Change::Displaced(self.part), &mut Random(faces as u64));
        let is_reset = forget_peak();
        let found = Outcome::of(&cap.mesh, Settings::default(), &pins);
        let peak = peak_memory_bytes().filter(|_| is_reset).and_then(|bytes| usize::try_from(bytes).ok());
        let shown = found.solved.as_ref().map(|(_, step)| step).or(found.last.as_ref());
        Ok([
            cap.mesh.face_count().to_string(),
            if found.solved.is_some() { "yes" } else { "NO" }.to_owned(),
            shown.map_or("–", |step| step.candidate.stage.name()).to_owned(),
            found.steps.to_string(),
            found.new_vertices().map_or("–".to_owned(), |count| count.to_string()),
            seconds(found.seconds_to_solve()),
            target(found.seconds_to_solve(), at_most),
            peak.map_or("–".to_owned(), megabytes),
            peak.map_or("–".to_owned(), |bytes| target(bytes as f64 / 1e6, MOST_MEGABYTES)),
            found.ending,
        ])
    }
}

/// Resets the kernel's high-water mark of memory; false if that is not supported (only Linux is).
pub(crate) fn forget_peak() -> bool {
    fs::write("/proc/self/clear_refs", "5").is_ok()
}
