//! Run in a session: single steps and continuous steps, pause, stop conditions, edits during the run.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::examples::Example;
use freebound::session::{Action, RunStop, SaveRequest, Session, Severity, Status, StopConditions};
use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{Control, Embedding, Family, Method, Pin, Pins, Settings, hard_pins};
use freebound_io::OutputKind;
use glam::DVec2;

use super::basics::{opened, session, settle, settled};
use freebound_testkit::{grid, write_obj};

/// Stop conditions without proof and stall: a run continues to the limit of steps.
const ON_AND_ON: StopConditions = StopConditions { planar: false, stalled: false, crossing: false, at_step: None };

fn step_count(session: &Session) -> usize {
    session.timeline().records().len()
}

fn embedding(session: &Session) -> Embedding {
    session.outcome().expect("solved").step.candidate.solution.embedding.clone()
}

/// Steps of the document's method without interruption.
fn uninterrupted(session: &Session, count: usize) -> Vec<Step> {
    let disk = session.model().expect("open").disk().expect("a disk");
    let document = session.document();
    let mut run = Flattener::new(document.problem().settings, document.pins());
    (0..count).map(|_| run.step(disk, Control::unattended()).expect("solvable")).collect()
}

/// Polls until the run has at least `count` steps.
fn until_step(session: &mut Session, count: usize) {
    while step_count(session) < count {
        assert!(
            session.busy().is_some(),
            "the run ended after {} steps: {:?}",
            step_count(session),
            session.messages()
        );
        std::thread::sleep(Duration::from_micros(100));
        session.poll();
    }
}

/// Session with a run of many steps: iterations that no proof ends.
fn with_long_run(max_steps: usize) -> Session {
    let mut session = opened(Example::BumpyCap);
    settled(&mut session, Action::SetStop(ON_AND_ON));
    let settings = Settings { max_steps: Some(max_steps), ..Settings::new(Method::Iterate, Family::Conformal) };
    session.handle(Action::SetSettings(settings));
    session
}

#[test]
fn an_example_waits_after_its_first_step_and_then_ends_planar() {
    let mut session = opened(Example::Face);
    assert!(matches!(session.status(), Status::Held) && step_count(&session) == 1);
    assert!(!session.outcome().expect("solved").step.verdict.planar, "there is something to repair");
    settled(&mut session, Action::Run);
    assert!(!matches!(session.status(), Status::Held));
    assert!(session.outcome().expect("solved").step.verdict.planar);
    assert_eq!(session.stopped(), Some(RunStop::Ended(Ending::Planar)));
    let count = step_count(&session);
    settled(&mut session, Action::Run);
    assert_eq!(step_count(&session), count, "there is nothing left to run for");
}

#[test]
fn a_file_is_run_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("face.obj");
    write_obj(&path, &Example::Face.mesh());
    let mut session = session();
    settled(&mut session, Action::Open(path));
    assert!(session.outcome().expect("solved").step.verdict.planar);
    assert!(step_count(&session) > 1);
}

#[test]
fn single_steps_are_those_of_an_uninterrupted_run() {
    let mut session = opened(Example::Face);
    let whole = uninterrupted(&session, 5);
    for count in 2..=5 {
        settled(&mut session, Action::Step);
        assert_eq!(step_count(&session), count, "also beyond the ending");
    }
    for step in whole {
        let kept = session.timeline().outcome(step.index).expect("kept");
        assert_eq!(kept.step.candidate.solution.embedding, step.candidate.solution.embedding, "step {}", step.index);
        assert_eq!(kept.step.verdict, step.verdict);
    }
}

#[test]
fn steps_asked_for_in_a_row_are_all_taken() {
    let mut session = opened(Example::Face);
    for _ in 0..3 {
        session.handle(Action::Step);
    }
    settle(&mut session);
    assert_eq!(step_count(&session), 4);
}

#[test]
fn a_paused_run_goes_on_where_it_was() {
    let mut session = with_long_run(60);
    until_step(&mut session, 5);
    settled(&mut session, Action::Cancel);
    let paused_at = step_count(&session);
    assert!((5..61).contains(&paused_at), "{paused_at}");
    settled(&mut session, Action::Step);
    assert_eq!(step_count(&session), paused_at + 1);
    settled(&mut session, Action::Run);
    assert_eq!((step_count(&session), session.stopped()), (61, Some(RunStop::Ended(Ending::Limit))));
    let whole = uninterrupted(&session, 61);
    for step in whole {
        let kept = session.timeline().outcome(step.index).expect("a small mesh is kept whole");
        assert_eq!(kept.step.candidate.solution.embedding, step.candidate.solution.embedding, "step {}", step.index);
    }
}

