//! Names of pins, pins with equal targets, and landmarks of the picture.

use std::path::{Path, PathBuf};

use freebound::session::{Action, Session, UndoGroup};
use freebound_core::geom::VAxis;
use freebound_core::pipeline::Target;
use freebound_core::problem::PinKind;
use freebound_io::{LandmarkSet, PinName, ProjectFile, parse_pts};
use freebound_testkit::{shaped, write_obj};
use glam::{DVec2, DVec3};
use tempfile::TempDir;

use super::basics::{session, settle, settled};
use super::documents::{id, place, with_dome, write_dome, write_picture};

fn name(text: &str) -> PinName {
    PinName::new(text).unwrap()
}

#[test]
fn a_name_is_one_undo_step_and_needs_no_solve() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    let (depth, revision) = (session.history().depth(), session.outcome_revision());
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
    assert!(session.is_current() && session.outcome_revision() == revision && session.has_unsaved_work());
    assert_eq!(session.history().depth(), depth + 1);
    session.handle(Action::Undo);
    assert_eq!(session.pin_name(id(3)), None);
    assert_eq!(session.outcome_revision(), revision);
}

#[test]
fn a_name_goes_with_its_pin_and_undo_restores_both() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    settled(&mut session, Action::Unpin(vec![id(3)]));
    assert!(session.document().targets.is_empty() && session.document().notes.is_empty());
    settled(&mut session, Action::Undo);
    assert!(session.document().targets.contains_key(&id(3)));
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
}

#[test]
fn two_pins_have_no_common_name_and_a_free_vertex_has_none() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("Left Eye")) });
    session.handle(Action::NamePin { vertex: id(9), name: Some(name("chin")) });
    assert_eq!(session.document().notes.len(), 1);
    assert!(session.messages().iter().any(|message| message.remedy.is_some()));
}

#[test]
fn names_come_back_from_a_project_and_from_a_constraint_file() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye, outer")) });
    let notes = session.document().notes.clone();
    let [project, list] = ["named.freebound", "named.txt"].map(|file| folder.path().join(file));
    settled(&mut session, Action::SaveProject(project.clone()));
    assert_eq!(ProjectFile::read(&project).unwrap().pins.notes, notes);
    settled(&mut session, Action::ExportConstraints(list.clone()));
    settled(&mut session, Action::UnpinAll);
    settled(&mut session, Action::ImportConstraints(list));
    assert_eq!(session.document().notes, notes);
    settled(&mut session, Action::Open(project));
    assert_eq!(session.document().notes, notes);
    assert!(!session.has_unsaved_work());
}

#[test]
fn the_pins_of_a_project_are_carried_to_another_mesh_in_one_step() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    let project = folder.path().join("dome.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let (targets, notes) = (session.document().targets.clone(), session.document().notes.clone());
    // The same mesh, moved: its faces are equal.
    let moved = folder.path().join("moved.obj");
    let text = std::fs::read_to_string(folder.path().join("dome.obj")).unwrap();
    std::fs::write(&moved, text.replace("v ", "v 9")).unwrap();
    settled(&mut session, Action::Open(moved));
    assert!(session.document().targets.is_empty());
    let depth = session.history().depth();
    settled(&mut session, Action::ImportConstraints(project));
    assert_eq!((&session.document().targets, &session.document().notes), (&targets, &notes));
    assert_eq!(session.history().depth(), depth + 1);
    assert!(session.messages().iter().any(|message| message.vertices == [id(3), id(8)]), "for a look at them");
    settled(&mut session, Action::Undo);
    assert!(session.document().targets.is_empty() && session.document().notes.is_empty());
}

