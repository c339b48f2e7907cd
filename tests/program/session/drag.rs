//! Dragging pins: the embedding under the pointer, its proof, pause and end.

use std::sync::Arc;

use freebound::examples::Example;
use freebound::session::{Action, Session};
use freebound_core::flatten::solve_once;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{BoundaryShape, Control, Embedding, Family, Method, NamedOption as _, PinKind, Settings};
use freebound_core::verify::verdict;
use glam::DVec2;

use super::basics::{opened, settle, settled};

/// Session for a drag on a mesh with three constraints and a soft pin.
fn with_constraints() -> Session {
    let mut session = opened(Example::Dome);
    for (number, place, kind) in [
        (0, DVec2::ZERO, PinKind::Hard),
        (60, DVec2::new(0.2, 0.9), PinKind::Soft(2.0)),
        (100, DVec2::X, PinKind::Hard),
        (200, DVec2::new(0.8, 0.9), PinKind::Hard),
    ] {
        settled(&mut session, Action::Place { vertex: VertexId::new(number), target: Target { uv: place, kind } });
    }
    session
}

/// Session whose method has the linear solve as its only step.
fn with_linear_method() -> Session {
    let mut session = with_constraints();
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::default())));
    session
}

/// Embedding of the document's first solve.
fn first_solve(session: &Session) -> Embedding {
    let document = session.document();
    let disk = session.model().expect("open").disk().expect("a disk");
    solve_once(disk, &document.problem().settings, &document.pins(), Control::unattended()).unwrap().embedding
}

#[test]
fn what_follows_the_pointer_is_the_first_solve_and_is_proved_in_its_own_time() {
    let mut session = with_linear_method();
    let disk = Arc::clone(session.model().expect("open").disk().expect("a disk"));
    for (i, number) in (0..).zip([100, 100, 60, 60, 0]) {
        let vertex = VertexId::new(number);
        let target = DVec2::new(0.1 * f64::from(i), 0.5);
        settled(&mut session, Action::MovePin { vertex, target });
        let preview = session.preview().expect("a drag shows one");
        let fresh = first_solve(&session);
        let apart = fresh.iter().zip(&*preview.embedding).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart < 1e-10, "{apart:.1e} apart");
        if number != 60 {
            assert_eq!(preview.embedding[vertex], target, "to the last bit");
        }
        assert_eq!(**preview.verdict().expect("proved by now"), verdict(&disk, &preview.embedding));
    }
    settled(&mut session, Action::EndGesture);
    assert!(session.preview().is_none() && session.is_current());
}

#[test]
fn pins_that_are_dragged_together_keep_their_distance_and_are_one_undo_step() {
    let mut session = with_linear_method();
    let before = session.document().clone();
    for i in 1..=10 {
        let by = DVec2::new(0.01, -0.02) * f64::from(i);
        let moves = [0, 100].map(VertexId::new).map(|v| (v, before.targets[&v].uv + by));
        settled(&mut session, Action::MovePins(moves.to_vec()));
        let apart = {
            let preview = session.preview().expect("a drag shows one");
            first_solve(&session).iter().zip(&*preview.embedding).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
        };
        assert!(apart < 1e-10, "{apart:.1e} apart");
    }
    settled(&mut session, Action::EndGesture);
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_pointer_that_rests_has_the_embedding_repaired_and_the_drag_goes_on() {
    let mut session = with_constraints();
    let vertex = VertexId::new(100);
    settled(&mut session, Action::MovePin { vertex, target: DVec2::new(0.9, 0.1) });
    settled(&mut session, Action::Rest);
    assert!(session.preview().is_none() && session.is_current(), "the run has taken its place");
    assert!(session.history().is_in_gesture());
    settled(&mut session, Action::MovePin { vertex, target: DVec2::new(0.8, 0.1) });
    assert!(session.preview().is_some());
    settled(&mut session, Action::EndGesture);
    assert!(session.is_current());
    settled(&mut session, Action::Undo);
    assert_eq!(session.document().targets[&vertex].uv, DVec2::X, "one undo step, rest and all");
}

#[test]
fn a_slower_column_catches_up_with_the_pointer() {
    let mut session = with_linear_method();
    let vertex = VertexId::new(200);
    // No poll between the moves: the column is still being solved for.
    for i in 0..20 {
        session.handle(Action::MovePin { vertex, target: DVec2::new(0.8 - 0.01 * f64::from(i), 0.9) });
    }
    settle(&mut session);
    let target = session.document().targets[&vertex].uv;
    assert_eq!(session.preview().expect("it caught up").embedding[vertex], target);
}

#[test]
fn a_drag_that_ends_where_it_began_shows_the_proved_embedding_again() {
    let mut session = opened(Example::Dome);
    let vertex = VertexId::new(100);
    let targets = [(0, DVec2::ZERO), (100, DVec2::X), (200, DVec2::new(0.5, 0.8))];
    for (number, target) in targets {
        settled(&mut session, Action::Place { vertex: VertexId::new(number), target: Target::hard(target) });
    }
    let before = session.outcome().expect("solved").clone();
    for target in [DVec2::new(0.9, 0.0), DVec2::X] {
        settled(&mut session, Action::MovePin { vertex, target });
        assert!(session.preview().is_some());
    }
    settled(&mut session, Action::EndGesture);
    assert!(session.preview().is_none() && session.is_current());
    assert!(Arc::ptr_eq(&before, session.outcome().expect("solved")), "nothing was solved anew");
}

#[test]
fn a_vertex_fixed_during_a_drag_is_fixed_where_the_screen_shows_it() {
    let mut session = with_constraints();
    settled(&mut session, Action::MovePin { vertex: VertexId::new(100), target: DVec2::new(0.9, 0.1) });
    let shown = session.preview().expect("a drag shows one").embedding[150];
    settled(&mut session, Action::Fix(vec![VertexId::new(150)]));
    assert_eq!(session.document().targets[&VertexId::new(150)], Target::fixed(shown));
}

#[test]
fn pins_that_were_freed_do_not_come_back_with_a_late_move() {
    let mut session = with_constraints();
    session.handle(Action::UnpinAll);
    session.handle(Action::MovePin { vertex: VertexId::new(100), target: DVec2::ONE });
    assert!(session.document().targets.is_empty());
}

#[test]
fn no_other_methods_map_follows_the_pointer() {
    let vertex = VertexId::new(100);
    for method in [Method::Lee(BoundaryShape::Circle), Method::Slim, Method::Spectral, Method::AbfPlusPlus] {
        let mut session = opened(Example::Dome);
        let settings = Settings { method: method.clone(), max_steps: Some(1), ..session.document().settings.clone() };
        settled(&mut session, Action::SetSettings(settings));
        for (vertex, uv) in [(vertex, DVec2::X), (VertexId::new(0), DVec2::ZERO)] {
            settled(&mut session, Action::Place { vertex, target: Target::hard(uv) });
        }
        let target = DVec2::new(0.7, 0.6);
        settled(&mut session, Action::MovePin { vertex, target });
        assert!(session.preview().is_none(), "{method:?}: its first step is not the natural boundary");
        settled(&mut session, Action::EndGesture);
        assert!(session.is_current(), "{method:?}");
        let step = &session.outcome().expect("solved").step;
        assert_eq!((step.candidate.stage.name(), step.candidate.solution.embedding[vertex]), (method.name(), target));
    }
}
