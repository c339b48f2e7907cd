//! Projects: everything is restored, changes are reported, and the session tracks unsaved work.

use std::fs;
use std::path::{Path, PathBuf};

use freebound::examples::Example;
use freebound::session::{Action, ChartState, Message, MissingFile, Session, Severity};
use freebound_core::geom::{ConvexPolygon, VAxis};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{
    BoundaryShape, Embedding, Family, GaugeSize, Growth, Method, NamedOption as _, Settings, Spacing, Stage, Treatment,
};
use freebound_io::{FileStamp, PathStyle, ProjectError, ProjectFile, ProjectSource, ProjectView};
use glam::DVec2;
use tempfile::TempDir;

use super::basics::{opened, session, settle, settled};
use super::documents::{errors, id, place, with_dome, words_of, write_dome, write_picture};
use freebound_testkit::assert_message;

fn project_in(folder: &TempDir) -> PathBuf {
    folder.path().join("work.freebound")
}

fn reopened(path: &Path) -> Session {
    let mut session = session();
    settled(&mut session, Action::Open(path.to_owned()));
    session
}

/// Dome with everything that a project contains.
fn with_everything() -> (TempDir, Session) {
    let (folder, mut session) = with_dome();
    fs::create_dir(folder.path().join("pictures")).unwrap();
    let picture = folder.path().join("pictures").join("ä b.png");
    write_picture(&picture, 5, 3);
    settled(&mut session, Action::OpenPicture(picture));
    settled(&mut session, Action::SetVAxis(VAxis::Down));
    settled(&mut session, Action::TurnFaces);
    let settings = Settings {
        method: Method::Iterate,
        family: Some(Family::Power(0.1 + 0.2)),
        treatment: Some(Treatment::LeastSquares),
        max_steps: Some(7),
        spacing: Spacing::Even,
        layers: 5,
        growth: Growth::One,
        size: GaugeSize::default(),
        ..Settings::default()
    };
    settled(&mut session, Action::SetSettings(settings));
    place(&mut session, 0, Target::hard(DVec2::new(0.1 + 0.7, -0.0)));
    place(&mut session, 6, Target::fixed(DVec2::new(1.0 / 3.0, 1e-310)));
    place(&mut session, 30, Target::weighted(DVec2::new(0.4, 0.9), f64::MIN_POSITIVE.sqrt()));
    session.set_view(ProjectView {
        mesh_shading: Some("checker".to_owned()),
        plane_shading: Some("angle".to_owned()),
        mesh_camera: Some(vec![0.1, 1.0 / 3.0]),
        plane_camera: Some(vec![2.5]),
        selection: vec![3, 4],
        tool: Some("constrain".to_owned()),
    });
    (folder, session)
}

#[test]
fn everything_in_a_project_comes_back_bit_for_bit() {
    let (folder, mut before) = with_everything();
    settled(&mut before, Action::SaveProject(project_in(&folder)));
    assert!(errors(&before).is_empty(), "{:?}", before.messages());
    let after = reopened(&project_in(&folder));
    assert!(after.messages().is_empty(), "{:?}", after.messages());
    let (a, b) = (before.document(), after.document());
    assert_eq!(a.settings, b.settings);
    assert_eq!((a.v_axis, &a.form), (b.v_axis, &b.form));
    assert_eq!(a.picture.as_ref().map(|p| (&p.name, &p.pixels)), b.picture.as_ref().map(|p| (&p.name, &p.pixels)));
    let bits = |session: &Session| -> Vec<_> {
        let pins = session.document().targets.iter();
        pins.map(|(v, pin)| (*v, pin.uv.to_array().map(f64::to_bits), format!("{:?}", pin.kind))).collect()
    };
    assert_eq!(bits(&before), bits(&after));
    assert_eq!(before.view(), after.view());
    assert!(after.model().expect("open").prepared.form.faces_turned && after.is_current());
    let embedding = |session: &Session| session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    assert_eq!(embedding(&before), embedding(&after));
}

