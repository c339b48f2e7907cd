//! Part: strokes of brushes on the map on the screen. Each frame is proved; a stroke becomes one edit at its end.
//!
//! ```text
//! brush ──▶ job: a frame with the pointer at its newest position ──▶ preview, proved
//!           a newer position replaces one that waits
//! end   ──▶ edit of the document: the map that the user shaped, once no frame is being computed
//! ```

use std::sync::Arc;

use glam::DVec2;

use super::action::BrushDab;
use super::drag_request::Screen;
use super::live::Frame;
use super::stop::Goal;
use super::{Background, Command, MessagePlace, Session, Wake};
use freebound_core::bijective::{BrushFrame, BrushSolver, DragFrame};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::{Problem, ShapedMap};
use freebound_core::problem::{Control, Embedding};

/// Strokes of brushes.
pub(super) struct Brushing {
    stroke: Option<Stroke>,
    frames: Background<(), Option<(BrushSolver, BrushFrame)>>,
}

/// Stroke in progress.
struct Stroke {
    dab: BrushDab,
    begin: Arc<Embedding>,
    problem: Problem,
    /// Solver between frames. `None` before the first frame and while a frame is computed.
    solver: Option<Box<BrushSolver>>,
    /// True if the pointer has moved or presses on since the last frame began.
    is_waiting: bool,
    is_ending: bool,
    /// Newest frame.
    frame: Option<BrushFrame>,
    has_moved: bool,
}

impl Brushing {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { stroke: None, frames: Background::new("brush", wake) }
    }

    /// True while a frame is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.frames.is_busy()
    }

    /// Drops the stroke. Returns true if there was one.
    pub(super) fn give_up(&mut self) -> bool {
        self.frames.cancel();
        self.stroke.take().is_some()
    }

    /// Computes the next frame, if one is wanted and none is being computed.
    fn start_next(&mut self, mesh: &Arc<DiskMesh>) {
        let Some(stroke) = self.stroke.as_mut().filter(|stroke| stroke.is_waiting) else { return };
        if self.frames.is_busy() {
            return;
        }
        stroke.is_waiting = false;
        let (mesh, dab, before) = (Arc::clone(mesh), stroke.dab, stroke.solver.take());
        let (begin, target) = (Arc::clone(&stroke.begin), stroke.problem.drag_target());
        self.frames.start((), move |cancel| {
            let solver = before.map(|solver| *solver);
            let first = || BrushSolver::new(&mesh, Embedding::clone(&begin), target, dab.brush, dab.at);
            let mut solver = solver.or_else(first)?;
            let frame = solver.frame(&mesh, dab.at, Control::new(cancel, &|_| {})).ok()?;
            Some((solver, frame))
        });
    }
}

impl Stroke {
    /// Frame of the preview, with the vertices that have moved.
    fn preview(&self) -> Option<Frame> {
        let (solver, frame) = (self.solver.as_ref()?, self.frame.clone()?);
        let BrushFrame { obstacle, is_at_rest, verdict, .. } = frame;
        let embedding = solver.embedding();
        let moved: Vec<(VertexId, DVec2)> = solver.moved().iter().map(|&v| (v, embedding[v])).collect();
        let result = DragFrame { reached: 1.0, obstacle, is_at_rest, verdict };
        Some(Frame { begin: Arc::clone(&self.begin), moved, problem: self.problem.clone(), result })
    }
}

impl Session {
    /// True if brushes can shape the map on the screen: it is planar, belongs to the document, has no new vertices, and
    /// nothing solves it.
    pub fn can_brush(&self) -> bool {
        self.brushed_screen().is_some()
    }

    /// Radius that the newest frame of a stroke used, in the plane.
    pub fn brush_radius(&self) -> Option<f64> {
        Some(self.brushing.stroke.as_ref()?.frame.as_ref()?.radius)
    }

    /// True from the first frame of a stroke to its end.
    pub fn is_brushing(&self) -> bool {
        self.brushing.stroke.is_some()
    }

