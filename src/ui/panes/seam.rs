//! The seam tool in the panes: the vertex under the pointer, what a click would cut, and the strip of its options.

use eframe::egui::{self, Pos2, Shape, Stroke, WidgetInfo};

use super::pane;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::editor::seam_intent::SeamIntent;
use crate::ui::editor::seam_tool::CREASES;
use crate::ui::state::{Edge, Viewport};
use crate::ui::theme::on_screen;
use crate::ui::timeline::lasting_menu;
use crate::ui::typed::Typed;
use crate::ui::{
    Control, Editor, FileDialogKind, Offer, Request, SeamRule, Theme, Tool, counted, theme_of, tip_with_keys,
};
use crate::view::{OrbitCamera, PlaneCamera};
use freebound_core::mesh::VertexId;

/// Opacity of what the mesh hides.
const HIDDEN: f32 = 0.4;

/// Width of a path that a click would cut, points: less than that of a seam.
const CUT_WIDTH: f32 = 2.0;

/// Width of dashes over a seam that a click would close, points.
const CLOSE_WIDTH: f32 = 3.0;

impl Editor {
    /// Takes in the vertex of the file that is under the pointer in the mesh's pane: of all charts.
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

    /// The same in the embedding's pane, where the vertex on the screen is known.
    pub(super) fn pick_seam_vertex_in_plane(&mut self, scene: &MeshScene) {
        let vertex = self.pointer.vertex().and_then(|vertex| scene.in_file.vertex(vertex));
        self.tools.seam.set_under(vertex);
        self.foresee_seam();
    }

    /// What the seam tool does, in words.
    pub(in crate::ui) fn seam_words(&self, has_shift: bool) -> String {
        let seam = &self.tools.seam;
        let edges = |edges: &[Edge]| counted(edges.len(), "edge", "edges");
        match (seam.foreseen(), seam.under(), seam.last()) {
            (Some(SeamIntent::Begin), Some(vertex), _) => format!("Click: the seam begins at {vertex}."),
            (Some(SeamIntent::Add(path)), Some(vertex), _) => {
                format!("Click: cut {} to {vertex}. Enter ends the seam, Shift takes away.", edges(path))
            }
            (Some(SeamIntent::TakeAway(path)), ..) => format!("Click: close {} of the seam.", edges(path)),
            (Some(SeamIntent::End), ..) => "Click: the seam ends here.".to_owned(),
            (Some(SeamIntent::Wait), ..) => "Finding the paths from here…".to_owned(),
            (Some(SeamIntent::Nothing), Some(vertex), None) => format!("No seam is at {vertex}."),
            (Some(SeamIntent::Nothing), Some(vertex), Some(last)) if seam.erases() != has_shift => {
                format!("No seam leads from {last} to {vertex}.")
            }
            (Some(SeamIntent::Nothing), Some(vertex), Some(last)) => {
                format!("No edges lead from {last} to {vertex}: they are of different parts.")
            }
            (_, _, None) if seam.erases() => {
                "Click a seam to close it. Clicks with Shift cut, and Esc ends the tool.".to_owned()
            }
            (_, _, None) => "Click where the seam begins. Shift takes a seam away, Esc ends the tool.".to_owned(),
            (_, _, Some(_)) => "Click where it goes on. Enter ends it, Shift takes away.".to_owned(),
        }
    }
}

fn has_shift(ui: &egui::Ui) -> bool {
    ui.input(|input| input.modifiers.shift)
}

/// Asks for what a click does.
pub(super) fn clicked(ui: &egui::Ui, editor: &Editor) -> Vec<Request> {
    editor.seam_click(has_shift(ui)).map(Request::ClickSeam).into_iter().collect()
}

/// The edges that a click would cut or close, and whether it closes them.
fn change(editor: &Editor) -> (&[Edge], bool) {
    let intent = editor.tools.seam.foreseen();
    (intent.map_or(&[], SeamIntent::edges), matches!(intent, Some(SeamIntent::TakeAway(_))))
}

/// A side of a path, as it is seen.
fn line(painter: &egui::Painter, ends: [Pos2; 2], theme: &Theme, style: PathStyle) {
    let seam = on_screen(theme.seam);
    let strong = if style.closes { theme.text } else { seam };
    let colour = if style.is_seen { strong } else { strong.gamma_multiply(HIDDEN) };
    if style.closes {
        painter.add(Shape::dashed_line(&ends, Stroke::new(CLOSE_WIDTH, colour), 4.0, 3.0));
    } else {
        painter.line_segment(ends, Stroke::new(CUT_WIDTH, colour));
    }
}

