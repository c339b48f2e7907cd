//! What to do next, beside the verdict: repair an embedding that is at fault, or change what it was asked for where the
//! flattener has ended with a fault, or with constraints that are not met; relax one that is planar but distorted.

use eframe::egui::{self, Button, RichText};

use super::menu::grouped;
use crate::session::{Action, RunStop, Session, Status};
use crate::ui::{Control, Editor, Request, Tab, Theme, theme_of, tip_with_keys};
use freebound_core::problem::{Method, Settings};

/// Width of the bar below which the advice is one word, points.
const ROOMY: f32 = 1000.0;

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Advice {
    Repair,
    /// The flattener has ended with a fault, or without all constraints met: what can still be done.
    Change(Change),
    /// With the greatest ratio of a face's area in the plane to that on the mesh, or the other way round.
    Relax(f64),
}

impl Advice {
    fn of(editor: &Editor) -> Option<Self> {
        let session = &editor.session;
        let is_at_rest = matches!(session.status(), Status::Held | Status::Current) && !editor.plane.is_moving(session);
        let step = editor.step_on_screen().filter(|_| is_at_rest && editor.tools.dragged().is_none())?;
        if step.step.verdict.planar {
            let change = Change::of(session).filter(|_| !step.step.unmet().is_empty());
            let ratio = step.distortion.summary.bad_ratio_of_areas().filter(|_| session.can_relax());
            change.map(Self::Change).or(ratio.map(Self::Relax))
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
        }
    }
}

/// What a person can change where the flattener has no step left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    NewVertices,
    Pins,
    Method,
}

impl Change {
    /// The change nearest at hand, once a flattener has come to its end.
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

    /// The button, and what there is to say about it.
    const fn words(self) -> [&'static str; 2] {
        match self {
            Self::NewVertices => [
                "Allow new vertices",
                "The ladder has no step left, and may not cut edges. With new vertices on them it meets nearly all \
                 constraints",
            ],
            Self::Pins => [
                "Free a pin",
                "The ladder has no step left with these pins: free one of them, or move its target. The Pins tab has them",
            ],
            Self::Method => ["Other weights", "The ladder has no step left: choose other weights, or another method"],
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

/// Shows the one button in the accent's colour, where there is something to do.
pub(super) fn advice(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(advice) = Advice::of(editor) else { return };
    let words = advice.words(ui.ctx().content_rect().width() >= ROOMY);
    let theme = theme_of(ui);
    let (button, tip, request) = match advice {
        Advice::Repair => {
            let tip =
                "Take all steps of the ladder, until the embedding is proved planar. Another method gives way to it";
            (accented(words, theme), tip.to_owned(), Request::Do(Action::Repair))
        }
        Advice::Change(change) => {
            let request = change.request(editor.session.document().settings.clone());
            (accented(words, theme), change.words()[1].to_owned(), request)
        }
        Advice::Relax(ratio) => {
            let tip = format!(
                "Areas differ {} : 1 between mesh and embedding, at equal total areas. Relaxing lowers the distortion: \
                 one-to-one throughout, constraints exact",
                ratio_words(ratio)
            );
            (Button::new(words), tip, Request::Do(Action::Relax))
        }
    };
    let tip = tip_with_keys(ui, &tip, &request);
    ui.add(button).on_hover_text(tip).asks(request, requests);
}

/// A button in the accent's colour. There is one at most.
fn accented(words: String, theme: &Theme) -> Button<'static> {
    Button::new(RichText::new(words).color(theme.panel).strong()).fill(theme.accent)
}

/// A large ratio, to two digits, its thousands set apart.
fn ratio_words(ratio: f64) -> String {
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
