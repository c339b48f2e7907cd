//! Equation of the selected vertex in the step on the screen: a table in the panel, and a drawing in the embedding
//! pane. The drawing shows eq. (3) of the paper: a vertex lies at the barycentre of its neighbours, plus an offset
//! that points outwards on the boundary.

use std::sync::Arc;

use eframe::egui::{self, Pos2, RichText, Role, Stroke, Vec2};
use glam::DVec2;

use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::state::Viewport;
use crate::ui::{Control, Editor, Request, Tab, number, pairs, remark, sentence, short, theme_of};
use crate::view::PlaneCamera;
use freebound_core::flatten::equation_of_step;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{NoEquation, WeightSource};
use freebound_core::weights::VertexEquation;

/// Residual below which an equation counts as met; a solve leaves rounding errors.
const MET: f64 = 1e-7;
/// Width of the spoke to a neighbour with share 1, points.
const SPOKE: f32 = 5.0;
/// Length of an arrow head, points.
const HEAD: f32 = 7.0;
/// Name of a neighbour that is no vertex of the surface.
const VIRTUAL: &str = "virtual";

/// Equation of a vertex, for the outcome on the screen.
fn equation_of(
    editor: &Editor,
    outcome: &Arc<Outcome>,
    vertex: VertexId,
) -> Option<Result<(VertexEquation, WeightSource), NoEquation>> {
    let step = &outcome.step;
    // Mesh of the drawn embedding: the session may already have another chart.
    let disk = step.candidate.mesh(editor.mesh_scene()?.model.disk()?);
    let timeline = editor.session.timeline();
    let index_before = timeline.index_of(outcome).and_then(|index| index.checked_sub(1));
    let before = index_before.and_then(|index| timeline.outcome(index));
    let before = before.map(|before| &before.step.candidate.solution.embedding);
    let is_there =
        vertex.index() < disk.vertex_count() && disk.vertex_count() == step.candidate.solution.embedding.len();
    is_there.then(|| equation_of_step(disk, step, before, vertex))
}

pub(super) fn equation_ui(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId, requests: &mut Vec<Request>) {
    let Some(outcome) = editor.step_on_screen() else { return };
    let Some(found) = equation_of(editor, outcome, vertex) else { return };
    ui.add_space(8.0);
    ui.strong("Equation");
    let (equation, source) = match found {
        Ok(found) => found,
        Err(reason) => {
            ui.label(RichText::new(reason.words()).color(theme_of(ui).weak_text));
            return;
        }
    };
    remark(ui, source_words(source, &equation));
    table(ui, editor, &equation, requests);
    ui.add_space(4.0);
    numbers(ui, &equation);
    let is_pinned = outcome.step.candidate.solution.pins.contains_key(&vertex);
    let words = match (equation.residual < MET, is_pinned) {
        (true, _) => return,
        (false, true) => "The vertex is pinned, so it need not meet its equation.",
        (false, false) if source == WeightSource::Extended => {
            "Not met: if the first solve fails, further solves use other weights."
        }
        (false, false) => "Not met exactly: the step solves all equations by least squares, or pins more vertices.",
    };
    remark(ui, words);
}

fn source_words(source: WeightSource, equation: &VertexEquation) -> &'static str {
    match (source, equation.offset_vector.is_some()) {
        (WeightSource::Surface, false) => "Weights of the surface; eq. 2: at its neighbours' barycentre.",
        (WeightSource::Surface, true) => "Weights of the surface; eq. 3: at its neighbours' barycentre plus an offset.",
        (WeightSource::StepBefore, false) => "Mean-value weights of the previous step (§4); eq. 2: at the barycentre.",
        (WeightSource::StepBefore, true) => {
            "Mean-value weights of the previous step (§4); eq. 3: at the barycentre plus an offset."
        }
        (WeightSource::Extended, _) => "Mean-value weights of the mesh with its outside (§5), before the solve.",
    }
}

/// Table of neighbour, k, d and share. A click on a neighbour selects it.
fn table(ui: &mut egui::Ui, editor: &Editor, equation: &VertexEquation, requests: &mut Vec<Request>) {
    let scene = editor.mesh_scene();
    let theme = theme_of(ui);
    egui::Grid::new("equation").num_columns(4).spacing([4.0, 2.0]).striped(true).show(ui, |ui| {
        let heads = [
            ("Neighbour", "In counter-clockwise order. Click to select"),
            ("k", "Weight, not normalised (the paper's λ); unit: length to the power p − 1"),
            ("d", "Offset along the edge: its length to the power p, 1 for mean-value weights"),
            ("Share", "The weight divided by the sum of all weights: w"),
        ];
        for (words, tip) in heads {
            // Numbers and their headings are right-aligned.
            let words = if words == "Neighbour" { words.to_owned() } else { format!("{words:>8}") };
            ui.label(RichText::new(words).monospace().color(theme.weak_text)).on_hover_text(tip);
        }
        ui.end_row();
        for term in &equation.terms {
            let name = scene.and_then(|scene| neighbour_words(scene, term.neighbour));
            if let Some([words, tip]) = &name {
                let link = ui.link(words.as_str()).on_hover_text(tip.as_str());
                link.asks(Request::Select(vec![term.neighbour]), requests);
            } else {
                ui.label(VIRTUAL).on_hover_text("Vertex of the frame around the mesh, or in a hole");
            }
            let at = name.as_ref().map_or(VIRTUAL, |[words, _]| words.as_str());
            for value in [term.weight, term.offset, term.share] {
                let colour = if value < 0.0 { theme.flipped } else { theme.text };
                let label = ui.label(RichText::new(format!("{:>8}", compact(value))).monospace().color(colour));
                label.named(Role::Label, &format!("Equation at {at}: {}", compact(value)));
            }
            ui.end_row();
        }
    });
}

