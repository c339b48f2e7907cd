//! Picture section of the pins tab: file, direction of v, and display options.

use eframe::egui::{self, RichText};

use crate::session::Action;
use crate::ui::{Control, Editor, FileDialogKind, Offer, Request, remark, theme_of};
use freebound_core::geom::VAxis;

pub(super) fn picture_ui(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    ui.horizontal(|ui| {
        ui.strong("Picture");
        match &document.picture {
            Some(picture) => {
                let words = format!("{}, {} × {}", picture.name, picture.pixels.width, picture.pixels.height);
                ui.add(egui::Label::new(RichText::new(words).color(theme_of(ui).weak_text)).truncate());
            }
            None => {
                ui.weak("none");
            }
        }
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let open = Request::Ask(FileDialogKind::OpenPicture);
        let open = Offer::new("Open picture…", "A PNG or JPEG file to map on the mesh", open);
        open.when(editor.has_disk()).show(ui, requests);
        let remove = Offer::new("Remove", "Remove the picture", Action::RemovePicture);
        remove.when(document.picture.is_some()).show(ui, requests);
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (v_axis, words, tip) in [
            (VAxis::Up, "v up", "v = 0 at the lower edge, as in OBJ files. Pins keep their positions on the picture"),
            (
                VAxis::Down,
                "v down",
                "v = 0 at the upper edge, as in pictures. Pins keep their positions on the picture",
            ),
        ] {
            let on = document.v_axis == v_axis;
            if ui.selectable_label(on, words).on_hover_text(tip).clicked() && !on {
                requests.push(Action::SetVAxis(v_axis).into());
            }
        }
        let sharp = ui
            .selectable_label(editor.pane_shading.is_sharp(), "Sharp")
            .on_hover_text("Pixels are squares of one colour");
        sharp.asks(Request::ToggleSharp, requests);
    });
    if let Some(plane) = editor.plane.scene().filter(|plane| document.picture.is_some() && plane.faces_outside > 0) {
        let share = 100.0 * plane.faces_outside as f64 / plane.mesh.mesh().real_face_count().max(1) as f64;
        let share = if share < 0.1 { "less than 0.1".to_owned() } else { format!("{share:.1}") };
        remark(ui, format!("{share} % of the faces reach outside the picture (hatched in the embedding)"));
    }
    if document.picture.is_some() {
        let mut percent = editor.appearance().opacity * 100.0;
        let slider = egui::Slider::new(&mut percent, 0.0..=100.0).suffix(" %").fixed_decimals(0);
        let label = ui.weak("Opacity behind the embedding");
        let slider = ui.add(slider).labelled_by(label.id);
        if slider.changed() {
            requests.push(Request::SetOpacity(percent / 100.0));
        }
    }
}
