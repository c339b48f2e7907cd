//! Windows over the panes: list of keys, "Go to", file dialog, exports, messages and questions. Also pictures of the
//! panes, cropped from a screenshot.

use std::path::PathBuf;
use std::sync::mpsc::sync_channel;

use eframe::egui::{self, Align2, Key, Pos2, Rect};

use crate::session::Action;
use crate::ui::editor::layout::GoTo;
use crate::ui::keys::{BINDINGS, Binding, MOUSE};
use crate::ui::{Control, Editor, Element, FileDialogKind, Pane, Request, pairs};
use freebound_core::geom::Picture;
use freebound_core::pipeline::Fit;
use freebound_io::OutputKind;

pub(in crate::ui) fn floating_windows(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    if editor.layout.keys_shown {
        keys_window(context, editor);
    }
    if let Some(go_to) = editor.layout.go_to.take() {
        editor.layout.go_to = go_to_window(context, editor, go_to, requests);
    }
    if editor.layout.exports_shown {
        exports_window(context, editor, requests);
    }
    super::tour::tour(context, editor);
    super::toast::toast(context, editor, requests);
    super::unsaved::question(context, editor, requests);
    super::large::question(context, editor, requests);
    if let Some(choice) = editor.files.dialogs.show(context) {
        editor.take_choice(choice);
    }
}

/// Groups of the list of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Group {
    Look,
    Pin,
    Step,
    File,
    Mouse,
}

impl Group {
    const ALL: [Self; 5] = [Self::Look, Self::Pin, Self::Step, Self::File, Self::Mouse];

    const fn title(self) -> &'static str {
        ["Look", "Pin", "Step", "File", "Mouse"][self as usize]
    }

    const fn of(request: &Request) -> Self {
        match request {
            Request::SetTool(_)
            | Request::UnpinSelected
            | Request::Escape
            | Request::Do(Action::Undo | Action::Redo) => Self::Pin,
            Request::Do(_)
            | Request::RunOrPause
            | Request::GoToStep(_)
            | Request::StepDefect(_)
            | Request::StepChart(_)
            | Request::ToggleLock => Self::Step,
            Request::Ask(_)
            | Request::SaveProject
            | Request::ToggleExports
            | Request::Quit
            | Request::OpenMenu(_)
            | Request::ToggleKeys => Self::File,
            _ => Self::Look,
        }
    }
}

fn keys_window(context: &egui::Context, editor: &mut Editor) {
    // Keys without modifiers first; the table itself has the opposite order.
    let mut bindings: Vec<&Binding> = BINDINGS.iter().collect();
    bindings.sort_by_key(|binding| (binding.shortcut.modifiers.any(), binding.about));
    let height = (context.content_rect().height() - 120.0).max(160.0);
    egui::Window::new("Keys and mouse")
        .open(&mut editor.layout.keys_shown)
        .collapsible(false)
        .default_size([520.0, height.min(620.0)])
        .pivot(Align2::CENTER_CENTER)
        .default_pos(context.content_rect().center())
        .show(context, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).max_height(height).show(ui, |ui| {
                for group in Group::ALL {
                    let of_group = bindings.iter().filter(|binding| Group::of(&(binding.request)()) == group);
                    let keys = of_group.map(|key| (context.format_shortcut(&key.shortcut), key.about));
                    let gestures = MOUSE.iter().filter(|_| group == Group::Mouse);
                    let gestures = gestures.map(|&(gesture, about)| (gesture.to_owned(), about));
                    ui.strong(group.title());
                    pairs(ui, group.title(), [24.0, 4.0], |ui| {
                        for (input, about) in keys.chain(gestures) {
                            ui.monospace(input);
                            ui.label(about);
                            ui.end_row();
                        }
                    });
                    ui.add_space(8.0);
                }
            });
        });
}

/// Shows the window "Go to". Returns its state, or `None` once it closes.
fn go_to_window(
    context: &egui::Context,
    editor: &Editor,
    mut go_to: GoTo,
    requests: &mut Vec<Request>,
) -> Option<GoTo> {
    let mut open = true;
    let mut gone = false;
    let window = egui::Window::new("Go to").open(&mut open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        let label = ui.label("Number of a vertex (12 or v12), an edge (e7) or a face (f3), from 0");
        let field = ui.add(egui::TextEdit::singleline(&mut go_to.text).desired_width(160.0)).labelled_by(label.id);
        let wanted = Element::parse(&go_to.text);
        let found = wanted.zip(editor.mesh_scene()).map(|(element, scene)| scene.vertices_of(element));
        let found = found.filter(|vertices| !vertices.is_empty());
        if !go_to.text.trim().is_empty() && found.is_none() {
            ui.colored_label(crate::ui::theme::theme_of(ui).flipped, "This mesh has no such element");
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let clicked = ui.add_enabled(found.is_some(), egui::Button::new("Go")).clicked();
        // Enter takes the focus from a field. Restore it, so that the user can correct the number.
        if std::mem::take(&mut go_to.takes_keyboard) || (entered && found.is_none()) {
            field.request_focus();
        }
        if let (true, Some(vertices)) = (entered || clicked, found) {
            requests.push(Request::GoTo(vertices));
            gone = true;
        }
    });
    (open && !gone).then_some(go_to)
}

