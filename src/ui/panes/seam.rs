//! Seam tool in the panes: the vertex under the pointer, the preview of a cut, and the strip of options.

use eframe::egui::{self, Pos2, Stroke, WidgetInfo};

use super::pane;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::editor::seam_intent::SeamIntent;
use crate::ui::editor::seam_tool::{BRUSH, CREASES};
use crate::ui::state::{Edge, Viewport};
use crate::ui::theme::on_screen;
use crate::ui::timeline::lasting_menu;
use crate::ui::typed::Typed;
use crate::ui::{
    Control, Editor, FileDialogKind, Offer, Request, SeamRule, Theme, Tool, counted, theme_of, tip_with_keys,
};
use crate::view::{OrbitCamera, PlaneCamera};
use freebound_core::mesh::VertexId;

/// Opacity of edges that the mesh hides.
const HIDDEN: f32 = 0.4;

/// Width of a path that a click would cut, points: less than the width of a seam.
const CUT_WIDTH: f32 = 2.0;

/// Width of the dashes over a seam that a click would close, points.
const CLOSE_WIDTH: f32 = 3.0;

impl Editor {
    /// Sets the vertex of the file under the pointer in the mesh pane, on any chart.
    pub(super) fn pick_seam_vertex(&mut self, scene: &MeshScene, camera: &OrbitCamera, pointer: glam::DVec2) {
        let size = self.mesh.pane.size();
        let of_chart = self.pointer.vertex().and_then(|vertex| scene.in_file.vertex(vertex));
        let found = self.tools.seam.ground().map(|ground| ground.vertex_at(camera, size, pointer));
        let vertex = found.unwrap_or(of_chart);
        self.tools.seam.set_under(vertex);
        if found.is_some() {
            let shown = vertex.filter(|_| self.is_of_session(scene)).and_then(|of| scene.in_file.copies(of).next());
            self.pointer.over_mesh(shown);
        }
        self.foresee_seam();
    }

    /// Sets the vertex of the file under the pointer in the embedding pane, from the vertex on the screen.
    pub(super) fn pick_seam_vertex_in_plane(&mut self, scene: &MeshScene) {
        let vertex = self.pointer.vertex().and_then(|vertex| scene.in_file.vertex(vertex));
        self.tools.seam.set_under(vertex);
        self.foresee_seam();
    }

    /// Hint for the status bar.
    pub(in crate::ui) fn seam_words(&self, has_shift: bool) -> String {
        let seam = &self.tools.seam;
        if seam.paints() {
            let words = if seam.erases() == has_shift {
                "Drag over the mesh: no automatic seam runs there. Shift takes paint away. Drag beside it to orbit."
            } else {
                "Drag over paint to take it away. Drag beside the mesh to orbit."
            };
            return words.to_owned();
        }
        let edges = |edges: &[Edge]| counted(edges.len(), "edge", "edges");
        match (seam.foreseen(), seam.under(), seam.last()) {
            (Some(SeamIntent::Begin), Some(vertex), _) => format!("Click: start the seam at {vertex}."),
            (Some(SeamIntent::Add(path)), Some(vertex), _) => {
                format!("Click: cut {} to {vertex}. Enter ends the seam, Shift erases.", edges(path))
            }
            (Some(SeamIntent::TakeAway(path)), ..) => format!("Click: erase {} of the seam.", edges(path)),
            (Some(SeamIntent::End), ..) => "Click: end the seam here.".to_owned(),
            (Some(SeamIntent::Wait), ..) => "Finding the paths from here…".to_owned(),
            (Some(SeamIntent::Nothing), Some(vertex), None) => format!("No seam is at {vertex}."),
            (Some(SeamIntent::Nothing), Some(vertex), Some(last)) if seam.erases() != has_shift => {
                format!("No seam leads from {last} to {vertex}.")
            }
            (Some(SeamIntent::Nothing), Some(vertex), Some(last)) => {
                format!("No edges lead from {last} to {vertex}: they belong to different parts.")
            }
            (_, _, None) if seam.erases() => {
                "Click a seam to erase it. Shift + click cuts, Esc ends the tool.".to_owned()
            }
            (_, _, None) => "Click the first vertex of the seam. Shift erases a seam, Esc ends the tool.".to_owned(),
            (_, _, Some(_)) => "Click the next vertex of the seam. Enter ends it, Shift erases.".to_owned(),
        }
    }
}

fn has_shift(ui: &egui::Ui) -> bool {
    ui.input(|input| input.modifiers.shift)
}

