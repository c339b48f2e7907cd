//! Edits on a planar map: solves continue from it, undo and redo show earlier results again, and a solve from
//! scratch ignores it.

use std::sync::Arc;

use freebound::examples::Example;
use freebound::session::{Action, RunStop, Session};
use freebound_core::flatten::{Ending, largest_move};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::problem::{Embedding, Family, Method, PinKind, Settings, Stage};
use glam::DVec2;

use super::basics::{opened, session, settle, settled};
use freebound_testkit::{assert_message, grid, write_obj};

/// Dome with five hard constraints: four at the boundary, pulled apart, and one inside. Also a vertex for a sixth.
struct Dome {
    session: Session,
    sixth: VertexId,
    inside: VertexId,
}

impl Dome {
    fn new() -> Self {
        let mut session = opened(Example::Dome);
        let disk = Arc::clone(session.model().expect("open").disk().expect("a disk"));
        let (pins, [inside, sixth]) = five_pins(&disk, &embedding(&session));
        for (vertex, target) in pins {
            settled(&mut session, Action::Place { vertex, target });
        }
        let step = &session.outcome().expect("solved").step;
        assert!(step.verdict.planar && step.unmet().is_empty());
        Self { session, sixth, inside }
    }

    fn width(&self) -> f64 {
        embedding(&self.session).bounds().extent()
    }

    /// Pins the sixth vertex a little off its position.
    fn place_sixth(&mut self) {
        let uv = embedding(&self.session)[self.sixth] + 0.05 * self.width() * DVec2::Y;
        settled(&mut self.session, Action::Place { vertex: self.sixth, target: Target::hard(uv) });
    }
}

/// Targets of five vertices; the inner one, and a vertex beside it.
fn five_pins(disk: &DiskMesh, flat: &Embedding) -> (Vec<(VertexId, Target)>, [VertexId; 2]) {
    let (middle, extent) = (flat.bounds().middle(), flat.bounds().extent());
    let nearest = |z: DVec2| {
        let by_distance = |a: &VertexId, b: &VertexId| flat[a].distance(z).total_cmp(&flat[b].distance(z));
        disk.vertices().min_by(by_distance).expect("vertices")
    };
    let inside = [DVec2::new(0.15, 0.0), DVec2::new(-0.15, 0.05)].map(|share| nearest(middle + extent * share));
    let boundary = disk.boundary_loop();
    let stretched = |vertex: VertexId| (vertex, Target::hard(middle + (flat[vertex] - middle) * DVec2::new(1.3, 0.9)));
    let corners = (0..4).map(|k| stretched(boundary[k * boundary.len() / 4]));
    (corners.chain([(inside[0], Target::hard(flat[inside[0]]))]).collect(), inside)
}

fn embedding(session: &Session) -> Embedding {
    session.outcome().expect("solved").step.candidate.solution.embedding.clone()
}

fn stages(session: &Session) -> Vec<Stage> {
    session.timeline().records().iter().map(|record| record.stage.clone()).collect()
}

/// True if the shown map is planar and meets all constraints.
fn is_solved(session: &Session) -> bool {
    let step = &session.outcome().expect("solved").step;
    session.is_current() && step.verdict.planar && step.unmet().is_empty()
}

#[test]
fn placing_a_sixth_landmark_keeps_the_others_where_they_are_and_takes_few_steps() {
    let mut dome = Dome::new();
    let before = embedding(&dome.session);
    dome.place_sixth();
    let (session, width) = (&dome.session, dome.width());
    assert!(is_solved(session) && session.is_continued());
    let steps = stages(session);
    assert!(steps[0] == Stage::Continuation && steps.len() <= 6, "{steps:?}");
    for index in 0..steps.len() {
        let step = &session.timeline().outcome(index).expect("kept").step;
        assert!(step.verdict.planar && step.is_continued, "step {index}");
        for (vertex, target) in session.document().targets.iter().filter(|(v, _)| **v != dome.sixth) {
            assert_eq!(step.candidate.solution.embedding[vertex], target.uv, "step {index}");
        }
    }
    let moved = largest_move(&before, &embedding(session));
    assert!(moved < 0.12 * width, "a pin that goes by 0.05 moves the map by {} of its width", moved / width);
    let note = session.timeline().records()[0].note.as_deref().expect("it is said");
    assert_message("edits-continued", note.split("; ").next().unwrap_or_default());
}

