//! Bumpy caps with pins displaced at random, swirled, stretched, or permuted.
//!
//! Targets start from the positions of the pins in a planar embedding without constraints. The *size* is the longer
//! side of its bounding box. Displaced, swirled and stretched pins are far apart, like those of the constrained sets
//! of real meshes: each is the vertex farthest from the pins before it, and the first is random. Permuted pins lie
//! anywhere.

use std::f64::consts::{FRAC_PI_2, SQRT_2, TAU};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Pins, Settings, hard_pins};
use freebound_testkit::bumpy_cap_of;
use glam::DVec2;

use crate::common::Times;
use crate::common::table::{Table, seconds};
use crate::outcome::Outcome;
use freebound_testkit::Random;

const VERTICES: [usize; 3] = [800, 5_000, 20_000];
const PINS: [usize; 4] = [3, 6, 12, 24];
const SEEDS: u64 = 3;

/// Change from the positions of the vertices to their targets.
#[derive(Clone, Copy)]
pub(crate) enum Change {
    /// Displaced by this part of the size, in random directions.
    Displaced(f64),
    /// Turned around the middle: by a quarter turn there, not at all at the distance of the outermost pin.
    Swirled,
    /// Stretched to twice as long as wide, with unchanged area.
    Stretched,
    /// Permuted at random.
    Permuted,
}

const CHANGES: [Change; 5] =
    [Change::Displaced(0.03), Change::Displaced(0.1), Change::Displaced(0.2), Change::Swirled, Change::Stretched];

impl Change {
    fn name(self) -> String {
        match self {
            Self::Displaced(part) => format!("displaced by {:.0} %", 100.0 * part),
            Self::Swirled => "swirl".to_owned(),
            Self::Stretched => "stretch 2:1".to_owned(),
            Self::Permuted => "permuted".to_owned(),
        }
    }
}

/// Cap with its planar embedding without constraints.
pub(crate) struct Cap {
    pub(crate) mesh: DiskMesh,
    embedding: Embedding,
}

impl Cap {
    /// Makes a cap of about this number of vertices. The error is a message.
    pub(crate) fn of(vertices: usize, seed: u64) -> Result<Self, String> {
        let mesh = DiskMesh::try_from(bumpy_cap_of(vertices, seed)).map_err(|diagnosis| diagnosis.to_string())?;
        let mut last = None::<Step>;
        let mut run = Flattener::new(Settings::default(), Pins::new());
        run.finish(&mesh, Control::unattended(), |step| last = Some(step)).map_err(|error| error.to_string())?;
        let step = last.filter(|step| step.verdict.planar).ok_or("no planar embedding without constraints")?;
        Ok(Self { mesh, embedding: step.candidate.solution.embedding })
    }

    /// Pins this number of different vertices.
    pub(crate) fn pins(&self, count: usize, change: Change, random: &mut Random) -> Pins {
        let vertices = match change {
            Change::Permuted => self.vertices_anywhere(count, random),
            _ => self.vertices_apart(count, random),
        };
        let places: Vec<DVec2> = vertices.iter().map(|v| self.embedding[v]).collect();
        let targets = self.changed(&places, change, random);
        hard_pins(vertices.into_iter().zip(targets))
    }

