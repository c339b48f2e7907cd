//! Live dragging of a planar embedding: `DragSolver` along a fixed path.
//!
//! Eight hard pins on a bumpy sheet, seen from above; one of them is dragged. The path resembles that of a hand: it
//! starts slowly, turns, and comes back, with one move per frame for two seconds. A *near* path stays within a
//! fortieth of the sheet's size, like the correction of a landmark; a *far* path covers a third of it.
//!
//! "first" is the time from the press to the first frame, including the setup of the drag. Updates per second are
//! those of the later frames, timed without the whole verdict. The whole verdict is computed separately for each
//! frame. The last column counts the planar frames for which it equals the verdict proved for the moved part.

use std::f64::consts::TAU;
use std::sync::Arc;

use freebound_core::bijective::{DragSolver, DragTarget};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Pin, hard_pins};
use freebound_core::verify::verdict;
use glam::DVec2;

use crate::common::table::{Table, seconds};
use crate::common::time;
use freebound_testkit::{disk, sheet_of_faces};

/// Face counts of the meshes.
const SIZES: [usize; 3] = [20_000, 100_000, 1_000_000];

/// Moves of the pointer.
const MOVES: u32 = 120;

/// Name of a path, and its length relative to the sheet's size.
const PATHS: [(&str, f64); 2] = [("near", 0.025), ("far", 0.33)];

pub(crate) fn print(wanted: &[usize]) {
    let heads = [
        "faces",
        "path",
        "first s",
        "updates a second",
        "worst frame s",
        "moving",
        "on the pointer",
        "planar, as the whole",
    ];
    let mut table = Table::new("dragging one of 8 hard constraints on a planar sheet, proved at every frame", &heads);
    let sizes = if wanted.is_empty() { &SIZES } else { wanted };
    for &faces in sizes {
        let mesh = disk(sheet_of_faces(faces));
        for (name, way) in PATHS {
            table.row(drag(&mesh, name, way));
        }
    }
    table.print();
}

/// Position of the pointer after a share of the path, relative to its length.
fn pointer(share: f64) -> DVec2 {
    let turned = DVec2::from_angle(0.4 + 0.6 * (TAU * share).sin());
    0.5 * (1.0 - (TAU * share).cos()) * turned
}

fn drag(mesh: &DiskMesh, name: &str, way: f64) -> [String; 8] {
    let begin: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    let size = begin.bounds().extent();
    let nearest = |z: DVec2| {
        let by_distance = |a: &VertexId, b: &VertexId| begin[a].distance(z).total_cmp(&begin[b].distance(z));
        mesh.vertices().min_by(by_distance).expect("vertices")
    };
    let around = (0..7).map(|k| 0.35 * size * DVec2::from_angle(0.3 + f64::from(k) * TAU / 7.0));
    let vertices: Vec<VertexId> = std::iter::once(DVec2::new(-0.05, -0.1) * size).chain(around).map(nearest).collect();
    let pins = hard_pins(vertices.iter().map(|&v| (v, begin[v])));
    let (pin, aim) = (vertices[0], DragTarget { pins, sheet: Arc::default() });
    let target = |k: u32| begin[pin] + way * size * pointer(f64::from(k) / f64::from(MOVES));
    let aimed = |k: u32| {
        let mut aim = aim.clone();
        aim.pins.insert(pin, Pin::hard(target(k)));
        aim
    };
    let (mut met, mut proved) = (0, 0);
    let mut observe = |live: &DragSolver, k: u32, found: &freebound_core::verify::Verdict| {
        met += usize::from(live.embedding()[pin] == target(k));
        proved += usize::from(found.planar && *found == verdict(mesh, live.embedding()));
    };
    let (first, (mut live, moved)) = time(|| {
        let mut live = DragSolver::new(mesh, begin.clone(), &[pin], aim.clone()).expect("a planar sheet");
        let moved = live.drag(mesh, &aimed(1), Control::unattended()).expect("nobody stops it");
        (live, moved)
    });
    observe(&live, 1, &moved.verdict);
    let (mut sum, mut worst) = (0.0, 0.0_f64);
    for k in 2..=MOVES {
        let aim = aimed(k);
        let (taken, moved) = time(|| live.drag(mesh, &aim, Control::unattended()).expect("nobody stops it"));
        (sum, worst) = (sum + taken, worst.max(taken));
        observe(&live, k, &moved.verdict);
    }
    [
        mesh.face_count().to_string(),
        name.to_owned(),
        seconds(first),
        format!("{:.1}", f64::from(MOVES - 1) / sum),
        seconds(worst),
        live.moving().len().to_string(),
        format!("{met} of {MOVES}"),
        format!("{proved} of {MOVES}"),
    ]
}
