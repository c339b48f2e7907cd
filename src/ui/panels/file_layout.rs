//! Findings about the texture coordinates of the open file: in the defects tab.

use eframe::egui::{self, Button, Color32, RichText, Role};

use super::menu::grouped;
use crate::session::{Action, LayoutCheckState, Session};
use crate::ui::{Control, Request, Theme, sentence, theme_of};
use freebound_core::mesh::FaceId;
use freebound_core::verify::{Finding, FindingSeverity, LayoutVerdict};

/// Section with the verdict on the layout of the file, if the file has texture coordinates.
pub(super) fn file_layout(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(state) = session.layout_check() else { return };
    egui::CollapsingHeader::new("Layout of the file").default_open(true).show(ui, |ui| match state {
        LayoutCheckState::Open => {
            let tip = "Test the texture coordinates of the file for overlaps, flipped faces and other faults";
            ui.button("Check")
                .named(Role::Button, "Check the layout of the file")
                .on_hover_text(tip)
                .asks(Action::CheckLayout, requests);
        }
        LayoutCheckState::Running => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label("Checking");
            });
        }
        LayoutCheckState::Failed(reason) => {
            ui.colored_label(theme_of(ui).flipped, sentence(&reason));
        }
        LayoutCheckState::Done(found) => findings(ui, session.opening_revision(), &found, requests),
    });
    ui.separator();
}

fn findings(ui: &mut egui::Ui, opening: u64, found: &LayoutVerdict, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let colour = if found.planar { theme.planar } else { theme.flipped };
    ui.colored_label(colour, sentence(&found.summary()));
    for finding in &found.findings {
        ui.push_id(opening, |ui| finding_row(ui, finding, requests));
    }
}

/// Finding with its count, and buttons that show its elements in turn.
fn finding_row(ui: &mut egui::Ui, finding: &Finding, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    ui.horizontal_wrapped(|ui| {
        let (square, _) = ui.allocate_exact_size(egui::Vec2::splat(10.0), egui::Sense::hover());
        ui.painter().rect_filled(square, 1.0, colour_of(finding.severity, theme));
        ui.label(sentence(&finding.headline())).on_hover_text(severity_words(finding.severity));
    });
    let count = finding.faces.len().max(finding.pairs.len());
    let place = ui.scope_id().with(("finding", finding.code.name()));
    let shown: Option<usize> = ui.data(|data| data.get_temp(place)).filter(|&at| at < count);
    let buttons: &[(&str, usize)] = match count {
        0 => return,
        1 => &[("Show", 0)],
        _ => &[("Previous", count - 1), ("Next", 1)],
    };
    ui.horizontal_wrapped(|ui| {
        for &(words, by) in buttons {
            let first = if by > 1 { count - 1 } else { 0 };
            let to = shown.map_or(first, |at| (at + by) % count);
            let button = ui.add(Button::new(words)).on_hover_text("Show it in both panes");
            let name = format!("{words} of {}", finding.code.name().replace('-', " "));
            if button.named(Role::Button, &name).clicked() {
                requests.push(Request::GoToFileFaces(faces_at(finding, to)));
                ui.data_mut(|data| data.insert_temp(place, to));
            }
        }
        if let Some(at) = shown {
            let faces: Vec<String> = faces_at(finding, at).iter().map(|face| face.number().to_string()).collect();
            let noun = if faces.len() == 1 { "face" } else { "faces" };
            let of = if count == 1 { String::new() } else { format!("{} of {}: ", grouped(at + 1), grouped(count)) };
            let words = format!("{of}{noun} {}", faces.join(" and "));
            ui.label(RichText::new(words).color(theme.weak_text));
        }
    });
}

/// Faces of the file at a place in the list of a finding.
fn faces_at(finding: &Finding, place: usize) -> Vec<FaceId> {
    finding
        .pairs
        .get(place)
        .map_or_else(|| finding.faces.get(place).copied().into_iter().collect(), |pair| pair.to_vec())
}

fn colour_of(severity: FindingSeverity, theme: &Theme) -> Color32 {
    match severity {
        FindingSeverity::Error => theme.flipped,
        FindingSeverity::Warning => theme.concave,
        FindingSeverity::Note => theme.weak_text,
    }
}

const fn severity_words(severity: FindingSeverity) -> &'static str {
    match severity {
        FindingSeverity::Error => "Error: the layout is not usable as it is",
        FindingSeverity::Warning => "Warning: the layout may be meant so",
        FindingSeverity::Note => "Note",
    }
}
