//! What of the window is open: tab and panels, the panes' widths, floating windows.

use crate::ui::state::{InsetView, Pane, Tab, Toast};
use crate::ui::theme::{PANEL_WIDTH, PANEL_WIDTHS};

/// A window narrower than this shows no panels until they are asked for, points.
const PANELS_FROM: f32 = 820.0;

/// Least share of the width that a pane has.
const LEAST_SHARE: f32 = 0.15;

/// The window that asks for an element to go to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoTo {
    /// What is typed into it.
    pub(in crate::ui) text: String,
    /// Whether its field is to take the keyboard in the next frame.
    pub(in crate::ui) takes_keyboard: bool,
}

#[derive(Clone, Debug, Default)]
pub struct Layout {
    tab: Tab,
    /// Whether the panels at the right show, where a person said so.
    panels_wanted: Option<bool>,
    is_narrow: bool,
    full: Option<Pane>,
    /// Share of the width that the mesh's pane has; half of it where nobody said.
    split: Option<f32>,
    /// Width of the panels at the right, where a person has changed it, points.
    panel_width: Option<f32>,
    pub keys_shown: bool,
    pub exports_shown: bool,
    /// "Go to", where it shows.
    pub go_to: Option<GoTo>,
    /// The good news that show.
    pub(in crate::ui) toast: Option<Toast>,
    /// What the insets over the panes show, and how near.
    pub(in crate::ui) insets: InsetView,
    /// The menu that is to open, by its place in the bar.
    pub(in crate::ui) menu_asked: Option<usize>,
}

impl Layout {
    pub fn tab(&self) -> Tab {
        self.tab
    }

    /// Opens a tab, and the panels with it.
    pub fn show_tab(&mut self, tab: Tab) {
        (self.tab, self.panels_wanted) = (tab, Some(true));
    }

    /// Has a tab come first where the panels show, or once they do.
    pub(in crate::ui) fn offer_tab(&mut self, tab: Tab) {
        self.tab = tab;
    }

    /// Whether the panels at the right show. Where nobody said, a narrow window does without.
    pub fn panels_shown(&self) -> bool {
        self.panels_wanted.unwrap_or(!self.is_narrow)
    }

    pub(in crate::ui) fn shows(&self, tab: Tab) -> bool {
        self.tab == tab && self.panels_shown()
    }

    pub(super) fn toggle_panels(&mut self) {
        self.panels_wanted = Some(!self.panels_shown());
    }

    /// Whether the window is too narrow for panels beside the panes.
    pub(in crate::ui) fn is_narrow(&self) -> bool {
        self.is_narrow
    }

    /// Takes the width that panels and panes have together, points.
    pub(in crate::ui) fn set_width(&mut self, width: f32) {
        self.is_narrow = width < PANELS_FROM;
    }

    /// The pane in full size, if one is.
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

    /// Takes in how wide the panels at the right are.
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

    /// Opens "go to", or gives its field the keyboard where it is open.
    pub(super) fn ask_go_to(&mut self) {
        let text = self.go_to.take().map(|open| open.text).unwrap_or_default();
        self.go_to = Some(GoTo { text, takes_keyboard: true });
    }

    /// Closes one of the floating windows. Returns whether one was open.
    pub(super) fn close_window(&mut self) -> bool {
        std::mem::take(&mut self.exports_shown) || std::mem::take(&mut self.keys_shown) || self.go_to.take().is_some()
    }
}
