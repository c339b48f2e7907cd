//! Data of a mesh in a session: pictures, constraint files, all targets together, turned faces.

use std::path::{Path, PathBuf};

use freebound::session::{Action, Message, MessagePlace, SaveRequest, Session, Severity};
use freebound_core::geom::{Picture, VAxis};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::PinKind;
use freebound_io::{OutputKind, PictureFile, material_picture, read_mesh};
use glam::{DVec2, DVec3};
use tempfile::TempDir;

use super::basics::{session, settled};
use freebound_testkit::{assert_message, corpus_disks, corpus_test, grid, write_obj};

pub(crate) fn id(number: u32) -> VertexId {
    VertexId::new(number)
}

/// Writes a grid that is bent in space, counter-clockwise seen from above.
pub(crate) fn write_dome(path: &Path, columns: u32, rows: u32) {
    let mut mesh = grid(columns, rows);
    let middle = DVec2::new(f64::from(columns), f64::from(rows)) / 2.0;
    for p in &mut mesh.positions {
        p.z = 3.0 - p.truncate().distance_squared(middle) * 0.12;
    }
    write_obj(path, &mesh);
}

pub(crate) fn write_picture(path: &Path, width: u32, height: u32) {
    let picture = Picture::filled(width, height, [10, 120, 200, 255]);
    freebound_io::raster::write_png(&picture, &mut std::fs::File::create(path).unwrap()).unwrap();
}

/// Session with a dome of 7 × 5 vertices, in a temporary folder.
pub(crate) fn with_dome() -> (TempDir, Session) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dome.obj");
    write_dome(&path, 6, 4);
    let mut session = session();
    settled(&mut session, Action::Open(path));
    assert!(session.is_current() && session.messages().is_empty(), "{:?}", session.messages());
    (folder, session)
}

pub(crate) fn place(session: &mut Session, vertex: u32, pin: Target) {
    settled(session, Action::Place { vertex: id(vertex), target: pin });
}

fn targets(session: &Session) -> Vec<DVec2> {
    session.document().targets.values().map(|target| target.uv).collect()
}

pub(crate) fn errors(session: &Session) -> Vec<&str> {
    let is_error = |m: &&Message| m.severity == Severity::Error;
    session.messages().iter().filter(is_error).map(|m| m.text.as_str()).collect()
}

/// Text of a message, and its remedy on a line of its own.
pub(crate) fn words_of(message: &Message) -> String {
    match &message.remedy {
        Some(remedy) => format!("{}\n{remedy}", message.text),
        None => message.text.clone(),
    }
}

#[test]
fn a_picture_is_one_edit_and_stretches_the_plane() {
    let (folder, mut session) = with_dome();
    let path = folder.path().join("wide.png");
    write_picture(&path, 8, 4);
    settled(&mut session, Action::OpenPicture(path));
    assert_eq!(session.document().frame().aspect, 2.0);
    assert!(session.is_current());
    settled(&mut session, Action::Undo);
    assert!(session.document().picture.is_none() && session.is_current());
    settled(&mut session, Action::Redo);
    settled(&mut session, Action::RemovePicture);
    assert!(session.document().picture.is_none());
}

#[test]
fn a_broken_picture_is_a_message_and_no_edit() {
    let (folder, mut session) = with_dome();
    for name in ["dome.obj", "missing.png"] {
        settled(&mut session, Action::OpenPicture(folder.path().join(name)));
        let message = session.messages().last().expect("said");
        assert_eq!(message.place, MessagePlace::Embedding);
        assert!(message.text.contains(name) && message.remedy.is_some(), "{message:?}");
    }
    assert!(!session.history().can_undo());
}

