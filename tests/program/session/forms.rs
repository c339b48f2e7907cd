//! Preparation of the mesh in a session: pins follow every change of it, and no number of another preparation is
//! used.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::session::{Action, Busy, Session};
use freebound_core::mesh::{PolygonMesh, Seams, VertexId, WeldDistance};
use freebound_core::pipeline::Target;
use freebound_io::ProjectFile;
use glam::{DVec2, DVec3};
use tempfile::TempDir;

use super::basics::{session, settle, settled};
use super::documents::errors;
use crate::cli::program::obj_text;
use freebound_testkit::{assert_message, grid, write_obj};

/// Gap between two sheets.
const GAP: f64 = 1.0 / 2_097_152.0;

/// Two sheets of 3×2 squares in one file, side by side with a gap, the right one first in the file.
fn two_sheets() -> PolygonMesh {
    let left = grid(3, 2);
    let mut positions: Vec<DVec3> = left.positions.iter().map(|p| *p + (3.0 + GAP) * DVec3::X).collect();
    let shift = positions.len();
    positions.extend(&left.positions);
    let corners = left.triangles.iter().flatten().map(|v| v.index());
    let corners = corners.clone().chain(corners.map(|v| v + shift)).map(VertexId::from_index).collect();
    PolygonMesh { positions, corners, starts: None }
}

fn with_two_sheets() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.obj");
    std::fs::write(&path, obj_text(&two_sheets())).expect("written");
    let mut session = session();
    settled(&mut session, Action::Open(path));
    assert_eq!(chart_count(&session), 2);
    (folder, session)
}

/// Session with a sheet of 4×2 squares that is cut twice, after two corners were pinned.
fn cut_twice() -> (TempDir, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.obj");
    write_obj(&path, &grid(4, 2));
    let mut session = session();
    settled(&mut session, Action::Open(path));
    pin(&mut session, 4, 0.75);
    pin(&mut session, 10, 0.25);
    settled(&mut session, Action::SetSeams(Seams::default().with([edge(7, 2), edge(7, 12)])));
    let both = session.seams().with([edge(3, 8), edge(8, 13)]);
    settled(&mut session, Action::SetSeams(both));
    assert_eq!(chart_count(&session), 3);
    (folder, session)
}

fn edge(a: u32, b: u32) -> [VertexId; 2] {
    [a, b].map(VertexId::new)
}

fn pin(session: &mut Session, vertex: u32, u: f64) {
    let target = Target::hard(DVec2::new(u, 0.5));
    settled(session, Action::Place { vertex: VertexId::new(vertex), target });
}

fn chart_count(session: &Session) -> usize {
    session.model().expect("open").chart_count()
}

/// Positions on the mesh of the pins of all charts, each with its u, from an exported file.
fn places(folder: &TempDir, session: &mut Session) -> Vec<(DVec3, f64)> {
    let path = folder.path().join("pins.txt");
    settled(session, Action::ExportConstraints(path.clone()));
    let text = std::fs::read_to_string(path).expect("written");
    let model = session.model().expect("open").clone();
    let whole = model.prepared.chart.as_ref().map(|of| of.charts.whole().polygons().positions.clone());
    let positions = whole.unwrap_or_else(|| model.mesh().positions.clone());
    let place = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        (positions[words[0].parse::<usize>().expect("a vertex")], words[1].parse().expect("a number"))
    };
    let mut places: Vec<(DVec3, f64)> = text.lines().filter(|line| !line.starts_with('#')).map(place).collect();
    places.sort_by(|a, b| a.1.total_cmp(&b.1));
    places
}

/// Pins a corner of each part, each on its side.
fn pin_both_parts(session: &mut Session) -> [(DVec3, f64); 2] {
    let on_screen = session.chart_on_screen().expect("charts");
    let corner = |session: &Session, x: f64| {
        let positions = &session.model().expect("open").mesh().positions;
        let found = positions.iter().position(|p| *p == DVec3::new(x, 2.0, 0.0)).expect("a corner");
        u32::try_from(found).expect("few")
    };
    assert_eq!(on_screen, 0, "the right part");
    let right = corner(session, 6.0 + GAP);
    pin(session, right, 0.75);
    settled(session, Action::ShowChart(1));
    let left = corner(session, 0.0);
    pin(session, left, 0.25);
    [(DVec3::new(0.0, 2.0, 0.0), 0.25), (DVec3::new(6.0 + GAP, 2.0, 0.0), 0.75)]
}

