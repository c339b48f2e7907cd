//! Curves of the numbers of the steps: their names, units and values.

use eframe::egui::Color32;

use crate::session::{StepDistortion, Timeline};
use crate::ui::controls::short;
use crate::ui::state::{CURVE_COUNT, TimelineView};
use crate::ui::theme::Theme;
use freebound_io::StepReport;
use freebound_io::figure::{AxisScale, AxisSpan};

/// Unit of a number without one.
const NO_UNIT: &str = "no unit";

/// Curve of one number of each step.
pub(in crate::ui) struct Curve {
    pub(in crate::ui) title: &'static str,
    pub(in crate::ui) unit: &'static str,
    about: &'static str,
    /// Scale unless the user chooses another.
    scale: AxisScale,
    value: ValueOf,
    colour: ColourOf,
}

type ValueOf = fn(&StepReport, &StepDistortion) -> Option<f64>;
type ColourOf = fn(&Theme) -> Color32;

const fn count(
    title: &'static str,
    unit: &'static str,
    about: &'static str,
    value: ValueOf,
    colour: ColourOf,
) -> Curve {
    Curve { title, unit, about, scale: AxisScale::Linear, value, colour }
}

const fn size(title: &'static str, unit: &'static str, about: &'static str, value: ValueOf, colour: ColourOf) -> Curve {
    Curve { title, unit, about, scale: AxisScale::Logarithmic, value, colour }
}

pub(in crate::ui) const CURVES: [Curve; CURVE_COUNT] = [
    count("Flipped", "faces", "flipped faces", |record, _| Some(record.flipped_faces as f64), |theme| theme.flipped),
    count(
        "Crossings",
        "pairs of edges",
        "pairs of boundary edges that cross",
        |record, _| Some(record.boundary_crossings as f64),
        |theme| theme.crossing,
    ),
    size(
        "Largest move",
        "units of the plane",
        "largest move of a vertex since the previous step, in units of the plane",
        |record, _| record.max_move,
        |theme| theme.accent,
    ),
    size(
        "Distance left",
        "units of the plane",
        "largest distance of a hard pin from its target, in units of the plane",
        |_, standing| Some(standing.progress?.distance_left),
        |theme| theme.unmet,
    ),
    size(
        "Energy",
        NO_UNIT,
        "mean symmetric Dirichlet energy: 4 without distortion",
        |_, standing| Some(standing.progress?.energy),
        |theme| theme.constraint,
    ),
    size(
        "Equation residual",
        NO_UNIT,
        "|A z| of all equations relative to their terms",
        |record, _| record.equation_residual,
        |theme| theme.accent,
    ),
    count(
        "Concave",
        "polygons",
        "concave polygons",
        |record, _| Some(record.concave_polygons as f64),
        |theme| theme.concave,
    ),
    count(
        "Overwound",
        "vertices",
        "overwound vertices",
        |record, _| Some(record.overwound_vertices as f64),
        |theme| theme.overwound,
    ),
    count(
        "Outside hull",
        "vertices",
        "vertices outside the hull of their neighbours",
        |record, _| Some(record.outside_hull_vertices as f64),
        |theme| theme.outside_hull,
    ),
    size(
        "Residual",
        NO_UNIT,
        "|Ax − b| / |b| of the step's linear solve",
        |record, _| record.residual,
        |theme| theme.weak_text,
    ),
    size(
        "Determinant",
        NO_UNIT,
        "smallest determinant of a face's map, at equal total areas",
        |_, standing| Some(standing.progress?.least_determinant),
        |theme| theme.planar,
    ),
];

/// Curve with its values and the scale that it shows on.
pub(in crate::ui) struct ShownCurve {
    pub(in crate::ui) curve: &'static Curve,
    /// Place among all curves.
    pub(in crate::ui) place: usize,
    pub(in crate::ui) scale: AxisScale,
    /// Value at each step, if there is one.
    pub(in crate::ui) values: Vec<Option<f64>>,
}

impl ShownCurve {
    pub(in crate::ui) fn new(place: usize, timeline: &Timeline, view: &TimelineView) -> Self {
        const ALL: &[Curve; CURVE_COUNT] = &CURVES;
        let curve = &ALL[place];
        let steps = timeline.records().iter().zip(timeline.standings());
        let values = steps.map(|(record, standing)| (curve.value)(record, standing).filter(|value| value.is_finite()));
        let scale = view.curve_scales[place].unwrap_or(curve.scale);
        Self { curve, place, scale, values: values.collect() }
    }

    /// All curves, in the order of their menu.
    pub(in crate::ui) fn all(timeline: &Timeline, view: &TimelineView) -> Vec<Self> {
        (0..CURVE_COUNT).map(|place| Self::new(place, timeline, view)).collect()
    }

    /// Curves that have numbers other than 0 and are not hidden.
    pub(in crate::ui) fn telling(timeline: &Timeline, view: &TimelineView) -> Vec<Self> {
        let mut all = Self::all(timeline, view);
        all.retain(|shown| !view.curves_hidden[shown.place] && shown.says_something());
        all
    }

    pub(in crate::ui) fn colour(&self, theme: &Theme) -> Color32 {
        (self.curve.colour)(theme)
    }

    pub(in crate::ui) fn is_empty(&self) -> bool {
        self.values.iter().all(Option::is_none)
    }

    /// True if a value differs from 0.
    pub(in crate::ui) fn says_something(&self) -> bool {
        self.values.iter().flatten().any(|value| value.abs() > 0.0)
    }

    /// Part of the vertical axis that shows all values.
    pub(in crate::ui) fn span(&self) -> AxisSpan {
        AxisSpan::of(self.scale, self.values.iter().copied().flatten())
    }

    /// Least and greatest value with a place on the scale.
    pub(in crate::ui) fn ends(&self) -> Option<[f64; 2]> {
        let placed = self.values.iter().copied().flatten().filter(|&value| self.scale.height_of(value).is_some());
        placed.fold(None, |ends, value| match ends {
            None => Some([value; 2]),
            Some([least, greatest]) => Some([value.min(least), value.max(greatest)]),
        })
    }

    /// Description, with the scale.
    pub(in crate::ui) fn about(&self) -> String {
        let scale = if self.scale == AxisScale::Logarithmic { "; by powers of ten" } else { "" };
        format!("{}{scale}", self.curve.about)
    }

    /// Formats a value.
    pub(in crate::ui) fn words(&self, value: f64) -> String {
        match self.curve.scale {
            AxisScale::Linear => format!("{value:.0}"),
            AxisScale::Logarithmic if value == 0.0 => "0".to_owned(),
            AxisScale::Logarithmic if (0.01..1e4).contains(&value.abs()) => short(value),
            AxisScale::Logarithmic => format!("{value:.1e}"),
        }
    }

    /// Value of a step in words, with its unit.
    pub(in crate::ui) fn words_at(&self, step: usize) -> String {
        let value = self.values.get(step).copied().flatten();
        value.map_or_else(|| "no such number".to_owned(), |value| format!("{} {}", self.words(value), self.unit()))
    }

    /// Unit after a number; empty without one.
    fn unit(&self) -> &'static str {
        if self.curve.unit == NO_UNIT { "" } else { self.curve.unit }
    }
}
