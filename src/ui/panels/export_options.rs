//! Windows with the options of an export: a cutting pattern, and a picture drawn for the layout.

use eframe::egui::{self, Align2, DragValue, Grid, Role};

use crate::ui::editor::BakeChoice;
use crate::ui::state::{ExportOptions, FileDialogKind, NO_LAYOUT_PICTURE, NO_MAP};
use crate::ui::{Control, Editor, Request, accented_if, dialog_buttons, list, option_list, theme_of};
use freebound_core::geom::Picture;
use freebound_io::PatternOptions;

/// Width of the sheet when it is first limited, millimetres.
const FIRST_WIDTH: f64 = 900.0;

/// Sides of square pictures, pixels.
const SIDES: [u32; 5] = [512, 1024, 2048, 4096, 8192];

/// Widest margin around charts, pixels.
const WIDEST_MARGIN: u32 = 64;

/// Shows the window of an export's options if it is open.
pub(super) fn export_options(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let Some(shown) = editor.files.options_shown else { return };
    let (title, words, dialog) = match shown {
        ExportOptions::Pattern => (
            "Cutting pattern",
            "Every chart in true size, to be cut out and joined along its seams.",
            FileDialogKind::Pattern,
        ),
        ExportOptions::Baked => (
            "Picture for this layout",
            "The picture of the file's own layout, drawn anew for the layout on the screen. For colours, not for normal maps.",
            FileDialogKind::Baked,
        ),
    };
    let solved = editor.session.outcome().is_some();
    let mut is_open = true;
    let window = egui::Window::new(title).open(&mut is_open).collapsible(false).auto_sized();
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        ui.set_max_width(340.0);
        ui.weak(words);
        ui.add_space(4.0);
        Grid::new(title).num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| match shown {
            ExportOptions::Pattern => rows(ui, &mut editor.files.pattern),
            ExportOptions::Baked => {
                let picture = editor.session.document().picture.clone();
                picture_rows(ui, picture.as_ref().map(|picture| &*picture.pixels), &mut editor.files.baked);
            }
        });
        ui.add_space(8.0);
        dialog_buttons(ui, |ui| {
            let theme = theme_of(ui);
            let name = format!("Export: {title}…");
            let is_possible = solved && (shown == ExportOptions::Pattern || editor.session.can_bake());
            let export = accented_if(ui, is_possible, "Export…", theme).named(Role::Button, &name);
            let tip = match shown {
                ExportOptions::Pattern => "PDF, SVG or DXF, by the end of the name",
                ExportOptions::Baked => "A PNG picture",
            };
            let lacks = if solved { NO_LAYOUT_PICTURE } else { NO_MAP };
            export.on_hover_text(tip).on_disabled_hover_text(lacks).asks(Request::Ask(dialog), requests);
            ui.button("Cancel").asks(Request::ToggleOptions(shown), requests);
        });
    });
    if !is_open {
        editor.files.options_shown = None;
    }
}

/// Options of a picture drawn for the layout.
fn picture_rows(ui: &mut egui::Ui, picture: Option<&Picture>, choice: &mut BakeChoice) {
    let title = |side: Option<u32>| match (side, picture) {
        (Some(side), _) => format!("{side} × {side}"),
        (None, Some(picture)) => format!("As it is: {} × {}", picture.width, picture.height),
        (None, None) => "As it is".to_owned(),
    };
    ui.label("Size in pixels");
    let sizes = std::iter::once(None).chain(SIDES.map(Some));
    let list = list(ui, "Size in pixels", 150.0, &title(choice.side), |ui| {
        for side in sizes {
            if ui.selectable_label(choice.side == side, title(side)).clicked() {
                choice.side = side;
            }
        }
    });
    list.on_hover_text("Width and height of the new picture");
    ui.end_row();
    ui.label("Margin");
    let tip = "Pixels around the charts that continue their colours, so that no background shows at seams";
    let field = DragValue::new(&mut choice.margin).range(0..=WIDEST_MARGIN).speed(0.2).suffix(" px");
    ui.add(field).named(Role::SpinButton, "Margin").on_hover_text(tip);
    ui.end_row();
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
