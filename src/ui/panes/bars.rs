//! Bars over a pane: errors, and questions of the window about recovered work, faces that point inward, and targets
//! that look mirrored. Bars cover part of the pane, which keeps its size.

use std::time::{Duration, SystemTime};

use eframe::egui::{self, Label, Rect, RichText, Sense, Vec2};

use super::seam;
use crate::session::{Action, Message, MessagePlace, MissingFile, Severity, named};
use crate::ui::icons::{self, Sign};
use crate::ui::state::FileDialogKind;
use crate::ui::{Control, Editor, Offer, Pane, Request, Tab, Tool, counted, sentence, theme_of};

/// Shows the bars at the upper edge of a pane.
pub(super) fn over(ui: &egui::Ui, rect: Rect, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let area = egui::Area::new(egui::Id::unique(("bars", pane == Pane::Mesh)));
    area.movable(false).order(egui::Order::Middle).fixed_pos(rect.min).constrain_to(rect).show(ui.ctx(), |ui| {
        ui.set_width(rect.width());
        ui.set_max_height(rect.height());
        ui.spacing_mut().item_spacing.y = 0.0;
        bars(ui, editor, pane, requests);
    });
}

fn bars(ui: &mut egui::Ui, editor: &Editor, pane: Pane, requests: &mut Vec<Request>) {
    let session = &editor.session;
    let place = match pane {
        Pane::Mesh => MessagePlace::Mesh,
        Pane::Plane => MessagePlace::Embedding,
    };
    if pane == Pane::Mesh && editor.tools.tool() == Tool::Seam && session.model().is_some() {
        // First, because the other bars appear and disappear.
        seam::strip(ui, editor, requests);
    }
    for left in session.recoverable().iter().filter(|_| pane == Pane::Mesh) {
        let since = SystemTime::now().duration_since(left.time).unwrap_or_default();
        let words =
            format!("Work on {} was not saved when the program ended. Recovery copy: {}", left.name, ago(since));
        let offers = [
            Offer::new("Recover", "Open the recovery copy", Action::Recover(left.path.clone())),
            Offer::new("Discard", "Delete the recovery copy", Action::DiscardRecovery(left.path.clone())),
        ];
        warning(ui, &words, offers, requests);
    }
    if pane == Pane::Mesh && editor.opened.faces_point_inward(session) {
        let offers = [
            Offer::new("Reverse them", "Make the other side of the faces the outside", Action::TurnFaces),
            Offer::new("Leave them", "Keep the faces; their orientation is intended", Request::LeaveFaces),
        ];
        let words = "The faces point inward: the mesh shows from behind, with its picture mirrored";
        warning(ui, words, offers, requests);
    }
    let remedy = session.model().and_then(|model| model.prepared.remedy.as_ref());
    if let Some(remedy) = remedy.filter(|_| pane == Pane::Mesh && session.seam_search().is_none()) {
        let done: Vec<String> = remedy.done().iter().map(ToString::to_string).collect();
        let words = match &done[..] {
            [] => "All faults of the mesh are harmless: it can be flattened without repair".to_owned(),
            _ => format!("The mesh can be repaired: {}", done.join(", ")),
        };
        let tip = "Repair the mesh and cut it along short seams. The file is not changed; undo reverts this";
        let offers = [
            Offer::new("Unwrap", tip, Action::Unwrap(None)),
            Offer::new("Show faults", "List every fault, with links to its elements", Request::ShowTab(Tab::Defects)),
        ];
        warning(ui, &words, offers, requests);
    }
    let is_dragging = editor.tools.dragged().is_some();
    if pane == Pane::Plane && !is_dragging && editor.opened.targets_look_mirrored(session) {
        let offers = [
            Offer::new("Mirror them", "Mirror all targets left to right", Action::MirrorTargets),
            Offer::new("Leave the targets", "Keep the targets; their orientation is intended", Request::LeaveTargets),
        ];
        let words = "Are the targets mirrored? A reflection fits them much better than a rotation";
        warning(ui, words, offers, requests);
    }
    message_bars(ui, editor, place, requests);
}

/// Formats an age.
fn ago(since: Duration) -> String {
    const MINUTE: u64 = 60;
    const HOUR: u64 = 60 * MINUTE;
    const DAY: u64 = 24 * HOUR;
    let whole = |unit: u64| usize::try_from(since.as_secs() / unit).unwrap_or(usize::MAX);
    let of = |unit: u64, one: &str, many: &str| format!("{} ago", counted(whole(unit), one, many));
    match since.as_secs() {
        ..MINUTE => "less than a minute ago".to_owned(),
        MINUTE..HOUR => of(MINUTE, "minute", "minutes"),
        HOUR..DAY => of(HOUR, "hour", "hours"),
        DAY.. => of(DAY, "day", "days"),
    }
}

fn warning(ui: &mut egui::Ui, words: &str, offers: impl IntoIterator<Item = Offer>, requests: &mut Vec<Request>) {
    bar(ui, Sign::Warning, |ui| {
        ui.add(Label::new(words).wrap());
        ui.horizontal_wrapped(|ui| offers.into_iter().for_each(|offer| offer.show(ui, requests)));
    });
}