#[test]
fn vertices_that_are_fixed_where_they_lie_leave_the_map_as_it_is_to_the_last_bit() {
    let mut dome = Dome::new();
    let before = embedding(&dome.session);
    settled(&mut dome.session, Action::Fix(vec![dome.sixth]));
    assert!(is_solved(&dome.session) && dome.session.document().targets.len() == 6);
    assert!(embedding(&dome.session) == before && stages(&dome.session) == [Stage::Continuation]);
    assert_eq!(dome.session.stopped(), Some(RunStop::Ended(Ending::Planar)));
}

#[test]
fn freeing_and_weighting_a_constraint_go_on_too() {
    let mut dome = Dome::new();
    dome.place_sixth();
    let (sixth, inside) = (dome.sixth, dome.inside);
    let session = &mut dome.session;
    let kind = PinKind::Soft(2.0);
    for edit in [Action::SetPinKind { vertices: vec![inside], kind }, Action::Unpin(vec![sixth])] {
        settled(session, edit.clone());
        assert!(is_solved(session) && session.is_continued(), "{edit:?}");
        assert!(
            stages(session)[0] == Stage::Continuation && stages(session).len() < 40,
            "{edit:?} {:?}",
            stages(session)
        );
    }
    // Two hard pins only fix position, size and rotation of a map.
    let pinned: Vec<VertexId> = session.document().targets.keys().copied().filter(|v| *v != inside).collect();
    settled(session, Action::SetPinKind { vertices: vec![inside], kind: PinKind::Hard });
    settled(session, Action::Unpin(pinned[..3].to_vec()));
    assert!(is_solved(session) && !session.is_continued() && stages(session)[0] == Stage::Natural);
}

#[test]
fn a_choice_of_method_or_weights_and_targets_that_all_move_are_solved_afresh() {
    let mut dome = Dome::new();
    dome.place_sixth();
    let session = &mut dome.session;
    let conformal = Settings::new(Method::Auto, Family::Conformal);
    let choices = [
        Action::SetSettings(Settings::new(Method::Auto, Family::MeanValue)),
        Action::SetSettings(Settings { relax_rounds: Some(0), ..conformal }),
        Action::MirrorTargets,
    ];
    for choice in choices {
        settled(session, choice.clone());
        assert!(session.is_current() && !session.is_continued(), "{choice:?}");
        assert_eq!(stages(session)[0], Stage::Natural, "{choice:?}");
        settled(session, Action::Undo);
        assert!(session.is_continued(), "shown again as it was");
    }
    let before = embedding(session);
    settled(session, Action::SetSettings(Settings { new_vertices: false, ..session.document().settings.clone() }));
    assert!(session.is_continued(), "whether edges may be split says nothing about a map without such");
    assert!(largest_move(&before, &embedding(session)) < 0.02 * before.bounds().extent());
}

