//! Bar at the top: menus, name of the document, and the verdict.

use eframe::egui::{self, Button, RichText, Role, WidgetInfo};

use super::advice::advice;
use super::quality::quality;
use super::verdict_pill::verdict_pill;
use crate::ui::commands::{self, MENUS, Mark, MenuCommand, MenuNode};
use crate::ui::{Control, Editor, FileDialogKind, Request, icons, keys_of, theme_of};
use freebound_io::OutputKind;

/// Indentation of a menu entry that may have a check mark.
const ROOM_FOR_MARK: &str = "      ";

pub(in crate::ui) fn top_bar(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let asked = editor.layout.menu_asked.take();
    let editor = &*editor;
    let bar = ui.max_rect();
    ui.horizontal_centered(|ui| {
        let menus = egui::MenuBar::new().ui(ui, |ui| {
            let responses: Vec<egui::Response> = (MENUS.iter().enumerate())
                .map(|(place, (title, _))| {
                    ui.menu_button(*title, |ui| nodes_ui(ui, commands::menu(editor, place), requests)).response
                })
                .collect();
            let asked = asked.or_else(|| menu_beside(ui.ctx(), &responses));
            if let Some(response) = asked.and_then(|place| responses.get(place)) {
                // Focus the title of the menu, so that the arrow keys lead into the menu.
                response.request_focus();
                response.ctx.request_repaint();
                egui::Popup::open_id(&response.ctx, egui::Popup::default_response_id(response));
            }
            responses.last().map_or(bar.left(), |last| last.rect.right())
        });
        let right = ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(4.0);
            let panels = ui.selectable_label(editor.layout.panels_shown(), "Panels");
            panels.on_hover_text("Show or hide the panels at the right").asks(Request::TogglePanels, requests);
            export_button(ui, editor, requests);
            verdict_pill(ui, editor, requests);
            quality(ui, editor, requests);
            advice(ui, editor, requests);
            ui.min_rect().left()
        });
        title_between(ui, bar, menus.inner..=right.inner, &title(editor));
    });
}

/// Menu that the arrow keys lead to from an open menu.
fn menu_beside(context: &egui::Context, responses: &[egui::Response]) -> Option<usize> {
    let is_open =
        |response: &egui::Response| egui::Popup::is_id_open(context, egui::Popup::default_response_id(response));
    let open = responses.iter().position(is_open)?;
    let by = context.input_mut(|input| {
        let mut count = |key| input.count_and_consume_key(egui::Modifiers::NONE, key).cast_signed();
        count(egui::Key::ArrowRight) - count(egui::Key::ArrowLeft)
    });
    let count = responses.len().cast_signed();
    (by != 0).then(|| (open.cast_signed() + by).rem_euclid(count).cast_unsigned())
}

/// Button that writes the mesh with its texture coordinates, in the format of its file. Hidden in a narrow window.
fn export_button(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.layout.is_narrow() {
        return;
    }
    let path = editor.session.model().and_then(|model| model.path.as_deref());
    let kind = path.map_or(OutputKind::Obj, OutputKind::of_mesh);
    let button = ui.add_enabled(editor.session.outcome().is_some(), Button::new("Export"));
    let keys = keys_of(ui.ctx(), &Request::ToggleExports);
    let tip = format!("Write the mesh with its texture coordinates ({keys} lists all exports)");
    let button = button.named(egui::Role::Button, "Export the mesh").on_hover_text(tip);
    button.asks(Request::Ask(FileDialogKind::Export(kind, None)), requests);
}

/// Name of the document, in the middle of the bar if menus and verdict leave room.
fn title_between(ui: &egui::Ui, bar: egui::Rect, room: std::ops::RangeInclusive<f32>, words: &str) {
    let text = egui::WidgetText::from(RichText::new(words).color(theme_of(ui).weak_text));
    let width = room.end() - room.start() - 24.0;
    if width < 40.0 {
        return;
    }
    let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), width, egui::TextStyle::Body);
    let half = galley.size() / 2.0;
    let leftmost = room.start() + 12.0 + half.x;
    let middle = bar.center().x.clamp(leftmost, (room.end() - 12.0 - half.x).max(leftmost));
    let place = egui::Rect::from_center_size(egui::pos2(middle, bar.center().y), galley.size());
    let response = ui.interact(place, ui.scope_id().with("title"), egui::Sense::hover());
    response.named(Role::Label, words);
    ui.painter().galley(egui::pos2(middle - half.x, bar.center().y - half.y), galley, theme_of(ui).weak_text);
}

/// Entries of a menu.
fn nodes_ui(ui: &mut egui::Ui, nodes: Vec<MenuNode>, requests: &mut Vec<Request>) {
    for node in nodes {
        match node {
            MenuNode::Entry(command) => entry_ui(ui, *command, requests),
            MenuNode::Submenu { title, nodes } => {
                ui.menu_button(title, |ui| nodes_ui(ui, nodes, requests));
            }
            MenuNode::Separator => drop(ui.separator()),
            MenuNode::Remark(words) => drop(ui.weak(words)),
        }
    }
}

/// Entry with its shortcut. A disabled entry says in its tooltip why.
fn entry_ui(ui: &mut egui::Ui, command: MenuCommand, requests: &mut Vec<Request>) {
    let keys = keys_of(ui.ctx(), command.request_of_keys());
    let MenuCommand { words, tip, request, gate, mark, .. } = command;
    let button = match mark {
        Mark::None => Button::new(&words),
        Mark::Choice(on) => Button::selectable(on, &words),
        Mark::Switch(_) => Button::new(format!("{ROOM_FOR_MARK}{words}")),
    };
    // A tooltip and a shortcut would not fit beside each other in a narrow window.
    let button = if tip.is_some() { button } else { button.shortcut_text(keys) };
    let mut response = ui.add_enabled(gate.is_ok(), button);
    if let Mark::Switch(on) = mark {
        if on {
            let middle = response.rect.left_center() + egui::vec2(14.0, 0.0);
            let square = egui::Rect::from_center_size(middle, egui::Vec2::splat(11.0));
            icons::check(ui.painter(), square, theme_of(ui).text);
        }
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, &words));
    }
    if let Some(tip) = tip {
        response = response.on_hover_text(tip);
    }
    if let Err(reason) = gate {
        response = response.on_disabled_hover_text(reason);
    }
    if response.asks(request, requests) {
        ui.close();
    }
}

/// Name of the document, and numbers of vertices and faces.
fn title(editor: &Editor) -> String {
    let Some(model) = editor.session.model() else { return "Freebound".to_owned() };
    let name = editor.marked_name();
    if let Some(charts) = editor.session.charts().filter(|_| editor.shows_page()) {
        let polygons = &model.source.polygons;
        let counts = [charts.count(), polygons.positions.len(), polygons.face_count()].map(grouped);
        return format!("{name} · {} charts · {} v · {} f", counts[0], counts[1], counts[2]);
    }
    // Faces are those of the file in every title and list: polygons, as they are written.
    let shown = model.prepared.chart.as_ref();
    let chart = shown.map(|of| format!(" · chart {}", of.number)).unwrap_or_default();
    let faces = shown.map_or(model.source.polygons.face_count(), |of| of.charts.faces(of.number).len());
    let counts = [model.vertex_count(), faces].map(grouped);
    format!("{name}{chart} · {} v · {} f", counts[0], counts[1])
}

/// Formats a count with its thousands separated by spaces.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let groups = digits.as_bytes().rchunks(3).rev();
    groups.map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
}