#[test]
fn every_choice_of_method_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = project_in(&folder);
    let families = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(-0.1), Family::Uniform];
    let triangle = ConvexPolygon::parse("0 0; 0.1 0.2; -7 1e-3").expect("convex");
    let on_shapes = [
        Method::Convex(BoundaryShape::Square),
        Method::Convex(BoundaryShape::Hull),
        Method::Convex(BoundaryShape::Polygon(triangle.clone())),
        Method::Stretch(BoundaryShape::Square),
        Method::Lee(BoundaryShape::Polygon(triangle)),
    ];
    let methods = Method::ALL.iter().cloned().chain(on_shapes);
    let treatments = [None, Some(Treatment::Eliminate), Some(Treatment::LeastSquares), Some(Treatment::Weighted)];
    for (index, method) in methods.enumerate() {
        let family = families[index % families.len()];
        let (treatment, new_vertices) = (treatments[index % 4], index % 3 != 1);
        let settings = Settings {
            treatment,
            new_vertices,
            relax_rounds: (index > 0).then_some(index),
            ..Settings::new(method, family)
        };
        let project = ProjectFile::new(ProjectSource::Example("dome".to_owned()), &settings);
        project.write(&path, PathStyle::Relative).unwrap();
        let read = ProjectFile::read(&path).unwrap();
        assert_eq!(read, project);
        assert_eq!(read.settings(), settings);
    }
}

#[test]
fn a_folder_moves_as_a_whole() {
    let (folder, mut session) = with_everything();
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    let text = fs::read_to_string(project_in(&folder)).unwrap();
    assert!(text.contains("\"file\": \"dome.obj\"") && text.contains("\"pictures/ä b.png\""), "{text}");
    let elsewhere = tempfile::tempdir().unwrap();
    let moved = elsewhere.path().join("moved");
    fs::rename(folder.path(), &moved).unwrap();
    let after = reopened(&moved.join("work.freebound"));
    assert!(after.messages().is_empty() && after.document().targets.len() == 3, "{:?}", after.messages());
}

#[test]
fn a_project_beside_its_mesh_s_folder_finds_it() {
    let (folder, mut session) = with_dome();
    let other = folder.path().join("projects");
    fs::create_dir(&other).unwrap();
    settled(&mut session, Action::SaveProject(other.join("work.freebound")));
    let text = fs::read_to_string(other.join("work.freebound")).unwrap();
    assert!(text.contains("\"../dome.obj\""), "{text}");
    assert!(reopened(&other.join("work.freebound")).messages().is_empty());
}

#[test]
fn an_example_s_project_names_the_example() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = opened(Example::Face);
    place(&mut session, 5, Target::hard(DVec2::new(0.5, 0.25)));
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    let after = reopened(&project_in(&folder));
    assert_eq!(after.model().expect("open").built_in, Some(Example::Face.name()));
    assert_eq!(after.document(), session.document());
    assert!(after.document().picture.is_some(), "the portrait belongs to it");
}

#[test]
fn the_session_knows_what_is_saved() {
    let (folder, mut session) = with_dome();
    assert!(!session.has_unsaved_work(), "a mesh as it was opened");
    assert_eq!((session.project_path(), session.project_name().as_deref()), (None, Some("dome.obj")));
    place(&mut session, 5, Target::hard(DVec2::X));
    assert!(session.has_unsaved_work());
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    assert!(!session.has_unsaved_work());
    assert_eq!(session.project_path(), Some(&project_in(&folder)));
    assert_eq!(session.project_name().as_deref(), Some("work"));
    place(&mut session, 6, Target::hard(DVec2::Y));
    assert!(session.has_unsaved_work());
    settled(&mut session, Action::Undo);
    assert!(!session.has_unsaved_work(), "back at what was saved");
    settled(&mut session, Action::Undo);
    assert!(session.has_unsaved_work(), "before what was saved");
    settled(&mut session, Action::OpenExample(Example::Face));
    assert!(!session.has_unsaved_work() && session.project_path().is_none());
}

#[test]
fn an_edit_while_a_save_is_under_way_is_unsaved() {
    let (folder, mut session) = with_dome();
    session.handle(Action::Place { vertex: id(1), target: Target::hard(DVec2::X) });
    session.handle(Action::SaveProject(project_in(&folder)));
    session.handle(Action::Place { vertex: id(2), target: Target::hard(DVec2::Y) });
    settle(&mut session);
    assert!(session.has_unsaved_work());
    assert_eq!(ProjectFile::read(&project_in(&folder)).unwrap().pins.targets.len(), 1);
}

