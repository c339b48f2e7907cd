//! The arrow keys move the selected pins by pixels of the picture. While a key is held, that is one gesture.

use eframe::egui::{self, Key};
use glam::DVec2;

use crate::mesh::VertexId;
use crate::session::Action;
use crate::ui::{Editor, Request};

/// Pixels that Shift makes of one.
const LARGE: f64 = 10.0;

/// Without a picture a nudge is this part of the embedding's extent.
const PARTS: f64 = 512.0;

const ARROWS: [(Key, DVec2); 4] = [
    (Key::ArrowLeft, DVec2::NEG_X),
    (Key::ArrowRight, DVec2::X),
    (Key::ArrowUp, DVec2::Y),
    (Key::ArrowDown, DVec2::NEG_Y),
];

/// What the arrow keys ask for in this frame, where pins are selected. They are then nobody else's.
pub(in crate::ui) fn requests(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    let is_elsewhere = context.text_edit_focused()
        || egui::Popup::is_any_open(context)
        || context.memory(egui::Memory::focused).is_some();
    let mut requests = Vec::new();
    if !is_elsewhere && editor.tools.dragged().is_none() && editor.pins_selected().next().is_some() {
        let push = context.input_mut(take_push);
        if push != DVec2::ZERO {
            requests.push(Request::Nudge(push));
        }
    }
    let is_held = context.input(|input| ARROWS.iter().any(|(key, _)| input.key_down(*key)));
    if !is_held && (editor.tools.is_nudging() || !requests.is_empty()) {
        requests.push(Request::EndNudge);
    }
    requests
}

/// The sum of all presses of arrow keys, which are taken out of the input.
fn take_push(input: &mut egui::InputState) -> DVec2 {
    let mut push = DVec2::ZERO;
    input.events.retain(|event| {
        let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
        let Some((_, way)) = ARROWS.iter().find(|(arrow, _)| arrow == key) else { return true };
        if modifiers.command || modifiers.alt {
            return true;
        }
        push += *way * if modifiers.shift { LARGE } else { 1.0 };
        false
    });
    push
}

impl Editor {
    /// Moves the selected pins by pixels of the picture; y runs up.
    pub(super) fn nudge(&mut self, pixels: DVec2) {
        let document = self.session.document();
        let frame = document.frame();
        let step = match &document.picture {
            Some(picture) => 1.0 / f64::from(picture.pixels.height),
            None => self.plane.scene().map_or(1.0, |scene| scene.arrays.bounds.extent()) / PARTS,
        };
        // The frame has no offset: it takes differences to differences.
        let by = frame.uv_from_plane(pixels * step);
        let nudged = |vertex: VertexId| Some((vertex, document.targets.get(&vertex)?.uv + by));
        let moves: Vec<(VertexId, DVec2)> = self.pins_selected().filter_map(nudged).collect();
        if !self.tools.is_nudging() {
            self.tools.set_nudging(true);
            self.session.handle(Action::EndGesture);
        }
        self.session.handle(Action::MovePins(moves));
    }

    pub(super) fn end_nudge(&mut self) {
        self.tools.set_nudging(false);
        self.session.handle(Action::EndGesture);
    }
}