/// Request of a click.
pub(super) fn clicked(ui: &egui::Ui, editor: &Editor) -> Vec<Request> {
    if editor.tools.seam.paints() {
        return Vec::new();
    }
    editor.seam_click(has_shift(ui)).map(Request::ClickSeam).into_iter().collect()
}

/// Edges that a click would cut or close, and true if it closes them.
fn change(editor: &Editor) -> (&[Edge], bool) {
    let intent = editor.tools.seam.foreseen();
    (intent.map_or(&[], SeamIntent::edges), matches!(intent, Some(SeamIntent::TakeAway(_))))
}

/// Edge of a path, cut or closed, hidden or not.
fn line(painter: &egui::Painter, ends: [Pos2; 2], theme: &Theme, style: PathStyle) {
    let seam = on_screen(theme.seam);
    let strong = if style.closes { theme.text } else { seam };
    let colour = if style.is_seen { strong } else { strong.gamma_multiply(HIDDEN) };
    if style.closes {
        pane::dashed(painter, ends, Stroke::new(CLOSE_WIDTH, colour), [4.0, 3.0]);
    } else {
        painter.line_segment(ends, Stroke::new(CUT_WIDTH, colour));
    }
}

#[derive(Clone, Copy)]
struct PathStyle {
    is_seen: bool,
    closes: bool,
}

/// Preview of a click over the mesh, and the last vertex of the seam.
pub(super) fn over_mesh(ui: &egui::Ui, view: Viewport<OrbitCamera>, editor: &mut Editor) {
    if editor.tools.tool() != Tool::Seam {
        return;
    }
    editor.tools.seam.update_visibility(&view.camera);
    let Some(ground) = editor.tools.seam.ground() else { return };
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let spot = |vertex: VertexId| view.spot(ground.place(vertex)?);
    if editor.tools.seam.paints() {
        return brush(ui, &painter, editor, theme, spot);
    }
    let (path, closes) = change(editor);
    for (place, edge) in path.iter().enumerate() {
        if let [Some(a), Some(b)] = edge.map(spot) {
            line(&painter, [a, b], theme, PathStyle { is_seen: editor.tools.seam.is_seen(place), closes });
        }
    }
    if let Some(at) = editor.tools.seam.last().and_then(spot) {
        end_mark(&painter, at, theme);
    }
    if let Some(at) = editor.tools.seam.under().and_then(spot) {
        pane::halo(&painter, at, theme.selection, 5.0);
    }
}

/// Stroke of the brush, and the ring under the pointer.
fn brush(
    ui: &egui::Ui,
    painter: &egui::Painter,
    editor: &Editor,
    theme: &Theme,
    spot: impl Fn(VertexId) -> Option<Pos2>,
) {
    let stroke = Stroke::new(CLOSE_WIDTH, on_screen(theme.kept_whole));
    for edge in editor.tools.seam.stroke() {
        if let [Some(a), Some(b)] = edge.map(&spot) {
            painter.line_segment([a, b], stroke);
        }
    }
    if let Some(at) = ui.input(|input| input.pointer.latest_pos()).filter(|at| painter.clip_rect().contains(*at)) {
        #[expect(clippy::cast_possible_truncation, reason = "a few points")]
        painter.circle_stroke(at, BRUSH as f32, Stroke::new(1.5, on_screen(theme.kept_whole)));
    }
}

/// Preview of a click over the embedding, at all copies of its edges, and the last vertex of the seam.
pub(super) fn over_plane(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, plane: &PlaneScene) {
    let (painter, theme, scene) = (ui.painter_at(view.rect), theme_of(ui), &plane.mesh);
    let spot = |vertex: VertexId| plane.position_of(vertex).map(|at| view.spot(at));
    let Some(disk) = scene.disk().filter(|_| editor.tools.tool() == Tool::Seam && editor.is_of_session(scene)) else {
        return;
    };
    let (path, closes) = change(editor);
    for &[a, b] in path {
        let joined = |from: VertexId| {
            let heads = disk.outgoing(from).map(|halfedge| disk.head(halfedge));
            heads.filter(move |&head| scene.in_file.vertex(head) == Some(b)).map(move |head| [from, head])
        };
        for ends in scene.in_file.copies(a).flat_map(joined) {
            if let [Some(a), Some(b)] = ends.map(spot) {
                line(&painter, [a, b], theme, PathStyle { is_seen: true, closes });
            }
        }
    }
    let last = editor.tools.seam.last().into_iter().flat_map(|vertex| scene.in_file.copies(vertex));
    last.filter_map(spot).for_each(|at| end_mark(&painter, at, theme));
}