#[test]
fn of_many_saves_the_last_one_is_in_the_file() {
    let (folder, mut session) = with_dome();
    for vertex in 0..20 {
        session.handle(Action::Place { vertex: id(vertex), target: Target::hard(DVec2::new(f64::from(vertex), 0.0)) });
        session.handle(Action::SaveProject(project_in(&folder)));
    }
    settle(&mut session);
    assert_eq!(ProjectFile::read(&project_in(&folder)).unwrap().pins.targets, session.document().targets);
    assert!(!session.has_unsaved_work());
}

#[test]
fn the_end_of_the_program_waits_for_what_is_being_written() {
    let (folder, mut session) = with_dome();
    place(&mut session, 1, Target::hard(DVec2::X));
    session.handle(Action::SaveProject(project_in(&folder)));
    let constraints = folder.path().join("marks.txt");
    session.handle(Action::ExportConstraints(constraints.clone()));
    session.finish_writing();
    assert!(project_in(&folder).is_file() && constraints.is_file());
}

#[test]
fn a_save_that_fails_is_said_and_nothing_counts_as_saved() {
    let (folder, mut session) = with_dome();
    place(&mut session, 1, Target::hard(DVec2::X));
    settled(&mut session, Action::SaveProject(folder.path().join("no such folder").join("a.freebound")));
    assert!(session.has_unsaved_work() && session.project_path().is_none());
    assert_eq!(errors(&session).len(), 1);
}

#[test]
fn a_missing_mesh_is_named_and_what_was_open_stays() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    fs::remove_file(folder.path().join("dome.obj")).unwrap();
    let mut session = opened(Example::Ell);
    settled(&mut session, Action::Open(project_in(&folder)));
    assert_eq!(session.model().expect("still open").built_in, Some(Example::Ell.name()));
    let message = session.messages().last().expect("said");
    assert!(message.text.contains("dome.obj") && message.remedy.is_some(), "{message:?}");
    assert_eq!(session.missing_file(message), Some(MissingFile::Mesh));
}

#[test]
fn a_mesh_that_was_moved_is_found_by_its_content() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    let deep = folder.path().join("models").join("old");
    fs::create_dir_all(&deep).unwrap();
    fs::rename(folder.path().join("dome.obj"), deep.join("renamed.obj")).unwrap();
    fs::rename(folder.path().join("pictures").join("ä b.png"), folder.path().join("photo.png")).unwrap();
    let mut session = reopened(&project_in(&folder));
    assert_eq!(session.model().expect("open").path.as_ref(), Some(&deep.join("renamed.obj")));
    assert_eq!(session.document().targets, first.document().targets);
    assert!(session.document().picture.is_some() && errors(&session).is_empty());
    assert_eq!(session.messages().iter().filter(|message| message.severity == Severity::Note).count(), 2);
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    let after = reopened(&project_in(&folder));
    assert!(after.messages().is_empty() && after.model().is_some(), "{:?}", after.messages());
}

#[test]
fn a_mesh_that_the_user_locates_opens_its_project() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    let elsewhere = tempfile::tempdir().unwrap();
    let (same, other) = (elsewhere.path().join("same.obj"), elsewhere.path().join("other.obj"));
    fs::copy(folder.path().join("dome.obj"), &same).unwrap();
    fs::remove_file(folder.path().join("dome.obj")).unwrap();
    write_dome(&other, 6, 3);
    for (mesh, faults) in [(&same, 0), (&other, 2)] {
        let mut session = reopened(&project_in(&folder));
        assert!(session.model().is_none());
        settled(&mut session, Action::LocateMesh(mesh.clone()));
        assert_eq!(session.model().expect("open").path.as_ref(), Some(mesh));
        assert_eq!(errors(&session).len(), faults, "{:?}", session.messages());
        assert!(session.messages().iter().all(|message| session.missing_file(message).is_none()));
        let has_all = session.document().targets == first.document().targets;
        assert_eq!(has_all, faults == 0);
    }
}

