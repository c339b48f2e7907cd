//! Bar at the bottom: hint for the active tool, and data of the element under the pointer.

use std::borrow::Cow;

use eframe::egui::{self, RichText};

use crate::session::{Action, Status};
use crate::ui::panes::page_pane::{numbers as page_numbers, texture_coordinates};
use crate::ui::timeline::PRESS_SPACE;
use crate::ui::{Editor, FileDialogKind, Request, Tool, short, theme_of, with_keys_set};
use crate::view::ElementKind;

pub(in crate::ui) fn status_bar(ui: &mut egui::Ui, editor: &Editor) {
    let has_shift = ui.input(|input| input.modifiers.shift);
    let weak = theme_of(ui).weak_text;
    ui.horizontal_centered(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(numbers(editor)).color(weak).monospace());
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let hint = hint(editor, has_shift);
                let ink = if hint == PRESS_SPACE { theme_of(ui).text } else { weak };
                let hint = with_keys(ui.ctx(), &hint);
                ui.add(egui::Label::new(RichText::new(hint).color(ink)).truncate());
            });
        });
    });
}

/// Hint with the keys that the user has set.
fn with_keys(context: &egui::Context, hint: &str) -> String {
    let usual = [
        (["Press ", "Space", " "], Request::Do(Action::Step)),
        (["press ", "Ctrl+O", "."], Request::Ask(FileDialogKind::Open)),
        (["", "L", " locks"], Request::ToggleLock),
        (["", "L", " unlocks"], Request::ToggleLock),
        (["", "F", " frames"], Request::Frame),
        (["", "Shift+X", " cuts"], Request::CutSelection),
    ];
    usual.iter().fold(hint.to_owned(), |hint, (keys, request)| with_keys_set(context, &hint, *keys, request))
}

fn hint(editor: &Editor, has_shift: bool) -> Cow<'static, str> {
    let is_over_new = editor.pointer.vertex().is_some_and(|vertex| editor.is_new_vertex(vertex));
    let is_held = matches!(editor.session.status(), Status::Held);
    let words = match editor.tools.tool() {
        _ if editor.tools.dragged().is_some() => "Move the pin; the embedding follows. Esc cancels.",
        _ if editor.session.model().is_none() => "Open a mesh: drop its file on the window, or press Ctrl+O.",
        _ if editor.shows_comparison_alone() && editor.plane.comparison.morph.is_shown() => {
            "Drag the slider, or press Play: every frame is proved planar. Drag pans, the wheel zooms. Esc goes back."
        }
        _ if editor.shows_comparison_alone() => {
            "Click a method to use it for the document. Drag pans all of them, the wheel zooms. Esc goes back."
        }
        Tool::Select if editor.plane.page.gesture().is_some() => {
            "X or Y locks an axis. Type a number. Ctrl snaps, Alt lets charts overlap. Click or Enter ends, Esc cancels."
        }
        Tool::Select if editor.shows_page() && editor.element_kind().is_some() => {
            "Click selects, Shift + click adds or removes; Ctrl + drag selects a box. F frames. Enter shows the chart alone."
        }
        Tool::Select if editor.element_kind() != Some(ElementKind::Vertices) && !editor.shows_page() => {
            "Click selects, Shift + click adds or removes; Ctrl + drag selects a box. Shift+X cuts along the selection."
        }
        Tool::Select if editor.shows_page() && editor.plane.page.selected().is_empty() => {
            "Click a chart to select it; Ctrl + drag selects a box. Drag a chart to move it. Double click shows it alone."
        }
        Tool::Select if editor.shows_page() && editor.movable_charts().is_empty() => {
            "Locks or pins hold the selected charts. L unlocks, Delete frees the pins, F frames. Shift + click adds."
        }
        Tool::Select if editor.shows_page() => {
            "Drag to move the selected charts; G moves, R turns, S scales them. L locks, F frames. Shift + click adds."
        }
        Tool::Constrain if !is_over_new => return editor.constrain_words().into(),
        Tool::Seam => return editor.seam_words(has_shift).into(),
        _ if is_held && !editor.timeline.curves_shown() => PRESS_SPACE,
        Tool::Fix | Tool::Constrain if is_over_new => {
            "A new vertex exists in this embedding only. It cannot be pinned."
        }
        Tool::Select if editor.pins_selected().next().is_some() => {
            "Drag a selected pin to move them all. Arrows move by a pixel (Shift: ten). Delete frees them."
        }
        Tool::Brush if editor.shows_page() => {
            "Drag over a chart. [ and ] change the size, Ctrl inverts pinch and texels. Alt lets charts overlap. Esc ends."
        }
        Tool::Brush => {
            "Drag over the map. [ and ] change the size, Ctrl inverts pinch and texels. The right button pans. Esc ends."
        }
        Tool::Fix => "Click a vertex to pin it. Drag a square to move it. Esc ends.",
        Tool::Select | Tool::Constrain => {
            "Click a vertex to select it. Shift adds; Ctrl + drag selects a box. Drag a square to move a pin."
        }
    };
    words.into()
}

fn numbers(editor: &Editor) -> String {
    if let Some(page) = editor.session.page().filter(|_| editor.shows_page()) {
        let at = editor.pointer.in_embedding().map(|at| texture_coordinates(page, at));
        let at = at.map(|at| format!("u {} v {}", short(at.x), short(at.y)));
        return at.into_iter().chain(page_numbers(editor)).collect::<Vec<_>>().join("  ·  ");
    }
    let mut parts = Vec::new();
    if let Some(place) = editor.pointer.in_embedding() {
        let at = editor.session.document().frame().uv_from_plane(place);
        parts.push(format!("u {} v {}", short(at.x), short(at.y)));
    }
    if let (Some(element), Some(scene)) = (editor.pointer.element(), editor.mesh_scene()) {
        parts.push(scene.element_words(element));
    } else if let (Some(vertex), Some(scene)) = (editor.pointer.vertex(), editor.mesh_scene()) {
        parts.push(scene.vertex_words(vertex));
        parts.extend(scene.side_of(vertex).map(|side| side.to_string()));
        if let Some(x) = scene.mesh().positions.get(vertex.index()) {
            parts.push(format!("({}, {}, {})", short(x.x), short(x.y), short(x.z)));
        }
    }
    if let Some(outcome) = editor.step_on_screen().filter(|_| !editor.plane.shows_preview()) {
        parts.push(outcome.step.candidate.stage.short_words().to_owned());
        parts.push(format!(
            "{:.0} ms",
            1000.0 * (outcome.step.candidate.solution.seconds.total() + outcome.step.verify_seconds)
        ));
    }
    parts.join("  ·  ")
}
