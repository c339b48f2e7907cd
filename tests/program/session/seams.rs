//! Seams in a session: an edit that is undone and redone, saved and opened again.

use freebound::session::{Action, Session, Severity};
use freebound_core::mesh::{Seams, VertexId};
use tempfile::TempDir;

use super::basics::{session, settled};
use super::documents::words_of;
use freebound_testkit::{assert_message, grid, write_obj};

/// Session with a sheet of 4×2 squares, in a temporary folder.
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

/// Edges across the middle of the sheet.
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
    // A slit from the boundary separates nothing.
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
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path.clone()));
    assert!(again.messages().is_empty(), "{:?}", again.messages());
    assert_eq!((chart_count(&again), again.seams()), (2, &across()));
    std::fs::write(&path, text.replace("2 7", "2-7")).expect("written");
    settled(&mut again, Action::Open(path));
    assert_message("seams-session-fault-in-project", &again.messages().first().expect("a fault").text);
}

/// Pins from an exported constraint file: vertex and u.
fn pins(folder: &TempDir, session: &mut Session) -> Vec<(u32, f64)> {
    let path = folder.path().join("pins.txt");
    settled(session, Action::ExportConstraints(path.clone()));
    let text = std::fs::read_to_string(path).expect("written");
    let pin = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        (words[0].parse().expect("a vertex"), words[1].parse().expect("a number"))
    };
    text.lines().filter(|line| !line.starts_with('#')).map(pin).collect()
}

/// Pins vertices in the given order, each with a different u: 0, 0.1 and so on.
fn pin(folder: &TempDir, session: &mut Session, vertices: &[u32]) {
    let line = |(k, v): (usize, &u32)| format!("{v} 0.{k} {v}\n");
    let path = folder.path().join("in.txt");
    std::fs::write(&path, vertices.iter().enumerate().map(line).collect::<String>()).expect("written");
    settled(session, Action::ImportConstraints(path));
}

/// Coordinate x of a vertex, and least x of its chart.
fn chart_with(session: &Session, vertex: u32) -> (f64, f64) {
    let model = session.model().expect("open");
    let charts = &model.prepared.chart.as_ref().expect("charts").charts;
    let number = charts.chart_of_vertex(VertexId::new(vertex)).expect("it has a chart");
    let positions = &charts.chart(number).repaired.polygons().positions.clone();
    let least = positions.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    (charts.whole().polygons().positions[vertex as usize].x, least)
}

#[test]
fn pins_stay_where_they_are_when_the_mesh_is_cut() {
    let (folder, mut session) = with_sheet();
    pin(&folder, &mut session, &[0, 7, 4, 14]);
    let before = session.document().clone();
    settled(&mut session, Action::SetSeams(across()));
    assert_eq!(chart_count(&session), 2);
    assert_eq!(pins(&folder, &mut session), [(0, 0.0), (4, 0.2), (7, 0.1), (14, 0.3)]);
    let document = session.document();
    assert_eq!(document.targets.len() + document.elsewhere[&1].targets.len(), 4, "each chart has its own");
    assert!(session.is_current());
    settled(&mut session, Action::Undo);
    assert_eq!((session.document(), chart_count(&session)), (&before, 1));
    settled(&mut session, Action::Redo);
    assert_eq!(pins(&folder, &mut session).len(), 4);
}

#[test]
fn a_pin_on_one_side_of_a_seam_keeps_its_side_when_vertices_get_other_numbers() {
    let (folder, mut session) = with_sheet();
    let right = Seams::default().with([edge(3, 8), edge(8, 13)]);
    settled(&mut session, Action::SetSeams(right.clone()));
    pin(&folder, &mut session, &[15, 0]);
    assert_eq!(chart_with(&session, 15), (3.0, 3.0), "the copy on the right");
    settled(&mut session, Action::SetSeams(right.with([edge(1, 6), edge(6, 11)])));
    assert_eq!(chart_count(&session), 3);
    let now = pins(&folder, &mut session);
    let (vertex, _) = now.iter().find(|(_, u)| u.to_bits() == 0.0_f64.to_bits()).expect("the pin is there");
    assert_ne!(*vertex, 15, "another vertex is cut before it");
    assert_eq!(chart_with(&session, *vertex), (3.0, 3.0));
}

#[test]
fn of_two_pins_that_come_to_one_vertex_one_stays_and_undo_brings_both_back() {
    let (folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across()));
    pin(&folder, &mut session, &[2, 15, 0]);
    let before = (session.document().clone(), pins(&folder, &mut session));
    assert_eq!(before.1.len(), 3);
    settled(&mut session, Action::SetSeams(Seams::default()));
    assert_eq!((chart_count(&session), pins(&folder, &mut session)), (1, vec![(0, 0.2), (2, 0.0)]));
    settled(&mut session, Action::Undo);
    assert_eq!((session.document().clone(), pins(&folder, &mut session)), before);
}

