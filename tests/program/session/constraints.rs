//! Constraints in a session: the last stages in the background, relaxation, conflicts, mirrored targets, new
//! vertices in an outcome.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::session::{Action, RunStop, Session};
use freebound_core::flatten::{Ending, Flattener};
use freebound_core::mesh::{DiskMesh, NewVertex, Refinement, VertexId};
use freebound_core::pipeline::{Fit, Outcome, Problem, Target};
use freebound_core::problem::{Control, Family, Method, Pins, Settings, Stage};
use glam::DVec2;

use super::basics::{session, settle, settled};
use super::documents::words_of;
use freebound_testkit::{assert_message, grid, write_obj};

pub(crate) fn id(number: u32) -> VertexId {
    VertexId::new(number)
}

/// Session with a flat grid of 8 × 8 squares.
pub(crate) fn with_grid() -> Session {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("grid.obj");
    write_obj(&path, &grid(8, 8));
    let mut session = session();
    settled(&mut session, Action::Open(path));
    session
}

pub(crate) fn place(session: &mut Session, pins: &[(u32, DVec2)]) {
    for &(vertex, target) in pins {
        session.handle(Action::Place { vertex: id(vertex), target: Target::hard(target) });
    }
}

/// Targets for the corners of the grid in place, and four vertices around its middle rotated by a quarter turn. The
/// linear solve folds.
fn twist() -> Vec<(u32, DVec2)> {
    let at = |x: f64, y: f64| DVec2::new(x, y);
    let corners = [(0, at(0.0, 0.0)), (8, at(8.0, 0.0)), (72, at(0.0, 8.0)), (80, at(8.0, 8.0))];
    let ring = [(30, at(5.0, 3.0)), (32, at(5.0, 5.0)), (48, at(3.0, 3.0)), (50, at(3.0, 5.0))];
    corners.into_iter().chain(ring).collect()
}

/// True if all hard pins of the newest step are met bitwise, and it is planar.
fn is_solved(session: &Session) -> bool {
    let outcome = session.outcome().expect("solved");
    let embedding = &outcome.step.candidate.solution.embedding;
    let is_met = |(vertex, target): &(u32, DVec2)| embedding[*vertex as usize] == *target;
    outcome.step.verdict.planar && twist().iter().all(is_met)
}

#[test]
fn a_hard_set_of_constraints_ends_planar_by_itself() {
    let mut session = with_grid();
    place(&mut session, &twist());
    settle(&mut session);
    assert!(is_solved(&session), "{:?}", session.messages());
    assert_eq!(session.stopped(), Some(RunStop::Ended(Ending::Planar)));
    let records = session.timeline().records();
    assert!(records[0].stage == Stage::Natural && !records[0].planar, "the linear solve shows first, and folds");
    assert_eq!(records.last().expect("steps").stage, Stage::Relax);
    let standings = session.timeline().standings();
    let waits = records.iter().zip(standings).any(|(record, standing)| record.planar && standing.unmet > 0);
    assert!(waits, "a planar step that does not meet the constraints is no end");
    assert!(standings.last().expect("steps").progress.is_some_and(|progress| progress.distance_left == 0.0));
}

#[test]
fn a_run_that_is_stopped_on_its_way_keeps_a_planar_step_and_can_go_on() {
    let mut session = with_grid();
    place(&mut session, &twist());
    // Pauses after the first planar step of the continuation, whatever is computed meanwhile.
    let begun = Instant::now();
    while !session
        .timeline()
        .records()
        .last()
        .is_some_and(|record| record.planar && record.stage == Stage::Continuation)
    {
        assert!(begun.elapsed() < Duration::from_secs(90), "{session:?}");
        std::thread::sleep(Duration::from_micros(100));
        session.poll();
    }
    settled(&mut session, Action::Cancel);
    let outcome = session.outcome().expect("solved");
    assert!(outcome.step.verdict.planar, "every step of a continuation is");
    settled(&mut session, Action::Run);
    assert!(is_solved(&session), "{:?}", session.messages());
}

