//! Plots: shares as bars, and as curves, in panels on a page.
//!
//! Heights are shares from 0 to 1, shown in per cent. Bars have names below them; curves have numbers from 0 on.

use glam::DVec2;

use super::font::width_of;
use super::{Anchor, Ink, Page, colours};
use crate::raster::Colour;
use freebound_core::geom::Bounds;

/// Margin around the page, points.
const MARGIN: f64 = 18.0;

/// Size of a panel with its words.
const PANEL: DVec2 = DVec2::new(400.0, 270.0);

/// Space between panels.
const GAP: f64 = 22.0;

/// Number of panels in a row.
const COLUMNS: usize = 2;

/// Sizes of a panel's title, of words, and of small words.
const TITLE: f64 = 13.0;
const WORDS: f64 = 11.0;
const SMALL: f64 = 9.5;

/// Number of names in a row of the legend.
const IN_A_ROW: usize = 3;

/// Space between the panel's sides and its axes: left, top, right, bottom.
const AROUND: [f64; 4] = [38.0, 52.0, 8.0, 58.0];

/// Bar of stacked parts, from the bottom up.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Name of the bar, in one or two lines.
    pub name: String,
    /// Number of runs, shown above the bar.
    pub count: usize,
    /// Shares, with a sum of at most 1.
    pub parts: Vec<f64>,
}

/// Curve of shares.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Name of the curve.
    pub name: String,
    /// Shares at 0, 1, 2 and so on.
    pub shares: Vec<f64>,
}

/// Content of a plot.
#[derive(Clone, Debug, PartialEq)]
pub enum Marks {
    /// Bars side by side, with the names of their parts.
    Bars(Vec<Bar>, Vec<String>),
    /// Curves in shared axes.
    Curves(Vec<Shares>),
}

impl Marks {
    /// End of the scale, per cent: 100 for bars, for curves as large as needed.
    fn scale(&self) -> u32 {
        let Self::Curves(curves) = self else { return 100 };
        let greatest = curves.iter().flat_map(|curve| &curve.shares).copied().fold(0.0, f64::max);
        let enough = |percent: &u32| greatest * 100.0 <= f64::from(*percent);
        [5, 10, 20, 30, 50].into_iter().find(enough).unwrap_or(100)
    }
}

/// Plot in a panel of a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Title of the plot.
    pub title: String,
    /// Name of the horizontal axis.
    pub along: String,
    /// Bars or curves.
    pub marks: Marks,
}

/// Page with plots in rows, and a caption below.
pub fn plots(panels: &[Plot], caption: &str) -> Page {
    let rows = panels.len().div_ceil(COLUMNS) as f64;
    let columns = COLUMNS as f64;
    let width = 2.0 * MARGIN + columns * PANEL.x + (columns - 1.0) * GAP;
    let below = MARGIN + rows * (PANEL.y + GAP);
    let mut page = Page::new(DVec2::new(width, below + WORDS + MARGIN));
    for (k, panel) in panels.iter().enumerate() {
        let place = DVec2::new((k % COLUMNS) as f64, (k / COLUMNS) as f64);
        panel.draw(&mut page, place * (PANEL + GAP) + MARGIN);
    }
    page.words(DVec2::new(MARGIN, below + WORDS * 0.7), Anchor::Start, WORDS, caption);
    page
}

impl Plot {
    fn draw(&self, page: &mut Page, corner: DVec2) {
        let [left, top, right, bottom] = AROUND;
        let area = Bounds { low: corner + DVec2::new(left, top), high: corner + PANEL - DVec2::new(right, bottom) };
        page.words(corner + DVec2::new(0.0, TITLE * 0.8), Anchor::Start, TITLE, &self.title);
        let scale = self.marks.scale();
        for fifth in 0_u32..=5 {
            let percent = scale * fifth / 5;
            let y = at_share(area, f64::from(fifth) / 5.0);
            let line = vec![DVec2::new(area.low.x, y), DVec2::new(area.high.x, y)];
            page.lines(vec![line], Ink::stroke(colours::GRID, 0.6), None);
            let words = percent.to_string();
            let at = DVec2::new(area.low.x - 5.0 - width_of(&words, SMALL), y + SMALL * 0.35);
            page.words(at, Anchor::Start, SMALL, &words);
        }
        match &self.marks {
            Marks::Bars(bars, parts) => {
                legend(page, corner, parts);
                draw_bars(page, area, bars);
            }
            Marks::Curves(curves) => {
                let names: Vec<String> = curves.iter().map(|curve| curve.name.clone()).collect();
                legend(page, corner, &names);
                draw_curves(page, area, curves, f64::from(scale) / 100.0);
            }
        }
        let axes = vec![vec![area.low, DVec2::new(area.low.x, area.high.y), area.high]];
        page.lines(axes, Ink::stroke(colours::INK, 0.9), None);
        let at = DVec2::new(area.middle().x, corner.y + PANEL.y - 6.0);
        page.words(at, Anchor::Middle, WORDS, &self.along);
    }
}

