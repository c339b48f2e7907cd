//! The menu of a vertex, by a secondary click on it or on its pin: what can be done with it.

use eframe::egui::{self, Response};

use crate::session::Action;
use crate::ui::{Control, Editor, Request, Tab};
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;

/// Weights that menus offer.
const WEIGHTS: [f64; 3] = [0.1, 1.0, 10.0];

/// The menu of the vertex that a secondary click on a pane met. A click beside all vertices has none.
pub(super) fn of_pane(response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    if response.secondary_clicked() {
        editor.pointer.set_menu_vertex(editor.pointer.vertex());
    }
    if let Some(vertex) = editor.pointer.menu_vertex() {
        response.context_menu(|ui| vertex_menu(ui, editor, vertex, requests));
    }
}

/// What can be done with a vertex.
pub(in crate::ui) fn vertex_menu(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId, requests: &mut Vec<Request>) {
    ui.weak(vertex.to_string());
    let document = editor.session.document();
    match document.targets.get(&vertex) {
        _ if editor.is_new_vertex(vertex) => {
            ui.weak("New: it belongs to this embedding alone");
        }
        Some(target) => {
            hold_entries(ui, vertex, target.kind, requests);
            entry(ui, "Choose another place", [Request::TakeVertex(vertex)], requests);
            entry(ui, "Free", [Action::Unpin(vec![vertex]).into()], requests);
        }
        None if document.settings.method.uses_pins() => {
            entry(ui, "Fix where it lies", [Action::Fix(vec![vertex]).into()], requests);
            entry(ui, "Choose its place", [Request::TakeVertex(vertex)], requests);
        }
        None => {}
    }
    ui.separator();
    entry(ui, "Go to", [Request::GoTo(vec![vertex])], requests);
    entry(ui, "Its equation", [Request::Select(vec![vertex]), Request::ShowTab(Tab::Vertex)], requests);
}

/// An entry that asks for something and closes the menu.
fn entry<const N: usize>(ui: &mut egui::Ui, words: &str, asks: [Request; N], requests: &mut Vec<Request>) {
    if ui.button(words).clicked() {
        requests.extend(asks);
        ui.close();
    }
}

/// How a pin can be held, as entries of a menu.
pub(in crate::ui) fn hold_entries(ui: &mut egui::Ui, vertex: VertexId, now: PinKind, requests: &mut Vec<Request>) {
    let exact = if now == PinKind::Fixed { PinKind::Fixed } else { PinKind::Hard };
    let weights = WEIGHTS.map(|weight| (format!("Weight {weight}"), PinKind::Soft(weight)));
    for (words, kind) in std::iter::once(("Exact".to_owned(), exact)).chain(weights) {
        let entry = ui.selectable_label(kind == now, words);
        if entry.asks(Action::SetPinKind { vertices: vec![vertex], kind }, requests) {
            ui.close();
        }
    }
}
