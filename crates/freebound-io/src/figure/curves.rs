//! Curves drawn into an area: a quantity over time, both on logarithmic axes.

use glam::DVec2;

use super::{Anchor, Ink, Page, colours};
use crate::raster::Colour;
use freebound_core::geom::Bounds;

/// Space for the numbers at the left, and for those below with the name of the axis.
const LEFT: f64 = 34.0;
const BELOW: f64 = 26.0;
/// Space for the name of the vertical axis.
const ABOVE: f64 = 18.0;
/// Margin at the right.
const RIGHT: f64 = 8.0;

/// Size of the words.
const WORDS: f64 = 8.0;

/// Least distance between the names of two powers of ten.
const ROOM: DVec2 = DVec2::new(34.0, 11.0);

/// Width of a curve, and half the side of the square at a step, points.
const CURVE: f64 = 1.2;
const STEP: f64 = 1.2;

/// Curve with its name.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name of the curve.
    pub name: String,
    /// Time and quantity. Only positive values are drawn.
    pub points: Vec<DVec2>,
}

/// Curves over a shared time axis.
#[derive(Clone, Debug)]
pub struct Curves {
    /// Names of the axes: time, quantity.
    pub axes: [String; 2],
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Colours of the curves, in order, repeated if there are more curves.
const COLOURS: [Colour; 8] = [
    [0x2f, 0x5b, 0xd8],
    [0xd9, 0x2d, 0x3a],
    [0x1f, 0x8a, 0x4c],
    [0xe8, 0x70, 0x0a],
    [0x7a, 0x3f, 0xb5],
    [0x00, 0x8f, 0xa3],
    [0x8a, 0x6d, 0x00],
    [0x55, 0x55, 0x55],
];

impl Curves {
    /// Draws the curves into an area.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        let low = area.low + DVec2::new(LEFT, ABOVE);
        let plot = Bounds { low, high: area.high - DVec2::new(RIGHT, BELOW) };
        let curves: Vec<Vec<DVec2>> = self.curves.iter().map(|curve| logarithms(&curve.points)).collect();
        let bounds = Bounds::of(curves.iter().flatten().copied());
        if !bounds.low.is_finite() {
            return;
        }
        let span = whole_decades(bounds);
        let place = |p: DVec2| {
            let share = (p - span.low) / span.size();
            DVec2::new(plot.low.x + share.x * plot.size().x, plot.high.y - share.y * plot.size().y)
        };
        self.draw_axes(page, plot, span);
        for (number, curve) in curves.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            let line: Vec<DVec2> = curve.iter().map(|&p| place(p)).collect();
            let square = |&at: &DVec2| {
                let half = DVec2::splat(STEP);
                Bounds { low: at - half, high: at + half }.corners().to_vec()
            };
            page.outlines(line.iter().map(square).collect(), Ink::fill(colour), None);
            page.lines(vec![line], Ink::stroke(colour, CURVE), None);
        }
    }

    /// Draws lines at the powers of ten, with their numbers.
    fn draw_axes(&self, page: &mut Page, plot: Bounds, span: Bounds) {
        let grid = Ink::stroke(colours::GRID, 0.5);
        let step = DVec2::ONE / span.size() * plot.size();
        // Names of neighbours do not touch.
        let every = |room: f64, step: f64| (room / step).ceil().max(1.0);
        let [across, up] = [every(ROOM.x, step.x), every(ROOM.y, step.y)];
        let is_named = |k: u32, every: f64| (f64::from(k) % every).abs() < 0.5;
        for (k, words) in (0_u32..).zip(decades(span.low.x, span.high.x)) {
            let x = plot.low.x + f64::from(k) * step.x;
            page.lines(vec![vec![DVec2::new(x, plot.low.y), DVec2::new(x, plot.high.y)]], grid, None);
            if is_named(k, across) {
                page.words(DVec2::new(x, plot.high.y + 1.3 * WORDS), Anchor::Middle, WORDS, &words);
            }
        }
        for (k, words) in (0_u32..).zip(decades(span.low.y, span.high.y)) {
            let y = plot.high.y - f64::from(k) * step.y;
            page.lines(vec![vec![DVec2::new(plot.low.x, y), DVec2::new(plot.high.x, y)]], grid, None);
            if is_named(k, up) {
                page.words(DVec2::new(plot.low.x - LEFT + 3.0, y + 0.35 * WORDS), Anchor::Start, WORDS, &words);
            }
        }
        let [time, quantity] = &self.axes;
        page.words(DVec2::new(plot.middle().x, plot.high.y + 2.7 * WORDS), Anchor::Middle, WORDS, time);
        page.words(plot.low - DVec2::new(LEFT - 3.0, 0.7 * WORDS), Anchor::Start, WORDS, quantity);
    }

    /// Names of the curves with their colours, for a legend.
    pub(super) fn key(&self) -> impl Iterator<Item = (&str, Colour)> {
        self.curves.iter().zip(COLOURS.iter().cycle()).map(|(curve, &colour)| (curve.name.as_str(), colour))
    }
}

/// Logarithms to base 10 of the points with positive coordinates.
fn logarithms(points: &[DVec2]) -> Vec<DVec2> {
    let logarithm = |p: &DVec2| DVec2::new(p.x.log10(), p.y.log10());
    points.iter().map(logarithm).filter(|p| p.is_finite()).collect()
}

/// Bounds at powers of ten around a box of logarithms, at least one decade in each direction.
fn whole_decades(bounds: Bounds) -> Bounds {
    let low = bounds.low.floor();
    Bounds { low, high: bounds.high.ceil().max(low + 1.0) }
}

/// Powers of ten from one exponent to another, as text.
fn decades(low: f64, high: f64) -> Vec<String> {
    let mut words = Vec::new();
    let mut exponent = low;
    while exponent <= high {
        words.push(match exponent {
            -3.0..=4.0 => format!("{}", 10_f64.powf(exponent)),
            _ => format!("1e{exponent}"),
        });
        exponent += 1.0;
    }
    words
}