/// Name of a neighbour, and the tip of its link. A new vertex has the name of its edge. `None` for a virtual vertex.
fn neighbour_words(scene: &MeshScene, neighbour: VertexId) -> Option<[String; 2]> {
    let tip = "Select this neighbour";
    if scene.new_vertex(neighbour).is_some() {
        let about = sentence(&scene.vertex_words(neighbour));
        return Some([scene.vertex_short_words(neighbour), format!("{about}. {tip}")]);
    }
    scene.number_of(neighbour).map(|number| [number.to_string(), tip.to_owned()])
}

fn numbers(ui: &mut egui::Ui, equation: &VertexEquation) {
    pairs(ui, "equation in sum", [16.0, 4.0], |ui| {
        number(ui, "Sum of k", compact(equation.weight_sum)).on_hover_text("Divisor of the offset");
        let of_terms = "Residual of the equation in this step, relative to the sizes of its terms";
        number(ui, "Residual", format!("{:.1e}", equation.residual)).on_hover_text(of_terms);
        number(ui, "Barycentre", pair(equation.barycentre))
            .on_hover_text("Barycentre of the neighbours, weighted by their shares: u, v");
        if let Some(offset) = equation.offset_vector {
            let tip = "From the barycentre to the position that eq. 3 requires: u, v";
            number(ui, "Offset", pair(offset)).on_hover_text(tip);
            number(ui, "Offset length", short(offset.length())).on_hover_text("In units of the plane");
        }
    });
}

fn pair(point: DVec2) -> String {
    format!("{}, {}", short(point.x), short(point.y))
}

/// Formats a number in at most eight characters.
fn compact(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e4).contains(&size) {
        format!("{value:.1e}")
    } else if size >= 100.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.3}")
    }
}

/// Draws the equation of the first selected vertex while the vertex tab is open. Spokes are as wide as their shares,
/// negative ones red. A cross marks the barycentre, an arrow the offset.
pub(in crate::ui) fn draw(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, plane: &PlaneScene) {
    if !editor.layout.shows(Tab::Vertex) || plane.is_stage() {
        return;
    }
    let Some(&vertex) = editor.selection.vertices().first() else { return };
    let Some(Ok((equation, source))) = equation_of(editor, &plane.outcome, vertex) else { return };
    if source == WeightSource::Extended {
        // The barycentre belongs to the stage that was solved.
        return;
    }
    let (theme, painter) = (theme_of(ui), ui.painter_at(view.rect));
    let at = |v: VertexId| plane.position_of(v).map(|z| view.spot(z));
    let Some(centre) = at(vertex) else { return };
    for term in &equation.terms {
        #[expect(clippy::cast_possible_truncation, reason = "a width in points")]
        let share = term.share as f32;
        let colour = if share < 0.0 { theme.flipped } else { theme.selection };
        if let Some(end) = at(term.neighbour) {
            painter.line_segment([centre, end], Stroke::new((SPOKE * share.abs()).clamp(0.75, SPOKE), colour));
        }
    }
    let barycentre = view.spot(equation.barycentre);
    for arm in [Vec2::new(4.0, 4.0), Vec2::new(4.0, -4.0)] {
        painter.line_segment([barycentre - arm, barycentre + arm], Stroke::new(3.5, theme.background));
        painter.line_segment([barycentre - arm, barycentre + arm], Stroke::new(1.75, theme.text));
    }
    if let Some(offset) = equation.offset_vector {
        arrow(&painter, [barycentre, view.spot(equation.barycentre + offset)], theme.text, theme.background);
    }
}

/// Arrow that is legible on any background.
fn arrow(painter: &egui::Painter, [from, to]: [Pos2; 2], ink: egui::Color32, ground: egui::Color32) {
    let along = to - from;
    let length = along.length();
    if length <= 1.0 || !length.is_finite() {
        return;
    }
    let head = along.normalized() * HEAD.min(length);
    let base = to - head;
    let side = head.rot90() * 0.55;
    painter.line_segment([from, base], Stroke::new(4.5, ground));
    let tip = vec![to, base + side, base - side];
    painter.add(egui::Shape::convex_polygon(tip.clone(), ink, Stroke::new(2.0, ground)));
    painter.line_segment([from, base], Stroke::new(2.25, ink));
    painter.add(egui::Shape::convex_polygon(tip, ink, Stroke::NONE));
}
