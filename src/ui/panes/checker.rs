//! Rows of the shading menu that set the squares of the checker.

use eframe::egui::{self, DragValue, Role};

use crate::ui::state::SQUARES;
use crate::ui::{CheckerRequest, CheckerStyle, Control, Editor, Request, Typed, remark};

/// Style and number of the squares.
pub(super) fn rows(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let checker = &editor.pane_shading.checker;
    ui.separator();
    remark(ui, "Squares of the checker");
    for style in CheckerStyle::ALL {
        let [words, tip] = style.words();
        let entry = ui.selectable_label(checker.style() == style, words).on_hover_text(tip);
        if entry.asks(CheckerRequest::SetStyle(style), requests) && style == CheckerStyle::Picture {
            ui.close();
        }
    }
    ui.horizontal(|ui| {
        let shown = editor.squares_shown();
        let [least, most] = SQUARES;
        step(ui, ["−", "Fewer squares along the page"], shown > least, CheckerRequest::Coarser, requests);
        number(ui, shown, requests);
        step(ui, ["+", "More squares along the page"], shown < most, CheckerRequest::Finer, requests);
        let auto = ui.selectable_label(checker.squares().is_none(), "Auto").named(Role::Button, "Automatic squares");
        let auto = auto.on_hover_text("Number of squares that suits the page or the chart on the screen");
        auto.asks(CheckerRequest::SetSquares(None), requests);
    });
}

/// Button that halves or doubles the number.
fn step(
    ui: &mut egui::Ui,
    [sign, name]: [&str; 2],
    is_possible: bool,
    request: CheckerRequest,
    requests: &mut Vec<Request>,
) {
    let button = ui.add_enabled(is_possible, egui::Button::new(sign).min_size(egui::Vec2::splat(22.0)));
    button.named(Role::Button, name).on_hover_text(name).asks(request, requests);
}

/// Typed number of squares.
fn number(ui: &mut egui::Ui, shown: u32, requests: &mut Vec<Request>) {
    let [least, most] = SQUARES;
    let mut count = shown;
    let typed = Typed::new("the number of squares", f64::from(least)..=f64::from(most)).whole();
    let field = DragValue::new(&mut count).range(least..=most).speed(0).update_while_editing(false);
    let field = ui.add(field.custom_parser(|text| typed.number(text)));
    let field = typed.name(ui, field, "Squares along the page");
    let tip = "Squares along the page, or across one chart: a power of two from 4 to 256";
    if field.on_hover_text(tip).changed() && count != shown {
        requests.push(CheckerRequest::SetSquares(Some(count)).into());
    }
}
