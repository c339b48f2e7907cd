//! Every press counts, however slow the frames are. egui looks once in a pass where the pointer is and which modifiers
//! are held, at the end of all events that have come in; a click that began and ended since the last frame, or two keys,
//! would be taken for one another. So the events are handed over in batches, each in a pass of its own:
//!
//! ```text
//! moves, press │ moves │ release │ key, the same key again │ another key
//! ```
//!
//! All passes belong to one frame: only the last one is painted. Moves are never torn apart, so that what waits is
//! bounded by the presses that a person makes.

use std::collections::VecDeque;
use std::num::NonZeroUsize;

use eframe::egui::{self, Event, Key, Modifiers, Pos2};

/// Passes of one frame at most. What is left goes into the next one.
const PASSES: NonZeroUsize = NonZeroUsize::new(16).expect("not zero");

/// Hands over the events.
#[derive(Debug, Default)]
pub(super) struct Presses {
    waiting: VecDeque<Event>,
    /// Where the pointer was at the end of the batch before.
    pointer: Option<Pos2>,
    /// The modifiers that are held by then.
    modifiers: Modifiers,
    /// The modifiers of the press that has not ended: they are those of the click.
    pressed_with: Option<Modifiers>,
    /// Whether the next batch is empty: what a key has opened is shown first, and has the keyboard then.
    pauses: bool,
}

/// A press that is longer is no click, seconds: a slow frame may lie between press and release.
const CLICK_SECONDS: f64 = 10.0;

/// Whether controls take a key once a pass, however often it was pressed.
const fn is_for_focus(key: Key) -> bool {
    use Key::{ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Enter, Space, Tab};
    matches!(key, ArrowDown | ArrowLeft | ArrowRight | ArrowUp | Enter | Space | Tab)
}

impl Presses {
    /// Hands all events of a window over in batches from now on.
    pub(super) fn install(context: &egui::Context) {
        context.add_plugin(Self::default());
        context.options_mut(|options| {
            options.max_passes = PASSES;
            options.input_options.max_click_duration = CLICK_SECONDS;
        });
    }

    /// Whether events wait for the next pass.
    pub(super) fn are_waiting(context: &egui::Context) -> bool {
        context.plugin_opt::<Self>().is_some_and(|presses| !presses.lock().waiting.is_empty())
    }

    /// The events of the next pass.
    fn next_batch(&mut self) -> Vec<Event> {
        let mut batch = Vec::new();
        if std::mem::take(&mut self.pauses) {
            return batch;
        }
        let mut has_moved = false;
        let mut chord: Option<(Key, Modifiers)> = None;
        while let Some(event) = self.waiting.pop_front() {
            match event {
                Event::PointerButton { pos, pressed: false, .. } if !has_moved && self.pointer != Some(pos) => {
                    // The way to where it was let go, which may have no event of its own.
                    self.waiting.push_front(event);
                    self.waiting.push_front(Event::PointerMoved(pos));
                }
                Event::PointerButton { pressed, .. } if chord.is_some() || (has_moved && !pressed) => {
                    self.waiting.push_front(event);
                    self.pauses = chord.is_some();
                    return batch;
                }
                Event::PointerButton { pos, button, pressed, modifiers } => {
                    self.pointer = Some(pos);
                    let modifiers = self.pressed_with.filter(|_| !pressed).unwrap_or(modifiers);
                    self.pressed_with = pressed.then_some(modifiers);
                    let is_other = modifiers != self.modifiers;
                    batch.extend(is_other.then_some(Event::ModifiersChanged(modifiers)));
                    batch.push(Event::PointerButton { pos, button, pressed, modifiers });
                    if is_other {
                        self.waiting.push_front(Event::ModifiersChanged(self.modifiers));
                    }
                    return batch;
                }
                Event::Key { key, pressed: true, modifiers, .. }
                    if chord.is_some_and(|c| c != (key, modifiers) || is_for_focus(key)) =>
                {
                    self.waiting.push_front(event);
                    self.pauses = true;
                    return batch;
                }
                event => {
                    match &event {
                        Event::PointerMoved(pos) => (self.pointer, has_moved) = (Some(*pos), true),
                        Event::PointerGone => self.pointer = None,
                        Event::Key { key, pressed: true, modifiers, .. } => chord = Some((*key, *modifiers)),
                        Event::ModifiersChanged(modifiers) => self.modifiers = *modifiers,
                        Event::WindowFocused(false) => (self.modifiers, self.pressed_with) = Default::default(),
                        _ => {}
                    }
                    batch.push(event);
                }
            }
        }
        batch
    }
}

impl egui::Plugin for Presses {
    fn debug_name(&self) -> &'static str {
        "presses"
    }

    fn input_hook(&mut self, _: &egui::Context, input: &mut egui::RawInput) {
        self.waiting.extend(input.events.drain(..));
        input.events = self.next_batch();
    }

    fn on_end_pass(&mut self, ui: &mut egui::Ui) {
        if !self.waiting.is_empty() {
            ui.ctx().request_discard("events wait");
            ui.ctx().request_repaint();
        }
    }
}