/// Error messages of a pane: the problem, its place, the remedy. A message stays until dismissed or resolved.
fn message_bars(ui: &mut egui::Ui, editor: &Editor, place: MessagePlace, requests: &mut Vec<Request>) {
    let is_here = |message: &&Message| message.place == place && message.severity == Severity::Error;
    // Newest first.
    let messages: Vec<&Message> = editor.session.messages().iter().filter(is_here).rev().collect();
    if messages.is_empty() {
        return;
    }
    let groups = grouped(&messages);
    // The messages of one group are dismissed below it.
    if groups.len() > 1 {
        on_ground(ui, |ui| {
            let words = format!("Dismiss all {}", messages.len());
            if ui.small_button(words).on_hover_text("Dismiss all messages of this pane").clicked() {
                requests.extend(messages.iter().map(|message| Action::Dismiss(message.id).into()));
            }
        });
    }
    let limit = ui.available_height() / 2.0;
    egui::ScrollArea::vertical().id_salt(("messages", place == MessagePlace::Mesh)).max_height(limit).show(ui, |ui| {
        for group in &groups {
            group_bars(ui, editor, group, requests);
        }
    });
}

/// Row of buttons over a pane, on the ground of a panel.
fn on_ground(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    let frame =
        egui::Frame::new().fill(theme_of(ui).panel).corner_radius(4).inner_margin(egui::Margin::symmetric(8, 4));
    frame.outer_margin(egui::Margin::symmetric(4, 2)).show(ui, |ui| ui.horizontal_wrapped(add));
}

/// Messages in groups, by the file at fault. The group with the newest message comes first.
fn grouped<'a>(messages: &[&'a Message]) -> Vec<Vec<&'a Message>> {
    let mut groups: Vec<Vec<&Message>> = Vec::new();
    for message in messages {
        let same = |group: &&mut Vec<&Message>| message.about.is_some() && group[0].about == message.about;
        match groups.iter_mut().find(same) {
            Some(group) => group.push(message),
            None => groups.push(vec![message]),
        }
    }
    groups
}

/// Newest message of a group. A button under it unfolds the others.
fn group_bars(ui: &mut egui::Ui, editor: &Editor, group: &[&Message], requests: &mut Vec<Request>) {
    let Some((newest, others)) = group.split_first() else { return };
    message_bar(ui, editor, newest, requests);
    let Some(file) = newest.about.as_ref().filter(|_| !others.is_empty()) else { return };
    let id = ui.scope_id().with(("unfolded", file));
    let is_open = ui.data(|data| data.get_temp(id).unwrap_or(false));
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    on_ground(ui, |ui| {
        let words = counted(others.len(), "more problem", "more problems");
        let words = format!("{} {words} of {name}", if is_open { "Hide" } else { "Show" });
        if ui.small_button(words).on_hover_text("All problems of this file").clicked() {
            ui.data_mut(|data| data.insert_temp(id, !is_open));
        }
        if ui.small_button(format!("Dismiss these {}", group.len())).clicked() {
            requests.extend(group.iter().map(|message| Action::Dismiss(message.id).into()));
        }
    });
    for message in others.iter().filter(|_| is_open) {
        message_bar(ui, editor, message, requests);
    }
}

fn message_bar(ui: &mut egui::Ui, editor: &Editor, message: &Message, requests: &mut Vec<Request>) {
    bar(ui, Sign::Bad, |ui| {
        ui.add(Label::new(sentence(&message.text)).wrap());
        if let Some(remedy) = &message.remedy {
            let weak = theme_of(ui).weak_text;
            ui.add(Label::new(RichText::new(sentence(remedy)).color(weak)).wrap());
        }
        ui.horizontal_wrapped(|ui| message_buttons(ui, editor, message, requests));
    });
}

/// Bar over a pane, with its sign at the left.
fn bar(ui: &mut egui::Ui, sign: Sign, add: impl FnOnce(&mut egui::Ui)) {
    let theme = theme_of(ui);
    let frame = egui::Frame::new()
        .fill(theme.panel.lerp_to_gamma(sign.colour(theme), 0.14))
        .stroke(egui::Stroke::new(1.0, theme.separator))
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

fn message_buttons(ui: &mut egui::Ui, editor: &Editor, message: &Message, requests: &mut Vec<Request>) {
    if let Some(missing) = editor.session.missing_file(message) {
        let (kind, about) = match missing {
            MissingFile::Mesh => (FileDialogKind::LocateMesh, "Choose the mesh file, and open the project with it"),
            MissingFile::Picture => {
                (FileDialogKind::LocatePicture, "Choose the picture file, and open the project with it")
            }
        };
        ui.small_button("Locate…").on_hover_text(about).asks(Request::Ask(kind), requests);
    }
    if !message.vertices.is_empty() {
        let kind = if message.vertices.len() == 1 { "vertex" } else { "vertices" };
        let button = ui.small_button(format!("Go to {kind} {}", named(&message.vertices)));
        let request = Request::GoToFileVertices(message.vertices.clone());
        button.on_hover_text("Show it in both panes").asks(request, requests);
    }
    if ui.small_button("Copy").on_hover_text("Copy the message").clicked() {
        ui.ctx().copy_text(message.text.clone());
    }
    ui.small_button("Dismiss").asks(Action::Dismiss(message.id), requests);
}

#[cfg(test)]
mod tests {
    use freebound_testkit::assert_message;

    use super::*;

    #[test]
    fn a_time_is_said_in_its_largest_unit() {
        let times = [3, 60, 3_599, 2 * 3_600 + 5, 3 * 86_400].map(|seconds| ago(Duration::from_secs(seconds)));
        let numbers = times.each_ref().map(|words| words.split(' ').next()?.parse::<u32>().ok());
        assert_eq!(numbers, [None, Some(1), Some(59), Some(2), Some(3)]);
        assert_message("bars-times", &times.join("\n"));
    }
}
