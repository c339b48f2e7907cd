//! A mesh that is no disk, mended in a session: undone, repeated, saved and opened again.

use freebound::io::read_mesh;
use freebound::mesh::{Form, PolygonMesh, Repair};
use freebound::session::{Action, Place, Session, Surface};
use tempfile::TempDir;

use crate::makers::{tetrahedron, write_obj};
use crate::program::obj_text;
use crate::session::{session, settled};
use crate::session_documents::errors;

/// A session with a tetrahedron, in a folder of its own.
fn with_closed() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("closed.obj");
    write_obj(&path, &tetrahedron());
    let mut session = session();
    settled(&mut session, Action::Open(path));
    (folder, session)
}

fn is_faulty(session: &Session) -> bool {
    matches!(session.model().expect("open").surface, Surface::Faulty(..))
}

#[test]
fn mending_is_an_edit_that_is_undone_and_repeated() {
    let (_folder, mut session) = with_closed();
    assert!(is_faulty(&session) && !session.can_repair());
    assert_eq!(errors(&session).len(), 1);
    let remedy = session.model().expect("open").remedy.clone().expect("it can be cut");
    assert_eq!(remedy.done()[0].repair, Repair::Cut);
    settled(&mut session, Action::Mend);
    assert!(!is_faulty(&session) && session.is_current() && errors(&session).is_empty());
    assert_eq!(session.document().form, Form::default().mended());
    let solved = session.outcome().expect("solved").step.solution.embedding.clone();
    settled(&mut session, Action::Undo);
    assert!(is_faulty(&session) && session.outcome().is_none());
    assert_eq!(errors(&session).len(), 1, "what is wrong is said again");
    settled(&mut session, Action::Redo);
    assert_eq!(session.outcome().expect("solved").step.solution.embedding, solved);
}

#[test]
fn mending_does_nothing_where_nothing_is_wrong_or_nothing_can_be_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lost = crate::makers::grid(3, 2);
    lost.positions[4].y = f64::NAN;
    for (name, mesh) in [("lost.obj", lost), ("sheet.obj", crate::makers::grid(3, 2))] {
        let path = folder.path().join(name);
        write_obj(&path, &mesh);
        let mut session = session();
        settled(&mut session, Action::Open(path));
        settled(&mut session, Action::Mend);
        assert!(!session.history().can_undo(), "{name}");
        assert_eq!(session.document().form, Form::default(), "{name}");
    }
}

#[test]
fn a_project_of_a_mended_mesh_opens_as_it_was_pins_of_new_vertices_too() {
    let (folder, mut session) = with_closed();
    settled(&mut session, Action::Mend);
    let first_new = u32::try_from(tetrahedron().vertex_count()).expect("few");
    settled(&mut session, Action::Fix([0, first_new].map(freebound::mesh::VertexId::new).to_vec()));
    let solved = session.outcome().expect("solved").step.solution.embedding.clone();
    let path = folder.path().join("closed.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = crate::session::session();
    settled(&mut again, Action::Open(path));
    assert!(again.messages().iter().all(|message| message.place != Place::Mesh), "{:?}", again.messages());
    assert_eq!(again.document().form, Form::default().mended());
    assert_eq!(again.document().targets.len(), 2);
    assert_eq!(again.outcome().expect("solved").step.solution.embedding, solved);
}

#[test]
fn turning_a_mended_mesh_keeps_it_mended_and_every_vertex_its_number() {
    let (_folder, mut session) = with_closed();
    settled(&mut session, Action::Mend);
    let places = |session: &Session| {
        let model = session.model().expect("open").clone();
        (model.repaired.clone().expect("mended").done().to_vec(), model.mesh().positions.clone())
    };
    let before = places(&session);
    let unturned = session.model().expect("open").mesh().triangles.clone();
    settled(&mut session, Action::TurnFaces);
    assert_eq!(places(&session), before);
    let turned = &session.model().expect("open").mesh().triangles;
    let backwards = |[a, b, c]: [freebound::mesh::VertexId; 3]| [a, c, b];
    assert!(unturned.iter().map(|face| backwards(*face)).eq(turned.iter().copied()));
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::TurnFaces);
    assert!(!is_faulty(&session) && session.is_current());
    assert_eq!(session.document().form, Form { faces_turned: true, ..Form::default().mended() });
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    assert!(is_faulty(&session));
}

#[test]
fn what_is_harmless_is_mended_without_a_question_and_the_file_keeps_its_faces() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("twice.obj");
    let mut mesh = PolygonMesh::from(&crate::makers::grid(3, 2));
    let first = mesh.corners[..3].to_vec();
    mesh.corners.extend(first);
    std::fs::write(&path, obj_text(&mesh)).expect("written");
    let mut session = session();
    settled(&mut session, Action::Open(path.clone()));
    assert!(session.is_current() && errors(&session).is_empty());
    let model = session.model().expect("open");
    assert_eq!(model.repaired.as_ref().expect("repaired").done()[0].repair, Repair::DropDuplicateFaces);
    assert_eq!(*model.source, read_mesh(&path).expect("a mesh"));
}
