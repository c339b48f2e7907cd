//! What can be exported, to choose from; and pictures of the panes, cut out of the window as it shows.

use std::path::PathBuf;
use std::sync::mpsc::sync_channel;

use eframe::egui::{self, Align2, Pos2, Rect};

use crate::geom::Picture;
use crate::io::{OutputFit, OutputKind};
use crate::ui::{Control, Editor, Pane, Purpose, Request};

/// Everything that can be exported: what it is, and what it is good for.
pub(super) const EXPORTS: [(Purpose, &str, &str); 7] = {
    use OutputKind::{Json, Obj, Png, Svg};
    use Purpose::{Export, PanePicture};
    let (unit, true_scale) = (Some(OutputFit::Unit), Some(OutputFit::True));
    [
        (
            Export(Obj, None),
            "Mesh with texture coordinates…",
            "OBJ, with its material and the picture where there is one",
        ),
        (Export(Svg, unit), "Layout in the unit square…", "SVG, as texture coordinates lie"),
        (Export(Svg, true_scale), "Layout at true scale…", "SVG in the mesh's own units, to cut out"),
        (PanePicture(Pane::Mesh), "Picture of the mesh's pane…", "PNG, as the pane shows"),
        (PanePicture(Pane::Plane), "Picture of the embedding's pane…", "PNG, as the pane shows"),
        (Export(Png, None), "Mesh and layout side by side…", "PNG, drawn anew"),
        (Export(Json, None), "Report…", "JSON: method, steps, verdict, distortion"),
    ]
};

pub(super) fn exports_window(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let solved = editor.session.outcome().is_some();
    let window = egui::Window::new("Export").open(&mut editor.layout.exports_shown).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        for (purpose, words, about) in EXPORTS {
            let button = ui.add_enabled(solved, egui::Button::new(words).min_size(egui::vec2(250.0, 24.0)));
            button.on_hover_text(about).asks(Request::Ask(purpose), requests);
        }
        if !solved {
            ui.weak("There is nothing to export yet: open a mesh.");
        }
    });
}

impl Editor {
    /// Asks for a picture of the window, to cut a pane out of.
    pub(in crate::ui) fn shoot_pane(&mut self, pane: Pane, path: PathBuf) {
        let area = if pane == Pane::Plane { self.plane.area() } else { self.mesh.area() };
        let Some(part) = area.rect() else { return };
        let (sender, picture) = sync_channel(1);
        let wake = self.host.wake();
        let scale = self.host.context().pixels_per_point();
        self.host.context().request_screenshot(move |image| {
            sender.send(cut(&image, part * scale)).ok();
            wake();
        });
        self.files.shot = Some((path, picture));
    }

    /// Takes in the picture of the window, and has the pane's part of it written. Call once per frame.
    pub(in crate::ui) fn poll_shot(&mut self) {
        let Some((path, shot)) = &self.files.shot else { return };
        if let Ok(picture) = shot.try_recv() {
            self.session.save_picture(path.clone(), picture);
            self.files.shot = None;
        }
    }
}

/// A part of a picture of the window, in pixels.
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
