//! Duration of a frame: the time until the next frame, if that was requested at once. A later frame follows a key
//! press, news from the background or a timer. Its start says nothing about the duration of the frame before.
//!
//! `cpu_usage` of eframe excludes the wait for the graphics card, so that a slow card would seem fast.

use eframe::egui;
use egui::{FullOutput, ViewportId};

#[derive(Debug, Default)]
pub(super) struct Frames {
    /// Start of the latest frame, seconds of the window's clock.
    began: f64,
    /// True if the latest frame requested another frame at once.
    asks_at_once: bool,
    /// Duration of the last measured frame, seconds.
    seconds: f64,
}

impl Frames {
    /// Starts to measure the frames of a window.
    pub(super) fn install(context: &egui::Context) {
        context.add_plugin(Self::default());
    }

    /// Duration of the last measured frame, seconds; 0 before the first measurement.
    pub(super) fn seconds(context: &egui::Context) -> f64 {
        context.plugin_opt::<Self>().map_or(0.0, |frames| frames.lock().seconds)
    }
}

impl egui::Plugin for Frames {
    fn debug_name(&self) -> &'static str {
        "frames"
    }

    fn on_begin_pass(&mut self, ui: &mut egui::Ui) {
        let now = ui.input(|input| input.time);
        // All passes of a frame have one time.
        if now > self.began {
            if self.asks_at_once {
                self.seconds = now - self.began;
            }
            self.began = now;
        }
    }

    fn output_hook(&mut self, _: &egui::Context, output: &mut FullOutput) {
        let window = output.viewport_output.get(&ViewportId::ROOT);
        self.asks_at_once = window.is_some_and(|window| window.repaint_delay.is_zero());
    }
}
