//! Check of every writer: coordinates must be finite.

use std::io;

use glam::DVec2;

use super::WriteError;

/// Coordinate that is infinite or not a number.
#[derive(Debug, thiserror::Error)]
#[error("coordinates {place} are ({}, {}): beyond the range of 64-bit numbers", at.x, at.y)]
struct NotFinite {
    place: usize,
    at: DVec2,
}

/// Accepts finite coordinates only.
///
/// # Errors
///
/// The first coordinate that is not finite, by its index in the list; [`WriteError::is_not_finite`] recognises this
/// error.
pub(super) fn check_finite<'a>(coordinates: impl IntoIterator<Item = &'a DVec2>) -> io::Result<()> {
    match coordinates.into_iter().enumerate().find(|(_, at)| !at.is_finite()) {
        Some((place, &at)) => Err(io::Error::new(io::ErrorKind::InvalidData, NotFinite { place, at })),
        None => Ok(()),
    }
}

impl WriteError {
    /// True if nothing was written because coordinates are infinite or not numbers.
    pub fn is_not_finite(&self) -> bool {
        matches!(self.source.get_ref(), Some(inner) if inner.is::<NotFinite>())
    }
}
