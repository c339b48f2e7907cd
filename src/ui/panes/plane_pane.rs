//! The embedding: pan, zoom to the pointer; hover, pick and drag.

use std::sync::Arc;

use eframe::egui;
use egui::{Pos2, Rect, Response};
use glam::DVec2;

use super::magnifier::Magnifier;
use super::mesh_pane::{boundary_line, clicked, cursor, new_vertex_mark, new_vertices, style};
use super::{compare, constrain};
use super::{pair_magnifier, pane, pin_drag, pins};
use crate::mesh::VertexId;
use crate::render::{self, PaneId, PlaneFrame};
use crate::session::{Place, Surface};
use crate::ui::editor::scene::PlaneScene;
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Editor, HullScene, Pane, Request, Stage};
use crate::view::PlaneCamera;

/// Marks drawn at most for a large selection.
const MARKS_SHOWN: usize = 2000;

/// Shows the pane and takes its gestures.
pub(in crate::ui) fn plane_pane_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    pane::header(ui, editor, Pane::Plane, requests);
    super::bars::bars(ui, editor, Pane::Plane, requests);
    pane::message_bars(ui, editor, Place::Embedding, requests);
    let (rect, response) = pane::surface(ui, "Embedding in the plane");
    editor.lay_out_plane(rect);
    let theme = theme_of(ui);
    ui.painter_at(rect).rect_filled(rect, 0.0, theme.background);
    let (Some(plane), Some(mut camera)) = (editor.plane.drawn().map(Arc::clone), editor.plane.camera()) else {
        return pane::empty_state(ui, rect, &waiting_words(editor));
    };
    navigate(ui, rect, &response, &mut camera);
    if editor.plane.camera() != Some(camera) {
        editor.plane.set_camera(camera);
        ui.ctx().request_repaint();
    }
    let magnifier = Magnifier::over(editor, rect, &plane).filter(|_| !editor.magnifies_pair());
    let is_covered = |at: Pos2| magnifier.as_ref().is_some_and(|magnifier| magnifier.rect.contains(at));
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|at| rect.contains(*at) && !is_covered(*at));
    if response.hovered() || response.contains_pointer() {
        look_under(ui, editor, &plane, pointer);
    }
    if editor.host.has_gpu() {
        let frame = frame(editor, &plane, camera, theme);
        ui.painter().add(render::plane_pane(PaneId("plane"), rect, frame));
    }
    select(ui, &response, editor, &plane, requests);
    marks(ui, rect, editor, &plane, camera);
    crate::ui::panels::equation_table::draw(ui, rect, editor, &plane, camera);
    if !plane.is_stage() {
        pin_drag::pins_ui(ui, rect, editor, camera, requests);
        pair_magnifier::over_plane(ui, rect, editor, &plane);
    }
    if let Some(magnifier) = magnifier {
        magnifier.show(ui, editor, &plane, requests);
    }
    stage_selector(ui, rect, editor, requests);
    if editor.layout.mesh_hidden()
        && let Some(legend) = editor.look.paint().and_then(|paint| paint.legend.as_ref())
    {
        pane::legend(ui, rect, legend, &editor.shading_title());
    }
    if !plane.is_stage() {
        compare::ghost_note(ui, rect, editor);
    }
}

/// Takes in what is under the pointer: a pin by its mark, which lies over the vertices, else the nearest vertex.
fn look_under(ui: &egui::Ui, editor: &mut Editor, plane: &PlaneScene, pointer: Option<Pos2>) {
    let (Some(rect), Some(camera)) = (editor.plane.area().rect(), editor.plane.camera()) else { return };
    let size = pane::size_of(rect);
    let grip = pointer.filter(|_| !plane.is_stage()).and_then(|at| pin_drag::pin_at(editor, rect, camera, at));
    let pointer = pointer.map(|at| pane::in_pane(rect, at));
    let pick = pointer.and_then(|at| plane.picker.nearest_vertex(&camera, size, at));
    let in_plane = pointer.map(|at| camera.embedding_from_pane(at, size));
    editor.pointer.over_plane(in_plane, grip.or(pick.map(|pick| pick.vertex)));
    editor.aim(ui, Pane::Plane, grip);
}

fn waiting_words(editor: &Editor) -> Vec<&'static str> {
    match editor.session.model().map(|model| &model.surface) {
        None => vec!["Its embedding will show here"],
        Some(Surface::Faulty(..)) => {
            vec!["This mesh cannot be flattened as it is", "The bars over the mesh say what is wrong and what to do"]
        }
        Some(Surface::Disk(_)) if editor.session.busy().is_some() => vec!["Solving…"],
        Some(Surface::Disk(_)) => vec!["Not solved", "Press Solve in the Method panel"],
    }
}

fn navigate(ui: &egui::Ui, rect: Rect, response: &Response, camera: &mut PlaneCamera) {
    let drag = DVec2::new(response.drag_delta().x.into(), response.drag_delta().y.into());
    let boxing = ui.input(|input| input.modifiers.command);
    if response.dragged() && !(boxing && response.dragged_by(egui::PointerButton::Primary)) {
        camera.pan(drag);
    }
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|_| response.contains_pointer());
    if let Some(pointer) = pointer {
        let wheel = pane::wheel(ui);
        if (wheel.zoom - 1.0).abs() > f64::EPSILON {
            camera.zoom_at(pane::in_pane(rect, pointer), wheel.zoom, pane::size_of(rect));
        }
        camera.pan(wheel.pan);
    }
}