#[test]
fn pins_of_two_parts_stay_where_they_are_when_the_parts_are_welded() {
    let (folder, mut session) = with_two_sheets();
    let expected = pin_both_parts(&mut session);
    let before = session.document().clone();
    settled(&mut session, Action::Weld(WeldDistance::new(1e-6)));
    assert_eq!(chart_count(&session), 1);
    assert_eq!(places(&folder, &mut session), expected);
    assert!(session.document().elsewhere.is_empty() && session.is_current());
    settled(&mut session, Action::Undo);
    assert_eq!((session.document(), chart_count(&session)), (&before, 2));
    assert_eq!(places(&folder, &mut session), expected);
    settled(&mut session, Action::Redo);
    settled(&mut session, Action::Weld(None));
    assert_eq!((chart_count(&session), places(&folder, &mut session)), (2, expected.to_vec()), "and taken apart");
}

#[test]
fn pins_of_a_part_stay_where_they_are_when_the_other_one_is_left_out() {
    let (folder, mut session) = with_two_sheets();
    let expected = pin_both_parts(&mut session);
    settled(&mut session, Action::LeaveOut(BTreeSet::from([0])));
    assert_eq!((chart_count(&session), places(&folder, &mut session)), (1, vec![expected[0]]));
    assert!(session.is_current());
    settled(&mut session, Action::Undo);
    assert_eq!(places(&folder, &mut session), expected);
}

#[test]
fn a_mesh_that_is_turned_while_it_is_welded_is_both() {
    let (folder, mut session) = with_two_sheets();
    let expected = pin_both_parts(&mut session);
    session.handle(Action::Weld(WeldDistance::new(1e-6)));
    session.handle(Action::TurnFaces);
    settle(&mut session);
    assert_eq!((chart_count(&session), places(&folder, &mut session)), (1, expected.to_vec()));
    assert!(session.document().form.faces_turned && session.document().form.repair.weld_distance().is_some());
}

#[test]
fn pins_are_not_edited_by_the_numbers_of_another_form() {
    let (_folder, mut session) = cut_twice();
    session.handle(Action::Undo);
    session.handle(Action::Undo);
    let wanted = session.document().clone();
    assert_ne!(session.model().expect("open").prepared.form, wanted.form, "it is being brought about");
    let (first, target) = (VertexId::new(4), DVec2::ZERO);
    assert!(wanted.targets.contains_key(&first));
    session.handle(Action::MovePin { vertex: first, target });
    session.handle(Action::Place { vertex: VertexId::new(0), target: Target::hard(target) });
    session.handle(Action::Unpin(vec![first]));
    session.handle(Action::SetPinKind { vertices: vec![first], kind: Target::fixed(target).kind });
    assert_eq!(session.document(), &wanted);
    settle(&mut session);
    assert_eq!(session.document(), &wanted);
    pin(&mut session, 0, 0.1);
    assert_eq!(session.document().targets.len(), 3, "now they are");
}

#[test]
fn constraints_that_are_read_while_the_mesh_is_formed_are_taken_once_it_is() {
    let (folder, mut session) = cut_twice();
    let path = folder.path().join("more.txt");
    std::fs::write(&path, "0 0.125 0.5\n").expect("written");
    session.handle(Action::Undo);
    session.handle(Action::Undo);
    settled(&mut session, Action::ImportConstraints(path));
    let expected = [(DVec3::ZERO, 0.125), (DVec3::new(0.0, 2.0, 0.0), 0.25), (DVec3::new(4.0, 0.0, 0.0), 0.75)];
    assert_eq!(places(&folder, &mut session), expected);
}

#[test]
fn the_mesh_takes_its_form_after_a_stop_and_is_not_solved() {
    let (_folder, mut session) = cut_twice();
    session.handle(Action::Undo);
    session.handle(Action::Undo);
    settled(&mut session, Action::Cancel);
    assert_eq!(session.model().expect("open").prepared.form, session.document().form);
    assert!(!session.is_current() && session.outcome().is_none());
    settled(&mut session, Action::Solve);
    assert!(session.is_current());
}

