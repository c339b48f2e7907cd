//! Complete window: bars, panels, panes, and keyboard.

use eframe::egui::{self, Frame, Margin, Panel, Rect, Sense, Vec2};

use super::theme::{BOTTOM_HEIGHT, PANEL_WIDTHS, TOP_HEIGHT, theme_of};
use super::{Editor, Intent, Pane, Request, keyboard};
use crate::ui::panels::{self, floating, menu, status, unsaved, welcome};
use crate::ui::panes::comparison::comparison_ui;
use crate::ui::panes::constrain;
use crate::ui::panes::mesh_pane::mesh_pane_ui;
use crate::ui::panes::plane_pane::plane_pane_ui;
use crate::ui::timeline::{CURVES_FROM, timeline_ui};

/// Width of the splitter between the panes, points.
const SPLITTER: f32 = 6.0;

/// Shows the window and carries out the collected requests.
pub fn window_ui(ui: &mut egui::Ui, editor: &mut Editor) {
    editor.poll();
    unsaved::hold_window(ui.ctx(), editor);
    let mut requests = keyboard::requests(ui.ctx(), editor);
    // Before the panes are shown: egui ends a drag at Esc, and the pane would forget the dragged pin.
    for escape in requests.extract_if(.., |request| *request == Request::Escape) {
        editor.handle(escape);
    }
    requests.extend(dropped_files(ui));
    let fill = theme_of(ui).panel;
    let bar = Frame::new().fill(fill).inner_margin(Margin::symmetric(8, 0));
    Panel::top("top").exact_size(TOP_HEIGHT).frame(bar).show(ui, |ui| menu::top_bar(ui, editor, &mut requests));
    Panel::bottom("bottom").exact_size(BOTTOM_HEIGHT).frame(bar).show(ui, |ui| status::status_bar(ui, editor));
    let tools_width = panels::tool_bar_width(ui.available_height());
    editor.layout.set_width(ui.available_width() - tools_width);
    editor.timeline.window_is_high = ui.available_height() >= CURVES_FROM;
    if editor.layout.panels_shown() {
        let frame = Frame::new().fill(fill).inner_margin(Margin::symmetric(12, 8));
        let panel = Panel::right("panels").default_size(editor.layout.panel_width()).size_range(PANEL_WIDTHS);
        let shown = panel.frame(frame).show(ui, |ui| within(ui, |ui| panels::side_panel(ui, editor, &mut requests)));
        editor.layout.set_panel_width(shown.response.rect.width());
    }
    if editor.has_disk() && !editor.shows_comparison_alone() {
        Panel::bottom("timeline")
            .exact_size(editor.timeline.height())
            .frame(bar)
            .show(ui, |ui| timeline_ui(ui, editor, &mut requests));
    }
    let tool_frame = Frame::new().fill(fill).inner_margin(Margin::symmetric(4, 8));
    Panel::left("tools")
        .exact_size(tools_width)
        .resizable(false)
        .frame(tool_frame)
        .show(ui, |ui| panels::tool_bar(ui, editor, &mut requests));
    editor.pointer.begin_frame();
    editor.tools.set_intent(Intent::Nothing);
    editor.mesh.pane.hide();
    editor.plane.pane.hide();
    editor.plane.page.pane.hide();
    egui::CentralPanel::default().frame(Frame::new().fill(fill)).show(ui, |ui| panes(ui, editor, &mut requests));
    if editor.pointer.pane().is_none() && editor.tools.dragged().is_none() {
        // Only now: the pane drawn first shows the vertex found in the other pane.
        editor.pointer.set_vertex(None);
        editor.pointer.set_element(None);
        editor.tools.seam.set_under(None);
        editor.plane.page.set_hovered(None);
    }
    constrain::line_across(ui, editor);
    floating::floating_windows(ui.ctx(), editor, &mut requests);
    welcome::welcome(ui.ctx(), editor, &mut requests);
    for request in requests {
        editor.handle(request);
    }
    unsaved::title_of_window(editor);
    if editor.gpu.is_quitting() {
        ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

/// Adds contents within the available room, even if they want more.
fn within(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    let room = ui.available_rect_before_wrap();
    let mut part = ui.new_child(egui::UiBuilder::new().max_rect(room));
    part.set_clip_rect(room.expand(4.0).intersect(ui.clip_rect()));
    add(&mut part);
    ui.advance_cursor_after_rect(room);
}

/// Two panes with a splitter between them, or one pane alone.
fn panes(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let all = ui.available_rect_before_wrap();
    let part = |ui: &mut egui::Ui, rect: Rect, add: &mut dyn FnMut(&mut egui::Ui)| {
        ui.scope_builder(egui::UiBuilder::new().max_rect(rect), |ui| {
            ui.set_clip_rect(rect.intersect(ui.clip_rect()));
            ui.spacing_mut().item_spacing.y = 0.0;
            add(ui);
        });
    };
    match editor.layout.full() {
        Some(Pane::Mesh) => part(ui, all, &mut |ui| mesh_pane_ui(ui, editor, requests)),
        Some(Pane::Plane) => part(ui, all, &mut |ui| plane(ui, editor, requests)),
        None => {
            let middle = all.left() + all.width() * editor.layout.split();
            let left = Rect::from_min_max(all.min, egui::pos2(middle - SPLITTER / 2.0, all.bottom()));
            let right = Rect::from_min_max(egui::pos2(middle + SPLITTER / 2.0, all.top()), all.max);
            part(ui, left, &mut |ui| mesh_pane_ui(ui, editor, requests));
            part(ui, right, &mut |ui| plane(ui, editor, requests));
            splitter(ui, editor, all, middle);
        }
    }
}

/// Embedding pane, or the method comparison.
fn plane(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    if editor.plane.comparison.is_shown() {
        comparison_ui(ui, editor, requests);
    } else {
        plane_pane_ui(ui, editor, requests);
    }
}

fn splitter(ui: &egui::Ui, editor: &mut Editor, all: Rect, middle: f32) {
    let bar = Rect::from_center_size(egui::pos2(middle, all.center().y), Vec2::new(SPLITTER, all.height()));
    let response = ui.interact(bar, ui.scope_id().with("splitter"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Width of the panes"));
    if response.dragged() {
        editor.layout.set_split((middle + response.drag_delta().x - all.left()) / all.width().max(1.0));
    }
    if response.double_clicked() {
        editor.layout.set_split(0.5);
    }
    let active = response.hovered() || response.dragged();
    if active {
        ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
    }
    let theme = theme_of(ui);
    let colour = if active { theme.accent } else { theme.separator };
    ui.painter().vline(middle, all.y_range(), egui::Stroke::new(1.0, colour));
}

/// Requests for files dropped on the window.
fn dropped_files(ui: &egui::Ui) -> Vec<Request> {
    let paths = |input: &egui::InputState| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect();
    Editor::dropped(ui.input(paths))
}
