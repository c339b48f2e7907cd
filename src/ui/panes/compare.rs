//! Two steps compared: the outline of one over the other, and how far each face has moved between them.

use std::sync::Arc;

use eframe::egui;
use egui::{Rect, RichText, Stroke, Vec2};
use glam::DVec2;

use crate::mesh::{TriMesh, VertexId};
use crate::render::{GhostLayer, LineLayer};
use crate::session::Outcome;
use crate::solver::Step;
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Editor, Shading};
use crate::view::{EdgeList, PlaneArrays};

/// The boundary of the compared step, ready to be drawn over the one on the screen.
#[derive(Debug)]
pub(in crate::ui) struct Ghost {
    /// The outcome on the screen by its revision, and the compared step.
    key: (u64, usize),
    /// The boundary's vertices only, in the unit space of the outcome on the screen.
    arrays: Arc<PlaneArrays>,
    edges: Arc<EdgeList>,
}

impl Ghost {
    fn new(key: (u64, usize), boundary: &[DVec2], shown: &PlaneArrays) -> Self {
        let vertices: Vec<VertexId> = (0..boundary.len()).map(VertexId::from_index).collect();
        Self {
            key,
            arrays: Arc::new(PlaneArrays::in_frame(boundary, &[], shown.frame())),
            edges: Arc::new(EdgeList::closed_loop(&vertices)),
        }
    }

    /// The outline, as the embedding's pane draws it.
    pub(super) fn layer(&self, theme: &Theme) -> GhostLayer {
        let line = LineLayer { edges: Arc::clone(&self.edges), colour: theme.ghost, width_in_points: 2.0 };
        GhostLayer { plane: Arc::clone(&self.arrays), line }
    }

    /// The step that it is of.
    pub(in crate::ui) fn step(&self) -> usize {
        self.key.1
    }
}

impl Editor {
    /// The step that moves are measured from: the compared one, or else the one before, as far as it is kept.
    pub fn moved_from(&self) -> Option<&Arc<Outcome>> {
        let timeline = self.session.timeline();
        let shown = self.plane_scene.as_ref()?.outcome.step.index;
        let compared = timeline.compared().filter(|&compared| compared != shown);
        timeline.outcome(compared.or_else(|| shown.checked_sub(1))?)
    }

    /// The step whose outline shows over the one on the screen.
    pub fn ghost_step(&self) -> Option<usize> {
        self.ghost.as_ref().map(Ghost::step)
    }

    /// Makes the outline of the compared step where another one is wanted. Call once per frame.
    pub(in crate::ui) fn refresh_ghost(&mut self) {
        let compared = self.session.timeline().compared();
        let (Some(plane), Some(step)) = (&self.plane_scene, compared) else {
            self.ghost = None;
            return;
        };
        let key = (plane.outcome_revision, step);
        if self.ghost.as_ref().is_some_and(|ghost| ghost.key == key) {
            return;
        }
        let other = self.session.compared().filter(|_| step != plane.outcome.step.index);
        self.ghost = match (other, plane.mesh.model.disk()) {
            (Some(other), Some(disk)) => {
                let embedding = &other.step.solution.embedding;
                let position_of = |v: &VertexId| embedding.get(v.index()).copied().unwrap_or(DVec2::NAN);
                let boundary: Vec<DVec2> = other.step.mesh(disk).boundary_loop().iter().map(position_of).collect();
                Some(Ghost::new(key, &boundary, &plane.arrays))
            }
            _ => None,
        };
    }

    /// The name of the shading with what it is measured from.
    pub(super) fn shading_title(&self) -> String {
        match (self.look.shading, self.moved_from()) {
            (Shading::Move, Some(base)) => format!("Move from step {}, plane units", base.step.index),
            (shading, _) => shading.title().to_owned(),
        }
    }
}

/// Where the vertices of one step lie in another one: new vertices that the other one lacks on its straight edges.
pub(in crate::ui) fn places_in(base: &Step, step: &Step) -> Vec<DVec2> {
    let embedding = &base.solution.embedding;
    let Some(refinement) = &step.refinement else { return embedding.clone() };
    if base.refinement.as_ref().is_some_and(|other| Arc::ptr_eq(other, refinement)) {
        return embedding.clone();
    }
    let mut places = embedding[..refinement.old_vertex_count()].to_vec();
    for new in refinement.new_vertices() {
        let [a, b] = new.edge.map(|v| embedding[v.index()]);
        places.push(a.lerp(b, new.at));
    }
    places
}

/// How far each face has moved between two embeddings: the mean of its corners.
pub(in crate::ui) fn face_moves(mesh: &TriMesh, before: &[DVec2], after: &[DVec2]) -> Vec<f64> {
    let moves: Vec<f64> = before.iter().zip(after).map(|(a, b)| a.distance(*b)).collect();
    let of_vertex = |v: VertexId| moves.get(v.index()).copied().unwrap_or(f64::NAN);
    mesh.triangles.iter().map(|corners| corners.map(of_vertex).iter().sum::<f64>() / 3.0).collect()
}

/// Says in the pane's lower left corner which step the outline is of.
pub(super) fn ghost_note(ui: &mut egui::Ui, rect: Rect, editor: &Editor) {
    let Some(step) = editor.ghost_step() else { return };
    let theme = theme_of(ui);
    let has_legend = editor.layout.mesh_hidden() && editor.look.paint().is_some_and(|paint| paint.legend.is_some());
    let height = if has_legend { 124.0 } else { 32.0 };
    let place = Rect::from_min_size(rect.left_bottom() + Vec2::new(12.0, -height), Vec2::new(150.0, 20.0));
    if rect.width() < 180.0 {
        return;
    }
    ui.painter_at(rect).rect_filled(place, 4.0, theme.panel.gamma_multiply(0.92));
    let ink = crate::ui::theme::on_screen(theme.ghost);
    let middle = place.left_center() + Vec2::new(8.0, 0.0);
    ui.painter_at(rect).line_segment([middle, middle + Vec2::new(18.0, 0.0)], Stroke::new(2.0, ink));
    let words = RichText::new(format!("Outline of step {step}")).small().color(theme.weak_text);
    let text = Rect::from_min_max(place.min + Vec2::new(32.0, 0.0), place.max);
    let mut part = ui.new_child(egui::UiBuilder::new().max_rect(text));
    part.horizontal_centered(|ui| ui.add(egui::Label::new(words).selectable(false)));
}

/// Says why nothing is coloured where moves are asked for and there are none.
pub(super) fn no_move_note(ui: &egui::Ui, rect: Rect, editor: &Editor) {
    let has_legend = editor.look.paint().is_some_and(|paint| paint.legend.is_some());
    if editor.look.shading != Shading::Move || has_legend || editor.plane_scene().is_none() {
        return;
    }
    let at = rect.left_bottom() + Vec2::new(12.0, -12.0);
    let words = "No step before this one is kept: nothing has moved";
    let font = egui::FontId::proportional(11.0);
    ui.painter_at(rect).text(at, egui::Align2::LEFT_BOTTOM, words, font, theme_of(ui).weak_text);
}
