//! What the ladder makes of real constraints: `cargo bench --bench constrained`.
//!
//! `auto` with its default settings on the constrained problems of `../shared/corpus`, one line a set.
//!
//! `cargo bench --bench constrained -- NAME` takes the sets whose name contains NAME.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use freebound::geom::PictureFrame;
use freebound::io::{Constraints, read_mesh};
use freebound::mesh::DiskMesh;
use freebound::session::{Outcome, OutputFit};
use freebound::solver::{Control, Run, Settings, Step};

use common::machine::print_machine;
use common::table::{Table, seconds};
use common::{arguments, time};

const HEADS: [&str; 9] = ["set", "vertices", "pins", "steps", "flips", "crossings", "planar", "largest error", "s"];

fn main() {
    print_machine();
    let name = arguments().first().cloned().unwrap_or_default();
    let mut table = Table::new("auto, with constraints that are to be met exactly", &HEADS);
    for path in sets(&name) {
        table.row(on_set(&path));
    }
    table.print();
}

/// The constraint files whose name contains `name`, in the order of their names.
fn sets(name: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus/constrained");
    let Ok(entries) = fs::read_dir(&folder) else {
        println!("nothing to do: there is no corpus at {}", folder.display());
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| mesh_of(path).is_file() && name_of(path).contains(name));
    paths.sort();
    paths
}

fn name_of(set: &Path) -> String {
    set.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The mesh of a constraint file: `maze_k4.txt` belongs to `maze.obj`.
fn mesh_of(set: &Path) -> PathBuf {
    let name = name_of(set);
    let mesh = name.rsplit_once('_').map_or(name.as_str(), |(mesh, _)| mesh);
    set.with_file_name("..").join(format!("{mesh}.obj"))
}

fn on_set(path: &Path) -> [String; 9] {
    let file = read_mesh(&mesh_of(path)).expect("readable");
    let mesh = DiskMesh::try_from(file.polygons.triangulate()).expect("a disk");
    let pins = Constraints::read(path, mesh.vertex_count()).expect("a constraint file").pins;
    let mut last = None::<Step>;
    let mut run = Run::new(Settings::default(), pins.clone());
    let (elapsed, ending) = time(|| run.finish(&mesh, Control::unattended(), |step| last = Some(step)));
    let name = name_of(path);
    let Some(step) = last else { panic!("{name}: {ending:?}") };
    let steps = step.index + 1;
    let outcome = Outcome::new(&mesh, Settings::default(), (PictureFrame::default(), pins), step);
    let (_, _, verdict) = outcome.output(&mesh, OutputFit::Unit);
    // What the solver gave: in the coordinates to be written, exact pins have their own numbers.
    let error = outcome.pin_error();
    [
        name,
        mesh.vertex_count().to_string(),
        outcome.pins.len().to_string(),
        steps.to_string(),
        verdict.flipped_faces.len().to_string(),
        (verdict.boundary_crossings.len() + verdict.unlisted_crossings).to_string(),
        if verdict.planar { "yes" } else { "no" }.to_owned(),
        format!("{error}"),
        seconds(elapsed),
    ]
}