#[test]
fn seams_asked_for_one_after_the_other_are_all_cut() {
    let (folder, mut session) = with_sheet();
    pin(&folder, &mut session, &[0, 14]);
    session.handle(Action::SetSeams(session.seams().with([edge(2, 7)])));
    session.handle(Action::SetSeams(session.seams().with([edge(7, 12)])));
    assert_eq!(session.seams(), &across());
    super::basics::settle(&mut session);
    assert_eq!((chart_count(&session), &session.document().form.seams), (2, &across()));
    // A cut in progress is undone alone.
    session.handle(Action::SetSeams(Seams::default()));
    session.handle(Action::Undo);
    super::basics::settle(&mut session);
    assert_eq!((chart_count(&session), session.seams()), (2, &across()));
}

#[test]
fn the_chart_on_the_screen_stays_there_when_another_is_cut() {
    let (_folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across()));
    settled(&mut session, Action::ShowChart(1));
    settled(&mut session, Action::SetSeams(across().with([edge(5, 6), edge(6, 7)])));
    let model = session.model().expect("open");
    assert_eq!(model.chart_count(), 3);
    assert!(model.mesh().positions.iter().all(|p| p.x >= 2.0), "the right half, which is whole");
}

#[test]
fn seams_are_written_to_a_file_and_read_from_it() {
    let (folder, mut session) = with_sheet();
    let path = folder.path().join("seams.txt");
    settled(&mut session, Action::ExportSeams(path.clone()));
    assert!(!path.exists());
    assert_message("seams-session-nothing-to-write", &session.messages().last().expect("said").text);
    settled(&mut session, Action::SetSeams(across()));
    settled(&mut session, Action::ExportSeams(path.clone()));
    assert_eq!(std::fs::read_to_string(&path).expect("written").lines().skip(1).collect::<Vec<_>>(), ["2 7", "7 12"]);
    settled(&mut session, Action::SetSeams(Seams::default().with([edge(3, 8)])));
    settled(&mut session, Action::ImportSeams(path.clone()));
    assert_eq!(session.seams(), &across().with([edge(3, 8)]), "those that there were stay");
    std::fs::write(&path, "0 1\n0 7\n").expect("written");
    settled(&mut session, Action::ImportSeams(path));
    let said = session.messages().last().expect("it is told");
    assert_eq!((said.severity, said.vertices.len()), (Severity::Error, 2));
    assert_message("seams-session-no-edge", &words_of(said));
    assert_eq!(session.seams().edges().len(), 3);
}

#[test]
fn a_project_keeps_pins_on_both_sides_of_a_seam() {
    let (folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across()));
    pin(&folder, &mut session, &[2, 15, 4]);
    let path = folder.path().join("sheet.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    assert!(again.messages().is_empty(), "{:?}", again.messages());
    assert_eq!(again.document(), session.document());
    assert_eq!(pins(&folder, &mut again).len(), 3);
}

#[test]
fn seams_of_texture_coordinates_are_an_edit_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.obj");
    // Two squares with different coordinates at their common side.
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n\
                vt 0 0\nvt .3 0\nvt .3 1\nvt 0 1\nvt .6 0\nvt .9 0\nvt .9 1\nvt .6 1\n\
                f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\n";
    std::fs::write(&path, text).expect("written");
    let mut session = session();
    settled(&mut session, Action::Open(path));
    // The planar layout of the file opens by itself.
    assert_eq!(chart_count(&session), 2);
    settled(&mut session, Action::Undo);
    assert_eq!(chart_count(&session), 1);
    let mut seams = Seams::default();
    seams.of_texture = true;
    settled(&mut session, Action::SetSeams(seams));
    assert_eq!(chart_count(&session), 2);
    settled(&mut session, Action::Undo);
    assert_eq!(chart_count(&session), 1);
}

#[test]
fn seams_of_a_project_that_the_mesh_does_not_have_are_told_and_the_project_keeps_them() {
    let (folder, mut session) = with_sheet();
    settled(&mut session, Action::SetSeams(across().with([edge(0, 1)])));
    let path = folder.path().join("sheet.freebound");
    settled(&mut session, Action::SaveProject(path.clone()));
    let text = std::fs::read_to_string(&path).expect("written");
    std::fs::write(&path, text.replace("\"2 7\"", "\"2 14\"").replace("\"0 1\"", "\"3 900\"")).expect("written");
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(path));
    let [message] = again.messages() else { panic!("{:?}", again.messages()) };
    assert_message("seams-session-left-out", &words_of(message));
    assert_eq!(again.seams(), &Seams::default().with([edge(7, 12)]));
    assert_eq!(again.model().expect("open").prepared.form, again.document().form);
    assert!(again.project_path().is_none(), "saving asks for another place");
}