#[test]
fn a_picture_that_the_user_locates_opens_its_project_and_is_no_edit() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    let elsewhere = tempfile::tempdir().unwrap();
    let photo = elsewhere.path().join("photo.png");
    fs::copy(folder.path().join("pictures").join("ä b.png"), &photo).unwrap();
    fs::remove_file(folder.path().join("pictures").join("ä b.png")).unwrap();
    let mut session = reopened(&project_in(&folder));
    assert!(session.document().picture.is_none());
    settled(&mut session, Action::LocatePicture(photo.clone()));
    assert_eq!(session.document().picture.as_ref().and_then(|picture| picture.path.clone()), Some(photo.clone()));
    assert!(session.messages().is_empty() && !session.has_unsaved_work() && !session.history().can_undo());
    let embedding = |session: &Session| session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    assert!(embedding(&session) == embedding(&first), "the map is that of the project");
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    assert!(reopened(&project_in(&folder)).document().picture.is_some());
    // Without a missing picture the action opens a picture.
    write_picture(&photo, 7, 3);
    settled(&mut session, Action::LocatePicture(photo));
    assert!(session.history().can_undo());
}

#[test]
fn a_located_file_that_is_no_mesh_says_so_and_the_project_can_be_opened_again() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    fs::remove_file(folder.path().join("dome.obj")).unwrap();
    let mut session = reopened(&project_in(&folder));
    let lacks = |session: &Session| {
        let is_lacking = |message: &&Message| session.missing_file(message) == Some(MissingFile::Mesh);
        session.messages().iter().filter(is_lacking).count()
    };
    fs::write(folder.path().join("empty.obj"), "").unwrap();
    for file in ["missing.obj", "empty.obj", "work.freebound"] {
        settled(&mut session, Action::LocateMesh(folder.path().join(file)));
        assert!(session.model().is_none() && !errors(&session).is_empty());
        assert_eq!(lacks(&session), 1, "another file can be located: {:?}", session.messages());
    }
}

#[test]
fn a_changed_mesh_is_said_and_pins_that_it_has_no_vertices_for_are_counted() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    write_dome(&folder.path().join("dome.obj"), 6, 3);
    let session = reopened(&project_in(&folder));
    assert_eq!(session.document().targets.len(), 2, "vertex 30 is gone");
    let said = errors(&session);
    assert_message("projects-changed-mesh", &said[..2].join("\n"));
    assert!(session.project_path().is_none(), "saving asks where, so that the pins stay in the file");
}

#[test]
fn a_missing_and_a_changed_picture_are_said() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    let picture = folder.path().join("pictures").join("ä b.png");
    write_picture(&picture, 5, 4);
    let session = reopened(&project_in(&folder));
    assert!(session.document().picture.is_some());
    assert_message("projects-changed-picture", errors(&session)[0]);
    fs::remove_file(&picture).unwrap();
    let session = reopened(&project_in(&folder));
    assert!(session.document().picture.is_none() && session.document().targets.len() == 3);
    assert_message("projects-missing-picture", errors(&session)[0]);
    assert_eq!(session.missing_file(&session.messages()[0]), Some(MissingFile::Picture));
}

#[test]
fn saving_a_project_without_its_picture_keeps_the_picture_s_name_in_the_file() {
    let (folder, mut first) = with_everything();
    settled(&mut first, Action::SaveProject(project_in(&folder)));
    let before = ProjectFile::read(&project_in(&folder)).unwrap().picture;
    assert!(before.is_some());
    fs::remove_file(folder.path().join("pictures").join("ä b.png")).unwrap();
    let mut session = reopened(&project_in(&folder));
    place(&mut session, 6, Target::hard(DVec2::Y));
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    assert_eq!(ProjectFile::read(&project_in(&folder)).unwrap().picture, before);
}

/// Error of a project file with this text, and the message on it.
fn said_of(text: &str) -> (ProjectError, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(project_in(&folder), text).unwrap();
    let session = reopened(&project_in(&folder));
    assert!(session.model().is_none(), "nothing is guessed: {text}");
    let message = &session.messages()[0];
    assert_eq!(message.severity, Severity::Error);
    let error = ProjectFile::read(&project_in(&folder)).expect_err("it is wrong");
    assert_eq!((&message.text, message.remedy.as_deref()), (&error.to_string(), Some(error.remedy())));
    (error, words_of(message))
}

