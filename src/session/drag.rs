//! Preview of pins that follow the pointer.
//!
//! If the screen shows a planar embedding and the method continues from one, that embedding follows the pins and stays
//! planar: see the module `live`. Otherwise the preview is linear.
//!
//! The first solve is complex-linear in the targets: z = Φ t. Moving pins by δ adds δ times their columns of Φ, one
//! multiply-add per vertex, at any mesh size. The column of the dragged pins is solved for once, in the background,
//! when the drag begins. Then every move is shown at once. The base of the preview is the embedding on the screen, so
//! that nothing jumps. If the screen shows new vertices, or the dragged pin was a gauge pin, the base is the first
//! solve. The exact verdict on the preview arrives later and is marked so. If the method does not begin with this
//! solve, the embedding does not move until the pointer pauses.
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

/// Relative tolerance of the displacements of pins that move together: rounding of the pointer's position.
const SAME_WAY: f64 = 1e-9;

/// Embedding shown while pins are dragged.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Positions of the vertices, in the plane.
    pub embedding: Arc<Embedding>,
    /// Number of previews in this session. A screen redraws if it changes.
    pub revision: u64,
    /// State of the planar drag. `None` if the preview is linear.
    pub live: Option<LivePreview>,
    /// Vertices that may have moved in a planar drag.
    moved: Option<MovedVertices>,
    /// Problem with the targets of this preview.
    problem: Problem,
    /// Newest verdict, with the revision of the preview that it belongs to.
    checked: Option<(u64, Arc<Verdict>)>,
}

/// Vertices that may have moved since a drag began. All other vertices are unchanged.
#[derive(Clone, Debug)]
pub struct MovedVertices {
    begin: Arc<Embedding>,
    vertices: Vec<VertexId>,
}

impl MovedVertices {
    /// Embedding at the beginning of the drag. Its address does not change during the drag.
    pub fn begin(&self) -> &Arc<Embedding> {
        &self.begin
    }

    /// Vertices that may have moved.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }
}

/// State of a planar drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LivePreview {
    /// Obstacle of a pin that cannot follow the pointer.
    pub obstacle: Option<Blocker>,
}

impl Preview {
    /// Vertices that may have moved since the drag began. `None` if the preview is linear.
    pub fn moved(&self) -> Option<&MovedVertices> {
        self.moved.as_ref()
    }

    /// Problem with the targets of this preview.
    pub(super) fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Verdict on this revision of the preview, once it is computed.
    pub fn verdict(&self) -> Option<&Arc<Verdict>> {
        self.checked.as_ref().filter(|(revision, _)| *revision == self.revision).map(|(_, verdict)| verdict)
    }
}

/// Column of a drag, solved for once and reused by all moves.
pub(super) struct Follow {
    /// Problem that the base solves.
    problem: Problem,
    /// Dragged pins, ascending.
    dragged: Vec<VertexId>,
    prepared: Arc<Prepared>,
    base: Arc<Embedding>,
    column: Vec<DVec2>,
}

impl Follow {
    pub(super) fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Dragged pins, ascending.
    pub(super) fn dragged(&self) -> &[VertexId] {
        &self.dragged
    }

    pub(super) fn prepared(&self) -> &Arc<Prepared> {
        &self.prepared
    }

    /// True if the column applies to a drag of these pins in this problem: only their targets differ.
    fn serves(&self, problem: &Problem, dragged: &[VertexId]) -> bool {
        self.dragged == dragged && self.problem.differs_in_targets_of(problem, dragged)
    }

    /// Uses the embedding on the screen as the base.
    fn go_on_from(&mut self, screen: &Screen) {
        (self.base, self.problem) = (Arc::clone(&screen.embedding), screen.problem.clone());
    }

    /// Base plus the change of the first solve. `None` if the displacements of the dragged pins differ.
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
            // Hard pins that were met stay met, bit for bit.
            if from.get(vertex).is_some_and(|before| before.target == self.base[vertex]) {
                embedding[*vertex] = pin.target;
            }
        }
        Some(embedding)
    }
}

