//! Mesh that is not a disk, repaired in a session: undone, redone, saved and opened again.

use freebound::session::{Action, MessagePlace, Session};
use freebound_core::mesh::{Fault, PolygonMesh, Preparation, Repair, Repairs, WeldDistance};
use freebound_core::pipeline::Surface;
use freebound_io::read_mesh;
use tempfile::TempDir;

use super::basics::{session, settled};
use super::documents::errors;
use crate::cli::program::obj_text;
use freebound_testkit::{tetrahedron, write_obj};

/// Session with a tetrahedron in a temporary folder. Opening it unwrapped it; undo gave its fault back.
fn with_closed() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("closed.obj");
    write_obj(&path, &tetrahedron());
    let mut session = session();
    settled(&mut session, Action::Open(path));
    settled(&mut session, Action::Undo);
    (folder, session)
}

/// Preparation without its automatic seams.
fn without_seams(session: &Session) -> Preparation {
    let form = session.document().form.clone();
    Preparation { seams: form.seams.without_automatic(), ..form }
}

fn is_faulty(session: &Session) -> bool {
    matches!(session.model().expect("open").prepared.surface, Surface::Faulty(..))
}

#[test]
fn mending_is_an_edit_that_is_undone_and_repeated() {
    let (_folder, mut session) = with_closed();
    assert!(is_faulty(&session) && !session.can_repair());
    assert_eq!(errors(&session).len(), 1);
    let remedy = session.model().expect("open").prepared.remedy.clone().expect("it can be cut");
    assert_eq!(remedy.done()[0].repair, Repair::Cut);
    settled(&mut session, Action::Unwrap(None));
    assert!(!is_faulty(&session) && session.is_current() && errors(&session).is_empty());
    assert_eq!(without_seams(&session), Preparation::default().with_all_repairs());
    let solved = session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    settled(&mut session, Action::Undo);
    assert!(is_faulty(&session) && session.outcome().is_none());
    assert_eq!(errors(&session).len(), 1, "what is wrong is said again");
    settled(&mut session, Action::Redo);
    assert_eq!(session.outcome().expect("solved").step.candidate.solution.embedding, solved);
}

#[test]
fn a_mesh_that_no_repair_helps_is_not_unwrapped_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lost = freebound_testkit::grid(3, 2);
    lost.positions[4].y = f64::NAN;
    let path = folder.path().join("lost.obj");
    write_obj(&path, &lost);
    let mut session = session();
    settled(&mut session, Action::Open(path));
    let told = errors(&session).len();
    settled(&mut session, Action::Unwrap(None));
    assert!(!session.history().can_undo() && !session.can_unwrap());
    assert_eq!(session.document().form, Preparation::default());
    assert_eq!(errors(&session).len(), told + 1);
}

#[test]
fn a_project_of_a_mended_mesh_opens_as_it_was_pins_of_new_vertices_too() {
    let (folder, mut session) = with_closed();
    settled(&mut session, Action::Unwrap(None));
    let first_new = u32::try_from(tetrahedron().vertex_count()).expect("few");
    settled(&mut session, Action::Fix([0, first_new].map(freebound_core::mesh::VertexId::new).to_vec()));
    let solved = session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    let path = folder.path().join("closed.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    assert!(again.messages().iter().all(|message| message.place != MessagePlace::Mesh), "{:?}", again.messages());
    assert_eq!(again.document().form, session.document().form);
    assert_eq!(again.document().targets.len(), 2);
    assert_eq!(again.outcome().expect("solved").step.candidate.solution.embedding, solved);
}

#[test]
fn turning_a_mended_mesh_keeps_it_mended_and_every_vertex_its_number() {
    let (_folder, mut session) = with_closed();
    settled(&mut session, Action::Unwrap(None));
    let places = |session: &Session| {
        let model = session.model().expect("open").clone();
        (model.prepared.repaired.clone().expect("mended").done().to_vec(), model.mesh().positions.clone())
    };
    let before = places(&session);
    let unturned = session.model().expect("open").mesh().triangles.clone();
    settled(&mut session, Action::TurnFaces);
    assert_eq!(places(&session), before);
    let turned = &session.model().expect("open").mesh().triangles;
    let backwards = |[a, b, c]: [freebound_core::mesh::VertexId; 3]| [a, c, b];
    assert!(unturned.iter().map(|face| backwards(*face)).eq(turned.iter().copied()));
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::TurnFaces);
    assert!(!is_faulty(&session) && session.is_current());
    let turned = Preparation { faces_turned: true, ..Preparation::default().with_all_repairs() };
    assert_eq!(without_seams(&session), turned);
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    assert!(is_faulty(&session));
}

