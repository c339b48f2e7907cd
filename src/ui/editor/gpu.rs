//! Connection to egui's context and the graphics card.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;

use super::frames::Frames;
use crate::session::Wake;
use crate::ui::presses::Presses;

/// Work shorter than this shows no progress, which would only flicker.
const PATIENCE: Duration = Duration::from_millis(250);

/// The window and its graphics card.
#[derive(Debug)]
pub struct Gpu {
    context: egui::Context,
    is_there: bool,
    /// Last title sent to the window.
    title: String,
    /// Start of the current background work.
    busy_since: Option<Instant>,
    is_quitting: bool,
}

impl Gpu {
    pub(super) fn new(context: &egui::Context) -> Self {
        Presses::install(context);
        Frames::install(context);
        Self { context: context.clone(), is_there: false, title: String::new(), busy_since: None, is_quitting: false }
    }

    pub(in crate::ui) fn context(&self) -> &egui::Context {
        &self.context
    }

    /// True if key or button presses wait for the next pass.
    pub fn has_presses_waiting(&self) -> bool {
        Presses::are_waiting(&self.context)
    }

    /// Time of the window's clock, seconds.
    pub(in crate::ui) fn now(&self) -> f64 {
        self.context.input(|input| input.time)
    }

    /// Duration of the last measured frame, seconds.
    pub(super) fn frame_seconds(&self) -> f64 {
        Frames::seconds(&self.context)
    }

    /// Callback for background work that has news: requests a repaint.
    pub(in crate::ui) fn wake(&self) -> Wake {
        let context = self.context.clone();
        Arc::new(move || context.request_repaint())
    }

    pub(in crate::ui) fn has_gpu(&self) -> bool {
        self.is_there
    }

    pub(crate) fn use_gpu(&mut self) {
        self.is_there = true;
    }

    pub(in crate::ui) fn set_title(&mut self, title: String) {
        if self.title != title {
            self.context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    pub fn is_quitting(&self) -> bool {
        self.is_quitting
    }

    pub(in crate::ui) fn quit(&mut self) {
        self.is_quitting = true;
    }

    /// Records whether background work is running. Call once per frame.
    pub(in crate::ui) fn note_work(&mut self, is_busy: bool, now: Instant) {
        self.busy_since = if is_busy { self.busy_since.or(Some(now)) } else { None };
    }

    /// True if background work has run long enough for its progress to show.
    pub(super) fn is_busy_for_long(&self) -> bool {
        self.busy_since.is_some_and(|since| since.elapsed() >= PATIENCE)
    }
}
