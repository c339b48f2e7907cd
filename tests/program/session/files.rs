//! Files that the session remembers, and the contents of files that it writes.

use std::fs;
use std::path::{Path, PathBuf};

use freebound::examples::Example;
use freebound::session::{Action, BakeRequest, RecentFiles, SaveRequest, Session, Severity};
use freebound_core::flatten::Flattener;
use freebound_core::geom::{Picture, PictureFrame};
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::pipeline::{Fit, Outcome, Problem, hard_targets};
use freebound_core::problem::{Control, Settings};
use freebound_io::{BakeOptions, EXTENSIONS, OutputKind, Registration};
use glam::DVec2;
use tempfile::TempDir;

use super::basics::{session, settled};
use super::documents::{errors, with_dome, words_of, write_picture};
use crate::cli::program::obj_text;
use freebound_testkit::assert_message;

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

/// First step of the dome with hard pins, on a picture twice as wide as high.
fn first_step() -> Outcome {
    let model = Example::Dome.model();
    let mesh = model.disk().expect("a dome is a disk");
    let frame = PictureFrame { aspect: 2.0, ..PictureFrame::default() };
    let targets = [(3, [0.2, 0.2]), (40, [0.8, 0.3]), (11, [0.7, 0.9])];
    let targets = hard_targets(targets.map(|(vertex, uv)| (VertexId::new(vertex), uv.into())));
    let problem = Problem { settings: Settings::default(), frame, targets, shaped: None };
    let mut run = Flattener::new(problem.settings.clone(), problem.pins());
    let step = run.step(mesh, Control::unattended()).expect("a dome can be solved");
    Outcome::new(mesh, problem, step)
}

/// Largest error of the hard pins in the report.
fn reported(outcome: &Outcome) -> Option<f64> {
    let model = Example::Dome.model();
    let finished = model.finished(outcome, Vec::new(), Fit::Unit);
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
    let rows = [
        (OutputKind::Obj, "obj"),
        (OutputKind::Ply, "ply"),
        (OutputKind::Glb, "glb"),
        (OutputKind::Svg, "svg"),
        (OutputKind::Png, "png"),
        (OutputKind::Json, "json"),
    ];
    for (kind, extension) in rows {
        let format = kind.format();
        assert_eq!(format.extension, extension);
        assert!(format.ending.ends_with(&format!(".{extension}")) && EXTENSIONS.contains(&format!(".{extension}")));
    }
}

/// Folder with a mesh with materials, and with constraints; session with both, a picture, and a project.
fn with_open_files() -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let dome = Example::Dome.mesh();
    let text = obj_text(&PolygonMesh::from(&dome));
    fs::write(path("dome.obj"), format!("mtllib looks.mtl\nusemtl skin\n{text}")).unwrap();
    fs::write(path("looks.mtl"), "newmtl skin\nmap_Kd skin.png\nbump dents.png\n").unwrap();
    fs::write(path("pins.txt"), "3 0.25 0.25 # the nose\n40 0.75 0.25\n").unwrap();
    for name in ["skin.png", "dents.png", "photo.png"] {
        write_picture(&path(name), 4, 4);
    }
    let mut session = session();
    settled(&mut session, Action::Open(path("dome.obj")));
    settled(&mut session, Action::OpenPicture(path("photo.png")));
    settled(&mut session, Action::ImportConstraints(path("pins.txt")));
    settled(&mut session, Action::SaveProject(path("work.freebound")));
    assert!(session.is_current() && errors(&session).is_empty(), "{:?}", session.messages());
    (folder, session)
}

