//! Small pieces of work for the document that take time: pictures and constraints to read, faces to turn, an embedding
//! to fit the targets to. Each becomes one edit when it comes back.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use super::reshaping::Reshaped;
use super::{Background, JobFailure, Model, Wake};
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::{Preparation, VertexId, WeldDistance};
use freebound_core::problem::{Embedding, SolveError};
use freebound_io::{Constraints, ConstraintsError, EdgesError, PictureError, PictureFile};

/// The job that brings the mesh into another form, or takes a chart out of it.
pub(super) const FORMING: &str = "turning or mending the faces";

/// The job that forms the mesh for an edit of its form.
pub(super) const RESHAPING: &str = "cutting or mending the mesh";

/// The mesh flattened without pins, upright in the middle of the picture.
pub(super) struct Flat {
    /// The picture's frame.
    pub(super) frame: PictureFrame,
    /// The form that the mesh had, and the chart that it was.
    pub(super) form: Preparation,
    pub(super) chart: Option<usize>,
    pub(super) embedding: Result<Embedding, SolveError>,
}

/// What a job brings back.
pub(super) enum BackgroundJob {
    Picture(Result<PictureFile, PictureError>),
    /// Constraints for the open mesh, from a file.
    Constraints {
        path: PathBuf,
        read: Result<Constraints, ConstraintsError>,
    },
    /// Seams for the open mesh, from a file.
    Seams(Result<Vec<[VertexId; 2]>, EdgesError>),
    /// The open mesh in another form, for an edit of it.
    Reshaped(Box<Reshaped>),
    /// So many vertices of the open mesh lie within a distance of another.
    Near {
        distance: WeldDistance,
        count: usize,
    },
    /// The open mesh in the form that the document has.
    Formed(Box<Model>),
    /// The open mesh flattened, to fit the targets to.
    Flat(Flat),
}

/// Jobs under way, and those that came back while no edit may be made: in the middle of a drag, and while the mesh is brought
/// into its form.
pub(super) struct BackgroundJobs {
    /// By what they do, in words.
    under_way: Background<&'static str, BackgroundJob>,
    arrived: VecDeque<(&'static str, BackgroundJob)>,
    /// Whether a person has stopped the work since the mesh is being formed.
    is_stopped: bool,
}

impl BackgroundJobs {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("job", wake), arrived: VecDeque::new(), is_stopped: false }
    }

    /// What the oldest job does that is under way.
    pub(super) fn words(&self) -> Option<&'static str> {
        self.under_way.key().copied()
    }

    /// Whether a job that does this is under way, or waits to be taken in.
    pub(super) fn is_under_way(&self, what: &str) -> bool {
        let arrived = self.arrived.iter().map(|(of, _)| of);
        self.under_way.keys().chain(arrived).any(|of| *of == what)
    }

    /// Sends a job. `what` it does goes on as "… stopped unexpectedly" where it fails.
    pub(super) fn send(
        &mut self,
        what: &'static str,
        work: impl FnOnce(&AtomicBool) -> BackgroundJob + Send + 'static,
    ) {
        self.under_way.add(what, work);
    }

    /// Drops all jobs: they were for another mesh.
    pub(super) fn forget(&mut self) {
        self.under_way.cancel();
        self.arrived.clear();
    }

    /// Drops the jobs that nobody wants any more. The mesh is still brought into the form that the document has.
    pub(super) fn stop(&mut self) {
        self.under_way.cancel_but(|what| *what == FORMING);
        self.arrived.clear();
        self.is_stopped = true;
    }

    /// Notes that a solve is wanted once the mesh has its form.
    pub(super) fn go_on(&mut self) {
        self.is_stopped = false;
    }

    /// Whether nothing is to be solved once the mesh has its form.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped
    }

    /// The next job that came back, or failed, with what it does: of those that do the same, in the order in which they were sent.
    /// While they are held back only a mesh in its form is let through, which is no edit.
    pub(super) fn poll(&mut self, is_held: bool) -> Option<(&'static str, Result<BackgroundJob, JobFailure>)> {
        while let Some((what, job)) = self.under_way.poll_in_order() {
            match job {
                Ok(job) if what != FORMING => self.arrived.push_back((what, job)),
                formed_or_failed => return Some((what, formed_or_failed)),
            }
        }
        let next = if is_held { None } else { self.arrived.pop_front() };
        next.map(|(what, job)| (what, Ok(job)))
    }
}
