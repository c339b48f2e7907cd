//! Undo and redo: actions that form one step, and actions that form none.

use freebound::session::{Command, Document, History};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, Settings};
use glam::DVec2;

fn pin(vertex: u32, x: f64) -> Command {
    Command::SetPin { vertex: VertexId::new(vertex), target: Some(Target::hard(DVec2::new(x, 0.0))) }
}

#[test]
fn a_drag_is_one_undo_step() {
    let (mut history, mut document) = (History::default(), Document::default());
    for x in [0.0, 0.5, 1.0] {
        history.apply_in_gesture(pin(7, x), &mut document);
    }
    history.end_gesture(&mut document);

    assert!(history.undo(&mut document));
    assert_eq!(document, Document::default());
    assert!(!history.can_undo());
    assert!(history.redo(&mut document));
    assert_eq!(document.targets[&VertexId::new(7)].uv, DVec2::X);
}

#[test]
fn a_drag_that_begins_by_pinning_several_is_one_undo_step() {
    let (mut history, mut document) = (History::default(), Document::default());
    history.apply_in_gesture(Command::Together(vec![pin(1, 0.0), pin(2, 1.0)]), &mut document);
    for x in [0.5, 0.75] {
        history.apply_in_gesture(pin(1, x), &mut document);
    }
    history.undo(&mut document);
    assert_eq!(document, Document::default());
    assert!(!history.can_undo());
}

#[test]
fn a_drag_that_is_given_up_leaves_no_trace() {
    let (mut history, mut document) = (History::default(), Document::default());
    history.apply(pin(3, 1.0), &mut document);
    let before = document.clone();
    for x in [0.0, 0.5] {
        history.apply_in_gesture(pin(7, x), &mut document);
    }
    assert!(history.give_up_gesture(&mut document));
    assert_eq!(document, before);
    assert!(!history.can_redo());
    assert!(!history.give_up_gesture(&mut document), "nothing is under way any more");
    assert_eq!(document, before);
}

#[test]
fn a_drag_that_comes_to_nothing_leaves_what_could_be_redone() {
    for gives_up in [true, false] {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply(pin(3, 1.0), &mut document);
        history.apply(pin(3, 2.0), &mut document);
        history.undo(&mut document);
        for x in [0.0, 1.0] {
            history.apply_in_gesture(pin(3, x), &mut document);
        }
        if gives_up {
            history.give_up_gesture(&mut document);
        } else {
            history.end_gesture(&mut document);
        }
        assert!(history.redo(&mut document));
        assert_eq!(document.targets[&VertexId::new(3)].uv.x.to_bits(), 2.0_f64.to_bits());
    }
}

#[test]
fn a_gesture_over_many_pins_stays_one_flat_step() {
    let (mut history, mut document) = (History::default(), Document::default());
    for round in 0..100_u32 {
        history.apply_in_gesture(pin(round % 7, f64::from(round)), &mut document);
    }
    let shown = format!("{history:?}");
    assert_eq!((shown.matches("Together").count(), shown.matches("SetPin").count()), (1, 7), "one step: {shown}");
    history.undo(&mut document);
    assert_eq!(document, Document::default());
}

#[test]
fn a_slide_and_a_drag_are_two_undo_steps() {
    let (mut history, mut document) = (History::default(), Document::default());
    let chosen = Settings::new(Method::Levy, Family::MeanValue);
    history.apply_in_gesture(Command::SetSettings(chosen.clone()), &mut document);
    history.apply_in_gesture(pin(7, 0.5), &mut document);
    history.undo(&mut document);
    assert_eq!(document, Document { settings: chosen, ..Document::default() });
}

#[test]
fn what_changes_nothing_is_no_undo_step() {
    let (mut history, mut document) = (History::default(), Document::default());
    assert!(history.apply(pin(7, 0.5), &mut document));
    assert!(!history.apply(pin(7, 0.5), &mut document));
    for x in [1.0, 0.5] {
        history.apply_in_gesture(pin(7, x), &mut document);
    }
    history.end_gesture(&mut document);
    assert!(history.undo(&mut document));
    assert!(!history.can_undo() && document == Document::default());
}

#[test]
fn two_drags_are_two_undo_steps() {
    let (mut history, mut document) = (History::default(), Document::default());
    history.apply_in_gesture(pin(7, 0.5), &mut document);
    history.end_gesture(&mut document);
    history.apply_in_gesture(pin(7, 1.0), &mut document);
    history.undo(&mut document);
    assert_eq!(document.targets[&VertexId::new(7)].uv, DVec2::new(0.5, 0.0));
}

#[test]
fn a_new_edit_forgets_what_could_be_redone() {
    let (mut history, mut document) = (History::default(), Document::default());
    history.apply(pin(1, 0.0), &mut document);
    history.undo(&mut document);
    history.apply(pin(2, 0.0), &mut document);
    assert!(!history.can_redo());
}

#[test]
fn settings_come_back_too() {
    let (mut history, mut document) = (History::default(), Document::default());
    let chosen = Settings::new(Method::Levy, Family::MeanValue);
    history.apply(Command::SetSettings(chosen.clone()), &mut document);
    assert_eq!(document.settings, chosen);
    history.undo(&mut document);
    assert_eq!(document.settings, Settings::default());
}

#[test]
fn a_slider_that_comes_back_to_where_it_was_drops_no_relaxing_and_nothing_that_can_be_repeated() {
    let (mut history, mut document) = (History::default(), Document::default());
    history.apply(pin(7, 0.5), &mut document);
    history.undo(&mut document);
    document.relaxed = 20;
    document.settings.family = Some(Family::Conformal);
    let before = document.clone();
    for family in [Family::Power(0.4), Family::Power(0.2), before.settings.family()] {
        let settings = Settings { family: Some(family), ..before.settings.clone() };
        let slid = Command::Together(vec![Command::SetSettings(settings), Command::SetRelaxed(0)]);
        history.apply_in_gesture(slid, &mut document);
    }
    history.end_gesture(&mut document);
    assert_eq!(document, before);
    assert!(history.can_redo() && !history.can_undo());
}