#[test]
fn a_pause_takes_effect_within_a_step_of_a_large_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.obj");
    let mut hill = grid(140, 140);
    for position in &mut hill.positions {
        position.z = 20.0 * (position.x / 40.0).sin() * (position.y / 50.0).cos();
    }
    write_obj(&path, &hill);
    let mut session = session();
    settled(&mut session, Action::Open(path));
    settled(&mut session, Action::SetStop(ON_AND_ON));
    session.handle(Action::Run);
    until_step(&mut session, 2);
    let mut longest = Duration::ZERO;
    for moment in 0..8 {
        std::thread::sleep(Duration::from_millis(7 * moment));
        let start = Instant::now();
        settled(&mut session, Action::Cancel);
        longest = longest.max(start.elapsed());
        assert!(session.messages().is_empty() && session.is_current(), "{:?}", session.messages());
        let count = step_count(&session);
        session.handle(Action::Run);
        until_step(&mut session, count + 1);
    }
    println!("paused after {longest:?} at most");
    // Ten times the limit for an idle machine, since tests run in parallel.
    assert!(longest < Duration::from_secs(1), "{longest:?}");
}

#[test]
fn what_is_asked_for_while_a_run_pauses_follows() {
    let mut session = with_long_run(60);
    until_step(&mut session, 2);
    session.handle(Action::Cancel);
    session.handle(Action::Run);
    settle(&mut session);
    assert_eq!(step_count(&session), 61);
}

#[test]
fn a_step_brings_a_run_to_rest() {
    let mut session = with_long_run(2000);
    until_step(&mut session, 3);
    session.handle(Action::Step);
    settle(&mut session);
    assert!(step_count(&session) < 2001, "it did not go on to the limit");
    let count = step_count(&session);
    settled(&mut session, Action::Step);
    assert_eq!(step_count(&session), count + 1);
}

#[test]
fn an_edit_during_a_run_replaces_it() {
    let mut session = with_long_run(2000);
    until_step(&mut session, 3);
    let settings = Settings::new(Method::Natural, Family::MeanValue);
    settled(&mut session, Action::SetSettings(settings.clone()));
    assert_eq!((step_count(&session), session.stopped()), (1, Some(RunStop::Ended(Ending::Done))));
    assert!(session.is_current());
    assert_eq!(session.outcome().expect("solved").problem.settings, settings);
}

#[test]
fn a_run_stops_at_the_step_that_was_asked_for_and_goes_on_from_there() {
    let mut session = opened(Example::BumpyCap);
    settled(&mut session, Action::SetStop(StopConditions { at_step: Some(3), ..ON_AND_ON }));
    settled(&mut session, Action::Run);
    assert_eq!((step_count(&session), session.stopped()), (4, Some(RunStop::AtStep)));
    settled(&mut session, Action::SetStop(StopConditions { at_step: Some(6), ..ON_AND_ON }));
    assert_eq!(step_count(&session), 4, "a condition alone moves nothing");
    settled(&mut session, Action::Run);
    assert_eq!(step_count(&session), 7);
}

#[test]
fn a_run_stops_where_the_boundary_crosses_itself() {
    let mut session = opened(Example::Face);
    // Two pins far apart in the middle of the face fold the boundary over.
    let pins = crossing_pins(&session);
    let crossing = StopConditions { crossing: true, ..ON_AND_ON };
    settled(&mut session, Action::SetStop(crossing));
    for (vertex, Pin { target, .. }) in pins {
        session.handle(Action::Place { vertex, target: Target::hard(target) });
    }
    // Starting from a planar map, no step would cross.
    settled(&mut session, Action::Solve);
    assert_eq!(session.stopped(), Some(RunStop::Crossing));
    let count = step_count(&session);
    settled(&mut session, Action::Run);
    assert!(step_count(&session) > count, "asked again, it goes on");
}

/// Three neighbours on the boundary, the middle one pulled across to the other side.
fn crossing_pins(session: &Session) -> Pins {
    let disk = session.model().expect("open").disk().expect("a disk");
    let boundary = disk.boundary_loop();
    let embedding = embedding(session);
    let opposite = embedding[boundary[boundary.len() / 2].index()];
    let at = |v: VertexId| embedding[v];
    let centre = embedding.iter().sum::<DVec2>() / embedding.len() as f64;
    let through = opposite + (opposite - centre);
    hard_pins([
        (boundary[0], through),
        (boundary[8], at(boundary[8])),
        (boundary[boundary.len() - 8], at(boundary[boundary.len() - 8])),
    ])
}

#[test]
fn a_condition_changed_during_a_run_is_heeded() {
    let mut session = with_long_run(2000);
    until_step(&mut session, 2);
    session.handle(Action::SetStop(StopConditions {
        at_step: Some(1999),
        planar: true,
        stalled: true,
        crossing: true,
    }));
    settle(&mut session);
    assert!(step_count(&session) < 1999, "{}", step_count(&session));
}

#[test]
fn the_view_follows_a_run_until_someone_looks_back() {
    let mut session = with_long_run(60);
    until_step(&mut session, 4);
    assert_eq!(session.timeline().shown(), session.timeline().newest());
    session.handle(Action::ShowStep(1));
    let revision = session.outcome_revision();
    settle(&mut session);
    assert_eq!((session.timeline().shown(), step_count(&session)), (Some(1), 61));
    assert_eq!(session.outcome_revision(), revision, "nothing is drawn anew");
    assert_eq!(session.outcome().expect("solved").step.index, 1);
    settled(&mut session, Action::Step);
    assert_eq!(session.timeline().shown(), Some(61), "whoever takes a step wants to see it");
}

