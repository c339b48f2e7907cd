//! What both panes share: header, message bars, marks and legend.

use eframe::egui;
use egui::{Align2, Color32, FontId, Pos2, Rect, Role, Sense, Stroke, Vec2};
use glam::DVec2;

use crate::session::{Action, Message, Place, Severity};
use crate::ui::controls::{Control, Offer, list, sentence, tip_with_keys};
use crate::ui::editor::scene::Legend;
use crate::ui::icons::{self, Sign};
use crate::ui::theme::theme_of;
use crate::ui::{Editor, Pane, Request, Shading};

/// A point of the screen as the camera takes it, relative to the pane.
pub(super) fn in_pane(rect: Rect, position: Pos2) -> DVec2 {
    DVec2::new((position.x - rect.min.x).into(), (position.y - rect.min.y).into())
}

/// A point of the pane on the screen.
#[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
pub(in crate::ui) fn on_screen(rect: Rect, point: DVec2) -> Pos2 {
    rect.min + Vec2::new(point.x as f32, point.y as f32)
}

/// The pane's size as the camera takes it.
pub(in crate::ui) fn size_of(rect: Rect) -> DVec2 {
    DVec2::new(rect.width().into(), rect.height().into())
}

/// Where a pane lies in the window.
#[derive(Clone, Copy, Debug)]
pub struct PaneArea {
    /// None where the pane does not show.
    rect: Option<Rect>,
    size: DVec2,
}

impl Default for PaneArea {
    fn default() -> Self {
        Self { rect: None, size: DVec2::splat(400.0) }
    }
}

impl PaneArea {
    /// Where the pane lies, points; `None` where it does not show.
    pub(in crate::ui) fn rect(&self) -> Option<Rect> {
        self.rect
    }

    /// Its size when it showed last, points.
    pub fn size(&self) -> DVec2 {
        self.size
    }

    /// Takes in that the pane does not show, or not yet in this frame.
    pub(in crate::ui) fn hide(&mut self) {
        self.rect = None;
    }

    /// Takes in where the pane lies. Returns whether its size has changed.
    pub(in crate::ui) fn set_rect(&mut self, rect: Rect) -> bool {
        self.rect = Some(rect);
        std::mem::replace(&mut self.size, size_of(rect)) != self.size
    }
}

/// Title, shading and the button for full size.
pub(super) fn header(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let title = match pane {
        Pane::Mesh => "Mesh",
        Pane::Plane => "Embedding",
    };
    ui.horizontal(|ui| {
        ui.set_min_height(26.0);
        ui.add_space(8.0);
        ui.strong(title);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(4.0);
            let (glyph, words) = if editor.layout.full().is_some() {
                ("Both", "Show both panes")
            } else {
                ("Full", "Show this pane alone")
            };
            let tip = tip_with_keys(ui, words, &Request::TogglePane);
            let button = ui.add(egui::Button::new(glyph).frame(false)).on_hover_text(tip);
            button.named(Role::Button, &format!("{words}: {title}")).asks(Request::ToggleFull(pane), requests);
            if pane == Pane::Plane {
                hull_switch(ui, editor, requests);
            }
            if pane == Pane::Mesh || editor.layout.full() == Some(Pane::Plane) {
                shading_menu(ui, editor, requests);
            }
        });
    });
}

fn hull_switch(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let tip = tip_with_keys(ui, "Hull and pockets of the virtual boundary", &Request::ToggleHull);
    let switch = ui.selectable_label(editor.plane.hull_shown(), "Hull").on_hover_text(tip);
    switch.asks(Request::ToggleHull, requests);
}

