//! The embedding: pan, zoom to the pointer; hover, pick and drag.

use std::sync::Arc;

use eframe::egui;
use egui::{Pos2, Rect, Response};
use glam::DVec2;

use super::compare;
use super::constrain;
use super::hull;
use super::magnifier::Magnifier;
use super::mesh_pane::{boundary_line, clicked, cursor, new_vertex_mark, new_vertices, style};
use super::pair_magnifier;
use super::pane;
use super::pin_drag;
use super::pins;
use crate::mesh::VertexId;
use crate::render::{self, PaneId, PlaneFrame};
use crate::session::{Place, Surface};
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Editor, Pane, Request};
use crate::view::PlaneCamera;

/// Marks drawn at most for a large selection.
const MARKS_SHOWN: usize = 2000;

/// Shows the pane and takes its gestures.
pub(in crate::ui) fn plane_pane_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    pane::header(ui, editor, Pane::Plane, requests);
    super::bars::bars(ui, editor, Pane::Plane, requests);
    pane::message_bars(ui, editor, Place::Embedding, requests);
    let (rect, response) = pane::surface(ui, "Embedding in the plane");
    editor.pane_rects[1] = Some(rect);
    if editor.plane_pane_size != pane::size_of(rect) {
        editor.plane_pane_size = pane::size_of(rect);
        editor.keep_framed();
    }
    let theme = theme_of(ui);
    ui.painter_at(rect).rect_filled(rect, 0.0, theme.background);
    let scenes = (editor.mesh_scene().map(Arc::clone), editor.drawn_plane().map(Arc::clone));
    let (Some(mesh), Some(plane), Some(mut camera)) = (scenes.0, scenes.1, editor.plane_camera) else {
        return pane::empty_state(ui, rect, &waiting_words(editor));
    };
    navigate(ui, rect, &response, &mut camera);
    if editor.plane_camera != Some(camera) {
        editor.plane_camera = Some(camera);
        ui.ctx().request_repaint();
    }
    let magnifier = Magnifier::over(editor, rect, &plane).filter(|_| !editor.magnifies_pair());
    let is_covered = |at: Pos2| magnifier.as_ref().is_some_and(|magnifier| magnifier.rect.contains(at));
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|at| rect.contains(*at) && !is_covered(*at));
    if response.hovered() || response.contains_pointer() {
        look_under(ui, editor, (rect, &plane, camera), pointer);
    }
    if editor.host.has_gpu() {
        let frame = frame(editor, (&mesh, &plane), camera, theme);
        ui.painter().add(render::plane_pane(PaneId("plane"), rect, frame));
    }
    select(ui, &response, editor, &plane, requests);
    marks(ui, rect, editor, (&mesh, &plane), camera);
    crate::ui::panels::equation_table::draw(ui, rect, editor, &plane, camera);
    if !plane.is_stage() {
        pin_drag::pins_ui(ui, rect, editor, camera, requests);
        pair_magnifier::over_plane(ui, rect, editor, (&mesh, &plane));
    }
    if let Some(magnifier) = magnifier {
        magnifier.show(ui, editor, (&mesh, &plane), requests);
    }
    hull::stage_selector(ui, rect, editor, requests);
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
fn look_under(
    ui: &egui::Ui,
    editor: &mut Editor,
    (rect, plane, camera): (Rect, &PlaneScene, PlaneCamera),
    pointer: Option<Pos2>,
) {
    let size = pane::size_of(rect);
    let grip = pointer.filter(|_| !plane.is_stage()).and_then(|at| pin_drag::pin_at(editor, rect, camera, at));
    let pointer = pointer.map(|at| pane::in_pane(rect, at));
    let pick = pointer.and_then(|at| plane.picker.nearest_vertex(&camera, size, at));
    let place = pointer.map(|at| camera.embedding_from_pane(at, size));
    editor.pointer.over_plane(place, grip.or(pick.map(|pick| pick.vertex)));
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
    let Some(camera) = editor.plane_camera else { return };
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

pub(in crate::ui) fn frame(
    editor: &Editor,
    (mesh, plane): (&MeshScene, &PlaneScene),
    camera: PlaneCamera,
    theme: &Theme,
) -> PlaneFrame {
    let mut lines = vec![boundary_line(mesh, theme)];
    let mut fills = Vec::new();
    if let Some(scene) = editor.hull_scene() {
        fills = scene.fills(theme);
        lines.extend(scene.lines(theme));
    }
    let mut style = style(editor);
    if plane.is_stage() && style.shading == render::Shading::Paint {
        style.shading = render::Shading::Plain;
    }
    let paint = editor.stage_paint().or(editor.preview_paint()).or(editor.look.paint().map(|paint| &paint.faces));
    PlaneFrame {
        mesh: Arc::clone(&mesh.arrays),
        plane: Some(Arc::clone(&plane.arrays)),
        paint: paint.map(Arc::clone),
        fills,
        lines,
        ghost: editor.ghost.as_ref().filter(|_| !plane.is_stage()).map(|ghost| ghost.layer(theme)),
        picture: editor.picture_layer(),
        outlined: editor.picture_box(),
        style,
        palette: theme.palette,
        camera,
    }
}

fn marks(ui: &egui::Ui, rect: Rect, editor: &Editor, (mesh, plane): (&MeshScene, &PlaneScene), camera: PlaneCamera) {
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
        super::defect_marks::plane_marks(ui, rect, editor, (mesh, plane), &spot);
    }
    for vertex in new_vertices(mesh) {
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