#[test]
fn the_newest_step_is_followed_again_once_it_is_shown() {
    let mut session = with_long_run(60);
    until_step(&mut session, 4);
    session.handle(Action::ShowStep(1));
    session.handle(Action::ShowStep(usize::MAX));
    settle(&mut session);
    assert_eq!(session.timeline().shown(), Some(60));
}

#[test]
fn two_steps_are_compared_until_another_run_begins() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Run);
    settled(&mut session, Action::Compare(Some(0)));
    assert_eq!(session.compared().expect("kept").step.index, 0);
    assert!(Arc::ptr_eq(session.compared().expect("kept"), session.timeline().outcome(0).expect("kept")));
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::MeanValue)));
    assert!(session.compared().is_none());
    settled(&mut session, Action::Compare(Some(0)));
    settled(&mut session, Action::Compare(None));
    assert!(session.compared().is_none());
}

#[test]
fn a_drag_shows_first_steps_only_and_its_end_the_whole_run() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Run);
    let (&vertex, &Pin { target: from, .. }) =
        session.outcome().expect("solved").step.candidate.solution.pins.iter().next().expect("a landmark");
    assert!(!matches!(session.status(), Status::Preview(_)));
    for i in 1..=5 {
        let target = from + DVec2::new(1e-4, 2e-4) * f64::from(i);
        settled(&mut session, Action::MovePin { vertex, target });
        assert!(matches!(session.status(), Status::Preview(_)) && !session.is_current(), "steps follow at the end");
        assert!(session.preview().is_some_and(|preview| preview.live.is_some()), "planar, and it stays so");
    }
    settled(&mut session, Action::EndGesture);
    assert!(!matches!(session.status(), Status::Preview(_)) && session.outcome().expect("solved").step.verdict.planar);
    assert!(step_count(&session) > 1);
}

#[test]
fn a_drag_that_is_given_up_ends_with_the_whole_run_too() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Run);
    let before = embedding(&session);
    let (&vertex, &Pin { target: from, .. }) =
        session.outcome().expect("solved").step.candidate.solution.pins.iter().next().expect("a gauge pin");
    settled(&mut session, Action::MovePin { vertex, target: from * 1.1 });
    settled(&mut session, Action::GiveUpGesture);
    assert_eq!(embedding(&session), before);
}

#[test]
fn an_example_stays_held_when_a_gesture_without_edits_ends() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::EndGesture);
    assert!(matches!(session.status(), Status::Held));
}

#[test]
fn steps_are_no_edits() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Step);
    settled(&mut session, Action::Run);
    settled(&mut session, Action::ShowStep(0));
    assert!(!session.history().can_undo() && !session.history().can_redo());
    assert!(session.is_current());
}

#[test]
fn the_step_on_the_screen_is_saved_with_the_numbers_up_to_it() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Run);
    settled(&mut session, Action::Step);
    assert!(step_count(&session) > 2, "{}", step_count(&session));
    settled(&mut session, Action::ShowStep(1));
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, kind| Action::Save(SaveRequest { path: folder.path().join(name), kind, fit: Fit::True });
    settled(&mut session, save("a.json", OutputKind::Json));
    settled(&mut session, save("a.obj", OutputKind::Obj));
    let report: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("a.json")).unwrap()).unwrap();
    assert_eq!(report["steps"].as_array().expect("steps").len(), 2);
    assert_eq!(written_coordinates(&folder.path().join("a.obj")), embedding(&session));
}

/// Texture coordinates of an OBJ file, in order.
fn written_coordinates(path: &Path) -> Embedding {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| -> Vec<f64> { line.split(' ').map(|number| number.parse().unwrap()).collect() };
    let lines = text.lines().filter_map(|line| line.strip_prefix("vt "));
    lines.map(|line| DVec2::from_slice(&numbers(line))).collect()
}

#[test]
fn a_method_that_fails_says_so_and_the_steps_on_the_screen_stay() {
    let mut session = opened(Example::Face);
    settled(&mut session, Action::Run);
    let count = step_count(&session);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Uniform)));
    assert!(session.messages().iter().any(|message| message.severity == Severity::Error));
    assert_eq!(step_count(&session), count);
    assert!(!session.is_current());
    settled(&mut session, Action::Undo);
    assert!(session.messages().is_empty() && session.is_current());
}

#[test]
fn a_step_after_a_cancelled_first_step_begins_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.obj");
    write_obj(&path, &grid(120, 120));
    let mut session = session();
    session.handle(Action::Open(path));
    while session.model().is_none() {
        session.poll();
    }
    settled(&mut session, Action::Cancel);
    settled(&mut session, Action::Step);
    assert_eq!(step_count(&session), 1);
    assert!(session.is_current());
}