#[test]
fn what_is_open_is_not_written_over() {
    let (folder, mut session) = with_open_files();
    fs::create_dir(folder.path().join("deep")).unwrap();
    let mut messages = Vec::new();
    for name in ["dome.obj", "looks.mtl", "skin.png", "dents.png", "photo.png", "pins.txt", "work.freebound"] {
        let path = folder.path().join("deep").join("..").join(name);
        let before = fs::read(&path).unwrap();
        let mut requests: Vec<Action> = [OutputKind::Obj, OutputKind::Svg, OutputKind::Png, OutputKind::Json]
            .map(|kind| Action::Save(SaveRequest { path: path.clone(), kind, fit: Fit::Unit }))
            .into();
        // Project and constraints may be overwritten.
        requests.extend((name != "work.freebound").then(|| Action::SaveProject(path.clone())));
        requests.extend((name != "pins.txt").then(|| Action::ExportConstraints(path.clone())));
        let mut said = Vec::new();
        for request in requests {
            settled(&mut session, request.clone());
            let message = session.messages().last().expect("said");
            assert!(message.severity == Severity::Error && message.text.contains(name), "{request:?}: {message:?}");
            said.push(words_of(message));
        }
        session.write_file(path.clone(), |out| freebound_io::raster::write_png(&Picture::filled(2, 2, [0; 4]), out));
        session.finish_writing();
        said.push(words_of(session.messages().last().expect("said")));
        said.dedup();
        assert_eq!(said.len(), 1, "{name}: {said:?}");
        messages.append(&mut said);
        assert!(before == fs::read(&path).unwrap(), "{name}");
    }
    assert_message("files-that-are-open", &messages.join("\n"));
}

#[test]
fn project_and_constraints_are_brought_up_to_date_in_their_files() {
    let (folder, mut session) = with_open_files();
    settled(&mut session, Action::Unpin(vec![VertexId::new(3)]));
    settled(&mut session, Action::ExportConstraints(folder.path().join("pins.txt")));
    settled(&mut session, Action::SaveProject(folder.path().join("work.freebound")));
    assert!(errors(&session).is_empty() && !session.has_unsaved_work(), "{:?}", session.messages());
    let pins = fs::read_to_string(folder.path().join("pins.txt")).unwrap();
    assert!(pins.contains("40 0.75 0.25") && !pins.contains("3 0.25"), "{pins}");
}

#[test]
fn what_was_open_before_may_be_written_over() {
    let (folder, mut session) = with_open_files();
    settled(&mut session, Action::OpenExample(Example::Dome));
    let path = folder.path().join("dome.obj");
    settled(&mut session, Action::Save(SaveRequest { path, kind: OutputKind::Obj, fit: Fit::Unit }));
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
}

/// Session with a sheet that has a layout and a picture, and a request for a large picture of that layout.
fn with_large_export() -> (TempDir, Session, Action) {
    let (folder, mut session) = with_dome();
    let at = |name: &str| folder.path().join(name);
    settled(&mut session, Action::Save(SaveRequest { path: at("uv.obj"), kind: OutputKind::Obj, fit: Fit::Unit }));
    settled(&mut session, Action::Open(at("uv.obj")));
    write_picture(&at("skin.png"), 3, 2);
    settled(&mut session, Action::OpenPicture(at("skin.png")));
    let options = BakeOptions { pixels: [8192, 8192], margin: 1000, registration: Registration::AsTheyAre };
    let request = Action::SaveBaked(BakeRequest { path: at("large.png"), options });
    (folder, session, request)
}

#[test]
fn an_export_is_cancelled_and_leaves_nothing() {
    let (folder, mut session, request) = with_large_export();
    session.handle(request);
    settled(&mut session, Action::Cancel);
    assert!(!folder.path().join("large.png").exists());
    let message = session.messages().last().expect("a note");
    assert!(message.text.contains("large.png") && message.severity == Severity::Caution, "{message:?}");
}

#[test]
fn a_pause_of_a_run_does_not_end_an_export() {
    let (folder, mut session, _) = with_large_export();
    let path = folder.path().join("small.png");
    let options = BakeOptions { pixels: [600, 600], margin: 2, registration: Registration::AsTheyAre };
    session.handle(Action::SaveBaked(BakeRequest { path: path.clone(), options }));
    session.handle(Action::Solve);
    assert!(session.is_running());
    settled(&mut session, Action::Cancel);
    assert!(path.exists(), "{:?}", session.messages());
}