#[test]
fn a_picture_that_the_material_names_comes_with_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dome.obj");
    write_dome(&path, 4, 3);
    let mesh = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("mtllib dome.mtl\n{}", mesh.replacen("f ", "usemtl skin\nf ", 1))).unwrap();
    std::fs::write(folder.path().join("dome.mtl"), "newmtl skin\nmap_Kd skin.png\n").unwrap();
    let mut session = session();
    settled(&mut session, Action::Open(path.clone()));
    assert!(session.is_current() && session.document().picture.is_none());
    assert!(errors(&session)[0].contains("skin.png"), "{:?}", session.messages());
    write_picture(&folder.path().join("skin.png"), 3, 2);
    settled(&mut session, Action::Open(path));
    assert_eq!(session.document().frame().aspect, 1.5);
    assert!(session.messages().is_empty() && !session.has_unsaved_work());
}

#[test]
fn a_picture_within_a_glb_file_comes_with_the_mesh_into_projects_and_exports() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_dome(&at("dome.obj"), 4, 3);
    write_picture(&at("skin.png"), 3, 2);
    let mut first = session();
    settled(&mut first, Action::Open(at("dome.obj")));
    settled(&mut first, Action::OpenPicture(at("skin.png")));
    settled(&mut first, Action::Save(SaveRequest { path: at("dome.glb"), kind: OutputKind::Glb, fit: Fit::Unit }));
    let skin = PictureFile::read(&at("skin.png")).unwrap().pixels;
    for name in ["dome.obj", "skin.png", "dome.mtl"] {
        std::fs::remove_file(at(name)).ok();
    }
    let mut session = session();
    settled(&mut session, Action::Open(at("dome.glb")));
    let picture = session.document().picture.clone().expect("a picture");
    assert_eq!((&*picture.pixels, picture.path.as_deref()), (&*skin, Some(at("dome.glb").as_path())));
    settled(&mut session, Action::SaveProject(at("dome.freebound")));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(at("dome.freebound")));
    assert_eq!(again.document().picture.as_ref().expect("a picture").pixels, skin);
    assert!(again.messages().iter().all(|message| message.severity == Severity::Note), "{:?}", again.messages());
    settled(&mut again, Action::Save(SaveRequest { path: at("out.obj"), kind: OutputKind::Obj, fit: Fit::Unit }));
    let out = read_mesh(&at("out.obj")).unwrap();
    let copied = material_picture(&out, &at("out.obj")).expect("a picture");
    assert!(copied.extension().is_some_and(|extension| extension == "png"), "{copied:?}");
    assert_eq!(PictureFile::read(&copied).unwrap().pixels, skin);
}

#[test]
fn constraints_of_a_file_join_those_that_there_are() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    let before = session.document().clone();
    let path = folder.path().join("marks.txt");
    std::fs::write(&path, "8 0.5 0.25 2\n# a comment\n20 1e-3 0.1\n").unwrap();
    settled(&mut session, Action::ImportConstraints(path));
    let pins = &session.document().targets;
    assert_eq!(pins.len(), 3);
    assert_eq!(pins[&id(8)], Target::weighted(DVec2::new(0.5, 0.25), 2.0));
    assert_eq!(pins[&id(20)], Target::hard(DVec2::new(1e-3, 0.1)));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_fault_in_a_constraint_file_names_its_line_and_changes_nothing() {
    let (folder, mut session) = with_dome();
    let path = folder.path().join("marks.txt");
    std::fs::write(&path, "8 0.5 0.25\n\n35 1 1\n").unwrap();
    settled(&mut session, Action::ImportConstraints(path));
    let message = session.messages().last().expect("said");
    assert_eq!((message.place, message.severity), (MessagePlace::Embedding, Severity::Error));
    assert_message("documents-fault-in-constraints", &words_of(message));
    assert!(session.document().targets.is_empty() && !session.history().can_undo());
}

