//! Seams of the mesh: unwrapping, the slider from short seams to little distortion, and the length of the seams.

use eframe::egui::{self, WidgetInfo};

use crate::session::{Action, SeamSearch, Session};
use crate::ui::{Control, Editor, Request, Typed, number, pairs, remark, short, tip_with_keys};
use freebound_core::cutting::SeamOptions;

/// Range of the slider: energy above that of an isometric map.
const EXCESS: std::ops::RangeInclusive<f64> = 0.01..=4.0;

pub(super) fn seams_section(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let session = &editor.session;
    let can_unwrap = session.can_unwrap();
    ui.horizontal(|ui| {
        let unwrap = Action::Unwrap(None).into();
        let tip = "Cut the mesh along short seams, so that its map has little distortion, and repair it if needed. \
                   Seams by hand are kept. The file is not changed; undo reverts this";
        let tip = tip_with_keys(ui, tip, &unwrap);
        let button = ui.add_enabled(can_unwrap, egui::Button::new("Unwrap"));
        button.on_hover_text(&tip).on_disabled_hover_text(tip).asks(unwrap, requests);
        if session.seam_search().is_some() {
            ui.button("Stop").on_hover_text("Stop the search for seams").asks(Action::Cancel, requests);
            ui.add(egui::Spinner::new().size(12.0));
        }
    });
    ui.add_enabled_ui(can_unwrap, |ui| slider(ui, session, requests));
    match session.seam_search() {
        Some(search) => drop(remark(ui, progress_words(&search))),
        None => lengths(ui, session),
    }
}

/// Slider for the bound on the distortion. The seams show while it moves, and are cut when it is released.
fn slider(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let kept = ui.scope_id().with("distortion");
    let before = (session.seam_bound() - SeamOptions::ISOMETRIC).clamp(*EXCESS.start(), *EXCESS.end());
    let mut excess: f64 = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let response = ui
        .vertical(|ui| {
            ui.horizontal(|ui| {
                ui.weak("Few seams");
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.weak("Little distortion"));
            });
            ui.spacing_mut().slider_width = (ui.available_width() - 62.0).max(60.0);
            let typed = Typed::new("an energy", 4.01..=8.0);
            // Little distortion is at the right.
            let range = *EXCESS.end()..=*EXCESS.start();
            let slider = egui::Slider::new(&mut excess, range)
                .logarithmic(true)
                .custom_formatter(|excess, _| format!("{:.2}", SeamOptions::ISOMETRIC + excess))
                .custom_parser(move |text| typed.number(text).map(|energy| energy - SeamOptions::ISOMETRIC));
            ui.add(slider)
        })
        .inner;
    let bound = SeamOptions::ISOMETRIC + excess;
    response.widget_info(|| WidgetInfo::slider(true, bound, "Bound on the distortion"));
    let has_changed = excess.to_bits() != before.to_bits();
    // The slider shows two digits.
    let bound = (bound * 100.0).round() / 100.0;
    if response.has_ended() || (response.changed() && !response.dragged()) {
        ui.data_mut(|data| data.remove::<f64>(kept));
        let action = if has_changed { Action::Unwrap(Some(bound)) } else { Action::PreviewSeams(None) };
        requests.push(action.into());
    } else if response.changed() {
        requests.push(Action::PreviewSeams(Some(bound)).into());
        ui.data_mut(|data| data.insert_temp(kept, excess));
    }
    response.on_hover_text(
        "Bound on the mean symmetric Dirichlet energy of each chart: 4 keeps all lengths, 4.1 is hardly visible. The \
         shortest seams found that meet it are cut",
    );
}

/// Progress of a search in few words.
pub(super) fn progress_words(search: &SeamSearch) -> String {
    let SeamSearch { done_count, part_count, relative_length, energy, .. } = search;
    match part_count {
        0 => "Finding short seams…".to_owned(),
        1 => format!("Finding short seams… energy {energy:.2}, length {relative_length:.2} √area"),
        _ => format!("Finding short seams… {done_count} of {part_count} parts, length {relative_length:.2} √area"),
    }
}

/// Length of the seams, and the greatest energy that was asked for.
fn lengths(ui: &mut egui::Ui, session: &Session) {
    let Some(seams) = session.automatic_seams() else { return };
    pairs(ui, "seams", [12.0, 4.0], |ui| {
        let tip = "Length of the automatic seams, and relative to the root of the surface's area";
        let relative = format!("{} ({:.2} √area)", short(seams.length), seams.relative_length());
        number(ui, "Seams", relative).on_hover_text(tip);
        let edges = seams.edges().len();
        number(ui, "Seam edges", edges.to_string()).on_hover_text("Number of edges that automatic seams cut");
    });
}