#[test]
fn faults_of_a_project_name_line_and_field() {
    let mesh = "\"mesh\": {\"example\": \"dome\"}";
    let pin =
        |fields: &str| format!("{{\"freebound_project\": 1, {mesh},\n\"pins\": [\n{{\"vertex\": 1, {fields}}}\n]}}");
    let cases = [
        (pin("\"u\": \"x\", \"v\": 0, \"hold\": \"hard\""), 3, Some("pins[0].u")),
        (pin("\"u\": 0, \"v\": 0, \"hold\": \"soft\""), 3, Some("pins[0].hold")),
        (pin("\"u\": 0, \"v\": 0, \"hold\": \"weighted\", \"weight\": -2"), 3, Some("pins[0].weight")),
        (pin("\"u\": 0, \"hold\": \"hard\""), 3, Some("pins[0]")),
        (pin("\"u\": 1e999, \"v\": 0, \"hold\": \"hard\""), 3, Some("pins[0].u")),
        (format!("{{\n\"freebound_project\": 1,\n{mesh},\n\"family\": \"nonsense\"\n}}"), 4, Some("family")),
        ("{\n\"freebound_project\": 1,\n\"mesh\": {},\n\"pins\": []\n}".to_owned(), 3, Some("mesh")),
        ("{\n\"freebound_project\": 1\n}".to_owned(), 3, None),
        (format!("{{\n\"freebound_project\": 1,\n{mesh},\n\"max_steps\": -3}}"), 4, Some("max_steps")),
        (format!("{{\n\"freebound_project\": 1,\n{mesh},\n\"method\": \"best\"\n}}"), 4, Some("method")),
        (format!("{{\n\"freebound_project\": 1,\n{mesh},\n\"pins\": ["), 4, Some("pins")),
    ];
    let mut messages = Vec::new();
    for (text, number, expected) in cases {
        let (error, words) = said_of(&text);
        let ProjectError::Malformed { path, line, field, .. } = &error else { panic!("{error}") };
        assert!(*line == number && expected.is_none_or(|expected| field == expected), "{error}\nof\n{text}");
        assert!(path.ends_with("work.freebound"), "{error}");
        messages.push(words);
    }
    assert_message("projects-faults", &messages.join("\n"));
}

#[test]
fn a_newer_project_is_refused_by_name_and_other_files_are_no_projects() {
    let (error, words) = said_of("{\"freebound_project\": 2, \"mesh\": 7}");
    assert!(matches!(error, ProjectError::Newer { version: 2, .. }), "{error}");
    let mut messages = vec![words];
    for other in ["", "v 1 2 3\n", "{}", "[1, 2]", "{\"freebound_project\": 0}"] {
        let (error, words) = said_of(other);
        assert!(matches!(error, ProjectError::NotAProject { .. }), "{other}: {error}");
        messages.push(words);
    }
    assert_message("projects-newer-and-others", &messages.join("\n"));
}

#[test]
fn fields_that_nobody_knows_yet_are_ignored_and_few_are_needed() {
    let folder = tempfile::tempdir().unwrap();
    let text = "{\"future\": {\"a\": [1]}, \"freebound_project\": 1, \"mesh\": {\"example\": \"dome\", \"x\": 1}}";
    fs::write(project_in(&folder), text).unwrap();
    let session = reopened(&project_in(&folder));
    assert!(session.messages().is_empty() && session.is_current());
    assert_eq!(session.document().settings, Settings::default());
}

#[test]
fn the_stamp_of_abc_is_that_of_the_standard() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("abc");
    fs::write(&path, "abc").unwrap();
    let stamp = FileStamp::read(&path).unwrap();
    // FIPS 180-4, the one-block example.
    let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    assert_eq!((stamp.bytes, stamp.sha256.as_str()), (3, expected));
}

/// Session with a face whose map went on from edits, so that solving it from scratch would give another map.
fn with_continued_map() -> (TempDir, Session, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let mut session = opened(Example::Dome);
    let pins = [0, 40, 90, 130].map(VertexId::new).to_vec();
    settled(&mut session, Action::Fix(pins.clone()));
    let from = session.document().targets[&pins[1]].uv;
    settled(&mut session, Action::Place { vertex: pins[1], target: Target::hard(from + DVec2::new(0.02, 0.01)) });
    settled(&mut session, Action::Relax);
    assert!(session.is_continued() && session.document().relaxed > 0);
    let path = project_in(&folder);
    settled(&mut session, Action::SaveProject(path.clone()));
    (folder, session, path)
}

