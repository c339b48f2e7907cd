//! Runs of a study as a table (CSV), one row each, out and in again.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::WriteError;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::study::{
    Defects, Limits, Patience, Record, StopReason, Studied, SystemForm, Trial, TrialOutcome,
};
use freebound_core::problem::{Family, Pins, Treatment, hard_pins};

/// Row of the table: everything needed to repeat the run on its mesh, and its result.
#[derive(Debug, Serialize, Deserialize)]
struct Row {
    mesh: String,
    run: u64,
    family: Family,
    treatment: Treatment,
    /// Pins in the form of `--pin`, `V:U,V` each, separated by spaces.
    pins: String,
    pin_count: usize,
    pins_inside: usize,
    pin_distance: f64,
    displacement: Option<f64>,
    outcome: String,
    reason: String,
    steps: usize,
    distortion: f64,
    first_flips: Option<usize>,
    first_crossings: Option<usize>,
    first_overwound: Option<usize>,
    first_turning_number: Option<i64>,
    last_flips: Option<usize>,
    last_crossings: Option<usize>,
    last_overwound: Option<usize>,
    last_turning_number: Option<i64>,
    mirrored: bool,
    last_move: Option<f64>,
    free_residual: Option<f64>,
    pinned_residual: Option<f64>,
    vertices: usize,
    faces: usize,
    boundary_vertices: usize,
    dividing_edges: usize,
    ears: usize,
    max_steps: usize,
    past_stall: bool,
}

impl Row {
    fn of(studied: &Studied, record: &Record) -> Self {
        let Record { trial, first, last, rest, .. } = record;
        let form = studied.form;
        let of = |defects: &Option<Defects>, what: fn(&Defects) -> usize| defects.as_ref().map(what);
        let turns = |defects: &Option<Defects>| defects.as_ref().and_then(|defects| defects.turning_number);
        Self {
            mesh: studied.mesh.clone(),
            run: trial.number,
            family: trial.family,
            treatment: trial.treatment,
            pins: in_words(&trial.pins),
            pin_count: trial.pins.len(),
            pins_inside: record.pins_inside,
            pin_distance: record.pin_distance,
            displacement: trial.displacement,
            outcome: record.outcome.name().to_owned(),
            reason: record.outcome.reason().to_owned(),
            steps: record.steps,
            distortion: record.distortion,
            first_flips: of(first, |defects| defects.flips),
            first_crossings: of(first, |defects| defects.crossings),
            first_overwound: of(first, |defects| defects.overwound),
            first_turning_number: turns(first),
            last_flips: of(last, |defects| defects.flips),
            last_crossings: of(last, |defects| defects.crossings),
            last_overwound: of(last, |defects| defects.overwound),
            last_turning_number: turns(last),
            mirrored: last.is_some_and(|last| last.mirrored),
            last_move: rest.and_then(|rest| rest.last_move),
            free_residual: rest.map(|rest| rest.free_residual),
            pinned_residual: rest.map(|rest| rest.pinned_residual),
            vertices: form.vertices,
            faces: form.faces,
            boundary_vertices: form.boundary,
            dividing_edges: form.dividing_edges,
            ears: form.ears,
            max_steps: studied.limits.max_steps,
            past_stall: studied.limits.patience == Patience::ToTheLimit,
        }
    }

    fn form(&self) -> SystemForm {
        SystemForm {
            vertices: self.vertices,
            faces: self.faces,
            boundary: self.boundary_vertices,
            dividing_edges: self.dividing_edges,
            ears: self.ears,
        }
    }

    fn limits(&self) -> Limits {
        let patience = if self.past_stall { Patience::ToTheLimit } else { Patience::OfMethod };
        Limits { max_steps: self.max_steps, patience }
    }

    /// Record of the row; `None` if its outcome or its pins cannot be parsed.
    fn record(&self) -> Option<Record> {
        let defects = |flips: Option<usize>, counts: [Option<usize>; 2], turning_number| {
            let [crossings, overwound] = counts;
            let (flips, crossings, overwound) = (flips?, crossings?, overwound?);
            Some(Defects { flips, crossings, overwound, turning_number, mirrored: false })
        };
        let first = defects(self.first_flips, [self.first_crossings, self.first_overwound], self.first_turning_number);
        let last = defects(self.last_flips, [self.last_crossings, self.last_overwound], self.last_turning_number);
        let rest = self.free_residual.zip(self.pinned_residual).map(|(free_residual, pinned_residual)| StopReason {
            last_move: self.last_move,
            free_residual,
            pinned_residual,
        });
        Some(Record {
            trial: Trial {
                number: self.run,
                family: self.family,
                treatment: self.treatment,
                pins: from_words(&self.pins)?,
                displacement: self.displacement,
            },
            pins_inside: self.pins_inside,
            pin_distance: self.pin_distance,
            outcome: TrialOutcome::named(&self.outcome, &self.reason)?,
            steps: self.steps,
            first,
            distortion: self.distortion,
            last: last.map(|last| Defects { mirrored: self.mirrored, ..last }),
            rest,
        })
    }
}

/// Pins in the form of `--pin`, exact to the last bit.
fn in_words(pins: &Pins) -> String {
    let words = pins.iter().map(|(vertex, pin)| format!("{}:{:?},{:?}", vertex.number(), pin.target.x, pin.target.y));
    words.collect::<Vec<_>>().join(" ")
}

fn from_words(text: &str) -> Option<Pins> {
    let pin = |words: &str| {
        let (vertex, place) = words.split_once(':')?;
        let (u, v) = place.split_once(',')?;
        Some((VertexId::new(vertex.parse().ok()?), DVec2::new(u.parse().ok()?, v.parse().ok()?)))
    };
    Some(hard_pins(text.split_whitespace().map(pin).collect::<Option<Vec<_>>>()?))
}

/// Writes a header and a row for each run, mesh by mesh.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_study(out: &mut impl Write, studied: &[Studied]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for of in studied {
        for record in &of.records {
            table.serialize(Row::of(of, record)).map_err(io::Error::from)?;
        }
    }
    table.flush()
}

/// Reads a table of [`write_study`].
///
/// # Errors
///
/// If the file cannot be read or is no such table; the error names the faulty line or run.
pub fn read_study(path: &Path) -> Result<Vec<Studied>, WriteError> {
    let failed = |error: io::Error| WriteError::reading(path, error);
    let mut table = csv::Reader::from_reader(File::open(path).map_err(failed)?);
    let mut studied: Vec<Studied> = Vec::new();
    for row in table.deserialize() {
        let row: Row = row.map_err(|error| failed(io::Error::new(io::ErrorKind::InvalidData, error)))?;
        let Some(record) = row.record() else {
            let text = format!("run {} of {}: not a row of a study", row.run, row.mesh);
            return Err(failed(io::Error::new(io::ErrorKind::InvalidData, text)));
        };
        match studied.last_mut() {
            Some(last) if last.mesh == row.mesh && last.limits == row.limits() => last.records.push(record),
            _ => {
                studied.push(Studied { form: row.form(), limits: row.limits(), mesh: row.mesh, records: vec![record] });
            }
        }
    }
    Ok(studied)
}
