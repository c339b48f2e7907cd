//! Strokes of brushes on a planar embedding: `BrushSolver` along a fixed path.
//!
//! A bumpy sheet, seen from above. The pointer goes back and forth over a third of the sheet's size, one frame at a
//! time, for two seconds at 60 frames per second. A *small* brush has a fortieth of the sheet's size as its radius, a
//! *large* one a tenth: it narrows to the most vertices that a dab moves. Strokes run in the inside and along the
//! boundary, where the outside moves too.
//!
//! "first" is the time from the press to the first frame. Frames per second are those of the later frames, timed
//! without the whole verdict, which is computed separately every tenth frame. "as the whole" counts the frames of these
//! that are planar and for which it equals the verdict proved from the moved part. The last column is the mean time of the
//! verdict that a stroke on the page adds: the moved faces against an equal sheet that lies beside.

use std::f64::consts::TAU;
use std::sync::Arc;

use freebound_core::bijective::{Brush, BrushKind, BrushSolver, DragTarget};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Embedding, Pins};
use freebound_core::verify::{ChartInPlane, shaped_verdict, verdict};
use glam::DVec2;

use crate::common::table::{Table, seconds};
use crate::common::time;
use freebound_testkit::{disk, sheet_of_faces};

/// Face counts of the meshes.
const SIZES: [usize; 2] = [20_000, 100_000];

/// Frames of a stroke.
const FRAMES: u32 = 120;

/// Frames between two whole verdicts.
const CHECKED: u32 = 10;

/// Names of radii, and their lengths relative to the sheet's size.
const RADII: [(&str, f64); 2] = [("small", 0.025), ("large", 0.1)];

pub(crate) fn print(wanted: &[usize]) {
    let heads = [
        "faces",
        "brush",
        "size",
        "place",
        "first s",
        "frames a second",
        "worst frame s",
        "moved",
        "as the whole",
        "among charts s",
    ];
    let mut table = Table::new("strokes of brushes on a planar sheet, proved at every frame", &heads);
    let sizes = if wanted.is_empty() { &SIZES[..] } else { wanted };
    for &faces in sizes {
        let mesh = disk(sheet_of_faces(faces));
        for kind in BrushKind::ALL {
            for (size, radius) in RADII {
                let places = if kind == BrushKind::Smooth { &["boundary"][..] } else { &["inside", "boundary"] };
                for place in places {
                    table.row(stroke(&mesh, kind, (size, radius), place));
                }
            }
        }
    }
    table.print();
}

fn stroke(mesh: &DiskMesh, kind: BrushKind, (name, share): (&str, f64), place: &str) -> [String; 10] {
    let begin: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    let bounds = begin.bounds();
    let size = bounds.extent();
    let from = if place == "inside" { DVec2::splat(-0.1) * size } else { DVec2::new(-0.5, -0.1) * bounds.size() };
    let along = if place == "inside" { DVec2::new(0.3, 0.1) } else { DVec2::new(0.0, 0.3) };
    // A grab stays within its rubber; other brushes sweep.
    let reach = if kind == BrushKind::Grab { 0.5 * share } else { 0.33 };
    let pointer = |k: u32| from + reach * size * along * (0.5 - 0.5 * (TAU * f64::from(k) / f64::from(FRAMES)).cos());
    let target = DragTarget { pins: Pins::new(), sheet: Arc::default() };
    let brush = Brush { kind, radius: share * size, strength: 0.5 };
    let (first, mut solver) = time(|| {
        let mut solver = BrushSolver::new(mesh, begin, target, brush, pointer(0)).expect("a planar sheet");
        solver.frame(mesh, pointer(1), Control::unattended()).expect("nobody stops it");
        solver
    });
    let beside: Embedding =
        mesh.mesh().positions.iter().map(|p| p.truncate() + 1.01 * bounds.size().with_y(0.0)).collect();
    let (mut sum, mut worst, mut proved, mut checked, mut judging) = (0.0, 0.0_f64, 0, 0, 0.0);
    for k in 2..=FRAMES {
        let (taken, frame) = time(|| solver.frame(mesh, pointer(k), Control::unattended()).expect("nobody stops it"));
        (sum, worst) = (sum + taken, worst.max(taken));
        if k % CHECKED == 0 {
            checked += 1;
            proved += u32::from(frame.verdict.planar && frame.verdict == verdict(mesh, solver.embedding()));
            let charts = [solver.embedding(), &beside].map(|coordinates| ChartInPlane { mesh, coordinates });
            let (taken, judged) = time(|| shaped_verdict(&charts, 0, solver.moved()));
            assert!(judged.folded.is_empty(), "a planar sheet has no flipped face");
            judging += taken;
        }
    }
    [
        mesh.face_count().to_string(),
        format!("{kind:?}").to_lowercase(),
        name.to_owned(),
        place.to_owned(),
        seconds(first),
        format!("{:.1}", f64::from(FRAMES - 1) / sum),
        seconds(worst),
        solver.moved().len().to_string(),
        format!("{proved} of {checked}"),
        seconds(judging / f64::from(checked)),
    ]
}