#[derive(Clone, Copy)]
struct PathStyle {
    is_seen: bool,
    closes: bool,
}

/// What a click would do, over the mesh, and where the seam has got to.
pub(super) fn over_mesh(ui: &egui::Ui, view: Viewport<OrbitCamera>, editor: &mut Editor) {
    if editor.tools.tool() != Tool::Seam {
        return;
    }
    editor.tools.seam.update_visibility(&view.camera);
    let Some(ground) = editor.tools.seam.ground() else { return };
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let spot = |vertex: VertexId| view.spot(ground.place(vertex)?);
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

/// The same over the embedding, at all copies of the edges that are there.
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

/// Where a seam has got to.
fn end_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_filled(at, 5.5, theme.background);
    painter.circle_filled(at, 4.0, on_screen(theme.seam));
}

/// Over the mesh's pane: what paths follow, whether clicks cut or close, and what is done with all seams.
pub(super) fn strip(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.92)).inner_margin(egui::Margin::symmetric(8, 4));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            measure(ui, editor.tools.seam.creases(), requests);
            let tip = "Clicks close seams instead of cutting them: the whole stretch under the pointer, or from the click \
                       before. Shift does the same for one click";
            let erase = ui.selectable_label(editor.tools.seam.erases(), "Erase").on_hover_text(tip);
            erase.asks(Request::ToggleErasing, requests);
            rules(ui, editor, requests);
            let tip = "Close all seams that were drawn or chosen; undo takes it back";
            let clear = Offer::new("Clear seams", tip, Request::ClearSeams);
            clear.when(!editor.session.seams().edges().is_empty()).show(ui, requests);
            if editor.tools.seam.last().is_some() {
                let tip = tip_with_keys(ui, "The seam is as it should be: the next click begins another", &Request::EndSeam);
                ui.button("End seam").on_hover_text(tip).asks(Request::EndSeam, requests);
            }
        });
    });
}

/// Seams by a rule, in a menu that stays open while an angle is typed; and what came of the last one.
fn rules(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let rules = &editor.tools.seam.rules;
    let menu = lasting_menu(ui, "Cut along", |ui| {
        ui.horizontal(|ui| {
            let sharp = Offer::new(
                "Sharp edges",
                "Cut where faces meet at this angle or more",
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
            field.on_hover_text("Between the normals of the two faces, degrees: 0 in one plane, 90 at a box's edge");
        });
        let materials =
            Offer::new("Borders of materials", "Cut where faces of two materials meet", by(SeamRule::Materials));
        materials.show(ui, requests);
        let groups =
            Offer::new("Borders of groups", "Cut where faces of two groups or objects meet", by(SeamRule::Groups));
        groups.show(ui, requests);
        ui.separator();
        let tip = "Cut along the edges of a file, too: the numbers of two vertices a line, from 0";
        Offer::new("Import seams…", tip, Request::Ask(FileDialogKind::ImportSeams)).show(ui, requests);
        let has_seams = !editor.session.seams().edges().is_empty();
        let export = Offer::new(
            "Export seams…",
            "Write the edges of the seams to a file",
            Request::Ask(FileDialogKind::ExportSeams),
        );
        export.when(has_seams).show(ui, requests);
    });
    menu.on_hover_text("Cut along edges that follow a rule, all at once");
    if let Some(said) = rules.said() {
        ui.weak(said);
    }
}

fn by(rule: SeamRule) -> Request {
    Request::CutByRule(rule)
}

/// What paths follow: from the shortest to creases.
fn measure(ui: &mut egui::Ui, creases: f64, requests: &mut Vec<Request>) {
    let mut percent = 100.0 * creases;
    ui.weak("Short");
    ui.spacing_mut().slider_width = 72.0;
    let slider = egui::Slider::new(&mut percent, 0.0..=100.0).suffix(" %").fixed_decimals(0);
    let response = ui.add(slider).on_hover_text(
        "What paths follow: 0 % the shortest way, 100 % sharp creases, even by a long way around. Type a number; \
         double-click resets",
    );
    response.widget_info(|| WidgetInfo::slider(true, percent, "Short ways to creases"));
    ui.weak("Creases");
    if response.double_clicked() {
        requests.push(Request::SetCreases(CREASES));
    } else if response.changed() {
        requests.push(Request::SetCreases(percent / 100.0));
    }
}
