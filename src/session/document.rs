//! What the user edits, and how an edit is taken back.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{Outcome, PictureFile, Problem};
use crate::examples::Example;
use crate::geom::{PictureFrame, VAxis};
use crate::io::{Target, Targets, hard_targets, pins_in_plane};
use crate::mesh::VertexId;
use crate::solver::{GaugeSize, Pins, Settings};

/// What the user edits. Small: mesh and pictures are immutable and kept elsewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The user's pins by their targets.
    pub targets: Targets,
    /// Method and weights.
    pub settings: Settings,
    /// The picture that is mapped on the mesh.
    pub picture: Option<Arc<PictureFile>>,
    /// Width over height of a picture that is not at hand.
    pub aspect: Option<f64>,
    /// Where v = 0 is on the picture.
    pub v_axis: VAxis,
    /// Whether the mesh's faces are turned around.
    pub faces_turned: bool,
}

impl Document {
    /// A built-in mesh's landmarks as constraints, on the picture that belongs to it.
    pub fn of_example(example: Example) -> Self {
        let landmarks = example.landmarks().into_iter();
        Self {
            targets: hard_targets(landmarks.map(|landmark| (landmark.vertex, landmark.target.into()))),
            picture: PictureFile::of_example(example).map(Arc::new),
            ..Self::default()
        }
    }

    /// How texture coordinates lie in the plane where the mesh is flattened.
    pub fn frame(&self) -> PictureFrame {
        let aspect = self.picture.as_ref().map(|picture| picture.aspect()).or(self.aspect);
        PictureFrame { aspect: aspect.unwrap_or(1.0), v_axis: self.v_axis }
    }

    /// The settings of a run: where there is a picture, the embedding is made to lie on it.
    pub fn run_settings(&self) -> Settings {
        let [low, high] = self.frame().corners();
        let has_picture = self.picture.is_some() || self.aspect.is_some();
        let size = if has_picture { GaugeSize::Within { low, high } } else { GaugeSize::TrueArea };
        Settings { size, ..self.settings }
    }

    /// What a run of it is to solve.
    pub fn problem(&self) -> Problem {
        Problem { settings: self.run_settings(), frame: self.frame(), targets: self.targets.clone() }
    }

    /// The user's pins in that plane.
    pub fn pins(&self) -> Pins {
        pins_in_plane(&self.targets, self.frame())
    }

    /// Whether an outcome is one of this document: a convex boundary takes no pins.
    pub(super) fn is_solved_in(&self, outcome: &Outcome) -> bool {
        let Problem { settings, frame, targets } = &outcome.problem;
        let has_targets = !settings.method.uses_pins() || *targets == self.targets;
        has_targets && *frame == self.frame() && *settings == self.run_settings()
    }

    /// Whether a run of these settings and pins (in the plane) is a run of this document: a convex boundary takes no
    /// pins.
    pub(super) fn is_solved_by(&self, settings: &Settings, pins: &Pins) -> bool {
        self.run_settings() == *settings && (!settings.method.uses_pins() || self.pins() == *pins)
    }
}

/// One undoable edit.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Pins `vertex`, or frees it when `target` is `None`.
    SetPin {
        /// The vertex to pin or free.
        vertex: VertexId,
        /// Its target.
        target: Option<Target>,
    },
    /// Chooses method and weights.
    SetSettings(Settings),
    /// Chooses the picture.
    SetPicture(Option<Arc<PictureFile>>),
    /// Chooses where v = 0 is.
    SetVAxis(VAxis),
    /// Turns the mesh's faces around, or back.
    SetFacesTurned(bool),
    /// Several edits that are one for the user.
    Together(Vec<Command>),
}

impl Command {
    /// Carries out the edit and returns the command that takes it back.
    #[must_use = "dropping the inverse makes the edit impossible to undo"]
    pub fn apply(self, document: &mut Document) -> Self {
        match self {
            Self::SetPin { vertex, target } => {
                let before = match target {
                    Some(target) => document.targets.insert(vertex, target),
                    None => document.targets.remove(&vertex),
                };
                Self::SetPin { vertex, target: before }
            }
            Self::SetSettings(settings) => Self::SetSettings(std::mem::replace(&mut document.settings, settings)),
            Self::SetPicture(picture) => Self::SetPicture(std::mem::replace(&mut document.picture, picture)),
            Self::SetVAxis(v_axis) => Self::SetVAxis(std::mem::replace(&mut document.v_axis, v_axis)),
            Self::SetFacesTurned(turned) => Self::SetFacesTurned(std::mem::replace(&mut document.faces_turned, turned)),
            Self::Together(commands) => {
                let mut inverses: Vec<Self> = commands.into_iter().map(|command| command.apply(document)).collect();
                inverses.reverse();
                Self::Together(inverses)
            }
        }
    }
}

