//! Requests of the user besides edits (rounds of relaxation, single steps) through edits, undo, pause and opening.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use freebound::examples::Example;
use freebound::session::{Action, RecentFiles, Session};
use freebound_core::problem::{Embedding, Family, Method, Settings, Stage};
use glam::DVec2;

use super::basics::{opened, session, settle, settled};
use super::constraints::{id, place, with_grid};
use freebound_testkit::{grid, write_obj};

/// Energy of the newest step, if it is a round of relaxation.
fn relaxed_energy(session: &Session) -> Option<f64> {
    let newest = session.timeline().newest().expect("solved");
    let is_relaxed = session.timeline().records()[newest].stage == Stage::Relax;
    session.timeline().standings()[newest].progress.filter(|_| is_relaxed).map(|progress| progress.energy)
}

/// Grid stretched by its corners: planar by its first solve, and distorted.
fn stretched() -> Session {
    let mut session = with_grid();
    let corners = [(0, [0.0, 0.0]), (8, [12.0, 1.0]), (72, [-1.0, 8.0]), (80, [9.0, 10.0])];
    place(&mut session, &corners.map(|(vertex, at)| (vertex, DVec2::from(at))));
    settle(&mut session);
    assert!(session.can_relax() && relaxed_energy(&session).is_none());
    session
}

#[test]
fn a_relaxing_that_was_asked_for_comes_back_when_a_later_move_is_undone() {
    let mut session = stretched();
    settled(&mut session, Action::Relax);
    let relaxed = relaxed_energy(&session).expect("relaxed");
    session.handle(Action::MovePin { vertex: id(80), target: DVec2::new(9.5, 11.0) });
    settled(&mut session, Action::EndGesture);
    let moved = relaxed_energy(&session).expect("what was asked for holds for what follows");
    settled(&mut session, Action::Undo);
    let again = relaxed_energy(&session).expect("relaxed as before the move");
    assert!(again.to_bits() == relaxed.to_bits() && (moved - relaxed).abs() > 1e-3 * relaxed, "{again} {relaxed}");
    settled(&mut session, Action::Undo);
    assert!(relaxed_energy(&session).is_none() && session.document().targets.len() == 4, "undone by itself");
    settled(&mut session, Action::Redo);
    settled(&mut session, Action::Redo);
    let again = relaxed_energy(&session).expect("repeated with the move");
    assert_eq!(again.to_bits(), moved.to_bits(), "shown again, not solved again");
}

#[test]
fn a_relaxing_ends_with_another_method_a_new_solve_and_a_pause() {
    let mut session = stretched();
    settled(&mut session, Action::Relax);
    settled(&mut session, Action::Solve);
    assert!(relaxed_energy(&session).is_none(), "solved again, as it is solved");
    settled(&mut session, Action::Relax);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    assert!(relaxed_energy(&session).is_none(), "another method shows its own result");
    settled(&mut session, Action::Undo);
    assert!(relaxed_energy(&session).is_some());
    settled(&mut session, Action::Solve);
    session.handle(Action::Relax);
    session.handle(Action::Cancel);
    settle(&mut session);
    assert!(!session.is_running(), "a relaxing that was stopped does not begin again by itself");
}

#[test]
fn a_relaxing_is_kept_in_the_project() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mesh, project) = (folder.path().join("grid.obj"), folder.path().join("work.freebound"));
    write_obj(&mesh, &grid(8, 8));
    let mut saved = session();
    settled(&mut saved, Action::Open(mesh));
    place(&mut saved, &[(0, DVec2::ZERO), (8, DVec2::new(12.0, 1.0)), (72, DVec2::new(-1.0, 8.0))]);
    settle(&mut saved);
    settled(&mut saved, Action::Relax);
    assert!(saved.has_unsaved_work());
    settled(&mut saved, Action::SaveProject(project.clone()));
    let mut opened = session();
    settled(&mut opened, Action::Open(project));
    assert!(relaxed_energy(&saved).is_some() && opened.document().relaxed == saved.document().relaxed);
    let map = |session: &Session| session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    assert_eq!(map(&opened), map(&saved), "the rounds are not taken again");
}

/// Number of the newest steps that are rounds of relaxation.
fn rounds(session: &Session) -> usize {
    session.timeline().records().iter().rev().take_while(|record| record.stage == Stage::Relax).count()
}

/// Grid flattened by a method that leaves much to relax, and a gate: while it is locked, the background waits after
/// each step.
fn drawn() -> (Session, Arc<Mutex<()>>) {
    let gate = Arc::new(Mutex::new(()));
    let of_background = Arc::clone(&gate);
    let mut session = Session::new(Arc::new(move || drop(of_background.lock().unwrap())), RecentFiles::default());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("grid.obj");
    write_obj(&path, &grid(8, 8));
    settled(&mut session, Action::Open(path));
    let settings = Settings { relax_rounds: Some(0), ..Settings::new(Method::Schnyder, Family::default()) };
    settled(&mut session, Action::SetSettings(settings));
    assert!(session.can_relax() && rounds(&session) == 0, "{:?}", session.messages());
    (session, gate)
}

