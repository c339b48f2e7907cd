//! A pin that follows the pointer.
//!
//! The first solve is complex-linear in the targets: z = Φ t. Moving pins by δ adds δ times their columns of Φ, one
//! multiply-add a vertex, at any size. So when a drag begins, the embedding and the column of what is dragged are solved
//! for once, in the background; from then on every move shows at once. The exact verdict on it lags behind, and says so.
//!
//! ```text
//! first move ──▶ job: base, column ──▶ Follow
//! every move ──▶ base + δ · column ──▶ Preview ──▶ job: verdict
//! rest, end  ──▶ run of the document; its first step takes the preview's place
//! ```

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::{Document, Job, JobContext, Poll, Session};
use crate::mesh::VertexId;
use crate::solver::{Control, Embedding, Prepared, SolveError, Verdict, are_held_alike, verdict};

/// Pins moved together may differ in their way by this share of it: rounding of the pointer's place.
const SAME_WAY: f64 = 1e-9;

/// The embedding of the first solve while pins are dragged.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Where vertices lie, in the plane.
    pub embedding: Arc<Embedding>,
    /// Counts the moves of this session, so that a screen can tell when to draw anew.
    pub revision: u64,
    /// The newest verdict that there is, with the revision that it is on.
    pub checked: Option<(u64, Arc<Verdict>)>,
}

impl Preview {
    /// The verdict on this very embedding, once it is there.
    pub fn verdict(&self) -> Option<&Arc<Verdict>> {
        self.checked.as_ref().filter(|(revision, _)| *revision == self.revision).map(|(_, verdict)| verdict)
    }
}

/// What is solved for once, for all moves of a drag.
pub(super) struct Follow {
    /// The document when it was solved for.
    document: Document,
    /// The pins that are dragged, ascending.
    dragged: Vec<VertexId>,
    prepared: Arc<Prepared>,
    base: Embedding,
    column: Vec<DVec2>,
}

pub(super) type FollowJob = Job<(), Result<Follow, SolveError>>;
pub(super) type VerdictJob = Job<(), Verdict>;

impl Follow {
    /// Whether it serves a drag of these pins in this document: only their targets differ.
    fn serves(&self, document: &Document, dragged: &[VertexId]) -> bool {
        let others_stay = document.targets.iter().all(|(vertex, target)| {
            dragged.binary_search(vertex).is_ok()
                || self.document.targets.get(vertex).is_some_and(|before| before.uv == target.uv)
        });
        self.dragged == dragged && others_stay && are_alike(&self.document, document)
    }

    /// The embedding of the document's first solve; none where the dragged pins did not all go the same way.
    fn embedding(&self, document: &Document) -> Option<Embedding> {
        let (from, to) = (self.document.pins(), document.pins());
        let way = |vertex: &VertexId| Some(to.get(vertex)?.target - from.get(vertex)?.target);
        let by = way(self.dragged.first()?)?;
        let goes_along = |vertex: &VertexId| way(vertex).is_some_and(|w| w.distance(by) <= SAME_WAY * by.length());
        if !self.dragged.iter().all(goes_along) {
            return None;
        }
        let place = |(base, column): (&DVec2, &DVec2)| *base + by.rotate(*column);
        let mut embedding: Embedding = self.base.par_iter().zip(&self.column).map(place).collect::<Vec<_>>().into();
        for (vertex, pin) in to.iter().filter(|(_, pin)| document.settings.is_exact(pin.hold)) {
            embedding[*vertex] = pin.target;
        }
        Some(embedding)
    }
}

/// Whether two documents differ in their pins' targets alone.
fn are_alike(a: &Document, b: &Document) -> bool {
    a.run_settings() == b.run_settings()
        && a.frame() == b.frame()
        && a.faces_turned == b.faces_turned
        && are_held_alike(&a.pins(), &b.pins())
}

