//! Welding of vertices within a distance, with a preview of their number.

use eframe::egui::{self, DragValue};

use super::menu::grouped;
use crate::session::{Action, Model, Session};
use crate::ui::{Control, Request, Typed, counted, five_digits, remark};
use freebound_core::geom::SpaceBounds;
use freebound_core::mesh::WeldDistance;

/// Default distance as a share of the diagonal of the bounding box, then rounded down to a power of ten.
const OFFERED: f64 = 1e-4;

/// Typed distance, for one opening of the session.
#[derive(Clone, Copy)]
struct Kept {
    opening: u64,
    distance: f64,
}

pub(super) fn welding(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(model) = session.model() else { return };
    let now = session.document().form.repair.weld_distance();
    let header = egui::CollapsingHeader::new("Weld within a distance").default_open(now.is_some());
    header.show(ui, |ui| {
        let place = ui.scope_id().with("weld distance");
        let opening = session.opening_revision();
        let kept = ui.data(|data| data.get_temp(place)).filter(|kept: &Kept| kept.opening == opening);
        let mut distance =
            kept.map_or_else(|| now.map_or_else(|| offered(model), WeldDistance::get), |kept| kept.distance);
        field(ui, &mut distance);
        ui.data_mut(|data| data.insert_temp(place, Kept { opening, distance }));
        if let Some(distance) = WeldDistance::new(distance) {
            offer(ui, session, distance, requests);
        }
        if let Some(now) = now {
            ui.horizontal_wrapped(|ui| {
                ui.label(format!("Welded within {}", five_digits(now.get())));
                let tip = "Restore the vertices of the file";
                ui.button("Do not weld").on_hover_text(tip).asks(Action::Weld(None), requests);
            });
        }
    });
}

/// Field for the distance, dragged or typed.
fn field(ui: &mut egui::Ui, distance: &mut f64) {
    ui.horizontal_wrapped(|ui| {
        let typed = Typed::new("a distance", 0.0..=f64::MAX);
        let speed = distance.abs() * 0.02;
        let value = DragValue::new(distance).range(0.0..=f64::MAX).speed(speed);
        let value = value.custom_formatter(|value, _| five_digits(value)).custom_parser(|text| typed.number(text));
        let field = ui.add(value);
        let field = typed.name(ui, field, "Distance of vertices to weld, in the mesh's units");
        field.on_hover_text("Vertices of faces within this distance become one. 0 welds vertices at equal positions");
        ui.label("of the mesh's units");
    });
}

/// Number of vertices that a distance would weld, and the button to weld them.
fn offer(ui: &mut egui::Ui, session: &Session, distance: WeldDistance, requests: &mut Vec<Request>) {
    let Some(count) = session.near_count(distance) else {
        requests.push(Action::CountNear(distance).into());
        remark(ui, "Counting…");
        return;
    };
    ui.vertical(|ui| {
        let is_new = session.document().form.repair.weld_distance() != Some(distance);
        let button = ui.add_enabled(count > 0 && is_new, egui::Button::new("Weld vertices"));
        let tip = "They become one, at the position of the first. The file is not changed; undo reverts this";
        button.on_hover_text(tip).asks(Action::Weld(Some(distance)), requests);
        match count {
            0 => ui.weak("No vertices lie within this distance"),
            1 => ui.weak(counted(count, "vertex will be welded", "")),
            _ => ui.weak(format!("{} vertices will be welded", grouped(count))),
        };
    });
}

/// Default distance.
fn offered(model: &Model) -> f64 {
    let positions = &model.source.polygons.positions;
    let offered = (SpaceBounds::of(positions.iter().copied()).diagonal() * OFFERED).log10().floor();
    if offered.is_finite() { 10.0_f64.powf(offered) } else { 0.0 }
}
