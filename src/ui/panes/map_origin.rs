//! Line over the embedding of an opened mesh: origin of its map, and a menu of other maps.

use eframe::egui::{self, Button, Rect, Role, Vec2};

use crate::session::{Action, LayoutCheckState, MapOrigin, Session};
use crate::ui::{Control, Editor, Request, Tab, Tool, close_button, counted, theme_of, tip_with_keys};
use freebound_core::mesh::Repair;

/// Gap between the line and the edges of the pane, points.
const GAP: f32 = 8.0;

/// Least width of a pane with such a line, points.
const LEAST_WIDTH: f32 = 200.0;

/// Side of the close button, points.
const CLOSE: f32 = 16.0;

/// Shows the line at the upper left corner of the pane.
pub(super) fn chip(ui: &egui::Ui, rect: Rect, editor: &Editor, requests: &mut Vec<Request>) {
    let origin = editor.opened.map_origin(&editor.session).filter(|_| rect.width() >= LEAST_WIDTH);
    // Clicks of other tools need the whole pane.
    let is_free = editor.tools.tool() == Tool::Select && editor.plane.hull_scene().is_none();
    let Some(origin) = origin.filter(|_| is_free && editor.session.busy().is_none()) else { return };
    let area = egui::Area::new(egui::Id::unique("map origin")).movable(false).order(egui::Order::Middle);
    let area = area.fixed_pos(rect.min + Vec2::splat(GAP)).constrain_to(rect);
    let theme = theme_of(ui);
    area.show(ui.ctx(), |ui| {
        let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.92)).corner_radius(4);
        frame.inner_margin(egui::Margin::symmetric(8, 4)).show(ui, |ui| {
            ui.set_max_width(rect.width() - 2.0 * GAP - 16.0);
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 8.0;
                let room = ui.available_width() - 96.0;
                ui.scope(|ui| {
                    ui.set_max_width(room);
                    ui.add(egui::Label::new(words(origin, &editor.session)).truncate());
                });
                menu(ui, origin, &editor.session, requests);
                let (square, _) = ui.allocate_exact_size(Vec2::splat(CLOSE), egui::Sense::hover());
                let names = ["Close the line on the map", "Close this line"];
                close_button(ui, ui.scope_id().with("close"), square, names).asks(Request::CloseMapOrigin, requests);
            });
        });
    });
}

/// Origin of the map, with the number of charts.
fn words(origin: MapOrigin, session: &Session) -> String {
    let charts = session.charts().map(|charts| counted(charts.count(), "chart", "charts"));
    let in_charts = charts.map_or_else(String::new, |charts| format!(", {charts}"));
    let own = match origin {
        MapOrigin::FileLayout => return format!("Layout of the file{in_charts}"),
        MapOrigin::FromLayout => return format!("Relaxed layout of the file{in_charts}"),
        MapOrigin::AutomaticSeams(0) if is_cut_open(session) => {
            "Flattened after a repair that cut edges open".to_owned()
        }
        MapOrigin::AutomaticSeams(0) => "Flattened without seams".to_owned(),
        MapOrigin::AutomaticSeams(edges) => format!("Unwrapped: {}", counted(edges, "seam edge", "seam edges")),
        MapOrigin::ChosenSeams => "Flattened along chosen seams".to_owned(),
        MapOrigin::Plain => "Flattened as it is".to_owned(),
    };
    let replaced = if has_faulty_layout(session) { "; the layout of the file is not one-to-one" } else { "" };
    format!("{own}{in_charts}{replaced}")
}

/// True if a repair cut edges open.
fn is_cut_open(session: &Session) -> bool {
    let repaired = session.model().and_then(|model| model.prepared.repaired.as_ref());
    repaired.is_some_and(|repaired| repaired.done().iter().any(|done| done.repair == Repair::Cut))
}

/// True if the layout of the file is known not to be one-to-one.
fn has_faulty_layout(session: &Session) -> bool {
    matches!(session.layout_check(), Some(LayoutCheckState::Done(found)) if !found.planar)
}

/// Menu of other maps for the mesh.
fn menu(ui: &mut egui::Ui, origin: MapOrigin, session: &Session, requests: &mut Vec<Request>) {
    let button = ui.menu_button("Change…", |ui| {
        if matches!(origin, MapOrigin::AutomaticSeams(_)) {
            let tip = "Choose between few seams and little distortion, in the Charts tab";
            entry(ui, true, ["More or fewer seams", tip], Request::ShowTab(Tab::Charts), requests);
            let tip = "Keep only the seams without which the mesh cannot lie flat";
            let seams = session.seams().without_automatic();
            entry(ui, true, ["As few seams as possible", tip], Action::SetSeams(seams).into(), requests);
        } else {
            let is_layout = matches!(origin, MapOrigin::FileLayout | MapOrigin::FromLayout);
            let again = if is_layout { "Unwrap again" } else { "Unwrap" };
            let tip = "Cut the mesh along short seams, so that its map has little distortion";
            entry(ui, session.can_unwrap(), [again, tip], Action::Unwrap(None).into(), requests);
        }
        if origin != MapOrigin::FileLayout && session.model().is_some_and(|model| model.source.texture.is_some()) {
            let tip = "Show the texture coordinates of the file as they are, faults included";
            entry(ui, true, ["Layout of the file", tip], Action::TakeLayout.into(), requests);
        }
        let tip = "Choose the method, the weights and the treatment of holes, in the Method tab";
        entry(ui, true, ["Other method", tip], Request::ShowTab(Tab::Method), requests);
    });
    let response = button.response.named(Role::Button, "Change the map");
    response.on_hover_text("Choose another map for the mesh; undo returns to this one");
}

fn entry(ui: &mut egui::Ui, enabled: bool, [words, tip]: [&str; 2], request: Request, requests: &mut Vec<Request>) {
    let tip = tip_with_keys(ui, tip, &request);
    if ui.add_enabled(enabled, Button::new(words)).on_hover_text(tip).asks(request, requests) {
        ui.close();
    }
}
