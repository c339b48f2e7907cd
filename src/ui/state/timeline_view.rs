//! The timeline as the window has it, beyond the steps themselves.

/// Height of the strip's buttons and steps, points.
pub(in crate::ui) const ROW_HEIGHT: f32 = 34.0;

/// Height of the whole strip, points.
const STRIP_HEIGHT: f32 = 150.0;

/// Number of curves.
pub(in crate::ui) const CURVE_COUNT: usize = 11;

/// State of the timeline in the window, beyond the steps themselves.
#[derive(Clone, Debug, Default)]
pub struct TimelineView {
    /// True if the curves show; where nobody said, a low window does without.
    pub curves_wanted: Option<bool>,
    pub window_is_high: bool,
    /// The curves that a person has put away, by place.
    pub curves_hidden: [bool; CURVE_COUNT],
    /// When the step on the screen was put there, while the steps are played; seconds of the window's clock.
    pub playing_since: Option<f64>,
    /// The step that was scrolled to last, and in how wide a row, points.
    pub(in crate::ui) scrolled_to: Option<(usize, f32)>,
}

impl TimelineView {
    pub fn curves_shown(&self) -> bool {
        self.curves_wanted.unwrap_or(self.window_is_high)
    }

    pub(in crate::ui) fn height(&self) -> f32 {
        if self.curves_shown() { STRIP_HEIGHT } else { ROW_HEIGHT }
    }
}
