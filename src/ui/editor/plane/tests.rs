//! Test of an embedding whose scene cannot be made.

use std::time::Duration;

use eframe::egui;
use freebound_testkit::assert_message;

use crate::examples::Example;
use crate::session::{Action, MessagePlace, RecentFiles, Severity};
use crate::ui::editor::Editor;

#[test]
fn a_sheet_that_cannot_be_drawn_is_said_once_and_not_waited_for() {
    let mut editor = Editor::new(&egui::Context::default(), RecentFiles::default());
    let rest = |editor: &mut Editor| {
        let is_at_work = |editor: &Editor| {
            let makes_scenes = editor.mesh.is_making_scene() || editor.plane.is_making_scene();
            editor.session.busy().is_some() || makes_scenes || editor.plane.is_moving(&editor.session)
        };
        editor.poll();
        while is_at_work(editor) {
            std::thread::sleep(Duration::from_millis(1));
            editor.poll();
        }
    };
    editor.session.handle(Action::OpenExample(Example::Cube));
    rest(&mut editor);
    let before = editor.plane.scene().expect("drawn").outcome_revision;
    editor.session.handle(Action::Step);
    while editor.session.outcome_revision() == before {
        std::thread::sleep(Duration::from_millis(1));
        editor.session.poll();
    }
    editor.plane.job.make(editor.session.outcome_revision(), |_| panic!("on purpose"));
    rest(&mut editor);
    rest(&mut editor);
    let [message] = editor.session.messages() else { panic!("{:?}", editor.session.messages()) };
    assert_eq!((message.severity, message.place), (Severity::Error, MessagePlace::Embedding));
    assert_message("tests-drawing-has-stopped", &message.text);
    assert_eq!(editor.plane.scene().map(|scene| scene.outcome_revision), Some(before), "what was drawn stays");
}
