//! Columns of a comparison's table, for terminals, files and the window.

use std::borrow::Cow;
use std::cmp::Ordering;

use super::{MethodReport, ResultReport, VerdictCounts};
use freebound_core::problem::{Labels, NamedOption};

/// Column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Name of the method.
    Method,
    /// Reason for the end of the method.
    Ending,
    /// Flipped faces.
    Flips,
    /// Boundary crossings.
    Crossings,
    /// Turning number of the boundary.
    Turning,
    /// Mean angle distortion.
    Angle,
    /// 99th percentile of the angle distortion.
    AngleP99,
    /// Mean area distortion.
    Area,
    /// L² stretch.
    StretchL2,
    /// L∞ stretch.
    StretchLinf,
    /// Mean symmetric Dirichlet energy.
    Energy,
    /// Number of steps.
    Steps,
    /// Seconds of all solves.
    Solve,
    /// Seconds of all verdicts.
    Verify,
    /// Bytes of the largest factors of a linear solve.
    Memory,
}

/// Sort order of the methods by a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Smallest value first.
    #[default]
    Up,
    /// Largest value first.
    Down,
}

/// Value of a column for a method.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell<'a> {
    /// Text.
    Words(Cow<'a, str>),
    /// Count.
    Count(usize),
    /// Integer that may be negative.
    Whole(i64),
    /// Measure; infinite if a face has no area.
    Measure(f64),
    /// Seconds.
    Seconds(f64),
    /// Bytes.
    Bytes(usize),
    /// No value.
    Nothing,
}

impl NamedOption for Column {
    const ALL: &'static [Self] = &[
        Self::Method,
        Self::Ending,
        Self::Flips,
        Self::Crossings,
        Self::Turning,
        Self::Angle,
        Self::AngleP99,
        Self::Area,
        Self::StretchL2,
        Self::StretchLinf,
        Self::Energy,
        Self::Steps,
        Self::Solve,
        Self::Verify,
        Self::Memory,
    ];

    fn labels(&self) -> Labels {
        let (name, title, about) = match self {
            Self::Method => ("method", "Method", "name of the method"),
            Self::Ending => ("ending", "Ending", "reason why the method ended"),
            Self::Flips => ("flips", "Flips", "flipped faces"),
            Self::Crossings => ("crossings", "Crossings", "pairs of boundary edges that meet"),
            Self::Turning => ("turning", "Turning", "turning number of the boundary: 1 if it is simple"),
            Self::Angle => ("angle", "Angle", "mean over the surface of σ₁/σ₂: 1 keeps angles"),
            Self::AngleP99 => ("angle-p99", "Angle p99", "σ₁/σ₂ that 99 % of the surface does not exceed"),
            Self::Area => ("area", "Area", "mean factor by which areas grow or shrink: 1 keeps areas"),
            Self::StretchL2 => {
                ("l2", "L²", "root mean square stretch from the plane to the surface, at equal total areas")
            }
            Self::StretchLinf => ("linf", "L∞", "greatest stretch from the plane to the surface, at equal total areas"),
            Self::Energy => ("energy", "Energy", "mean symmetric Dirichlet energy: 4 without distortion"),
            Self::Steps => ("steps", "Steps", "number of steps of the method"),
            Self::Solve => ("solve", "Solve", "seconds of all steps, without their proofs"),
            Self::Verify => ("verify", "Verify", "seconds of the proofs"),
            Self::Memory => ("memory", "Memory", "memory of the largest factors of a linear solve"),
        };
        Labels { name, title, about, source: "" }
    }
}

