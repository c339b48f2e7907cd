//! A planar embedding that follows the pointer, and stays planar: proved at every frame.
//!
//! ```text
//! first move ──▶ job: from what is on the screen, a frame towards the targets ──▶ Preview, proved
//! its end    ──▶ job: the next frame, towards the targets as they are by then; none where nothing moves any more
//! rest, end  ──▶ run of the document, which goes on from the newest frame
//! ```
//!
//! That is for methods that continue from an embedding, and for constraints; up to two exact pins only say where the
//! embedding lies. Where what is on the screen is no beginning, the drag is linear.

use std::sync::Arc;

use glam::DVec2;

use super::drag_request::{DragRequest, Screen};
use super::{Background, JobFailure, Wake};
use freebound_core::bijective::{DragFrame, DragSolver};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Problem;
use freebound_core::problem::{Control, Embedding};

/// Frames under way, and the embedding between them.
pub(super) struct LiveDrag {
    held: Option<HeldPins>,
    /// Whether what was on the screen is no embedding to begin with.
    has_no_beginning: bool,
    frames: Background<DragGoal, Option<(HeldPins, Frame)>>,
}

/// What a frame goes to, and the pins that are dragged there, ascending.
#[derive(Clone)]
struct DragGoal {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// An embedding between two frames.
pub(super) struct HeldPins {
    live: DragSolver,
    /// The embedding that the drag began with.
    begin: Arc<Embedding>,
    /// The problem that the drag began with.
    problem: Problem,
}

/// A frame that has ended: with the solver for the next one, or nothing if the drag has no start.
type EndedFrame = Result<Option<(HeldPins, Frame)>, JobFailure>;

/// A frame.
pub(super) struct Frame {
    /// The embedding that the drag began with.
    pub(super) begin: Arc<Embedding>,
    /// The vertices that may have moved since then, and where they lie now.
    pub(super) moved: Vec<(VertexId, DVec2)>,
    /// The problem that it goes to.
    pub(super) problem: Problem,
    pub(super) result: DragFrame,
}

/// What a frame begins with.
enum DragStart {
    Held(Box<HeldPins>),
    Screen(Screen),
}

impl LiveDrag {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { held: None, has_no_beginning: false, frames: Background::new("live", wake) }
    }

    pub(super) fn is_busy(&self) -> bool {
        self.frames.is_busy()
    }

    /// No further frame is wanted.
    pub(super) fn end(&mut self) {
        self.frames.cancel();
        (self.held, self.has_no_beginning) = (None, false);
    }

    /// Lets a planar embedding follow. Gives the pins back where there is none.
    pub(super) fn follow(&mut self, request: DragRequest) -> Option<DragRequest> {
        let problem = &request.task.problem;
        let is_under_way =
            |to: &DragGoal| to.dragged == request.dragged && to.problem.differs_in_targets_of(problem, &to.dragged);
        if self.frames.key().is_some_and(is_under_way) {
            // Its end takes the targets up.
            return None;
        }
        self.frames.cancel();
        let serves = |held: &HeldPins| {
            held.live.dragged() == request.dragged && held.problem.differs_in_targets_of(problem, &request.dragged)
        };
        let held = self.held.take().filter(serves);
        let can_begin = || !self.has_no_beginning && problem.settings.continues(&problem.pins());
        let begin = || request.base().filter(|screen| screen.is_planar && can_begin()).cloned().map(DragStart::Screen);
        let Some(beginning) = held.map(Box::new).map(DragStart::Held).or_else(begin) else { return Some(request) };
        let mesh = Arc::clone(&request.task.mesh);
        self.start(mesh, beginning, DragGoal { problem: request.task.problem, dragged: request.dragged });
        None
    }

    fn start(&mut self, mesh: Arc<DiskMesh>, beginning: DragStart, to: DragGoal) {
        self.frames.start(to.clone(), move |cancel| {
            let DragGoal { problem, dragged } = to;
            let mut held = match beginning {
                DragStart::Held(held) => *held,
                DragStart::Screen(Screen { embedding, problem, .. }) => {
                    let live = DragSolver::new(&mesh, Embedding::clone(&embedding), &dragged, problem.drag_target())?;
                    HeldPins { live, begin: embedding, problem }
                }
            };
            let result = held.live.drag(&mesh, &problem.drag_target(), Control::new(cancel, &|_| {})).ok()?;
            let embedding = held.live.embedding();
            let moved = held.live.moving().iter().map(|&vertex| (vertex, embedding[vertex])).collect();
            let begin = Arc::clone(&held.begin);
            Some((held, Frame { begin, moved, problem, result }))
        });
    }

    /// A frame that has ended, with the pins that are dragged; none inside if what was on the screen is no beginning.
    pub(super) fn poll(&mut self) -> Option<(Vec<VertexId>, EndedFrame)> {
        self.frames.poll().map(|(goal, outcome)| (goal.dragged, outcome))
    }

    /// Keeps the embedding for the next frame.
    pub(super) fn hold(&mut self, held: HeldPins) {
        self.held = Some(held);
    }

    /// Notes that what is on the screen is no embedding to begin with.
    pub(super) fn give_up(&mut self) {
        self.has_no_beginning = true;
    }
}