fn shading_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let tip = tip_with_keys(ui, "Wireframe", &Request::ToggleWireframe);
    let wire = ui.selectable_label(editor.look.wireframe, "Wire").on_hover_text(tip);
    wire.asks(Request::ToggleWireframe, requests);
    let width = ui.spacing().combo_width;
    list(ui, "Shading of both panes", width, editor.look.shading.title(), |ui| {
        for shading in Shading::ALL {
            let request = Request::SetShading(shading);
            let tip = tip_with_keys(ui, shading.about(), &request);
            let entry = ui.selectable_label(editor.look.shading == shading, shading.title()).on_hover_text(tip);
            entry.asks(request, requests);
        }
    });
}

/// Messages that belong to a pane: what happened, where, what to do. They stay until dismissed or mended.
pub(super) fn message_bars(ui: &mut egui::Ui, editor: &Editor, place: Place, requests: &mut Vec<Request>) {
    let messages: Vec<&Message> = editor.session.messages().iter().filter(|m| m.place == place).collect();
    if messages.is_empty() {
        return;
    }
    let limit = ui.available_height() / 2.0;
    egui::ScrollArea::vertical().id_salt(("messages", place == Place::Mesh)).max_height(limit).show(ui, |ui| {
        for message in messages {
            message_bar(ui, message, requests);
        }
    });
}

fn message_bar(ui: &mut egui::Ui, message: &Message, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let sign = match message.severity {
        Severity::Note => Sign::Good,
        Severity::Error => Sign::Bad,
    };
    bar(ui, sign, |ui| {
        ui.add(egui::Label::new(sentence(&message.text)).wrap());
        if let Some(remedy) = &message.remedy {
            ui.add(egui::Label::new(egui::RichText::new(sentence(remedy)).color(theme.weak_text)).wrap());
        }
        ui.horizontal_wrapped(|ui| message_buttons(ui, message, requests));
    });
}

/// A bar over a pane, with its sign at the left.
pub(in crate::ui) fn bar(ui: &mut egui::Ui, sign: Sign, add: impl FnOnce(&mut egui::Ui)) {
    let theme = theme_of(ui);
    let frame = egui::Frame::new()
        .fill(sign.colour(theme).gamma_multiply(0.14))
        .inner_margin(8)
        .outer_margin(egui::Margin::symmetric(4, 2));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal_top(|ui| {
            let (square, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
            icons::sign(ui.painter(), square.translate(Vec2::new(0.0, 3.0)), sign, theme);
            ui.vertical(add);
        });
    });
}

fn message_buttons(ui: &mut egui::Ui, message: &Message, requests: &mut Vec<Request>) {
    if !message.vertices.is_empty() {
        Offer::new("Go to", "Show it in the mesh", Request::GoTo(message.vertices.clone())).show(ui, requests);
    }
    if ui.small_button("Copy").on_hover_text("Copy the message").clicked() {
        ui.ctx().copy_text(message.text.clone());
    }
    ui.small_button("Dismiss").asks(Action::Dismiss(message.id), requests);
}

/// Words in the middle of a pane that has nothing to show.
pub(super) fn empty_state(ui: &egui::Ui, rect: Rect, lines: &[&str]) {
    let theme = theme_of(ui);
    let width = (rect.width() - 32.0).max(40.0);
    let mut galleys = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let (size, colour) = if i == 0 { (15.0, theme.text) } else { (13.0, theme.weak_text) };
        let mut job = egui::text::LayoutJob::simple((*line).to_owned(), FontId::proportional(size), colour, width);
        job.halign = egui::Align::Center;
        galleys.push(ui.painter().layout_job(job));
    }
    let height: f32 = galleys.iter().map(|galley| galley.size().y + 6.0).sum();
    let mut at = rect.center() - Vec2::new(0.0, height / 2.0);
    for galley in galleys {
        let step = galley.size().y + 6.0;
        ui.painter_at(rect).galley(at, galley, theme.text);
        at.y += step;
    }
}

/// A ring around a vertex.
pub(super) fn halo(painter: &egui::Painter, at: Pos2, colour: Color32, radius: f32) {
    painter.circle_stroke(at, radius + 1.5, Stroke::new(1.5, Color32::from_black_alpha(90)));
    painter.circle_stroke(at, radius, Stroke::new(2.0, colour));
}

