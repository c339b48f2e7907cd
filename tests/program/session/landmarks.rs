//! Names of pins, and pins with equal targets.

use freebound::session::Action;
use freebound_core::pipeline::Target;
use freebound_core::problem::PinKind;
use freebound_io::{PinName, ProjectFile};
use glam::DVec2;

use super::basics::settled;
use super::documents::{id, place, with_dome};

fn name(text: &str) -> PinName {
    PinName::new(text).unwrap()
}

#[test]
fn a_name_is_one_undo_step_and_needs_no_solve() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    let (depth, revision) = (session.history().depth(), session.outcome_revision());
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
    assert!(session.is_current() && session.outcome_revision() == revision && session.has_unsaved_work());
    assert_eq!(session.history().depth(), depth + 1);
    session.handle(Action::Undo);
    assert_eq!(session.pin_name(id(3)), None);
    assert_eq!(session.outcome_revision(), revision);
}

#[test]
fn a_name_goes_with_its_pin_and_undo_restores_both() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    settled(&mut session, Action::Unpin(vec![id(3)]));
    assert!(session.document().targets.is_empty() && session.document().notes.is_empty());
    settled(&mut session, Action::Undo);
    assert!(session.document().targets.contains_key(&id(3)));
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
}

#[test]
fn two_pins_have_no_common_name_and_a_free_vertex_has_none() {
    let (_folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye")) });
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("Left Eye")) });
    session.handle(Action::NamePin { vertex: id(9), name: Some(name("chin")) });
    assert_eq!(session.document().notes.len(), 1);
    assert!(session.messages().iter().any(|message| message.remedy.is_some()));
}

#[test]
fn names_come_back_from_a_project_and_from_a_constraint_file() {
    let (folder, mut session) = with_dome();
    place(&mut session, 3, Target::hard(DVec2::new(0.25, 0.5)));
    place(&mut session, 8, Target::hard(DVec2::new(0.75, 0.5)));
    session.handle(Action::NamePin { vertex: id(3), name: Some(name("left eye, outer")) });
    let notes = session.document().notes.clone();
    let [project, list] = ["named.freebound", "named.txt"].map(|file| folder.path().join(file));
    settled(&mut session, Action::SaveProject(project.clone()));
    assert_eq!(ProjectFile::read(&project).unwrap().pins.notes, notes);
    settled(&mut session, Action::ExportConstraints(list.clone()));
    settled(&mut session, Action::UnpinAll);
    settled(&mut session, Action::ImportConstraints(list));
    assert_eq!(session.document().notes, notes);
    settled(&mut session, Action::Open(project));
    assert_eq!(session.document().notes, notes);
    assert!(!session.has_unsaved_work());
}

#[test]
fn equal_targets_are_merged_in_one_step_and_the_name_stays() {
    let (_folder, mut session) = with_dome();
    let target = Target::hard(DVec2::new(0.25, 0.5));
    place(&mut session, 3, target);
    place(&mut session, 20, Target::hard(DVec2::new(0.75, 0.5)));
    place(&mut session, 8, target);
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("left eye")) });
    let before = session.document().clone();
    settled(&mut session, Action::MergePins([id(3), id(8)]));
    assert!(!session.document().targets.contains_key(&id(8)) && session.document().targets.len() == 2);
    assert_eq!(session.pin_name(id(3)), Some(&name("left eye")));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_message_about_equal_targets_names_both_pins() {
    let (_folder, mut session) = with_dome();
    let target = Target::hard(DVec2::new(0.25, 0.5));
    place(&mut session, 3, target);
    place(&mut session, 20, Target::hard(DVec2::new(0.75, 0.5)));
    place(&mut session, 8, target);
    session.handle(Action::NamePin { vertex: id(8), name: Some(name("left eye")) });
    let conflict = session.conflict_of(id(8)).expect("equal targets").clone();
    assert!(session.conflict_words(&conflict).contains("left eye"), "{}", session.conflict_words(&conflict));
    let kind = PinKind::Soft(1.0);
    settled(&mut session, Action::SetPinKind { vertices: vec![id(8)], kind });
    assert!(session.conflict_of(id(8)).is_none(), "a loosened pin is no conflict");
}
