//! Layout of the window: tab and panels, widths of the panes, floating windows.

use crate::ui::state::{Help, InsetView, Pane, Tab, Toast, Tour, Welcome};
use crate::ui::theme::{PANEL_WIDTH, PANEL_WIDTHS};

/// Least width of a window that shows the panels by default, points.
const PANELS_FROM: f32 = 820.0;

/// Least share of the width for a pane.
const LEAST_SHARE: f32 = 0.15;

/// Window "Go to", which asks for an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoTo {
    /// Text in its field.
    pub(in crate::ui) text: String,
    /// True if its field takes the keyboard focus in the next frame.
    pub(in crate::ui) takes_keyboard: bool,
}

#[derive(Debug, Default)]
pub struct Layout {
    tab: Tab,
    /// The user's choice to show or hide the panels at the right, if made.
    panels_wanted: Option<bool>,
    is_narrow: bool,
    full: Option<Pane>,
    /// Share of the width for the mesh pane. Default: half.
    split: Option<f32>,
    /// Width of the panels at the right, if the user has changed it, points.
    panel_width: Option<f32>,
    pub keys_shown: bool,
    pub exports_shown: bool,
    /// Window "Go to", if open.
    pub go_to: Option<GoTo>,
    /// Success message that shows.
    pub(in crate::ui) toast: Option<Toast>,
    /// Welcome at a start without a file.
    pub welcome: Welcome,
    /// Guided tour, if under way.
    pub(in crate::ui) tour: Option<Tour>,
    /// Zoom and pan of the insets over the panes.
    pub(in crate::ui) insets: InsetView,
    /// Windows that help.
    pub help: Help,
    /// Menu to open, by its place in the bar.
    pub(in crate::ui) menu_asked: Option<usize>,
}

impl Layout {
    /// Starts the guided tour from its first card.
    pub(crate) fn start_tour(&mut self) {
        self.welcome.close();
        self.tour = Some(Tour::default());
    }

    /// Guided tour, if under way.
    pub fn tour(&self) -> Option<&Tour> {
        self.tour.as_ref()
    }

    pub fn tab(&self) -> Tab {
        self.tab
    }

    /// Opens a tab, and the panels if hidden.
    pub fn show_tab(&mut self, tab: Tab) {
        (self.tab, self.panels_wanted) = (tab, Some(true));
    }

    /// Selects a tab without opening the panels.
    pub(in crate::ui) fn offer_tab(&mut self, tab: Tab) {
        self.tab = tab;
    }

    /// True if the panels at the right show. Default: yes, unless the window is narrow.
    pub fn panels_shown(&self) -> bool {
        self.panels_wanted.unwrap_or(!self.is_narrow)
    }

    pub(in crate::ui) fn shows(&self, tab: Tab) -> bool {
        self.tab == tab && self.panels_shown()
    }

    pub(super) fn toggle_panels(&mut self) {
        self.panels_wanted = Some(!self.panels_shown());
    }

    /// True if the window is too narrow for panels beside the panes.
    pub(in crate::ui) fn is_narrow(&self) -> bool {
        self.is_narrow
    }

    /// Sets the width of panels and panes together, points.
    pub(in crate::ui) fn set_width(&mut self, width: f32) {
        self.is_narrow = width < PANELS_FROM;
    }

    /// Pane in full size, if any.
    pub fn full(&self) -> Option<Pane> {
        self.full
    }

    /// Shows one pane in full size, or both again.
    pub(super) fn toggle_full(&mut self, pane: Pane) {
        self.full = if self.full.is_some() { None } else { Some(pane) };
    }

    /// Shows a pane in full size, or both.
    pub(super) fn show_full(&mut self, pane: Option<Pane>) {
        self.full = pane;
    }

    pub fn mesh_hidden(&self) -> bool {
        self.full == Some(Pane::Plane)
    }

    /// Width of the panels at the right, points.
    pub fn panel_width(&self) -> f32 {
        self.panel_width.unwrap_or(PANEL_WIDTH)
    }

    /// Sets the width of the panels at the right, clamped to [`PANEL_WIDTHS`].
    pub fn set_panel_width(&mut self, width: f32) {
        if width.is_finite() {
            self.panel_width = Some(width.clamp(PANEL_WIDTHS.min, PANEL_WIDTHS.max));
        }
    }

    pub(in crate::ui) fn split(&self) -> f32 {
        self.split.unwrap_or(0.5)
    }

    pub(in crate::ui) fn set_split(&mut self, share: f32) {
        self.split = Some(share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE));
    }

    /// Opens the window "Go to", or focuses its field if it is open.
    pub(super) fn ask_go_to(&mut self) {
        let text = self.go_to.take().map(|open| open.text).unwrap_or_default();
        self.go_to = Some(GoTo { text, takes_keyboard: true });
    }

    /// Closes one of the floating windows. Returns true if one was open.
    pub(super) fn close_window(&mut self) -> bool {
        self.help.close()
            || self.welcome.close()
            || std::mem::take(&mut self.exports_shown)
            || std::mem::take(&mut self.keys_shown)
            || self.go_to.take().is_some()
    }
}
