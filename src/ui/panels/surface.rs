//! Preparation options of the mesh: its charts, its holes, and the start of the map.

use eframe::egui::{self, Response};

use crate::session::{Action, Model, Session};
use crate::ui::{Editor, Request, list, pairs, remark};
use freebound_core::mesh::{Fault, HoleTreatment, Repair};
use freebound_core::pipeline::Surface;
use freebound_core::problem::{NamedOption, Settings, Start};

/// Width of the lists, points.
const WIDTH: f32 = 150.0;

/// Grid row for the first step. Disabled if the file has no layout.
pub(super) fn start_row(ui: &mut egui::Ui, editor: &Editor, settings: &mut Settings, requests: &mut Vec<Request>) {
    if !settings.method.continues_from_layout() {
        return;
    }
    let has_layout = editor.session.model().is_some_and(|model| model.source.texture.is_some());
    ui.label("Start");
    let row = |ui: &mut egui::Ui| {
        list(ui, "Start", WIDTH, settings.start.labels().title, |ui| {
            for &start in Start::ALL {
                let is_chosen = settings.start == start;
                let label = ui.selectable_label(is_chosen, start.labels().title).on_hover_text(start.labels().tip());
                match start {
                    _ if is_chosen || !label.clicked() => {}
                    Start::FromScratch => settings.start = start,
                    Start::File => requests.push(Action::TakeLayout.into()),
                }
            }
        })
    };
    let tip = "First step of the run. The file's layout is verified unchanged; Relax then lowers its distortion";
    greyed_unless(ui, has_layout, row)
        .on_hover_text(tip)
        .on_disabled_hover_text("The file has no texture coordinates to start from");
    ui.end_row();
}

/// Rows of charts and holes in a grid of their own.
pub(super) fn surface_rows(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    pairs(ui, "surface", [12.0, 4.0], |ui| {
        charts_row(ui, session, requests);
        holes_row(ui, session, requests);
    });
}

fn greyed_unless(ui: &mut egui::Ui, enabled: bool, row: impl FnOnce(&mut egui::Ui) -> Response) -> Response {
    ui.add_enabled_ui(enabled, row).inner
}

/// Remark below the rows if the file's layout was requested but the map on the screen does not start from it.
pub(super) fn start_remark(ui: &mut egui::Ui, editor: &Editor) {
    let Some(outcome) = editor.step_on_screen() else { return };
    if outcome.problem.settings.start == Start::File && !outcome.step.lies_as_given {
        remark(ui, "Solved from scratch: the file's layout has cuts that the mesh does not have.");
    }
}

/// Grid row for the definition of charts, if the file has texture coordinates.
pub(super) fn charts_row(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    if session.model().is_none_or(|model| model.source.texture.is_none()) {
        return;
    }
    ui.label("Charts");
    let before = session.seams().of_texture;
    let words = |of_texture: bool| if of_texture { "File's texture seams" } else { "Parts" };
    let list = list(ui, "Definition of charts", WIDTH, words(before), |ui| {
        for of_texture in [false, true] {
            let label = ui.selectable_label(before == of_texture, words(of_texture));
            if label.clicked() && before != of_texture {
                let mut seams = session.seams().clone();
                seams.of_texture = of_texture;
                requests.push(Action::SetSeams(seams).into());
            }
        }
    });
    list.on_hover_text("Parts of the mesh, or charts of the file's texture coordinates, with cuts along their seams");
    ui.end_row();
}

/// Grid row for the treatment of holes, if the mesh has holes.
pub(super) fn holes_row(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(model) = session.model() else { return };
    let before = session.document().form.holes;
    if before == HoleTreatment::default() && !has_holes(model) {
        return;
    }
    ui.label("Holes");
    let list = list(ui, "Treatment of holes", WIDTH, words_of(before), |ui| {
        for holes in [HoleTreatment::Fill, HoleTreatment::Cut] {
            let label = ui.selectable_label(before == holes, words_of(holes));
            if label.clicked() && before != holes {
                requests.push(Action::SetHoles(holes).into());
            }
        }
    });
    list.on_hover_text(
        "Fill holes while flattening, with faces that are never written. Or cut the mesh from holes to the outside",
    );
    ui.end_row();
}

const fn words_of(holes: HoleTreatment) -> &'static str {
    match holes {
        HoleTreatment::Fill => "Filled",
        HoleTreatment::Cut => "Cut to the outside",
    }
}

fn has_holes(model: &Model) -> bool {
    let is_filled = model
        .prepared
        .repaired
        .iter()
        .flat_map(|repaired| repaired.done())
        .any(|done| done.repair == Repair::FillHoles);
    let is_fault = match &model.prepared.surface {
        Surface::Disk(_) => false,
        Surface::Faulty(_, diagnosis) => {
            diagnosis.faults.iter().any(|fault| matches!(fault, Fault::SeveralBoundaryLoops(_)))
        }
    };
    is_filled || is_fault
}
