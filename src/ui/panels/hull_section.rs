//! Vertices outside the convex hull of their neighbours: no defects of their own, but why an embedding folds (Gortler,
//! Gotsman, Thurston 2006). What is said of all of them, and of one.

use eframe::egui::{self, CollapsingHeader, Role};

use crate::ui::{Control, Editor, Request, counted, number, remark, theme_of};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::verify::{CornerKind, HullStanding, Verdict, holes_turn_once, hull_standing, index_range};

/// What the theorem says, for who wonders what to do with the list.
const ABOUT: &str = "Where the boundary and the loop around each hole turn once and faces fold, a vertex inside the surface, or one \
                     where its boundary turns away from it or goes straight on, lies outside the hull of its neighbours. A \
                     planar embedding has none. Weights that are positive pull vertices inside back, so what is left along an \
                     iteration says where it hangs.";

/// Beside the list of defects: how many there are, marks, and a way from one to the next.
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

/// Whether the surface is one-to-one, its polygons aside: what fills its holes may fold.
fn is_faultless(verdict: &Verdict) -> bool {
    verdict.flipped_faces.is_empty() && verdict.crossed_holes.is_empty() && verdict.boundary_crossings.is_empty()
}

/// Why an embedding is not one-to-one that has none.
fn why_without(disk: &DiskMesh, outcome: &Outcome) -> &'static str {
    let (embedding, verdict) = (&outcome.step.candidate.solution.embedding, &outcome.step.verdict);
    let holes_turn_once = embedding.len() == disk.vertex_count() && holes_turn_once(disk, embedding, verdict.upright());
    let once = if verdict.mirrored { -1 } else { 1 };
    if verdict.turning_number != Some(once) {
        "Every vertex lies in the hull of its neighbours: it folds because the boundary does not turn once."
    } else if !holes_turn_once {
        "Every vertex lies in the hull of its neighbours: it folds because the loop around a hole does not turn once."
    } else if disk.mesh().holes().is_empty() {
        "Every vertex lies in the hull of its neighbours: only the boundary meets itself."
    } else {
        "Every vertex lies in the hull of its neighbours: no face folds, but the boundary or loops around holes meet."
    }
}

/// What the tab of a vertex says of it, as rows of a table.
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
            "Of the one-form dz along any direction: 0 where neighbours go once around, 1 where the vertex is an extreme, \
             negative at folds",
        );
    }
}

/// In short, and at length.
fn standing_words(HullStanding { corner, is_inside }: HullStanding) -> [&'static str; 2] {
    match (corner, is_inside) {
        (CornerKind::Interior, true) => ["inside", "It lies strictly inside the convex hull of its neighbours"],
        (CornerKind::Interior, false) => {
            ["outside", "It lies outside the convex hull of its neighbours, or on its rim: faces around it fold"]
        }
        (CornerKind::Reflex, true) => [
            "inside, reflex",
            "The boundary turns away from the surface here, and it lies in the hull of its neighbours",
        ],
        (CornerKind::Reflex, false) => [
            "outside, reflex",
            "The boundary turns away from the surface here, and it lies outside the hull of its neighbours: faces around \
             it fold",
        ],
        (CornerKind::Straight, true) => [
            "on its rim, straight",
            "The boundary goes straight on here, and a neighbour lies on the surface's side of it",
        ],
        (CornerKind::Straight, false) => [
            "outside, straight",
            "The boundary goes straight on here, and no neighbour lies on the surface's side of it",
        ],
        (CornerKind::Convex, _) => {
            ["free, convex", "The boundary turns toward the surface here: it need not lie in the hull"]
        }
    }
}

fn index_words([least, greatest]: [i64; 2]) -> String {
    if least == greatest { least.to_string() } else { format!("{least} to {greatest}") }.replace('-', "−")
}
