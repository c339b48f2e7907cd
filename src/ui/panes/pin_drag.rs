//! Pins in the embedding pane. Each pin is a named widget that can be dragged. Selected pins move together.

use eframe::egui::{self, CursorIcon, Rect, Response, Role, Sense, Vec2};
use glam::DVec2;

use super::pins::{self, Emphasis, PinShown};
use super::vertex_menu::vertex_menu;
use crate::session::Action;
use crate::ui::state::{PinDrag, Viewport};
use crate::ui::{Control, Editor, Request, sentence, theme_of};
use crate::view::PlaneCamera;
use freebound_core::mesh::VertexId;

/// Side of the square around a pin that can be grabbed, points.
const GRAB_SIZE: f32 = 18.0;

/// Time without motion after which the pointer counts as resting in a drag, seconds.
const REST: f64 = 0.2;

/// Pin, its position on the screen, and the view.
struct Grip {
    pin: PinShown,
    at: egui::Pos2,
    view: Viewport<PlaneCamera>,
}

/// Shows the pins and handles their gestures.
pub(super) fn pins_ui(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &mut Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let painter = ui.painter_at(view.rect);
    let pins = editor.pins_shown();
    if let Some(dragged) = editor.tools.dragged()
        && !pins.iter().any(|pin| pin.vertex == dragged)
    {
        // The pin was removed during the drag, for example by undo.
        editor.tools.end_drag();
        requests.push(Request::Do(Action::EndGesture));
    }
    for pin in pins {
        let at = view.spot(pin.target);
        let is_dragged = editor.tools.dragged() == Some(pin.vertex);
        // A pin dragged out of the pane stays dragged.
        if !is_dragged && !view.rect.expand(GRAB_SIZE).contains(at) {
            continue;
        }
        let grip = Grip { pin, at, view };
        let mut response = grip.widget(ui, editor);
        let is_strong = response.hovered() || editor.selection.vertices().contains(&pin.vertex);
        if let Some(conflict) = editor.session.conflict_of(pin.vertex) {
            pins::conflict_mark(&painter, at, theme);
            response = response.on_hover_text(sentence(&editor.session.conflict_words(conflict)));
        }
        pin.kind.mark(&painter, at, theme, Emphasis::strong_if(is_strong));
        // A mark that leaves the click to the pane also leaves hover and cursor to it.
        if editor.tools.pair().is_none() && (response.hovered() || response.dragged()) {
            ui.ctx().set_cursor_icon(if response.dragged() { CursorIcon::Grabbing } else { CursorIcon::Grab });
            editor.pointer.set_vertex(Some(pin.vertex));
        }
        if response.clicked() {
            let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
            let toggle = Request::ToggleSelected(pin.vertex);
            requests.push(if adds { toggle } else { Request::Select(vec![pin.vertex]) });
        }
        response.context_menu(|ui| vertex_menu(ui, editor, pin.vertex, requests));
        grip.drag(ui, &response, editor, requests);
    }
}

/// Vertex of the pin under a position on the screen. Among several, the topmost, which takes the click.
pub(super) fn pin_at(editor: &Editor, view: Viewport<PlaneCamera>, at: egui::Pos2) -> Option<VertexId> {
    let is_under = |pin: &PinShown| Rect::from_center_size(view.spot(pin.target), Vec2::splat(GRAB_SIZE)).contains(at);
    editor.pins_shown().into_iter().rfind(is_under).map(|pin| pin.vertex)
}

impl Grip {
    fn widget(&self, ui: &egui::Ui, editor: &Editor) -> Response {
        let PinShown { vertex, kind, .. } = self.pin;
        let grab = Rect::from_center_size(self.at, Vec2::splat(GRAB_SIZE));
        let seen = grab.intersect(self.view.rect);
        let grab = if seen.is_positive() { seen } else { grab };
        // The pane takes the click that completes a pair, even over a pin.
        let sense = if editor.tools.pair().is_some() { Sense::hover() } else { Sense::click_and_drag() };
        let name = kind.name(editor.session.number_of(vertex));
        ui.interact(grab, ui.scope_id().with(("pin", vertex)), sense).named(Role::Button, &name)
    }

    fn drag(&self, ui: &egui::Ui, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
        let vertex = self.pin.vertex;
        if response.drag_started() {
            self.grab(ui, editor, requests);
        }
        let Some(drag) = editor.tools.drag_of(vertex) else { return };
        let now = ui.input(|input| input.time);
        if response.dragged() && response.drag_delta() != Vec2::ZERO {
            let pointer = response.interact_pointer_pos().map_or(self.at, |pointer| pointer + drag.offset);
            let place = self.view.point_at(pointer);
            requests.push(Request::Do(drag.moves_to(place, editor.session.document().frame())));
            (drag.moved_at, drag.has_rested) = (now, false);
        } else if response.dragged() && !drag.has_rested {
            let still = now - drag.moved_at;
            if still >= REST {
                drag.has_rested = true;
                requests.push(Request::Do(Action::Rest));
            } else {
                ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(REST - still));
            }
        }
        // Also if the end of the drag was missed, for example over another window.
        if response.drag_stopped() || !response.dragged() {
            editor.tools.end_drag();
            requests.push(Request::Do(Action::EndGesture));
        }
    }

    fn grab(&self, ui: &egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
        let PinShown { vertex, target, .. } = self.pin;
        let pressed = ui.input(|input| input.pointer.press_origin());
        let goes_together = editor.selection.vertices().contains(&vertex);
        let others: Vec<(VertexId, DVec2)> = if goes_together {
            let selected =
                editor.pins_shown().into_iter().filter(|pin| editor.selection.vertices().contains(&pin.vertex));
            selected.filter(|pin| pin.vertex != vertex).map(|pin| (pin.vertex, pin.target - target)).collect()
        } else {
            requests.push(Request::Select(vec![vertex]));
            Vec::new()
        };
        let offset = pressed.map_or(Vec2::ZERO, |pressed| self.at - pressed);
        // Nothing has moved yet, so a resting pointer must not trigger further steps.
        editor.tools.begin_drag(PinDrag { vertex, offset, others, moved_at: 0.0, has_rested: true });
        requests.push(Request::Do(Action::EndGesture));
    }
}
