//! Files that the session remembers, and what it says in those that it writes.

use std::path::{Path, PathBuf};

use freebound::examples::Example;
use freebound::geom::PictureFrame;
use freebound::io::{EXTENSIONS, OutputFit, OutputKind, hard_targets};
use freebound::mesh::VertexId;
use freebound::session::{Model, Outcome, Problem, RecentFiles};
use freebound::solver::{Control, Ladder, Settings};
use glam::DVec2;

#[test]
fn the_list_survives_a_restart_newest_first() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("deep").join("recent.json");
    let mut recent = RecentFiles::load(store.clone());
    for name in ["/a.obj", "/b.obj", "/a.obj"] {
        recent.remember(Path::new(name));
    }
    assert_eq!(RecentFiles::load(store).paths(), [PathBuf::from("/a.obj"), PathBuf::from("/b.obj")]);
}

#[test]
fn a_broken_list_is_an_empty_one() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("recent.json");
    std::fs::write(&store, "{").unwrap();
    assert!(RecentFiles::load(store).paths().is_empty());
}

/// The dome's first step with hard pins, on a picture twice as wide as high.
fn first_step() -> Outcome {
    let model = Model::example(Example::Dome);
    let mesh = model.disk().expect("a dome is a disk");
    let frame = PictureFrame { aspect: 2.0, ..PictureFrame::default() };
    let targets = [(3, [0.2, 0.2]), (40, [0.8, 0.3]), (11, [0.7, 0.9])];
    let targets = hard_targets(targets.map(|(vertex, uv)| (VertexId::new(vertex), uv.into())));
    let problem = Problem { settings: Settings::default(), frame, targets };
    let mut run = Ladder::new(problem.settings, problem.pins());
    let step = run.step(mesh, Control::unattended()).expect("a dome can be solved");
    Outcome::new(mesh, problem, step)
}

/// The largest error of the hard pins that the report tells.
fn reported(outcome: &Outcome) -> Option<f64> {
    let model = Model::example(Example::Dome);
    let finished = outcome.finished(&model, Vec::new(), OutputFit::Unit);
    finished.report.pins.and_then(|pins| pins.max_hard_error)
}

#[test]
fn a_hard_constraint_that_the_solver_misses_is_reported_though_the_file_has_its_numbers() {
    let mut outcome = first_step();
    assert_eq!(reported(&outcome), Some(0.0));
    outcome.step.candidate.solution.embedding[40] += DVec2::new(0.25, 0.0);
    let error = reported(&outcome).expect("there are hard pins");
    assert!((error - 0.125).abs() < 1e-12, "{error}");
}

#[test]
fn every_format_stands_in_its_own_row_of_the_table() {
    let rows =
        [(OutputKind::Obj, "obj"), (OutputKind::Svg, "svg"), (OutputKind::Png, "png"), (OutputKind::Json, "json")];
    for (kind, extension) in rows {
        let format = kind.format();
        assert_eq!(format.extension, extension);
        assert!(format.ending.ends_with(&format!(".{extension}")) && EXTENSIONS.contains(&format!(".{extension}")));
    }
}
