//! Drag on a planar embedding: every frame is planar, and nothing jumps at the start or at the end.

use std::sync::Arc;

use freebound::examples::Example;
use freebound::session::{Action, Session, Status};
use freebound_core::bijective::Blocker;
use freebound_core::flatten::{Ending, largest_move};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::problem::{Embedding, Family, Method, PinKind, Settings, Stage};
use freebound_core::verify::verdict;
use glam::DVec2;

use super::basics::{opened, settle, settled};

/// Dome whose planar map meets its constraints: four at the boundary, and two inside.
fn planar() -> (Session, Arc<DiskMesh>, [VertexId; 2]) {
    let mut session = opened(Example::Dome);
    let disk = Arc::clone(session.model().expect("open").disk().expect("a disk"));
    let flat = embedding(&session);
    let nearest = |z: DVec2| {
        let by_distance = |a: &VertexId, b: &VertexId| flat[a].distance(z).total_cmp(&flat[b].distance(z));
        disk.vertices().min_by(by_distance).expect("vertices")
    };
    let (middle, extent) = (flat.bounds().middle(), flat.bounds().extent());
    let inside = [DVec2::new(0.15, 0.0), DVec2::new(-0.15, 0.0)].map(|share| nearest(middle + extent * share));
    let boundary = disk.boundary_loop();
    let pinned = (0..4).map(|k| boundary[k * boundary.len() / 4]).chain(inside);
    for vertex in pinned {
        settled(&mut session, Action::Place { vertex, target: Target::hard(flat[vertex]) });
    }
    assert!(session.outcome().expect("solved").step.verdict.planar);
    (session, disk, inside)
}

fn embedding(session: &Session) -> Embedding {
    session.outcome().expect("solved").step.candidate.solution.embedding.clone()
}

#[test]
fn every_frame_of_a_drag_on_a_planar_sheet_is_planar_and_on_the_pointer() {
    let (mut session, disk, [vertex, _]) = planar();
    let from = session.document().targets[&vertex].uv;
    let size = embedding(&session).bounds().extent();
    let mut shown = embedding(&session);
    for k in 1..=12 {
        let target = from + 0.005 * size * f64::from(k) * DVec2::new(0.3, 1.0);
        session.handle(Action::MovePin { vertex, target });
        let revision = session.preview().map(|preview| preview.revision);
        while session.is_following() {
            session.poll();
            if let Some(preview) = session.preview().filter(|preview| Some(preview.revision) != revision) {
                let proved = preview.verdict().expect("there with the frame");
                assert!(proved.planar && **proved == verdict(&disk, &preview.embedding));
                let jump = largest_move(&shown, &preview.embedding);
                assert!(jump < 0.02 * size, "frame {k} jumps by {jump}");
                shown = Embedding::clone(&preview.embedding);
            }
            std::thread::sleep(std::time::Duration::from_micros(200));
        }
        let preview = session.preview().expect("it follows");
        assert_eq!((preview.embedding[vertex], preview.live.expect("live").obstacle), (target, None));
    }
}

#[test]
fn at_the_end_of_a_drag_the_run_goes_on_from_where_it_ended() {
    let (mut session, _, [vertex, _]) = planar();
    let from = session.document().targets[&vertex].uv;
    let size = embedding(&session).bounds().extent();
    let target = from + 0.08 * size * DVec2::Y;
    settled(&mut session, Action::MovePin { vertex, target });
    let preview = Embedding::clone(&session.preview().expect("it follows").embedding);
    settled(&mut session, Action::EndGesture);
    assert!(session.preview().is_none() && session.is_current());
    let timeline = session.timeline();
    let mut before = preview;
    for record in 0..timeline.records().len() {
        let step = &timeline.outcome(record).expect("kept").step;
        assert!(step.verdict.planar && step.unmet().is_empty() && !step.is_of_planar_start(), "step {record}");
        let jump = largest_move(&before, &step.candidate.solution.embedding);
        assert!(jump < 0.03 * size, "step {record} jumps by {jump}, the sheet is {size} wide");
        before = step.candidate.solution.embedding.clone();
    }
    assert_eq!(timeline.outcome(0).expect("kept").step.candidate.stage, Stage::Continuation);
    assert_eq!(session.stopped(), Some(freebound::session::RunStop::Ended(Ending::Planar)));
}

#[test]
fn a_pin_let_go_before_its_first_frame_goes_on_from_the_step_on_the_screen() {
    let (mut session, _, [vertex, _]) = planar();
    let size = embedding(&session).bounds().extent();
    let target = session.document().targets[&vertex].uv + 0.02 * size * DVec2::X;
    session.handle(Action::MovePin { vertex, target });
    settled(&mut session, Action::EndGesture);
    let first = &session.timeline().outcome(0).expect("kept").step;
    assert_eq!(
        (first.candidate.stage.clone(), first.candidate.solution.embedding[vertex]),
        (Stage::Continuation, target)
    );
}

