//! Constrained problems of the corpus, relaxed at the end, compared with the maps that were published with the
//! meshes.

use std::fs;
use std::path::{Path, PathBuf};

use freebound_core::flatten::Step;
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::pins_in_plane;
use freebound_core::problem::{Embedding, Pins, Settings};
use freebound_core::verify::{distortion, verdict};
use freebound_io::{Constraints, read_mesh};
use glam::DVec2;

use crate::common::table::{Table, seconds};
use crate::outcome::Outcome;
use freebound_testkit::corpus;

/// Rounds of relaxation at the end.
const RELAX_ROUNDS: usize = 20;

const HEADS: [&str; 13] = [
    "set",
    "vertices",
    "pins",
    "planar",
    "rung",
    "steps",
    "error",
    "new",
    "s",
    "s relaxed",
    "energy",
    "published",
    "end",
];

pub(crate) fn run(is_quick: bool) {
    let title = format!(
        "auto on the corpus; energy: mean symmetric Dirichlet energy after {RELAX_ROUNDS} rounds, and of the published map"
    );
    let mut table = Table::new(title, &HEADS);
    for path in sets() {
        let name = name_of(&path);
        if is_quick && !name.starts_with("fran_face") {
            continue;
        }
        let row = row(&path).unwrap_or_else(|error| {
            let mut cells = HEADS.map(|_| "–".to_owned());
            (cells[0], cells[HEADS.len() - 1]) = (name, error);
            cells
        });
        println!("{}", row.join("  "));
        table.row(row);
    }
    println!();
    table.print();
}

/// Constraint files, sorted by name.
pub(crate) fn sets() -> Vec<PathBuf> {
    let entries = fs::read_dir(corpus().join("constrained")).expect("the corpus has constrained sets");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| mesh_of(path).is_file() && !name_of(path).ends_with(".publishedmap"));
    paths.sort();
    paths
}

pub(crate) fn name_of(set: &Path) -> String {
    set.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Name of a constraint file without the number of its constraints: `maze_k4.txt` belongs to `maze`.
fn stem_of(set: &Path) -> String {
    let name = name_of(set);
    name.rsplit_once('_').map_or(name.clone(), |(mesh, _)| mesh.to_owned())
}

fn mesh_of(set: &Path) -> PathBuf {
    set.with_file_name("..").join(format!("{}.obj", stem_of(set)))
}

/// Reads a set's mesh and pins.
pub(crate) fn read_set(path: &Path) -> Result<(DiskMesh, Pins), String> {
    let file = read_mesh(&mesh_of(path)).map_err(|error| error.to_string())?;
    let mesh = DiskMesh::try_from(file.polygons.triangulate()).map_err(|error| error.to_string())?;
    let targets = Constraints::read(path, mesh.vertex_count()).map_err(|error| error.to_string())?.targets;
    Ok((mesh, pins_in_plane(&targets, PictureFrame::default())))
}

fn row(path: &Path) -> Result<[String; 13], String> {
    let (mesh, pins) = read_set(path)?;
    let settings = Settings { relax_rounds: Some(RELAX_ROUNDS), ..Settings::default() };
    let found = Outcome::of(&mesh, settings, &pins);
    let shown = found.solved.as_ref().map(|(_, step)| step).or(found.last.as_ref());
    let relaxed = found.last.as_ref().filter(|step| step.verdict.planar);
    Ok([
        name_of(path),
        mesh.vertex_count().to_string(),
        pins.len().to_string(),
        if found.solved.is_some() { "yes" } else { "NO" }.to_owned(),
        shown.map_or("–", |step| step.candidate.stage.name()).to_owned(),
        found.steps.to_string(),
        shown.map_or("–".to_owned(), |step| format!("{:e}", largest_error(step, &pins))),
        found.new_vertices().map_or("–".to_owned(), |count| count.to_string()),
        seconds(found.seconds_to_solve()),
        seconds(found.seconds),
        relaxed.map_or("–".to_owned(), |step| energy(step.candidate.mesh(&mesh), &step.candidate.solution.embedding)),
        published(path, &mesh).unwrap_or_else(|| "–".to_owned()),
        found.ending,
    ])
}

/// Largest distance of a hard-pinned vertex from its target.
fn largest_error(step: &Step, pins: &Pins) -> f64 {
    let exact = pins.iter().filter(|(_, pin)| pin.kind.is_hard());
    exact.map(|(vertex, pin)| step.candidate.solution.embedding[vertex].distance(pin.target)).fold(0.0, f64::max)
}

/// Mean symmetric Dirichlet energy.
fn energy(mesh: &DiskMesh, embedding: &Embedding) -> String {
    format!("{:.3}", distortion(mesh, embedding).summary.symmetric_dirichlet.mean)
}

/// Energy of the map that was published with a mesh, and its verdict if it is not planar.
fn published(set: &Path, mesh: &DiskMesh) -> Option<String> {
    let text = fs::read_to_string(set.with_file_name(format!("{}.publishedmap.txt", stem_of(set)))).ok()?;
    let mut map = Embedding::from(vec![DVec2::NAN; mesh.vertex_count()]);
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let mut words = line.split_whitespace();
        let vertex: usize = words.next()?.parse().ok()?;
        let [u, v] = [words.next()?.parse().ok()?, words.next()?.parse().ok()?];
        *map.get_mut(vertex)? = DVec2::new(u, v);
    }
    let energy = energy(mesh, &map);
    let verdict = verdict(mesh, &map);
    Some(if verdict.planar { energy } else { format!("{energy} (not planar)") })
}
