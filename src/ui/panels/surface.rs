//! What is made of the mesh before it is flattened, as far as a person chooses: its charts, its holes, and what the map starts from.

use eframe::egui::{self, Response};

use crate::session::{Action, Model, Session};
use crate::ui::{Editor, Request, list, pairs, remark};
use freebound_core::mesh::{Fault, HoleTreatment, Repair};
use freebound_core::pipeline::Surface;
use freebound_core::problem::{NamedOption, Settings, Start};

/// Width of the lists, points.
const WIDTH: f32 = 150.0;

/// Row of a grid: what the first step is. Grey where the file has no layout.
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
    let tip = "What the first step is. The file's layout is proved as it is; Relax lowers its distortion from there";
    greyed_unless(ui, has_layout, row)
        .on_hover_text(tip)
        .on_disabled_hover_text("The file has no texture coordinates to start from");
    ui.end_row();
}

/// The rows of charts and holes by themselves.
pub(super) fn surface_rows(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    pairs(ui, "surface", [12.0, 4.0], |ui| {
        charts_row(ui, session, requests);
        holes_row(ui, session, requests);
    });
}

fn greyed_unless(ui: &mut egui::Ui, enabled: bool, row: impl FnOnce(&mut egui::Ui) -> Response) -> Response {
    ui.add_enabled_ui(enabled, row).inner
}

/// Below the rows: that the file's layout is wanted, and the map on the screen does not start from it.
pub(super) fn start_remark(ui: &mut egui::Ui, editor: &Editor) {
    let Some(outcome) = editor.step_on_screen() else { return };
    if outcome.problem.settings.start == Start::File && !outcome.step.lies_as_given {
        remark(ui, "Solved afresh: the file's layout is cut where the mesh is not.");
    }
}

/// Row of a grid: what the charts of the mesh are, where the file has texture coordinates.
pub(super) fn charts_row(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    if session.model().is_none_or(|model| model.source.texture.is_none()) {
        return;
    }
    ui.label("Charts");
    let before = session.seams().of_texture;
    let words = |of_texture: bool| if of_texture { "File's texture seams" } else { "Parts" };
    let list = list(ui, "What the charts are", WIDTH, words(before), |ui| {
        for of_texture in [false, true] {
            let label = ui.selectable_label(before == of_texture, words(of_texture));
            if label.clicked() && before != of_texture {
                let mut seams = session.seams().clone();
                seams.of_texture = of_texture;
                requests.push(Action::SetSeams(seams).into());
            }
        }
    });
    list.on_hover_text(
        "The mesh's parts, or the charts of the file's texture coordinates: it is cut along their seams",
    );
    ui.end_row();
}

/// Row of a grid: what becomes of holes, where the mesh has some.
pub(super) fn holes_row(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(model) = session.model() else { return };
    let before = session.document().form.holes;
    if before == HoleTreatment::default() && !has_holes(model) {
        return;
    }
    ui.label("Holes");
    let list = list(ui, "What becomes of holes", WIDTH, words_of(before), |ui| {
        for holes in [HoleTreatment::Fill, HoleTreatment::Cut] {
            let label = ui.selectable_label(before == holes, words_of(holes));
            if label.clicked() && before != holes {
                requests.push(Action::SetHoles(holes).into());
            }
        }
    });
    list.on_hover_text("Filled while the mesh is flattened, with faces that no file gets; or cut open to the outside");
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
