//! Quantities over the steps of a run, one panel each. Dots have the colour of the stage that made the step.
//!
//! Numbers of 0 and below have no place on a logarithmic axis. They are marked by hollow triangles in a strip below it.

use std::io::{self, Write};

use glam::DVec2;

use super::sheet::wrapped;
use super::{Anchor, AxisScale, AxisSpan, Ink, Page, colours, width_of};
use crate::raster::Colour;
use freebound_core::geom::Bounds;

/// Margin around the page, points.
const MARGIN: f64 = 18.0;

/// Size of a panel with its words, and the space between panels.
const PANEL: DVec2 = DVec2::new(330.0, 220.0);
const GAP: f64 = 18.0;

/// Greatest number of panels in a row.
const COLUMNS: usize = 2;

/// Space between the panel's sides and its axes: left, top, right, bottom.
const AROUND: [f64; 4] = [46.0, 36.0, 8.0, 34.0];

/// Sizes of titles, words and small words, and the distance between lines.
const TITLE: f64 = 12.0;
const WORDS: f64 = 10.0;
const SMALL: f64 = 9.0;
const LINE: f64 = 15.0;

/// Height of the strip for numbers without a place on the axis, points.
const STRIP: f64 = 14.0;

/// Radius of a dot: of few steps, and of many.
const DOTS: [f64; 2] = [2.0, 1.0];

/// Greatest number of steps with large dots.
const FEW: usize = 80;

/// Quantity over the steps.
#[derive(Clone, Debug)]
pub struct StepCurve {
    /// Name of the quantity.
    pub title: String,
    /// Unit, or the kind of things that are counted.
    pub unit: String,
    /// Scale of the vertical axis.
    pub scale: AxisScale,
    /// Value at each step, if there is one.
    pub values: Vec<Option<f64>>,
}

/// Curves of a run.
#[derive(Clone, Debug)]
pub struct StepFigure {
    /// The curves, each in its panel.
    pub curves: Vec<StepCurve>,
    /// Name of the stage that made each step.
    pub stages: Vec<String>,
    /// Caption of the figure.
    pub caption: String,
}

impl StepFigure {
    /// Page with the legend, the panels and the caption.
    pub fn page(&self) -> Page {
        let columns = self.curves.len().clamp(1, COLUMNS);
        let rows = self.curves.len().div_ceil(columns);
        let width = 2.0 * MARGIN + columns as f64 * (PANEL.x + GAP) - GAP;
        let (key, key_height) = self.legend(width);
        let above = MARGIN + key_height;
        let below = above + rows as f64 * (PANEL.y + GAP);
        let caption = wrapped(&self.caption, WORDS, width - 2.0 * MARGIN);
        let mut page = Page::new(DVec2::new(width, below + LINE * caption.len() as f64 + MARGIN));
        for (stage, at) in key {
            let middle = at + DVec2::new(4.0, -0.35 * WORDS);
            page.outlines(vec![dot(middle, 3.0)], Ink::fill(self.colour(&stage)), None);
            page.words(at + DVec2::new(12.0, 0.0), Anchor::Start, WORDS, &stage);
        }
        for (k, curve) in self.curves.iter().enumerate() {
            let place = DVec2::new((k % columns) as f64, (k / columns) as f64);
            let corner = place * (PANEL + GAP) + DVec2::new(MARGIN, above);
            self.draw(&mut page, Bounds::at(corner, PANEL), curve);
        }
        for (k, line) in caption.iter().enumerate() {
            page.words(DVec2::new(MARGIN, below + LINE * (k as f64 + 0.7)), Anchor::Start, WORDS, line);
        }
        page
    }

