//! Colour scales of the per-face quantities, their ranges and their legends.
//!
//! | scale   | value                  | colours             | range                                       |
//! |---------|------------------------|---------------------|---------------------------------------------|
//! | angle   | σ₁/σ₂, 1 is conformal  | white → violet      | 1 to the 99th percentile                    |
//! | area    | log₂ of the area ratio | blue – white – red  | symmetric, the wider of 1st and 99th        |
//! | stretch | root mean square of σ  | viridis             | 1st to 99th percentile                      |
//! | move    | distance in the plane  | viridis             | 0 to the 99th percentile                    |
//!
//! Viridis is by S. van der Walt and N. Smith (CC0); nine samples of it stand here.

use super::ticks::{self, Tick};

/// Least width of a scale. Below it differences are rounding and shall not be blown up to full colour.
const LEAST_WIDTH: f64 = 0.1;
/// Shares of the faces that lie below and above the range.
const TAIL: f64 = 0.01;
/// The most ticks on a legend.
const TICK_COUNT: usize = 5;

const ANGLE: [[u8; 3]; 5] = [[255, 255, 255], [227, 214, 245], [187, 158, 229], [138, 92, 205], [84, 36, 156]];
const AREA: [[u8; 3]; 7] =
    [[28, 74, 150], [86, 140, 201], [173, 203, 231], [248, 248, 246], [244, 196, 172], [218, 122, 92], [161, 44, 38]];
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];
/// Where a value is not a number.
const NO_VALUE: [u8; 3] = [128, 128, 128];

/// What a face's number means, and so how it is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Ratio of the singular values, at least 1.
    Angle,
    /// Logarithm to base 2 of the ratio of areas, plane over surface.
    Area,
    /// Stretch, or any positive quantity.
    Stretch,
    /// Distance that a face has moved, embedding units. It may be of any size.
    Move,
}

/// The values that the ends of a scale stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Value of the first colour.
    pub low: f64,
    /// Value of the last colour, above `low`.
    pub high: f64,
}

impl Range {
    /// Where a value lies: 0 at the low end, 1 at the high end, beyond them cut off. NaN stays NaN.
    pub fn share(self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

impl Scale {
    /// The range that shows the bulk of the values: outliers, one in a hundred at either end, do not widen it.
    pub fn robust_range(self, values: &[f64]) -> Range {
        let [low, high] = tails(values);
        match self {
            Self::Angle => Range { low: 1.0, high: high.max(1.0 + LEAST_WIDTH) },
            Self::Area => {
                let reach = low.abs().max(high.abs()).max(LEAST_WIDTH);
                Range { low: -reach, high: reach }
            }
            Self::Stretch if high - low < LEAST_WIDTH => {
                let middle = low.midpoint(high);
                Range { low: middle - LEAST_WIDTH / 2.0, high: middle + LEAST_WIDTH / 2.0 }
            }
            Self::Stretch => Range { low, high },
            Self::Move => Range { low: 0.0, high: if high > 0.0 { high } else { 1.0 } },
        }
    }

    /// The colour of a value, sRGB.
    pub fn colour(self, value: f64, range: Range) -> [u8; 3] {
        self.colour_at(range.share(value))
    }

    /// The colour at a place along the scale, from 0 to 1: what a legend's bar shows.
    pub fn colour_at(self, share: f64) -> [u8; 3] {
        match self {
            Self::Angle => sample(&ANGLE, share),
            Self::Area => sample(&AREA, share),
            Self::Stretch | Self::Move => sample(&VIRIDIS, share),
        }
    }

    /// Places and numbers for a legend. Areas are told as ratios: ½, 1, 2.
    pub fn ticks(self, range: Range) -> Vec<Tick> {
        let values = ticks::nice_values(range.low, range.high, TICK_COUNT);
        let tick = |(value, step): (f64, f64)| Tick {
            at: range.share(value),
            label: match self {
                Self::Angle | Self::Stretch | Self::Move => ticks::label(value, step),
                Self::Area => ratio_label(value, step),
            },
        };
        values.into_iter().map(tick).collect()
    }
}

/// The values that a hundredth of all finite ones lie below and above.
fn tails(values: &[f64]) -> [f64; 2] {
    let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    if finite.is_empty() {
        return [0.0, 0.0];
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length is one")]
    let cut = (TAIL * finite.len() as f64) as usize;
    let last = finite.len() - 1;
    let low = *finite.select_nth_unstable_by(cut, f64::total_cmp).1;
    let high = *finite.select_nth_unstable_by(last - cut, f64::total_cmp).1;
    [low, high]
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cut to 0..=255 and 0..stops before")]
fn sample(stops: &[[u8; 3]], share: f64) -> [u8; 3] {
    if share.is_nan() {
        return NO_VALUE;
    }
    let place = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let below = (place as usize).min(stops.len() - 2);
    let rest = place - below as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + rest * (f64::from(b) - f64::from(a))).round() as u8;
    std::array::from_fn(|k| mix(stops[below][k], stops[below + 1][k]))
}

/// A power of two as a ratio.
fn ratio_label(exponent: f64, step: f64) -> String {
    let whole = step >= 1.0 - 1e-9;
    match exponent.round() {
        _ if !whole => format!("{:.2}", exponent.exp2()),
        e if e.abs() > 9.0 => format!("2^{e:.0}").replace('-', "−"),
        e if e >= 0.0 => format!("{:.0}", e.exp2()),
        -1.0 => "½".to_owned(),
        -2.0 => "¼".to_owned(),
        e => format!("1/{:.0}", (-e).exp2()),
    }
}
