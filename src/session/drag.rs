//! A pin that follows the pointer.
//!
//! The first solve is complex-linear in the targets: z = Φ t. Moving pins by δ adds δ times their columns of Φ, one
//! multiply-add a vertex, at any size. So when a drag begins, the embedding and the column of what is dragged are solved
//! for once, in the background; from then on every move shows at once. The exact verdict on it lags behind, and says so.
//! Where the method does not begin with that solve, nothing follows the pointer until it rests.
//!
//! ```text
//! first move ──▶ job: base, column ──▶ Follow
//! every move ──▶ base + δ · column ──▶ Preview ──▶ job: verdict
//! rest, end  ──▶ run of the document; its first step takes the preview's place
//! ```

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::solving::Task;
use super::{Background, Problem, Session, Wake};
use crate::mesh::{DiskMesh, VertexId};
use crate::solver::{Control, Embedding, Prepared, SolveError, Verdict, verdict};

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
    checked: Option<(u64, Arc<Verdict>)>,
}

impl Preview {
    /// The verdict on this very embedding, once it is there.
    pub fn verdict(&self) -> Option<&Arc<Verdict>> {
        self.checked.as_ref().filter(|(revision, _)| *revision == self.revision).map(|(_, verdict)| verdict)
    }
}

/// What is solved for once, for all moves of a drag.
struct Follow {
    /// The problem when it was solved.
    problem: Problem,
    /// The pins that are dragged, ascending.
    dragged: Vec<VertexId>,
    prepared: Arc<Prepared>,
    base: Embedding,
    column: Vec<DVec2>,
}

impl Follow {
    /// Whether it serves a drag of these pins in this problem: only their targets differ.
    fn serves(&self, problem: &Problem, dragged: &[VertexId]) -> bool {
        let others_stay = problem.targets.iter().all(|(vertex, target)| {
            dragged.binary_search(vertex).is_ok()
                || self.problem.targets.get(vertex).is_some_and(|before| before.uv == target.uv)
        });
        self.dragged == dragged && others_stay && self.problem.differs_in_targets_alone(problem)
    }

    /// The embedding of the problem's first solve; none where the dragged pins did not all go the same way.
    fn embedding(&self, problem: &Problem) -> Option<Embedding> {
        let (from, to) = (self.problem.pins(), problem.pins());
        let way = |vertex: &VertexId| Some(to.get(vertex)?.target - from.get(vertex)?.target);
        let by = way(self.dragged.first()?)?;
        let goes_along = |vertex: &VertexId| way(vertex).is_some_and(|w| w.distance(by) <= SAME_WAY * by.length());
        if !self.dragged.iter().all(goes_along) {
            return None;
        }
        let moved = |(base, column): (&DVec2, &DVec2)| *base + by.rotate(*column);
        let mut embedding: Embedding = self.base.par_iter().zip(&self.column).map(moved).collect::<Vec<_>>().into();
        for (vertex, pin) in to.iter().filter(|(_, pin)| problem.settings.is_exact(pin.hold)) {
            embedding[*vertex] = pin.target;
        }
        Some(embedding)
    }
}

