//! Buttons of the timeline: navigation between steps, running, and stop conditions.

use eframe::egui;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Color32, PopupCloseBehavior, Rect, RichText, Role, Sense, Shape, Stroke, Vec2};

use super::room::Room;
use crate::session::{Action, RunStop, Status, StopConditions};
use crate::ui::{Control, Editor, Request, StepTarget, theme_of, tip_with_keys};

/// Side of a drawn button, points.
const BUTTON: f32 = 24.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drawing {
    First,
    Previous,
    Play,
    Pause,
    Next,
    Last,
    FoldDown,
    FoldUp,
}

/// Buttons for navigation between steps. A tight row has only previous and next.
pub(super) fn playback_buttons(ui: &mut egui::Ui, editor: &Editor, room: Room, requests: &mut Vec<Request>) {
    ui.spacing_mut().item_spacing.x = 2.0;
    let [has_previous, has_next] = editor.steps_around();
    let is_playing = editor.timeline.playing_since.is_some();
    let (play, play_name) =
        if is_playing { (Drawing::Pause, "Stop playing") } else { (Drawing::Play, "Play the steps") };
    let to = Request::GoToStep;
    let buttons = [
        (Drawing::First, "First step", has_previous, to(StepTarget::First)),
        (Drawing::Previous, "Previous step", has_previous, to(StepTarget::Previous)),
        (play, play_name, has_previous || has_next, Request::TogglePlay),
        (Drawing::Next, "Next step", has_next, to(StepTarget::Next)),
        (Drawing::Last, "Last step", has_next, to(StepTarget::Last)),
    ];
    let is_shown = |drawing: Drawing| room != Room::Tight || matches!(drawing, Drawing::Previous | Drawing::Next);
    for (drawing, name, enabled, request) in buttons.into_iter().filter(|(drawing, ..)| is_shown(*drawing)) {
        ui.add_enabled_ui(enabled, |ui| drawn_button(ui, drawing, name, request, requests));
    }
}

/// Button that shows or hides the curves.
pub(super) fn fold_button(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let shown = editor.timeline.curves_shown();
    let (drawing, name) = if shown { (Drawing::FoldDown, "Hide the curves") } else { (Drawing::FoldUp, "Curves") };
    drawn_button(ui, drawing, name, Request::ToggleCurves, requests);
}

fn drawn_button(ui: &mut egui::Ui, drawing: Drawing, name: &str, request: Request, requests: &mut Vec<Request>) {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(BUTTON), Sense::click());
    let theme = theme_of(ui);
    if ui.is_enabled() && response.hovered() {
        ui.painter().rect_filled(rect, 4.0, theme.accent.gamma_multiply(0.12));
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 4.0, Stroke::new(1.0, theme.accent), egui::StrokeKind::Inside);
    }
    // egui draws a disabled button faintly.
    draw(ui.painter(), rect, drawing, theme.text);
    let tip = tip_with_keys(ui, name, &request);
    let response = response.named(Role::Button, name).on_hover_text(&tip).on_disabled_hover_text(&tip);
    response.asks(request, requests);
}

fn draw(painter: &egui::Painter, rect: Rect, drawing: Drawing, colour: Color32) {
    let middle = rect.center();
    let at = |x: f32, y: f32| middle + Vec2::new(x, y);
    let chevron = |up: f32| {
        let points = vec![at(-4.0, 2.0 * up), at(0.0, -2.0 * up), at(4.0, 2.0 * up)];
        painter.add(Shape::line(points, Stroke::new(1.6, colour)));
    };
    let (has_ring, tip_base_half, bars): (bool, Option<[f32; 3]>, &[f32]) = match drawing {
        Drawing::First => (false, Some([-3.0, 5.0, 4.5]), &[-5.0]),
        Drawing::Previous => (false, Some([-4.5, 3.5, 4.5]), &[]),
        Drawing::Play => (true, Some([5.0, -2.5, 4.0]), &[]),
        Drawing::Pause => (true, None, &[-2.5, 2.5]),
        Drawing::Next => (false, Some([4.5, -3.5, 4.5]), &[]),
        Drawing::Last => (false, Some([3.0, -5.0, 4.5]), &[5.0]),
        Drawing::FoldDown => return chevron(-1.0),
        Drawing::FoldUp => return chevron(1.0),
    };
    if has_ring {
        painter.circle_stroke(middle, 9.0, Stroke::new(1.3, colour));
    }
    if let Some([tip, base, half]) = tip_base_half {
        let corners = vec![at(tip, 0.0), at(base, -half), at(base, half)];
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    }
    for &x in bars {
        painter.rect_filled(Rect::from_center_size(at(x, 0.0), Vec2::new(2.0, 9.0)), 0.0, colour);
    }
}

