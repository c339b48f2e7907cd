//! What is done to the user's pins.

use glam::DVec2;

use super::{Command, Document, Place, Session};
use crate::geom::PictureFrame;
use crate::io::{Target, Targets};
use crate::mesh::VertexId;
use crate::solver::{Hold, Pins};

impl Session {
    /// Pins vertices where they lie.
    pub(super) fn fix(&mut self, vertices: &[VertexId]) {
        let Some(outcome) = self.outcome().cloned().filter(|_| self.takes_pins()) else { return };
        // What the screen shows is the preview, where there is one.
        let preview = self.preview().map(|preview| (self.document.frame(), &*preview.embedding));
        let (frame, shown) = preview.unwrap_or((outcome.problem.frame, &outcome.step.solution.embedding));
        // New vertices belong to one embedding alone: they cannot be pinned.
        let count = self.model.as_ref().map_or(0, |model| model.mesh().vertex_count());
        let fresh = vertices.iter().filter(|v| v.index() < count && !self.document.targets.contains_key(v));
        let place = |vertex: &VertexId| shown.get(vertex.index()).copied();
        let pin = |&vertex: &VertexId| Command::SetPin {
            vertex,
            target: place(&vertex).map(|z| Target::fixed(frame.uv_from_plane(z))),
        };
        let commands: Vec<Command> = fresh.map(pin).collect();
        self.edit(commands);
    }

    /// Pins a vertex, or places its pin anew.
    pub(super) fn place(&mut self, vertex: VertexId, target: Target) {
        let count = self.model.as_ref().map_or(0, |model| model.mesh().vertex_count());
        if vertex.index() < count
            && target.uv.is_finite()
            && target.hold.invalid_weight().is_none()
            && self.takes_pins()
        {
            self.edit(vec![Command::SetPin { vertex, target: Some(target) }]);
        }
    }

    /// Moves pins as part of a drag. Where one of them is a gauge pin, all of those become the user's first.
    pub(super) fn move_pins(&mut self, moves: &[(VertexId, DVec2)]) {
        let is_users = |(vertex, _): &(VertexId, DVec2)| self.document.targets.contains_key(vertex);
        if !moves.iter().all(is_users) {
            // Where the solver chose no gauge, those it has are pins of the user's that are freed by now.
            let Some(outcome) = self.outcome().filter(|outcome| outcome.step.solution.gauge_completed) else { return };
            let adopted = adopted(&self.document, &outcome.step.solution.pins, outcome.problem.frame);
            if !moves.iter().all(|(vertex, _)| adopted.contains_key(vertex)) {
                return;
            }
            let commands = adopted.into_iter().map(|(vertex, target)| Command::SetPin { vertex, target: Some(target) });
            self.history.apply_in_gesture(Command::Together(commands.collect()), &mut self.document);
        }
        let command = |&(vertex, uv): &(VertexId, DVec2)| {
            let before = self.document.targets.get(&vertex).filter(|before| uv.is_finite() && before.uv != uv)?;
            Some(Command::SetPin { vertex, target: Some(Target { uv, ..*before }) })
        };
        let commands: Vec<Command> = moves.iter().filter_map(command).collect();
        if commands.is_empty() {
            return;
        }
        self.history.apply_in_gesture(Command::Together(commands), &mut self.document);
        self.follow(moves);
    }

    /// Holds pins in another way, as an edit of its own.
    pub(super) fn set_hold(&mut self, vertices: &[VertexId], hold: Hold) {
        let commands = self.holds(vertices, hold);
        self.edit(commands);
    }

    /// Holds pins in another way as part of a drag.
    pub(super) fn slide_hold(&mut self, vertices: &[VertexId], hold: Hold) {
        let commands = self.holds(vertices, hold);
        if !commands.is_empty() {
            self.history.apply_in_gesture(Command::Together(commands), &mut self.document);
            self.solve();
        }
    }

    fn holds(&self, vertices: &[VertexId], hold: Hold) -> Vec<Command> {
        if hold.invalid_weight().is_some() {
            return Vec::new();
        }
        let command = |&vertex: &VertexId| {
            let before = self.document.targets.get(&vertex).filter(|before| before.hold != hold)?;
            Some(Command::SetPin { vertex, target: Some(Target { hold, ..*before }) })
        };
        vertices.iter().filter_map(command).collect()
    }

    /// Frees vertices.
    pub(super) fn unpin(&mut self, vertices: &[VertexId]) {
        let pinned = vertices.iter().filter(|v| self.document.targets.contains_key(v));
        let commands: Vec<Command> = pinned.map(|&vertex| Command::SetPin { vertex, target: None }).collect();
        self.edit(commands);
    }

    /// Carries out edits that are one for the user, and solves.
    pub(super) fn edit(&mut self, mut commands: Vec<Command>) {
        let command = match commands.len() {
            0 => return,
            1 => commands.remove(0),
            _ => Command::Together(commands),
        };
        if self.history.apply(command, &mut self.document) {
            self.solve();
        }
    }

    /// Says why where the method takes no pins.
    pub(super) fn takes_pins(&mut self) -> bool {
        if self.document.settings.method.uses_pins() {
            return true;
        }
        let text = "a convex boundary takes no pins: every boundary vertex has its place".to_owned();
        self.fail(Place::Embedding, text, Some("choose another method to pin vertices"));
        false
    }
}

/// The gauge pins as pins of the user's, each where it lies; the user's own stay what they are.
fn adopted(document: &Document, in_force: &Pins, frame: PictureFrame) -> Targets {
    let fresh = in_force.iter().filter(|(vertex, _)| !document.targets.contains_key(vertex));
    fresh.map(|(&vertex, pin)| (vertex, Target::fixed(frame.uv_from_plane(pin.target)))).collect()
}
