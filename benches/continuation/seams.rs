//! Closed surfaces cut open along long random seams. Without constraints their free boundaries cross themselves; in
//! the other cases the whole boundary is pinned to a simple polygon.

use std::f64::consts::{PI, TAU};

use freebound_core::geom::Bounds;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Pins, Settings, hard_pins};
use freebound_core::verify::distortion;
use glam::DVec2;

use crate::common::table::{Table, seconds, target};
use crate::outcome::Outcome;
use freebound_testkit::{Relief, bumpy_cap_of, seamed_ball};

/// Disk, by the parameters of its maker.
enum Surface {
    /// Cells along an octahedron's side, number of edges of the seams, relief and seed.
    Ball(i32, usize, Relief, u64),
    /// Number of vertices.
    Cap(usize),
}

impl Surface {
    fn mesh(&self) -> Result<DiskMesh, String> {
        let mesh = match *self {
            Self::Ball(cells, edges, relief, seed) => seamed_ball(cells, edges, relief, seed),
            Self::Cap(vertices) => bumpy_cap_of(vertices, 1),
        };
        DiskMesh::try_from(mesh).map_err(|diagnosis| diagnosis.to_string())
    }

    fn name(&self) -> String {
        match self {
            Self::Ball(_, _, relief, seed) => format!("ball, {relief:?}, {seed}").to_lowercase(),
            Self::Cap(_) => "cap".to_owned(),
        }
    }
}

/// Disks that are flattened without constraints, and their time target in seconds.
const FREE: [Surface; 6] = [
    Surface::Ball(79, 300, Relief::Bumps, 1),
    Surface::Ball(79, 1000, Relief::Bumps, 2),
    Surface::Ball(79, 3000, Relief::Bumps, 3),
    Surface::Ball(79, 300, Relief::Folds, 4),
    Surface::Ball(79, 1000, Relief::Folds, 5),
    Surface::Ball(79, 3000, Relief::Folds, 6),
];
const FREE_SECONDS: f64 = 5.0;

/// Shape that a whole boundary is pinned to.
#[derive(Clone, Copy, Debug)]
enum Held {
    /// Circle, by edge lengths.
    Circle,
    /// Flower with five petals, from the circle by edge lengths: nowhere straight, and concave in five places.
    Flower,
    /// Unconstrained boundary in waves: sheared along x, then along y.
    Waves,
    /// Unconstrained boundary, swirled: half a turn in the middle, none at the farthest point.
    Swirl,
}

/// Height and number of petals, on a circle of radius 1.
const PETALS: [f64; 2] = [0.4, 5.0];

/// Height of a wave, and number of waves, relative to the size.
const WAVES: [f64; 2] = [0.08, 2.0];

const HELD: [(Surface, f64); 3] = [
    (Surface::Cap(15_000), 10.0),
    (Surface::Ball(61, 824, Relief::Bumps, 7), 10.0),
    (Surface::Ball(120, 1648, Relief::Bumps, 8), 60.0),
];

const HEADS: [&str; 11] =
    ["surface", "faces", "boundary", "held", "planar", "rung", "steps", "s", "target s", "energy", "end"];

pub(crate) fn run_free(is_quick: bool) {
    let mut table = Table::new("auto on disks with long seams, without constraints", &HEADS);
    for surface in FREE.iter().take(if is_quick { 1 } else { FREE.len() }) {
        match surface.mesh() {
            Ok(mesh) => show(
                &mut table,
                row(surface, &mesh, Asked { held: "–".to_owned(), pins: Pins::new(), at_most: FREE_SECONDS }),
            ),
            Err(error) => println!("{}: {error}", surface.name()),
        }
    }
    println!();
    table.print();
}

pub(crate) fn run_held(is_quick: bool) {
    let mut table = Table::new("auto with the whole boundary held", &HEADS);
    for (surface, at_most) in HELD.iter().take(if is_quick { 1 } else { HELD.len() }) {
        let mesh = match surface.mesh() {
            Ok(mesh) => mesh,
            Err(error) => {
                println!("{}: {error}", surface.name());
                continue;
            }
        };
        for held in [Held::Circle, Held::Flower, Held::Waves, Held::Swirl] {
            match held.pins(&mesh) {
                Some(pins) => show(
                    &mut table,
                    row(surface, &mesh, Asked { held: format!("{held:?}").to_lowercase(), pins, at_most: *at_most }),
                ),
                None => println!("{}: no planar embedding without constraints", surface.name()),
            }
        }
    }
    println!();
    table.print();
}

