//! Short background jobs for the document: reading pictures and constraints, preparing the mesh, flattening it to fit
//! the targets. Each result becomes one edit.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::carried_pins::{CarriedPins, CarryError};
use super::layout_of_other::{LayoutOfOther, LayoutOfOtherError};
use super::reshaping::Reshaped;
use super::{Background, JobFailure, Model, Wake};
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::{Preparation, VertexId, WeldDistance};
use freebound_core::problem::{Embedding, SolveError};
use freebound_io::{Constraints, ConstraintsError, EdgesError, PictureError, PictureFile, PictureLandmark, PtsError};

/// Name of the job that prepares the mesh as the document wants it, or extracts a chart.
pub(super) const FORMING: &str = "reversing or repairing the faces";

/// Name of the job that prepares the mesh for an edit of its preparation.
pub(super) const RESHAPING: &str = "cutting or repairing the mesh";

/// Mesh flattened without pins, upright in the middle of the picture.
pub(super) struct Flat {
    /// Frame of the picture.
    pub(super) frame: PictureFrame,
    /// Preparation of the mesh, and the number of its chart.
    pub(super) form: Preparation,
    pub(super) chart: Option<usize>,
    /// Flat mesh, or the error with the numbers of files.
    pub(super) embedding: Result<Embedding, SolveError>,
}

/// Result of a job.
pub(super) enum BackgroundJob {
    /// Picture for the open mesh, read from a file.
    Picture { path: PathBuf, read: Result<PictureFile, PictureError> },
    /// Constraints for the open mesh, read from a file.
    Constraints { path: PathBuf, read: Result<Constraints, ConstraintsError> },
    /// Landmarks of the picture in pixels, read from a file.
    Landmarks { path: PathBuf, read: Result<Vec<PictureLandmark>, PtsError> },
    /// Constraints of a project, carried to a mesh.
    Carried { path: PathBuf, mesh: Arc<Model>, read: Result<CarriedPins, CarryError> },
    /// Seams for the open mesh, read from a file.
    Seams(Result<Vec<[VertexId; 2]>, EdgesError>),
    /// Layout of another mesh file on the open mesh.
    LayoutOfOther { path: PathBuf, read: Result<Box<LayoutOfOther>, LayoutOfOtherError> },
    /// Open mesh in another preparation, for an edit.
    Reshaped(Box<Reshaped>),
    /// Number of vertices of the open mesh within a distance of another vertex.
    Near { distance: WeldDistance, count: usize },
    /// Open mesh in the preparation of the document.
    Formed(Box<Model>),
    /// Open mesh, flattened to fit the targets to it.
    Flat(Flat),
}

/// Jobs in progress, and finished jobs that have to wait because no edit is allowed: during a drag, and while the mesh
/// is being prepared.
pub(super) struct BackgroundJobs {
    /// Running jobs. The key is a description of the job.
    under_way: Background<&'static str, BackgroundJob>,
    arrived: VecDeque<(&'static str, BackgroundJob)>,
    /// True if the user stopped the work after the preparation of the mesh began.
    is_stopped: bool,
}

impl BackgroundJobs {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("job", wake), arrived: VecDeque::new(), is_stopped: false }
    }

    /// Description of the oldest running job.
    pub(super) fn words(&self) -> Option<&'static str> {
        self.under_way.key().copied()
    }

    /// True if a job with this description is running or its result waits.
    pub(super) fn is_under_way(&self, what: &str) -> bool {
        let arrived = self.arrived.iter().map(|(of, _)| of);
        self.under_way.keys().chain(arrived).any(|of| *of == what)
    }

    /// Starts a job. `what` describes it and completes the message "… stopped unexpectedly".
    pub(super) fn send(
        &mut self,
        what: &'static str,
        work: impl FnOnce(&AtomicBool) -> BackgroundJob + Send + 'static,
    ) {
        self.under_way.add(what, work);
    }

    /// Drops all jobs, because another mesh is open.
    pub(super) fn forget(&mut self) {
        self.under_way.cancel();
        self.arrived.clear();
    }

    /// Drops all jobs except [`FORMING`], so that the mesh still gets the preparation of the document.
    pub(super) fn stop(&mut self) {
        self.under_way.cancel_but(|what| *what == FORMING);
        // The preparation itself still arrives; only the map along its seams is given up.
        self.under_way.interrupt();
        self.arrived.clear();
        self.is_stopped = true;
    }

    /// Notes that a solve follows once the mesh is prepared.
    pub(super) fn go_on(&mut self) {
        self.is_stopped = false;
    }

    /// True if no solve follows once the mesh is prepared.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped
    }

    /// Returns the next result or failure, with the description of its job. Jobs with equal descriptions return in the
    /// order in which they were sent. If `is_held`, only failures and results of [`FORMING`] are returned, which are no
    /// edits.
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
