//! Timeline alone: steps kept whole within a budget, and the shown step.

use std::sync::Arc;

use freebound::session::Timeline;
use freebound_core::flatten::Flattener;
use freebound_core::mesh::{DiskMesh, FaceId};
use freebound_core::pipeline::{Outcome, Problem};
use freebound_core::problem::{Control, Family, Method, Pins, Settings};

use freebound_testkit::grid;

/// First step of a small run.
fn first() -> Outcome {
    let disk = DiskMesh::try_from(grid(4, 4)).expect("a disk");
    let mut run = Flattener::new(Settings::new(Method::Natural, Family::Conformal), Pins::new());
    let step = run.step(&disk, Control::unattended()).expect("solvable");
    Outcome::new(&disk, Problem { settings: run.settings().clone(), ..Problem::default() }, step)
}

/// Copy of an outcome with another step index and number of flipped faces.
fn like(first: &Outcome, index: usize, flipped: usize) -> Arc<Outcome> {
    let mut outcome = first.clone();
    outcome.step.index = index;
    outcome.step.verdict.planar = flipped == 0;
    outcome.step.verdict.flipped_faces = vec![FaceId::new(0); flipped];
    Arc::new(outcome)
}

/// Timeline with a budget of `room` steps, filled with steps that have these numbers of flipped faces.
fn with_room_for(room: usize, flipped: impl IntoIterator<Item = usize>) -> Timeline {
    let first = first();
    // No step made by the tests is larger by more than a few words.
    let mut timeline = Timeline::with_budget(room * (first.bytes() + 64));
    for (index, flipped) in flipped.into_iter().enumerate() {
        timeline.push(like(&first, index, flipped));
    }
    timeline
}

fn kept(timeline: &Timeline) -> Vec<usize> {
    timeline.kept().map(|(index, _)| index).collect()
}

#[test]
fn the_bytes_of_a_step_are_at_least_those_of_its_lists() {
    let outcome = first();
    let lists = outcome.step.candidate.solution.embedding.len() * 16 + outcome.distortion.faces.len() * 32;
    assert!(outcome.bytes() >= lists);
    assert!(like(&outcome, 0, 1000).bytes() >= outcome.bytes() + 4000, "a list of defects counts");
}

#[test]
fn the_numbers_of_every_step_stay_and_whole_steps_within_the_budget() {
    let timeline = with_room_for(10, vec![5; 500]);
    assert_eq!(timeline.records().len(), 500);
    assert!(timeline.records().iter().enumerate().all(|(i, record)| record.index == i));
    assert!((6..=10).contains(&kept(&timeline).len()), "{:?}", kept(&timeline));
    assert!(timeline.bytes() <= 10 * (first().bytes() + 64));
}

#[test]
fn a_budget_that_shrinks_lets_steps_go_at_once_and_stays_for_the_next_run() {
    let mut timeline = with_room_for(40, vec![5; 30]);
    assert_eq!(kept(&timeline).len(), 30);
    timeline.set_budget(10 * (first().bytes() + 64));
    assert!((6..=10).contains(&kept(&timeline).len()), "{:?}", kept(&timeline));
    assert_eq!(timeline.records().len(), 30);
    let mut next = timeline.begun_anew();
    assert_eq!(next.records().len(), 0);
    for index in 0..30 {
        next.push(like(&first(), index, 5));
    }
    assert!((6..=10).contains(&kept(&next).len()), "{:?}", kept(&next));
}

#[test]
fn what_is_kept_is_even() {
    for count in [30, 64, 100, 333, 1000] {
        let timeline = with_room_for(12, vec![5; count]);
        let kept = kept(&timeline);
        assert_eq!((kept[0], *kept.last().expect("some")), (0, count - 1));
        let widest = kept.windows(2).map(|pair| pair[1] - pair[0]).max().expect("several");
        assert!(widest * (kept.len() - 1) <= 3 * count, "of {count} steps {kept:?} are left");
    }
}

#[test]
fn first_last_best_and_proved_steps_outlive_others() {
    let mut flipped = vec![9; 200];
    flipped[70] = 2;
    for planar in [121, 123, 150] {
        flipped[planar] = 0;
    }
    let timeline = with_room_for(8, flipped);
    assert_eq!(timeline.best(), Some(121));
    let kept = kept(&timeline);
    for needed in [0, 121, 123, 150, 199] {
        assert!(kept.contains(&needed), "{needed} is not among {kept:?}");
    }
    assert!(kept.len() <= 8);
}

#[test]
fn the_best_step_stays_while_it_is_the_best() {
    let mut flipped = vec![9; 200];
    flipped[70] = 2;
    assert!(kept(&with_room_for(6, flipped)).contains(&70));
}

#[test]
fn proved_steps_are_thinned_too_where_nothing_else_is_left() {
    let timeline = with_room_for(8, vec![0; 300]);
    assert!(kept(&timeline).len() <= 8);
    assert_eq!(timeline.best(), Some(0), "the first of equals");
}

#[test]
fn first_and_last_stay_even_where_the_budget_is_too_small() {
    let timeline = with_room_for(0, vec![5, 4, 3, 3]);
    assert_eq!(kept(&timeline), [0, 2, 3]);
}

#[test]
fn what_the_screen_shows_is_kept() {
    let first = first();
    let mut timeline = with_room_for(8, vec![5; 8]);
    assert!(timeline.show(4));
    timeline.compare(Some(3));
    for index in 8..200 {
        assert!(!timeline.push(like(&first, index, 5)), "the view stays where it is");
    }
    assert_eq!((timeline.shown(), timeline.compared()), (Some(4), Some(3)));
    assert!(timeline.outcome(4).is_some() && timeline.outcome(3).is_some());
}

#[test]
fn a_step_that_is_not_kept_shows_the_one_before_it() {
    let mut timeline = with_room_for(6, vec![5; 100]);
    let kept = kept(&timeline);
    let gap = kept.windows(2).find(|pair| pair[1] > pair[0] + 1).expect("a gap");
    assert!(timeline.show(gap[0] + 1));
    assert_eq!(timeline.shown(), Some(gap[0]));
    assert!(!timeline.show(gap[0]), "it is there already");
    assert_eq!((timeline.previous_kept(gap[1]), timeline.next_kept(gap[0])), (Some(gap[0]), Some(gap[1])));
    assert_eq!((timeline.previous_kept(0), timeline.next_kept(99)), (None, None));
}

#[test]
fn an_empty_timeline_shows_nothing() {
    let mut timeline = Timeline::default();
    assert!(!timeline.show(3));
    timeline.compare(Some(0));
    assert_eq!((timeline.shown(), timeline.compared(), timeline.newest()), (None, None, None));
}
