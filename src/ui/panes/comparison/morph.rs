//! Morph between two methods, in place of the cells. Shows its ends, a large view of a frame with its verdict, and a
//! slider over the frames.

use std::sync::Arc;

use eframe::egui::{self, Rect, Role, Vec2, WidgetInfo};

use super::LEGEND;
use super::cell::quiet;
use crate::render::{self, FaceShading, PaneId, PlaneFrame, Style};
use crate::session::{Compared, Contender, ContenderState, MorphState, MorphTour};
use crate::ui::editor::comparison::MorphFrame;
use crate::ui::editor::picture_box::picture_box;
use crate::ui::panes::mesh_pane::boundary_line;
use crate::ui::panes::plane_pane::navigate;
use crate::ui::panes::{legend, pane};
use crate::ui::state::size_of;
use crate::ui::{Control, Editor, MorphRequest, Request, list, theme_of};
use crate::view::PlaneCamera;
use freebound_core::problem::{Phase, Variant};

/// Height of the row of the ends, and of the row of the slider, points.
const ROW: f32 = 30.0;

/// Height of the line with the verdict, points.
const LINE: f32 = 20.0;

pub(super) fn morph_ui(ui: &mut egui::Ui, room: Rect, editor: &mut Editor, requests: &mut Vec<Request>) {
    ui.painter().rect_filled(room, 0.0, theme_of(ui).background);
    let ends = editor.session.morph_ends();
    let [above, below] = room.split_top_bottom_at_y((room.top() + ROW).min(room.bottom())).into();
    row(ui, above, |ui| ends_row(ui, editor, &ends, requests));
    match editor.session.morph() {
        MorphState::Done(tour) => found(ui, below, editor, &tour, requests),
        state => nothing_yet(ui, below, editor, &state),
    }
}

/// Row of controls in a part of the pane.
fn row(ui: &mut egui::Ui, part: Rect, add: impl FnOnce(&mut egui::Ui)) {
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let part = part.shrink2(Vec2::new(8.0, 0.0));
    ui.scope_builder(egui::UiBuilder::new().max_rect(part).layout(layout), |ui| {
        ui.set_clip_rect(part.intersect(ui.clip_rect()));
        add(ui);
    });
}

/// Lists to choose the methods at both ends, among methods with planar maps.
fn ends_row(ui: &mut egui::Ui, editor: &Editor, ends: &[(Variant, Arc<Compared>)], requests: &mut Vec<Request>) {
    let Some(between) = editor.session.morph_between() else { return };
    let width = ((ui.available_width() - 130.0) / 2.0).clamp(60.0, 240.0);
    let names = [("From", "Method that the morph begins with"), ("to", "Method that the morph ends with")];
    let requests_of: [fn(Variant) -> MorphRequest; 2] = [MorphRequest::From, MorphRequest::To];
    for (((words, name), request), now) in names.into_iter().zip(requests_of).zip(between) {
        ui.label(words);
        let menu = list(ui, name, width, &now.title(), |ui| {
            for (variant, _) in ends {
                let entry = ui.selectable_label(*variant == now, variant.title());
                entry.asks(Request::Morph(request(variant.clone())), requests);
            }
        });
        menu.on_hover_text("Methods with planar maps. If both ends are the same, the other end changes");
    }
}

/// Message while there is no morph.
fn nothing_yet(ui: &mut egui::Ui, room: Rect, editor: &Editor, state: &MorphState) {
    let (first, second) = match state {
        MorphState::Running(phase, frames) => {
            let phase = phase.map_or("preparing", Phase::words);
            (format!("Finding the morph: {phase}, {frames} frames tested"), "Esc cancels".to_owned())
        }
        MorphState::Failed(why) => (format!("No morph: {why}"), "Choose other methods above".to_owned()),
        MorphState::TooLarge(shortage) => (
            format!("No morph: {shortage}"),
            "Use fewer frames on the command line: freebound compare --morph --frames".to_owned(),
        ),
        _ if awaits_change(editor) => ("The morph waits until the change is finished".to_owned(), String::new()),
        _ if editor.session.is_comparing() => {
            ("The methods are still running".to_owned(), "The morph follows when they have finished".to_owned())
        }
        _ if editor.session.is_morphing() => ("The morph waits until the document is solved".to_owned(), String::new()),
        _ => (
            "A morph needs two planar maps".to_owned(),
            "Choose methods with planar maps under Methods, such as Convex boundary or Auto".to_owned(),
        ),
    };
    let lines: Vec<&str> = [first.as_str(), second.as_str()].into_iter().filter(|line| !line.is_empty()).collect();
    pane::empty_state(ui, room, &lines);
    let region = ui.interact(room, ui.scope_id().with("no morph"), egui::Sense::hover());
    region.named(Role::Label, &lines.join(". "));
}

