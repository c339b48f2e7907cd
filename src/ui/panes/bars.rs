//! Bars that the window shows by itself: work that a session before left, faces that point inward, targets that look
//! mirrored.

use eframe::egui;

use super::pane::bar;
use crate::session::Action;
use crate::ui::icons;
use crate::ui::theme::theme_of;
use crate::ui::{Editor, Pane, Request};

/// Shows the bars of a pane.
pub(in crate::ui) fn bars(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    if pane == Pane::Mesh {
        recovery(ui, editor, requests);
        inward(ui, editor, requests);
    } else {
        mirrored(ui, editor, requests);
    }
}

fn recovery(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    for left in editor.session.recoverable() {
        bar(ui, (theme.stale, icons::Sign::Warning), |ui| {
            let words = format!("Work on {} was not saved when the program ended", left.name);
            ui.add(egui::Label::new(words).wrap());
            ui.horizontal_wrapped(|ui| {
                if ui.small_button("Recover").on_hover_text("Open it as it was").clicked() {
                    requests.push(Request::Do(Action::Recover(left.path.clone())));
                }
                if ui.small_button("Discard").on_hover_text("Forget it for good").clicked() {
                    requests.push(Request::Do(Action::DiscardRecovery(left.path.clone())));
                }
            });
        });
    }
}

fn inward(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if !editor.opened.faces_point_inward(&editor.session) {
        return;
    }
    let theme = theme_of(ui);
    bar(ui, (theme.stale, icons::Sign::Warning), |ui| {
        ui.add(egui::Label::new("The faces point inward: the mesh shows from behind, and its picture mirrored").wrap());
        ui.horizontal_wrapped(|ui| {
            if ui.small_button("Turn them").on_hover_text("Make the other side the outside").clicked() {
                requests.push(Request::Do(Action::TurnFaces));
            }
            if ui.small_button("Leave them").on_hover_text("It is meant so").clicked() {
                requests.push(Request::LeaveFaces);
            }
        });
    });
}

fn mirrored(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.dragged_pin.is_some() || !editor.opened.targets_look_mirrored(&editor.session) {
        return;
    }
    let theme = theme_of(ui);
    bar(ui, (theme.stale, icons::Sign::Warning), |ui| {
        let words = "Are the targets mirrored? A reflection fits them much better than a rotation";
        ui.add(egui::Label::new(words).wrap());
        ui.horizontal_wrapped(|ui| {
            if ui.small_button("Mirror them").on_hover_text("Mirror all targets left to right").clicked() {
                requests.push(Request::Do(Action::MirrorTargets));
            }
            if ui.small_button("Leave the targets").on_hover_text("They are meant so").clicked() {
                requests.push(Request::LeaveTargets);
            }
        });
    });
}
