//! Seams in a session: an edit that is undone and repeated, saved and opened again.

use freebound::mesh::{Seams, VertexId};
use freebound::session::{Action, Session};
use tempfile::TempDir;

use crate::makers::{grid, write_obj};
use crate::session::{session, settled};

/// A session with a sheet of 4×2 squares, in a folder of its own.
fn with_sheet() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.obj");
    write_obj(&path, &grid(4, 2));
    let mut session = session();
    settled(&mut session, Action::Open(path));
    (folder, session)
}

fn edge(a: u32, b: u32) -> [VertexId; 2] {
    [a, b].map(VertexId::new)
}

/// The edges across the middle of the sheet.
fn across() -> Seams {
    Seams::default().with([edge(7, 2), edge(7, 12)])
}

fn chart_count(session: &Session) -> usize {
    session.model().expect("open").chart_count()
}

#[test]
fn seams_are_an_edit_that_is_undone_and_repeated() {
    let (_folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across()));
    assert_eq!((chart_count(&session), session.seams()), (2, &across()));
    assert!(session.is_current());
    settled(&mut session, Action::Undo);
    assert_eq!((chart_count(&session), session.seams()), (1, &Seams::default()));
    settled(&mut session, Action::Redo);
    assert_eq!(chart_count(&session), 2);
    settled(&mut session, Action::SetSeams(across().without([edge(2, 7)])));
    // A slit from the boundary takes nothing apart.
    assert_eq!((chart_count(&session), session.model().expect("open").vertex_count()), (1, 16));
}

#[test]
fn a_project_with_seams_opens_as_it_was() {
    let (folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across()));
    let path = folder.path().join("sheet.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let text = std::fs::read_to_string(&path).expect("written");
    assert!(text.contains("\"2 7\",") && text.contains("\"7 12\"\n"), "{text}");
    let mut again = crate::session::session();
    settled(&mut again, Action::Open(path.clone()));
    assert!(again.messages().is_empty(), "{:?}", again.messages());
    assert_eq!((chart_count(&again), again.seams()), (2, &across()));
    std::fs::write(&path, text.replace("2 7", "2-7")).expect("written");
    settled(&mut again, Action::Open(path));
    let message = &again.messages().iter().next().expect("a fault").text;
    assert!(message.contains("\"2-7\" is no edge"), "{message}");
}
