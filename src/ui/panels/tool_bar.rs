//! Bar at the left: the tools of the left mouse button, and the work on the charts of the page.

use eframe::egui::scroll_area::ScrollBarVisibility;
use eframe::egui::{
    self, Align2, Color32, FontId, Rect, RectAlign, Role, ScrollArea, Sense, TextStyle, Tooltip, Vec2, WidgetInfo,
};

use crate::ui::state::{GestureKind, PageRequest};
use crate::ui::theme::{HOVERED, SELECTED};
use crate::ui::{Editor, Request, Tool, icons, theme_of, tip_with_keys};

/// Height beside the panes and the timeline from which names stand below the icons, points: room for both groups, also
/// with the curves of the timeline.
const NAMES_FROM: f32 = 610.0;

/// Widths of the bar with names and without, points.
const WIDTHS: [f32; 2] = [64.0, 44.0];

/// Size of a button with its name, points.
const NAMED: Vec2 = Vec2::new(56.0, 44.0);

/// Size of a button without its name, points.
const NAMELESS: Vec2 = Vec2::splat(28.0);

/// Side of an icon above its name, points.
const ICON: f32 = 28.0;

/// Width of the bar, points, in a window with this height for it and the timeline.
pub(in crate::ui) fn tool_bar_width(height: f32) -> f32 {
    WIDTHS[usize::from(height < NAMES_FROM)]
}

/// Button of the bar.
struct ToolButton<'a> {
    /// Short name below the icon.
    name: &'a str,
    /// Accessible name, and tooltip without keys.
    about: &'a str,
    /// True for the tool in use, and `None` for a command.
    is_on: Option<bool>,
    /// Reason why the button is disabled.
    hindrance: Option<&'static str>,
    request: Request,
}

pub(in crate::ui) fn tool_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let has_names = ui.available_width() > NAMELESS.x + 12.0;
    ui.spacing_mut().item_spacing.y = 4.0;
    // A low window scrolls the bar.
    let area = ScrollArea::vertical().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden);
    area.show(ui, |ui| tools(ui, editor, has_names, requests));
}

fn tools(ui: &mut egui::Ui, editor: &Editor, has_names: bool, requests: &mut Vec<Request>) {
    ui.vertical_centered(|ui| {
        for tool in Tool::ALL {
            let [_, name, _, about] = tool.words();
            let is_on = Some(editor.tools.tool() == tool);
            let button = ToolButton { name, about, is_on, hindrance: None, request: Request::SetTool(tool) };
            show(ui, button, has_names, &|painter, icon, colour| icons::tool(painter, icon, tool, colour), requests);
        }
        if editor.shows_page() {
            ui.separator();
            chart_tools(ui, editor, has_names, requests);
        }
    });
}

/// Second group: moves of the selected charts, and packing.
fn chart_tools(ui: &mut egui::Ui, editor: &Editor, has_names: bool, requests: &mut Vec<Request>) {
    let hindrance = editor.movable_charts().is_empty().then_some("Select charts of the page that are not locked first");
    for kind in GestureKind::ALL {
        let request = PageRequest::Begin(kind).into();
        let button = ToolButton { name: kind.title(), about: kind.about(), is_on: None, hindrance, request };
        show(ui, button, has_names, &|painter, icon, colour| icons::gesture(painter, icon, kind, colour), requests);
    }
    let button = ToolButton {
        name: "Pack",
        about: "Pack the selected charts around the others, or all if none is selected",
        is_on: None,
        hindrance: editor.pack_hindrance(),
        request: PageRequest::Pack.into(),
    };
    show(ui, button, has_names, &icons::pack, requests);
}

fn show(
    ui: &mut egui::Ui,
    button: ToolButton<'_>,
    has_names: bool,
    icon: &dyn Fn(&egui::Painter, Rect, Color32),
    requests: &mut Vec<Request>,
) {
    let ToolButton { name, about, is_on, hindrance, request } = button;
    let (size, enabled) = (if has_names { NAMED } else { NAMELESS }, hindrance.is_none());
    let (rect, response) = ui.allocate_exact_size(size, if enabled { Sense::click() } else { Sense::hover() });
    response.widget_info(|| match is_on {
        Some(is_on) => WidgetInfo::selected(Role::Button, enabled, is_on, about),
        None => WidgetInfo::labeled(Role::Button, enabled, about),
    });
    let (theme, is_on) = (theme_of(ui), is_on == Some(true));
    if is_on || (enabled && response.hovered()) {
        let share = if is_on { SELECTED } else { HOVERED };
        ui.painter().rect_filled(rect, 5.0, theme.accent.gamma_multiply(share));
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 5.0, egui::Stroke::new(1.0, theme.accent), egui::StrokeKind::Inside);
    }
    let colour = match (is_on, enabled) {
        (true, _) => theme.accent,
        (false, true) => theme.text,
        (false, false) => theme.weak_text,
    };
    let width = if has_names { ICON } else { NAMELESS.x };
    icon(ui.painter(), Rect::from_min_size(rect.center_top() - Vec2::X * width / 2.0, Vec2::splat(width)), colour);
    if has_names {
        let font: FontId = TextStyle::Small.resolve(ui.style());
        ui.painter().text(rect.center_bottom() - Vec2::Y * 2.0, Align2::CENTER_BOTTOM, name, font, colour);
    }
    let tip = hindrance.map_or_else(|| tip_with_keys(ui, about, &request), str::to_owned);
    // Beside the bar: a tooltip below the button would cover the next ones.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::RIGHT);
    tooltip.show(|ui| ui.label(tip));
    if response.clicked() && enabled {
        requests.push(request);
    }
}