/// Session with a dome of other faces, moved and scaled, and a project with two pins of the first dome.
fn with_project_of_another_dome() -> (TempDir, Session, PathBuf) {
    let (folder, mut session) = with_dome();
    place(&mut session, 0, Target::hard(DVec2::new(0.25, 0.125)));
    place(&mut session, 34, Target::hard(DVec2::new(0.75, 0.5)));
    let project = folder.path().join("dome.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let other = folder.path().join("other.obj");
    let mut mesh = shaped(12, 8, |x, y| {
        let (x, y) = (x / 2.0, y / 2.0);
        DVec3::new(x, y, 3.0 - 0.12 * (DVec2::new(x, y) - DVec2::new(3.0, 2.0)).length_squared())
    });
    mesh.positions.iter_mut().for_each(|place| *place = 10.0 * *place + DVec3::splat(700.0));
    write_obj(&other, &mesh);
    settled(&mut session, Action::Open(other));
    (folder, session, project)
}

#[test]
fn the_pins_of_a_project_go_to_the_same_places_of_other_faces_however_large_they_are() {
    let (_folder, mut session, project) = with_project_of_another_dome();
    settled(&mut session, Action::ImportConstraints(project));
    // Corners of both domes.
    let targets: Vec<_> = session.document().targets.iter().map(|(&vertex, target)| (vertex, target.uv.x)).collect();
    assert_eq!(targets, [(id(0), 0.25), (id(116), 0.75)]);
}

#[test]
fn the_other_side_of_the_picture_and_a_changed_mesh_are_minded() {
    let (folder, mut session, project) = with_project_of_another_dome();
    settled(&mut session, Action::SetVAxis(VAxis::Down));
    settled(&mut session, Action::ImportConstraints(project.clone()));
    assert_eq!(session.document().targets[&id(0)].uv, DVec2::new(0.25, 0.875));
    settled(&mut session, Action::UnpinAll);
    write_dome(&folder.path().join("dome.obj"), 6, 3);
    settled(&mut session, Action::ImportConstraints(project));
    assert!(session.document().targets.is_empty());
    assert!(session.messages().iter().any(|message| message.remedy.is_some()));
}

#[test]
fn a_project_that_cannot_be_read_brings_no_pins() {
    let (folder, mut session) = with_dome();
    let project = folder.path().join("broken.freebound");
    std::fs::write(&project, "{").unwrap();
    let depth = session.history().depth();
    settled(&mut session, Action::ImportConstraints(project));
    assert_eq!(session.history().depth(), depth);
    assert!(session.messages().iter().any(|message| message.remedy.is_some()));
}

#[test]
fn equal_targets_are_merged_in_one_step_and_the_name_stays() {
    let (_folder, mut session) = with_dome();
    let target = Target::hard(DVec2::new(0.25, 0.5));
    place(&mut session, 3, target);
    place(&mut session, 20, Target::hard(DVec2::new(0.75, 0.5)));
    place(&mut session, 8, target);
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("left eye")) });
    let before = session.document().clone();
    settled(&mut session, Action::MergePins([id(3), id(8)]));
    assert!(!session.document().targets.contains_key(&id(8)) && session.document().targets.len() == 2);
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_message_about_equal_targets_names_both_pins() {
    let (_folder, mut session) = with_dome();
    let target = Target::hard(DVec2::new(0.25, 0.5));
    place(&mut session, 3, target);
    place(&mut session, 20, Target::hard(DVec2::new(0.75, 0.5)));
    place(&mut session, 8, target);
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("left eye")) });
    let conflict = session.conflict_of(id(8)).expect("equal targets").clone();
    assert!(session.conflict_words(&conflict).contains("left eye"), "{}", session.conflict_words(&conflict));
    let kind = PinKind::Soft(1.0);
    settled(&mut session, Action::SetPinKind { vertices: vec![id(8)], kind });
    assert!(session.conflict_of(id(8)).is_none(), "a loosened pin is no conflict");
}

/// Session with a dome, a picture of 40 × 20 pixels, and a file of five landmarks.
fn with_points() -> (tempfile::TempDir, Session, PathBuf) {
    let (folder, mut session) = with_dome();
    let picture = folder.path().join("photo.png");
    write_picture(&picture, 40, 20);
    settled(&mut session, Action::OpenPicture(picture));
    let points = folder.path().join("photo.pts");
    std::fs::write(&points, "version: 1\nn_points: 5\n{\n10.5 5.5\n30.5 5.5\n20.5 10.5\n12.5 15.5\n28.5 15.5\n}\n")
        .unwrap();
    (folder, session, points)
}

