//! A pin that follows the pointer.
//!
//! Where the screen shows a planar embedding and the method goes on from one, that embedding follows and stays planar: see
//! the module `live`. Elsewhere what follows is linear.
//!
//! The first solve is complex-linear in the targets: z = Φ t. Moving pins by δ adds δ times their columns of Φ, one
//! multiply-add a vertex, at any size. So when a drag begins, the column of what is dragged is solved for once, in the
//! background; from then on every move shows at once, as what was on the screen plus that change, so that nothing jumps; as the
//! first solve plus that change where the screen shows new vertices, or where the pin was the solver's own. The exact verdict
//! on it lags behind, and says so. Where the method does not begin with that solve, nothing follows the pointer until it
//! rests.
//!
//! ```text
//! first move ──▶ job: column ──▶ Follow
//! every move ──▶ base + δ · column ──▶ Preview ──▶ job: verdict
//! rest, end  ──▶ run of the document; its first step takes the preview's place
//! ```

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::drag_request::{DragRequest, Screen};
use super::live::{Frame, LiveDrag};
use super::solving::Task;
use super::{Background, Wake};
use freebound_core::bijective::Blocker;
use freebound_core::flatten::Prepared;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Problem;
use freebound_core::problem::{Control, Embedding, SolveError};
use freebound_core::verify::{Verdict, verdict};

/// Pins moved together may differ in their way by this share of it: rounding of the pointer's place.
const SAME_WAY: f64 = 1e-9;

/// What follows pins while they are dragged.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Where vertices lie, in the plane.
    pub embedding: Arc<Embedding>,
    /// Counts the moves of this session, so that a screen can tell when to draw anew.
    pub revision: u64,
    /// Where it is a planar embedding that stays so: how far it has followed.
    pub live: Option<LivePreview>,
    /// The vertices that may have moved, if it is a planar embedding that stays so.
    moved: Option<MovedVertices>,
    /// The problem that it follows to.
    problem: Problem,
    /// The newest verdict that there is, with the revision that it is on.
    checked: Option<(u64, Arc<Verdict>)>,
}

/// Vertices that may have moved since a drag began; all others lie where they did.
#[derive(Clone, Debug)]
pub struct MovedVertices {
    begin: Arc<Embedding>,
    vertices: Vec<VertexId>,
}

impl MovedVertices {
    /// The embedding that the drag began with. It stays the same object during the drag.
    pub fn begin(&self) -> &Arc<Embedding> {
        &self.begin
    }

    /// The vertices.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }
}

/// How far a planar embedding has followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LivePreview {
    /// What is in the way of a pin that cannot follow.
    pub obstacle: Option<Blocker>,
}

impl Preview {
    /// The vertices that may have moved since the drag began, if it is a planar embedding that stays so.
    pub fn moved(&self) -> Option<&MovedVertices> {
        self.moved.as_ref()
    }

    /// The problem that it follows to.
    pub(super) fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The verdict on this very embedding, once it is there.
    pub fn verdict(&self) -> Option<&Arc<Verdict>> {
        self.checked.as_ref().filter(|(revision, _)| *revision == self.revision).map(|(_, verdict)| verdict)
    }
}

/// What is solved for once, for all moves of a drag.
pub(super) struct Follow {
    /// The problem that the base is of.
    problem: Problem,
    /// The pins that are dragged, ascending.
    dragged: Vec<VertexId>,
    prepared: Arc<Prepared>,
    base: Arc<Embedding>,
    column: Vec<DVec2>,
}

impl Follow {
    pub(super) fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The pins that are dragged, ascending.
    pub(super) fn dragged(&self) -> &[VertexId] {
        &self.dragged
    }

    pub(super) fn prepared(&self) -> &Arc<Prepared> {
        &self.prepared
    }

    /// Whether it serves a drag of these pins in this problem: only their targets differ.
    fn serves(&self, problem: &Problem, dragged: &[VertexId]) -> bool {
        self.dragged == dragged && self.problem.differs_in_targets_of(problem, dragged)
    }