#[test]
fn a_pointer_that_rests_has_the_whole_settle_and_the_drag_goes_on_from_there() {
    let (mut session, _, [vertex, _]) = planar();
    let from = session.document().targets[&vertex].uv;
    let size = embedding(&session).bounds().extent();
    settled(&mut session, Action::MovePin { vertex, target: from + 0.05 * size * DVec2::Y });
    settled(&mut session, Action::Rest);
    assert!(session.preview().is_none() && session.is_current());
    let settled_there = embedding(&session);
    settled(&mut session, Action::MovePin { vertex, target: from + 0.051 * size * DVec2::Y });
    let jump = largest_move(&settled_there, &session.preview().expect("it follows").embedding);
    assert!(jump < 0.01 * size, "{jump}");
    settled(&mut session, Action::EndGesture);
    assert!(session.is_current());
}

#[test]
fn a_pin_dragged_over_another_says_which_is_in_its_way() {
    let (mut session, disk, [vertex, other]) = planar();
    let [from, over] = [vertex, other].map(|v| session.document().targets[&v].uv);
    settled(&mut session, Action::MovePin { vertex, target: over + 0.2 * (over - from) });
    let preview = session.preview().expect("it follows as far as it can");
    assert_eq!(preview.live.expect("live").obstacle, Some(Blocker::Pin(other)));
    assert!(verdict(&disk, &preview.embedding).planar);
    settled(&mut session, Action::EndGesture);
    let step = &session.outcome().expect("solved").step;
    assert!(step.verdict.planar && step.unmet().is_empty(), "the ladder finds a way around");
}

#[test]
fn what_is_not_planar_follows_from_where_it_is() {
    let (mut session, _, [vertex, other]) = planar();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Iterate, Family::default())));
    // Past one another they fold the first step, with which the method begins.
    let over = session.document().targets[&other].uv;
    let from = session.document().targets[&vertex].uv;
    settled(
        &mut session,
        Action::Place { vertex, target: Target { uv: over + 0.5 * (over - from), kind: PinKind::Hard } },
    );
    let (before, from) = (embedding(&session), session.document().targets[&vertex].uv);
    let size = before.bounds().extent();
    for way in [1e-3, 1e-6] {
        let target = from + way * size * DVec2::X;
        session.handle(Action::MovePin { vertex, target });
        settle(&mut session);
        let preview = session.preview().expect("it follows");
        assert!(preview.live.is_none());
        assert_eq!(preview.embedding[vertex], target);
        // Other vertices may move farther than the pin, since it lies between other pins.
        let jump = largest_move(&before, &preview.embedding);
        assert!(jump < 50.0 * way * size, "{jump} for {way}");
    }
}

#[test]
fn a_pin_dragged_along_the_boundary_onto_the_next_names_that() {
    let mut session = opened(Example::Dome);
    settled(&mut session, Action::Fix([0, 10, 20].map(VertexId::new).to_vec()));
    let target = session.document().targets[&VertexId::new(20)].uv;
    settled(&mut session, Action::MovePin { vertex: VertexId::new(10), target });
    let live = session.preview().expect("it follows as far as it can").live.expect("live");
    assert_eq!(live.obstacle, Some(Blocker::Pin(VertexId::new(20))));
}

#[test]
fn a_drag_that_is_given_up_leaves_the_step_that_was_there() {
    let (mut session, _, [vertex, _]) = planar();
    let before = Arc::clone(session.outcome().expect("solved"));
    let target = session.document().targets[&vertex].uv + 0.05 * embedding(&session).bounds().extent() * DVec2::Y;
    settled(&mut session, Action::MovePin { vertex, target });
    assert!(session.preview().is_some());
    settled(&mut session, Action::GiveUpGesture);
    assert!(session.preview().is_none() && session.is_current());
    assert!(Arc::ptr_eq(session.outcome().expect("kept"), &before), "nothing is solved again");
}

#[test]
fn what_a_drag_left_without_a_run_is_not_called_proved() {
    let (mut session, _, [vertex, _]) = planar();
    let target = session.document().targets[&vertex].uv + 0.05 * embedding(&session).bounds().extent() * DVec2::Y;
    settled(&mut session, Action::MovePin { vertex, target });
    session.handle(Action::EndGesture);
    settled(&mut session, Action::Cancel);
    if !session.is_current() {
        assert!(matches!(session.status(), Status::Stale), "{:?}", session.status());
    }
}