/// Session whose relaxation is paused before the second round. If `wants_round`, the first round is complete.
fn paused(wants_round: bool) -> Session {
    let (mut session, gate) = drawn();
    let waits = gate.lock().unwrap();
    session.handle(Action::Relax);
    while wants_round && rounds(&session) == 0 {
        std::thread::sleep(Duration::from_micros(100));
        session.poll();
    }
    session.handle(Action::Cancel);
    drop(waits);
    settle(&mut session);
    assert!(rounds(&session) <= 1 && session.stopped().is_none(), "{:?}", session.messages());
    session
}

#[test]
fn a_paused_relaxing_comes_back_as_far_as_it_was_taken() {
    for wants_round in [false, true] {
        let mut session = paused(wants_round);
        let taken = rounds(&session);
        assert_eq!(session.document().relaxed, taken, "what a project would say");
        for _ in 0..2 {
            settled(&mut session, Action::Undo);
            settled(&mut session, Action::Redo);
            assert_eq!(rounds(&session), taken);
        }
        settled(&mut session, Action::Undo);
        let is_as_drawn = session.document().settings.method == Method::Schnyder;
        assert_eq!((session.document().relaxed, is_as_drawn), (0, taken > 0), "undone by itself, where it is one");
    }
}

#[test]
fn a_paused_relaxing_goes_on_when_the_run_is_asked_to() {
    let (mut whole, _) = drawn();
    settled(&mut whole, Action::Relax);
    let mut session = paused(true);
    settled(&mut session, Action::Step);
    assert_eq!((rounds(&session), session.document().relaxed), (2, 2));
    settled(&mut session, Action::Run);
    assert_eq!(session.document().relaxed, whole.document().relaxed);
    assert_eq!(at_rest(&session), at_rest(&whole));
    settled(&mut session, Action::Undo);
    assert_eq!((rounds(&session), session.document().relaxed), (2, 2), "each wish is a step of its own");
}

#[test]
fn weights_that_slide_end_a_relaxing_as_chosen_ones_do() {
    let mut session = stretched();
    settled(&mut session, Action::Relax);
    let rounds_before = rounds(&session);
    for power in [1.1, 1.2, 1.3] {
        let family = Family::Power(power);
        session.handle(Action::SlideSettings(Settings { family: Some(family), ..session.document().settings.clone() }));
        settle(&mut session);
    }
    settled(&mut session, Action::EndGesture);
    assert!(session.document().relaxed == 0 && relaxed_energy(&session).is_none());
    settled(&mut session, Action::Undo);
    assert_eq!(rounds(&session), rounds_before, "one step back, and relaxed again");
}

fn at_rest(session: &Session) -> (usize, Embedding) {
    let outcome = session.outcome().expect("solved");
    (outcome.step.index, outcome.step.candidate.solution.embedding.clone())
}

/// Takes single steps, and returns the last step's index and embedding.
fn taken_on(session: &mut Session, steps: usize) -> (usize, Embedding) {
    for _ in 0..steps {
        settled(session, Action::Step);
    }
    at_rest(session)
}

#[test]
fn steps_taken_by_hand_are_taken_again_when_a_later_edit_is_undone() {
    let mut session = opened(Example::BumpyCap);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Iterate, Family::Conformal)));
    let (by_itself, _) = at_rest(&session);
    let first = taken_on(&mut session, 3);
    assert_eq!(first.0, by_itself + 3);
    settled(&mut session, Action::Fix([0, 20, 40].map(id).to_vec()));
    let (pinned, _) = at_rest(&session);
    let second = taken_on(&mut session, 2);
    assert_eq!(second.0, pinned + 2);
    settled(&mut session, Action::Undo);
    assert_eq!(at_rest(&session), first);
    settled(&mut session, Action::Redo);
    assert_eq!(at_rest(&session), second);
    settled(&mut session, Action::Solve);
    assert_eq!(at_rest(&session).0, pinned, "solved again, as it is solved");
}

#[test]
fn steps_taken_by_hand_that_a_pause_cuts_short_are_not_taken_again() {
    let mut session = opened(Example::BumpyCap);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Iterate, Family::Conformal)));
    let (by_itself, _) = at_rest(&session);
    for _ in 0..1000 {
        session.handle(Action::Step);
    }
    settled(&mut session, Action::Cancel);
    let (taken, _) = at_rest(&session);
    assert!(taken < by_itself + 1000);
    settled(&mut session, Action::TurnFaces);
    settled(&mut session, Action::Undo);
    assert_eq!(at_rest(&session).0, taken);
}
