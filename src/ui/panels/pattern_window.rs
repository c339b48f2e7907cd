//! Window with the options of a cutting pattern.

use eframe::egui::{self, Align2, DragValue, Grid, Role};

use crate::ui::state::FileDialogKind;
use crate::ui::{Control, Editor, Request, accented, option_list, theme_of};
use freebound_io::PatternOptions;

/// Width of the sheet when it is first limited, millimetres.
const FIRST_WIDTH: f64 = 900.0;

/// Shows the window if it is open.
pub(super) fn pattern_window(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let solved = editor.session.outcome().is_some();
    let pattern = &mut editor.files.pattern;
    let mut is_open = pattern.is_shown;
    let window = egui::Window::new("Cutting pattern").open(&mut is_open).collapsible(false).auto_sized();
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        ui.set_max_width(340.0);
        ui.weak("Every chart in true size, to be cut out and joined along its seams.");
        ui.add_space(4.0);
        Grid::new("pattern").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| rows(ui, &mut pattern.options));
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let theme = theme_of(ui);
            let export = ui.add_enabled(solved, accented("Export…", theme)).named(Role::Button, "Export the pattern…");
            let tip = "PDF, SVG or DXF, by the end of the name";
            let export =
                export.on_hover_text(tip).on_disabled_hover_text("There is nothing to export yet: open a mesh");
            export.asks(Request::Ask(FileDialogKind::Pattern), requests);
            ui.button("Cancel").asks(Request::TogglePattern, requests);
        });
    });
    editor.files.pattern.is_shown &= is_open;
}

fn rows(ui: &mut egui::Ui, options: &mut PatternOptions) {
    ui.label("Unit of the mesh");
    option_list(ui, "Unit of the mesh", "Length of one unit of the mesh", &mut options.unit);
    ui.end_row();
    ui.label("Seam allowance");
    millimetres(
        ui,
        "Seam allowance",
        "Distance from the sewing line to the cutting line; 0 for none",
        &mut options.allowance,
    );
    ui.end_row();
    ui.label("Corners");
    let tip = "Shape of the seam allowance at corners";
    ui.add_enabled_ui(options.allowance > 0.0, |ui| option_list(ui, "Corners", tip, &mut options.joins));
    ui.end_row();
    ui.label("Notches every");
    let before = options.notches;
    let tip = "Distance between marks that meet on both sides of a seam; 0 for none";
    millimetres(ui, "Notches every", tip, &mut options.notches);
    if options.notches > 0.0 && options.notches < PatternOptions::NEAREST_NOTCHES {
        // Between 0 and the least distance there is nothing: the field jumps over it.
        options.notches = if before > options.notches { 0.0 } else { PatternOptions::NEAREST_NOTCHES };
    }
    ui.end_row();
    ui.label("Paper (PDF)");
    option_list(ui, "Paper", "Pages of a PDF document", &mut options.paper);
    ui.end_row();
    let mut is_limited = options.sheet_width.is_some();
    let switch = ui.checkbox(&mut is_limited, "Sheet width");
    let tip = "Width of the cloth or sheet that the pieces are laid on. Off: a sheet that is nearly square";
    if switch.on_hover_text(tip).changed() {
        options.sheet_width = is_limited.then_some(FIRST_WIDTH);
    }
    match &mut options.sheet_width {
        Some(width) => {
            millimetres(ui, "Width of the sheet", tip, width);
            // A sheet has some width.
            *width = width.max(1.0);
        }
        None => {
            ui.weak("as needed");
        }
    }
    ui.end_row();
}

/// Field for a length in millimetres.
fn millimetres(ui: &mut egui::Ui, name: &str, tip: &str, value: &mut f64) {
    let field = DragValue::new(value).range(0.0..=PatternOptions::LONGEST).speed(0.5).max_decimals(2).suffix(" mm");
    ui.add(field).named(Role::SpinButton, name).on_hover_text(tip);
}
