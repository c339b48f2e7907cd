//! The tool bar at the left.

use eframe::egui::{self, Role, Sense, Vec2, WidgetInfo};

use crate::ui::{Control, icons, theme_of, tip_with_keys};
use crate::ui::{Editor, Request, Tool};

/// Side of a tool's button, points.
const BUTTON: f32 = 32.0;

pub(in crate::ui) fn tool_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.vertical_centered(|ui| {
        for tool in Tool::ALL {
            let (rect, response) = ui.allocate_exact_size(Vec2::splat(BUTTON), Sense::click());
            let on = editor.tools.tool() == tool;
            let about = tool.words()[2];
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, about));
            let theme = theme_of(ui);
            if on || response.hovered() {
                let share = if on { 0.22 } else { 0.10 };
                ui.painter().rect_filled(rect, 5.0, theme.accent.gamma_multiply(share));
            }
            if response.has_focus() {
                ui.painter().rect_stroke(rect, 5.0, egui::Stroke::new(1.0, theme.accent), egui::StrokeKind::Inside);
            }
            let colour = if on { theme.accent } else { theme.text };
            icons::tool(ui.painter(), rect, tool, colour);
            let request = Request::SetTool(tool);
            response.on_hover_text(tip_with_keys(ui, about, &request)).asks(request, requests);
        }
    });
}
