//! Embedding pane: pan, zoom to the pointer; hover, pick and drag.

use std::sync::Arc;

use eframe::egui::{self, Pos2, Rect, Response};
use glam::DVec2;

use super::elements::{self, Marks, Plane};
use super::magnifier::Magnifier;
use super::mesh_pane::{boundary_line, new_vertex_mark, new_vertices, picture_layer, seam_line, style};
use super::pane;
use super::region::{Region, draw_region};
use super::{
    bars, brush, constrain, header, inset, legend, magnifier, map_origin, page_pane, pin_drag, pins, seam, vertex_menu,
};
use crate::render::{self, PaneId, PlaneFrame};
use crate::session::FirstMapWork;
use crate::ui::editor::picture_box::picture_box;
use crate::ui::editor::scene::PlaneScene;
use crate::ui::panels::equation_table;
use crate::ui::state::{Viewport, in_pane, size_of};
use crate::ui::{Control, Editor, HullScene, HullStage, Pane, Request, Theme, Tool, theme_of};
use crate::view::{ElementKind, PlaneCamera};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Surface;

pub(in crate::ui) fn plane_pane_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    header::header(ui, editor, Pane::Plane, requests);
    let (rect, response) = pane::surface(ui, "Embedding in the plane");
    bars::over(ui, rect, editor, Pane::Plane, requests);
    let theme = theme_of(ui);
    ui.painter_at(rect).rect_filled(rect, 0.0, theme.background);
    if let Some(work) = editor.session.first_map_work().filter(|_| editor.session.outcome().is_none()) {
        return pane::empty_state(ui, rect, first_map_words(work));
    }
    map_origin::chip(ui, rect, editor, requests);
    if editor.shows_page() {
        page_pane::plane_ui(ui, &response, editor, requests);
    } else if editor.awaits_page() {
        let words = page_pane::waiting_words(editor);
        pane::empty_state(ui, rect, &words.iter().map(String::as_str).collect::<Vec<_>>());
    } else {
        chart_ui(ui, rect, &response, editor, requests);
    }
}

/// Pane with one chart alone, or the whole map.
fn chart_ui(ui: &mut egui::Ui, rect: Rect, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    editor.lay_out_plane(rect);
    let (Some(plane), Some(mut camera)) = (editor.plane.drawn().map(Arc::clone), editor.plane.pane.camera()) else {
        return pane::empty_state(ui, rect, &waiting_words(editor));
    };
    brush::navigate(ui, response, &mut camera, editor, requests);
    if editor.plane.pane.camera() != Some(camera) {
        editor.plane.pane.set_camera(camera);
        ui.ctx().request_repaint();
    }
    let view = Viewport { rect, camera };
    let magnifier = Magnifier::over(editor, view, &plane).filter(|_| !editor.magnifies_pair());
    let is_covered = |at: Pos2| magnifier.as_ref().is_some_and(|magnifier| magnifier.rect.contains(at));
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|at| rect.contains(*at) && !is_covered(*at));
    if response.hovered() || response.contains_pointer() {
        pick(ui, view, editor, &plane, pointer);
    }
    if editor.gpu.has_gpu() {
        let frame = frame(editor, &plane, camera, theme);
        ui.painter().add(render::plane_pane(PaneId("plane"), rect, frame));
    }
    if !brush::takes_drags(editor)
        && let Some(region) = draw_region(ui, response, editor, Pane::Plane)
    {
        requests.push(within(view, &region, editor, &plane));
    }
    pane::click(ui, response, editor, requests);
    vertex_menu::of_pane(response, editor, requests);
    marks(ui, view, editor, &plane);
    equation_table::draw(ui, view, editor, &plane);
    if !brush::hides_pins(editor, &plane) {
        pin_drag::pins_ui(ui, view, editor, requests);
    }
    brush::over_plane(ui, response, view, editor, requests);
    if !plane.is_stage() {
        magnifier::over_plane(ui, view, editor, &plane, requests);
    }
    if let Some(magnifier) = magnifier {
        magnifier.show(ui, editor, &plane, requests);
    }
    stage_selector(ui, rect, editor, requests);
    brush::bar(ui, rect, editor, requests);
    if legend::plane_has_own(editor) {
        legend::legend(ui, rect, editor, Pane::Plane);
        legend::no_move_note(ui, rect, editor, Pane::Plane);
    }
    if !plane.is_stage() {
        legend::ghost_note(ui, rect, editor, requests);
    }
}

