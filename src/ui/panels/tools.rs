//! The tool bar at the left.

use eframe::egui;
use egui::{Role, Sense, Vec2, WidgetInfo};

use crate::ui::icons;
use crate::ui::theme::theme_of;
use crate::ui::{Editor, Request, Tool, keys_of};

/// Side of a tool's button, points.
const BUTTON: f32 = 32.0;

/// The tools with their names.
const TOOLS: [(Tool, &str); 3] = [
    (Tool::Select, "Select vertices"),
    (Tool::Fix, "Fix: pin a vertex where it lies"),
    (Tool::Constrain, "Constrain: join a vertex with its place"),
];

/// Shows the tools.
pub(in crate::ui) fn tool_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.vertical_centered(|ui| {
        for (tool, name) in TOOLS {
            let (rect, response) = ui.allocate_exact_size(Vec2::splat(BUTTON), Sense::click());
            let on = editor.tool == tool;
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, name));
            let theme = theme_of(ui);
            if on || response.hovered() {
                let share = if on { 0.22 } else { 0.10 };
                ui.painter().rect_filled(rect, 5.0, theme.accent.gamma_multiply(share));
            }
            if response.has_focus() {
                ui.painter().rect_stroke(rect, 5.0, egui::Stroke::new(1.0, theme.accent), egui::StrokeKind::Inside);
            }
            let colour = if on { theme.accent } else { theme.text };
            match tool {
                Tool::Select => icons::pointer(ui.painter(), rect, colour),
                Tool::Fix => icons::pin(ui.painter(), rect, colour),
                Tool::Constrain => icons::pair(ui.painter(), rect, colour),
            }
            let request = Request::SetTool(tool);
            let tip = format!("{name} ({})", keys_of(ui.ctx(), &request));
            if response.on_hover_text(tip).clicked() {
                requests.push(request);
            }
        }
    });
}
