//! The door of every writer: numbers that are infinite, or none at all, do not pass.

use std::io;

use glam::DVec2;

use super::WriteError;

/// A coordinate that 64-bit numbers cannot hold.
#[derive(Debug, thiserror::Error)]
#[error("coordinates {place} are ({}, {}): beyond the range of 64-bit numbers", at.x, at.y)]
struct NotFinite {
    place: usize,
    at: DVec2,
}

/// Lets finite coordinates pass.
///
/// # Errors
///
/// The first that are not, by their place in the list; [`WriteError::is_not_finite`] knows it again.
pub(super) fn check_finite<'a>(coordinates: impl IntoIterator<Item = &'a DVec2>) -> io::Result<()> {
    match coordinates.into_iter().enumerate().find(|(_, at)| !at.is_finite()) {
        Some((place, &at)) => Err(io::Error::new(io::ErrorKind::InvalidData, NotFinite { place, at })),
        None => Ok(()),
    }
}

impl WriteError {
    /// Whether nothing was written because coordinates are infinite or not numbers.
    pub fn is_not_finite(&self) -> bool {
        matches!(self.source.get_ref(), Some(inner) if inner.is::<NotFinite>())
    }
}
