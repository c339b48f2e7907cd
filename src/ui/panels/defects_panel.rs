//! Tab of the defects: faults of the mesh, or defects of the embedding with links to them.

use eframe::egui::{self, Color32, RichText, Role};

use super::diagnosis;
use super::file_layout::file_layout;
use super::hull_section::hull_section;
use super::parts::parts;
use super::welding::welding;
use crate::ui::{Control, Defect, Editor, Request, Theme, counted, keys_of, read_more, theme_of};
use freebound_core::mesh::VertexId;
use freebound_core::verify::Verdict;

/// Height of a row, points.
const ROW: f32 = 22.0;

/// Kinds of defects, in list order.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Flipped,
    Concave,
    CrossedHole,
    Crossing,
    Overwound,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Flipped, Self::Concave, Self::CrossedHole, Self::Crossing, Self::Overwound];

    const fn of(defect: Defect) -> Self {
        match defect {
            Defect::Flipped(_) => Self::Flipped,
            Defect::Concave(_) => Self::Concave,
            Defect::CrossedHole(_) => Self::CrossedHole,
            Defect::Crossing(_) => Self::Crossing,
            Defect::Overwound(_) => Self::Overwound,
        }
    }

    const fn colour(self, theme: &Theme) -> Color32 {
        match self {
            Self::Flipped => theme.flipped,
            Self::Concave => theme.concave,
            Self::CrossedHole | Self::Crossing => theme.crossing,
            Self::Overwound => theme.overwound,
        }
    }

    /// Number of defects of the kind, with its noun.
    fn counted(self, verdict: &Verdict) -> String {
        match self {
            Self::Flipped => counted(verdict.flipped_faces.len(), "flipped face", "flipped faces"),
            Self::Concave => counted(verdict.concave_polygons.len(), "concave polygon", "concave polygons"),
            Self::CrossedHole => counted(verdict.crossed_holes.len(), "crossed hole", "crossed holes"),
            Self::Crossing if verdict.boundary_crossings.len() == 1 => "1 boundary crossing".to_owned(),
            Self::Crossing => format!("{} boundary crossings", verdict.crossing_count_in_words()),
            Self::Overwound => counted(verdict.overwound_vertices.len(), "overwound vertex", "overwound vertices"),
        }
    }
}

pub(in crate::ui) fn defects_panel(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    file_layout(ui, &editor.session, requests);
    if diagnosis::faults(ui, &editor.session, requests) {
        return;
    }
    if let Some(model) = editor.session.model() {
        diagnosis::notes(ui, model);
        parts(ui, &editor.session, requests);
        welding(ui, &editor.session, requests);
    }
    let Some(outcome) = editor.step_on_screen().cloned() else {
        ui.label("Nothing is solved yet.");
        return;
    };
    let verdict = &outcome.step.verdict;
    if verdict.planar {
        ui.colored_label(theme.planar, "Planar: proved one-to-one");
        ui.label("Exact arithmetic shows that no face is flipped and that the boundary does not meet itself.");
        read_more(ui, "What is proved?", "why.md#the-word-proved", requests);
        unmet_list(ui, editor, &outcome.step.unmet(), requests);
        let new = outcome.new_vertex_count();
        if new > 0 {
            let words = counted(new, "new vertex", "new vertices");
            ui.label(format!("{words} on split edges. The surface is unchanged, with more triangles."));
        }
        return;
    }
    counts(ui, editor, verdict, requests);
    read_more(ui, "What are these defects?", "window.md#defects", requests);
    let turns = verdict.turning_number.map_or_else(|| "undefined".to_owned(), |turns| turns.to_string());
    ui.label(RichText::new(format!("Turning number of the boundary: {turns}")).color(theme.weak_text))
        .on_hover_text("1 if the boundary goes around once. Undefined if an edge has no length or turns back");
    ui.horizontal(|ui| {
        for (words, by) in [("Previous", -1), ("Next", 1)] {
            let request = Request::StepDefect(by);
            ui.button(words).on_hover_text(keys_of(ui.ctx(), &request)).asks(request, requests);
        }
        if let Some(at) = editor.selection.defect() {
            ui.weak(format!("{} of {}", at + 1, editor.defect_count()));
        }
    });
    hull_section(ui, editor, requests);
    ui.separator();
    list(ui, editor, requests);
}

/// Number of defects of each kind. A click shows the next of its kind.
fn counts(ui: &mut egui::Ui, editor: &Editor, verdict: &Verdict, requests: &mut Vec<Request>) {
    let defects = editor.defects();
    for kind in Kind::ALL {
        let places = || (0..defects.len()).filter(|&place| Kind::of(defects[place]) == kind);
        let shown = editor.selection.defect();
        let next = places().find(|&place| shown.is_some_and(|shown| place > shown)).or(places().next());
        let words = kind.counted(verdict);
        ui.horizontal(|ui| {
            let (square, _) = ui.allocate_exact_size(egui::Vec2::splat(10.0), egui::Sense::hover());
            ui.painter().rect_filled(square, 1.0, kind.colour(theme_of(ui)));
            // Words begin at the same place, with a button around them or not.
            let Some(next) = next else {
                ui.add_space(ui.spacing().button_padding.x);
                ui.label(words);
                return;
            };
            let button =
                ui.add(egui::Button::new(&words).frame_when_inactive(false)).on_hover_text("Go to the next one");
            button.named(Role::Button, &format!("{words}, go to the next")).asks(Request::GoToDefect(next), requests);
        });
    }
}

/// List of the hard pins that miss their targets, each a link to its vertex.
fn unmet_list(ui: &mut egui::Ui, editor: &Editor, unmet: &[VertexId], requests: &mut Vec<Request>) {
    if unmet.is_empty() {
        return;
    }
    ui.colored_label(theme_of(ui).unmet, format!("Constraints not met: {}", unmet.len()));
    ui.horizontal_wrapped(|ui| {
        for &vertex in unmet {
            let link = ui.link(editor.vertex_words(vertex)).on_hover_text("Show this vertex");
            link.asks(Request::GoTo(vec![vertex]), requests);
        }
    });
}

fn list(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(plane) = editor.plane.scene() else { return };
    let theme = theme_of(ui);
    let defects = editor.defects();
    egui::ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, defects.len(), |ui, range| {
        for place in range {
            let colour = Kind::of(defects[place]).colour(theme);
            let words = RichText::new(defects[place].words(&plane.mesh)).color(colour);
            let row = ui.selectable_label(editor.selection.defect() == Some(place), words);
            row.context_menu(|ui| {
                for (words, request) in [("Go to", Request::GoToDefect(place)), ("Next", Request::StepDefect(1))] {
                    if ui.button(words).asks(request, requests) {
                        ui.close();
                    }
                }
            });
            row.asks(Request::GoToDefect(place), requests);
        }
    });
}
