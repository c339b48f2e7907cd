//! The good news that shows.

/// The news that shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct Toast {
    /// The message's number.
    pub(in crate::ui) id: u64,
    /// When it came, or when pointer and keyboard left it; seconds of the window's clock.
    pub(in crate::ui) since: f64,
}