/// The scale of a shading: bar, histogram, numbers.
pub(in crate::ui) fn legend(ui: &egui::Ui, rect: Rect, legend: &Legend, title: &str) {
    let theme = theme_of(ui);
    let painter = ui.painter_at(rect);
    let size = Vec2::new(184.0, 78.0);
    if rect.width() < size.x + 24.0 || rect.height() < 2.0 * size.y {
        return;
    }
    let frame = Rect::from_min_size(rect.left_bottom() + Vec2::new(12.0, -12.0 - size.y), size);
    painter.rect_filled(frame, 4.0, theme.panel.gamma_multiply(0.92));
    painter.text(frame.min + Vec2::new(10.0, 6.0), Align2::LEFT_TOP, title, FontId::proportional(11.0), theme.text);
    let bar = Rect::from_min_size(frame.min + Vec2::new(10.0, 44.0), Vec2::new(size.x - 20.0, 9.0));
    let most = legend.histogram.iter().copied().max().unwrap_or(0).max(1);
    let width = bar.width() / legend.histogram.len() as f32;
    for (i, &count) in legend.histogram.iter().enumerate() {
        let left = bar.left() + width * i as f32;
        let share = (i as f64 + 0.5) / legend.histogram.len() as f64;
        let [r, g, b] = legend.scale.colour_at(share);
        let cell = Rect::from_min_size(Pos2::new(left, bar.top()), Vec2::new(width + 0.5, bar.height()));
        painter.rect_filled(cell, 0.0, crate::ui::theme::rgb([r, g, b]));
        #[expect(clippy::cast_possible_truncation, reason = "a height in points")]
        let height = (20.0 * f64::from(count) / f64::from(most)) as f32;
        let column =
            Rect::from_min_max(Pos2::new(left, bar.top() - 1.0 - height), Pos2::new(left + width, bar.top() - 1.0));
        painter.rect_filled(column, 0.0, theme.weak_text.gamma_multiply(0.6));
    }
    for tick in legend.scale.ticks(legend.range) {
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
        let x = bar.left() + bar.width() * tick.at as f32;
        painter.vline(x, bar.bottom()..=bar.bottom() + 3.0, Stroke::new(1.0, theme.weak_text));
        painter.text(
            Pos2::new(x, bar.bottom() + 4.0),
            Align2::CENTER_TOP,
            &tick.label,
            FontId::proportional(10.0),
            theme.weak_text,
        );
    }
}

/// A pane's drawing surface, with its name for those who do not see it.
pub(in crate::ui) fn surface(ui: &mut egui::Ui, name: &str) -> (Rect, egui::Response) {
    let size = ui.available_size().max(Vec2::splat(16.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    (rect, response.named(Role::Image, name))
}

/// What the wheel and the trackpad did over a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WheelMove {
    /// How much nearer to come: above 1 enlarges.
    pub(super) zoom: f64,
    /// How far to pan, points.
    pub(in crate::ui) pan: DVec2,
}

/// Enlargement per notch of the wheel.
const ZOOM_PER_NOTCH: f64 = 1.15;

/// Reads the wheel: notches zoom, two fingers on a trackpad pan, a pinch zooms.
pub(super) fn wheel(ui: &egui::Ui) -> WheelMove {
    ui.input(|input| {
        let mut moved = WheelMove { zoom: f64::from(input.zoom_delta()), pan: DVec2::ZERO };
        for event in &input.events {
            let egui::Event::MouseWheel { unit, delta, modifiers, .. } = event else { continue };
            if modifiers.command {
                continue;
            }
            match unit {
                egui::MouseWheelUnit::Point => moved.pan += DVec2::new(delta.x.into(), delta.y.into()),
                _ => moved.zoom *= ZOOM_PER_NOTCH.powf(delta.y.into()),
            }
        }
        moved
    })
}