#[test]
fn exported_constraints_come_back_bit_for_bit() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.1 + 0.2, -0.0)));
    place(&mut session, 30, Target::weighted(DVec2::new(1.0 / 3.0, 7e-300), 0.7));
    let pins = session.document().targets.clone();
    let path = folder.path().join("marks.txt");
    settled(&mut session, Action::ExportConstraints(path.clone()));
    settled(&mut session, Action::UnpinAll);
    settled(&mut session, Action::ImportConstraints(path));
    assert_eq!(session.document().targets, pins);
}

#[test]
fn mirrored_targets_keep_their_box_and_twice_mirrored_their_places() {
    let (_folder, mut session) = with_dome();
    for (vertex, u) in [(0, 0.25), (6, 0.5), (30, 1.0)] {
        place(&mut session, vertex, Target::hard(DVec2::new(u, u * u)));
    }
    let before = session.document().clone();
    settled(&mut session, Action::MirrorTargets);
    let mirrored: Vec<f64> = targets(&session).iter().map(|target| target.x).collect();
    assert_eq!(mirrored, [1.0, 0.75, 0.25]);
    settled(&mut session, Action::MirrorTargets);
    assert_eq!(*session.document(), before);
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before, "each is one step of undo");
}

/// Complex numbers by which three points are rotated and scaled to three others, measured along two sides.
fn turns(from: [DVec2; 3], to: [DVec2; 3]) -> [DVec2; 2] {
    [1, 2].map(|end| {
        let (a, b) = (from[end] - from[0], to[end] - to[0]);
        DVec2::new(a.dot(b), a.perp_dot(b)) / a.length_squared()
    })
}

#[test]
fn fitting_moves_all_targets_by_one_similarity_of_the_picture() {
    let (folder, mut session) = with_dome();
    let path = folder.path().join("wide.png");
    write_picture(&path, 9, 3);
    settled(&mut session, Action::OpenPicture(path));
    settled(&mut session, Action::SetVAxis(VAxis::Down));
    for (vertex, u, v) in [(0, 5.0, 4.0), (6, 5.5, 4.0), (30, 5.2, 3.0)] {
        place(&mut session, vertex, Target::hard(DVec2::new(u, v)));
    }
    let places = |session: &Session| -> [DVec2; 3] {
        let pins: Vec<DVec2> = session.document().pins().values().map(|pin| pin.target).collect();
        pins.try_into().unwrap()
    };
    let (before, document) = (places(&session), session.document().clone());
    settled(&mut session, Action::FitTargets);
    let after = places(&session);
    let [one, other] = turns(before, after);
    assert!(one.distance(other) < 1e-9 * one.length(), "neither sheared nor mirrored: {one}, {other}");
    let [low, high] = session.document().frame().corners();
    let middle = (after[0] + after[1] + after[2]) / 3.0;
    assert!(middle.cmpge(low).all() && middle.cmple(high).all(), "{middle} is on the picture");
    settled(&mut session, Action::FitTargets);
    let again = places(&session);
    assert!(after.iter().zip(again).all(|(a, b)| a.distance(b) < 1e-9), "there is nothing left to fit");
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), document);
}

#[test]
fn a_pin_that_nothing_can_hold_is_not_placed() {
    let (_folder, mut session) = with_dome();
    for weight in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        place(&mut session, 3, Target::weighted(DVec2::X, weight));
        assert!(session.document().targets.is_empty(), "{weight}");
    }
}

#[test]
fn fitting_one_target_is_refused() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::X));
    let before = session.document().clone();
    settled(&mut session, Action::FitTargets);
    assert!(errors(&session).len() == 1 && *session.document() == before, "{:?}", session.messages());
    assert_message("documents-fit-of-one-target", &words_of(&session.messages()[0]));
}

