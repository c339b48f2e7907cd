//! Bars that the window shows by itself: work that a session before left, faces that point inward, targets that look
//! mirrored.

use eframe::egui;

use super::pane::bar;
use crate::session::Action;
use crate::ui::controls::Control;
use crate::ui::icons::Sign;
use crate::ui::{Editor, Pane, Request};

/// Shows the bars of a pane.
pub(in crate::ui) fn bars(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    match pane {
        Pane::Mesh => {
            recovery(ui, editor, requests);
            inward(ui, editor, requests);
        }
        Pane::Plane => mirrored(ui, editor, requests),
    }
}

/// A button of a bar: what it says, what it does, what it asks for.
type BarButton = (&'static str, &'static str, Request);

fn warning(ui: &mut egui::Ui, words: &str, buttons: [BarButton; 2], requests: &mut Vec<Request>) {
    bar(ui, Sign::Warning, |ui| {
        ui.add(egui::Label::new(words).wrap());
        ui.horizontal_wrapped(|ui| {
            for (words, tip, request) in buttons {
                ui.small_button(words).on_hover_text(tip).asks(request, requests);
            }
        });
    });
}

fn recovery(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    for left in editor.session.recoverable() {
        let words = format!("Work on {} was not saved when the program ended", left.name);
        let buttons = [
            ("Recover", "Open it as it was", Action::Recover(left.path.clone()).into()),
            ("Discard", "Forget it for good", Action::DiscardRecovery(left.path.clone()).into()),
        ];
        warning(ui, &words, buttons, requests);
    }
}

fn inward(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.opened.faces_point_inward(&editor.session) {
        let buttons = [
            ("Turn them", "Make the other side the outside", Action::TurnFaces.into()),
            ("Leave them", "It is meant so", Request::LeaveFaces),
        ];
        let words = "The faces point inward: the mesh shows from behind, and its picture mirrored";
        warning(ui, words, buttons, requests);
    }
}

fn mirrored(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.tools.dragged().is_none() && editor.opened.targets_look_mirrored(&editor.session) {
        let buttons = [
            ("Mirror them", "Mirror all targets left to right", Action::MirrorTargets.into()),
            ("Leave the targets", "They are meant so", Request::LeaveTargets),
        ];
        let words = "Are the targets mirrored? A reflection fits them much better than a rotation";
        warning(ui, words, buttons, requests);
    }
}
