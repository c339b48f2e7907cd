//! Next action, offered beside the verdict. Repair a faulty embedding. Change the settings if the flattener has ended
//! with a fault or with unmet constraints. Relax a planar but distorted embedding. Unwrap a mesh without seams whose
//! map is distorted.

use eframe::egui::{self, Button};

use super::menu::grouped;
use crate::session::{Action, MapOrigin, RunStop, Session, Status};
use crate::ui::GOOD_ENERGY;
use crate::ui::{Control, Editor, Request, Tab, accented, short, theme_of, tip_with_keys, with_keys_set};
use freebound_core::problem::{Method, Settings};

/// Width of the window below which the advice is short, points.
const ROOMY: f32 = 1000.0;

/// Next action.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Advice {
    Repair,
    /// Change of settings or pins after the flattener has ended with a fault or with unmet constraints.
    Change(Change),
    /// Relaxation, with the greatest ratio between the areas of a face in the plane and on the mesh, in either
    /// direction.
    Relax(f64),
    /// Automatic seams for a mesh without them, with its mean energy.
    Unwrap(f64),
}

impl Advice {
    fn of(editor: &Editor) -> Option<Self> {
        let session = &editor.session;
        if editor.shows_page() {
            // The advice is on a single chart.
            return None;
        }
        let is_at_rest = matches!(session.status(), Status::Held | Status::Current) && !editor.plane.is_moving(session);
        let step = editor.step_on_screen().filter(|_| is_at_rest && editor.tools.dragged().is_none())?;
        if step.step.verdict.planar {
            let change = Change::of(session).filter(|_| !step.step.unmet().is_empty());
            let ratio = step.distortion.summary.bad_ratio_of_areas().filter(|_| session.can_relax());
            let energy = step.distortion.summary.symmetric_dirichlet.mean;
            let is_uncut = session.map_origin() == Some(MapOrigin::Plain) && session.can_unwrap();
            let unwrap = (is_uncut && energy > GOOD_ENERGY).then_some(Self::Unwrap(energy));
            change.map(Self::Change).or(ratio.map(Self::Relax)).or(unwrap)
        } else if session.can_repair() {
            Some(Self::Repair)
        } else {
            Change::of(session).map(Self::Change)
        }
    }

    fn words(self, is_roomy: bool) -> String {
        match self {
            Self::Repair => "Repair".to_owned(),
            Self::Change(change) => change.words()[0].to_owned(),
            Self::Relax(ratio) if is_roomy => format!("Areas differ {} : 1, Relax (R)", ratio_words(ratio)),
            Self::Relax(_) => "Relax (R)".to_owned(),
            Self::Unwrap(_) => "Unwrap (U)".to_owned(),
        }
    }
}

/// Change that can help after the flattener has run out of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    NewVertices,
    Pins,
    Method,
}

impl Change {
    /// Change to offer. `None` unless a run of the automatic method has ended and its newest step is on the screen.
    fn of(session: &Session) -> Option<Self> {
        let document = session.document();
        let is_newest = session.timeline().shown() == session.timeline().newest();
        let has_ended = is_newest && matches!(session.stopped(), Some(RunStop::Ended(_)));
        if !has_ended || document.settings.method != Method::Auto {
            return None;
        }
        Some(match (document.targets.is_empty(), document.settings.new_vertices) {
            (false, false) => Self::NewVertices,
            (false, true) => Self::Pins,
            (true, _) => Self::Method,
        })
    }

    /// Label of the button, and its tooltip.
    const fn words(self) -> [&'static str; 2] {
        match self {
            Self::NewVertices => [
                "Allow new vertices",
                "No further method applies without adding vertices. Allow edge splits to satisfy nearly all \
                 constraints",
            ],
            Self::Pins => [
                "Free a pin",
                "No further method applies with these pins. Free a pin or move its target, in the Pins tab",
            ],
            Self::Method => ["Other weights", "No further method applies. Choose other weights or another method"],
        }
    }

    fn request(self, settings: Settings) -> Request {
        match self {
            Self::NewVertices => Action::SetSettings(Settings { new_vertices: true, ..settings }).into(),
            Self::Pins => Request::ShowTab(Tab::Pins),
            Self::Method => Request::ShowTab(Tab::Method),
        }
    }
}

/// Shows the button of the next action, if there is one.
pub(super) fn advice(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(advice) = Advice::of(editor) else { return };
    let words = advice.words(ui.ctx().content_rect().width() >= ROOMY);
    let words = with_keys_set(ui.ctx(), &words, ["(", "R", ")"], &Request::Do(Action::Relax));
    let theme = theme_of(ui);
    let (button, tip, request) = match advice {
        Advice::Repair => {
            let tip =
                "Run Auto until the embedding is proved planar. If another method is set, this changes it to Auto";
            (accented(words, theme), tip.to_owned(), Request::Do(Action::Repair))
        }
        Advice::Change(change) => {
            let request = change.request(editor.session.document().settings.clone());
            (accented(words, theme), change.words()[1].to_owned(), request)
        }
        Advice::Relax(ratio) => {
            let tip = format!(
                "Areas differ {} : 1 between mesh and embedding, at equal total areas. Relaxing lowers the \
                 distortion. The map stays planar, and hard pins stay on their targets",
                ratio_words(ratio)
            );
            (Button::new(words), tip, Request::Do(Action::Relax))
        }
        Advice::Unwrap(energy) => {
            let tip = format!(
                "Energy {}. Seams lower it to at most {GOOD_ENERGY}, which is hardly visible. Undo returns to the mesh \
                 without seams",
                short(energy)
            );
            (Button::new(words), tip, Request::Do(Action::Unwrap(None)))
        }
    };
    let tip = tip_with_keys(ui, &tip, &request);
    ui.add(button).on_hover_text(tip).asks(request, requests);
}

/// Formats a large ratio with two digits and grouped thousands.
pub(super) fn ratio_words(ratio: f64) -> String {
    if ratio.is_nan() || ratio >= 1e9 {
        return format!("{ratio:.0e}");
    }
    let unit = 10.0_f64.powf(ratio.log10().floor() - 1.0).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and a thousand million")]
    grouped(((ratio / unit).round() * unit) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_has_two_digits_and_its_thousands_apart() {
        let expected = [(100.4, "100"), (2_512.0, "2 500"), (98_765.4, "99 000"), (3.2e12, "3e12")];
        for (ratio, words) in expected {
            assert_eq!(ratio_words(ratio), words);
        }
        assert_eq!(ratio_words(f64::INFINITY), "inf");
    }
}
