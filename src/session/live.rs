//! Planar embedding that follows the pointer and stays planar. Every frame is proved.
//!
//! ```text
//! first move ──▶ job: a frame from the embedding on the screen towards the targets ──▶ Preview, proved
//! its end    ──▶ job: the next frame towards the current targets, until nothing moves any more
//! rest, end  ──▶ run of the document, which continues from the newest frame
//! ```
//!
//! Planar drags need a method that continues from an embedding, and constraints: up to two hard pins only fix the
//! position of the embedding. If the embedding on the screen is no valid start, the drag is linear.

use std::sync::Arc;

use glam::DVec2;

use super::drag_request::{DragRequest, Screen};
use super::{Background, JobFailure, Wake};
use freebound_core::bijective::{DragFrame, DragSolver};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Problem;
use freebound_core::problem::{Control, Embedding};

/// Frames in progress, and the solver between frames.
pub(super) struct LiveDrag {
    held: Option<HeldPins>,
    /// True if the embedding on the screen was no valid start.
    has_no_beginning: bool,
    frames: Background<DragGoal, Option<(HeldPins, Frame)>>,
}

/// Problem that a frame moves towards, and the dragged pins, ascending.
#[derive(Clone)]
struct DragGoal {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// Solver of a drag between two frames.
pub(super) struct HeldPins {
    live: DragSolver,
    /// Embedding at the beginning of the drag.
    begin: Arc<Embedding>,
    /// Problem at the beginning of the drag.
    problem: Problem,
}

/// Finished frame, with the solver for the next one. `None` if the drag has no valid start.
type EndedFrame = Result<Option<(HeldPins, Frame)>, JobFailure>;

/// Frame of a planar drag.
pub(super) struct Frame {
    /// Embedding at the beginning of the drag.
    pub(super) begin: Arc<Embedding>,
    /// Vertices that may have moved since the beginning, with their positions.
    pub(super) moved: Vec<(VertexId, DVec2)>,
    /// Problem that the frame moves towards.
    pub(super) problem: Problem,
    pub(super) result: DragFrame,
}

/// Start of a frame.
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

    /// Ends the drag and drops its frames.
    pub(super) fn end(&mut self) {
        self.frames.cancel();
        (self.held, self.has_no_beginning) = (None, false);
    }

    /// Starts a frame for dragged pins. Returns the request if no planar drag is possible.
    pub(super) fn follow(&mut self, request: DragRequest) -> Option<DragRequest> {
        let problem = &request.task.problem;
        let is_under_way =
            |to: &DragGoal| to.dragged == request.dragged && to.problem.differs_in_targets_of(problem, &to.dragged);
        if self.frames.key().is_some_and(is_under_way) {
            // The next frame uses the new targets.
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

    /// Finished frame with its dragged pins. The frame is `None` if the embedding on the screen was no valid start.
    pub(super) fn poll(&mut self) -> Option<(Vec<VertexId>, EndedFrame)> {
        self.frames.poll().map(|(goal, outcome)| (goal.dragged, outcome))
    }

    /// Stores the solver for the next frame.
    pub(super) fn hold(&mut self, held: HeldPins) {
        self.held = Some(held);
    }

    /// Notes that the embedding on the screen is no valid start.
    pub(super) fn give_up(&mut self) {
        self.has_no_beginning = true;
    }
}