impl Session {
    /// What the screen shows while pins are dragged.
    pub fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref()
    }

    /// Lets the embedding follow pins that were moved. Whatever is being solved is given up.
    pub(super) fn follow(&mut self, moves: &[(VertexId, DVec2)]) {
        let mut dragged: Vec<VertexId> = moves.iter().map(|(vertex, _)| *vertex).collect();
        dragged.sort_unstable();
        dragged.dedup();
        (self.running, self.solve_again) = (None, false);
        let served = self.follow.as_ref().is_some_and(|follow| follow.serves(&self.document, &dragged));
        if !(served && self.show_preview()) {
            self.begin_to_follow(dragged);
        }
    }

    /// Solves for base and column in the background, unless that is under way for the same drag.
    fn begin_to_follow(&mut self, dragged: Vec<VertexId>) {
        if !self.bring_faces() {
            // A solve follows once the mesh is turned around.
            return;
        }
        if let Some((document, under_way, _)) = &self.follow_job
            && *under_way == dragged
            && are_alike(document, &self.document)
        {
            return;
        }
        let Some(disk) = self.model.as_ref().and_then(|model| model.disk()).map(Arc::clone) else { return };
        let (document, at_hand) = (self.document.clone(), self.kept.prepared.clone());
        let (asked, vertices) = (document.clone(), dragged.clone());
        let work = move |context: &JobContext<()>| {
            let quiet = |_| {};
            let control = Control::new(context.cancel_flag(), &quiet);
            let (settings, pins) = (document.run_settings(), document.pins());
            let prepared = match at_hand.filter(|prepared| prepared.serves(&settings, &pins)) {
                Some(prepared) => prepared,
                None => Arc::new(Prepared::new(&disk, &settings, &pins, control)?),
            };
            let base = prepared.solve(&disk, &pins, control)?.embedding;
            let column = prepared.column(&disk, &dragged)?;
            Ok(Follow { document, dragged, prepared, base, column })
        };
        self.follow_job = Job::spawn("follow", self.waker(), work).ok().map(|job| (asked, vertices, job));
    }

    pub(super) fn poll_following(&mut self) {
        if let Some((_, _, job)) = &self.follow_job {
            match job.poll() {
                Poll::Running => {}
                Poll::Lost | Poll::Done(Err(_)) => {
                    // The run at the end of the drag says what is wrong.
                    self.follow_job = None;
                }
                Poll::Done(Ok(follow)) => {
                    self.follow_job = None;
                    self.take_follow(follow);
                }
            }
        }
        self.poll_verdict();
    }

    fn take_follow(&mut self, follow: Follow) {
        if !are_alike(&follow.document, &self.document) {
            return;
        }
        self.kept.prepared = Some(Arc::clone(&follow.prepared));
        let dragged = follow.dragged.clone();
        let serves = follow.serves(&self.document, &dragged);
        self.follow = Some(follow);
        let is_wanted = self.history.is_in_gesture() && self.running.is_none() && !self.is_current();
        if is_wanted && !(serves && self.show_preview()) {
            // The pins went on in another way meanwhile.
            self.follow = None;
            self.begin_to_follow(dragged);
        }
    }

    /// Shows the embedding of the document's first solve. Returns whether the column at hand gives it.
    fn show_preview(&mut self) -> bool {
        let embedding = self.follow.as_ref().and_then(|follow| follow.embedding(&self.document));
        let Some(embedding) = embedding else { return false };
        self.preview_revision += 1;
        let checked = self.preview.take().and_then(|before| before.checked);
        self.preview = Some(Preview { embedding: Arc::new(embedding), revision: self.preview_revision, checked });
        self.check_preview();
        true
    }

    /// Proves the newest preview in the background, one at a time.
    fn check_preview(&mut self) {
        let Some(preview) = self.preview.as_ref().filter(|preview| preview.verdict().is_none()) else { return };
        let Some(disk) = self.model.as_ref().and_then(|model| model.disk()).map(Arc::clone) else { return };
        if self.verdict_job.is_some() {
            return;
        }
        let (embedding, revision) = (Arc::clone(&preview.embedding), preview.revision);
        let work = move |_: &JobContext<()>| verdict(&disk, &embedding);
        self.verdict_job = Job::spawn("verdict", self.waker(), work).ok().map(|job| (revision, job));
    }

    fn poll_verdict(&mut self) {
        let Some((revision, job)) = &self.verdict_job else { return };
        let found = match job.poll() {
            Poll::Running => return,
            Poll::Lost => None,
            Poll::Done(verdict) => Some((*revision, Arc::new(verdict))),
        };
        self.verdict_job = None;
        if let Some(preview) = &mut self.preview {
            preview.checked = found.or(preview.checked.take());
            self.check_preview();
        }
    }

    /// The pointer rests in the middle of a drag: the whole run is worth taking.
    pub(super) fn rest(&mut self) {
        if self.history.is_in_gesture() && self.preview.is_some() && self.running.is_none() {
            self.run_document();
        }
    }

    /// Takes the preview off the screen.
    pub(super) fn end_preview(&mut self) {
        (self.preview, self.follow, self.follow_job, self.verdict_job) = (None, None, None, None);
    }
}
