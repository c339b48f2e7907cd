//! Bars over a pane: messages, and what the window asks by itself: about work that a session before left, faces that
//! point inward, targets that look mirrored.

use eframe::egui::{self, Label, RichText, Sense, Vec2};

use crate::session::{Action, Message, Place, Severity};
use crate::ui::icons::{self, Sign};
use crate::ui::{Control, Editor, Offer, Pane, Request, sentence, theme_of};

pub(super) fn bars(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let session = &editor.session;
    let place = match pane {
        Pane::Mesh => Place::Mesh,
        Pane::Plane => Place::Embedding,
    };
    for left in session.recoverable().iter().filter(|_| pane == Pane::Mesh) {
        let words = format!("Work on {} was not saved when the program ended", left.name);
        let offers = [
            Offer::new("Recover", "Open it as it was", Action::Recover(left.path.clone())),
            Offer::new("Discard", "Forget it for good", Action::DiscardRecovery(left.path.clone())),
        ];
        warning(ui, &words, offers, requests);
    }
    if pane == Pane::Mesh && editor.opened.faces_point_inward(session) {
        let offers = [
            Offer::new("Turn them", "Make the other side the outside", Action::TurnFaces),
            Offer::new("Leave them", "It is meant so", Request::LeaveFaces),
        ];
        let words = "The faces point inward: the mesh shows from behind, and its picture mirrored";
        warning(ui, words, offers, requests);
    }
    let is_dragging = editor.tools.dragged().is_some();
    if pane == Pane::Plane && !is_dragging && editor.opened.targets_look_mirrored(session) {
        let offers = [
            Offer::new("Mirror them", "Mirror all targets left to right", Action::MirrorTargets),
            Offer::new("Leave the targets", "They are meant so", Request::LeaveTargets),
        ];
        let words = "Are the targets mirrored? A reflection fits them much better than a rotation";
        warning(ui, words, offers, requests);
    }
    message_bars(ui, editor, place, requests);
}

fn warning(ui: &mut egui::Ui, words: &str, offers: [Offer; 2], requests: &mut Vec<Request>) {
    bar(ui, Sign::Warning, |ui| {
        ui.add(Label::new(words).wrap());
        ui.horizontal_wrapped(|ui| offers.into_iter().for_each(|offer| offer.show(ui, requests)));
    });
}

/// Messages that belong to a pane: what happened, where, what to do. They stay until dismissed or mended.
fn message_bars(ui: &mut egui::Ui, editor: &Editor, place: Place, requests: &mut Vec<Request>) {
    let messages: Vec<&Message> = editor.session.messages().iter().filter(|m| m.place == place).collect();
    if messages.is_empty() {
        return;
    }
    let limit = ui.available_height() / 2.0;
    egui::ScrollArea::vertical().id_salt(("messages", place == Place::Mesh)).max_height(limit).show(ui, |ui| {
        for message in messages {
            message_bar(ui, message, requests);
        }
    });
}

fn message_bar(ui: &mut egui::Ui, message: &Message, requests: &mut Vec<Request>) {
    let sign = match message.severity {
        Severity::Note => Sign::Good,
        Severity::Error => Sign::Bad,
    };
    bar(ui, sign, |ui| {
        ui.add(Label::new(sentence(&message.text)).wrap());
        if let Some(remedy) = &message.remedy {
            let weak = theme_of(ui).weak_text;
            ui.add(Label::new(RichText::new(sentence(remedy)).color(weak)).wrap());
        }
        ui.horizontal_wrapped(|ui| message_buttons(ui, message, requests));
    });
}

/// A bar over a pane, with its sign at the left.
fn bar(ui: &mut egui::Ui, sign: Sign, add: impl FnOnce(&mut egui::Ui)) {
    let theme = theme_of(ui);
    let frame = egui::Frame::new()
        .fill(sign.colour(theme).gamma_multiply(0.14))
        .inner_margin(8)
        .outer_margin(egui::Margin::symmetric(4, 2));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal_top(|ui| {
            let (square, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
            icons::sign(ui.painter(), square.translate(Vec2::new(0.0, 3.0)), sign, theme);
            ui.vertical(add);
        });
    });
}

fn message_buttons(ui: &mut egui::Ui, message: &Message, requests: &mut Vec<Request>) {
    if !message.vertices.is_empty() {
        Offer::new("Go to", "Show it in the mesh", Request::GoTo(message.vertices.clone())).show(ui, requests);
    }
    if ui.small_button("Copy").on_hover_text("Copy the message").clicked() {
        ui.ctx().copy_text(message.text.clone());
    }
    ui.small_button("Dismiss").asks(Action::Dismiss(message.id), requests);
}
