//! Vertices outside the convex hull of their neighbours. They are not defects, but the cause of folds (Gortler,
//! Gotsman, Thurston 2006). This file shows the list of these vertices, and the rows for a single vertex.

use eframe::egui::{self, CollapsingHeader, Role};

use crate::ui::{Control, Editor, Request, counted, number, remark, theme_of};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::verify::{CornerKind, HullStanding, Verdict, holes_turn_once, hull_standing, index_range};

/// Explanation of the list: the theorem and its use.
const ABOUT: &str = "Interior vertices, and reflex or straight boundary vertices, outside the hull of their \
                     neighbours. A planar embedding has none. If faces fold although the boundary and each hole loop \
                     turn once, there is at least one. Positive weights pull interior vertices back. Vertices left \
                     during an iteration show where it stalls.";

/// Section below the defects: number of vertices, marks, and navigation between them.
pub(super) fn hull_section(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(scene) = editor.plane.scene().filter(|scene| !is_faultless(&scene.outcome.step.verdict)) else { return };
    let outside = editor.outside_hull();
    let Some(&first) = outside.first() else {
        if let Some(disk) = scene.mesh.disk() {
            remark(ui, why_without(disk, &scene.outcome));
        }
        return;
    };
    let title = counted(outside.len(), "vertex outside its hull", "vertices outside their hulls");
    CollapsingHeader::new(title).id_salt("outside hull").show(ui, |ui| {
        remark(ui, ABOUT);
        ui.horizontal(|ui| {
            let (square, _) = ui.allocate_exact_size(egui::Vec2::splat(10.0), egui::Sense::hover());
            ui.painter().rect_filled(square, 1.0, theme_of(ui).outside_hull);
            let mut is_marked = editor.selection.marks_outside_hull;
            if ui.checkbox(&mut is_marked, "Mark them in both panes").changed() {
                requests.push(Request::ToggleOutsideHull);
            }
        });
        let selected = editor.selection.vertices().first().filter(|_| editor.selection.vertices().len() == 1);
        let after = selected.map_or(0, |&vertex| outside.partition_point(|&other| other <= vertex));
        let before = selected.map_or(0, |&vertex| outside.partition_point(|&other| other < vertex));
        let next = outside.get(after).copied().unwrap_or(first);
        let previous = outside[before.checked_sub(1).unwrap_or(outside.len() - 1)];
        ui.horizontal(|ui| {
            for (words, name, vertex) in
                [("Previous", "Previous vertex outside", previous), ("Next", "Next vertex outside", next)]
            {
                ui.button(words).named(Role::Button, name).asks(Request::GoTo(vec![vertex]), requests);
            }
            if let Some(place) = selected.and_then(|vertex| outside.binary_search(vertex).ok()) {
                ui.weak(format!("{} of {}", place + 1, outside.len()));
            }
        });
    });
}

/// True if the surface is one-to-one, apart from its polygons. Faces that fill holes may fold.
fn is_faultless(verdict: &Verdict) -> bool {
    verdict.flipped_faces.is_empty() && verdict.crossed_holes.is_empty() && verdict.boundary_crossings.is_empty()
}

/// Reason why an embedding without vertices outside their hulls is not one-to-one.
fn why_without(disk: &DiskMesh, outcome: &Outcome) -> &'static str {
    let (embedding, verdict) = (&outcome.step.candidate.solution.embedding, &outcome.step.verdict);
    let holes_turn_once = embedding.len() == disk.vertex_count() && holes_turn_once(disk, embedding, verdict.upright());
    let once = if verdict.mirrored { -1 } else { 1 };
    if verdict.turning_number != Some(once) {
        "Every vertex lies in the hull of its neighbours. Faces fold because the boundary does not turn once."
    } else if !holes_turn_once {
        "Every vertex lies in the hull of its neighbours. Faces fold because the loop around a hole does not turn once."
    } else if disk.mesh().holes().is_empty() {
        "Every vertex lies in the hull of its neighbours. Only the boundary meets itself."
    } else {
        "Every vertex lies in the hull of its neighbours. No face folds, but the boundary or loops around holes meet."
    }
}

/// Rows of the vertex tab: standing to the hull of the neighbours, and index.
pub(super) fn hull_rows(ui: &mut egui::Ui, disk: &DiskMesh, outcome: &Outcome, vertex: VertexId) {
    let (embedding, upright) = (&outcome.step.candidate.solution.embedding, outcome.step.verdict.upright());
    if embedding.len() != disk.vertex_count() {
        return;
    }
    if let Some(standing) = hull_standing(disk, embedding, vertex, upright) {
        let [words, tip] = standing_words(standing);
        number(ui, "Hull of neighbours", words).on_hover_text(tip);
    }
    if let Some(range) = index_range(disk, embedding, vertex) {
        number(ui, "Index", index_words(range)).on_hover_text(
            "Index of the one-form dz along any direction. 0 if the neighbours go around once, 1 if the vertex is an \
             extremum, negative at folds",
        );
    }
}

/// Short and long description of a standing.
fn standing_words(HullStanding { corner, is_inside }: HullStanding) -> [&'static str; 2] {
    match (corner, is_inside) {
        (CornerKind::Interior, true) => ["inside", "The vertex lies strictly inside the convex hull of its neighbours"],
        (CornerKind::Interior, false) => [
            "outside",
            "The vertex lies outside the convex hull of its neighbours, or on its rim. Faces around it fold",
        ],
        (CornerKind::Reflex, true) => [
            "inside, reflex",
            "The boundary turns away from the surface here. The vertex lies in the hull of its neighbours",
        ],
        (CornerKind::Reflex, false) => [
            "outside, reflex",
            "The boundary turns away from the surface here. The vertex lies outside the hull of its neighbours. \
             Faces around it fold",
        ],
        (CornerKind::Straight, true) => {
            ["on its rim, straight", "The boundary is straight here. A neighbour lies on the surface's side of it"]
        }
        (CornerKind::Straight, false) => {
            ["outside, straight", "The boundary is straight here. No neighbour lies on the surface's side of it"]
        }
        (CornerKind::Convex, _) => {
            ["free, convex", "The boundary turns toward the surface here. The vertex need not lie in the hull"]
        }
    }
}

fn index_words([least, greatest]: [i64; 2]) -> String {
    if least == greatest { least.to_string() } else { format!("{least} to {greatest}") }.replace('-', "−")
}