/// Mark of the last vertex of a seam.
fn end_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_filled(at, 5.5, theme.background);
    painter.circle_filled(at, 4.0, on_screen(theme.seam));
}

/// Strip over the mesh pane: preference of paths, cut or erase, rules, and actions for all seams.
pub(super) fn strip(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.92)).inner_margin(egui::Margin::symmetric(8, 4));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            measure(ui, editor.tools.seam.creases(), requests);
            let tip = "Clicks erase seams instead of cutting: the whole stretch under the pointer, or from the \
                       previous click. Shift does so for one click";
            let erase = ui.selectable_label(editor.tools.seam.erases(), "Erase").on_hover_text(tip);
            erase.asks(Request::ToggleErasing, requests);
            let tip = "Paint over the mesh where no automatic seam may run; the seams move away. Erase takes paint \
                       away. Drag beside the mesh to orbit";
            let paint = ui.selectable_label(editor.tools.seam.paints(), "Keep whole").on_hover_text(tip);
            paint.asks(Request::TogglePainting, requests);
            rules(ui, editor, requests);
            let tip = "Erase all seams that were drawn or chosen; undo restores them";
            let clear = Offer::new("Clear seams", tip, Request::ClearSeams);
            clear.when(!editor.session.seams().edges().is_empty()).show(ui, requests);
            if editor.tools.seam.last().is_some() {
                let tip = tip_with_keys(ui, "End this seam. The next click starts another one", &Request::EndSeam);
                ui.button("End seam").on_hover_text(tip).asks(Request::EndSeam, requests);
            }
        });
    });
}

/// Menu of the rules for seams, which stays open while an angle is typed, and the result of the last rule.
fn rules(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let rules = &editor.tools.seam.rules;
    let menu = lasting_menu(ui, "Cut along", |ui| {
        ui.horizontal(|ui| {
            let sharp = Offer::new(
                "Sharp edges",
                "Cut edges with this angle or more between their faces",
                by(SeamRule::Sharp(rules.degrees)),
            );
            sharp.show(ui, requests);
            let mut degrees = rules.degrees;
            let typed = Typed::new("an angle", 0.0..=180.0);
            let drag = egui::DragValue::new(&mut degrees).range(0.0..=180.0).suffix("°").fixed_decimals(0);
            let field = ui.add(drag.custom_parser(|text| typed.number(text)));
            let field = typed.name(ui, field, "Least angle of sharp edges");
            if field.changed() {
                requests.push(Request::SetSharp(degrees));
            }
            field.on_hover_text(
                "Angle between the normals of the two faces, in degrees. 0: in one plane; 90: at a box's edge",
            );
        });
        let materials =
            Offer::new("Borders of materials", "Cut where faces of two materials meet", by(SeamRule::Materials));
        materials.show(ui, requests);
        let groups =
            Offer::new("Borders of groups", "Cut where faces of two groups or objects meet", by(SeamRule::Groups));
        groups.show(ui, requests);
        ui.separator();
        let tip = "Also cut along the edges of a file. Each line has the numbers of two vertices, from 0";
        Offer::new("Import seams…", tip, Request::Ask(FileDialogKind::ImportSeams)).show(ui, requests);
        let has_seams = !editor.session.seams().all_listed().edges().is_empty();
        let export = Offer::new(
            "Export seams…",
            "Write the edges of the seams to a file",
            Request::Ask(FileDialogKind::ExportSeams),
        );
        export.when(has_seams).show(ui, requests);
    });
    menu.on_hover_text("Cut along all edges that match a rule");
    if let Some(said) = rules.said() {
        ui.weak(said);
    }
}

fn by(rule: SeamRule) -> Request {
    Request::CutByRule(rule)
}

/// Slider for the preference of paths, from shortest to along creases.
fn measure(ui: &mut egui::Ui, creases: f64, requests: &mut Vec<Request>) {
    let mut percent = 100.0 * creases;
    ui.weak("Short");
    ui.spacing_mut().slider_width = (ui.available_width() - 80.0).clamp(24.0, 72.0);
    let slider = egui::Slider::new(&mut percent, 0.0..=100.0).suffix(" %").fixed_decimals(0);
    let response = ui.add(slider).on_hover_text(
        "Course of paths. 0 %: shortest way; 100 %: along sharp creases, even on a long detour. Type a number; \
         double-click resets",
    );
    response.widget_info(|| WidgetInfo::slider(true, percent, "Course of paths"));
    ui.weak("Creases");
    if response.double_clicked() {
        requests.push(Request::SetCreases(CREASES));
    } else if response.changed() {
        requests.push(Request::SetCreases(percent / 100.0));
    }
}
