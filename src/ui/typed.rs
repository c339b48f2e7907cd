//! Number fields: invalid input marks the field and changes nothing.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use eframe::egui::{Id, Response, Role, Stroke, StrokeKind, Ui};

use super::controls::Control;
use super::theme::theme_of;

/// Range of valid numbers of a field.
pub(in crate::ui) struct Typed {
    /// Noun for the number in messages: "a weight".
    what: &'static str,
    range: RangeInclusive<f64>,
    is_whole: bool,
    /// Text typed in this frame, and true if it was valid.
    last: RefCell<Option<(String, bool)>>,
}

impl Typed {
    pub(in crate::ui) fn new(what: &'static str, range: RangeInclusive<f64>) -> Self {
        Self { what, range, is_whole: false, last: RefCell::default() }
    }

    /// Allows whole numbers only.
    pub(in crate::ui) fn whole(self) -> Self {
        Self { is_whole: true, ..self }
    }

    /// Number of a text, if it is valid.
    pub(in crate::ui) fn number(&self, text: &str) -> Option<f64> {
        let number = parsed(text).filter(|number| self.range.contains(number));
        let number = number.filter(|number| !self.is_whole || number.fract() == 0.0);
        self.last.replace(Some((text.trim().to_owned(), number.is_some())));
        number
    }

    /// Records that the shown number was typed again, and returns it with all digits.
    pub(in crate::ui) fn again(&self, number: f64) -> f64 {
        self.last.replace(Some((String::new(), true)));
        number
    }

    /// Sets the name of the field, and marks the field if the last input was invalid.
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
        let Some(_) = parsed(text) else { return format!("“{text}” is not a number") };
        let [least, most] = [self.range.start(), self.range.end()].map(|&end| in_words(end));
        let kind = if self.is_whole { ", as a whole number" } else { "" };
        format!("{text} is not valid: {} must lie between {least} and {most}{kind}", self.what)
    }
}

/// Parses a finite number with a minus sign or a hyphen.
fn parsed(text: &str) -> Option<f64> {
    text.trim().replace('−', "-").parse().ok().filter(|number: &f64| number.is_finite())
}

fn in_words(number: f64) -> String {
    if (1e-3..1e6).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}
