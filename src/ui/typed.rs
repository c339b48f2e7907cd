//! What is typed into a field of a number: where it cannot be taken the field is marked, and nothing changes.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use eframe::egui::{Id, Response, Role, Stroke, StrokeKind, Ui};

use super::controls::Control;
use super::theme::theme_of;

/// The numbers that a field takes.
pub(in crate::ui) struct Typed {
    /// What the number is: "a weight".
    what: &'static str,
    range: RangeInclusive<f64>,
    is_whole: bool,
    /// What was typed in this frame, and whether it was taken.
    last: RefCell<Option<(String, bool)>>,
}

impl Typed {
    pub(in crate::ui) fn new(what: &'static str, range: RangeInclusive<f64>) -> Self {
        Self { what, range, is_whole: false, last: RefCell::default() }
    }

    /// The same for whole numbers alone.
    pub(in crate::ui) fn whole(self) -> Self {
        Self { is_whole: true, ..self }
    }

    /// The number that a text stands for, where it is taken.
    pub(in crate::ui) fn number(&self, text: &str) -> Option<f64> {
        let number = parsed(text).filter(|number| self.range.contains(number));
        let number = number.filter(|number| !self.is_whole || number.fract() == 0.0);
        self.last.replace(Some((text.trim().to_owned(), number.is_some())));
        number
    }

    /// The number that the field shows was typed again.
    pub(in crate::ui) fn again(&self, number: f64) -> f64 {
        self.last.replace(Some((String::new(), true)));
        number
    }

    /// Names the field, and marks it where what was typed last was not taken.
    pub(in crate::ui) fn name(self, ui: &Ui, field: Response, name: &str) -> Response {
        let key = Id::unique(("not taken", name));
        if field.gained_focus() || field.dragged() {
            ui.data_mut(|data| data.remove_temp::<String>(key));
        }
        match self.last.take() {
            Some((_, true)) => {
                ui.data_mut(|data| data.remove_temp::<String>(key));
            }
            Some((text, false)) => {
                let words = self.refusal(&text);
                ui.data_mut(|data| data.insert_temp(key, words));
            }
            None => {}
        }
        let Some(words) = ui.data(|data| data.get_temp::<String>(key)) else {
            return field.named(Role::SpinButton, name);
        };
        let stroke = Stroke::new(1.5, theme_of(ui).flipped);
        ui.painter().rect_stroke(field.rect, 2.0, stroke, StrokeKind::Inside);
        field.named(Role::SpinButton, &format!("{name}: {words}")).on_hover_text(words)
    }

    fn refusal(&self, text: &str) -> String {
        let Some(_) = parsed(text) else { return format!("“{text}” is no number") };
        let [least, most] = [self.range.start(), self.range.end()].map(|&end| in_words(end));
        let kind = if self.is_whole { ", and is whole" } else { "" };
        format!("{text} is not taken: {} lies between {least} and {most}{kind}", self.what)
    }
}

/// A finite number, its sign a minus or a hyphen.
fn parsed(text: &str) -> Option<f64> {
    text.trim().replace('−', "-").parse().ok().filter(|number: &f64| number.is_finite())
}

fn in_words(number: f64) -> String {
    if (1e-3..1e6).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}