#[test]
fn undo_and_redo_bring_back_the_same_bytes_and_solve_nothing() {
    let mut dome = Dome::new();
    let mut states = vec![embedding(&dome.session)];
    dome.place_sixth();
    states.push(embedding(&dome.session));
    let (vertex, width) = (dome.inside, dome.width());
    let session = &mut dome.session;
    // A drag in two moves.
    let from = session.document().targets[&vertex].uv;
    for share in [0.02, 0.04] {
        settled(session, Action::MovePin { vertex, target: from + share * width * DVec2::X });
    }
    settled(session, Action::EndGesture);
    states.push(embedding(session));
    settled(session, Action::Relax);
    states.push(embedding(session));
    settled(session, Action::UnpinAll);
    states.push(embedding(session));
    let shows_at_once = |session: &mut Session, action: Action, state: &Embedding| {
        let what = format!("{action:?}");
        session.handle(action);
        assert!(!session.is_running() && session.is_current(), "nothing is solved: {what}");
        assert!(embedding(session) == *state, "to the last bit: {what}");
    };
    for _ in 0..2 {
        for state in states[..4].iter().rev() {
            shows_at_once(session, Action::Undo, state);
        }
        for state in &states[1..] {
            shows_at_once(session, Action::Redo, state);
        }
    }
    // The run that is shown again can be continued.
    settled(session, Action::Undo);
    let count = stages(session).len();
    settled(session, Action::Step);
    assert!(stages(session).len() == count + 1 && session.is_current());
    assert_eq!(stages(session).last(), Some(&Stage::Relax), "after a continuation a step is a round of relaxing");
}

#[test]
fn a_drag_that_came_to_rest_and_is_given_up_shows_what_was_there() {
    let mut dome = Dome::new();
    let (before, vertex, width) = (embedding(&dome.session), dome.inside, dome.width());
    let session = &mut dome.session;
    let target = session.document().targets[&vertex].uv + 0.04 * width * DVec2::X;
    settled(session, Action::MovePin { vertex, target });
    settled(session, Action::Rest);
    assert!(session.is_current() && embedding(session) != before);
    session.handle(Action::GiveUpGesture);
    assert!(session.is_current() && !session.is_running() && embedding(session) == before);
}

#[test]
fn an_edit_while_the_one_before_is_solved_for_goes_on_from_what_is_there() {
    let mut dome = Dome::new();
    let uv = embedding(&dome.session)[dome.sixth] + 0.03 * dome.width() * DVec2::Y;
    for share in [0.0, 0.01, 0.02] {
        let target = Target::hard(uv + share * dome.width() * DVec2::X);
        dome.session.handle(Action::Place { vertex: dome.sixth, target });
    }
    settle(&mut dome.session);
    assert!(is_solved(&dome.session) && dome.session.is_continued());
}

#[test]
fn a_solve_afresh_gives_the_same_bytes_as_a_fresh_session() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = folder.path().join("grid.obj");
    write_obj(&mesh, &grid(8, 8));
    let mut edited = session();
    settled(&mut edited, Action::Open(mesh.clone()));
    // Rotated so far that the first solve folds, so the planar start is needed too.
    let at = |x: f64, y: f64| DVec2::new(x, y);
    let corners = [(0, at(0.0, 0.0)), (8, at(8.0, 0.0)), (72, at(0.0, 8.0)), (80, at(8.0, 8.0))];
    let ring = [(30, at(5.0, 3.0)), (32, at(5.0, 5.0)), (48, at(3.0, 3.0)), (50, at(3.0, 5.0))];
    let place = |session: &mut Session, pins: &[(u32, DVec2)]| {
        for &(vertex, uv) in pins {
            session.handle(Action::Place { vertex: VertexId::new(vertex), target: Target::hard(uv) });
        }
        settle(session);
    };
    place(&mut edited, &corners);
    for pin in ring {
        place(&mut edited, &[pin]);
    }
    assert!(is_solved(&edited) && edited.is_continued());
    let gone_on = embedding(&edited);
    settled(&mut edited, Action::Solve);
    assert!(is_solved(&edited) && !edited.is_continued());
    let mut fresh = session();
    settled(&mut fresh, Action::Open(mesh));
    place(&mut fresh, &[&corners[..], &ring].concat());
    assert!(embedding(&edited) == embedding(&fresh), "to the last bit");
    assert!(embedding(&edited) != gone_on, "of two ways to the constraints one is left");
}