    /// Goes on from what is on the screen.
    fn go_on_from(&mut self, screen: &Screen) {
        (self.base, self.problem) = (Arc::clone(&screen.embedding), screen.problem.clone());
    }

    /// The base with the change of the first solve; none where the dragged pins did not all go the same way.
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
        for (vertex, pin) in to.iter().filter(|(_, pin)| problem.settings.is_hard(pin.kind)) {
            // What was met stays met, to the last bit.
            if from.get(vertex).is_some_and(|before| before.target == self.base[vertex]) {
                embedding[*vertex] = pin.target;
            }
        }
        Some(embedding)
    }
}

/// What a column is solved for.
struct WantedPreview {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// What the screen shows while pins are dragged.
pub(super) struct Drag {
    preview: Option<Preview>,
    /// Counts previews.
    revision: u64,
    live: LiveDrag,
    follow: Option<Follow>,
    following: Background<WantedPreview, Result<Follow, SolveError>>,
    /// Proves previews, by their revisions, one at a time.
    proving: Background<u64, Verdict>,
}

impl Drag {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            preview: None,
            revision: 0,
            live: LiveDrag::new(wake),
            follow: None,
            following: Background::new("follow", wake),
            proving: Background::new("verdict", wake),
        }
    }

    /// Whether a column, a frame, or the verdict on a preview, is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.following.is_busy() || self.proving.is_busy() || self.live.is_busy()
    }

    /// Lets the embedding follow pins that were moved, at once where their column is known; otherwise that is solved
    /// for first, unless it is under way.
    pub(super) fn follow(&mut self, request: DragRequest, prepared: Option<&Arc<Prepared>>) {
        if self.preview.is_none()
            && let (Some(follow), Some(screen)) = (&mut self.follow, request.base())
        {
            follow.go_on_from(screen);
        }
        let (task, dragged) = (&request.task, &request.dragged);
        let is_served = self.follow.as_ref().is_some_and(|follow| follow.serves(&task.problem, dragged));
        if is_served && self.show_linear(task) {
            return;
        }
        let is_under_way = |wanted: &WantedPreview| {
            wanted.dragged == *dragged && wanted.problem.differs_in_targets_alone(&task.problem)
        };
        if !self.following.key().is_some_and(is_under_way) {
            self.solve_column(request, prepared.cloned());
        }
    }

    /// Solves for the column in the background, and for a base where there is none on the screen.
    fn solve_column(&mut self, request: DragRequest, prepared: Option<Arc<Prepared>>) {
        let base = request.base().cloned();
        let DragRequest { task: Task { mesh, problem, .. }, dragged, .. } = request;
        let wanted = WantedPreview { problem: problem.clone(), dragged: dragged.clone() };
        self.following.start(wanted, move |cancel| {
            let control = Control::new(cancel, &|_| {});
            let pins = problem.pins();
            let prepared = match prepared.filter(|prepared| prepared.serves(&problem.settings, &pins)) {
                Some(prepared) => prepared,
                None => Arc::new(Prepared::new(&mesh, &problem.settings, &pins, control)?),
            };
            let (base, problem) = match base {
                Some(screen) => (screen.embedding, screen.problem),
                None => (Arc::new(prepared.solve(&mesh, &pins, control)?.embedding), problem),
            };
            let column = prepared.column(&mesh, &dragged)?;
            Ok(Follow { problem, dragged, prepared, base, column })
        });
    }

    /// Shows the base with the change of the first solve. Returns whether the column gives it.
    fn show_linear(&mut self, task: &Task) -> bool {
        let embedding = self.follow.as_ref().and_then(|follow| follow.embedding(&task.problem));
        let Some(embedding) = embedding else { return false };
        self.show(Arc::new(embedding), task.problem.clone());
        self.prove(&task.mesh);
        true
    }

    /// Shows an embedding.
    fn show(&mut self, embedding: Arc<Embedding>, problem: Problem) {
        self.revision += 1;
        let checked = self.preview.take().and_then(|before| before.checked);
        self.preview = Some(Preview { embedding, revision: self.revision, live: None, moved: None, problem, checked });
    }

    /// Shows a frame of a planar embedding, with its verdict. What is shown already of the same drag changes in place.
    pub(super) fn show_live(&mut self, frame: Frame) {
        let Frame { begin, moved, problem, result } = frame;
        let before = self.preview.take();
        let checked = before.as_ref().and_then(|preview| preview.checked.as_ref()).map(|(_, verdict)| verdict);
        // The same verdict stays the same to a screen that looks at it: nothing is coloured anew.
        let verdict = match checked {
            Some(before) if **before == result.verdict => Arc::clone(before),
            _ => Arc::new(result.verdict),
        };
        let of_drag = before.and_then(|Preview { embedding, moved, .. }| Some((embedding, moved?)));
        let (mut embedding, known) = match of_drag.filter(|(_, known)| Arc::ptr_eq(&known.begin, &begin)) {
            Some((embedding, known)) => (embedding, known.vertices),
            None => (Arc::clone(&begin), Vec::new()),
        };
        let places = Arc::make_mut(&mut embedding);
        for &(vertex, place) in &moved {
            places[vertex] = place;
        }
        // The neighbourhood that moves never shrinks during a drag; without one, nothing has moved in this frame.
        let vertices =
            if moved.len() < known.len() { known } else { moved.into_iter().map(|(vertex, _)| vertex).collect() };
        self.revision += 1;
        self.preview = Some(Preview {
            embedding,
            revision: self.revision,
            live: Some(LivePreview { obstacle: result.obstacle }),
            moved: Some(MovedVertices { begin, vertices }),
            problem,
            checked: Some((self.revision, verdict)),
        });
    }

    /// Proves the newest preview in the background, one at a time.
    pub(super) fn prove(&mut self, mesh: &Arc<DiskMesh>) {
        let Some(preview) = self.preview.as_ref().filter(|preview| preview.verdict().is_none()) else { return };
        if !self.proving.is_busy() {
            let (mesh, embedding) = (Arc::clone(mesh), Arc::clone(&preview.embedding));
            self.proving.start(preview.revision, move |_| verdict(&mesh, &embedding));
        }
    }

    /// Nothing follows the pointer any more; what is on the screen stays.
    pub(super) fn stop_following(&mut self) {
        self.following.cancel();
        self.live.end();
    }

    /// A step has taken the preview's place; the column still serves.
    pub(super) fn end_preview(&mut self) {
        self.preview = None;
        self.proving.cancel();
        self.live.end();
    }

    /// The drag is over.
    pub(super) fn end(&mut self) {
        self.end_preview();
        self.follow = None;
        self.following.cancel();
    }

    /// The map that the screen shows while pins are dragged.
    pub(super) fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref()
    }

    /// The planar embedding that follows the pointer.
    pub(super) fn live_mut(&mut self) -> &mut LiveDrag {
        &mut self.live
    }

    /// A column that was solved for. If its solve failed, the run at the end of the drag says why.
    pub(super) fn poll_column(&mut self) -> Option<Follow> {
        self.following.poll()?.1.ok()?.ok()
    }

    /// Takes a column for the moves that follow.
    pub(super) fn take_column(&mut self, follow: Follow) {
        self.follow = Some(follow);
    }

    /// Takes in the verdict on a preview. Returns whether there was one.
    pub(super) fn poll_proof(&mut self) -> bool {
        let Some((revision, verdict)) = self.proving.poll() else { return false };
        if let Some(preview) = &mut self.preview {
            let found = verdict.ok().map(|verdict| (revision, Arc::new(verdict)));
            preview.checked = found.or(preview.checked.take());
        }
        true
    }
}
