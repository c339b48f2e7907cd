//! Building blocks of panels: controls that make requests, drop-down lists, and rows of numbers.

use eframe::egui::{self, ComboBox, Grid, PopupCloseBehavior, Response, RichText, Role, Ui, WidgetInfo};

use super::keys::keys_of;
use super::state::Request;
use super::theme::{Theme, theme_of};
use freebound_core::problem::NamedOption;

/// Helpers for the response of a control.
pub(in crate::ui) trait Control {
    /// Sets role and name for screen readers.
    fn named(self, role: Role, name: &str) -> Self;

    /// Pushes the request if the control was clicked. Returns true on a click.
    fn asks(&self, request: impl Into<Request>, requests: &mut Vec<Request>) -> bool;

    /// True if a gesture with the control ends in this frame: a drag, or typing.
    fn has_ended(&self) -> bool;
}

impl Control for Response {
    fn named(self, role: Role, name: &str) -> Self {
        let enabled = self.enabled();
        self.widget_info(|| WidgetInfo::labeled(role, enabled, name));
        self
    }

    fn asks(&self, request: impl Into<Request>, requests: &mut Vec<Request>) -> bool {
        if self.clicked() {
            requests.push(request.into());
        }
        self.clicked()
    }

    fn has_ended(&self) -> bool {
        self.drag_stopped() || self.lost_focus()
    }
}

/// Tooltip text, followed by the shortcuts of the request in parentheses.
pub(in crate::ui) fn tip_with_keys(ui: &Ui, tip: &str, request: &Request) -> String {
    match keys_of(ui.ctx(), request) {
        keys if keys.is_empty() => tip.to_owned(),
        keys => format!("{tip} ({keys})"),
    }
}

/// Small button: its label, its tooltip and its request.
pub(in crate::ui) struct Offer {
    pub(in crate::ui) words: &'static str,
    pub(in crate::ui) tip: &'static str,
    pub(in crate::ui) request: Request,
    pub(in crate::ui) enabled: bool,
}

impl Offer {
    pub(in crate::ui) fn new(words: &'static str, tip: &'static str, request: impl Into<Request>) -> Self {
        Self { words, tip, request: request.into(), enabled: true }
    }

    /// Enables the button only if the condition is true.
    pub(in crate::ui) fn when(self, enabled: bool) -> Self {
        Self { enabled, ..self }
    }

    pub(in crate::ui) fn show(self, ui: &mut Ui, requests: &mut Vec<Request>) {
        let button = ui.add_enabled(self.enabled, egui::Button::new(self.words).small());
        button.on_hover_text(tip_with_keys(ui, self.tip, &self.request)).asks(self.request, requests);
    }
}

/// Button in the accent colour, for the action that most likely comes next. A window has at most one.
pub(in crate::ui) fn accented(words: impl Into<String>, theme: &Theme) -> egui::Button<'static> {
    egui::Button::new(RichText::new(words.into()).color(theme.panel).strong()).fill(theme.accent)
}

/// Button of [`accented`] if it is enabled. Disabled, it has no accent colour, on which its faded words are hard to read.
pub(in crate::ui) fn accented_if(ui: &mut Ui, is_enabled: bool, words: impl Into<String>, theme: &Theme) -> Response {
    let button = if is_enabled { accented(words, theme) } else { egui::Button::new(words.into()) };
    ui.add_enabled(is_enabled, button)
}

/// Row of the buttons of a dialog, at its right edge. `add` adds the primary button first: it is the rightmost.
pub(in crate::ui) fn dialog_buttons(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let size = egui::Vec2::new(ui.min_rect().width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), add);
}

/// Greatest height of an open list, points.
const LIST_HEIGHT: f32 = 480.0;

/// Drop-down list with name, width in points, selected text and entries. The entries are built only while the list is
/// open.
pub(in crate::ui) fn list(ui: &mut Ui, name: &str, width: f32, shown: &str, entries: impl FnOnce(&mut Ui)) -> Response {
    // Show all entries at once if they fit: users overlook entries that need scrolling.
    let height = LIST_HEIGHT.min(ui.ctx().content_rect().height() - 60.0);
    let list = ComboBox::from_id_salt(name).selected_text(shown).width(width).height(height);
    list.show_ui(ui, entries).response.named(Role::ComboBox, name)
}

/// Drop-down list of an option. True if another entry was clicked.
pub(in crate::ui) fn option_list<T>(ui: &mut Ui, name: &str, tip: &str, now: &mut T) -> bool
where
    T: NamedOption + PartialEq + Copy + 'static,
{
    let before = *now;
    let list = list(ui, name, 72.0, before.labels().title, |ui| {
        for &option in T::ALL {
            let label = ui.selectable_label(before == option, option.labels().title);
            if label.on_hover_text(option.labels().tip()).clicked() {
                *now = option;
            }
        }
    });
    list.on_hover_text(tip);
    *now != before
}