    fn vertices_anywhere(&self, count: usize, random: &mut Random) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = Vec::new();
        while vertices.len() < count {
            let vertex = VertexId::from_index(below(random, self.mesh.vertex_count()));
            if !vertices.contains(&vertex) {
                vertices.push(vertex);
            }
        }
        vertices
    }

    fn vertices_apart(&self, count: usize, random: &mut Random) -> Vec<VertexId> {
        let mut vertices = vec![VertexId::from_index(below(random, self.mesh.vertex_count()))];
        let mut nearest = vec![f64::INFINITY; self.embedding.len()];
        while vertices.len() < count {
            let latest = self.embedding[vertices[vertices.len() - 1].index()];
            for (distance, z) in nearest.iter_mut().zip(&self.embedding) {
                *distance = distance.min(z.distance(latest));
            }
            let farthest = self.mesh.vertices().max_by(|a, b| nearest[a.index()].total_cmp(&nearest[b.index()]));
            vertices.extend(farthest);
        }
        vertices
    }

    fn changed(&self, places: &[DVec2], change: Change, random: &mut Random) -> Vec<DVec2> {
        let low = self.embedding.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = self.embedding.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let (size, middle) = ((high - low).max_element(), places.iter().sum::<DVec2>() / places.len() as f64);
        let reach = places.iter().map(|z| z.distance(middle)).fold(0.0, f64::max);
        let mut displaced = |z: DVec2, part: f64| z + part * size * DVec2::from_angle(TAU * random.unit());
        match change {
            Change::Displaced(part) => places.iter().map(|&z| displaced(z, part)).collect(),
            Change::Swirled => {
                let turn = |z: DVec2| DVec2::from_angle(FRAC_PI_2 * (1.0 - z.distance(middle) / reach));
                places.iter().map(|&z| middle + turn(z).rotate(z - middle)).collect()
            }
            Change::Stretched => {
                places.iter().map(|&z| middle + (z - middle) * DVec2::new(SQRT_2, SQRT_2.recip())).collect()
            }
            Change::Permuted => {
                let mut shuffled = places.to_vec();
                for last in (1..shuffled.len()).rev() {
                    shuffled.swap(last, below(random, last + 1));
                }
                shuffled
            }
        }
    }
}

/// Random whole number below a limit.
pub(crate) fn below(random: &mut Random, limit: usize) -> usize {
    usize::try_from(random.bits() >> 32).unwrap_or_default() % limit
}

/// Statistics over runs of one kind.
#[derive(Default)]
struct Count {
    runs: usize,
    planar: usize,
    without_new: usize,
    worst: f64,
    times: Times,
}

impl Count {
    fn add(&mut self, found: &Outcome) {
        self.runs += 1;
        self.planar += usize::from(found.solved.is_some());
        self.without_new += usize::from(found.new_vertices() == Some(0));
        self.worst = self.worst.max(found.seconds_to_solve());
        self.times.add(found.seconds_to_solve());
    }

    fn row(&self, vertices: String, change: String) -> [String; 7] {
        let share = |count: usize| format!("{:.0} %", 100.0 * count as f64 / self.runs as f64);
        let [planar, without] = [self.planar, self.without_new].map(share);
        [vertices, change, self.runs.to_string(), planar, without, seconds(self.times.median()), seconds(self.worst)]
    }
}

pub(crate) fn run(is_quick: bool) {
    let heads = ["vertices", "targets", "runs", "planar", "without new", "median s", "worst s"];
    let mut table = Table::new("auto on bumpy caps with 3, 6, 12 and 24 hard pins", &heads);
    let (sizes, seeds) = if is_quick { (&VERTICES[..1], 1) } else { (&VERTICES[..], SEEDS) };
    for &vertices in sizes {
        let caps: Vec<Cap> = (1..=seeds).filter_map(|seed| cap_or_word(vertices, seed)).collect();
        let permuted = if vertices <= 5_000 { &[Change::Permuted][..] } else { &[] };
        for &change in CHANGES.iter().chain(permuted) {
            let count = over(&caps, change);
            let row = count.row(vertices.to_string(), change.name());
            println!("{}", row.join("  "));
            table.row(row);
        }
    }
    println!();
    table.print();
}

fn cap_or_word(vertices: usize, seed: u64) -> Option<Cap> {
    Cap::of(vertices, seed).map_err(|error| println!("cap of {vertices} vertices, seed {seed}: {error}")).ok()
}

/// Runs all numbers of pins on all caps; prints the names of runs that fail.
fn over(caps: &[Cap], change: Change) -> Count {
    let mut count = Count::default();
    for (cap, seed) in caps.iter().zip(1_u64..) {
        for pin_count in PINS {
            let mut random = Random(1000 * seed + pin_count as u64);
            let pins = cap.pins(pin_count, change, &mut random);
            let found = Outcome::of(&cap.mesh, Settings::default(), &pins);
            if found.solved.is_none() {
                let (vertices, name) = (cap.mesh.vertex_count(), change.name());
                let stage = found.last.as_ref().map_or("–", |step| step.candidate.stage.name());
                println!(
                    "FAILED: {vertices} vertices, {pin_count} pins {name}, seed {seed}: {stage}: {}",
                    found.ending
                );
            }
            count.add(&found);
        }
    }
    count
}