fn select(ui: &egui::Ui, response: &Response, editor: &mut Editor, plane: &PlaneScene, requests: &mut Vec<Request>) {
    let Some(camera) = editor.plane.camera() else { return };
    let rect = response.rect;
    if let Some(chosen) = super::boxes::drag_box(ui, response, editor, Pane::Plane) {
        let size = pane::size_of(rect);
        let [a, b] = [chosen.left_bottom(), chosen.right_top()]
            .map(|corner| camera.embedding_from_pane(pane::in_pane(rect, corner), size));
        let count = plane.mesh.mesh().vertex_count();
        let positions = plane.positions()[..count].iter().enumerate();
        let inside = positions.filter(|(_, z)| z.cmpge(a).all() && z.cmple(b).all());
        let mut chosen: Vec<VertexId> = inside.map(|(i, _)| VertexId::from_index(i)).collect();
        let targets = editor.pins_shown().into_iter();
        let targets = targets.filter(|pin| pin.target.cmpge(a).all() && pin.target.cmple(b).all());
        chosen.extend(targets.map(|pin| pin.vertex));
        requests.push(Request::AddToSelection(chosen));
    }
    if response.clicked() {
        requests.extend(clicked(ui, editor));
    }
    if response.hovered() {
        ui.ctx().set_cursor_icon(cursor(editor));
    }
}

pub(in crate::ui) fn frame(editor: &Editor, plane: &PlaneScene, camera: PlaneCamera, theme: &Theme) -> PlaneFrame {
    let mut lines = vec![boundary_line(&plane.mesh, theme)];
    let mut fills = Vec::new();
    if let Some(scene) = editor.plane.hull_scene() {
        fills = scene.fills(theme);
        lines.extend(scene.lines(theme));
    }
    let mut style = style(editor);
    if plane.is_stage() && style.shading == render::Shading::Paint {
        style.shading = render::Shading::Plain;
    }
    let paint = editor
        .plane
        .hull_scene()
        .and_then(HullScene::paint)
        .or(editor.plane.preview_paint())
        .or(editor.look.paint().map(|paint| &paint.faces));
    PlaneFrame {
        mesh: Arc::clone(&plane.mesh.arrays),
        plane: Some(Arc::clone(&plane.arrays)),
        paint: paint.map(Arc::clone),
        fills,
        lines,
        ghost: editor.plane.ghost_layer(theme).filter(|_| !plane.is_stage()),
        picture: editor.picture_layer(),
        outlined: editor.picture_box(),
        style,
        palette: theme.palette,
        camera,
    }
}

fn marks(ui: &egui::Ui, rect: Rect, editor: &Editor, plane: &PlaneScene, camera: PlaneCamera) {
    let theme = theme_of(ui);
    let over = ui.painter_at(rect);
    let size = pane::size_of(rect);
    let spot = |vertex: VertexId| -> Pos2 {
        let z = plane.positions().get(vertex.index()).copied().unwrap_or(DVec2::NAN);
        pane::on_screen(rect, camera.pane_from_embedding(z, size))
    };
    // The verdict is on the result, not on a stage before it.
    if !plane.is_stage() {
        let spot = |z: DVec2| pane::on_screen(rect, camera.pane_from_embedding(z, size));
        super::defect_marks::plane_marks(ui, rect, editor, plane, &spot);
    }
    for vertex in new_vertices(&plane.mesh) {
        new_vertex_mark(&over, spot(vertex), theme);
    }
    if !plane.is_stage() {
        let unmet = editor.unmet_shown();
        for pin in editor.pins_shown() {
            if unmet.contains(&pin.vertex) {
                pins::unmet_mark(&over, spot(pin.vertex), theme);
            }
            let target = pane::on_screen(rect, camera.pane_from_embedding(pin.target, size));
            pins::residual(&over, [spot(pin.vertex), target], theme, pin.kind);
        }
        let spot = |z: DVec2| pane::on_screen(rect, camera.pane_from_embedding(z, size));
        constrain::preview(&over, ui, editor, &spot);
    }
    for &vertex in editor.selection.vertices().iter().take(MARKS_SHOWN) {
        pane::halo(&over, spot(vertex), theme.selection, 6.0);
    }
    if let Some(vertex) = editor.pointer.vertex() {
        pane::halo(&over, spot(vertex), theme.selection, 5.0);
    }
}

/// The stages to choose from, in the upper left corner of the pane, and what the chosen one shows.
fn stage_selector(ui: &mut egui::Ui, rect: Rect, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(scene) = editor.plane.hull_scene() else { return };
    let theme = theme_of(ui);
    let place = Rect::from_min_max(rect.min + egui::vec2(8.0, 8.0), rect.max - egui::vec2(8.0, 8.0));
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(place));
    let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.92)).corner_radius(4).inner_margin(6);
    frame.show(&mut ui, |ui| {
        ui.spacing_mut().item_spacing = egui::vec2(2.0, 4.0);
        if scene.has_stages {
            ui.horizontal_wrapped(|ui| {
                for stage in Stage::ALL {
                    let label = ui.selectable_label(editor.plane.stage() == stage, stage.title());
                    if label.on_hover_text(stage.about()).clicked() {
                        requests.push(Request::SetStage(stage));
                    }
                }
            });
        }
        ui.add(egui::Label::new(egui::RichText::new(&scene.caption).small().color(theme.weak_text)).wrap());
    });
}