/// True if both methods still take part, but their maps wait for a change of the document to finish.
fn awaits_change(editor: &Editor) -> bool {
    let session = &editor.session;
    let Some(between) = session.morph_between() else { return false };
    let ends = between.map(|variant| session.contenders().iter().find(|of| of.variant() == variant));
    let [Some(first), Some(second)] = ends else { return false };
    // If no method is left to run, a waiting method waits for the requested preparation of the mesh.
    let waits = |of: &Contender| session.contender_state(of) == ContenderState::Waiting;
    session.is_in_gesture() || (!session.is_comparing() && (waits(first) || waits(second)))
}

/// Frame on the screen, the slider, and the verdict on the frame.
fn found(ui: &mut egui::Ui, room: Rect, editor: &mut Editor, tour: &Arc<MorphTour>, requests: &mut Vec<Request>) {
    let Some(leg) = tour.legs.first() else { return };
    let quantity = editor.plane.comparison.quantity();
    let mesh = editor.mesh.scene().filter(|mesh| mesh.model_revision == editor.session.model_revision()).cloned();
    let frame = editor.plane.comparison.morph.drawn(mesh.as_ref(), tour, quantity);
    let strip = if quantity.is_some() { LEGEND } else { 0.0 };
    let low = room.bottom() - ROW - LINE;
    let view = Rect::from_min_max(room.min, egui::pos2(room.right(), (low - strip).max(room.top() + 1.0)));
    let number = editor.plane.comparison.morph.frame_of(leg.frames.len());
    let verdict = leg.verdicts[number].summary();
    let words = format!("Frame {} of {} · {verdict} · {}", number + 1, leg.frames.len(), leg.route.words());
    large_view(ui, view, editor, frame.as_ref(), &words);
    if let Some((quantity, legend)) = quantity.zip(frame.as_ref().and_then(|frame| frame.legend.as_ref())) {
        let strip = Rect::from_min_max(view.left_bottom(), egui::pos2(room.right(), low));
        legend::strip(ui, strip, quantity.title(), legend);
    }
    let line = Rect::from_min_size(egui::pos2(room.left(), low), Vec2::new(room.width(), LINE));
    row(ui, line, |ui| {
        ui.add(egui::Label::new(&words).truncate());
    });
    let controls = Rect::from_min_max(line.left_bottom(), room.max);
    row(ui, controls, |ui| controls_row(ui, editor, leg.frames.len(), requests));
}

/// Embedding of a frame.
fn large_view(ui: &egui::Ui, view: Rect, editor: &mut Editor, frame: Option<&MorphFrame>, words: &str) {
    let response = ui.interact(view, ui.scope_id().with("morph"), egui::Sense::click_and_drag());
    let before = editor.plane.comparison.morph.camera_in(size_of(view));
    let mut camera = before;
    navigate(ui, &response, &mut camera);
    if camera != before {
        editor.plane.comparison.morph.set_camera(camera);
        ui.ctx().request_repaint();
    }
    if let Some(frame) = frame.filter(|_| editor.gpu.has_gpu()) {
        ui.painter().add(render::plane_pane(PaneId("morph"), view, drawing(ui, editor, frame, frame.camera(&camera))));
    }
    response.named(Role::Image, &format!("Morph: {words}"));
}

fn drawing(ui: &egui::Ui, editor: &Editor, frame: &MorphFrame, camera: PlaneCamera) -> PlaneFrame {
    let theme = theme_of(ui);
    let shading = if frame.legend.is_some() { FaceShading::Paint } else { FaceShading::Plain };
    PlaneFrame {
        mesh: Arc::clone(&frame.mesh.arrays),
        plane: Some(Arc::clone(&frame.arrays)),
        paint: Some(Arc::clone(&frame.faces)),
        fills: Vec::new(),
        lines: vec![boundary_line(&frame.mesh, theme)],
        ghost: None,
        picture: None,
        pattern: None,
        outlined: picture_box(editor.session.document()),
        style: Style {
            shading,
            wire_in_points: if editor.pane_shading.wireframe { 1.0 } else { 0.0 },
            ..Style::default()
        },
        palette: quiet(theme.palette, false),
        camera,
    }
}

/// Play button, and slider over `count` frames.
fn controls_row(ui: &mut egui::Ui, editor: &Editor, count: usize, requests: &mut Vec<Request>) {
    let morph = &editor.plane.comparison.morph;
    let (words, name) = if morph.is_playing() { ("Pause", "Pause the morph") } else { ("Play", "Play the morph") };
    let play = ui.add(egui::Button::new(words).min_size(Vec2::new(56.0, 0.0)));
    let play = play.on_hover_text("Play from this frame to the end, or pause");
    play.named(Role::Button, name).asks(Request::Morph(MorphRequest::Play), requests);
    let mut number = morph.frame_of(count) + 1;
    ui.spacing_mut().slider_width = (ui.available_width() - 70.0).max(40.0);
    let slider = ui.add(egui::Slider::new(&mut number, 1..=count));
    let slider = slider.on_hover_text("From the first map to the last. Every frame is proved");
    if slider.changed() {
        let share = number.saturating_sub(1) as f64 / count.saturating_sub(1).max(1) as f64;
        requests.push(Request::Morph(MorphRequest::Seek(share)));
    }
    slider.widget_info(|| WidgetInfo::slider(true, number as f64, "Frame of the morph"));
}
