//! How an edit is taken back.

use std::collections::BTreeSet;

use super::{Command, Document};
use crate::mesh::VertexId;

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
    let vertex_of = |command: &Command| if let Command::SetPin { vertex, .. } = command { Some(*vertex) } else { None };
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

/// A command's single edits, in their order.
fn parts(command: Command) -> Vec<Command> {
    match command {
        Command::Together(commands) => commands.into_iter().flat_map(parts).collect(),
        single => vec![single],
    }
}

fn replay(from: &mut Vec<Command>, to: &mut Vec<Command>, document: &mut Document) -> bool {
    let Some(command) = from.pop() else { return false };
    to.push(command.apply(document));
    true
}