    /// Writes the curves as a table: a row for each step, a column for each curve, all digits. Cells without a number
    /// are empty.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        let heads = self.curves.iter().map(|curve| format!("{} [{}]", curve.title, curve.unit));
        table.write_record(["Step", "Stage"].map(str::to_owned).into_iter().chain(heads))?;
        for (step, stage) in self.stages.iter().enumerate() {
            let cell = |curve: &StepCurve| {
                let value = curve.values.get(step).copied().flatten();
                value.map(|value| format!("{value:?}")).unwrap_or_default()
            };
            let cells = self.curves.iter().map(cell);
            table.write_record([step.to_string(), stage.clone()].into_iter().chain(cells))?;
        }
        table.flush()
    }

    /// Stages in the order of their first steps.
    fn stage_names(&self) -> Vec<&String> {
        let mut names: Vec<&String> = Vec::new();
        for stage in &self.stages {
            if !names.contains(&stage) {
                names.push(stage);
            }
        }
        names
    }

    fn colour(&self, stage: &str) -> Colour {
        let place = self.stage_names().iter().position(|name| *name == stage).unwrap_or(0);
        colours::SERIES[place % colours::SERIES.len()]
    }

    /// Names of the stages with their positions, in lines of at most this width, and their height.
    fn legend(&self, width: f64) -> (Vec<(String, DVec2)>, f64) {
        let mut at = DVec2::new(MARGIN, MARGIN + 0.7 * WORDS);
        let mut key = Vec::new();
        for name in self.stage_names() {
            let length = 12.0 + width_of(name, WORDS) + 18.0;
            if at.x + length > width && at.x > MARGIN {
                at = DVec2::new(MARGIN, at.y + LINE);
            }
            key.push((name.clone(), at));
            at.x += length;
        }
        (key, at.y + 0.3 * WORDS + 8.0 - MARGIN)
    }

    fn draw(&self, page: &mut Page, panel: Bounds, curve: &StepCurve) {
        let [left, top, right, bottom] = AROUND;
        let low = panel.low + DVec2::new(left, top);
        let area = Bounds { low, high: panel.high - DVec2::new(right, bottom) };
        let span = AxisSpan::of(curve.scale, curve.values.iter().copied().flatten());
        let plot = Bounds { high: area.high - DVec2::new(0.0, if span.has_unplaced { STRIP } else { 0.0 }), ..area };
        page.words(panel.low + DVec2::new(left, 0.8 * TITLE), Anchor::Start, TITLE, &curve.title);
        let scale = if curve.scale == AxisScale::Logarithmic { ", logarithmic" } else { "" };
        let unit = format!("{}{scale}", curve.unit);
        let size = SMALL * ((PANEL.x - left) / width_of(&unit, SMALL).max(1.0)).min(1.0);
        page.words(panel.low + DVec2::new(left, TITLE + SMALL + 4.0), Anchor::Start, size, &unit);
        draw_axes(page, [plot, area], &span, curve.values.len());
        self.draw_curve(page, [plot, area], &span, curve);
    }

    fn draw_curve(&self, page: &mut Page, [plot, area]: [Bounds; 2], span: &AxisSpan, curve: &StepCurve) {
        let count = curve.values.len();
        let place = |step: usize, value: f64| {
            let share = span.share(value)?;
            Some(DVec2::new(across(plot, step, count), plot.high.y - share * plot.size().y))
        };
        let points: Vec<Option<DVec2>> =
            curve.values.iter().enumerate().map(|(step, value)| place(step, (*value)?)).collect();
        let lines = points.split(Option::is_none).map(|run| run.iter().copied().flatten().collect::<Vec<_>>());
        page.lines(lines.collect(), Ink::stroke(colours::EDGE, 0.9), None);
        let radius = if count <= FEW { DOTS[0] } else { DOTS[1] };
        for name in self.stage_names() {
            let is_own = |step: usize| self.stages.get(step) == Some(name);
            let own = points.iter().enumerate().filter(|(step, _)| is_own(*step)).filter_map(|(_, point)| *point);
            page.outlines(own.map(|at| dot(at, radius)).collect(), Ink::fill(self.colour(name)), None);
            let is_unplaced = |value: f64| value.is_finite() && span.share(value).is_none();
            let unplaced = (0..count).filter(|&step| is_own(step) && curve.values[step].is_some_and(is_unplaced));
            let at = |step: usize| DVec2::new(across(plot, step, count), area.high.y - 0.5 * STRIP);
            let ink = Ink::both(colours::PAPER, self.colour(name), 0.8);
            page.outlines(unplaced.map(|step| triangle(at(step), radius + 0.8)).collect(), ink, None);
        }
    }
}

/// Position of a step along the axis.
fn across(plot: Bounds, step: usize, count: usize) -> f64 {
    let last = count.saturating_sub(1).max(1) as f64;
    plot.low.x + 4.0 + (plot.size().x - 8.0) * step as f64 / last
}

