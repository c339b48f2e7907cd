//! Small pieces of work for the document that take time: pictures and constraints to read, faces to turn, an embedding
//! to fit the targets to. Each becomes one edit when it comes back.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use super::edits::Flat;
use super::seams::Recut;
use super::{Background, Messages, Model, Place, Wake};
use crate::io::{Constraints, ConstraintsError, EdgesError, PictureError, PictureFile};
use crate::mesh::{VertexId, WeldDistance};

/// What an errand brings back.
pub(super) enum Errand {
    Picture(Result<PictureFile, PictureError>),
    /// Constraints for the open mesh, from a file.
    Constraints {
        path: PathBuf,
        read: Result<Constraints, ConstraintsError>,
    },
    /// Seams for the open mesh, from a file.
    Seams(Result<Vec<[VertexId; 2]>, EdgesError>),
    /// The open mesh, cut along other seams.
    Recut(Box<Recut>),
    /// So many vertices of the open mesh lie within a distance of another.
    Near {
        distance: WeldDistance,
        count: usize,
    },
    /// The open mesh in another form.
    Formed(Box<Model>),
    /// The open mesh flattened, to fit the targets to.
    Flat(Flat),
}

/// Errands under way, and those that came back in the middle of a drag, which no other edit may break up.
pub(super) struct Errands {
    /// By what they do, in words.
    under_way: Background<&'static str, Errand>,
    arrived: Vec<Errand>,
}

impl Errands {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("errand", wake), arrived: Vec::new() }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_busy()
    }

    /// Whether an errand that does this is under way.
    pub(super) fn is_under_way(&self, what: &str) -> bool {
        self.under_way.keys().any(|of| *of == what)
    }

    /// Sends an errand. `what` it does goes on as "… stopped unexpectedly" where it fails.
    pub(super) fn send(&mut self, what: &'static str, work: impl FnOnce(&AtomicBool) -> Errand + Send + 'static) {
        self.under_way.add(what, work);
    }

    /// Drops all errands: they were for another mesh, or nobody wants them any more.
    pub(super) fn forget(&mut self) {
        self.under_way.cancel();
        self.arrived.clear();
    }

    /// The next errand that came back. In a gesture only a mesh in another form is let through, which is no edit.
    pub(super) fn poll(&mut self, is_in_gesture: bool, messages: &mut Messages) -> Option<Errand> {
        while let Some((what, errand)) = self.under_way.poll() {
            match errand {
                Ok(formed @ Errand::Formed(_)) => return Some(formed),
                Ok(errand) => self.arrived.push(errand),
                Err(failure) => messages.fail_background(Place::Embedding, what, &failure),
            }
        }
        if is_in_gesture || self.arrived.is_empty() { None } else { Some(self.arrived.remove(0)) }
    }
}
