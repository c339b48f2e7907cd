//! The editor's way through the steps of a run.

use crate::session::Action;
use crate::ui::{Editor, StepTarget};

/// Playing all steps takes about so long, seconds.
const PLAY_SECONDS: f64 = 6.0;

/// How long one step shows while they are played, at least and at most, seconds.
const STEP_SECONDS: (f64, f64) = (0.1, 0.8);

impl Editor {
    /// Whether the open mesh can be solved. If so, the strip under the panes shows, so that the panes have their final
    /// size before the first step is there.
    pub fn has_disk(&self) -> bool {
        self.session.model().is_some_and(|model| model.disk().is_some())
    }

    /// Whether steps are kept before and after the one on the screen.
    pub(in crate::ui) fn steps_around(&self) -> [bool; 2] {
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return [false; 2] };
        [timeline.previous_kept(shown).is_some(), timeline.next_kept(shown).is_some()]
    }

    pub(super) fn go_to_step(&mut self, target: StepTarget) {
        self.timeline.playing_since = None;
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return };
        let wanted = match target {
            StepTarget::First => Some(0),
            StepTarget::Previous => timeline.previous_kept(shown),
            StepTarget::Next => timeline.next_kept(shown),
            StepTarget::Last => timeline.newest(),
        };
        if let Some(index) = wanted {
            self.session.handle(Action::ShowStep(index));
        }
    }

    pub(super) fn run_or_pause(&mut self) {
        self.timeline.playing_since = None;
        self.session.handle(if self.session.is_running() { Action::Cancel } else { Action::Run });
    }

    /// Plays the steps from the one on the screen, or from the first where it is the last; or stops playing.
    pub(super) fn toggle_play(&mut self) {
        let timeline = self.session.timeline();
        let Some(shown) = timeline.shown() else { return };
        if self.timeline.playing_since.take().is_some() {
            return;
        }
        if timeline.next_kept(shown).is_none() {
            self.session.handle(Action::ShowStep(0));
        }
        self.timeline.playing_since = Some(self.host.now());
    }

    /// Shows the next step when it is time. Call once per frame.
    pub(super) fn go_on_playing(&mut self) {
        let Some(since) = self.timeline.playing_since else { return };
        let now = self.host.now();
        let timeline = self.session.timeline();
        let Some(next) = timeline.shown().and_then(|shown| timeline.next_kept(shown)) else {
            self.timeline.playing_since = None;
            return;
        };
        let gaps = timeline.kept().count().max(2) - 1;
        let pace = (PLAY_SECONDS / gaps as f64).clamp(STEP_SECONDS.0, STEP_SECONDS.1);
        if now - since >= pace {
            self.session.handle(Action::ShowStep(next));
            self.timeline.playing_since = Some(now);
        }
        self.host.context().request_repaint();
    }
}