impl Column {
    /// Head of the column in a file. Columns of seconds or bytes name their unit.
    pub fn head(self) -> &'static str {
        match self {
            Self::AngleP99 => "angle_p99",
            Self::StretchL2 => "stretch_l2",
            Self::StretchLinf => "stretch_linf",
            Self::Turning => "turning_number",
            Self::Solve => "solve_seconds",
            Self::Verify => "verify_seconds",
            Self::Memory => "factor_bytes",
            other => other.name(),
        }
    }

    /// True if the column holds text, which is aligned at the left.
    pub const fn is_of_words(self) -> bool {
        matches!(self, Self::Method | Self::Ending)
    }

    /// Value of the column for a method.
    pub fn cell(self, of: &MethodReport) -> Cell<'_> {
        let result = of.result.as_ref();
        let count =
            |count: fn(&VerdictCounts) -> usize| result.map_or(Cell::Nothing, |of| Cell::Count(count(&of.verdict)));
        let measure = |of: fn(&ResultReport) -> f64| result.map_or(Cell::Nothing, |result| Cell::Measure(of(result)));
        match self {
            Self::Method => Cell::Words(Cow::Borrowed(&of.name)),
            Self::Ending => Cell::Words(Cow::Borrowed(of.error.as_ref().map_or(of.ending, |error| error.kind))),
            Self::Flips => count(|verdict| verdict.flipped_faces),
            Self::Crossings => count(|verdict| verdict.boundary_crossings),
            Self::Turning => result.and_then(|of| of.verdict.turning_number).map_or(Cell::Nothing, Cell::Whole),
            Self::Angle => measure(|of| of.distortion.angle.mean),
            Self::AngleP99 => measure(|of| of.distortion.angle.p99),
            Self::Area => measure(|of| of.distortion.area.mean),
            Self::StretchL2 => measure(|of| of.distortion.stretch_l2),
            Self::StretchLinf => measure(|of| of.distortion.stretch_linf),
            Self::Energy => measure(|of| of.distortion.symmetric_dirichlet.mean),
            Self::Steps => Cell::Count(of.steps.len()),
            Self::Solve => Cell::Seconds(of.seconds.solve),
            Self::Verify => Cell::Seconds(of.seconds.verify),
            Self::Memory => of.factor_bytes.map_or(Cell::Nothing, Cell::Bytes),
        }
    }

    /// Order of two methods by the column. A method without a value comes last in both directions.
    pub fn compare(self, direction: Direction, methods: [&MethodReport; 2]) -> Ordering {
        let [first, second] = methods.map(|of| self.cell(of));
        let ordering = match (&first, &second) {
            (Cell::Nothing, Cell::Nothing) => return Ordering::Equal,
            (Cell::Nothing, _) => return Ordering::Greater,
            (_, Cell::Nothing) => return Ordering::Less,
            (Cell::Words(first), Cell::Words(second)) => first.cmp(second),
            _ => first.number().total_cmp(&second.number()),
        };
        match direction {
            Direction::Up => ordering,
            Direction::Down => ordering.reverse(),
        }
    }
}

impl Cell<'_> {
    /// Value as a number; NaN if it is none.
    fn number(&self) -> f64 {
        match self {
            Self::Count(count) | Self::Bytes(count) => *count as f64,
            Self::Whole(whole) => *whole as f64,
            Self::Measure(number) | Self::Seconds(number) => *number,
            Self::Words(_) | Self::Nothing => f64::NAN,
        }
    }

    /// Text for display, rounded to significant digits.
    pub fn words(&self) -> String {
        match self {
            Self::Words(words) => words.clone().into_owned(),
            Self::Count(count) => count.to_string(),
            Self::Whole(whole) => whole.to_string().replace('-', "−"),
            Self::Measure(number) => measure_words(*number),
            Self::Seconds(seconds) => seconds_words(*seconds),
            Self::Bytes(bytes) => bytes_words(*bytes),
            Self::Nothing => "–".to_owned(),
        }
    }

    /// Text for a file: all digits, `inf` for an infinite number, and empty without a value.
    pub fn exact(&self) -> String {
        match self {
            Self::Words(words) => words.clone().into_owned(),
            Self::Count(count) | Self::Bytes(count) => count.to_string(),
            Self::Whole(whole) => whole.to_string(),
            Self::Measure(number) | Self::Seconds(number) => exact_number(*number),
            Self::Nothing => String::new(),
        }
    }
}

/// Number for a file, with all digits; empty for NaN.
pub(super) fn exact_number(number: f64) -> String {
    if number.is_nan() { String::new() } else { format!("{number:?}") }
}

/// Text with three decimals; one decimal for larger numbers, scientific notation for the largest.
fn measure_words(number: f64) -> String {
    if !number.is_finite() {
        return "∞".to_owned();
    }
    match number.abs() {
        ..99.995 => format!("{number:.3}"),
        ..9999.5 => format!("{number:.1}"),
        _ => format!("{number:.1e}"),
    }
}

fn seconds_words(seconds: f64) -> String {
    match seconds {
        ..0.000_999_5 => format!("{:.0} µs", 1e6 * seconds),
        ..0.999_5 => format!("{:.0} ms", 1e3 * seconds),
        ..99.95 => format!("{seconds:.2} s"),
        _ => format!("{seconds:.0} s"),
    }
}

fn bytes_words(bytes: usize) -> String {
    match bytes as f64 {
        small @ ..999_500.0 => format!("{:.0} kB", (small / 1e3).ceil()),
        some @ ..9.995e8 => format!("{:.1} MB", some / 1e6),
        much => format!("{:.2} GB", much / 1e9),
    }
}
