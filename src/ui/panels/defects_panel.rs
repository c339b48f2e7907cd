//! What is wrong with the embedding, as a list to jump from; or with the mesh.

use eframe::egui::{self, RichText};

use super::diagnosis;
use crate::mesh::VertexId;
use crate::ui::{Control, Defect, Editor, Request, counted, keys_of, theme_of};

/// Height of a row, points.
const ROW: f32 = 22.0;

pub(in crate::ui) fn defects_panel(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    if let Some(model) = editor.session.model() {
        if diagnosis::faults(ui, model, requests) {
            return;
        }
        diagnosis::notes(ui, model);
    }
    let Some(outcome) = editor.step_on_screen().cloned() else {
        ui.label("Nothing is solved yet.");
        return;
    };
    let verdict = &outcome.step.verdict;
    if verdict.planar {
        ui.colored_label(theme.planar, "Planar: proved one-to-one");
        ui.label(
            "Every face lies the right way up and the boundary does not meet itself, decided in exact arithmetic.",
        );
        unmet_list(ui, &outcome.step.unmet(), requests);
        let new = outcome.new_vertex_count();
        if new > 0 {
            let words = counted(new, "new vertex", "new vertices");
            ui.label(format!("{words} on old edges: the surface is the same, cut into more triangles."));
        }
        return;
    }
    let rows = [
        (theme.flipped, "flipped faces", verdict.flipped_faces.len().to_string()),
        (theme.concave, "concave polygons", verdict.concave_polygons.len().to_string()),
        (theme.crossing, "boundary crossings", verdict.crossing_count_in_words()),
        (theme.overwound, "overwound vertices", verdict.overwound_vertices.len().to_string()),
    ];
    for (colour, words, count) in rows {
        ui.horizontal(|ui| {
            let (square, _) = ui.allocate_exact_size(egui::Vec2::splat(10.0), egui::Sense::hover());
            ui.painter().rect_filled(square, 1.0, colour);
            ui.label(format!("{count} {words}"));
        });
    }
    let turns = verdict.turning_number.map_or_else(|| "undefined".to_owned(), |turns| turns.to_string());
    ui.label(RichText::new(format!("Turning number of the boundary: {turns}")).color(theme.weak_text))
        .on_hover_text("1 for a boundary that goes around once; undefined where an edge has no length or turns back");
    ui.horizontal(|ui| {
        for (words, by) in [("Previous", -1), ("Next", 1)] {
            let request = Request::StepDefect(by);
            ui.button(words).on_hover_text(keys_of(ui.ctx(), &request)).asks(request, requests);
        }
        if let Some(at) = editor.selection.defect() {
            ui.weak(format!("{} of {}", at + 1, editor.defect_count()));
        }
    });
    ui.separator();
    list(ui, editor, requests);
}

/// The exact pins that are not on their targets, to jump from.
fn unmet_list(ui: &mut egui::Ui, unmet: &[VertexId], requests: &mut Vec<Request>) {
    if unmet.is_empty() {
        return;
    }
    ui.colored_label(theme_of(ui).unmet, format!("Constraints not met: {}", unmet.len()));
    ui.horizontal_wrapped(|ui| {
        for &vertex in unmet {
            let link = ui.link(vertex.to_string()).on_hover_text("Show this vertex");
            link.asks(Request::GoTo(vec![vertex]), requests);
        }
    });
}

fn list(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let defects = editor.defects();
    egui::ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, defects.len(), |ui, range| {
        for place in range {
            let colour = match defects[place] {
                Defect::Flipped(_) => theme.flipped,
                Defect::Concave(_) => theme.concave,
                Defect::Crossing(_) => theme.crossing,
                Defect::Overwound(_) => theme.overwound,
            };
            let words = RichText::new(defects[place].words()).color(colour);
            let row = ui.selectable_label(editor.selection.defect() == Some(place), words);
            row.context_menu(|ui| {
                for (words, request) in [("Go to", Request::GoToDefect(place)), ("Next", Request::StepDefect(1))] {
                    if ui.button(words).asks(request, requests) {
                        ui.close();
                    }
                }
            });
            row.asks(Request::GoToDefect(place), requests);
        }
    });
}