/// Sets the element under the pointer: a pin by its mark, which lies over the vertices, else the nearest vertex.
fn pick(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &mut Editor, plane: &PlaneScene, pointer: Option<Pos2>) {
    let Viewport { rect, camera } = view;
    let pointer = pointer.filter(|_| editor.is_of_session(&plane.mesh));
    let grip = pointer.filter(|_| !plane.is_stage()).and_then(|at| pin_drag::pin_at(editor, view, at));
    let nearest = |at| plane.picker.nearest_vertex(&camera, size_of(rect), in_pane(rect, at));
    let pick = pointer.and_then(nearest);
    editor.pointer.over_plane(pointer.map(|at| view.point_at(at)), grip.or(pick.map(|pick| pick.vertex)));
    let kind = editor.kind_under_pointer().filter(|kind| *kind != ElementKind::Vertices && grip.is_none());
    if let Some((kind, at)) = kind.zip(pointer) {
        editor.pointer.set_element(Plane::of_chart(plane).element_at(kind, view, at));
    }
    editor.aim(ui, Pane::Plane, grip);
    if editor.tools.tool() == Tool::Seam {
        editor.pick_seam_vertex_in_plane(&plane.mesh);
    }
}

const fn first_map_words(work: FirstMapWork) -> &'static [&'static str] {
    match work {
        FirstMapWork::Check => &["Checking the layout of the file…", "It appears here if it is one-to-one"],
        FirstMapWork::Seams => &["Unwrapping…", "The map appears here once short seams are found"],
    }
}

fn waiting_words(editor: &Editor) -> Vec<&'static str> {
    match editor.session.model().map(|model| &model.prepared.surface) {
        None => vec!["The embedding appears here"],
        Some(Surface::Faulty(..)) if editor.session.seam_search().is_some() => {
            vec!["Unwrapping…", "The map appears here once short seams are found"]
        }
        Some(Surface::Faulty(..)) => {
            vec![
                "This mesh has faults that prevent flattening",
                "The bars above the mesh and the Defects tab list the faults",
            ]
        }
        Some(Surface::Disk(_)) if editor.session.busy().is_some() => vec!["Solving…"],
        Some(Surface::Disk(_)) => vec!["Not solved", "Press Solve in the Method panel"],
    }
}

/// Camera moves: pan, zoom to the pointer.
pub(super) fn navigate(ui: &egui::Ui, response: &Response, camera: &mut PlaneCamera) {
    let drag = DVec2::new(response.drag_delta().x.into(), response.drag_delta().y.into());
    let boxing = ui.input(|input| input.modifiers.command);
    if response.dragged() && !(boxing && response.dragged_by(egui::PointerButton::Primary)) {
        camera.pan(drag);
    }
    zoom(ui, response, camera);
}

/// Zoom to the pointer, and pan by two fingers.
pub(super) fn zoom(ui: &egui::Ui, response: &Response, camera: &mut PlaneCamera) {
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|_| response.contains_pointer());
    if let Some(pointer) = pointer.filter(|_| !inset::has_wheel(ui)) {
        let wheel = pane::wheel(ui);
        if (wheel.zoom - 1.0).abs() > f64::EPSILON {
            camera.zoom_at(in_pane(response.rect, pointer), wheel.zoom, size_of(response.rect));
        }
        camera.pan(wheel.pan);
    }
}

/// Request that selects the elements inside a region of the screen, and vertices with targets inside it.
fn within(view: Viewport<PlaneCamera>, region: &Region, editor: &Editor, plane: &PlaneScene) -> Request {
    let kind = editor.kind_under_pointer().unwrap_or_default();
    let inside = Plane::of_chart(plane).inside(kind, view, region);
    if kind != ElementKind::Vertices {
        return Request::AddElements(inside);
    }
    let pins = editor.pins_shown().into_iter().filter(|pin| region.contains(view.spot(pin.target)));
    Request::AddToSelection(inside.vertices().iter().copied().chain(pins.map(|pin| pin.vertex)).collect())
}