#[test]
fn relaxing_lowers_the_energy_and_keeps_the_constraints() {
    let mut session = with_grid();
    place(&mut session, &twist());
    settle(&mut session);
    assert!(session.can_relax());
    let before = session.timeline().newest().expect("steps");
    settled(&mut session, Action::Relax);
    assert!(is_solved(&session), "{:?}", session.messages());
    let timeline = session.timeline();
    let relaxed = &timeline.records()[before + 1..];
    assert!(!relaxed.is_empty() && relaxed.iter().all(|record| record.stage == Stage::Relax && record.planar));
    // Counted from the first step that meets the constraints, automatic rounds included.
    let arrived =
        timeline.records().iter().rposition(|record| record.stage == Stage::Continuation).expect("it arrived");
    let energies: Vec<f64> =
        timeline.standings()[arrived..].iter().map(|standing| standing.progress.expect("numbers").energy).collect();
    assert!(energies.is_sorted_by(|a, b| a >= b) && energies.last() < energies.first(), "{energies:?}");
    assert_eq!(session.stopped(), Some(RunStop::Ended(Ending::Planar)), "it comes to rest where it was");
}

#[test]
fn a_planar_start_is_kept_when_targets_are_edited() {
    let mut session = with_grid();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Continuation, Family::Conformal)));
    place(&mut session, &twist()[..5]);
    settle(&mut session);
    assert_eq!(session.timeline().records()[0].stage, Stage::Continuation, "one without pins had made the start");
    settled(&mut session, Action::TurnFaces);
    assert_eq!(session.timeline().records()[0].stage, Stage::Natural, "that of other faces does not serve");
}

#[test]
fn what_is_not_planar_is_not_relaxed() {
    let mut session = with_grid();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    place(&mut session, &twist());
    settle(&mut session);
    assert!(!session.outcome().expect("solved").step.verdict.planar && !session.can_relax());
    settled(&mut session, Action::Relax);
    assert_eq!(session.timeline().records().len(), 1);
}

#[test]
fn what_is_one_to_one_but_for_concave_polygons_can_be_relaxed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("quads.obj");
    let height = |x: u32, y: u32| 0.3 * f64::from(x * y) / 16.0;
    let vertices = (0..25).map(|k| (k % 5, k / 5)).map(|(x, y)| format!("v {x} {y} {}\n", height(x, y)));
    let corner = |k: u32| k / 4 * 5 + k % 4 + 1;
    let quads = (0..16).map(corner).map(|v| format!("f {v} {} {} {}\n", v + 1, v + 6, v + 5));
    std::fs::write(&path, vertices.chain(quads).collect::<String>()).unwrap();
    let mut session = session();
    settled(&mut session, Action::Open(path));
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    let at = |x: f64, y: f64| DVec2::new(x, y);
    place(
        &mut session,
        &[(0, at(0.0, 0.0)), (4, at(4.0, 0.0)), (24, at(4.0, 4.0)), (20, at(0.0, 4.0)), (12, at(3.5, 2.5))],
    );
    settle(&mut session);
    let verdict = &session.outcome().expect("solved").step.verdict;
    assert!(verdict.is_one_to_one() && !verdict.planar, "{}", verdict.summary());
    assert!(session.can_relax());
    settled(&mut session, Action::Relax);
    assert!(session.timeline().records().iter().any(|record| record.stage == Stage::Relax));
}

/// Corners of a face, with targets that flip it.
fn turned() -> [(u32, DVec2); 3] {
    [(30, DVec2::new(3.0, 3.0)), (31, DVec2::new(3.0, 4.0)), (40, DVec2::new(4.0, 3.0))]
}

#[test]
fn a_constraint_that_needs_new_vertices_is_known_before_it_is_solved_for() {
    let mut session = with_grid();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    place(&mut session, &turned());
    session.poll();
    assert_eq!(session.conflicts().len(), 1, "{:?}", session.conflicts());
    let conflict = session.conflict_of(id(31)).expect("a corner of the face");
    assert!(conflict.needs_new_vertices() && conflict.vertices() == [id(30), id(31), id(40)]);
    assert!(session.conflict_of(id(0)).is_none());
    settled(&mut session, Action::Unpin(vec![id(31)]));
    assert!(session.conflicts().is_empty());
}