/// Undo and redo stacks. Edits of one gesture, such as a drag, are one step.
#[derive(Debug, Default)]
pub struct History {
    undo: Vec<Command>,
    redo: Vec<Command>,
    /// The gesture whose edits the last step collects.
    gesture: Option<Gesture>,
    /// What could be repeated when the gesture began: it can be again where the gesture comes to nothing.
    redo_before: Vec<Command>,
}

/// What a gesture edits. Two gestures of different kinds never share a step, even where the end of the first was missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gesture {
    Pins,
    Settings,
}

impl Gesture {
    fn of(command: &Command) -> Self {
        if matches!(command, Command::SetSettings(_)) { Self::Settings } else { Self::Pins }
    }
}

impl History {
    /// Applies an edit as a step of its own. Returns whether it changed anything; one that did not is no step.
    pub fn apply(&mut self, command: Command, document: &mut Document) -> bool {
        self.end_gesture(document);
        let before = document.clone();
        let inverse = command.apply(document);
        if *document == before {
            return false;
        }
        self.undo.push(inverse);
        self.redo.clear();
        true
    }

    /// Applies an edit that belongs to a gesture: until the gesture ends, edits share one step.
    pub fn apply_in_gesture(&mut self, command: Command, document: &mut Document) {
        let gesture = Gesture::of(&command);
        let inverse = command.apply(document);
        match self.undo.last_mut() {
            Some(step) if self.gesture == Some(gesture) => {
                let earlier = std::mem::replace(step, Command::Together(Vec::new()));
                *step = joined(inverse, earlier);
            }
            _ => {
                self.redo_before = std::mem::take(&mut self.redo);
                self.undo.push(inverse);
            }
        }
        self.gesture = Some(gesture);
    }

    /// Whether a gesture has edited the document and has not ended.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Marks the end of a gesture: the next edit starts a new step. A gesture that ended where it began is none.
    pub fn end_gesture(&mut self, document: &Document) {
        if self.gesture.take().is_none() {
            return;
        }
        if let Some(step) = self.undo.last() {
            let mut before = document.clone();
            drop(step.clone().apply(&mut before));
            if before == *document {
                self.undo.pop();
                self.redo = std::mem::take(&mut self.redo_before);
            }
        }
        self.redo_before.clear();
    }

    /// Takes back the gesture that has not ended, for good. Returns whether there was one.
    pub fn give_up_gesture(&mut self, document: &mut Document) -> bool {
        if self.gesture.take().is_none() {
            return false;
        }
        if let Some(command) = self.undo.pop() {
            drop(command.apply(document));
        }
        self.redo = std::mem::take(&mut self.redo_before);
        true
    }

    /// Whether there is a step to take back.
    pub fn can_undo(&self) -> bool {
        !self.undo.is_empty()
    }

    /// Whether there is a step to repeat.
    pub fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    /// Takes back the last step. Returns whether there was one.
    pub fn undo(&mut self, document: &mut Document) -> bool {
        self.end_gesture(document);
        replay(&mut self.undo, &mut self.redo, document)
    }

    /// Repeats the last step taken back. Returns whether there was one.
    pub fn redo(&mut self, document: &mut Document) -> bool {
        self.end_gesture(document);
        replay(&mut self.redo, &mut self.undo, document)
    }
}

/// Two inverses as one. What sets the same things again is dropped: only the state before the gesture matters.
fn joined(later: Command, earlier: Command) -> Command {
    let earlier = parts(earlier);
    let vertices: BTreeSet<VertexId> = earlier.iter().filter_map(vertex_of).collect();
    let sets_settings = earlier.iter().any(|command| matches!(command, Command::SetSettings(_)));
    let is_new = |command: &Command| match command {
        Command::SetPin { vertex, .. } => !vertices.contains(vertex),
        Command::SetSettings(_) => !sets_settings,
        _ => true,
    };
    let mut commands: Vec<Command> = parts(later).into_iter().filter(is_new).collect();
    commands.extend(earlier);
    if commands.len() == 1 { commands.remove(0) } else { Command::Together(commands) }
}

fn vertex_of(command: &Command) -> Option<VertexId> {
    match command {
        Command::SetPin { vertex, .. } => Some(*vertex),
        _ => None,
    }
}

/// A command's single edits, in their order.
fn parts(command: Command) -> Vec<Command> {
    match command {
        Command::Together(commands) => commands.into_iter().flat_map(parts).collect(),
        single => vec![single],
    }
}