/// Height of a share on the page.
fn at_share(area: Bounds, share: f64) -> f64 {
    area.high.y - share * area.size().y
}

fn colour(number: usize) -> Colour {
    colours::SERIES[number % colours::SERIES.len()]
}

/// Draws the names of parts or curves below the title, in columns as wide as the widest name.
fn legend(page: &mut Page, corner: DVec2, names: &[String]) {
    let begin = corner + DVec2::new(AROUND[0], TITLE + 10.0);
    let widest = names.iter().map(|name| width_of(name, SMALL)).fold(0.0, f64::max);
    for (k, name) in names.iter().enumerate() {
        let cell = DVec2::new(SMALL + 9.0 + widest, SMALL * 1.3);
        let at = begin + cell * DVec2::new((k % IN_A_ROW) as f64, (k / IN_A_ROW) as f64);
        let square = Bounds::at(at + DVec2::new(0.0, -SMALL * 0.8), DVec2::splat(SMALL * 0.85));
        page.outlines(vec![square.corners().to_vec()], Ink::fill(colour(k)), None);
        page.words(at + DVec2::new(SMALL + 3.0, 0.0), Anchor::Start, SMALL, name);
    }
}

fn draw_bars(page: &mut Page, area: Bounds, bars: &[Bar]) {
    let cell = area.size().x / bars.len().max(1) as f64;
    for (k, bar) in bars.iter().enumerate() {
        let middle = area.low.x + cell * (k as f64 + 0.5);
        let half = (cell * 0.36).min(30.0);
        let mut share = 0.0;
        for (part, height) in bar.parts.iter().enumerate() {
            let low = DVec2::new(middle - half, at_share(area, share + height));
            let high = DVec2::new(middle + half, at_share(area, share));
            page.outlines(vec![Bounds { low, high }.corners().to_vec()], Ink::fill(colour(part)), None);
            share += height;
        }
        let above = DVec2::new(middle, at_share(area, share) - 3.0);
        page.words(above, Anchor::Middle, SMALL, &bar.count.to_string());
        for (line, words) in bar.name.lines().enumerate() {
            let at = DVec2::new(middle, area.high.y + 4.0 + SMALL * (1.0 + 1.15 * line as f64));
            page.words(at, Anchor::Middle, SMALL, words);
        }
    }
}

/// Draws curves on a scale of shares from 0 to `top`.
fn draw_curves(page: &mut Page, area: Bounds, curves: &[Shares], top: f64) {
    let last = curves.iter().map(|curve| curve.shares.len()).max().unwrap_or(0).saturating_sub(1).max(1);
    let at = |number: usize| area.low.x + area.size().x * number as f64 / last as f64;
    for number in (0..=last).step_by(last.div_ceil(6)) {
        let tick = vec![DVec2::new(at(number), area.high.y), DVec2::new(at(number), area.high.y + 3.0)];
        page.lines(vec![tick], Ink::stroke(colours::INK, 0.9), None);
        let place = DVec2::new(at(number), area.high.y + 4.0 + SMALL);
        page.words(place, Anchor::Middle, SMALL, &number.to_string());
    }
    for (k, curve) in curves.iter().enumerate() {
        let line = curve.shares.iter().enumerate().map(|(n, &share)| DVec2::new(at(n), at_share(area, share / top)));
        page.lines(vec![line.collect()], Ink::stroke(colour(k), 1.8), None);
    }
}
