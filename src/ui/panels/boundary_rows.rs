//! Rows of the method tab for the shape of the boundary.

use eframe::egui::{self, Id, Role, Stroke, StrokeKind};

use crate::ui::{Control, list, remark, sentence, theme_of};
use freebound_core::geom::ConvexPolygon;
use freebound_core::problem::{BoundaryShape, NamedOption, Settings, Spacing};

/// Name of the field for a polygon's corners.
const CORNERS: &str = "Corners of the polygon";

/// Rows for shape, polygon corners and spacing, if the method maps the boundary to a shape.
pub(super) fn boundary_rows(ui: &mut egui::Ui, settings: &mut Settings) {
    let Some(shape) = settings.method.boundary_shape_mut() else { return };
    ui.label("Boundary");
    list(ui, "Shape of the boundary", 150.0, shape.labels().title, |ui| {
        for choice in BoundaryShape::ALL {
            let is_chosen = shape.name() == choice.name();
            let label = ui.selectable_label(is_chosen, choice.labels().title);
            if label.on_hover_text(sentence(choice.labels().about)).clicked() && !is_chosen {
                *shape = choice.clone();
            }
        }
    });
    ui.end_row();
    if let BoundaryShape::Polygon(polygon) = shape {
        ui.label("Corners");
        ui.vertical(|ui| corners_field(ui, polygon));
        ui.end_row();
    }
    ui.label("Spacing");
    ui.horizontal(|ui| {
        for &choice in Spacing::ALL {
            let label = ui.selectable_value(&mut settings.spacing, choice, choice.labels().title);
            label.on_hover_text(sentence(choice.labels().about));
        }
    });
    ui.end_row();
}

/// Field for the corners. Applies the text when the field loses focus, and marks it if it is no convex polygon.
fn corners_field(ui: &mut egui::Ui, polygon: &mut ConvexPolygon) {
    let key = Id::unique(CORNERS);
    let own = polygon.to_string();
    // Text being typed, and the polygon it was typed for. Another polygon shows its own corners.
    let typed = ui.data(|data| data.get_temp::<[String; 2]>(key)).filter(|[of, _]| *of == own);
    let mut text = typed.map_or_else(|| own.clone(), |[_, text]| text);
    let field = ui.add(egui::TextEdit::singleline(&mut text).desired_width(200.0));
    let fault = ConvexPolygon::fault_in(&text);
    if let Some(fault) = &fault {
        let stroke = Stroke::new(1.5, theme_of(ui).flipped);
        ui.painter().rect_stroke(field.rect, 2.0, stroke, StrokeKind::Inside);
        remark(ui, fault.to_string());
    }
    let field = field.named(Role::TextInput, CORNERS);
    if fault.is_none() && field.lost_focus() {
        if let Ok(read) = ConvexPolygon::parse(&text) {
            *polygon = read;
        }
    } else {
        ui.data_mut(|data| data.insert_temp(key, [own, text]));
    }
    field.on_hover_text("Corners as x y; x y; …, counter-clockwise, every corner convex");
}
