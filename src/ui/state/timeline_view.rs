//! State of the timeline in the window, except for the steps.

use freebound_io::figure::AxisScale;

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
    /// Scale of each curve, if the user has chosen one.
    pub curve_scales: [Option<AxisScale>; CURVE_COUNT],
    /// Place of the curve that shows enlarged.
    pub curve_enlarged: Option<usize>,
    /// Time at which the step on the screen appeared, while steps are played; seconds of the window's clock.
    pub playing_since: Option<f64>,
    /// Step that was last scrolled to, and the width of the row at that time, points.
    pub(in crate::ui) scrolled_to: Option<(usize, f32)>,
}

/// Requests to the curves of the steps. Curves are numbered in the order of their menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveRequest {
    /// Shows a curve enlarged.
    Enlarge(usize),
    /// Closes the enlarged curve.
    Close,
    /// Sets the scale of a curve.
    SetScale(usize, AxisScale),
}

/// Exports of the curves of the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvesExport {
    /// All curves as a table.
    Table,
    /// Curves with numbers as a drawing.
    Svg,
    /// Curves with numbers as a document.
    Pdf,
}

impl CurvesExport {
    /// All exports, in menu order.
    pub const ALL: [Self; 3] = [Self::Table, Self::Svg, Self::Pdf];

    /// Menu entry and description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Table => ["Curves as a table…", "CSV: all curves with all digits, a row for each step"],
            Self::Svg => ["Curves as a drawing…", "SVG: the shown curves with axes, for a paper"],
            Self::Pdf => ["Curves as a document…", "PDF: the shown curves with axes, for a paper"],
        }
    }
}

impl TimelineView {
    pub fn curves_shown(&self) -> bool {
        self.curves_wanted.unwrap_or(self.window_is_high)
    }

    pub(in crate::ui) fn height(&self) -> f32 {
        if self.curves_shown() { STRIP_HEIGHT } else { ROW_HEIGHT }
    }

    pub(in crate::ui) fn handle(&mut self, request: CurveRequest) {
        match request {
            CurveRequest::Enlarge(place) => self.curve_enlarged = Some(place).filter(|&place| place < CURVE_COUNT),
            CurveRequest::Close => self.curve_enlarged = None,
            CurveRequest::SetScale(place, scale) => {
                if let Some(chosen) = self.curve_scales.get_mut(place) {
                    *chosen = Some(scale);
                }
            }
        }
    }

    /// Closes the enlarged curve. Returns true if one was open.
    pub(in crate::ui) fn close_curve(&mut self) -> bool {
        self.curve_enlarged.take().is_some()
    }
}