pub(super) fn frame(editor: &Editor, plane: &PlaneScene, camera: PlaneCamera, theme: &Theme) -> PlaneFrame {
    let hull = editor.plane.hull_scene();
    let mut lines = vec![boundary_line(&plane.mesh, theme), seam_line(&plane.mesh.seams, theme)];
    lines.extend(editor.selection.lines(plane.mesh.arrays.revision).map(|edges| elements::line_of(edges, theme)));
    lines.extend(hull.into_iter().flat_map(|scene| scene.lines(theme)));
    let mut style = style(editor, Pane::Plane);
    if plane.is_stage() && style.shading == render::FaceShading::Paint {
        style.shading = render::FaceShading::Plain;
    }
    let of_stage = hull.and_then(HullScene::paint).or(editor.plane.preview_paint());
    let paint = of_stage.or(editor.pane_shading.paint(Pane::Plane).map(|paint| &paint.faces));
    PlaneFrame {
        mesh: Arc::clone(&plane.mesh.arrays),
        plane: Some(Arc::clone(&plane.arrays)),
        paint: paint.map(Arc::clone),
        fills: hull.map(|scene| scene.fill(theme)).into_iter().collect(),
        lines,
        ghost: editor.plane.ghost_layer(theme).filter(|_| !plane.is_stage()),
        picture: picture_layer(editor),
        pattern: editor.pane_shading.checker.tile(),
        outlined: picture_box(editor.session.document()),
        style,
        palette: theme.palette,
        camera,
    }
}

fn marks(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, plane: &PlaneScene) {
    let theme = theme_of(ui);
    let over = ui.painter_at(view.rect);
    let spot = |vertex: VertexId| view.spot(plane.position_of(vertex).unwrap_or(DVec2::NAN));
    // The verdict is on the result, not on a stage before it.
    if !plane.is_stage() {
        pane::plane_marks(ui, view, editor, plane);
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
            pins::residual(&over, [spot(pin.vertex), view.spot(pin.target)], theme, pin.kind);
        }
        constrain::landmarks(ui, view, editor);
        constrain::preview(ui, view, editor, plane);
        seam::over_plane(ui, view, editor, plane);
    }
    let seen = |vertex: VertexId| Some(view.spot(plane.position_of(vertex)?));
    let mesh = plane.mesh.elements();
    let selected = editor.selection.elements_on(&plane.mesh);
    let marks = Marks { painter: &over, theme, mesh: &mesh };
    marks.selection(selected, seen, |_| true);
    marks.under_pointer(editor.pointer.element(), seen);
    if editor.is_of_session(&plane.mesh) {
        for side in editor.tools.seam_hover.sides() {
            over.line_segment(side.map(spot), pane::seam_stroke(theme));
        }
    }
    if let Some(vertex) = editor.pointer.vertex().filter(|_| editor.pointer.element().is_none()) {
        // At a cut, mark the copies on both sides.
        let copies = plane.mesh.in_file.vertex(vertex).into_iter().flat_map(|of| plane.mesh.in_file.copies(of));
        copies.filter(|copy| *copy != vertex).for_each(|copy| pane::halo(&over, spot(copy), theme.selection, 4.0));
        pane::halo(&over, spot(vertex), theme.selection, 5.0);
        let pin = editor.session.document().targets.get(&vertex);
        let at = pin.map_or(spot(vertex), |pin| view.spot(editor.session.document().frame().plane_from_uv(pin.uv)));
        pins::name_beside(&over, at, theme, editor);
    }
}

/// Selector of the stages in the upper left corner of the pane, and the caption of the chosen stage.
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
                for stage in HullStage::ALL {
                    let [title, about] = stage.words();
                    let label = ui.selectable_label(editor.plane.stage() == stage, title).on_hover_text(about);
                    label.asks(Request::SetStage(stage), requests);
                }
            });
        }
        ui.add(egui::Label::new(egui::RichText::new(&scene.caption).small().color(theme.weak_text)).wrap());
    });
}
