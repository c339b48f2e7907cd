//! Tab of the selected vertex: its position and its surroundings.

use std::f64::consts::TAU;

use eframe::egui;

use super::equation_table;
use super::hull_section::hull_rows;
use crate::session::Action;
use crate::ui::editor::scene::MeshScene;
use crate::ui::{Control, Editor, Request, number, pairs, sentence, short, with_keys_set};
use freebound_core::mesh::{DiskMesh, HalfedgeId, VertexId};
use freebound_core::problem::Embedding;

fn no_vertex(ui: &mut egui::Ui) {
    let words = "Select a vertex: click one in either pane, or press G and type its number.";
    ui.label(with_keys_set(ui.ctx(), words, ["press ", "G", " and"], &Request::AskGoTo));
}

/// Name of the vertex, and buttons beside it.
fn name_row(ui: &mut egui::Ui, scene: &MeshScene, vertex: VertexId, requests: &mut Vec<Request>) {
    if let Some(of_file) = scene.number_of(vertex) {
        ui.strong(of_file.to_string());
        if ui.small_button("Copy").on_hover_text("Copy the number").clicked() {
            ui.ctx().copy_text(of_file.number().to_string());
        }
    } else {
        ui.strong(sentence(&scene.vertex_words(vertex))).on_hover_text(NOT_TO_PIN);
    }
    ui.small_button("Frame").asks(Request::GoTo(vec![vertex]), requests);
}

pub(in crate::ui) fn vertex_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.shows_page() && !editor.plane.page.elements().is_empty() {
        ui.label("The data of a vertex shows with its chart alone: press Enter.");
        return;
    }
    let Some(&vertex) = editor.selection.vertices().first() else {
        return no_vertex(ui);
    };
    if editor.selection.vertices().len() > 1 {
        ui.weak(format!("{} selected; this is the first", editor.selection.vertices().len()));
    }
    let Some(scene) = editor.mesh_scene() else { return };
    let Some(position) = scene.mesh().positions.get(vertex.index()) else { return };
    ui.horizontal(|ui| name_row(ui, scene, vertex, requests));
    if let Some(chart) = editor.session.chart_on_screen() {
        let name = editor.session.chart_name(chart).map(|name| format!(": {name}")).unwrap_or_default();
        ui.label(format!("Chart {chart}{name}"));
    }
    if let Some(side) = scene.side_of(vertex) {
        ui.label(side.to_string()).on_hover_text("Each side of a seam has a vertex of its own, with its own pin");
    }
    let embedding = editor.step_on_screen().map(|outcome| &outcome.step.candidate.solution.embedding);
    pairs(ui, "vertex", [16.0, 4.0], |ui| {
        for (axis, value) in ["x", "y", "z"].iter().zip(position.to_array()) {
            number(ui, axis, short(value));
        }
        if let Some(z) = embedding.and_then(|embedding| embedding.get(vertex.index())) {
            let frame = editor.step_on_screen().map(|outcome| outcome.problem.frame).unwrap_or_default();
            let uv = frame.uv_from_plane(*z);
            number(ui, "u", short(uv.x));
            number(ui, "v", short(uv.y));
        }
        if let Some(disk) = scene.disk() {
            let valence = disk.outgoing(vertex).filter(|&h| !disk.is_virtual_edge(disk.edge_of(h))).count();
            number(ui, "Valence", valence.to_string());
            let place = disk.boundary_place(vertex);
            let is_at_hole = disk.outgoing(vertex).filter_map(|h| disk.face_of(h)).any(|face| disk.is_virtual(face));
            let elsewhere = if is_at_hole { "around a hole" } else { "inside" };
            number(ui, "Location", place.map_or_else(|| elsewhere.to_owned(), |at| format!("on the boundary ({at})")));
            number(ui, "Angles on the mesh", turns(angle_sum_on_mesh(disk, vertex)));
            if let Some(embedding) = embedding {
                number(ui, "Angles in the plane", turns(angle_sum_in_plane(disk, embedding, vertex)));
            }
            if let Some(outcome) = editor.step_on_screen() {
                hull_rows(ui, disk, outcome, vertex);
            }
        }
    });
    equation_table::equation_ui(ui, editor, vertex, requests);
    ui.add_space(8.0);
    if editor.session.document().targets.contains_key(&vertex) {
        ui.button("Free").on_hover_text("Free the vertex").asks(Action::Unpin(vec![vertex]), requests);
    } else if embedding.is_some() && scene.new_vertex(vertex).is_none() {
        let fix = ui.button("Fix").on_hover_text("Pin the vertex at its current position");
        fix.asks(Action::Fix(vec![vertex]), requests);
    }
}

/// Explanation of a new vertex.
const NOT_TO_PIN: &str = "It exists in this embedding only and cannot be pinned";

/// Formats an angle sum as a multiple of a full turn.
fn turns(angle: f64) -> String {
    format!("{:.4} × 2π", angle / TAU)
}

fn angle_sum_on_mesh(disk: &DiskMesh, vertex: VertexId) -> f64 {
    let at = |v: VertexId| disk.position(v) - disk.position(vertex);
    corners(disk, vertex).map(|[a, b]| at(a).angle_between(at(b))).sum()
}

fn angle_sum_in_plane(disk: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> f64 {
    let at = |v: VertexId| embedding[v] - embedding[vertex];
    corners(disk, vertex).map(|[a, b]| at(a).angle_to(at(b)).abs()).sum()
}

/// Other two corners of each face around a vertex.
fn corners(disk: &DiskMesh, vertex: VertexId) -> impl Iterator<Item = [VertexId; 2]> + '_ {
    let is_shown = |h: &HalfedgeId| disk.face_of(*h).is_some_and(|face| !disk.is_virtual(face));
    disk.outgoing(vertex).filter(is_shown).map(|h| [disk.head(h), disk.tail(disk.previous(h))])
}
