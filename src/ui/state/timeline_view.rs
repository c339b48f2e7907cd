//! State of the timeline in the window, except for the steps.

/// Height of the row of buttons and steps, points.
pub(in crate::ui) const ROW_HEIGHT: f32 = 34.0;

/// Height of the strip with curves, points.
const STRIP_HEIGHT: f32 = 150.0;

/// Number of curves.
pub(in crate::ui) const CURVE_COUNT: usize = 11;

/// State of the timeline in the window, except for the steps.
#[derive(Clone, Debug, Default)]
pub struct TimelineView {
    /// The user's choice to show or hide the curves, if made. Default: shown, unless the window is low.
    pub curves_wanted: Option<bool>,
    pub window_is_high: bool,
    /// True for each curve that the user has hidden.
    pub curves_hidden: [bool; CURVE_COUNT],
    /// Time at which the step on the screen appeared, while steps are played; seconds of the window's clock.
    pub playing_since: Option<f64>,
    /// Step that was last scrolled to, and the width of the row at that time, points.
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
