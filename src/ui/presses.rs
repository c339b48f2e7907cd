//! Every press counts, however slow the frames are. egui looks once in a pass where the pointer is and which modifiers
//! are held, at the end of all events that have come in; a click that began and ended since the last frame, or two keys,
//! would be taken for one another. So the events are handed over in batches, each in a pass of its own:
//!
//! ```text
//! moves, press │ moves │ release │ │ key with its text, and as it repeats │ │ another key │ │ pasted, text, key
//! ```
//!
//! A pass without events follows each click and each key: what it has opened is shown first, and has the keyboard then.
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
    /// Whether the next batch is empty, after a click or a key.
    pauses: bool,
}

/// The events of a pass.
#[derive(Default)]
struct Batch {
    events: Vec<Event>,
    has_moved: bool,
    /// The key that is pressed in it.
    chord: Option<Chord>,
}

/// A key that is pressed.
struct Chord {
    key: Key,
    modifiers: Modifiers,
    is_down: bool,
    /// Whether its text may come.
    types: bool,
}

impl Batch {
    /// Whether an event can be handed over with those before it.
    fn has_room_for(&self, event: &Event) -> bool {
        let Some(chord) = &self.chord else {
            return !self.has_moved || !matches!(event, Event::PointerButton { pressed: false, .. });
        };
        match event {
            // A key that repeats is pressed again before it was let go.
            &Event::Key { key, pressed: true, modifiers, .. } => {
                chord.is_down && (key, modifiers) == (chord.key, chord.modifiers) && !is_for_focus(key)
            }
            Event::Key { pressed: false, .. } | Event::ModifiersChanged(_) => true,
            Event::Text(_) => chord.types,
            _ => false,
        }
    }

    fn add(&mut self, event: Event) {
        match (&event, &mut self.chord) {
            (Event::PointerMoved(_), _) => self.has_moved = true,
            (&Event::Key { key, pressed: true, modifiers, .. }, chord) => {
                let types = !(modifiers.ctrl || modifiers.command);
                *chord = Some(Chord { key, modifiers, is_down: true, types });
            }
            (&Event::Key { key, .. }, Some(chord)) if key == chord.key => (chord.is_down, chord.types) = (false, false),
            (Event::Text(_), Some(chord)) => chord.types = false,
            _ => {}
        }
        self.events.push(event);
    }
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
        let mut batch = Batch::default();
        if std::mem::take(&mut self.pauses) {
            return batch.events;
        }
        while let Some(event) = self.waiting.pop_front() {
            match event {
                Event::PointerButton { pos, pressed: false, .. } if !batch.has_moved && self.pointer != Some(pos) => {
                    // The way to where it was let go, which may have no event of its own.
                    self.waiting.push_front(event);
                    self.waiting.push_front(Event::PointerMoved(pos));
                }
                event if !batch.has_room_for(&event) => {
                    self.waiting.push_front(event);
                    break;
                }
                Event::PointerButton { pos, button, pressed, modifiers } => {
                    self.pointer = Some(pos);
                    let modifiers = self.pressed_with.filter(|_| !pressed).unwrap_or(modifiers);
                    self.pressed_with = pressed.then_some(modifiers);
                    let is_other = modifiers != self.modifiers;
                    batch.events.extend(is_other.then_some(Event::ModifiersChanged(modifiers)));
                    batch.events.push(Event::PointerButton { pos, button, pressed, modifiers });
                    if is_other {
                        self.waiting.push_front(Event::ModifiersChanged(self.modifiers));
                    }
                    self.pauses = !pressed;
                    return batch.events;
                }
                event => {
                    self.note(&event);
                    batch.add(event);
                }
            }
        }
        self.pauses = batch.chord.is_some();
        batch.events
    }

    /// Remembers pointer and modifiers as they are after an event.
    fn note(&mut self, event: &Event) {
        match event {
            Event::PointerMoved(pos) => self.pointer = Some(*pos),
            Event::PointerGone => self.pointer = None,
            Event::ModifiersChanged(modifiers) => self.modifiers = *modifiers,
            Event::WindowFocused(false) => (self.modifiers, self.pressed_with) = Default::default(),
            _ => {}
        }
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