fn map_of(session: &Session) -> Embedding {
    session.outcome().expect("a map").step.candidate.solution.embedding.clone()
}

#[test]
fn a_saved_map_returns_bit_for_bit_without_a_solve() {
    let (_folder, mut before, path) = with_continued_map();
    let mut after = reopened(&path);
    assert_eq!(map_of(&after), map_of(&before));
    let outcome = after.outcome().unwrap();
    assert_eq!((&outcome.step.candidate.stage, after.timeline().records().len()), (&Stage::Saved, 1));
    assert!(outcome.step.verdict.planar && outcome.step.unmet().is_empty());
    assert_eq!(outcome.distortion.summary, before.outcome().unwrap().distortion.summary);
    assert!(after.is_current() && !after.has_unsaved_work() && errors(&after).is_empty());
    // Solving from scratch gives another map, so the test would see a solve.
    settled(&mut before, Action::Solve);
    assert_ne!(map_of(&after), map_of(&before));
    // Edits start from the saved map, and undo returns to it.
    let saved = map_of(&after);
    let vertex = VertexId::new(0);
    let target = after.document().targets[&vertex].uv + DVec2::new(0.0, 0.01);
    settled(&mut after, Action::Place { vertex, target: Target::hard(target) });
    assert!(after.is_continued() && map_of(&after)[vertex] == target);
    settled(&mut after, Action::Undo);
    assert_eq!(map_of(&after), saved);
    settled(&mut after, Action::Relax);
    assert!(after.timeline().records().len() > 1, "the run continues from the saved map");
}

#[test]
fn saved_maps_of_several_charts_return_with_their_layout() {
    let (folder, mut before) = super::charts::with_disks();
    super::charts::until_laid_out(&mut before);
    settled(&mut before, Action::Relax);
    super::charts::until_laid_out(&mut before);
    let path = project_in(&folder);
    settled(&mut before, Action::SaveProject(path.clone()));
    let mut after = reopened(&path);
    super::charts::until_laid_out(&mut after);
    for number in 0..5 {
        let map = |session: &Session| match session.chart_state(number) {
            ChartState::Solved(outcome) => outcome.step.candidate.solution.embedding.clone(),
            other => panic!("chart {number}: {other:?}"),
        };
        assert_eq!(map(&after), map(&before), "chart {number}");
        let ChartState::Solved(outcome) = after.chart_state(number) else { unreachable!() };
        assert_eq!(outcome.step.candidate.stage, Stage::Saved);
    }
    assert_eq!(after.atlas().unwrap().coordinates, before.atlas().unwrap().coordinates);
}

#[test]
fn a_map_of_another_mesh_is_left_out_and_solved_again() {
    let (folder, session, path) = with_continued_map();
    drop(session);
    let text = std::fs::read_to_string(&path).unwrap();
    let other = text.replace("\"dome\"", "\"bumpy-cap\"");
    assert_ne!(text, other);
    let path = folder.path().join("other.freebound");
    std::fs::write(&path, other).unwrap();
    let after = reopened(&path);
    assert_ne!(after.outcome().expect("solved").step.candidate.stage, Stage::Saved);
}

#[test]
fn a_damaged_map_is_said_and_solved_again() {
    let (folder, session, path) = with_continued_map();
    drop(session);
    let text = std::fs::read_to_string(&path).unwrap();
    let start = text.find("\"positions\"").expect("a map") + 40;
    let other = if &text[start..=start] == "A" { "B" } else { "A" };
    let path = folder.path().join("damaged.freebound");
    std::fs::write(&path, format!("{}{other}{}", &text[..start], &text[start + 1..])).unwrap();
    let after = reopened(&path);
    assert_ne!(after.outcome().expect("solved").step.candidate.stage, Stage::Saved);
    assert!(errors(&after).is_empty());
    assert_message("projects-damaged-map", &words_of(&after.messages()[0]));
}

#[test]
fn a_map_that_is_not_planar_is_not_saved() {
    let folder = tempfile::tempdir().unwrap();
    let session = opened(Example::Face);
    assert!(!session.outcome().unwrap().step.verdict.planar);
    let mut session = session;
    settled(&mut session, Action::SaveProject(project_in(&folder)));
    assert!(ProjectFile::read(&project_in(&folder)).unwrap().maps.is_empty());
}
