//! How long a frame takes: until the next one begins, where that was asked for at once. A frame that comes later, with a
//! press, with news from the background or when it is time, says nothing about the one before it, which had ended long ago.
//!
//! eframe's own number, `cpu_usage`, leaves out the wait for the graphics card: where that is slow, all would seem quick.

use eframe::egui;
use egui::{FullOutput, ViewportId};

#[derive(Debug, Default)]
pub(super) struct Frames {
    /// When the latest frame began, seconds of the window's clock.
    began: f64,
    /// Whether it asked for another one at once.
    asks_at_once: bool,
    /// How long the latest frame took that was measured.
    seconds: f64,
}

impl Frames {
    /// Measures all frames of a window from now on.
    pub(super) fn install(context: &egui::Context) {
        context.add_plugin(Self::default());
    }

    /// How long frames take, seconds, as far as was measured.
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
        // The passes of a frame lie at one time.
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