/// List like [`list`] that clicks inside do not close. Its entries close it.
pub(in crate::ui) fn open_list(
    ui: &mut Ui,
    name: &str,
    width: f32,
    shown: &str,
    entries: impl FnOnce(&mut Ui),
) -> Response {
    let height = LIST_HEIGHT.min(ui.ctx().content_rect().height() - 60.0);
    let list = ComboBox::from_id_salt(name).selected_text(shown).width(width).height(height);
    let list = list.close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    list.show_ui(ui, entries).response.named(Role::ComboBox, name)
}

/// Label in small, weak letters.
pub(in crate::ui) fn remark(ui: &mut Ui, words: impl Into<String>) -> Response {
    let weak = theme_of(ui).weak_text;
    ui.label(RichText::new(words).small().color(weak))
}

/// Link to a place of the documentation.
pub(in crate::ui) fn read_more(ui: &mut Ui, words: &str, place: &'static str, requests: &mut Vec<Request>) {
    let link =
        ui.link(RichText::new(words).small().color(theme_of(ui).accent)).on_hover_text("Open the documentation there");
    link.asks(Request::ShowDocumentation(Some(place)), requests);
}

/// Grid of two columns: names and their values.
pub(in crate::ui) fn pairs(ui: &mut Ui, name: &str, spacing: [f32; 2], rows: impl FnOnce(&mut Ui)) {
    Grid::new(name).num_columns(2).spacing(spacing).show(ui, rows);
}

/// Row of a name and its number, right-aligned. Screen readers read the name with the number.
pub(in crate::ui) fn number(ui: &mut Ui, name: &str, value: impl Into<String>) -> Response {
    let label = ui.label(name);
    let value = value.into();
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.with_layout(layout, |ui| ui.monospace(&value).named(Role::Label, &format!("{name}: {value}")));
    ui.end_row();
    label
}

/// Numbers of one table row, each right-aligned in `width` letters. Screen readers read `name` with each number.
pub(in crate::ui) fn figures(ui: &mut Ui, name: &str, width: usize, values: &[String]) {
    for value in values {
        ui.monospace(format!("{value:>width$}")).named(Role::Label, &format!("{name}: {value}"));
    }
}

/// Column heads over the numbers of [`figures`], with equal `width`.
pub(in crate::ui) fn heads(ui: &mut Ui, width: usize, words: &[String]) {
    for words in words {
        head(ui, width, words);
    }
}

/// Column head over the numbers of [`figures`].
pub(in crate::ui) fn head(ui: &mut Ui, width: usize, words: &str) -> Response {
    let weak = theme_of(ui).weak_text;
    ui.label(RichText::new(format!("{words:>width$}")).monospace().color(weak))
}

/// Close button: a cross painted into `rect`.
pub(in crate::ui) fn close_button(ui: &Ui, id: egui::Id, rect: egui::Rect, [name, tip]: [&str; 2]) -> Response {
    let response = ui.interact(rect, id, egui::Sense::click());
    let theme = theme_of(ui);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, theme.accent.gamma_multiply(0.2));
    }
    let half = egui::Vec2::splat(3.5);
    let stroke = egui::Stroke::new(1.4, theme.text);
    for arm in [half, egui::vec2(half.x, -half.y)] {
        ui.painter().line_segment([rect.center() - arm, rect.center() + arm], stroke);
    }
    response.named(Role::Button, name).on_hover_text(tip)
}

pub(in crate::ui) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Formats a number ≥ 0 with at most five significant digits.
pub(in crate::ui) fn five_digits(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e5).contains(&number) {
        return format!("{number:.1e}");
    }
    let unit = 10_f64.powf((4.0 - number.log10().floor()).clamp(0.0, 4.0));
    ((number * unit).round() / unit).to_string()
}

/// Formats a number with four significant digits.
pub(in crate::ui) fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".to_owned(),
        1e-3..1e-2 => format!("{value:.6}"),
        1e-2..0.1 => format!("{value:.5}"),
        0.1..1.0 => format!("{value:.4}"),
        1.0..10.0 => format!("{value:.3}"),
        10.0..100.0 => format!("{value:.2}"),
        100.0..1e3 => format!("{value:.1}"),
        1e3..1e5 => format!("{value:.0}"),
        _ => format!("{value:.3e}"),
    }
}

/// Capitalises the first letter.
pub fn sentence(words: &str) -> String {
    // A message may begin with a file name, which keeps its spelling.
    if words.split(' ').next().is_some_and(|first| first.contains(['.', '/', '\\'])) {
        return words.to_owned();
    }
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_four_digits_that_mean_something() {
        let expected = [
            (0.0, "0"),
            (0.001_234_56, "0.001235"),
            (-0.412_345, "-0.4123"),
            (1.0, "1.000"),
            (31.415_9, "31.42"),
            (2_718.28, "2718"),
            (1.234_1e-7, "1.234e-7"),
            (f64::INFINITY, "inf"),
        ];
        for (value, words) in expected {
            assert_eq!(short(value), words);
        }
    }
}
