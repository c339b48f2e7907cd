//! Cell of a compared method: its embedding, name, verdict and numbers.

use std::sync::Arc;

use eframe::egui::{self, Pos2, Rect, Response, RichText, Role, Sense, Stroke, Vec2};
use glam::DVec2;

use crate::render::{self, FaceShading, PaneId, PlaneFrame, Style};
use crate::session::{Contender, ContenderState, Session};
use crate::ui::editor::comparison::CellScene;
use crate::ui::editor::picture_box::picture_box;
use crate::ui::icons::{self, Sign};
use crate::ui::panes::mesh_pane::boundary_line;
use crate::ui::panes::pane;
use crate::ui::panes::plane_pane::navigate;
use crate::ui::state::{Viewport, size_of};
use crate::ui::{Control, Editor, Request, Theme, theme_of};
use crate::view::{Palette, PlaneCamera};
use freebound_core::mesh::VertexId;
use freebound_core::problem::Variant;
use freebound_io::MethodReport;

/// Identifiers of the drawing surfaces.
const PANES: [PaneId; 6] = [
    PaneId("comparison 1"),
    PaneId("comparison 2"),
    PaneId("comparison 3"),
    PaneId("comparison 4"),
    PaneId("comparison 5"),
    PaneId("comparison 6"),
];

/// Height of the line with the name, and of each line of numbers, points.
const NAME: f32 = 19.0;
const LINE: f32 = 14.0;

/// Free space below the last line, points.
const BELOW: f32 = 4.0;

/// Greatest number of lines below the name.
const LINES: usize = 4;

/// Least height of a cell with more than its verdict below the name, points. The table has the other numbers.
const ROOM_FOR_NUMBERS: f32 = 190.0;

/// Greatest number of marked crossings.
const MARKS: usize = 200;

/// Rectangle of the embedding in a cell of a size.
pub(super) fn view_of(cell: Rect, size: Vec2) -> Rect {
    let words = NAME + LINE * lines_in(size) as f32 + BELOW;
    Rect::from_min_max(cell.min, cell.max - Vec2::new(0.0, words.min(cell.height() - 1.0)))
}

fn lines_in(size: Vec2) -> usize {
    if size.y < ROOM_FOR_NUMBERS { 1 } else { LINES }
}

/// Texts of a cell.
struct CellWords {
    sign: Sign,
    title: String,
    /// Lines below the title.
    lines: Vec<String>,
    /// Text over the drawing, if the drawing is not up to date.
    over: Option<String>,
}

impl CellWords {
    fn of(session: &Session, contender: &Contender) -> Self {
        let state = &session.contender_state(contender);
        let found = contender.found().map(|found| &found.report);
        let working = |words: &str| if found.is_some() { format!("{words} again…") } else { format!("{words}…") };
        let over = match state {
            // Methods run only while nothing else does.
            ContenderState::Waiting if session.is_running() => Some("waiting until the document is solved".to_owned()),
            ContenderState::Waiting => Some(if found.is_some() { "to be solved again" } else { "waiting…" }.to_owned()),
            ContenderState::Running(None, _) => Some(working("solving")),
            ContenderState::Running(Some(phase), 0) => Some(working(phase.words())),
            ContenderState::Running(Some(phase), steps) => Some(format!("step {steps}, {}…", phase.words())),
            ContenderState::Lost(words) => Some(words.clone()),
            ContenderState::Done => None,
        };
        let is_done = *state == ContenderState::Done;
        let sign = match found.and_then(|report| report.result.as_ref()) {
            _ if matches!(state, ContenderState::Lost(_)) => Sign::Bad,
            _ if !is_done => Sign::Working,
            Some(result) if result.verdict.planar && result.pins.unmet.is_empty() => Sign::Good,
            Some(result) if result.verdict.planar => Sign::Unmet,
            _ => Sign::Bad,
        };
        let numbers =
            |report: &MethodReport| std::iter::once(report.verdict_line()).chain(report.number_lines()).collect();
        let lines = found.map_or_else(Vec::new, numbers);
        Self { sign, title: contender.variant().title(), lines, over }
    }

    /// All texts of the cell, for screen readers.
    fn name(&self) -> String {
        let over = self.over.iter().map(String::as_str);
        let all: Vec<&str> = over.chain(self.lines.iter().map(String::as_str)).collect();
        format!("{}: {}", self.title, all.join("; "))
    }
}

/// Shows the method with this index.
pub(super) fn cell(ui: &mut egui::Ui, rect: Rect, editor: &mut Editor, number: usize, requests: &mut Vec<Request>) {
    let contender = &editor.session.contenders()[number];
    let variant = contender.variant();
    let words = CellWords::of(&editor.session, contender);
    let scene = editor.plane.comparison.cell(contender);
    let failure = contender.found().map(|found| found.report.error_words()).unwrap_or_default();
    let view = view_of(rect, rect.size());
    let response = ui.interact(rect, ui.scope_id().with(("comparison", number)), Sense::click_and_drag());
    let is_own = Variant::of(&editor.session.document().settings) == variant;
    if let Some(camera) = editor.plane.comparison.camera(size_of(view)) {
        move_camera(ui, &response, view, editor, camera);
    }
    if let (Some(scene), Some(camera)) = (scene, editor.plane.comparison.camera(size_of(view))) {
        let view = Viewport { rect: view, camera: scene.frame.camera(&camera) };
        if editor.gpu.has_gpu() {
            let frame = frame_of(editor, &scene, view.camera, theme_of(ui));
            ui.painter().add(render::plane_pane(PANES[number % PANES.len()], view.rect, frame));
        }
        marks(ui, view, &scene);
    }
    if words.over.is_some() || !failure.is_empty() {
        veil(ui, view, words.over.as_deref().unwrap_or(&failure));
    }
    name_and_numbers(ui, Rect::from_min_max(egui::pos2(rect.left(), view.bottom()), rect.max), &words);
    outline(ui, rect, &response, is_own);
    let tip = if is_own { "The method of the document" } else { "Click to use this method for the document" };
    let response = response.named(Role::Button, &words.name()).on_hover_text_at_pointer(tip);
    if !is_own {
        response.asks(Request::TakeContender(variant), requests);
    }
}

