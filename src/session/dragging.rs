//! Frames of a drag of pins.

use std::sync::Arc;

use super::drag::Follow;
use super::drag_request::{DragRequest, Screen};
use super::{MessagePlace, Preview, Session};
use freebound_core::mesh::VertexId;

impl Session {
    /// Preview, while pins are dragged.
    pub fn preview(&self) -> Option<&Preview> {
        self.drag.preview()
    }

    /// Moves the embedding with the dragged pins.
    pub(super) fn follow(&mut self, dragged: Vec<VertexId>) {
        let Some(task) = self.task() else { return };
        let request = DragRequest { task, dragged, screen: self.screen() };
        let Some(request) = self.drag.live_mut().follow(request) else { return };
        // If the method does not begin with the solve that follows pins, the proved step stays on the screen. If the
        // mesh is still being prepared, a solve follows later.
        if request.task.problem.settings.begin_with_pins_held() {
            self.drag.follow(request, self.solving.prepared());
        }
    }

    /// Embedding on the screen, on the mesh as given.
    pub(super) fn screen(&self) -> Option<Screen> {
        if let Some(preview) = self.preview() {
            let (embedding, problem) = (Arc::clone(&preview.embedding), preview.problem().clone());
            return Some(Screen { embedding, problem, is_planar: preview.live.is_some() });
        }
        let outcome = self.outcome().filter(|outcome| outcome.step.candidate.refinement.is_none())?;
        Screen::of(outcome, outcome.step.candidate.solution.embedding.len())
    }

    /// Processes the results of the drag's jobs.
    pub(super) fn poll_drag(&mut self) {
        self.poll_live();
        if let Some(follow) = self.drag.poll_column() {
            self.take_column(follow);
        }
        if !self.drag.poll_proof() {
            return;
        }
        if let Some(mesh) = self.disk().cloned() {
            self.drag.prove(&mesh);
        }
    }

    fn take_column(&mut self, follow: Follow) {
        if !follow.problem().differs_in_targets_alone(&self.document.problem()) {
            return;
        }
        self.solving.keep_prepared(Arc::clone(follow.prepared()));
        let dragged = follow.dragged().to_vec();
        self.drag.take_column(follow);
        if self.history.is_in_gesture() && !self.is_running() && !self.is_current() {
            self.follow(dragged);
        }
    }

    /// Shows a finished frame and starts the next frame as long as something moves.
    pub(super) fn poll_live(&mut self) {
        let Some((dragged, outcome)) = self.drag.live_mut().poll() else { return };
        if !self.history.is_in_gesture() || self.is_running() {
            return;
        }
        let wanted = self.document.problem();
        match outcome {
            Ok(Some((held, frame))) if frame.problem.differs_in_targets_of(&wanted, &dragged) => {
                let is_at_rest = frame.result.is_at_rest && frame.problem == wanted;
                self.drag.live_mut().hold(held);
                self.drag.show_live(frame);
                if !is_at_rest {
                    self.follow(dragged);
                }
            }
            Ok(None) => {
                self.drag.live_mut().give_up();
                self.follow(dragged);
            }
            Ok(Some(_)) => {}
            Err(failure) => {
                self.drag.live_mut().give_up();
                self.messages.fail_background(MessagePlace::Embedding, "moving the pins", &failure);
            }
        }
    }
}