/// Problem and pins of a column that is being solved for.
struct WantedPreview {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// Preview and solvers of a drag.
pub(super) struct Drag {
    preview: Option<Preview>,
    /// Number of previews.
    revision: u64,
    live: LiveDrag,
    follow: Option<Follow>,
    following: Background<WantedPreview, Result<Follow, SolveError>>,
    /// Verdicts on previews, by their revisions, one at a time.
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

    /// True if a column, a frame or the verdict on a preview is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.following.is_busy() || self.proving.is_busy() || self.live.is_busy()
    }

    /// Moves the embedding with the dragged pins, at once if their column is known. Otherwise solves for the column
    /// first, unless its solve is in progress.
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

    /// Solves for the column in the background, and for the base if the screen provides none.
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

    /// Shows the base plus the change of the first solve. Returns true if the column applies.
    fn show_linear(&mut self, task: &Task) -> bool {
        let embedding = self.follow.as_ref().and_then(|follow| follow.embedding(&task.problem));
        let Some(embedding) = embedding else { return false };
        self.show(Arc::new(embedding), task.problem.clone());
        self.prove(&task.mesh);
        true
    }

    /// Shows an embedding as a linear preview.
    fn show(&mut self, embedding: Arc<Embedding>, problem: Problem) {
        self.revision += 1;
        let checked = self.preview.take().and_then(|before| before.checked);
        self.preview = Some(Preview { embedding, revision: self.revision, live: None, moved: None, problem, checked });
    }

    /// Shows a frame of a planar drag with its verdict. A preview of the same drag is updated in place.
    pub(super) fn show_live(&mut self, frame: Frame) {
        let Frame { begin, moved, problem, result } = frame;
        let before = self.preview.take();
        let checked = before.as_ref().and_then(|preview| preview.checked.as_ref()).map(|(_, verdict)| verdict);
        // Reuse an equal verdict, so that the screen does not recolour the faces.
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
        // The neighbourhood that moves never shrinks during a drag. A frame without one has moved nothing.
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

    /// Computes the verdict on the newest preview in the background, one at a time.
    pub(super) fn prove(&mut self, mesh: &Arc<DiskMesh>) {
        let Some(preview) = self.preview.as_ref().filter(|preview| preview.verdict().is_none()) else { return };
        if !self.proving.is_busy() {
            let (mesh, embedding) = (Arc::clone(mesh), Arc::clone(&preview.embedding));
            self.proving.start(preview.revision, move |_| verdict(&mesh, &embedding));
        }
    }

    /// Stops following the pointer. The preview stays on the screen.
    pub(super) fn stop_following(&mut self) {
        self.following.cancel();
        self.live.end();
    }

    /// Removes the preview, because a step replaces it. The column stays usable.
    pub(super) fn end_preview(&mut self) {
        self.preview = None;
        self.proving.cancel();
        self.live.end();
    }

    /// Ends the drag.
    pub(super) fn end(&mut self) {
        self.end_preview();
        self.follow = None;
        self.following.cancel();
    }

    /// Preview, while pins are dragged.
    pub(super) fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref()
    }

    /// Solver of the planar drag.
    pub(super) fn live_mut(&mut self) -> &mut LiveDrag {
        &mut self.live
    }

    /// Column that was solved for. If the solve failed, the run at the end of the drag reports the reason.
    pub(super) fn poll_column(&mut self) -> Option<Follow> {
        self.following.poll()?.1.ok()?.ok()
    }

    /// Stores a column for further moves.
    pub(super) fn take_column(&mut self, follow: Follow) {
        self.follow = Some(follow);
    }

    /// Stores the verdict on a preview. Returns true if a job has ended.
    pub(super) fn poll_proof(&mut self) -> bool {
        let Some((revision, verdict)) = self.proving.poll() else { return false };
        if let Some(preview) = &mut self.preview {
            let found = verdict.ok().map(|verdict| (revision, Arc::new(verdict)));
            preview.checked = found.or(preview.checked.take());
        }
        true
    }
}