fn show(table: &mut Table, row: [String; 11]) {
    println!("{}", row.join("  "));
    table.row(row);
}

/// Case of a disk: name of the constraint, pins, and time target in seconds.
struct Asked {
    held: String,
    pins: Pins,
    at_most: f64,
}

fn row(surface: &Surface, mesh: &DiskMesh, Asked { held, pins, at_most }: Asked) -> [String; 11] {
    let found = Outcome::of(mesh, Settings::default(), &pins);
    let solved = found.solved.as_ref().map(|(_, step)| step);
    let last = found.last.as_ref();
    // Without pins the row shows the relaxed end, so the time is the whole run's.
    let taken = if pins.is_empty() { found.seconds } else { found.seconds_to_solve() };
    let energy = |step: &freebound_core::flatten::Step| {
        format!(
            "{:.3}",
            distortion(step.candidate.mesh(mesh), &step.candidate.solution.embedding).summary.symmetric_dirichlet.mean
        )
    };
    [
        surface.name(),
        mesh.face_count().to_string(),
        mesh.boundary_loop().len().to_string(),
        held,
        if solved.is_some() { "yes" } else { "NO" }.to_owned(),
        solved.or(last).map_or("–", |step| step.candidate.stage.name()).to_owned(),
        found.steps.to_string(),
        seconds(taken),
        target(taken, at_most),
        last.map_or("–".to_owned(), energy),
        found.ending,
    ]
}

impl Held {
    /// Pins all boundary vertices; `None` if that requires a planar embedding and there is none.
    fn pins(self, mesh: &DiskMesh) -> Option<Pins> {
        let places = match self {
            Self::Circle => on_circle(mesh),
            Self::Flower => {
                let petals = |z: &DVec2| (1.0 + PETALS[0] * (PETALS[1] * z.to_angle()).cos()) * *z;
                on_circle(mesh).iter().map(petals).collect()
            }
            Self::Waves => moved(mesh, |z, size| {
                let wave = |by: f64| WAVES[0] * size * (TAU * WAVES[1] * by / size).sin();
                let x = z.x + wave(z.y);
                DVec2::new(x, z.y + wave(x))
            })?,
            Self::Swirl => {
                moved(mesh, |z, size| DVec2::from_angle(PI * (1.0 - 2.0_f64.sqrt() * z.length() / size)).rotate(z))?
            }
        };
        Some(hard_pins(mesh.boundary_loop().iter().copied().zip(places)))
    }
}

/// Points on a circle, angles in proportion to lengths on the surface.
fn on_circle(mesh: &DiskMesh) -> Vec<DVec2> {
    let boundary = mesh.boundary_loop();
    let mut walked = vec![0.0];
    for (k, &vertex) in boundary.iter().enumerate() {
        let next = boundary[(k + 1) % boundary.len()];
        walked.push(walked[k] + mesh.position(vertex).distance(mesh.position(next)));
    }
    walked[..boundary.len()].iter().map(|length| DVec2::from_angle(TAU * length / walked[boundary.len()])).collect()
}

/// Boundary of the unconstrained embedding, moved by a map of the plane. The map gets the position relative to the
/// middle of the bounding box, and the box's longer side.
fn moved(mesh: &DiskMesh, map: impl Fn(DVec2, f64) -> DVec2) -> Option<Vec<DVec2>> {
    let found = Outcome::of(mesh, Settings::default(), &Pins::new());
    let step = found.last.filter(|step| step.verdict.planar)?;
    let boundary = step.candidate.solution.embedding.boundary(mesh);
    let bounds = Bounds::of(boundary.iter().copied());
    let (middle, size) = (bounds.middle(), bounds.size().max_element());
    Some(boundary.iter().map(|&z| middle + map(z - middle, size)).collect())
}
