//! Scales of axes, and marks at round numbers.

/// Greatest number of marks on an axis.
const MARKS: usize = 6;

/// Length of a logarithmic axis, in decades, below which marks are closer than the powers of ten.
const FEW_DECADES: f64 = 2.2;

/// Space above and below a curve, relative to its height.
const SPACE: f64 = 0.06;

/// Scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Equal distances for equal differences.
    #[default]
    Linear,
    /// Equal distances for equal factors. Numbers of 0 and below have no place on it.
    Logarithmic,
}

/// Part of an axis that shows some values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSpan {
    /// Scale of the axis.
    pub scale: AxisScale,
    /// Lowest height: a value, or its logarithm to base 10.
    pub low: f64,
    /// Greatest height.
    pub high: f64,
    /// True if some values have no place on the axis.
    pub has_unplaced: bool,
}

impl AxisScale {
    /// Height of a value. `None` without a place on the scale.
    pub fn height_of(self, value: f64) -> Option<f64> {
        match self {
            Self::Linear => Some(value).filter(|value| value.is_finite()),
            Self::Logarithmic => Some(value.log10()).filter(|height| height.is_finite()),
        }
    }
}

impl AxisSpan {
    /// Span of all values, with space around them. A linear span of values of 0 and above begins at 0.
    pub fn of(scale: AxisScale, values: impl Iterator<Item = f64> + Clone) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let has_unplaced = finite.clone().any(|value| scale.height_of(value).is_none());
        let heights = finite.filter_map(|value| scale.height_of(value));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let (low, high) = match scale {
            _ if low > high => (0.0, 1.0),
            AxisScale::Linear => (low.min(0.0), if high <= 0.0 && low >= 0.0 { 1.0 } else { high.max(0.0) }),
            AxisScale::Logarithmic if high - low < 1.0 => (0.5 * (low + high) - 0.5, 0.5 * (low + high) + 0.5),
            AxisScale::Logarithmic => (low, high),
        };
        let space = SPACE * (high - low);
        let below = if scale == AxisScale::Linear && low >= 0.0 { 0.0 } else { space };
        Self { scale, low: low - below, high: high + space, has_unplaced }
    }

    /// Share of the span below a value. `None` without a place on the scale.
    pub fn share(&self, value: f64) -> Option<f64> {
        Some((self.scale.height_of(value)? - self.low) / (self.high - self.low))
    }

    /// Share of the span below a height.
    fn share_of_height(&self, height: f64) -> f64 {
        (height - self.low) / (self.high - self.low)
    }

    /// Marks at round values: share of the span, and number.
    pub fn marks(&self) -> Vec<(f64, String)> {
        match self.scale {
            AxisScale::Logarithmic if self.high - self.low < FEW_DECADES => self.leading_marks(),
            AxisScale::Logarithmic => self.marks_every(self.step().max(1.0).round(), power_words),
            AxisScale::Linear => {
                let step = self.step();
                let decimals = decimals_of(step);
                let is_plain = (1e-4..1e5).contains(&step);
                let words = |value: f64| {
                    if is_plain { format!("{:.decimals$}", value + 0.0) } else { format!("{value:.1e}") }
                };
                self.marks_every(step, words)
            }
        }
    }

    /// Marks at the multiples of a step, in heights.
    fn marks_every(&self, step: f64, words: impl Fn(f64) -> String) -> Vec<(f64, String)> {
        let first = (self.low / step).ceil();
        let heights = (0..=2 * MARKS).map(|k| (k as f64 + first) * step).take_while(|height| *height <= self.high);
        heights.map(|height| (self.share_of_height(height), words(height).replace('-', "−"))).collect()
    }

    /// Marks at 1, 2 and 5 times the powers of ten, on a short logarithmic axis.
    fn leading_marks(&self) -> Vec<(f64, String)> {
        let (mut decade, mut marks) = (self.low.floor(), Vec::new());
        while decade <= self.high {
            for leading in [1.0_f64, 2.0, 5.0] {
                let height = decade + leading.log10();
                if (self.low..=self.high).contains(&height) {
                    marks.push((self.share_of_height(height), value_words(leading, decade).replace('-', "−")));
                }
            }
            decade += 1.0;
        }
        marks
    }

    /// Distance between marks, in heights: a power of ten, times 1, 2 or 5.
    fn step(&self) -> f64 {
        let length = self.high - self.low;
        let power = 10_f64.powf((length / MARKS as f64).log10().floor());
        let enough = |factor: &f64| length / (factor * power) <= MARKS as f64;
        [1.0, 2.0, 5.0].into_iter().find(enough).unwrap_or(10.0) * power
    }
}

/// Number of decimals of multiples of a step.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few decimals")]
fn decimals_of(step: f64) -> usize {
    (-(step.log10() + 1e-9).floor()).clamp(0.0, 8.0) as usize
}

/// Power of ten in words.
fn power_words(exponent: f64) -> String {
    value_words(1.0, exponent)
}

/// A leading digit times a power of ten, in words.
fn value_words(leading: f64, exponent: f64) -> String {
    match exponent {
        -3.0..=4.0 => {
            let decimals = decimals_of(10_f64.powf(exponent));
            format!("{:.decimals$}", leading * 10_f64.powf(exponent))
        }
        _ => format!("{leading}e{exponent:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_lie_within_the_span_and_are_few() {
        for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
            for greatest in [1e-12, 0.3, 1.0, 7.0, 4.2e3, 1e9] {
                for least in [1e-16, 0.9 * greatest, greatest] {
                    let span = AxisSpan::of(scale, [least, greatest].into_iter());
                    let marks = span.marks();
                    assert!((1..=MARKS + 2).contains(&marks.len()), "{scale:?} {least} {greatest}: {marks:?}");
                    assert!(marks.iter().all(|(share, _)| (-1e-9..=1.0 + 1e-9).contains(share)), "{marks:?}");
                    let words: Vec<&String> = marks.iter().map(|(_, words)| words).collect();
                    assert!(words.windows(2).all(|pair| pair[0] != pair[1]), "{words:?}");
                    for value in [least, greatest] {
                        assert!(span.share(value).is_some_and(|share| (-1e-9..=1.0).contains(&share)));
                    }
                }
            }
        }
    }

    #[test]
    fn zeros_and_negatives_have_no_place_on_a_logarithmic_axis() {
        let span = AxisSpan::of(AxisScale::Logarithmic, [0.0, -1.0, 10.0, 1000.0].into_iter());
        assert!(span.has_unplaced && span.share(0.0).is_none() && span.share(-1.0).is_none());
        let words: Vec<String> = span.marks().into_iter().map(|(_, words)| words).collect();
        assert_eq!(words, ["10", "100", "1000"]);
        let linear = AxisSpan::of(AxisScale::Linear, [0.0, -1.0, 10.0].into_iter());
        assert!(!linear.has_unplaced && linear.low < -1.0 && linear.high > 10.0);
        let none = AxisSpan::of(AxisScale::Logarithmic, [0.0].into_iter());
        assert!(none.has_unplaced && none.low < none.high);
    }
}
