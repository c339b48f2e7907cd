//! Rough terrain, which conformal weights fold: `cargo bench --bench terrain`.
//!
//! Fractional Brownian motion over a jittered grid: octaves of smooth noise. Each octave has half the wavelength of
//! the one before, and 2⁻ᴴ times its height. On steep slopes triangles have obtuse angles and cotangents turn
//! negative. Every program that solves this system folds some faces. This benchmark only counts them.
//!
//! `cargo bench --bench terrain -- FILE.obj` writes the terrain, to be opened in the editor.

mod common;

use std::path::Path;

use freebound_core::flatten::solve_once;
use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Control, Family, Method, Pins, Settings};
use freebound_core::verify::{distortion, verdict};
use freebound_io::{MeshFile, Texture, write_atomically, write_obj};
use glam::{DVec2, DVec3};

use common::machine::print_machine;
use common::table::Table;
use common::{arguments, time};
use freebound_testkit::{Random, sheet_of_faces};

const FACES: usize = 100_000;

/// Hurst exponent H: 1 is smooth, 0 is rough at every scale; mountains have about 0.8.
const HURST: f64 = 0.8;

/// Height of the first octave; the terrain's width is 2.
const HEIGHT: f64 = 0.4;

/// Number of octaves: the last has a wavelength of about two cells.
const OCTAVES: u32 = 7;

/// Nodes of the noise lattice along each axis.
const LATTICE: usize = 512;

/// Smooth noise on a periodic lattice of random values.
struct Noise(Vec<f64>);

impl Noise {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        Self((0..LATTICE * LATTICE).map(|_| 2.0 * random.unit() - 1.0).collect())
    }

    /// Values at the corners of the lattice cell, blended by 3t² − 2t³.
    fn at(&self, point: DVec2) -> f64 {
        let cell = point.floor();
        let t = point - cell;
        let t = t * t * (DVec2::splat(3.0) - 2.0 * t);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a remainder lies in the lattice")]
        let wrapped = |x: f64, step: usize| (x.rem_euclid(LATTICE as f64) as usize + step) % LATTICE;
        let value = |i: usize, j: usize| self.0[wrapped(cell.y, j) * LATTICE + wrapped(cell.x, i)];
        let row = |j: usize| value(0, j) * (1.0 - t.x) + value(1, j) * t.x;
        row(0) * (1.0 - t.y) + row(1) * t.y
    }

    /// Sum of the octaves.
    fn fractal(&self, point: DVec2) -> f64 {
        /// Lattice cells across the terrain in the first octave, and offset that decorrelates the octaves.
        const FIRST: f64 = 2.0;
        const SHIFT: f64 = 17.3;
        (0..OCTAVES)
            .map(|octave| {
                let (frequency, height) = (FIRST * f64::from(octave).exp2(), (-HURST * f64::from(octave)).exp2());
                height * self.at(point * frequency + DVec2::splat(SHIFT * f64::from(octave)))
            })
            .sum()
    }
}

/// The sheet's grid seen from above, displaced by the noise.
fn terrain() -> TriMesh {
    let noise = Noise::new(2005);
    let mut mesh = sheet_of_faces(FACES);
    for p in &mut mesh.positions {
        *p = DVec3::new(p.x, p.y, HEIGHT * noise.fractal(p.truncate()));
    }
    mesh
}

fn main() {
    let mesh = terrain();
    if let Some(path) = arguments().first() {
        let file = MeshFile::from(&mesh);
        write_atomically(Path::new(path), |out| write_obj(out, &file, &Texture::default()))
            .expect("the file can be written");
        println!("wrote {path}");
        return;
    }
    print_machine();
    let mesh = DiskMesh::try_from(mesh).expect("a terrain is a disk");
    let heads = [
        "family",
        "flipped faces",
        "crossings",
        "overwound",
        "turning",
        "residual",
        "replaced pivots",
        "angle p99",
        "solve s",
        "verdict s",
    ];
    let title = format!("rough terrain, natural boundary, {} faces", mesh.face_count());
    let mut table = Table::new(title, &heads);
    for family in [Family::Conformal, Family::MeanValue] {
        let settings = Settings::new(Method::Natural, family);
        let (solve, solution) = time(|| solve_once(&mesh, &settings, &Pins::new(), Control::unattended()));
        let solution = solution.expect("a good answer");
        let linear = solution.linear.expect("a linear method");
        let (prove, found) = time(|| verdict(&mesh, &solution.embedding));
        table.row([
            family.to_string(),
            found.flipped_faces.len().to_string(),
            found.crossing_count_in_words(),
            found.overwound_vertices.len().to_string(),
            found.turning_number.map_or_else(|| "-".to_owned(), |turns| turns.to_string()),
            format!("{:.1e}", linear.residual),
            linear.replaced_pivots.to_string(),
            format!("{:.1}", distortion(&mesh, &solution.embedding).summary.angle.p99),
            format!("{solve:.3}"),
            format!("{prove:.3}"),
        ]);
    }
    table.print();
}