#[test]
fn landmarks_move_the_pins_of_their_names_in_one_undo_step() {
    let (_folder, mut session, points) = with_points();
    let names: Vec<PinName> = LandmarkSet::Five.names().iter().map(|text| name(text)).collect();
    for (vertex, place_of) in [(3, 0), (8, 2)] {
        place(&mut session, vertex, Target::weighted(DVec2::new(0.01 * f64::from(vertex), 0.5), 7.0));
        session.handle(Action::NamePin { vertex: id(vertex), name: Some(names[place_of].clone()) });
    }
    let (before, depth) = (session.document().clone(), session.history().depth());
    settled(&mut session, Action::ImportConstraints(points));
    let targets = &session.document().targets;
    assert_eq!(targets[&id(3)], Target::weighted(DVec2::new(0.25, 0.75), 7.0), "the kind stays");
    assert_eq!(targets[&id(8)].uv, DVec2::new(0.5, 0.5));
    let waiting: Vec<PinName> = session.landmarks_waiting().into_iter().map(|landmark| landmark.name).collect();
    assert_eq!(waiting, [names[1].clone(), names[3].clone(), names[4].clone()]);
    assert_eq!((session.landmark_count(), session.history().depth()), (5, depth + 1));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_pin_on_a_landmark_takes_its_name_and_the_next_one_waits() {
    let (_folder, mut session, points) = with_points();
    settled(&mut session, Action::ImportConstraints(points.clone()));
    assert!(session.document().targets.is_empty() && session.landmarks_waiting().len() == 5);
    let first = session.next_landmark(None).expect("waits");
    let depth = session.history().depth();
    place(&mut session, 3, Target::hard(first.uv));
    assert_eq!(session.pin_name(id(3)), Some(&first.name));
    assert_eq!(session.history().depth(), depth + 1, "pin and name are one step");
    let second = session.next_landmark(Some(first.uv)).expect("waits");
    assert_eq!(session.next_landmark(Some(second.uv)).map(|third| third.uv), Some(DVec2::new(0.5, 0.5)));
    assert!(session.landmark_at(first.uv).is_none() && session.landmark_at(second.uv).is_some());
    place(&mut session, 9, Target::hard(DVec2::new(0.111, 0.2)));
    assert_eq!(session.pin_name(id(9)), None);
    settled(&mut session, Action::CloseLandmarks);
    assert!(session.next_landmark(None).is_none() && session.pin_name(id(3)).is_some());
    settled(&mut session, Action::ImportConstraints(points));
    assert_eq!(session.landmarks_waiting().len(), 4);
    settled(&mut session, Action::RemovePicture);
    assert_eq!(session.landmark_count(), 0, "they belong to the picture");
    settled(&mut session, Action::Undo);
    assert_eq!(session.landmark_count(), 5, "and return with it");
}

#[test]
fn named_pins_are_written_as_the_landmarks_that_they_came_from() {
    for v_axis in [VAxis::Up, VAxis::Down] {
        let (folder, mut session, points) = with_points();
        settled(&mut session, Action::SetVAxis(v_axis));
        settled(&mut session, Action::ImportConstraints(points.clone()));
        for vertex in [3, 8, 12, 18, 30] {
            let next = session.next_landmark(None).expect("waits");
            place(&mut session, vertex, Target::hard(next.uv));
        }
        assert!(session.landmarks_waiting().is_empty());
        let out = folder.path().join("out.pts");
        if v_axis == VAxis::Down {
            session.handle(Action::CloseLandmarks);
        }
        settled(&mut session, Action::ExportConstraints(out.clone()));
        let read = |path: &Path| parse_pts(&std::fs::read_to_string(path).unwrap()).unwrap();
        let (before, after) = (read(&points), read(&out));
        assert!(before.iter().zip(&after).all(|(a, b)| a.distance(*b) < 1e-6) && before.len() == after.len());
    }
}

#[test]
fn landmarks_without_a_picture_and_incomplete_sets_say_what_to_do() {
    let (folder, mut session, points) = with_points();
    settled(&mut session, Action::RemovePicture);
    settled(&mut session, Action::ImportConstraints(points.clone()));
    let remedies = |session: &Session| session.messages().iter().filter(|message| message.remedy.is_some()).count();
    assert_eq!((session.landmark_count(), remedies(&session)), (0, 1));
    settled(&mut session, Action::Undo);
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.75)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name(LandmarkSet::Five.names()[0])) });
    let out = folder.path().join("out.pts");
    settled(&mut session, Action::ExportConstraints(out.clone()));
    assert!(!out.exists() && remedies(&session) >= 2);
    std::fs::write(&points, "version: 2\n").unwrap();
    let before = session.document().clone();
    settled(&mut session, Action::ImportConstraints(points));
    assert!(*session.document() == before && session.landmark_count() == 0);
}

