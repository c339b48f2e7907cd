//! Actions of the morph between two methods.

use super::morph::MorphView;
use crate::session::{Action, Compared, MorphState};
use crate::ui::editor::Editor;
use crate::ui::state::MorphRequest;
use freebound_core::problem::Variant;

/// Duration of the morph, seconds.
const SECONDS: f64 = 3.0;

impl Editor {
    /// Carries out a request to the morph.
    pub(in crate::ui::editor) fn morph(&mut self, request: MorphRequest) {
        let now = self.gpu.now();
        let between = self.session.morph_between();
        let view = &mut self.plane.comparison.morph;
        match request {
            MorphRequest::Toggle if view.is_shown => self.close_morph(),
            MorphRequest::Toggle => {
                *view = MorphView::shown();
                self.go_on_with_morph();
            }
            MorphRequest::Seek(share) => (view.share, view.playing_since) = (share.clamp(0.0, 1.0), None),
            MorphRequest::Play if view.is_playing() => view.playing_since = None,
            MorphRequest::Play => {
                let from = if view.share >= 1.0 { 0.0 } else { view.share };
                (view.share, view.playing_since) = (from, Some(now - from * SECONDS));
            }
            MorphRequest::From(variant) => self.morph_between(between, [Some(variant), None]),
            MorphRequest::To(variant) => self.morph_between(between, [None, Some(variant)]),
        }
    }

    /// Changes the method at one end. Choosing the method of the other end swaps the two.
    fn morph_between(&mut self, before: Option<[Variant; 2]>, chosen: [Option<Variant>; 2]) {
        let Some([from, to]) = before else { return };
        let between = match chosen {
            [Some(new), _] => [new.clone(), if new == to { from } else { to }],
            [None, Some(new)] => [if new == from { to } else { from }, new],
            [None, None] => return,
        };
        let view = &mut self.plane.comparison.morph;
        (view.share, view.playing_since) = (0.0, None);
        self.session.handle(Action::Morph(Some(between)));
    }

    /// Closes the morph, shows the cells again, and drops the morph in the session.
    pub(in crate::ui::editor) fn close_morph(&mut self) {
        self.plane.comparison.morph = MorphView::default();
        self.session.handle(Action::Morph(None));
    }

    /// Closes the morph. Returns true if it was open.
    pub(in crate::ui::editor) fn leave_morph(&mut self) -> bool {
        let is_shown = self.plane.comparison.morph.is_shown;
        if is_shown {
            self.close_morph();
        }
        is_shown
    }

    /// Chooses the ends if none are chosen or a chosen method has left the comparison, and advances the playback.
    /// Call once per frame.
    pub(in crate::ui::editor) fn go_on_with_morph(&mut self) {
        if !self.plane.comparison.morph.is_shown {
            return;
        }
        let takes_part = |variant: &Variant| self.session.contenders().iter().any(|of| of.variant() == *variant);
        let is_chosen = self.session.morph_between().is_some_and(|between| between.iter().all(takes_part));
        if !is_chosen && !self.session.is_comparing() {
            let between = self.usual_morph();
            if self.session.morph_between() != between {
                self.session.handle(Action::Morph(between));
            }
        }
        let is_there = matches!(self.session.morph(), MorphState::Done(_));
        let now = self.gpu.now();
        let view = &mut self.plane.comparison.morph;
        view.playing_since = view.playing_since.filter(|_| is_there);
        // Free the memory of a morph that no longer exists.
        view.drawn = view.drawn.take().filter(|_| is_there);
        if let Some(since) = view.playing_since {
            view.share = ((now - since) / SECONDS).clamp(0.0, 1.0);
            view.playing_since = view.playing_since.filter(|_| view.share < 1.0);
            self.gpu.context().request_repaint();
        }
    }

    /// Default ends: the document's method, if its map can be an end, and the first method with another map.
    fn usual_morph(&self) -> Option<[Variant; 2]> {
        let ends = self.session.morph_ends();
        let own = Variant::of(&self.session.document().settings);
        let (first, of_first) = ends.iter().find(|(variant, _)| *variant == own).or(ends.first())?;
        let others = || ends.iter().filter(|(variant, _)| variant != first);
        // Methods often share one map, and a morph between equal maps would not move.
        let is_other = |end: &Compared| match (&end.outcome, &of_first.outcome) {
            (Some(end), Some(first)) => {
                end.step.candidate.solution.embedding != first.step.candidate.solution.embedding
            }
            _ => false,
        };
        let (second, _) = others().find(|(_, end)| is_other(end)).or_else(|| others().next())?;
        Some([first.clone(), second.clone()])
    }
}
