//! Bars that the window shows by itself: work that a session before left, faces that point inward, targets that look
//! mirrored.

use eframe::egui;

use super::pane::bar;
use crate::session::Action;
use crate::ui::controls::Offer;
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

fn warning(ui: &mut egui::Ui, words: &str, offers: [Offer; 2], requests: &mut Vec<Request>) {
    bar(ui, Sign::Warning, |ui| {
        ui.add(egui::Label::new(words).wrap());
        ui.horizontal_wrapped(|ui| {
            for offer in offers {
                offer.show(ui, requests);
            }
        });
    });
}

fn recovery(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    for left in editor.session.recoverable() {
        let words = format!("Work on {} was not saved when the program ended", left.name);
        let offers = [
            Offer::new("Recover", "Open it as it was", Action::Recover(left.path.clone())),
            Offer::new("Discard", "Forget it for good", Action::DiscardRecovery(left.path.clone())),
        ];
        warning(ui, &words, offers, requests);
    }
}

fn inward(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.opened.faces_point_inward(&editor.session) {
        let offers = [
            Offer::new("Turn them", "Make the other side the outside", Action::TurnFaces),
            Offer::new("Leave them", "It is meant so", Request::LeaveFaces),
        ];
        let words = "The faces point inward: the mesh shows from behind, and its picture mirrored";
        warning(ui, words, offers, requests);
    }
}

fn mirrored(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.tools.dragged().is_none() && editor.opened.targets_look_mirrored(&editor.session) {
        let offers = [
            Offer::new("Mirror them", "Mirror all targets left to right", Action::MirrorTargets),
            Offer::new("Leave the targets", "They are meant so", Request::LeaveTargets),
        ];
        let words = "Are the targets mirrored? A reflection fits them much better than a rotation";
        warning(ui, words, offers, requests);
    }
}
