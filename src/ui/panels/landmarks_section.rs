//! Landmarks of the picture that wait for a vertex: section of the pins tab.

use eframe::egui;

use crate::session::Action;
use crate::ui::{Editor, Offer, Request, remark};

pub(super) fn landmarks_ui(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let count = editor.session.landmark_count();
    if count == 0 {
        return;
    }
    let waiting = editor.session.landmarks_waiting();
    ui.separator();
    ui.horizontal(|ui| {
        ui.strong("Landmarks");
        ui.weak(format!("{} of {count} placed", count - waiting.len()));
    });
    let taken = editor.landmark_taken();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let (words, after) =
            if taken.is_some() { ("Skip", taken.as_ref().map(|it| it.uv)) } else { ("Place next", None) };
        let next = Offer::new(words, "Take the next landmark, then click its vertex", Request::TakeLandmark { after });
        next.when(!waiting.is_empty()).show(ui, requests);
        Offer::new("Close", "Drop the landmarks that wait. Pins stay", Action::CloseLandmarks).show(ui, requests);
    });
    let words = match (taken, waiting.first()) {
        (Some(landmark), _) => format!("Click the vertex of {}.", landmark.name),
        (None, Some(next)) => format!("Next: {}", next.name),
        (None, None) => "All landmarks have a pin.".to_owned(),
    };
    remark(ui, words);
}
