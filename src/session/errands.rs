//! Small pieces of work for the document that take time: pictures and constraints to read, faces to turn, an embedding
//! to fit the targets to. Each becomes one edit when it comes back.

use super::edits::Flat;
use super::{Background, Messages, Model, Place, Wake};
use crate::io::{Constraints, ConstraintsError, PictureError, PictureFile};

/// What an errand brings back.
pub(super) enum Errand {
    /// A picture.
    Picture(Result<PictureFile, PictureError>),
    /// Constraints for the open mesh.
    Constraints(Result<Constraints, ConstraintsError>),
    /// The open mesh with its faces turned around.
    Turned(Box<Model>),
    /// The open mesh flattened, to fit the targets to.
    Flat(Flat),
}

/// What an errand is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Picture,
    Constraints,
    Turn,
    Fit,
}

impl Purpose {
    const fn words(self) -> &'static str {
        match self {
            Self::Picture => "reading the picture",
            Self::Constraints => "reading the constraints",
            Self::Turn => "turning the faces",
            Self::Fit => "fitting the targets",
        }
    }
}

/// Errands under way, and those that came back in the middle of a drag, which no other edit may break up.
pub(super) struct Errands {
    under_way: Background<Purpose, Errand>,
    arrived: Vec<Errand>,
}

impl Errands {
    /// Nothing is under way.
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("errand", wake), arrived: Vec::new() }
    }

    /// Whether something is under way.
    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_busy()
    }

    /// Whether something is under way for a purpose.
    pub(super) fn is_under_way(&self, purpose: Purpose) -> bool {
        self.under_way.keys().any(|of| *of == purpose)
    }

    /// Sends an errand.
    pub(super) fn send(
        &mut self,
        purpose: Purpose,
        work: impl FnOnce(&std::sync::atomic::AtomicBool) -> Errand + Send + 'static,
    ) {
        self.under_way.add(purpose, work);
    }

    /// Drops all errands: they were for another mesh, or nobody wants them any more.
    pub(super) fn forget(&mut self) {
        self.under_way.cancel();
        self.arrived.clear();
    }

    /// The next errand that came back. In a gesture only turned faces are let through, which are no edit.
    pub(super) fn poll(&mut self, is_in_gesture: bool, messages: &mut Messages) -> Option<Errand> {
        while let Some((purpose, errand)) = self.under_way.poll() {
            match errand {
                Ok(turned @ Errand::Turned(_)) => return Some(turned),
                Ok(errand) => self.arrived.push(errand),
                Err(failure) => messages.fail_background(Place::Embedding, purpose.words(), &failure),
            }
        }
        if is_in_gesture || self.arrived.is_empty() { None } else { Some(self.arrived.remove(0)) }
    }
}
