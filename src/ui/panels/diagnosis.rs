//! Diagnosis of the mesh: each fault with links to its elements and its repairs. Also the repairs already done to a
//! mesh that can be flattened.

use eframe::egui::{self, Button, RichText};

use super::menu::grouped;
use super::parts::parts;
use super::surface::surface_rows;
use super::welding::welding;
use crate::session::{Action, Model, Session};
use crate::ui::{Control, Request, counted, sentence, theme_of, tip_with_keys};
use freebound_core::mesh::{Fault, Preparation, Repair, TriMesh};
use freebound_core::pipeline::Surface;

/// Shows the faults of a mesh that cannot be flattened. Returns true if the mesh has such faults.
pub(super) fn faults(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) -> bool {
    let Some(model) = session.model() else { return false };
    let Surface::Faulty(mesh, diagnosis) = &model.prepared.surface else { return false };
    ui.label("The mesh has faults that prevent flattening:");
    surface_rows(ui, session, requests);
    egui::ScrollArea::vertical().show(ui, |ui| {
        if let Some(remedy) = &model.prepared.remedy {
            let done: Vec<String> = remedy.done().iter().map(ToString::to_string).collect();
            let tip = "Repair the mesh and cut it along short seams. The file is not changed; undo reverts this";
            let unwrap = Action::Unwrap(None).into();
            ui.button("Unwrap").on_hover_text(tip_with_keys(ui, tip, &unwrap)).asks(unwrap, requests);
            if !done.is_empty() {
                ui.weak(format!("Its repair: {}", done.join(", ")));
            }
        }
        for fault in &diagnosis.faults {
            ui.separator();
            fault_card(ui, fault, mesh, requests);
            remedies(ui, fault, &session.document().form, requests);
        }
        ui.separator();
        done(ui, model);
        parts(ui, session, requests);
        welding(ui, session, requests);
    });
    true
}

/// Card of a fault: message, remedy, and buttons that show its elements in turn.
fn fault_card(ui: &mut egui::Ui, fault: &Fault, mesh: &TriMesh, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let colour = if fault.is_harmless() { theme.weak_text } else { theme.flipped };
    ui.colored_label(colour, sentence(&fault.message()));
    let remedy = if fault.is_harmless() { "this fault is harmless" } else { fault.remedy() };
    ui.label(RichText::new(sentence(remedy)).color(theme.weak_text));
    let count = fault.elements().count();
    if count == 0 {
        return;
    }
    let place = ui.scope_id().with(("element", fault.name()));
    let shown: Option<usize> = ui.data(|data| data.get_temp(place)).filter(|&at| at < count);
    ui.horizontal(|ui| {
        let name = fault.name().replace('-', " ");
        for (words, by) in [("Previous", count - 1), ("Next", 1)] {
            let to = shown.map_or(if by == 1 { 0 } else { count - 1 }, |at| (at + by) % count);
            let button = ui.add(Button::new(words)).on_hover_text("Show it in the mesh");
            let button = button.named(egui::Role::Button, &format!("{words} of {name}"));
            if button.clicked() {
                requests.push(Request::GoTo(fault.vertices_of(to, mesh)));
                ui.data_mut(|data| data.insert_temp(place, to));
            }
        }
        if let Some(at) = shown {
            ui.weak(format!("{} of {}", grouped(at + 1), grouped(count)));
        }
    });
}

/// Buttons for the repairs of a fault that are not done yet.
fn remedies(ui: &mut egui::Ui, fault: &Fault, form: &Preparation, requests: &mut Vec<Request>) {
    let is_open = |repair: &&Repair| !form.allows(**repair);
    ui.horizontal_wrapped(|ui| {
        for &repair in fault.repairs().iter().filter(is_open) {
            let [words, tip] = repair.offer();
            let button = ui.button(words).on_hover_text(format!("{tip}. The file is not changed; undo reverts this"));
            button.asks(Action::AllowRepair(repair), requests);
        }
    });
}

/// Repairs already done to the mesh.
fn done(ui: &mut egui::Ui, model: &Model) {
    for done in model.prepared.repaired.iter().flat_map(|repaired| repaired.done()) {
        ui.weak(format!("Mesh: {done}"));
    }
}

/// Notes on the preparation of a mesh that can be flattened; empty if it needed none.
pub(super) fn notes(ui: &mut egui::Ui, model: &Model) {
    let Some(disk) = model.disk() else { return };
    done(ui, model);
    let mut notes: Vec<String> = Vec::new();
    let unused = disk.vertex_count() - disk.used_vertex_count();
    if unused > 0 {
        notes.push(counted(unused, "unreferenced vertex", "unreferenced vertices"));
    }
    if disk.mollification() > 0.0 {
        let longer = disk.mollification() * disk.unit();
        notes.push(format!("it has faces without area, so all edges are measured {longer:.1e} longer"));
    }
    for note in notes {
        ui.weak(format!("Mesh: {note}"));
    }
}
