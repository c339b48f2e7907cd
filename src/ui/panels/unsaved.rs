//! The one question that stops everything: what to do with work that is not saved when something else is to open, or
//! the window to close.

use eframe::egui;

use crate::session::Action;
use crate::ui::{Control, Editor, Purpose, Request};

/// What waits for the answer.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) enum Wish {
    Quit,
    Do(Action),
}

/// The answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    Save,
    DontSave,
    Cancel,
}

/// The question as the window has it.
#[derive(Debug, Default)]
pub struct Unsaved {
    /// What is asked about.
    asked: Option<Wish>,
    /// What goes on once the project is saved.
    after_saving: Option<Wish>,
}

impl Unsaved {
    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }
}

impl Editor {
    /// What the open document is called.
    pub(super) fn document_name(&self) -> String {
        self.session.project_name().unwrap_or_else(|| "Freebound".to_owned())
    }

    /// The same, with a mark where work is not saved.
    pub(super) fn marked_name(&self) -> String {
        format!("{}{}", if self.session.has_unsaved_work() { "• " } else { "" }, self.document_name())
    }

    /// Does what would lose the open document: at once where nothing is lost, else once the person has answered.
    pub(in crate::ui) fn wish(&mut self, wish: Wish) {
        if self.session.has_unsaved_work() {
            self.files.unsaved.asked = Some(wish);
        } else {
            self.grant(wish);
        }
    }

    fn grant(&mut self, wish: Wish) {
        match wish {
            Wish::Quit => self.host.quit(),
            Wish::Do(action) => self.session.handle(action),
        }
    }

    pub(in crate::ui) fn answer(&mut self, answer: Answer) {
        let Some(wish) = self.files.unsaved.asked.take() else { return };
        match answer {
            Answer::Cancel => {}
            Answer::DontSave => self.grant(wish),
            Answer::Save => {
                self.files.unsaved.after_saving = Some(wish);
                self.save_project();
            }
        }
    }

    /// Saves where the project was saved before, or asks where.
    pub(in crate::ui) fn save_project(&mut self) {
        match self.session.project_path().cloned() {
            Some(path) => {
                self.keep_view();
                self.session.handle(Action::SaveProject(path));
            }
            None => self.ask(Purpose::SaveProject),
        }
    }

    /// Goes on with what waited for the project to be saved. Where it was not saved, that is given up. Call once per
    /// frame.
    pub(in crate::ui) fn go_on_after_saving(&mut self) {
        if self.files.unsaved.after_saving.is_none() || self.files.dialogs.is_open() || self.session.is_saving_project()
        {
            return;
        }
        let wish = self.files.unsaved.after_saving.take();
        if let Some(wish) = wish.filter(|_| !self.session.has_unsaved_work()) {
            self.grant(wish);
        }
    }

    /// Takes the question away. Returns whether it was asked.
    pub(in crate::ui) fn close_question(&mut self) -> bool {
        self.files.unsaved.asked.take().is_some()
    }
}

/// Keeps a window open that somebody closes while work is not saved.
pub(in crate::ui) fn hold_window(context: &egui::Context, editor: &mut Editor) {
    let is_closing = context.input(|input| input.viewport().close_requested());
    if is_closing && !editor.host.is_quitting() && editor.session.has_unsaved_work() {
        context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        editor.wish(Wish::Quit);
    }
}

pub(in crate::ui) fn question(context: &egui::Context, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(wish) = &editor.files.unsaved.asked else { return };
    let name = editor.document_name();
    egui::Modal::new(egui::Id::unique("unsaved work")).show(context, |ui| {
        ui.set_width(340.0);
        ui.strong(format!("Save the project {name}?"));
        ui.add_space(4.0);
        ui.label(match wish {
            Wish::Quit => "Its changes are lost when the window closes.",
            Wish::Do(_) => "Its changes are lost when something else opens.",
        });
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            for (answer, words) in
                [(Answer::Save, "Save"), (Answer::DontSave, "Don't save"), (Answer::Cancel, "Cancel")]
            {
                ui.button(words).asks(Request::Answer(answer), requests);
            }
        });
    });
}

/// Gives the window its title: the document's name, with a mark where work is not saved.
pub(in crate::ui) fn title_of_window(editor: &mut Editor) {
    let title = match editor.session.model() {
        Some(_) => format!("{} – Freebound", editor.marked_name()),
        None => "Freebound".to_owned(),
    };
    editor.host.set_title(title);
}
