//! Strip under the panes: buttons, the row of steps, and curves of their numbers.
//!
//! | file | what |
//! |---|---|
//! | `buttons.rs` | navigation between steps, running, stop conditions |
//! | `chips.rs` | the row of steps |
//! | `curves.rs` | curves side by side |
//! | `enlarged.rs` | a curve in its own window |
//! | `room.rs` | amount of room in a row |
//! | `marks.rs` | least and greatest value of a curve, and powers of ten |

mod buttons;
pub(super) mod chips;
mod curves;
mod enlarged;
mod marks;
mod room;

use eframe::egui::{self, Align, Layout, RichText};

use crate::session::{Action, RunStop, Status};
use crate::ui::state::ROW_HEIGHT;
use crate::ui::{Editor, Request, remark, theme_of, with_keys_set};
pub(super) use buttons::lasting_menu;
use buttons::{fold_button, playback_buttons, run_buttons, stop_menu};
use chips::chips;
use curves::{curves, curves_menu};
pub(super) use enlarged::enlarged_curve;
use freebound_core::flatten::Ending;
use room::Room;

/// Least height of a window that shows the curves by default, points.
pub(super) const CURVES_FROM: f32 = 560.0;

pub(super) fn timeline_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let room = Room::of(ui.available_width());
    ui.spacing_mut().item_spacing.y = 0.0;
    let row = egui::vec2(ui.available_width(), ROW_HEIGHT);
    ui.allocate_ui_with_layout(row, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_height(ROW_HEIGHT);
        playback_buttons(ui, editor, room, requests);
        ui.separator();
        run_buttons(ui, editor, requests);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            fold_button(ui, editor, requests);
            if editor.timeline.curves_shown() && room == Room::Ample {
                curves_menu(ui, editor, requests);
            }
            stop_menu(ui, editor, room, requests);
            // Show the reason for the stop, unless the verdict says it.
            let stop =
                editor.session.stopped().filter(|stop| !matches!(stop, RunStop::Ended(Ending::Planar | Ending::Done)));
            if let Some(stop) = stop.filter(|_| room == Room::Ample) {
                remark(ui, stop.words());
            }
            ui.add_space(6.0);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| chips(ui, editor, room, requests));
        });
    });
    if editor.timeline.curves_shown() {
        if let Some(words) = notice(editor) {
            let theme = theme_of(ui);
            let ink = if words == PRESS_SPACE { theme.text } else { theme.weak_text };
            let step = Request::Do(Action::Step);
            let words = with_keys_set(ui.ctx(), words, ["", "Space", " "], &step);
            ui.centered_and_justified(|ui| ui.label(RichText::new(words).color(ink)));
        } else {
            curves(ui, editor, requests);
        }
    }
}

/// Text in place of the curves while there is at most one step.
fn notice(editor: &Editor) -> Option<&'static str> {
    let session = &editor.session;
    Some(match (session.timeline().records().len(), session.status()) {
        (0, _) if session.is_running() => "The first step is running.",
        (0, _) => "No steps yet.",
        (1, Status::Held) => PRESS_SPACE,
        (1, Status::Preview(_)) => "The other steps follow when the gesture ends.",
        (1, Status::Solving) => "The first step is done; the others follow.",
        (1, _) if session.stopped() == Some(RunStop::Ended(Ending::Planar)) => {
            "Planar at the first step: nothing to repair. Space takes one more."
        }
        (1, _) => "This method is a single solve. Press Space to continue with a mean-value iteration.",
        _ => return None,
    })
}

/// Hint for new users.
pub(super) const PRESS_SPACE: &str = "Press Space to take a step.";