#[test]
fn nothing_is_written_by_the_numbers_of_another_form() {
    let (folder, mut session) = cut_twice();
    let (pins, project) = (folder.path().join("now.txt"), folder.path().join("now.freebound"));
    session.handle(Action::Undo);
    session.handle(Action::Undo);
    let before = errors(&session).len();
    session.handle(Action::ExportConstraints(pins.clone()));
    session.handle(Action::SaveProject(project.clone()));
    let said = errors(&session).split_off(before);
    assert!(said.len() == 2 && said[0] == said[1], "{said:?}");
    assert_message("forms-nothing-is-written", said[0]);
    settle(&mut session);
    assert!(!pins.exists() && !project.exists());
    settled(&mut session, Action::SaveProject(project.clone()));
    let saved = ProjectFile::read(&project).expect("a project").pins.targets;
    assert_eq!(saved.keys().copied().collect::<Vec<_>>(), [4, 10].map(VertexId::new));
}

#[test]
fn a_copy_for_recovery_has_the_pins_of_its_form() {
    let (folder, mut session) = cut_twice();
    let copies = folder.path().join("copies");
    session.keep_copies_in(copies.clone());
    session.handle(Action::Undo);
    session.handle(Action::Undo);
    let copy = || std::fs::read_dir(&copies).ok()?.find_map(|entry| ProjectFile::read(&entry.ok()?.path()).ok());
    let begun = Instant::now();
    let copy = loop {
        session.poll();
        if let Some(copy) = copy() {
            break copy;
        }
        assert!(begun.elapsed() < Duration::from_secs(90), "no copy is made");
    };
    assert_eq!(copy.pins.targets.keys().copied().collect::<Vec<_>>(), [4, 10].map(VertexId::new));
}

#[test]
fn the_mesh_is_cut_once_while_pins_are_dragged_and_the_cut_follows_the_drag() {
    let (_folder, mut session) = cut_twice();
    settled(&mut session, Action::Undo);
    settled(&mut session, Action::Undo);
    session.handle(Action::MovePin { vertex: VertexId::new(4), target: DVec2::new(0.5, 0.25) });
    session.handle(Action::SetSeams(Seams::default().with([edge(7, 2), edge(7, 12)])));
    assert_eq!(session.busy(), Some(Busy::Job("cutting or repairing the mesh")));
    // If the mesh were cut repeatedly, this would never return.
    settle(&mut session);
    assert_eq!(chart_count(&session), 1);
    settled(&mut session, Action::EndGesture);
    assert_eq!(chart_count(&session), 2);
}

#[test]
fn a_count_that_was_stopped_is_not_begun_again() {
    let (_folder, mut session) = with_two_sheets();
    let within = WeldDistance::new(1e-6).expect("a distance");
    session.handle(Action::CountNear(within));
    assert_eq!(session.busy(), Some(Busy::Job("counting near vertices")));
    session.handle(Action::Cancel);
    settled(&mut session, Action::CountNear(within));
    assert_eq!(session.near_count(within), None);
    let other = WeldDistance::new(1e-5).expect("a distance");
    settled(&mut session, Action::CountNear(other));
    assert_eq!(session.near_count(other), Some(3));
}

#[test]
fn how_charts_are_packed_is_undone_and_repeated_without_a_solve() {
    let (_folder, mut session) = with_two_sheets();
    let step = session.outcome().expect("solved").clone();
    settled(&mut session, Action::SetChartSize { chart: 1, size: 2.0 });
    for action in [Action::Undo, Action::Redo] {
        session.handle(action);
        assert_eq!(session.busy(), None);
        settle(&mut session);
        assert!(session.is_current() && Arc::ptr_eq(&step, session.outcome().expect("solved")));
    }
}

#[test]
fn constraint_files_are_taken_in_the_order_in_which_they_were_given() {
    let (folder, mut session) = with_two_sheets();
    let [long, short] = ["long.txt", "short.txt"].map(|name| folder.path().join(name));
    std::fs::write(&long, "# a long file\n".repeat(200_000) + "0 0.25 0.5\n").expect("written");
    std::fs::write(&short, "0 0.75 0.5\n").expect("written");
    session.handle(Action::ImportConstraints(long));
    settled(&mut session, Action::ImportConstraints(short));
    assert_eq!(session.document().targets[&VertexId::new(0)].uv.x, 0.75);
}
