//! Undo and redo.

use std::collections::BTreeSet;

use super::past::Past;
use super::{Command, Document};
use freebound_core::mesh::VertexId;

/// Undo and redo stacks. Edits of one gesture, such as a drag, are one step.
#[derive(Debug, Default)]
pub struct History {
    undo: Vec<Edit>,
    redo: Vec<Edit>,
    /// Gesture whose edits the last step collects.
    gesture: Option<Gesture>,
    /// Redo stack at the beginning of the gesture. Restored if the gesture changes nothing.
    redo_before: Vec<Edit>,
    /// Index of the step up to which the user took the run by single steps. Default: 0.
    taken_to: usize,
    /// Solutions of the documents in the history.
    past: Past,
}

/// Step of the history.
#[derive(Debug)]
struct Edit {
    command: Command,
    /// Value of `taken_to` for the document that the command leads to.
    taken_to: usize,
}

/// Kind of a gesture. Gestures of different kinds never share a step, even if the end of the first was missed.
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
    /// Applies an edit as a separate step. Returns true if the document changed; otherwise no step is added.
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

    /// Changes the document as part of the last step. The step is dropped if it no longer changes anything.
    pub(super) fn amend(&mut self, command: Command, document: &mut Document) {
        let inverse = command.apply(document);
        if let Some(edit) = self.undo.last_mut() {
            edit.join(inverse);
        }
        if self.gesture.is_none() {
            self.drop_idle_step(document);
        }
    }

    /// Applies an edit of a gesture. All edits of a gesture share one step.
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

    /// True if a gesture has edited the document and has not ended.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Ends the gesture. A gesture without any effect adds no step.
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

    /// Restores the relaxation that a slider dropped, if the slider returned to its former value.
    fn take_back_relaxed(&self, document: &mut Document) {
        let Some(edit) = self.undo.last() else { return };
        let mut before = document.clone();
        drop(edit.command.clone().apply(&mut before));
        if before.settings == document.settings {
            document.relaxed = before.relaxed;
        }
    }

    /// Drops the last step if undoing it would not change the document. Returns true if it was dropped.
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

    /// Reverts the gesture that has not ended, without a redo step. Returns true if there was a gesture.
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

    /// Index of the step up to which the user took the run by single steps, or 0.
    pub(super) fn taken_to(&self) -> usize {
        self.taken_to
    }

    /// Sets the index of the step up to which the user took the run. This is no edit. The next edit resets the index,
    /// and undoing that edit restores it.
    pub(super) fn set_taken_to(&mut self, step: usize) {
        self.taken_to = step;
    }

    /// Number of steps that can be undone.
    pub fn depth(&self) -> usize {
        self.undo.len()
    }

    /// True if there is a step to undo.
    pub fn can_undo(&self) -> bool {
        !self.undo.is_empty()
    }

    /// True if there is a step to redo.
    pub fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    /// Undoes the last step. Returns true if there was one.
    pub fn undo(&mut self, document: &mut Document) -> bool {
        self.end_gesture(document);
        replay([&mut self.undo, &mut self.redo], document, &mut self.taken_to)
    }

    /// Redoes the step that was undone last. Returns true if there was one.
    pub fn redo(&mut self, document: &mut Document) -> bool {
        self.end_gesture(document);
        replay([&mut self.redo, &mut self.undo], document, &mut self.taken_to)
    }

    /// Solutions of the documents in the history.
    pub(super) fn past_mut(&mut self) -> &mut Past {
        &mut self.past
    }
}

impl Edit {
    /// Adds the inverse of a later edit.
    fn join(&mut self, later: Command) {
        let earlier = std::mem::replace(&mut self.command, Command::Together(Vec::new()));
        self.command = joined(later, earlier);
    }
}

/// Joins two inverses. Commands of the later edit that set an item again are dropped, because only its first state
/// matters.
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

/// True if a command sets method and weights, alone or among others.
fn sets_settings(command: &Command) -> bool {
    match command {
        Command::SetSettings(_) => true,
        Command::Together(commands) => commands.iter().any(sets_settings),
        _ => false,
    }
}

/// Single edits of a command, in their order.
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