/// All exports: dialog, menu entry and description.
pub(super) const EXPORTS: [(FileDialogKind, &str, &str); 9] = {
    use FileDialogKind::{Export, PanePicture};
    use OutputKind::{Glb, Json, Obj, Ply, Png, Svg};
    let (unit, true_scale) = (Some(Fit::Unit), Some(Fit::True));
    [
        (
            Export(Obj, None),
            "Mesh with texture coordinates…",
            "OBJ, with its material, and with the picture if there is one",
        ),
        (Export(Ply, None), "Mesh as PLY…", "PLY in 32 bits, with all data of an opened PLY file"),
        (Export(Glb, None), "Mesh as GLB…", "Binary glTF in 32 bits, with all data of an opened glTF file"),
        (Export(Svg, unit), "Layout in the unit square…", "SVG, positioned like texture coordinates"),
        (Export(Svg, true_scale), "Layout at true scale…", "SVG in the units of the mesh, for cutting out"),
        (PanePicture(Pane::Mesh), "Picture of the mesh's pane…", "PNG, as shown in the pane"),
        (PanePicture(Pane::Plane), "Picture of the embedding's pane…", "PNG, as shown in the pane"),
        (Export(Png, None), "Mesh and layout side by side…", "PNG, redrawn for the file"),
        (Export(Json, None), "Report…", "JSON: method, steps, verdict, distortion"),
    ]
};

fn exports_window(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let solved = editor.session.outcome().is_some();
    let window = egui::Window::new("Export").open(&mut editor.layout.exports_shown).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        for (kind, words, about) in EXPORTS {
            let button = ui.add_enabled(solved, egui::Button::new(words).min_size(egui::vec2(250.0, 24.0)));
            button.on_hover_text(about).asks(Request::Ask(kind), requests);
        }
        if !solved {
            ui.weak("There is nothing to export yet: open a mesh.");
        }
    });
}

impl Editor {
    /// Requests a screenshot of the window, from which a pane is cropped.
    pub(in crate::ui) fn shoot_pane(&mut self, pane: Pane, path: PathBuf) {
        let part = match pane {
            Pane::Plane => self.plane.pane.rect().or(self.plane.page.pane.rect()),
            Pane::Mesh => self.mesh.pane.rect(),
        };
        let Some(part) = part else { return };
        let (sender, picture) = sync_channel(1);
        let wake = self.gpu.wake();
        let scale = self.gpu.context().pixels_per_point();
        self.gpu.context().request_screenshot(move |image| {
            sender.send(cut(&image, part * scale)).ok();
            wake();
        });
        self.files.shot = Some((path, picture));
    }

    /// Writes the pane's part of a finished screenshot. Call once per frame.
    pub(in crate::ui) fn poll_shot(&mut self) {
        let Some((path, shot)) = &self.files.shot else { return };
        if let Ok(picture) = shot.try_recv() {
            self.session.write_file(path.clone(), move |out| freebound_io::raster::write_png(&picture, out));
            self.files.shot = None;
        }
    }
}

/// Crops a screenshot to a rectangle, in pixels.
fn cut(image: &egui::ColorImage, part: Rect) -> Picture {
    let whole = Rect::from_min_size(Pos2::ZERO, egui::vec2(image.width() as f32, image.height() as f32));
    let within = |corner: Pos2| corner.round().clamp(whole.min, whole.max);
    let part = image.region(&Rect::from_min_max(within(part.min), within(part.max)), None);
    let [width, height] = part.size.map(|count| u32::try_from(count).unwrap_or(0));
    Picture { width, height, pixels: part.pixels.iter().flat_map(egui::Color32::to_srgba_unmultiplied).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pane_is_cut_out_of_the_window() {
        let colour = |i: usize| egui::Color32::from_gray(u8::try_from(i).unwrap());
        let image = egui::ColorImage::new([4, 3], (0..12).map(colour).collect());
        let part = cut(&image, Rect::from_min_max(egui::pos2(1.0, 1.0), egui::pos2(3.0, 9.0)));
        assert_eq!((part.width, part.height), (2, 2));
        let greys: Vec<u8> = part.pixels.chunks_exact(4).map(|pixel| pixel[0]).collect();
        assert_eq!(greys, [5, 6, 9, 10]);
    }
}