#[test]
fn what_is_harmless_is_mended_without_a_question_and_the_file_keeps_its_faces() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("twice.obj");
    let mut mesh = PolygonMesh::from(&freebound_testkit::grid(3, 2));
    let first = mesh.corners[..3].to_vec();
    mesh.corners.extend(first);
    std::fs::write(&path, obj_text(&mesh)).expect("written");
    let mut session = session();
    settled(&mut session, Action::Open(path.clone()));
    assert!(session.is_current() && errors(&session).is_empty());
    let model = session.model().expect("open");
    assert_eq!(model.prepared.repaired.as_ref().expect("repaired").done()[0].repair, Repair::StackDuplicates);
    assert_eq!(*model.source, read_mesh(&path).expect("a mesh"));
}

#[test]
fn a_single_remedy_is_an_edit_that_leaves_the_other_faults_and_is_kept_in_a_project() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("odd.obj");
    let mut mesh = tetrahedron();
    mesh.triangles[2].swap(0, 1);
    write_obj(&path, &mesh);
    let mut session = session();
    settled(&mut session, Action::Open(path));
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::AllowRepair(Repair::TurnFaces));
    let faults = |session: &Session| match &session.model().expect("open").prepared.surface {
        Surface::Faulty(_, diagnosis) => diagnosis.faults.iter().map(Fault::name).collect(),
        Surface::Disk(_) => Vec::new(),
    };
    assert_eq!(faults(&session), ["closed"]);
    let project = folder.path().join("odd.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(project));
    assert_eq!(again.document().form.repair, Repairs::SAFE.with(Repair::TurnFaces));
    assert_eq!(faults(&again), ["closed"]);
    settled(&mut again, Action::AllowRepair(Repair::Cut));
    assert!(again.outcome().expect("solved").step.verdict.planar);
    settled(&mut again, Action::Undo);
    assert_eq!(faults(&again), ["closed"]);
    settled(&mut session, Action::Undo);
    assert_eq!(faults(&session), ["mixed-orientation", "closed"]);
}

#[test]
fn the_distance_of_welding_is_kept_in_a_project_and_older_projects_have_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.obj");
    write_obj(&path, &freebound_testkit::grid(3, 2));
    let mut session = session();
    settled(&mut session, Action::Open(path));
    let within = WeldDistance::new(1e-3).expect("a distance");
    assert_eq!(session.near_count(within), None);
    settled(&mut session, Action::CountNear(within));
    assert_eq!(session.near_count(within), Some(0));
    settled(&mut session, Action::Weld(Some(within)));
    assert!(session.is_current(), "nothing is near: the sheet is as it was");
    let project = folder.path().join("sheet.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(project.clone()));
    assert_eq!(again.document().form.repair, Repairs::SAFE.welding(Some(within)));
    let text = std::fs::read_to_string(&project).expect("written");
    let older: String =
        text.lines().filter(|line| !line.contains("weld_distance")).map(|line| line.to_owned() + "\n").collect();
    assert_ne!(older, text);
    std::fs::write(&project, older).expect("written");
    settled(&mut again, Action::Open(project));
    assert_eq!(again.document().form.repair, Repairs::SAFE);
}
