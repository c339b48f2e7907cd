//! Windows over the panes: "Go to", file dialog, exports, messages and questions. Also pictures of the
//! panes, cropped from a screenshot.

use std::path::PathBuf;
use std::sync::mpsc::sync_channel;

use eframe::egui::{self, Align2, Key, Pos2, Rect};

use crate::ui::editor::layout::GoTo;
use crate::ui::state::{BAKED, COPY_COMMAND, EXPORTS, ExportOptions, NO_LAYOUT_PICTURE, NO_MAP, PATTERN};
use crate::ui::timeline::enlarged_curve;
use crate::ui::{Control, Editor, Element, Pane, Request};
use freebound_core::geom::Picture;

pub(in crate::ui) fn floating_windows(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    super::keys_window::keys_window(context, editor);
    super::about::help_windows(context, editor);
    if let Some(go_to) = editor.layout.go_to.take() {
        editor.layout.go_to = go_to_window(context, editor, go_to, requests);
    }
    if editor.layout.exports_shown {
        exports_window(context, editor, requests);
    }
    super::export_options::export_options(context, editor, requests);
    super::palette::palette(context, editor, requests);
    enlarged_curve(context, editor, requests);
    super::tour::tour(context, editor);
    super::toast::toast(context, editor, requests);
    super::unsaved::question(context, editor, requests);
    super::large::question(context, editor, requests);
    if let Some(choice) = editor.files.dialogs.show(context) {
        editor.take_choice(choice);
    }
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
        let found = Element::parse(&go_to.text).and_then(|element| editor.request_to_show(element));
        if !go_to.text.trim().is_empty() && found.is_none() {
            ui.colored_label(crate::ui::theme::theme_of(ui).flipped, "This mesh has no such element");
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let clicked = ui.add_enabled(found.is_some(), egui::Button::new("Go")).clicked();
        // Enter takes the focus from a field. Restore it, so that the user can correct the number.
        if std::mem::take(&mut go_to.takes_keyboard) || (entered && found.is_none()) {
            field.request_focus();
        }
        if let (true, Some(request)) = (entered || clicked, found) {
            requests.push(request);
            gone = true;
        }
    });
    (open && !gone).then_some(go_to)
}

/// Least height of a window that lists all exports in one column, points.
const ONE_COLUMN: f32 = 600.0;

fn exports_window(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let (solved, can_bake) = (editor.session.outcome().is_some(), editor.session.can_bake());
    let window = egui::Window::new("Export").open(&mut editor.layout.exports_shown).collapsible(false).auto_sized();
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        let columns = if context.content_rect().height() < ONE_COLUMN { 2 } else { 1 };
        egui::Grid::new("exports").num_columns(columns).spacing([6.0, 4.0]).show(ui, |ui| {
            let commands = [
                (Request::ToggleOptions(ExportOptions::Baked), BAKED),
                (Request::ToggleOptions(ExportOptions::Pattern), PATTERN),
                (Request::CopyCommandLine, COPY_COMMAND),
            ];
            let files = EXPORTS.into_iter().map(|(kind, words, about)| (Request::Ask(kind), [words, about]));
            for (place, (request, [words, about])) in files.chain(commands).enumerate() {
                let lacks = request == Request::ToggleOptions(ExportOptions::Baked) && !can_bake;
                let button = egui::Button::new(words).min_size(egui::vec2(250.0, 22.0));
                let button = ui.add_enabled(solved && !lacks, button).on_hover_text(about);
                button.on_disabled_hover_text(if lacks { NO_LAYOUT_PICTURE } else { NO_MAP }).asks(request, requests);
                if place % columns + 1 == columns {
                    ui.end_row();
                }
            }
        });
        if !solved {
            ui.weak(format!("{NO_MAP}."));
        }
    });
}

impl Editor {
    /// Requests a screenshot of the window, from which a pane is cropped.
    pub(in crate::ui) fn shoot_pane(&mut self, pane: Pane, path: PathBuf) {
        let part = match pane {
            Pane::Plane => self.plane.rect(),
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
