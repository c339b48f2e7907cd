//! The welcome at a start without a file.

/// State of the welcome.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Welcome {
    is_shown: bool,
    /// Opening over which the welcome shows. Another one closes it.
    opening: Option<u64>,
    /// True if the welcome shows at a start without a file.
    pub(in crate::ui) at_start: bool,
}

impl Default for Welcome {
    fn default() -> Self {
        Self { is_shown: false, opening: None, at_start: true }
    }
}

impl Welcome {
    /// True if the welcome is open.
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Shows the welcome at the start of the program, unless the user has turned that off.
    pub(crate) fn greet(&mut self) {
        self.is_shown = self.at_start;
    }

    /// Opens or closes the welcome.
    pub(in crate::ui) fn toggle(&mut self) {
        (self.is_shown, self.opening) = (!self.is_shown, None);
    }

    /// Closes the welcome. Returns true if it was open.
    pub(in crate::ui) fn close(&mut self) -> bool {
        std::mem::take(&mut self.is_shown)
    }

    /// True if the welcome shows over an opening, if there is one. Another opening closes it.
    pub(in crate::ui) fn is_shown_at(&mut self, opening: Option<u64>) -> bool {
        if let Some(now) = opening {
            self.is_shown &= *self.opening.get_or_insert(now) == now;
        }
        self.is_shown
    }
}