fn replay(from: &mut Vec<Command>, to: &mut Vec<Command>, document: &mut Document) -> bool {
    let Some(command) = from.pop() else {
        return false;
    };
    to.push(command.apply(document));
    true
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::solver::{Family, Method};

    fn pin(vertex: u32, x: f64) -> Command {
        Command::SetPin { vertex: VertexId::new(vertex), target: Some(Target::hard(DVec2::new(x, 0.0))) }
    }

    #[test]
    fn a_drag_is_one_undo_step() {
        let (mut history, mut document) = (History::default(), Document::default());
        for x in [0.0, 0.5, 1.0] {
            history.apply_in_gesture(pin(7, x), &mut document);
        }
        history.end_gesture(&document);

        assert!(history.undo(&mut document));
        assert_eq!(document, Document::default());
        assert!(!history.can_undo());
        assert!(history.redo(&mut document));
        assert_eq!(document.targets[&VertexId::new(7)].uv, DVec2::X);
    }

    #[test]
    fn a_drag_that_begins_by_pinning_several_is_one_undo_step() {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply_in_gesture(Command::Together(vec![pin(1, 0.0), pin(2, 1.0)]), &mut document);
        for x in [0.5, 0.75] {
            history.apply_in_gesture(pin(1, x), &mut document);
        }
        history.undo(&mut document);
        assert_eq!(document, Document::default());
        assert!(!history.can_undo());
    }

    #[test]
    fn a_drag_that_is_given_up_leaves_no_trace() {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply(pin(3, 1.0), &mut document);
        let before = document.clone();
        for x in [0.0, 0.5] {
            history.apply_in_gesture(pin(7, x), &mut document);
        }
        assert!(history.give_up_gesture(&mut document));
        assert_eq!(document, before);
        assert!(!history.can_redo());
        assert!(!history.give_up_gesture(&mut document), "nothing is under way any more");
        assert_eq!(document, before);
    }

    #[test]
    fn a_drag_that_comes_to_nothing_leaves_what_could_be_redone() {
        for gives_up in [true, false] {
            let (mut history, mut document) = (History::default(), Document::default());
            history.apply(pin(3, 1.0), &mut document);
            history.apply(pin(3, 2.0), &mut document);
            history.undo(&mut document);
            for x in [0.0, 1.0] {
                history.apply_in_gesture(pin(3, x), &mut document);
            }
            if gives_up {
                history.give_up_gesture(&mut document);
            } else {
                history.end_gesture(&document);
            }
            assert!(history.redo(&mut document));
            assert_eq!(document.targets[&VertexId::new(3)].uv.x.to_bits(), 2.0_f64.to_bits());
        }
    }

    #[test]
    fn a_gesture_over_many_pins_stays_one_flat_step() {
        let (mut history, mut document) = (History::default(), Document::default());
        for round in 0..100_u32 {
            history.apply_in_gesture(pin(round % 7, f64::from(round)), &mut document);
        }
        let Some(Command::Together(commands)) = history.undo.last() else { panic!("one step: {:?}", history.undo) };
        assert_eq!(commands.len(), 7);
        history.undo(&mut document);
        assert_eq!(document, Document::default());
    }

    #[test]
    fn a_slide_and_a_drag_are_two_undo_steps() {
        let (mut history, mut document) = (History::default(), Document::default());
        let chosen = Settings::new(Method::Levy, Family::MeanValue);
        history.apply_in_gesture(Command::SetSettings(chosen), &mut document);
        history.apply_in_gesture(pin(7, 0.5), &mut document);
        history.undo(&mut document);
        assert_eq!(document, Document { settings: chosen, ..Document::default() });
    }

    #[test]
    fn what_changes_nothing_is_no_undo_step() {
        let (mut history, mut document) = (History::default(), Document::default());
        assert!(history.apply(pin(7, 0.5), &mut document));
        assert!(!history.apply(pin(7, 0.5), &mut document));
        for x in [1.0, 0.5] {
            history.apply_in_gesture(pin(7, x), &mut document);
        }
        history.end_gesture(&document);
        assert!(history.undo(&mut document));
        assert!(!history.can_undo() && document == Document::default());
    }

    #[test]
    fn two_drags_are_two_undo_steps() {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply_in_gesture(pin(7, 0.5), &mut document);
        history.end_gesture(&document);
        history.apply_in_gesture(pin(7, 1.0), &mut document);
        history.undo(&mut document);
        assert_eq!(document.targets[&VertexId::new(7)].uv, DVec2::new(0.5, 0.0));
    }

    #[test]
    fn a_new_edit_forgets_what_could_be_redone() {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply(pin(1, 0.0), &mut document);
        history.undo(&mut document);
        history.apply(pin(2, 0.0), &mut document);
        assert!(!history.can_redo());
    }

    #[test]
    fn settings_come_back_too() {
        let (mut history, mut document) = (History::default(), Document::default());
        let chosen = Settings::new(Method::Levy, Family::MeanValue);
        history.apply(Command::SetSettings(chosen), &mut document);
        assert_eq!(document.settings, chosen);
        history.undo(&mut document);
        assert_eq!(document.settings, Settings::default());
    }
}
