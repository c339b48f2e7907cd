//! Marks of a curve: its least and greatest value and powers of ten, beside the plot.

use std::sync::Arc;

use eframe::egui::{self, FontId, Galley, Rect};

use crate::ui::editor::step_curve::ShownCurve;
use crate::ui::theme_of;
use freebound_io::figure::AxisScale;

/// Font size of the marks, points.
const MARKS: f32 = 9.0;

/// Marks at the left of a curve: its greatest and its least value, and whole powers of ten between them, with their
/// heights. Lines at the powers of ten cross the plot; the labels stay outside.
pub(super) struct Marks {
    /// Greatest value, the least if its label differs, and numbers without a place on the scale if there are some.
    ends: Vec<(f64, Arc<Galley>)>,
    powers: Vec<(f64, Arc<Galley>)>,
}

impl Marks {
    /// Marks of a curve. `unplaced` is the height of numbers without a place on the scale, if there are some.
    pub(super) fn new(ui: &egui::Ui, shown: &ShownCurve, unplaced: Option<f64>) -> Self {
        let ink = theme_of(ui).weak_text;
        let laid = |words: String| ui.painter().layout_no_wrap(words, FontId::proportional(MARKS), ink);
        let height = |value: f64| shown.scale.height_of(value).unwrap_or(0.0);
        let (mut ends, mut powers) = (Vec::new(), Vec::new());
        if let Some([least, greatest]) = shown.ends() {
            ends.push((height(greatest), shown.words(greatest)));
            ends.extend(Some((height(least), shown.words(least))).filter(|(_, words)| *words != ends[0].1));
            if shown.scale == AxisScale::Logarithmic {
                powers = powers_within(height(least), height(greatest));
            }
        }
        ends.extend(unplaced.map(|height| (height, "≤ 0".to_owned())));
        Self {
            ends: ends.into_iter().map(|(height, words)| (height, laid(words))).collect(),
            powers: powers.into_iter().map(|power| (f64::from(power), laid(format!("1e{power}")))).collect(),
        }
    }

    /// Width of the labels, points.
    pub(super) fn width(&self) -> f32 {
        let all = self.ends.iter().chain(&self.powers);
        all.map(|(_, words)| words.size().x).fold(0.0, f32::max) + 4.0
    }

    /// Paints the labels from `left` on, and the lines across the plot in `rect`.
    pub(super) fn paint(&self, ui: &egui::Ui, left: f32, rect: Rect, height_on_screen: &dyn Fn(f64) -> f32) {
        let (painter, theme) = (ui.painter(), theme_of(ui));
        let write = |middle: f32, words: &Arc<Galley>| {
            let at = egui::pos2(left, middle - words.size().y / 2.0);
            painter.galley(at, Arc::clone(words), theme.weak_text);
        };
        let half = MARKS / 2.0 + 1.0;
        let mut taken: Vec<f32> = Vec::new();
        for (height, words) in &self.ends {
            // Place the least value below the greatest, even if both are close.
            let highest = taken.last().map_or(rect.top() + half, |above| above + 2.0 * half);
            let middle = height_on_screen(*height).min(rect.bottom() - half).max(highest);
            write(middle, words);
            taken.push(middle);
        }
        for (height, words) in &self.powers {
            let y = height_on_screen(*height);
            painter.hline(rect.x_range(), y, egui::Stroke::new(1.0, theme.separator));
            if rect.shrink(half).y_range().contains(y) && taken.iter().all(|other| (other - y).abs() >= 2.0 * half) {
                write(y, words);
                taken.push(y);
            }
        }
    }
}

/// Whole powers of ten in a range, evenly spaced, at most three.
#[expect(clippy::cast_possible_truncation, reason = "powers of ten of f64 are below 400")]
fn powers_within(least: f64, greatest: f64) -> Vec<i32> {
    let (lowest, highest) = (least.ceil() as i32, greatest.floor() as i32);
    let gap = ((highest - lowest) / 3 + 1).max(1);
    (lowest..=highest).filter(|power| power.rem_euclid(gap) == 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_few_and_lie_within_the_range() {
        assert_eq!(powers_within(-2.5, 0.4), [-2, -1, 0]);
        assert_eq!(powers_within(0.2, 0.7), [0_i32; 0]);
        for greatest in 0..40 {
            let powers = powers_within(-17.0, f64::from(greatest));
            assert!((1..=4).contains(&powers.len()), "{powers:?}");
            assert!(powers.iter().all(|&power| (-17..=greatest).contains(&power)));
        }
    }
}
