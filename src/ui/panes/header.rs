//! Header of a pane: title, shading, switches, full size. A narrow pane omits some.

use eframe::egui::{self, Role};

use crate::ui::{
    Control, Editor, Measure, PageRequest, Pane, Request, SelectionKind, ShadingMode, Tool, open_list, tip_with_keys,
};

use super::checker;

/// Least width of a pane with a title in its header, points.
const ROOM_FOR_TITLE: f32 = 270.0;

/// Least width of a pane with the list of what clicks select in its header, points. The Edit menu has it, too.
const ROOM_FOR_KIND: f32 = 330.0;

/// Least width of a pane with switches in its header, points. Keys and the View menu have them, too.
const ROOM_FOR_SWITCHES: f32 = 190.0;

/// Width of the list of what clicks select, points.
const KIND_WIDTH: f32 = 72.0;

/// Least width of the shading menu in the header, points. The View menu has the shadings, too.
const LEAST_MENU: f32 = 60.0;

/// Title, shading menu, switches and full-size button, if there is room.
pub(super) fn header(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let title = if pane == Pane::Plane && editor.shows_page() { "Layout" } else { pane.title() };
    let room = ui.available_width();
    ui.horizontal(|ui| {
        ui.set_min_height(26.0);
        if room >= ROOM_FOR_TITLE {
            ui.add_space(8.0);
            ui.strong(title);
        } else {
            ui.add_space(4.0);
        }
        if pane == Pane::Plane && editor.session.charts().is_some() {
            page_switch(ui, editor, requests);
        }
        if room >= ROOM_FOR_KIND && (pane == Pane::Mesh || editor.layout.full() == Some(Pane::Plane)) {
            kind_menu(ui, editor, requests);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(4.0);
            let (glyph, words) = match editor.layout.full() {
                Some(_) => ("Both", "Show both panes"),
                None => ("Full", "Show this pane alone"),
            };
            let tip = tip_with_keys(ui, words, &Request::TogglePane);
            let button = ui.add(egui::Button::new(glyph).frame(false)).on_hover_text(tip);
            button.named(Role::Button, &format!("{words}: {title}")).asks(Request::ToggleFull(pane), requests);
            if room >= ROOM_FOR_SWITCHES {
                switches(ui, editor, pane, requests);
            }
            if ui.available_width() >= LEAST_MENU {
                shading_menu(ui, editor, pane, requests);
            }
        });
    });
}

/// Switch between all charts on the page and one chart alone.
fn page_switch(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let shows_page = editor.shows_page() || editor.awaits_page();
    let chart = editor.session.chart_on_screen().unwrap_or_default();
    let (words, about) = if shows_page {
        (format!("Chart {chart}"), "Show this chart alone, to work on its vertices and steps")
    } else {
        ("All charts".to_owned(), "Show all charts as they lie on the page")
    };
    let tip = tip_with_keys(ui, about, &PageRequest::Toggle.into());
    ui.add(egui::Button::new(words).small()).on_hover_text(tip).asks(PageRequest::Show(!shows_page), requests);
}

/// Switches of a pane.
fn switches(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    if pane == Pane::Plane && !editor.shows_page() {
        let tip = tip_with_keys(ui, "Hull and pockets of the virtual boundary", &Request::ToggleHull);
        let switch = ui.selectable_label(editor.plane.hull_shown(), "Hull").on_hover_text(tip);
        switch.asks(Request::ToggleHull, requests);
    }
    if pane == Pane::Mesh && editor.selection.through {
        let tip = "Vertices behind the mesh are picked and selected, too. Click: only those that are seen";
        let tip = tip_with_keys(ui, tip, &Request::ToggleThrough);
        ui.selectable_label(true, "X-ray").on_hover_text(tip).asks(Request::ToggleThrough, requests);
    }
    if pane == Pane::Mesh || editor.layout.full() == Some(Pane::Plane) {
        let tip = tip_with_keys(ui, "Wireframe", &Request::ToggleWireframe);
        let wire = ui.selectable_label(editor.pane_shading.wireframe, "Wire").on_hover_text(tip);
        wire.asks(Request::ToggleWireframe, requests);
    }
}

/// List of what clicks select, if the tool selects.
fn kind_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.tools.tool() != Tool::Select || editor.session.model().is_none() {
        return;
    }
    let now = editor.selection_kind_shown();
    let list = open_list(ui, "What clicks select", KIND_WIDTH, now.words()[0], |ui| {
        let has_charts = editor.session.charts().is_some();
        for kind in SelectionKind::ALL.into_iter().filter(|kind| has_charts || *kind != SelectionKind::Charts) {
            let [title, about] = kind.words();
            let request = Request::SetSelectionKind(kind);
            let tip = tip_with_keys(ui, about, &request);
            if ui.selectable_label(now == kind, title).on_hover_text(tip).asks(request, requests) {
                ui.close();
            }
        }
    });
    list.on_hover_text("What clicks and regions select");
}

fn shading_menu(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let width = ui.spacing().combo_width.min(ui.available_width() - 4.0);
    // Truncate a long name.
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
    let now = editor.shading(pane);
    let name = format!("Shading of the {}", pane.title().to_lowercase());
    let menu = open_list(ui, &name, width, &editor.title_of_shading(now), |ui| {
        for shading in ShadingMode::ALL.into_iter().filter(|shading| shading.is_for(pane)) {
            let [title, about] = shading.words();
            let about = Measure::of_shading(shading).map_or(about, Measure::tip);
            let tip = tip_with_keys(ui, about, &Request::SetShading(shading));
            let entry = ui.selectable_label(now == shading, title).on_hover_text(tip);
            if entry.asks(Request::SetPaneShading(pane, shading), requests) {
                ui.close();
            }
        }
        for (place, title) in editor.files.table.titles().enumerate() {
            let is_shown = now == ShadingMode::Column && editor.files.table.chosen() == Some(place);
            let entry = ui.selectable_label(is_shown, format!("Column: {title}"));
            let entry = entry.on_hover_text("Number of the opened table, in both panes");
            if entry.asks(Request::ShowColumn(place), requests) {
                ui.close();
            }
        }
        checker::rows(ui, editor, requests);
    });
    menu.on_hover_text(
        "Shading of this pane. Number keys set it for the pane under the pointer, or for both panes if it is over \
         neither. The Constrain tool over a picture has its own shadings",
    );
}