/// Buttons that take new steps.
pub(super) fn run_buttons(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.spacing_mut().item_spacing.x = 4.0;
    let session = &editor.session;
    let theme = theme_of(ui);
    let button = match session.status() {
        // Highlight the obvious next action of a new document, unless there is something to repair.
        Status::Held if !session.can_repair() => {
            Button::new(RichText::new("Step").color(theme.panel)).fill(theme.accent)
        }
        _ => Button::new("Step"),
    };
    let step = Action::Step.into();
    let tip = tip_with_keys(ui, "Take one further step", &step);
    ui.add_enabled(editor.has_disk(), button).on_hover_text(tip).asks(step, requests);
    let (words, enabled, tip) = if session.is_running() {
        ("Pause", true, "Pause after the current step")
    } else {
        ("Run", session.can_run(), "Take steps until a stop condition holds")
    };
    let tip = tip_with_keys(ui, tip, &Request::RunOrPause);
    let at_rest = session.stopped().map_or("", RunStop::words);
    let response = ui.add_enabled(enabled, Button::new(words).min_size(Vec2::new(50.0, 0.0)));
    let response = response.on_disabled_hover_text(format!("Stopped: {at_rest}. Step still takes another step."));
    response.on_hover_text(tip).asks(Request::RunOrPause, requests);
    ui.add_space(4.0);
}

/// Menu of the stop conditions of a run.
pub(super) fn stop_menu(ui: &mut egui::Ui, editor: &Editor, room: Room, requests: &mut Vec<Request>) {
    let before = editor.session.stop_conditions();
    let mut stop = before;
    let words = if room == Room::Ample { format!("Stop: {}", conditions_in_words(before)) } else { "Stop".to_owned() };
    let response = lasting_menu(ui, &words, |ui| {
        ui.weak("Stop a run if");
        ui.checkbox(&mut stop.planar, "it is planar").on_hover_text("The embedding is proved one-to-one");
        ui.checkbox(&mut stop.stalled, "it stalls").on_hover_text("The iteration no longer improves and hardly moves");
        ui.checkbox(&mut stop.crossing, "the boundary crosses").on_hover_text("Two boundary edges meet");
        ui.horizontal(|ui| {
            let mut at_step = stop.at_step.is_some();
            let newest = editor.session.timeline().newest().unwrap_or_default();
            if ui.checkbox(&mut at_step, "it reaches step").on_hover_text("Counted from 0").changed() {
                stop.at_step = at_step.then_some(newest + 10);
            }
            if let Some(step) = &mut stop.at_step {
                let field = ui.add(egui::DragValue::new(step).range(0..=100_000)).on_hover_text("Step, counted from 0");
                field.named(Role::SpinButton, "Step to stop at");
            }
        });
        ui.weak("A run always stops at the end of its method.");
    });
    response.named(Role::Button, "Stop conditions").on_hover_text("Conditions that stop a run");
    if stop != before {
        requests.push(Action::SetStop(stop).into());
    }
}

/// Frameless button with a menu that stays open while its boxes are ticked.
pub(in crate::ui) fn lasting_menu(ui: &mut egui::Ui, words: &str, add: impl FnOnce(&mut egui::Ui)) -> egui::Response {
    let ink = theme_of(ui).weak_text;
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    // Room for the triangle that marks a menu.
    let button = Button::new(RichText::new(format!("{words}    ")).color(ink)).frame(false);
    let (response, _) = MenuButton::from_button(button).config(config).ui(ui, add);
    let middle = response.rect.right_center() - Vec2::new(4.5, -1.0);
    let corners = [(-3.5, -2.0), (3.5, -2.0), (0.0, 3.0)].map(|(x, y)| middle + Vec2::new(x, y));
    ui.painter().add(Shape::convex_polygon(corners.to_vec(), ink, Stroke::NONE));
    response
}

/// Stop conditions in few words.
fn conditions_in_words(stop: StopConditions) -> String {
    let named = [(stop.planar, "planar"), (stop.stalled, "stalled"), (stop.crossing, "crossing")];
    let mut words: Vec<String> = named.iter().filter(|(on, _)| *on).map(|(_, words)| (*words).to_owned()).collect();
    words.extend(stop.at_step.map(|step| format!("step {step}")));
    if words.is_empty() { "at the end".to_owned() } else { words.join(", ") }
}
