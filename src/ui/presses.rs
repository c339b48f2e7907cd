//! Delivery of every press, even if frames are slow. egui reads pointer position and modifiers once in a pass, after
//! all events of that pass. If a click began and ended since the last frame, or two keys were pressed, egui would
//! confuse them. So the events are delivered in batches, each in its own pass:
//!
//! ```text
//! moves, press │ moves │ release │ │ key with its text, and as it repeats │ │ another key │ │ pasted, text, key
//! ```
//!
//! A pass without events follows each click and each key. It shows a popup that the click or key opened, and gives it
//! the focus before the next event.
//!
//! All passes belong to one frame: only the last one is painted. Moves are never split, so the number of waiting
//! events is bounded by the presses of the user.

use std::collections::VecDeque;
use std::num::NonZeroUsize;

use eframe::egui::{self, Event, Key, Modifiers, Pos2};

/// Greatest number of passes in one frame. Remaining events wait for the next frame.
const PASSES: NonZeroUsize = NonZeroUsize::new(16).expect("not zero");

/// Queue of the events.
#[derive(Debug, Default)]
pub(super) struct Presses {
    waiting: VecDeque<Event>,
    /// Position of the pointer after the last batch.
    pointer: Option<Pos2>,
    /// Modifiers held after the last batch.
    modifiers: Modifiers,
    /// Modifiers at the press of the button that is held, which count for the whole click.
    pressed_with: Option<Modifiers>,
    /// True if the next batch is empty, after a click or a key.
    pauses: bool,
}

/// Events of a pass.
#[derive(Default)]
struct Batch {
    events: Vec<Event>,
    has_moved: bool,
    /// Key pressed in the pass.
    chord: Option<Chord>,
}

/// Pressed key.
struct Chord {
    key: Key,
    modifiers: Modifiers,
    is_down: bool,
    /// True if the text of the key may follow.
    types: bool,
}

impl Batch {
    /// True if an event fits into the pass of the events before it.
    fn has_room_for(&self, event: &Event) -> bool {
        let Some(chord) = &self.chord else {
            return !self.has_moved || !matches!(event, Event::PointerButton { pressed: false, .. });
        };
        match event {
            // A repeating key is pressed again before it is released.
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

/// Longest press that counts as a click, seconds. A slow frame may lie between press and release.
const CLICK_SECONDS: f64 = 10.0;

/// True if controls handle a key once a pass, however often it was pressed.
const fn is_for_focus(key: Key) -> bool {
    use Key::{ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Enter, Space, Tab};
    matches!(key, ArrowDown | ArrowLeft | ArrowRight | ArrowUp | Enter | Space | Tab)
}

impl Presses {
    /// Delivers all events of a window in batches from now on.
    pub(super) fn install(context: &egui::Context) {
        context.add_plugin(Self::default());
        context.options_mut(|options| {
            options.max_passes = PASSES;
            options.input_options.max_click_duration = CLICK_SECONDS;
        });
    }

    /// True if events wait for the next pass.
    pub(super) fn are_waiting(context: &egui::Context) -> bool {
        context.plugin_opt::<Self>().is_some_and(|presses| !presses.lock().waiting.is_empty())
    }

    /// Events of the next pass.
    fn next_batch(&mut self) -> Vec<Event> {
        let mut batch = Batch::default();
        if std::mem::take(&mut self.pauses) {
            return batch.events;
        }
        while let Some(event) = self.waiting.pop_front() {
            match event {
                Event::PointerButton { pos, pressed: false, .. } if !batch.has_moved && self.pointer != Some(pos) => {
                    // Move the pointer to the place of release first, which may have no event.
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

    /// Records pointer and modifiers after an event.
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
