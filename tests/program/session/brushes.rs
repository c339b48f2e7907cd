//! Strokes of brushes: every frame is planar, and a stroke is one edit that later edits and files keep.

use freebound::examples::Example;
use freebound::session::{Action, BrushDab, Session};
use freebound_core::bijective::{Brush, BrushKind};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::Embedding;
use freebound_core::verify::verdict;
use glam::DVec2;

use super::basics::{opened, session, settle, settled};

fn embedding(session: &Session) -> Embedding {
    session.outcome().expect("solved").step.candidate.solution.embedding.clone()
}

/// Point in the plane at shares of the map's extent from its middle.
fn at(session: &Session, share: [f64; 2]) -> DVec2 {
    let bounds = embedding(session).bounds();
    bounds.middle() + bounds.extent() * DVec2::from(share)
}

fn dab(session: &Session, kind: BrushKind, share: [f64; 2]) -> Action {
    let radius = 0.2 * embedding(session).bounds().extent();
    let brush = Brush { kind, radius, strength: 1.0 };
    Action::Brush(BrushDab { brush, at: at(session, share), begins: true })
}

/// Carries out a stroke; all frames have to be planar.
fn stroke(session: &mut Session, kind: BrushKind, way: &[[f64; 2]]) {
    let dabs: Vec<Action> = way.iter().map(|&share| dab(session, kind, share)).collect();
    let disk = session.model().expect("open").disk().expect("a disk").clone();
    for dab in dabs {
        settled(session, dab);
        let preview = session.preview().expect("the stroke has moved something");
        let proved = preview.verdict().expect("there with the frame");
        assert!(proved.planar && **proved == verdict(&disk, &preview.embedding));
    }
    settled(session, Action::EndBrush);
}

#[test]
fn a_stroke_is_one_edit_that_undo_and_redo_show_bit_for_bit() {
    let mut session = opened(Example::Dome);
    let before = embedding(&session);
    for kind in BrushKind::ALL {
        let way = if kind == BrushKind::Smooth { [[0.5, 0.0], [0.5, 0.05]] } else { [[0.1, 0.0], [0.15, 0.05]] };
        stroke(&mut session, kind, &way);
        let after = embedding(&session);
        assert!(after != before, "{kind:?}");
        assert!(session.is_current() && session.preview().is_none() && session.has_unsaved_work());
        assert!(session.outcome().expect("there").step.verdict.planar);
        settled(&mut session, Action::Undo);
        assert!(embedding(&session) == before, "{kind:?}");
        settled(&mut session, Action::Redo);
        assert!(embedding(&session) == after, "{kind:?}");
        settled(&mut session, Action::Undo);
    }
}

#[test]
fn a_cancelled_stroke_leaves_the_map_and_the_history() {
    let mut session = opened(Example::Dome);
    let before = embedding(&session);
    let action = dab(&session, BrushKind::Grab, [0.1, 0.0]);
    settled(&mut session, action);
    for cancel in [Action::GiveUpBrush, Action::Undo, Action::Cancel] {
        for share in [[0.1, 0.0], [0.2, 0.1]] {
            let action = dab(&session, BrushKind::Grab, share);
            settled(&mut session, action);
        }
        assert!(session.is_brushing() && session.preview().is_some());
        settled(&mut session, cancel);
        assert!(!session.is_brushing() && session.preview().is_none() && !session.history().can_undo());
        assert!(embedding(&session) == before);
    }
}

#[test]
fn a_shaped_map_stays_when_a_pin_is_added_and_goes_with_another_method() {
    let mut session = opened(Example::Dome);
    let solved = embedding(&session);
    stroke(&mut session, BrushKind::Grab, &[[0.0, 0.0], [0.1, 0.05]]);
    let shaped = embedding(&session);
    settled(&mut session, Action::Fix(vec![VertexId::new(3)]));
    assert!(embedding(&session) == shaped);
    let by = DVec2::new(0.25, 0.5);
    let target = Target::hard(shaped[3] + by);
    settled(&mut session, Action::Place { vertex: VertexId::new(3), target });
    let moved = embedding(&session);
    assert_eq!(moved[3], shaped[3] + by);
    let error = moved.iter().zip(shaped.iter()).map(|(a, b)| a.distance(*b + by)).fold(0.0, f64::max);
    assert!(error < 1e-9, "{error}");
    settled(&mut session, Action::UnpinAll);
    assert!(embedding(&session) == shaped);
    settled(&mut session, Action::Solve);
    assert!(embedding(&session) == solved);
    settled(&mut session, Action::Undo);
    assert!(embedding(&session) == shaped);
}

#[test]
fn pins_hold_under_every_brush() {
    let mut session = opened(Example::Dome);
    let middle = at(&session, [0.0, 0.0]);
    let flat = embedding(&session);
    let near = (0..flat.len()).min_by(|&a, &b| flat[a].distance(middle).total_cmp(&flat[b].distance(middle)));
    let pinned = VertexId::from_index(near.expect("vertices"));
    settled(&mut session, Action::Fix(vec![pinned]));
    let place = embedding(&session)[pinned];
    for kind in [BrushKind::Grab, BrushKind::Relax, BrushKind::Pinch, BrushKind::Texels] {
        stroke(&mut session, kind, &[[0.02, 0.0], [0.08, 0.05]]);
        assert_eq!(embedding(&session)[pinned], place, "{kind:?}");
    }
}

#[test]
fn a_shaped_map_returns_from_a_project_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = folder.path().join("dome.obj");
    freebound_testkit::write_obj(&mesh, &Example::Dome.mesh());
    let mut session = session();
    settled(&mut session, Action::Open(mesh));
    stroke(&mut session, BrushKind::Texels, &[[0.1, 0.0], [0.15, 0.05]]);
    let shaped = embedding(&session);
    let project = folder.path().join("dome.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let mut again = super::basics::session();
    settled(&mut again, Action::Open(project));
    assert!(embedding(&again) == shaped);
    stroke(&mut again, BrushKind::Relax, &[[0.1, 0.0]]);
    assert!(embedding(&again) != shaped);
}

#[test]
fn brushes_wait_for_a_planar_map() {
    let mut session = session();
    assert!(!session.can_brush());
    settled(&mut session, Action::OpenExample(Example::Dome));
    assert!(session.can_brush());
    session.handle(Action::Solve);
    assert!(!session.can_brush(), "while it is solved");
    settle(&mut session);
    assert!(session.can_brush());
}
