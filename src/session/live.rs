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

use super::drag::{Pull, Screen};
use super::{Background, Place, Problem, Session, Wake};
use crate::io::Target;
use crate::mesh::{DiskMesh, VertexId};
use crate::solver::{Aim, Control, Embedding, Live, Moved};

/// Frames under way, and the embedding between them.
pub(super) struct LiveDrag {
    held: Option<Held>,
    /// Whether what was on the screen is no embedding to begin with.
    has_no_beginning: bool,
    frames: Background<Towards, Option<(Held, Frame)>>,
}

/// What a frame goes to, and the pins that are dragged there, ascending.
#[derive(Clone)]
struct Towards {
    problem: Problem,
    dragged: Vec<VertexId>,
}

/// An embedding between two frames.
struct Held {
    live: Live,
    /// The problem that the drag began with.
    problem: Problem,
}

/// A frame.
pub(super) struct Frame {
    pub(super) embedding: Arc<Embedding>,
    /// The problem that it goes to.
    pub(super) problem: Problem,
    pub(super) moved: Moved,
}

/// What a frame begins with.
enum Beginning {
    Held(Box<Held>),
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
    pub(super) fn follow(&mut self, pull: Pull) -> Option<Pull> {
        let problem = &pull.task.problem;
        let is_under_way =
            |to: &Towards| to.dragged == pull.dragged && to.problem.differs_in_targets_of(problem, &to.dragged);
        if self.frames.key().is_some_and(is_under_way) {
            // Its end takes the targets up.
            return None;
        }
        self.frames.cancel();
        let serves = |held: &Held| {
            held.live.dragged() == pull.dragged && held.problem.differs_in_targets_of(problem, &pull.dragged)
        };
        let held = self.held.take().filter(serves);
        let can_begin = !self.has_no_beginning && problem.settings.continues(&problem.pins());
        let begin = || pull.base().filter(|screen| can_begin && screen.is_planar).cloned().map(Beginning::Screen);
        let Some(beginning) = held.map(Box::new).map(Beginning::Held).or_else(begin) else { return Some(pull) };
        let mesh = Arc::clone(&pull.task.mesh);
        self.start(mesh, beginning, Towards { problem: pull.task.problem, dragged: pull.dragged });
        None
    }

    fn start(&mut self, mesh: Arc<DiskMesh>, beginning: Beginning, to: Towards) {
        self.frames.start(to.clone(), move |cancel| {
            let Towards { problem, dragged } = to;
            let mut held = match beginning {
                Beginning::Held(held) => *held,
                Beginning::Screen(Screen { embedding, problem, .. }) => {
                    let live = Live::new(&mesh, Embedding::clone(&embedding), &dragged, problem.aim())?;
                    Held { live, problem }
                }
            };
            let moved = held.live.drag(&mesh, &problem.aim(), Control::new(cancel, &|_| {})).ok()?;
            let embedding = Arc::new(held.live.embedding().clone());
            Some((held, Frame { embedding, problem, moved }))
        });
    }
}

impl Problem {
    /// Where its pins are to be, as they are held, and how embeddings are written.
    pub(super) fn aim(&self) -> Aim {
        Aim { pins: self.settings.held(&self.pins()), sheet: Arc::new(self.sheet()) }
    }

    /// Whether it differs from another problem in the targets of these pins alone.
    pub(super) fn differs_in_targets_of(&self, other: &Self, moved: &[VertexId]) -> bool {
        let is_moved = |vertex: &VertexId| moved.binary_search(vertex).is_ok();
        let stays = |(vertex, target): (&VertexId, &Target)| {
            is_moved(vertex) || self.targets.get(vertex).is_some_and(|before| before.uv == target.uv)
        };
        let have_all = moved.iter().all(|vertex| self.targets.contains_key(vertex));
        have_all && other.targets.iter().all(stays) && self.differs_in_targets_alone(other)
    }
}

impl Session {
    /// Takes in a frame, and has the next one follow as long as something moves.
    pub(super) fn poll_live(&mut self) {
        let Some((Towards { dragged, .. }, outcome)) = self.drag.live.frames.poll() else { return };
        if !self.history.is_in_gesture() || self.is_running() {
            return;
        }
        let wanted = self.document.problem();
        match outcome {
            Ok(Some((held, frame))) if frame.problem.differs_in_targets_of(&wanted, &dragged) => {
                let is_at_rest = frame.moved.is_at_rest && frame.problem == wanted;
                self.drag.live.held = Some(held);
                self.drag.show_live(frame);
                if !is_at_rest {
                    self.follow(dragged);
                }
            }
            Ok(None) => {
                self.drag.live.has_no_beginning = true;
                self.follow(dragged);
            }
            Ok(Some(_)) => {}
            Err(failure) => {
                self.drag.live.has_no_beginning = true;
                self.messages.fail_background(Place::Embedding, "moving the pins", &failure);
            }
        }
    }
}
