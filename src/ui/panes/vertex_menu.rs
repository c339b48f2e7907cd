//! Context menu of a vertex, opened by a secondary click on the vertex or its pin.

use eframe::egui::{self, Response};

use crate::session::Action;
use crate::ui::{Control, Editor, Request, Tab};
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;

/// Weights offered in menus.
const WEIGHTS: [f64; 3] = [0.1, 1.0, 10.0];

/// Context menu of the vertex under a secondary click on a pane. A click beside all vertices opens none.
pub(super) fn of_pane(response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    if response.secondary_clicked() {
        editor.pointer.set_menu_vertex(editor.pointer.vertex());
    }
    if let Some(vertex) = editor.pointer.menu_vertex() {
        response.context_menu(|ui| vertex_menu(ui, editor, vertex, requests));
    }
}

/// Entries for a vertex.
pub(in crate::ui) fn vertex_menu(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId, requests: &mut Vec<Request>) {
    ui.weak(editor.vertex_words(vertex));
    let document = editor.session.document();
    match document.targets.get(&vertex) {
        _ if editor.is_new_vertex(vertex) => {
            ui.weak("New vertex, in this embedding only");
        }
        Some(target) => {
            hold_entries(ui, vertex, target.kind, requests);
            entry(ui, "Choose another position", [Request::TakeVertex(vertex)], requests);
            entry(ui, "Free", [Action::Unpin(vec![vertex]).into()], requests);
        }
        None if document.settings.method.uses_pins() => {
            entry(ui, "Fix at its current position", [Action::Fix(vec![vertex]).into()], requests);
            entry(ui, "Choose its position", [Request::TakeVertex(vertex)], requests);
        }
        None => {}
    }
    ui.separator();
    entry(ui, "Go to", [Request::GoTo(vec![vertex])], requests);
    entry(ui, "Show its equation", [Request::Select(vec![vertex]), Request::ShowTab(Tab::Vertex)], requests);
}

/// Entry that makes requests and closes the menu.
fn entry<const N: usize>(ui: &mut egui::Ui, words: &str, asks: [Request; N], requests: &mut Vec<Request>) {
    if ui.button(words).clicked() {
        requests.extend(asks);
        ui.close();
    }
}

/// Entries for the kind of a pin.
pub(in crate::ui) fn hold_entries(ui: &mut egui::Ui, vertex: VertexId, now: PinKind, requests: &mut Vec<Request>) {
    let exact = if now == PinKind::Fixed { PinKind::Fixed } else { PinKind::Hard };
    let weights = WEIGHTS.map(|weight| (format!("Weight {weight}"), PinKind::Soft(weight)));
    for (words, kind) in std::iter::once(("Hard".to_owned(), exact)).chain(weights) {
        let entry = ui.selectable_label(kind == now, words);
        if entry.asks(Action::SetPinKind { vertices: vec![vertex], kind }, requests) {
            ui.close();
        }
    }
}
