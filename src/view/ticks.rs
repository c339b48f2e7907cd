//! Numbers that people like to read on an axis: 1, 2 or 5 times a power of ten.

/// A labelled place on a legend's bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Place along the bar: 0 at the low end, 1 at the high end.
    pub at: f64,
    /// The number, with the digits that mean something.
    pub label: String,
}

/// Slack when a nice number is compared with a bound, relative: powers of ten are rounded.
const SLACK: f64 = 1e-9;

/// The smallest of 1, 2, 5 × 10ᵏ that is at least `width`. 1 for a width that is not positive and finite.
pub fn nice_step_at_least(width: f64) -> f64 {
    if !(width.is_normal() && width > 0.0) {
        return 1.0;
    }
    let decade = 10_f64.powf(width.log10().floor());
    let leading = [1.0, 2.0, 5.0, 10.0].into_iter().find(|&m| m * decade >= width * (1.0 - SLACK));
    leading.unwrap_or(10.0) * decade
}

/// Multiples of a nice step from `low` to `high`, at most `count` of them and as many as fit.
pub(super) fn nice_values(low: f64, high: f64, count: usize) -> Vec<(f64, f64)> {
    let step = nice_step_at_least((high - low) / count.max(2) as f64);
    let first = (low / step - SLACK).ceil();
    (0..=count)
        .map(|k| (first + k as f64) * step)
        .take_while(|&v| v <= high + SLACK * step)
        .map(|v| (v, step))
        .collect()
}

/// A value with as many decimals as its step needs.
pub(super) fn label(value: f64, step: f64) -> String {
    let magnitude = step.abs().log10().floor();
    if !(-5.0..=5.0).contains(&magnitude) {
        return format!("{value:.1e}");
    }
    let mut decimals = 0;
    while decimals < 6 && 10_f64.powi(-decimals) > step * (1.0 + SLACK) {
        decimals += 1;
    }
    let decimals = usize::try_from(decimals).unwrap_or(0);
    // Adding zero turns −0 into 0.
    format!("{:.decimals$}", value + 0.0).replace('-', "−")
}
