//! Success message about written files, or remark on something that was not done, over the lower edge of the panes for a few seconds.

use std::time::Duration;

use eframe::egui::{self, Align2, Rect, Sense, Vec2};

use crate::session::{Action, Message, Severity};
use crate::ui::icons::{self, Sign};
use crate::ui::state::Toast;
use crate::ui::theme::BOTTOM_HEIGHT;
use crate::ui::{Control, Editor, Request, sentence, theme_of};

/// Duration of the message, seconds.
const SECONDS: f64 = 4.0;

/// Gap between the message and the strip below it, points.
const GAP: f32 = 12.0;

/// Greatest width of the message, points.
const WIDTH: f32 = 440.0;

/// Shows the newest success message or remark, and dismisses it when its time is over. It stays while it is under the pointer
/// or one of its buttons has the focus.
pub(in crate::ui) fn toast(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let newest = editor.session.messages().iter().rfind(|message| message.severity != Severity::Error).cloned();
    let Some(message) = newest else {
        editor.layout.toast = None;
        return;
    };
    let now = editor.gpu.now();
    let begun = Toast { id: message.id, since: now };
    if editor.files.dialogs.is_open() {
        // The message would cover the dialog. Its time starts when the dialog closes.
        editor.layout.toast = Some(begun);
        return;
    }
    let shown = *editor.layout.toast.get_or_insert(begun);
    let shown = if shown.id == message.id { shown } else { begun };
    let strip = if editor.has_disk() { editor.timeline.height() } else { 0.0 };
    let area = egui::Area::new(egui::Id::unique("toast")).order(egui::Order::Foreground).movable(false);
    let panes = panes(context, editor);
    let bottom = context.content_rect().bottom() - (BOTTOM_HEIGHT + strip + GAP);
    let area = area.pivot(Align2::CENTER_BOTTOM).fixed_pos(egui::pos2(panes.center().x, bottom));
    let width = WIDTH.min(panes.width() - 40.0);
    let area = area.show(context, |ui| contents(ui, &message, width, requests));
    let since = if area.response.contains_pointer() || area.inner { now } else { shown.since };
    editor.layout.toast = Some(Toast { since, ..shown });
    let left = since + SECONDS - now;
    if left <= 0.0 {
        requests.push(Action::Dismiss(message.id).into());
    } else {
        context.request_repaint_after(Duration::from_secs_f64(left));
    }
}

/// Place of both panes. Default: the window.
fn panes(context: &egui::Context, editor: &Editor) -> Rect {
    let panes = editor.mesh.pane.rect().into_iter().chain(editor.plane.rect());
    panes.reduce(Rect::union).unwrap_or_else(|| context.content_rect())
}

/// Text and buttons of the message. Returns true if a button has the focus.
fn contents(ui: &mut egui::Ui, message: &Message, width: f32, requests: &mut Vec<Request>) -> bool {
    let theme = theme_of(ui);
    let sign = if message.severity == Severity::Note { Sign::Good } else { Sign::Warning };
    let tint = theme.panel.lerp_to_gamma(sign.colour(theme), 0.14);
    let frame = egui::Frame::popup(ui.style()).fill(tint).inner_margin(10);
    let row = |ui: &mut egui::Ui| {
        ui.set_max_width(width);
        let (square, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
        icons::sign(ui.painter(), square.translate(Vec2::new(0.0, 3.0)), sign, theme);
        let words_and_buttons = |ui: &mut egui::Ui| {
            ui.add(egui::Label::new(sentence(&message.text)).wrap());
            ui.horizontal(|ui| buttons(ui, message, requests)).inner
        };
        ui.vertical(words_and_buttons).inner
    };
    frame.show(ui, |ui| ui.horizontal_top(row).inner).inner
}

fn buttons(ui: &mut egui::Ui, message: &Message, requests: &mut Vec<Request>) -> bool {
    let mut has_keyboard = false;
    if let Some(file) = message.files.first() {
        let button = ui.small_button("Show in folder");
        has_keyboard |= button.has_focus();
        button.asks(Action::ShowFolder(file.clone()), requests);
    }
    let close = ui.small_button("Close");
    has_keyboard |= close.has_focus();
    close.asks(Action::Dismiss(message.id), requests);
    has_keyboard
}
