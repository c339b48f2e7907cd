//! State of the windows that help: command palette, list of keys, messages of this run, and About.

use eframe::egui::KeyboardShortcut;

/// Greatest number of recent commands.
const MOST_RECENT: usize = 8;

/// Command palette that is open.
#[derive(Clone, Debug, Default)]
pub(in crate::ui) struct Palette {
    pub(in crate::ui) query: String,
    /// Row of the selected command.
    pub(in crate::ui) row: usize,
    /// True once its field has the focus.
    pub(in crate::ui) has_focus: bool,
}

/// Change of keys that another binding has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) struct KeyClash {
    /// Binding to be changed, by its place in the table.
    pub(in crate::ui) place: usize,
    pub(in crate::ui) shortcut: KeyboardShortcut,
    /// Binding that has the keys.
    pub(in crate::ui) owner: usize,
}

/// State of the list of keys.
#[derive(Clone, Debug, Default)]
pub(in crate::ui) struct KeyList {
    pub(in crate::ui) query: String,
    /// True once its field has the focus.
    pub(in crate::ui) has_focus: bool,
    /// Binding that the next press changes, by its place in the table.
    pub(in crate::ui) listens_for: Option<usize>,
    pub(in crate::ui) clash: Option<KeyClash>,
}

/// Windows that help.
#[derive(Clone, Debug, Default)]
pub struct Help {
    pub(in crate::ui) palette: Option<Palette>,
    /// Names of the commands chosen last in the palette, newest first.
    pub(in crate::ui) recent: Vec<String>,
    pub(in crate::ui) keys: KeyList,
    pub(in crate::ui) log_shown: bool,
    pub(in crate::ui) about_shown: bool,
}

impl Help {
    /// True if the command palette is open.
    pub fn has_palette(&self) -> bool {
        self.palette.is_some()
    }

    /// Opens the command palette, or closes it.
    pub(in crate::ui) fn toggle_palette(&mut self) {
        self.palette = if self.palette.is_some() { None } else { Some(Palette::default()) };
    }

    /// Puts a command first among the recent ones.
    pub(in crate::ui) fn remember(&mut self, id: String) {
        self.recent.retain(|other| *other != id);
        self.recent.insert(0, id);
        self.recent.truncate(MOST_RECENT);
    }

    /// Closes one window. Returns true if one was open.
    pub(in crate::ui) fn close(&mut self) -> bool {
        self.palette.take().is_some() || std::mem::take(&mut self.log_shown) || std::mem::take(&mut self.about_shown)
    }
}
