//! Windows of the Help menu: About, and the messages of this run.

use std::fmt::Write as _;
use std::time::SystemTime;

use eframe::egui::{self, Align2, Role};

use super::documentation::documentation;
use crate::session::{LoggedMessage, Severity};
use crate::ui::{Control, Editor, sentence, theme_of};

/// Paper that the program implements.
const PAPER: &str = "Z. Karni, C. Gotsman, S. J. Gortler: Free-Boundary Linear Parameterization of 3D Meshes in the \
                     Presence of Constraints. Shape Modeling International 2005.";

/// Text of About.
fn about_words() -> String {
    format!(
        "Freebound {}\n\nFlattens triangle meshes into the plane and proves every result.\n\nLicence: {}\n\nIt \
         implements and extends:\n{PAPER}",
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_LICENSE"),
    )
}

/// Shows the windows of the Help menu that are open.
pub(super) fn help_windows(context: &egui::Context, editor: &mut Editor) {
    documentation(context, editor);
    about(context, &mut editor.layout.help.about_shown);
    log(context, editor);
}

fn about(context: &egui::Context, is_open: &mut bool) {
    let window = egui::Window::new("About Freebound").open(is_open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
        ui.set_max_width(380.0);
        let words = about_words();
        ui.add(egui::Label::new(&words).wrap().selectable(true));
        ui.add_space(8.0);
        let copy = ui.button("Copy").named(Role::Button, "Copy the text");
        if copy.on_hover_text("Copy the version, the licence and the reference").clicked() {
            ui.ctx().copy_text(words);
        }
    });
}

/// Line of a message: its age, text and remedy.
fn line(LoggedMessage { time, message }: &LoggedMessage, now: SystemTime) -> String {
    let seconds = now.duration_since(*time).unwrap_or_default().as_secs();
    let age = if seconds < 60 { format!("{seconds} s") } else { format!("{} min {} s", seconds / 60, seconds % 60) };
    let mut line = format!("{age} ago: {}", sentence(&message.text));
    if let Some(remedy) = &message.remedy {
        write!(line, ". {}", sentence(remedy)).ok();
    }
    line
}

fn log(context: &egui::Context, editor: &mut Editor) {
    let log = editor.session.message_log();
    let width = (context.content_rect().width() - 60.0).min(560.0);
    let window = egui::Window::new("Messages of this run").open(&mut editor.layout.help.log_shown).collapsible(false);
    let window = window.default_size([width, 320.0]).pivot(Align2::CENTER_CENTER);
    window.default_pos(context.content_rect().center()).show(context, |ui| {
        if log.len() == 0 {
            ui.weak("There are no messages yet.");
            return;
        }
        let now = SystemTime::now();
        let copy = ui.button("Copy all").named(Role::Button, "Copy all messages");
        if copy.on_hover_text("Copy the messages of this run, the oldest first").clicked() {
            let lines: Vec<String> = log.clone().map(|logged| line(logged, now)).collect();
            ui.ctx().copy_text(lines.join("\n"));
        }
        ui.separator();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for logged in log.rev() {
                let is_error = logged.message.severity == Severity::Error;
                let colour = if is_error { theme_of(ui).flipped } else { theme_of(ui).text };
                let words = egui::RichText::new(line(logged, now)).color(colour);
                ui.add(egui::Label::new(words).wrap().selectable(true));
            }
        });
    });
}
