//! Card of the guided tour, over the lower left corner of a pane. Each card asks for one action, and says when it was
//! done.

use eframe::egui::{self, Align2, Rect, RichText};

use crate::session::Action;
use crate::ui::state::{Tour, TourCard, TourStart};
use crate::ui::theme::BOTTOM_HEIGHT;
use crate::ui::{Editor, Request, Tool, theme_of, with_keys_set};

/// Width of a card, points.
const WIDTH: f32 = 300.0;

/// Gap between the card and the edges of the panes, points.
const GAP: f32 = 12.0;

/// Least width of a card, points.
const LEAST_WIDTH: f32 = 200.0;

/// Answer to a card.
enum Answer {
    Next,
    End,
}

pub(in crate::ui) fn tour(context: &egui::Context, editor: &mut Editor) {
    let Some(mut tour) = editor.layout.tour.take() else { return };
    let mesh = editor.session.model_revision();
    if tour.start.as_ref().is_some_and(|start| start.mesh != mesh) {
        tour.start = None;
    }
    // The camera is framed when the mesh arrives.
    if !tour.is_done && editor.mesh.scene().is_some() {
        let card = tour.card();
        let start = tour.start.get_or_insert_with(|| state(editor, mesh));
        tour.is_done = notices(card, start, editor);
    }
    let strip = if editor.has_disk() { editor.timeline.height() } else { 0.0 };
    let area = egui::Area::new(egui::Id::unique("tour")).order(egui::Order::Foreground).movable(false);
    let pane = pane_beside(context, editor, tour.card());
    let bottom = context.content_rect().bottom() - (BOTTOM_HEIGHT + strip + GAP);
    let area = area.pivot(Align2::LEFT_BOTTOM).fixed_pos(egui::pos2(pane.left() + GAP, bottom));
    // Inner margins of the card are 12 points.
    let width = (pane.width() - 2.0 * GAP - 24.0).clamp(LEAST_WIDTH, WIDTH);
    editor.layout.tour = match area.show(context, |ui| card(ui, &tour, width)).inner {
        Some(Answer::Next) => tour.next(),
        Some(Answer::End) => None,
        None => Some(tour),
    };
}

/// Pane that a card covers a corner of: not the mesh if the card asks to turn or to pin it.
fn pane_beside(context: &egui::Context, editor: &Editor, card: TourCard) -> Rect {
    let plane = editor.plane.rect();
    let [first, second] = match card {
        TourCard::Look | TourCard::Pin => [plane, editor.mesh.pane.rect()],
        _ => [editor.mesh.pane.rect(), plane],
    };
    first.or(second).unwrap_or_else(|| context.content_rect())
}

fn state(editor: &Editor, mesh: u64) -> TourStart {
    TourStart {
        mesh,
        camera: editor.mesh.pane.camera(),
        targets: editor.session.document().targets.clone(),
        exports_shown: editor.layout.exports_shown,
    }
}

/// True if the action of a card was done since its start.
fn notices(card: TourCard, start: &mut TourStart, editor: &Editor) -> bool {
    let targets = &editor.session.document().targets;
    match card {
        TourCard::Look => editor.mesh.pane.camera() != start.camera,
        TourCard::Pin | TourCard::Landmark => targets.keys().any(|vertex| !start.targets.contains_key(vertex)),
        TourCard::Drag => targets.iter().any(|(&vertex, target)| {
            // A pin that was made on this card counts once it is dragged.
            start.targets.entry(vertex).or_insert(*target).uv != target.uv
        }),
        TourCard::Step => editor.step_on_screen().is_some_and(|outcome| outcome.step.verdict.planar),
        TourCard::Export => {
            start.exports_shown &= editor.layout.exports_shown;
            editor.layout.exports_shown && !start.exports_shown
        }
    }
}

/// Instruction of a card with the keys that the user has set.
fn with_keys(context: &egui::Context, card: TourCard, text: &str) -> String {
    let (usual, request) = match card {
        TourCard::Pin => ("P", Request::SetTool(Tool::Fix)),
        TourCard::Step => ("Space", Request::Do(Action::Step)),
        TourCard::Landmark => ("C", Request::SetTool(Tool::Constrain)),
        TourCard::Export => ("Ctrl+E", Request::ToggleExports),
        TourCard::Look | TourCard::Drag => return text.to_owned(),
    };
    with_keys_set(context, text, ["Press ", usual, ""], &request)
}

fn card(ui: &mut egui::Ui, tour: &Tour, width: f32) -> Option<Answer> {
    let theme = theme_of(ui);
    let [title, text] = tour.card().words();
    let mut answer = None;
    egui::Frame::popup(ui.style()).fill(theme.panel).inner_margin(12).show(ui, |ui| {
        ui.set_width(width);
        ui.label(RichText::new(format!("Tour {} of {}", tour.place + 1, TourCard::ALL.len())).color(theme.weak_text));
        ui.strong(title);
        ui.label(with_keys(ui.ctx(), tour.card(), text));
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let is_last = tour.next().is_none();
            let next = egui::Button::new(if is_last { "Finish" } else { "Next" });
            let next = if tour.is_done() { next.fill(theme.planar.gamma_multiply(0.35)) } else { next };
            let tip = if is_last { "End the tour" } else { "Go to the next card, with or without the action" };
            if ui.add(next).on_hover_text(tip).clicked() {
                answer = Some(Answer::Next);
            }
            if !is_last && ui.button("Skip tour").on_hover_text("End the tour. Help has it again").clicked() {
                answer = Some(Answer::End);
            }
            if tour.is_done() {
                ui.colored_label(theme.planar, "Done");
            }
        });
    });
    answer
}