#[test]
fn a_picture_and_its_landmarks_can_be_dropped_together() {
    let (folder, _, points) = with_points();
    let mut session = session();
    let (mesh, picture) = (folder.path().join("dome.obj"), Some(folder.path().join("photo.png")));
    settled(
        &mut session,
        Action::OpenTogether(UndoGroup { mesh, picture, constraints: vec![points], left: Vec::new() }),
    );
    assert!(session.document().picture.is_some());
    assert_eq!(session.landmarks_waiting().len(), 5, "{:?}", session.messages());
}

#[test]
fn files_that_are_opened_while_a_mesh_is_loading_belong_to_it() {
    let (folder, _, points) = with_points();
    let mut session = session();
    session.handle(Action::Open(folder.path().join("dome.obj")));
    session.handle(Action::ImportConstraints(points));
    session.handle(Action::OpenPicture(folder.path().join("photo.png")));
    settle(&mut session);
    assert_eq!(session.landmarks_waiting().len(), 5, "{:?}", session.messages());
}

#[test]
fn numbered_landmarks_are_written_in_their_order_and_points_on_one_place_can_be_skipped() {
    let (folder, mut session, points) = with_points();
    std::fs::write(&points, "version: 1\nn_points: 3\n{\n0 0\n0 0\n20.5 10.5\n}\n").unwrap();
    settled(&mut session, Action::ImportConstraints(points.clone()));
    let first = session.next_landmark(None).expect("waits");
    assert_eq!(session.next_landmark(Some(first.uv)).expect("waits").name, name("point 3"));
    for vertex in [3, 8, 12] {
        let next = session.next_landmark(None).expect("waits");
        place(&mut session, vertex, Target::hard(next.uv));
    }
    session.handle(Action::CloseLandmarks);
    let out = folder.path().join("out.pts");
    settled(&mut session, Action::ExportConstraints(out.clone()));
    let read = |path: &Path| parse_pts(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert!(read(&points).iter().zip(read(&out)).all(|(a, b)| a.distance(b) < 1e-6));
}

#[test]
fn landmarks_move_pins_of_charts_that_are_not_shown() {
    let folder = tempfile::tempdir().unwrap();
    let [mesh, picture, points] = ["two.obj", "photo.png", "photo.pts"].map(|name| folder.path().join(name));
    let square = |x: f64| format!("v {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\n", x + 1.0, x + 1.0);
    std::fs::write(&mesh, format!("{}{}f 1 2 3 4\nf 5 6 7 8\n", square(0.0), square(3.0))).unwrap();
    write_picture(&picture, 40, 20);
    std::fs::write(&points, "version: 1\nn_points: 2\n{\n10.5 5.5\n30.5 5.5\n}\n").unwrap();
    let mut session = session();
    settled(
        &mut session,
        Action::OpenTogether(UndoGroup { mesh, picture: Some(picture), constraints: Vec::new(), left: Vec::new() }),
    );
    for (chart, text) in [(0, "point 1"), (1, "point 2")] {
        settled(&mut session, Action::ShowChart(chart));
        place(&mut session, 1, Target::hard(DVec2::new(0.1, 0.1)));
        session.handle(Action::NamePin { vertex: id(1), name: Some(name(text)) });
    }
    let depth = session.history().depth();
    settled(&mut session, Action::ImportConstraints(points));
    assert_eq!(session.history().depth(), depth + 1);
    assert!(session.landmarks_waiting().is_empty());
    assert_eq!(session.document().targets[&id(1)].uv, DVec2::new(0.75, 0.75));
    settled(&mut session, Action::ShowChart(0));
    assert_eq!(session.document().targets[&id(1)].uv, DVec2::new(0.25, 0.75));
}