/// Moves the camera of all cells after input over this cell.
fn move_camera(ui: &egui::Ui, response: &Response, view: Rect, editor: &mut Editor, camera: PlaneCamera) {
    let mut moved = camera;
    navigate(ui, &response.clone().with_new_rect(view), &mut moved);
    if moved != camera {
        editor.plane.comparison.set_camera(moved);
        ui.ctx().request_repaint();
    }
}

fn frame_of(editor: &Editor, scene: &CellScene, camera: PlaneCamera, theme: &Theme) -> PlaneFrame {
    let plane = &scene.plane;
    let shading = match editor.plane.comparison.quantity() {
        Some(_) => FaceShading::Paint,
        None => FaceShading::Plain,
    };
    PlaneFrame {
        mesh: Arc::clone(&plane.mesh.arrays),
        plane: Some(Arc::clone(&plane.arrays)),
        paint: Some(Arc::clone(&scene.faces)),
        fills: Vec::new(),
        lines: vec![boundary_line(&plane.mesh, theme)],
        ghost: None,
        picture: None,
        pattern: None,
        outlined: picture_box(editor.session.document()),
        style: Style {
            shading,
            wire_in_points: if editor.pane_shading.wireframe { 1.0 } else { 0.0 },
            ..Style::default()
        },
        palette: quiet(theme.palette, plane.outcome.is_held()),
        camera,
    }
}

/// Palette without the grid, whose position differs from cell to cell. Also hides the outline of the picture unless
/// the embedding is held on the picture.
pub(super) fn quiet(palette: Palette, is_on_picture: bool) -> Palette {
    let unit_square = if is_on_picture { palette.unit_square } else { palette.background };
    Palette { grid: palette.background, unit_square, ..palette }
}

/// Rings around crossings and overwound vertices.
fn marks(ui: &egui::Ui, view: Viewport<PlaneCamera>, scene: &CellScene) {
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let plane = &scene.plane;
    let verdict = &plane.outcome.step.verdict;
    let at = |vertex: VertexId| plane.position_of(vertex).unwrap_or(DVec2::NAN);
    let Some(disk) = plane.mesh.disk() else { return };
    for pair in verdict.boundary_crossings.iter().take(MARKS) {
        let [first, second] = pair.map(|edge| disk.ends(edge).map(at));
        painter.circle_stroke(view.spot(pane::crossing_point(first, second)), 4.0, Stroke::new(1.5, theme.crossing));
    }
    for &vertex in verdict.overwound_vertices.iter().take(MARKS) {
        pane::overwound_mark(&painter, view.spot(at(vertex)), theme);
    }
}

/// Dims the drawing and shows the reason why it is missing or out of date.
fn veil(ui: &egui::Ui, view: Rect, words: &str) {
    let theme = theme_of(ui);
    ui.painter_at(view).rect_filled(view, 0.0, theme.background.gamma_multiply(0.75));
    pane::small_state(ui, view, words);
}

/// Outline of a cell, strong for the method of the document.
fn outline(ui: &egui::Ui, rect: Rect, response: &Response, is_own: bool) {
    let theme = theme_of(ui);
    let (width, colour) = match (is_own, response.hovered() || response.has_focus()) {
        (true, _) => (2.0, theme.accent),
        (false, true) => (1.0, theme.accent),
        (false, false) => (1.0, theme.separator),
    };
    ui.painter().rect_stroke(rect, 3.0, Stroke::new(width, colour), egui::StrokeKind::Inside);
}

/// Sign and name in a line, with the numbers below.
fn name_and_numbers(ui: &mut egui::Ui, room: Rect, words: &CellWords) {
    let theme = theme_of(ui);
    let room = room.shrink2(Vec2::new(6.0, 0.0));
    ui.painter().rect_filled(room.expand2(Vec2::new(5.0, -1.0)), 0.0, theme.panel);
    let sign = Rect::from_center_size(room.left_top() + Vec2::new(6.0, NAME / 2.0), Vec2::splat(11.0));
    icons::sign(ui.painter(), sign, words.sign, theme);
    let line = |ui: &egui::Ui, at: Pos2, text: RichText| {
        let width = room.right() - at.x;
        let text = egui::WidgetText::from(text);
        let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), width, egui::TextStyle::Small);
        ui.painter_at(room).galley(at - Vec2::new(0.0, galley.size().y / 2.0), galley, theme.text);
    };
    let title = RichText::new(&words.title).text_style(egui::TextStyle::Body).strong();
    line(ui, room.left_top() + Vec2::new(18.0, NAME / 2.0), title);
    for (number, text) in words.lines.iter().enumerate() {
        let at = room.left_top() + Vec2::new(0.0, NAME + LINE * (number as f32 + 0.5));
        if at.y + LINE / 2.0 <= room.bottom() + 1.0 {
            line(ui, at, RichText::new(text).small().color(theme.weak_text));
        }
    }
}