#[test]
fn turned_faces_mirror_the_embedding_and_stay_turned_in_the_file() {
    let (folder, mut session) = with_dome();
    let opening = session.opening_revision();
    let before = session.model().expect("open").clone();
    settled(&mut session, Action::TurnFaces);
    let after = session.model().expect("open").clone();
    assert_eq!(before.mesh().positions, after.mesh().positions);
    for (a, b) in before.mesh().triangles.iter().zip(&after.mesh().triangles) {
        assert_eq!(*b, [a[0], a[2], a[1]]);
    }
    assert!(session.is_current() && session.opening_revision() == opening);
    assert!(session.outcome().expect("solved").step.verdict.planar);
    let path = folder.path().join("turned.obj");
    let kind = freebound_io::OutputKind::Obj;
    settled(&mut session, Action::Save(SaveRequest { path: path.clone(), kind, fit: Fit::Unit }));
    assert_eq!(read_mesh(&path).unwrap().polygons.triangulate(), *after.mesh());
    settled(&mut session, Action::Undo);
    assert_eq!(session.model().expect("open").mesh(), before.mesh());
    assert!(session.is_current());
}

#[test]
fn faces_turned_to_and_fro_at_once_end_as_the_document_says() {
    for count in 1..6 {
        let (_folder, mut session) = with_dome();
        for _ in 0..count {
            session.handle(Action::TurnFaces);
        }
        settled(&mut session, Action::EndGesture);
        let is_turned = count % 2 == 1;
        assert_eq!(session.document().form.faces_turned, is_turned);
        assert_eq!(session.model().expect("open").prepared.form.faces_turned, is_turned);
        assert!(session.is_current(), "after {count}");
    }
}

#[test]
fn a_cancelled_turn_is_made_up_for_by_the_next_solve() {
    let (_folder, mut session) = with_dome();
    session.handle(Action::TurnFaces);
    settled(&mut session, Action::Cancel);
    settled(&mut session, Action::Solve);
    assert!(session.is_current() && session.model().expect("open").prepared.form.faces_turned);
}

#[test]
fn a_bowl_seen_from_inside_points_inward_and_a_flat_sheet_says_nothing() {
    let (folder, mut session) = with_dome();
    assert!(!session.model().expect("open").prepared.faces_point_inward);
    settled(&mut session, Action::TurnFaces);
    assert!(session.model().expect("open").prepared.faces_point_inward);
    let path = folder.path().join("flat.obj");
    let mut sheet = grid(4, 4);
    sheet.positions[12] += DVec3::Z * 0.01;
    write_obj(&path, &sheet);
    for turns in 0..2 {
        settled(&mut session, Action::Open(path.clone()));
        for _ in 0..turns {
            settled(&mut session, Action::TurnFaces);
        }
        assert!(!session.model().expect("open").prepared.faces_point_inward);
    }
}

corpus_test! {
    fn of_the_corpus_fran_s_faces_point_inward() {
        for entry in corpus_disks() {
            let volume = freebound_core::mesh::relative_volume(&entry.disk());
            println!("{:<24} {volume:+.4}", entry.file);
            if entry.file == "fran_face.obj" {
                assert!(volume < -0.01);
            }
        }
    }
}

#[test]
fn an_edit_that_arrives_in_the_middle_of_a_drag_waits_for_its_end() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::X));
    place(&mut session, 8, Target::hard(DVec2::Y));
    let before = session.document().clone();
    let path: PathBuf = folder.path().join("marks.txt");
    std::fs::write(&path, "20 0.5 0.5\n").unwrap();
    session.handle(Action::MovePin { vertex: id(3), target: DVec2::ZERO });
    settled(&mut session, Action::ImportConstraints(path));
    session.handle(Action::MovePin { vertex: id(3), target: DVec2::NEG_X });
    assert_eq!(session.document().targets.len(), 2);
    settled(&mut session, Action::EndGesture);
    assert_eq!(session.document().targets.len(), 3);
    settled(&mut session, Action::Undo);
    assert_eq!(targets(&session), [DVec2::NEG_X, DVec2::Y]);
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before, "the drag is one step");
    assert!(session.document().targets.values().all(|pin| pin.kind == PinKind::Hard));
}
