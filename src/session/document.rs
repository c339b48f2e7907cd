//! What the user edits, and how an edit is taken back.

use glam::DVec2;

use crate::mesh::VertexId;
use crate::solver::{Pins, Settings};

/// What the user edits. Small: the mesh itself is immutable and kept elsewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The user's pins, in the plane of the embedding.
    pub pins: Pins,
    /// Method and weights.
    pub settings: Settings,
}

impl Document {
    /// Whether a run of these settings and pins is a run of this document: a convex boundary takes no pins.
    pub(super) fn is_solved_by(&self, settings: &Settings, pins: &Pins) -> bool {
        self.settings == *settings && (!settings.method.uses_pins() || self.pins == *pins)
    }
}

/// One undoable edit.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Pins `vertex` at `target`, or frees it when `target` is `None`.
    SetPin {
        /// The vertex to pin or free.
        vertex: VertexId,
        /// Its prescribed position in the plane of the embedding.
        target: Option<DVec2>,
    },
    /// Chooses method and weights.
    SetSettings(Settings),
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
                    Some(position) => document.pins.insert(vertex, position),
                    None => document.pins.remove(&vertex),
                };
                Self::SetPin { vertex, target: before }
            }
            Self::SetSettings(settings) => Self::SetSettings(std::mem::replace(&mut document.settings, settings)),
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
    /// Applies an edit as a step of its own.
    pub fn apply(&mut self, command: Command, document: &mut Document) {
        self.end_gesture();
        self.undo.push(command.apply(document));
        self.redo.clear();
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
            _ => self.undo.push(inverse),
        }
        self.gesture = Some(gesture);
        self.redo.clear();
    }

    /// Whether a gesture has edited the document and has not ended.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Marks the end of a gesture: the next edit starts a new step.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// Takes back the gesture that has not ended, for good. Returns whether there was one.
    pub fn give_up_gesture(&mut self, document: &mut Document) -> bool {
        if self.gesture.take().is_none() {
            return false;
        }
        if let Some(command) = self.undo.pop() {
            drop(command.apply(document));
        }
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
        self.end_gesture();
        replay(&mut self.undo, &mut self.redo, document)
    }

    /// Repeats the last step taken back. Returns whether there was one.
    pub fn redo(&mut self, document: &mut Document) -> bool {
        self.end_gesture();
        replay(&mut self.redo, &mut self.undo, document)
    }
}

/// Two inverses as one. What sets the same thing again is dropped: only the state before the gesture matters.
fn joined(later: Command, earlier: Command) -> Command {
    match (&later, &earlier) {
        (Command::SetPin { vertex: a, .. }, Command::SetPin { vertex: b, .. }) if a == b => earlier,
        (Command::SetPin { vertex, .. }, Command::Together(commands))
            if commands.iter().any(|c| matches!(c, Command::SetPin { vertex: v, .. } if v == vertex)) =>
        {
            earlier
        }
        (Command::SetSettings(_), Command::SetSettings(_)) => earlier,
        _ => Command::Together(vec![later, earlier]),
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
    use super::*;
    use crate::solver::{Family, Method};

    fn pin(vertex: u32, x: f64) -> Command {
        Command::SetPin { vertex: VertexId::new(vertex), target: Some(DVec2::new(x, 0.0)) }
    }

    #[test]
    fn a_drag_is_one_undo_step() {
        let (mut history, mut document) = (History::default(), Document::default());
        for x in [0.0, 0.5, 1.0] {
            history.apply_in_gesture(pin(7, x), &mut document);
        }
        history.end_gesture();

        assert!(history.undo(&mut document));
        assert_eq!(document, Document::default());
        assert!(!history.can_undo());
        assert!(history.redo(&mut document));
        assert_eq!(document.pins[&VertexId::new(7)], DVec2::X);
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
    fn a_slide_and_a_drag_are_two_undo_steps() {
        let (mut history, mut document) = (History::default(), Document::default());
        let chosen = Settings::new(Method::Levy, Family::MeanValue);
        history.apply_in_gesture(Command::SetSettings(chosen), &mut document);
        history.apply_in_gesture(pin(7, 0.5), &mut document);
        history.undo(&mut document);
        assert_eq!(document, Document { settings: chosen, ..Document::default() });
    }

    #[test]
    fn two_drags_are_two_undo_steps() {
        let (mut history, mut document) = (History::default(), Document::default());
        history.apply_in_gesture(pin(7, 0.5), &mut document);
        history.end_gesture();
        history.apply_in_gesture(pin(7, 1.0), &mut document);
        history.undo(&mut document);
        assert_eq!(document.pins[&VertexId::new(7)], DVec2::new(0.5, 0.0));
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