    /// Planar map on the screen that brushes can shape.
    fn brushed_screen(&self) -> Option<Screen> {
        let is_at_rest = !self.is_running() && self.preview().is_none() && !self.history.is_in_gesture();
        if !is_at_rest || !self.is_current() || !self.has_form_as_wanted() {
            return None;
        }
        let outcome = self.outcome().filter(|outcome| outcome.can_be_saved())?;
        Screen::of(outcome, self.disk()?.vertex_count()).filter(|screen| screen.is_planar)
    }

    /// Applies a brush at the pointer: starts a stroke, or continues it.
    pub(super) fn brush(&mut self, dab: BrushDab) {
        let Some(mesh) = self.disk().cloned() else { return };
        if let Some(stroke) = &mut self.brushing.stroke {
            if !stroke.is_ending {
                (stroke.dab.at, stroke.is_waiting) = (dab.at, true);
            }
        } else {
            let Some(Screen { embedding, problem, .. }) = self.brushed_screen() else { return };
            let stroke = Stroke {
                dab,
                begin: embedding,
                problem,
                solver: None,
                is_waiting: true,
                is_ending: false,
                frame: None,
                has_moved: false,
            };
            self.brushing.stroke = Some(stroke);
        }
        self.brushing.start_next(&mesh);
    }

    /// Ends a stroke: it becomes an edit at the next poll that has its newest frame. Not at once, because the window is
    /// drawn by then, and it would not show the run that begins.
    pub(super) fn end_brush(&mut self) {
        if let Some(stroke) = &mut self.brushing.stroke {
            stroke.is_ending = true;
        }
    }

    /// Drops a stroke and shows the map before it.
    pub(super) fn give_up_brush(&mut self) {
        if self.brushing.give_up() {
            self.drag.end();
        }
    }

    /// Shows finished frames, and makes a stroke that has ended an edit.
    pub(super) fn poll_brush(&mut self) {
        let wanted = self.document.problem();
        if self.brushing.stroke.as_ref().is_some_and(|stroke| stroke.problem != wanted) {
            // The document has changed.
            return self.give_up_brush();
        }
        match self.brushing.frames.poll() {
            Some(((), Ok(Some((solver, frame))))) => self.take_frame(solver, frame),
            Some(((), Ok(None))) => self.give_up_brush(),
            Some(((), Err(failure))) => {
                self.give_up_brush();
                self.messages.fail_background(MessagePlace::Embedding, "moving vertices with a brush", &failure);
            }
            None => {}
        }
        if let Some(mesh) = self.disk().cloned() {
            self.brushing.start_next(&mesh);
        }
        let is_ending = self.brushing.stroke.as_ref().is_some_and(|stroke| stroke.is_ending);
        if is_ending && !self.brushing.is_busy() {
            self.take_stroke();
        }
    }

    fn take_frame(&mut self, solver: BrushSolver, frame: BrushFrame) {
        let Some(stroke) = &mut self.brushing.stroke else { return };
        stroke.has_moved |= !solver.moved().is_empty();
        (stroke.solver, stroke.frame) = (Some(Box::new(solver)), Some(frame));
        if let Some(frame) = stroke.preview().filter(|_| stroke.has_moved) {
            self.drag.show_live(frame);
        }
    }

    /// Makes the stroke an edit: the map that the user shaped. All charts stay where they lie on the page.
    fn take_stroke(&mut self) {
        let Some(stroke) = self.brushing.stroke.take() else { return };
        let shaped = stroke.solver.as_ref().map(|solver| solver.embedding().clone());
        let Some(shaped) = shaped.filter(|shaped| *shaped != *stroke.begin) else { return self.drag.end() };
        let mut edits = vec![Command::SetShaped(Some(ShapedMap(Arc::new(shaped)))), Command::SetRelaxed(0)];
        if let Some(layout) = self.layout_as_it_lies() {
            edits.push(Command::SetLayout(Box::new(layout)));
        }
        if self.apply(Command::Together(edits)) {
            self.solving.follow_newest();
            // The preview stays until the map arrives with its distortion.
            self.begin(Goal::Until(self.stop_conditions()));
        }
    }
}