/// What a column is solved for.
struct Wanted {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// What the screen shows while pins are dragged.
pub(super) struct Drag {
    preview: Option<Preview>,
    /// Counts previews.
    revision: u64,
    follow: Option<Follow>,
    following: Background<Wanted, Result<Follow, SolveError>>,
    /// Proves previews, by their revisions, one at a time.
    proving: Background<u64, Verdict>,
}

impl Drag {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            preview: None,
            revision: 0,
            follow: None,
            following: Background::new("follow", wake),
            proving: Background::new("verdict", wake),
        }
    }

    /// Whether a column, or the verdict on a preview, is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.following.is_busy() || self.proving.is_busy()
    }

    /// Lets the embedding follow pins that were moved, at once where their column is known; otherwise that is solved
    /// for first, unless it is under way.
    pub(super) fn follow(&mut self, task: Task, dragged: Vec<VertexId>, prepared: Option<&Arc<Prepared>>) {
        let is_served = self.follow.as_ref().is_some_and(|follow| follow.serves(&task.problem, &dragged));
        if is_served && self.show_preview(&task) {
            return;
        }
        let is_under_way =
            |wanted: &Wanted| wanted.dragged == dragged && wanted.problem.differs_in_targets_alone(&task.problem);
        if !self.following.key().is_some_and(is_under_way) {
            self.solve_column(task, dragged, prepared.cloned());
        }
    }

    /// Solves for base and column in the background.
    fn solve_column(&mut self, task: Task, dragged: Vec<VertexId>, prepared: Option<Arc<Prepared>>) {
        let Task { mesh, problem, .. } = task;
        let wanted = Wanted { problem: problem.clone(), dragged: dragged.clone() };
        self.following.start(wanted, move |cancel| {
            let control = Control::new(cancel, &|_| {});
            let pins = problem.pins();
            let prepared = match prepared.filter(|prepared| prepared.serves(&problem.settings, &pins)) {
                Some(prepared) => prepared,
                None => Arc::new(Prepared::new(&mesh, &problem.settings, &pins, control)?),
            };
            let base = prepared.solve(&mesh, &pins, control)?.embedding;
            let column = prepared.column(&mesh, &dragged)?;
            Ok(Follow { problem, dragged, prepared, base, column })
        });
    }

    /// Shows the embedding of the problem's first solve. Returns whether the column gives it.
    fn show_preview(&mut self, task: &Task) -> bool {
        let embedding = self.follow.as_ref().and_then(|follow| follow.embedding(&task.problem));
        let Some(embedding) = embedding else { return false };
        self.revision += 1;
        let checked = self.preview.take().and_then(|before| before.checked);
        self.preview = Some(Preview { embedding: Arc::new(embedding), revision: self.revision, checked });
        self.prove(&task.mesh);
        true
    }

    /// Proves the newest preview in the background, one at a time.
    fn prove(&mut self, mesh: &Arc<DiskMesh>) {
        let Some(preview) = self.preview.as_ref().filter(|preview| preview.verdict().is_none()) else { return };
        if !self.proving.is_busy() {
            let (mesh, embedding) = (Arc::clone(mesh), Arc::clone(&preview.embedding));
            self.proving.start(preview.revision, move |_| verdict(&mesh, &embedding));
        }
    }

    /// No column is wanted any more; what is on the screen stays.
    pub(super) fn stop_following(&mut self) {
        self.following.cancel();
    }

    /// A step has taken the preview's place; the column still serves.
    pub(super) fn end_preview(&mut self) {
        self.preview = None;
        self.proving.cancel();
    }

    /// The drag is over.
    pub(super) fn end(&mut self) {
        self.end_preview();
        self.follow = None;
        self.following.cancel();
    }
}

impl Session {
    /// What the screen shows while pins are dragged.
    pub fn preview(&self) -> Option<&Preview> {
        self.drag.preview.as_ref()
    }

    /// Lets the embedding follow pins that were moved.
    pub(super) fn follow(&mut self, dragged: Vec<VertexId>) {
        // Where the method begins with something else than the solve that follows pins, the screen keeps what is proved. Where
        // the mesh is to be turned around, a solve follows by itself.
        let task = self.task().filter(|_| self.document.settings.begin_with_pins_held());
        if let Some(task) = task {
            self.drag.follow(task, dragged, self.solving.prepared());
        }
    }

    /// Takes in what a drag has waited for.
    pub(super) fn poll_drag(&mut self) {
        // Where the solve for a column failed, the run at the end of the drag says why.
        if let Some((_, Ok(Ok(follow)))) = self.drag.following.poll() {
            self.take_column(follow);
        }
        let Some((revision, verdict)) = self.drag.proving.poll() else { return };
        if let Some(preview) = &mut self.drag.preview {
            let found = verdict.ok().map(|verdict| (revision, Arc::new(verdict)));
            preview.checked = found.or(preview.checked.take());
        }
        if let Some(mesh) = self.disk().cloned() {
            self.drag.prove(&mesh);
        }
    }

    fn take_column(&mut self, follow: Follow) {
        if !follow.problem.differs_in_targets_alone(&self.document.problem()) {
            return;
        }
        self.solving.keep_prepared(Arc::clone(&follow.prepared));
        let dragged = follow.dragged.clone();
        self.drag.follow = Some(follow);
        if self.history.is_in_gesture() && !self.is_running() && !self.is_current() {
            self.follow(dragged);
        }
    }
}
