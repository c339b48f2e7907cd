//! Success message that shows.

/// Success message that shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct Toast {
    /// Number of the message.
    pub(in crate::ui) id: u64,
    /// Start of its display, or the last time it had pointer or focus; seconds of the window's clock.
    pub(in crate::ui) since: f64,
}
