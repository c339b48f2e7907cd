//! Colours of the renderer, and colour scales of per-face quantities with their ranges and legends. The theme holds
//! the values of the renderer's colours; shaders receive them as uniforms.
//!
//! | scale   | value                  | colours             | range                                       |
//! |---------|------------------------|---------------------|---------------------------------------------|
//! | angle   | σ₁/σ₂, 1 is conformal  | white → violet      | 1 to the 99th percentile                    |
//! | area    | log₂ of the area ratio | blue – white – red  | symmetric, the wider of 1st and 99th        |
//! | stretch | root mean square of σ  | viridis             | 1st to 99th percentile                      |
//! | move    | distance in the plane  | viridis             | 0 to the 99th percentile                    |
//! | column  | number of one sign     | viridis             | 1st to 99th percentile                      |
//! | signed  | number of both signs   | blue – white – red  | symmetric, the wider of 1st and 99th        |
//!
//! Viridis is by S. van der Walt and N. Smith (CC0); this module holds nine samples of it.

/// Least width of a scale. Smaller differences are rounding and must not span the full range of colours.
const LEAST_WIDTH: f64 = 0.1;
/// Share of the faces below the range, and share above it.
const TAIL: f64 = 0.01;
/// Largest number of steps between the ticks of a legend.
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
/// Colour of values that are not a number.
const NO_VALUE: [u8; 3] = [128, 128, 128];

/// Quantity of a face that determines its colour scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Ratio of the singular values, at least 1.
    Angle,
    /// Logarithm to base 2 of the ratio of areas, plane over surface.
    Area,
    /// Stretch, or any positive quantity.
    Stretch,
    /// Distance that a face has moved, embedding units, of any magnitude.
    Move,
    /// Number of a table, of one sign.
    Column,
    /// Number of a table, of both signs.
    SignedColumn,
}

/// Values at the two ends of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Value of the first colour.
    pub low: f64,
    /// Value of the last colour, above `low`.
    pub high: f64,
}

impl Range {
    /// Position of a value in the range: 0 at the low end, 1 at the high end, clamped. NaN stays NaN.
    pub fn share(self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

impl Scale {
    /// Scale of the numbers of a table: diverging if they have both signs.
    pub fn of_column(values: &[f64]) -> Self {
        let has = |is_so: fn(&f64) -> bool| values.iter().any(is_so);
        if has(|value| *value < 0.0) && has(|value| *value > 0.0) { Self::SignedColumn } else { Self::Column }
    }

    /// Range that shows the bulk of the values. The lowest and highest hundredth of the values do not widen it.
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
            Self::Column if high > low => Range { low, high },
            Self::Column => Range { low, high: low + low.abs().max(1.0) },
            Self::SignedColumn => {
                let reach = low.abs().max(high.abs());
                let reach = if reach > 0.0 { reach } else { 1.0 };
                Range { low: -reach, high: reach }
            }
        }
    }

    /// Colour of a value, sRGB.
    pub fn colour(self, value: f64, range: Range) -> [u8; 3] {
        self.colour_at(range.share(value))
    }

    /// Colour at a position along the scale, from 0 to 1, as a legend's bar shows it.
    pub fn colour_at(self, share: f64) -> [u8; 3] {
        match self {
            Self::Angle => sample(&ANGLE, share),
            Self::Area | Self::SignedColumn => sample(&AREA, share),
            Self::Stretch | Self::Move | Self::Column => sample(&VIRIDIS, share),
        }
    }

    /// Tick positions and labels for a legend. Areas are labelled as ratios: ½, 1, 2.
    pub fn ticks(self, range: Range) -> Vec<Tick> {
        let values = nice_values(range.low, range.high, TICK_COUNT);
        let tick = |(value, step): (f64, f64)| Tick {
            at: range.share(value),
            label: match self {
                Self::Area => ratio_label(value, step),
                _ => label(value, step),
            },
        };
        values.into_iter().map(tick).collect()
    }
}

/// 1st and 99th percentile of the finite values.
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

/// Label of a power of two as a ratio.
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

/// Labelled tick on a legend's bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position along the bar: 0 at the low end, 1 at the high end.
    pub at: f64,
    /// Number with its significant digits.
    pub label: String,
}

/// Relative slack for comparing a nice number with a bound, since powers of ten are rounded.
const SLACK: f64 = 1e-9;

/// Returns the smallest of 1, 2, 5 × 10ᵏ that is at least `width`; 1 if `width` is not positive and finite.
pub fn nice_step_at_least(width: f64) -> f64 {
    if !(width.is_normal() && width > 0.0) {
        return 1.0;
    }
    let decade = 10_f64.powf(width.log10().floor());
    let leading = [1.0, 2.0, 5.0, 10.0].into_iter().find(|&m| m * decade >= width * (1.0 - SLACK));
    leading.unwrap_or(10.0) * decade
}

/// Multiples of a nice step from `low` to `high`, each with the step; at most `count` + 1 of them.
fn nice_values(low: f64, high: f64, count: usize) -> Vec<(f64, f64)> {
    let step = nice_step_at_least((high - low) / count.max(2) as f64);
    let first = (low / step - SLACK).ceil();
    (0..=count)
        .map(|k| (first + k as f64) * step)
        .take_while(|&v| v <= high + SLACK * step)
        .map(|v| (v, step))
        .collect()
}

/// Formats a value with the decimals that its step needs.
fn label(value: f64, step: f64) -> String {
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

/// Colour in sRGB with straight alpha, as designers write it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Srgb(pub [u8; 4]);

impl Srgb {
    /// Opaque colour from `0xRRGGBB`.
    pub const fn from_hex(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// Returns this colour with another opacity, 0 to 255.
    #[must_use]
    pub const fn with_alpha(self, alpha: u8) -> Self {
        let [r, g, b, _] = self.0;
        Self([r, g, b, alpha])
    }

    /// Linear light with straight alpha, as the shaders compute.
    pub fn to_linear(self) -> [f32; 4] {
        let [r, g, b, a] = self.0.map(|byte| f32::from(byte) / 255.0);
        [linear(r), linear(g), linear(b), a]
    }
}

/// The sRGB transfer function, IEC 61966-2-1.
fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Colours of both panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Background of the panes.
    pub background: Srgb,
    /// Grid lines of the embedding; major lines at full alpha.
    pub grid: Srgb,
    /// Outline of the unit square.
    pub unit_square: Srgb,
    /// Front of the mesh.
    pub clay: Srgb,
    /// Back of the mesh.
    pub clay_back: Srgb,
    /// Faces of the embedding in plain shading.
    pub plane_face: Srgb,
    /// Mixed into areas covered by overlapping faces of the embedding.
    pub overlap: Srgb,
    /// The two colours of the checker.
    pub checker: [Srgb; 2],
    /// Wireframe.
    pub wire: Srgb,
    /// Wireframe over the dark parts of a checker or a picture.
    pub wire_light: Srgb,
    /// Flipped faces.
    pub flipped: Srgb,
}
