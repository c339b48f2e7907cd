//! List of the parts of a mesh, each kept or left out.

use std::collections::BTreeSet;

use eframe::egui::{self, Role};

use super::menu::grouped;
use crate::session::{Action, Model, Session};
use crate::ui::{Control, Request};
use freebound_core::mesh::{Fault, PartFaces};
use freebound_core::pipeline::Surface;

/// Height of a row, points.
const ROW: f32 = 22.0;

/// Greatest share of the panel's free height that the list takes, and its least height in rows.
const LIST: (f32, f32) = (0.6, 4.0);

/// Shows the parts if there are several, or some are left out.
pub(super) fn parts(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(model) = session.model() else { return };
    let left_out = &*session.document().form.left_out;
    let kept = kept_parts(model);
    if kept.len() < 2 && left_out.is_empty() {
        return;
    }
    egui::CollapsingHeader::new("Parts").default_open(true).show(ui, |ui| {
        let rows = kept.len() + left_out.len();
        let (share, least) = LIST;
        let gap = ui.spacing().item_spacing.y;
        // Whole rows: a row that is cut looks like the last one.
        let in_sight = (share * ui.available_height() / (ROW + gap)).floor().max(least);
        let height = in_sight * (ROW + gap) - gap;
        egui::ScrollArea::vertical().id_salt("parts").max_height(height).show_rows(ui, ROW, rows, |ui, range| {
            for row in range {
                match kept.get(row) {
                    Some(&part) => kept_row(ui, part, &kept, left_out, requests),
                    None => left_out.iter().nth(row - kept.len()).into_iter().for_each(|&first_face| {
                        left_out_row(ui, first_face, left_out, requests);
                    }),
                }
            }
        });
        if !left_out.is_empty() {
            let tip = "Flatten all parts";
            ui.button("Keep all").on_hover_text(tip).asks(Action::LeaveOut(BTreeSet::new()), requests);
        }
    });
}

fn kept_row(
    ui: &mut egui::Ui,
    part: PartFaces,
    kept: &[PartFaces],
    left_out: &BTreeSet<u32>,
    requests: &mut Vec<Request>,
) {
    let PartFaces { first_face, count } = part;
    let others = || kept.iter().map(|other| other.first_face).filter(move |&other| other != first_face);
    ui.horizontal(|ui| {
        let words = format!("Part of face {first_face}: {} f", grouped(count));
        let field = ui.add_enabled(kept.len() > 1, egui::Checkbox::new(&mut true, words));
        let field = field.named(Role::CheckBox, &format!("Keep the part of face {first_face}"));
        let tip = "Ticked parts are flattened. Other parts stay unchanged in the file";
        let without = left_out.iter().copied().chain([first_face]).collect();
        field.on_hover_text(tip).asks(Action::LeaveOut(without), requests);
        if kept.len() > 1 {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let button = ui.small_button("Only this").on_hover_text("Leave out all other parts");
                let button = button.named(Role::Button, &format!("Only the part of face {first_face}"));
                button.asks(Action::LeaveOut(left_out.iter().copied().chain(others()).collect()), requests);
            });
        }
    });
}

fn left_out_row(ui: &mut egui::Ui, first_face: u32, left_out: &BTreeSet<u32>, requests: &mut Vec<Request>) {
    let field = ui.add(egui::Checkbox::new(&mut false, format!("Part of face {first_face}: left out")));
    let field = field.named(Role::CheckBox, &format!("Keep the part of face {first_face}"));
    let with = left_out.iter().copied().filter(|&other| other != first_face).collect();
    field.on_hover_text("Flatten this part, too").asks(Action::LeaveOut(with), requests);
}

/// Kept parts, if there are several.
fn kept_parts(model: &Model) -> Vec<PartFaces> {
    if let Some(charts) = model.prepared.chart.as_ref().map(|of| &of.charts) {
        let part =
            |chart| PartFaces { first_face: charts.first_face(chart).number(), count: charts.faces(chart).len() };
        return (0..charts.count()).map(part).collect();
    }
    let Surface::Faulty(_, diagnosis) = &model.prepared.surface else { return Vec::new() };
    let parts = diagnosis.faults.iter().find_map(|fault| match fault {
        Fault::SeveralComponents { first_faces, sizes } => Some(first_faces.polygons.iter().zip(sizes)),
        _ => None,
    });
    parts.into_iter().flatten().map(|(&first_face, &count)| PartFaces { first_face, count }).collect()
}
