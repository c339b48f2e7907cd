//! How an edit is taken back.

use std::collections::BTreeSet;

use super::past::Past;
use super::{Command, Document};
use freebound_core::mesh::VertexId;

/// Undo and redo stacks. Edits of one gesture, such as a drag, are one step.
#[derive(Debug, Default)]
pub struct History {
    undo: Vec<Edit>,
    redo: Vec<Edit>,
    /// The gesture whose edits the last step collects.
    gesture: Option<Gesture>,
    /// What could be repeated when the gesture began: it can be again where the gesture comes to nothing.
    redo_before: Vec<Edit>,
    /// How far a person has taken the document's run, step by step: as far as this step of it; 0 where nobody did.
    taken_to: usize,
    /// What was solved for the documents that it leads to.
    past: Past,
}

/// A step of the history.
#[derive(Debug)]
struct Edit {
    command: Command,
    /// How far the run was taken of the document that the command leads to.
    taken_to: usize,
}

/// What a gesture edits. Two gestures of different kinds never share a step, even where the end of the first was missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gesture {
    Pins,
    Settings,
}

impl Gesture {
    fn of(command: &Command) -> Self {
        if sets_settings(command) { Self::Settings } else { Self::Pins }
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
        self.undo.push(Edit { command: inverse, taken_to: std::mem::take(&mut self.taken_to) });
        self.redo.clear();
        true
    }

    /// Changes the document together with the last step, which takes this back too: no step of its own. One that changes
    /// nothing any more is dropped.
    pub(super) fn amend(&mut self, command: Command, document: &mut Document) {
        let inverse = command.apply(document);
        if let Some(edit) = self.undo.last_mut() {
            edit.join(inverse);
        }
        if self.gesture.is_none() {
            self.drop_idle_step(document);
        }
    }

    /// Applies an edit that belongs to a gesture: until the gesture ends, edits share one step.
    pub fn apply_in_gesture(&mut self, command: Command, document: &mut Document) {
        let gesture = Gesture::of(&command);
        let inverse = command.apply(document);
        match self.undo.last_mut() {
            Some(edit) if self.gesture == Some(gesture) => edit.join(inverse),
            _ => {
                self.redo_before = std::mem::take(&mut self.redo);
                self.undo.push(Edit { command: inverse, taken_to: std::mem::take(&mut self.taken_to) });
            }
        }
        self.gesture = Some(gesture);
    }

    /// Whether a gesture has edited the document and has not ended.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Marks the end of a gesture: the next edit starts a new step. A gesture that ended where it began is none.
    pub fn end_gesture(&mut self, document: &mut Document) {
        let Some(gesture) = self.gesture.take() else { return };
        if gesture == Gesture::Settings {
            self.take_back_relaxed(document);
        }
        if self.drop_idle_step(document) {
            self.redo = std::mem::take(&mut self.redo_before);
        }
        self.redo_before.clear();
    }

    /// Gives back the relaxing that a slider has dropped which came back to where it was.
    fn take_back_relaxed(&self, document: &mut Document) {
        let Some(edit) = self.undo.last() else { return };
        let mut before = document.clone();
        drop(edit.command.clone().apply(&mut before));
        if before.settings == document.settings {
            document.relaxed = before.relaxed;
        }
    }

    /// Drops the last step where it leads to the document as it is. Returns whether it did.
    fn drop_idle_step(&mut self, document: &Document) -> bool {
        let is_idle = self.undo.last().is_some_and(|edit| {
            let mut before = document.clone();
            drop(edit.command.clone().apply(&mut before));
            before == *document
        });
        if let Some(edit) = self.undo.pop_if(|_| is_idle) {
            self.taken_to = edit.taken_to;
        }
        is_idle
    }

    /// Takes back the gesture that has not ended, for good. Returns whether there was one.
    pub fn give_up_gesture(&mut self, document: &mut Document) -> bool {
        if self.gesture.take().is_none() {
            return false;
        }
        if let Some(edit) = self.undo.pop() {
            drop(edit.command.apply(document));
            self.taken_to = edit.taken_to;
        }
        self.redo = std::mem::take(&mut self.redo_before);
        true
    }

    /// How far a person has taken the document's run, step by step: as far as this step of it; 0 where nobody did.
    pub(super) fn taken_to(&self) -> usize {
        self.taken_to
    }

    /// Remembers how far. It is no edit: it is forgotten with the next one, and comes back where that is taken back.
    pub(super) fn set_taken_to(&mut self, step: usize) {
        self.taken_to = step;
    }

    /// How many steps there are to take back.
    pub fn depth(&self) -> usize {
        self.undo.len()
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
        replay([&mut self.undo, &mut self.redo], document, &mut self.taken_to)
    }

    /// Repeats the last step taken back. Returns whether there was one.
    pub fn redo(&mut self, document: &mut Document) -> bool {
        self.end_gesture(document);
        replay([&mut self.redo, &mut self.undo], document, &mut self.taken_to)
    }

    /// Solutions of the documents that it leads to.
    pub(super) fn past_mut(&mut self) -> &mut Past {
        &mut self.past
    }
}

impl Edit {
    /// Takes a later inverse in.
    fn join(&mut self, later: Command) {
        let earlier = std::mem::replace(&mut self.command, Command::Together(Vec::new()));
        self.command = joined(later, earlier);
    }
}

/// Two inverses as one. What sets the same things again is dropped: only the state before the first of them matters.
fn joined(later: Command, earlier: Command) -> Command {
    let earlier = parts(earlier);
    let vertex_of = |command: &Command| if let Command::SetPin { vertex, .. } = command { Some(*vertex) } else { None };
    let vertices: BTreeSet<VertexId> = earlier.iter().filter_map(vertex_of).collect();
    let has_settings = earlier.iter().any(sets_settings);
    let has_rounds = earlier.iter().any(|command| matches!(command, Command::SetRelaxed(_)));
    let is_new = |command: &Command| match command {
        Command::SetPin { vertex, .. } => !vertices.contains(vertex),
        Command::SetSettings(_) => !has_settings,
        Command::SetRelaxed(_) => !has_rounds,
        _ => true,
    };
    let mut commands: Vec<Command> = parts(later).into_iter().filter(is_new).collect();
    commands.extend(earlier);
    if commands.len() == 1 { commands.remove(0) } else { Command::Together(commands) }
}

/// Whether a command chooses method and weights, alone or together with others.
fn sets_settings(command: &Command) -> bool {
    match command {
        Command::SetSettings(_) => true,
        Command::Together(commands) => commands.iter().any(sets_settings),
        _ => false,
    }
}

/// A command's single edits, in their order.
fn parts(command: Command) -> Vec<Command> {
    match command {
        Command::Together(commands) => commands.into_iter().flat_map(parts).collect(),
        single => vec![single],
    }
}

fn replay([from, to]: [&mut Vec<Edit>; 2], document: &mut Document, taken_to: &mut usize) -> bool {
    let Some(edit) = from.pop() else { return false };
    let command = edit.command.apply(document);
    to.push(Edit { command, taken_to: std::mem::replace(taken_to, edit.taken_to) });
    true
}