#[test]
fn without_new_vertices_the_best_planar_step_stays_and_the_unmet_constraints_are_named() {
    let mut session = with_grid();
    let settings = Settings { new_vertices: false, ..Settings::default() };
    settled(&mut session, Action::SetSettings(settings));
    place(&mut session, &turned());
    settle(&mut session);
    let outcome = session.outcome().expect("solved");
    let unmet = outcome.step.unmet();
    assert!(outcome.step.verdict.planar && !outcome.step.unmet().is_empty() && !unmet.is_empty(), "{unmet:?}");
    assert_eq!(session.stopped(), Some(RunStop::Ended(Ending::Unmet)));
    assert!(!session.can_run() && !session.can_relax());
    let message = session.messages().last().expect("it is said");
    assert_eq!(message.vertices, unmet);
    assert_message("constraints-session-unmet", &words_of(message));
}

/// Polls until the targets have been checked.
fn until_mirrored(session: &mut Session) {
    let begun = Instant::now();
    while !session.targets_look_mirrored() {
        assert!(begun.elapsed() < Duration::from_secs(90), "nobody asks: {session:?}");
        std::thread::sleep(Duration::from_millis(1));
        session.poll();
    }
}

#[test]
fn mirrored_targets_are_asked_about_until_they_are_mirrored_back() {
    let mut session = with_grid();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    let mirrored = [(0, [8.0, 0.0]), (8, [0.0, 0.5]), (72, [7.5, 8.0]), (80, [0.0, 8.0])];
    place(&mut session, &mirrored.map(|(vertex, target)| (vertex, DVec2::from(target))));
    until_mirrored(&mut session);
    settled(&mut session, Action::MirrorTargets);
    assert!(!session.targets_look_mirrored());
    settled(&mut session, Action::Undo);
    assert!(session.targets_look_mirrored());
}

/// Grid of one square with its diagonal split in the middle.
fn split_square() -> (DiskMesh, Arc<Refinement>) {
    let disk = DiskMesh::try_from(grid(1, 1)).expect("a disk");
    let new = NewVertex { edge: [id(0), id(3)], at: 0.5 };
    let parts = disk.faces().map(|face| {
        let corners = disk.face(face);
        // The corner off the diagonal, with the halves of the diagonal.
        let place = corners.iter().position(|v| ![id(0), id(3)].contains(v)).expect("each face has one");
        let [apex, a, b] = [corners[place], corners[(place + 1) % 3], corners[(place + 2) % 3]];
        (face, vec![[apex, a, id(4)], [apex, id(4), b]])
    });
    let parts: BTreeMap<_, _> = parts.collect();
    let refinement = Refinement::new(&disk, vec![new], &parts).expect("still a disk");
    (disk, Arc::new(refinement))
}

#[test]
fn an_outcome_with_new_vertices_is_measured_and_proved_on_its_own_mesh() {
    let (disk, refinement) = split_square();
    let mut run = Flattener::new(Settings::new(Method::Natural, Family::Conformal), Pins::new());
    let mut step = run.step(&disk, Control::unattended()).expect("a square can be solved");
    let [a, b] = [0, 3].map(|v: usize| step.candidate.solution.embedding[v]);
    step.candidate.solution.embedding =
        step.candidate.solution.embedding.iter().copied().chain([a.midpoint(b)]).collect();
    step.candidate.refinement = Some(refinement);
    let outcome = Outcome::new(&disk, Problem { settings: run.settings().clone(), ..Problem::default() }, step);
    assert_eq!((outcome.new_vertex_count(), outcome.distortion.faces.len()), (1, 4));
    for fit in [Fit::Unit, Fit::True] {
        let (coordinates, _, verdict) = outcome.output(&disk, fit);
        assert!(coordinates.len() == 5 && verdict.planar, "{verdict:?}");
    }
}