/// Draws lines at round numbers, and the frame. `plot` is the area without the strip.
fn draw_axes(page: &mut Page, [plot, area]: [Bounds; 2], span: &AxisSpan, count: usize) {
    let beside = |page: &mut Page, y: f64, words: &str| {
        let at = DVec2::new(area.low.x - 5.0 - width_of(words, SMALL), y + 0.35 * SMALL);
        page.words(at, Anchor::Start, SMALL, words);
    };
    for (share, words) in span.marks() {
        let y = plot.high.y - share * plot.size().y;
        let line = vec![DVec2::new(area.low.x, y), DVec2::new(area.high.x, y)];
        page.lines(vec![line], Ink::stroke(colours::GRID, 0.6), None);
        beside(page, y, &words);
    }
    if span.has_unplaced {
        let line = vec![DVec2::new(area.low.x, plot.high.y), DVec2::new(area.high.x, plot.high.y)];
        page.lines(vec![line], Ink::stroke(colours::EDGE, 0.6), None);
        beside(page, area.high.y - 0.5 * STRIP, "≤ 0");
    }
    let last = count.saturating_sub(1);
    let step = step_between(last);
    for number in (0..=last).step_by(step) {
        let x = across(plot, number, count);
        let tick = vec![DVec2::new(x, area.high.y), DVec2::new(x, area.high.y + 3.0)];
        page.lines(vec![tick], Ink::stroke(colours::INK, 0.8), None);
        page.words(DVec2::new(x, area.high.y + 4.0 + SMALL), Anchor::Middle, SMALL, &number.to_string());
    }
    page.outlines(vec![area.corners().to_vec()], Ink::stroke(colours::INK, 0.8), None);
    let at = DVec2::new(area.middle().x, area.high.y + 8.0 + 2.0 * SMALL);
    page.words(at, Anchor::Middle, SMALL, "step");
}

/// Distance between numbered steps: 1, 2 or 5, times a power of ten; at most 8 steps have numbers.
fn step_between(last: usize) -> usize {
    let mut power = 1;
    loop {
        if let Some(step) = [1, 2, 5].map(|factor| factor * power).into_iter().find(|step| last / step < 8) {
            return step;
        }
        power *= 10;
    }
}

/// Outline of a dot.
fn dot(at: DVec2, radius: f64) -> Vec<DVec2> {
    (0..12).map(|k| at + radius * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 12.0)).collect()
}

/// Outline of a triangle that points down.
fn triangle(at: DVec2, radius: f64) -> Vec<DVec2> {
    [(-1.0, -0.8), (1.0, -0.8), (0.0, 1.0)].map(|(x, y)| at + radius * DVec2::new(x, y)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Item;

    fn figure(scale: AxisScale) -> StepFigure {
        let values = vec![Some(10.0), Some(0.0), None, Some(-2.0), Some(1e-3)];
        let curve = StepCurve { title: "Energy".to_owned(), unit: "unit".to_owned(), scale, values };
        let stages = ["Natural", "Natural", "Iteration", "Iteration", "Iteration"].map(str::to_owned).to_vec();
        StepFigure { curves: vec![curve], stages, caption: "caption".to_owned() }
    }

    fn outlines_of(page: &Page, fill: Colour) -> usize {
        let is_own = |item: &&Item| matches!(item, Item::Path(path) if path.ink.fill == Some(fill));
        let count = |item: &Item| if let Item::Path(path) = item { path.lines.len() } else { 0 };
        page.items.iter().filter(is_own).map(count).sum()
    }

    #[test]
    fn every_value_is_drawn_and_those_without_a_place_are_marked() {
        let page = figure(AxisScale::Logarithmic).page();
        // A dot for each placed step, and one in the legend for each stage.
        assert_eq!([0, 1].map(|k| outlines_of(&page, colours::SERIES[k])), [1 + 1, 1 + 1]);
        assert_eq!(outlines_of(&page, colours::PAPER), 2, "0 and −2 are marked");
        let page = figure(AxisScale::Linear).page();
        assert_eq!([0, 1].map(|k| outlines_of(&page, colours::SERIES[k])), [2 + 1, 2 + 1]);
        assert_eq!(outlines_of(&page, colours::PAPER), 0);
    }

    #[test]
    fn words_lie_on_the_page() {
        let mut figure = figure(AxisScale::Logarithmic);
        figure.stages = (0..5).map(|k| format!("a stage with a long name, number {k}")).collect();
        let page = figure.page();
        for item in &page.items {
            if let Item::Words(words) = item {
                let width = width_of(&words.text, words.size);
                let left = if words.anchor == Anchor::Middle { words.at.x - width / 2.0 } else { words.at.x };
                assert!(left >= 0.0 && left + width <= page.size.x && words.at.y <= page.size.y, "{}", words.text);
            }
        }
    }
}
