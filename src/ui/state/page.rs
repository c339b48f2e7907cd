//! Requests to the page, and gestures that move charts on it.

use std::collections::BTreeSet;

use eframe::egui;
use glam::{DAffine2, DVec2};

use crate::session::movement_about;
use freebound_core::geom::Bounds;

/// Request to the page, on which all charts lie.
#[derive(Clone, Debug, PartialEq)]
pub enum PageRequest {
    /// Shows all charts on the page, or the chart on the screen alone.
    Show(bool),
    /// Shows the page, or the chart on the screen alone.
    Toggle,
    /// Selects a chart, or nothing. `adds` adds the chart to the selection, or takes it away.
    Pick {
        /// The chart.
        chart: Option<usize>,
        /// True to keep the selection.
        adds: bool,
    },
    /// Selects charts in addition to those that are selected.
    Add(Vec<usize>),
    /// Shows a chart alone, to work on its vertices. Default: the first selected chart.
    Open(Option<usize>),
    /// Starts a gesture that follows the pointer.
    Begin(GestureKind),
    /// Restricts a move to an axis, or frees it.
    Lock(Axis),
    /// Adds a letter to the typed number of a gesture. `None` removes the last letter.
    Type(Option<char>),
    /// Ends a gesture; it becomes an edit.
    End,
    /// Lines up the selected charts.
    Align(Alignment),
    /// Spaces the selected charts evenly along an axis.
    Distribute(Axis),
    /// Mirrors each selected chart in place, left to right or top to bottom.
    Mirror(Axis),
    /// Scales each selected chart in place to a density, pixels per unit of length.
    SetDensity(f64),
    /// Packs the selected charts around the others, or all if none is selected.
    Pack,
    /// Packs all charts that are not locked.
    PackAll,
    /// Lays the selected charts on the first of them.
    Stack,
    /// Gives the selected charts places of their own.
    Unstack,
    /// Sets the places that moved charts snap to.
    SetSnap(Snap),
}

/// Kinds of gestures on charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GestureKind {
    /// Moves charts.
    Move,
    /// Turns charts about the centre of the selection.
    Turn,
    /// Scales charts about the centre of the selection.
    Scale,
}

impl GestureKind {
    /// All kinds, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Move, Self::Turn, Self::Scale];

    /// Title for menus and buttons.
    pub const fn title(self) -> &'static str {
        ["Move", "Turn", "Scale"][self as usize]
    }

    /// Key that starts the gesture on selected charts.
    pub const fn key(self) -> egui::Key {
        [egui::Key::G, egui::Key::R, egui::Key::S][self as usize]
    }

    /// Description for menus and the list of keys.
    pub const fn about(self) -> &'static str {
        [
            "Move the selected charts with the pointer; a click ends it",
            "Turn the selected charts about the centre of the selection; a click ends it",
            "Scale the selected charts about the centre of the selection; a click ends it",
        ][self as usize]
    }
}

/// Axes of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal: u.
    X,
    /// Vertical: v.
    Y,
}

impl Axis {
    /// Both axes.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    /// Unit vector along the axis.
    pub const fn unit(self) -> DVec2 {
        match self {
            Self::X => DVec2::X,
            Self::Y => DVec2::Y,
        }
    }
}

/// Lines that charts are aligned at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// Left sides at the left side of the selection.
    Left,
    /// Centres on one vertical line.
    Centre,
    /// Right sides at the right side of the selection.
    Right,
    /// Upper sides at the upper side of the selection.
    Top,
    /// Centres on one horizontal line.
    Middle,
    /// Lower sides at the lower side of the selection.
    Bottom,
}

impl Alignment {
    /// All alignments, in the order of menus.
    pub const ALL: [Self; 6] = [Self::Left, Self::Centre, Self::Right, Self::Top, Self::Middle, Self::Bottom];

    /// Title for menus.
    pub const fn title(self) -> &'static str {
        ["Left", "Centre", "Right", "Top", "Middle", "Bottom"][self as usize]
    }

    /// Displacement that lines up a chart with these bounds within the bounds of the selection.
    pub fn shift(self, own: Bounds, of_selection: Bounds) -> DVec2 {
        let by = |at: fn(Bounds) -> DVec2| at(of_selection) - at(own);
        match self {
            Self::Left => by(|bounds| bounds.low) * DVec2::X,
            Self::Centre => by(Bounds::middle) * DVec2::X,
            Self::Right => by(|bounds| bounds.high) * DVec2::X,
            Self::Top => by(|bounds| bounds.high) * DVec2::Y,
            Self::Middle => by(Bounds::middle) * DVec2::Y,
            Self::Bottom => by(|bounds| bounds.low) * DVec2::Y,
        }
    }
}

/// Places that moved charts snap to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Snap {
    /// Any place.
    #[default]
    Off,
    /// Corners of pixels of the picture.
    Pixels,
    /// Lines of the background grid.
    Grid,
    /// Sides of other charts and of the page.
    Charts,
}

impl Snap {
    /// All kinds of places, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Off, Self::Pixels, Self::Grid, Self::Charts];

    /// Title for menus.
    pub const fn title(self) -> &'static str {
        ["No snapping", "Snap to pixels", "Snap to the grid", "Snap to charts"][self as usize]
    }
}

/// Steps of a turn that snaps, degrees.
const TURN_STEP: f64 = 15.0;

/// Steps of a scale that snaps.
const SCALE_STEP: f64 = 0.1;

/// Distance from the pivot, relative to the selection's extent, below which a pointer has no direction.
const AT_PIVOT: f64 = 1e-6;

/// Gesture that moves, turns or scales charts. Positions are in the page's plane.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) struct PageGesture {
    pub(in crate::ui) kind: GestureKind,
    pub(in crate::ui) charts: BTreeSet<usize>,
    /// Bounds of the charts at the start.
    bounds: Bounds,
    /// Pointer at the start, and now.
    from: DVec2,
    to: DVec2,
    axis: Option<Axis>,
    typed: String,
    /// True if the gesture ends when the button is released.
    pub(in crate::ui) is_drag: bool,
    /// True once the pointer was over the page.
    pub(in crate::ui) has_start: bool,
}

/// Places that a gesture snaps to.
#[derive(Clone, Debug, Default)]
pub(in crate::ui) struct SnapPlaces {
    pub(in crate::ui) snap: Snap,
    /// Width and height of a pixel of the picture.
    pub(in crate::ui) pixel: DVec2,
    /// Distance of the grid's lines.
    pub(in crate::ui) grid: f64,
    /// Bounds of the page and of charts that stay.
    pub(in crate::ui) others: Vec<Bounds>,
    /// Distance within which sides of charts attract.
    pub(in crate::ui) reach: f64,
}

impl PageGesture {
    pub(in crate::ui) fn new(kind: GestureKind, charts: BTreeSet<usize>, bounds: Bounds, from: DVec2) -> Self {
        Self { kind, charts, bounds, from, to: from, axis: None, typed: String::new(), is_drag: false, has_start: true }
    }

    /// Gesture that ends when the button is released, or by a click or a key.
    pub(in crate::ui) fn with_drag(self, is_drag: bool) -> Self {
        Self { is_drag, ..self }
    }

    /// Gesture that begins away from the page: its start is the first place of the pointer over the page.
    pub(in crate::ui) fn begun_elsewhere(self) -> Self {
        Self { has_start: false, ..self }
    }

    pub(in crate::ui) fn follow(&mut self, pointer: DVec2) {
        if !std::mem::replace(&mut self.has_start, true) {
            self.from = pointer;
        }
        self.to = pointer;
    }

    /// Restricts the move to an axis, or frees it if it is restricted to that axis.
    pub(in crate::ui) fn lock(&mut self, axis: Axis) {
        self.axis = Some(axis).filter(|axis| self.axis != Some(*axis));
    }

    /// Adds a letter to the typed number. A minus sign changes the sign.
    pub(in crate::ui) fn type_letter(&mut self, letter: Option<char>) {
        match letter {
            None => drop(self.typed.pop()),
            Some('-') if self.typed.starts_with('-') => drop(self.typed.remove(0)),
            Some('-') => self.typed.insert(0, '-'),
            Some('.') if self.typed.contains('.') => {}
            Some(letter) => self.typed.push(letter),
        }
    }

    /// Typed number, if there is one.
    fn number(&self) -> Option<f64> {
        self.typed.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// Movement of the charts. Typed numbers count in pixels, degrees, or as a factor.
    pub(in crate::ui) fn movement(&self, places: &SnapPlaces) -> DAffine2 {
        let pivot = self.bounds.middle();
        let about = |by: DAffine2| movement_about(pivot, by);
        match self.kind {
            GestureKind::Move => DAffine2::from_translation(self.shift(places)),
            GestureKind::Turn => about(DAffine2::from_angle(self.degrees(places.snap).to_radians())),
            GestureKind::Scale => about(DAffine2::from_scale(DVec2::splat(self.factor(places.snap)))),
        }
    }

    fn shift(&self, places: &SnapPlaces) -> DVec2 {
        if let Some(number) = self.number() {
            return self.axis.unwrap_or(Axis::X).unit() * number * places.pixel;
        }
        let along = self.axis.map_or(DVec2::ONE, Axis::unit);
        let by = (self.to - self.from) * along;
        by + places.attraction(Bounds { low: self.bounds.low + by, high: self.bounds.high + by }) * along
    }

    /// Directions from the pivot to the pointer at the start and now; `None` if the pointer is at the pivot.
    fn arms(&self) -> Option<[DVec2; 2]> {
        let arms = [self.from, self.to].map(|at| at - self.bounds.middle());
        arms.iter().all(|arm| arm.length() > AT_PIVOT * self.bounds.extent()).then_some(arms)
    }

    fn degrees(&self, snap: Snap) -> f64 {
        let turned = || self.arms().map_or(0.0, |[from, to]| from.angle_to(to).to_degrees());
        let degrees = self.number().unwrap_or_else(turned);
        if snap == Snap::Off || self.number().is_some() { degrees } else { (degrees / TURN_STEP).round() * TURN_STEP }
    }

    fn factor(&self, snap: Snap) -> f64 {
        let scaled = || self.arms().map_or(1.0, |[from, to]| to.length() / from.length());
        let factor = self.number().unwrap_or_else(scaled);
        let snapped = if snap == Snap::Off || self.number().is_some() {
            factor
        } else {
            ((factor / SCALE_STEP).round() * SCALE_STEP).max(SCALE_STEP)
        };
        if snapped > 0.0 { snapped } else { 1.0 }
    }

    /// Description of the movement so far.
    pub(in crate::ui) fn words(&self, places: &SnapPlaces) -> String {
        let typed = if self.typed.is_empty() { String::new() } else { format!(" (typed {})", self.typed) };
        let axis = match self.axis {
            Some(Axis::X) => " along x",
            Some(Axis::Y) => " along y",
            None => "",
        };
        match self.kind {
            GestureKind::Move => {
                let by = self.shift(places) / places.pixel;
                format!("Move{axis}: {:.1}, {:.1} px{typed}", by.x, by.y)
            }
            GestureKind::Turn => format!("Turn: {:.1}°{typed}", self.degrees(places.snap)),
            GestureKind::Scale => format!("Scale: {:.3}{typed}", self.factor(places.snap)),
        }
    }
}

impl SnapPlaces {
    /// Displacement from a box to the place that attracts it.
    fn attraction(&self, own: Bounds) -> DVec2 {
        let to_grid = |step: DVec2| (own.low / step).round() * step - own.low;
        match self.snap {
            Snap::Off => DVec2::ZERO,
            Snap::Pixels => to_grid(self.pixel),
            Snap::Grid => to_grid(DVec2::splat(self.grid)),
            Snap::Charts => {
                let sides = |bounds: &Bounds| [bounds.low, bounds.high];
                let nearest = |axis: usize| {
                    let pairs = self.others.iter().flat_map(sides).flat_map(|to| sides(&own).map(|side| to - side));
                    let by = pairs.map(|by| by[axis]).min_by(|a, b| a.abs().total_cmp(&b.abs()));
                    by.filter(|by| by.abs() <= self.reach).unwrap_or(0.0)
                };
                DVec2::new(nearest(0), nearest(1))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: Bounds = Bounds { low: DVec2::new(1.0, 1.0), high: DVec2::new(3.0, 2.0) };

    fn gesture(kind: GestureKind) -> PageGesture {
        PageGesture::new(kind, BTreeSet::from([0]), SQUARE, DVec2::new(3.0, 1.5))
    }

    fn places(snap: Snap) -> SnapPlaces {
        let others = vec![Bounds { low: DVec2::ZERO, high: DVec2::new(0.5, 4.0) }];
        SnapPlaces { snap, pixel: DVec2::splat(0.01), grid: 0.25, others, reach: 0.1 }
    }

    fn assert_near(a: DVec2, b: DVec2) {
        assert!(a.distance(b) < 1e-12, "{a} {b}");
    }

    #[test]
    fn a_move_follows_the_pointer_along_a_locked_axis_or_a_typed_number_of_pixels() {
        let mut gesture = gesture(GestureKind::Move);
        gesture.follow(DVec2::new(3.5, 1.25));
        let moved = |gesture: &PageGesture| gesture.movement(&places(Snap::Off)).transform_point2(DVec2::ZERO);
        assert_near(moved(&gesture), DVec2::new(0.5, -0.25));
        gesture.lock(Axis::Y);
        assert_near(moved(&gesture), DVec2::new(0.0, -0.25));
        for letter in ['1', '2', '-', '.', '5', '.'] {
            gesture.type_letter(Some(letter));
        }
        assert_near(moved(&gesture), DVec2::new(0.0, -0.125));
        gesture.lock(Axis::Y);
        gesture.type_letter(None);
        assert_near(moved(&gesture), DVec2::new(-0.12, 0.0));
    }

    #[test]
    fn a_turn_and_a_scale_keep_the_centre_of_the_selection() {
        let centre = SQUARE.middle();
        let mut turn = gesture(GestureKind::Turn);
        turn.follow(centre + DVec2::new(0.0, 3.0));
        let by = turn.movement(&places(Snap::Off));
        assert_near(by.transform_point2(centre), centre);
        assert_near(by.transform_vector2(DVec2::X), DVec2::Y);
        let mut scale = gesture(GestureKind::Scale);
        scale.follow(centre + DVec2::new(0.0, 2.52));
        assert_near(scale.movement(&places(Snap::Off)).transform_vector2(DVec2::X), DVec2::new(2.52, 0.0));
        assert_near(scale.movement(&places(Snap::Pixels)).transform_vector2(DVec2::X), DVec2::new(2.5, 0.0));
        scale.type_letter(Some('0'));
        assert_near(scale.movement(&places(Snap::Off)).transform_vector2(DVec2::X), DVec2::X);
    }

    #[test]
    fn a_pointer_that_starts_at_the_pivot_turns_and_scales_nothing() {
        for kind in [GestureKind::Turn, GestureKind::Scale] {
            let mut gesture = PageGesture::new(kind, BTreeSet::from([0]), SQUARE, SQUARE.middle());
            gesture.follow(DVec2::new(9.0, 9.0));
            assert_eq!(gesture.movement(&places(Snap::Off)), DAffine2::IDENTITY);
        }
    }

    #[test]
    fn a_move_snaps_to_pixels_the_grid_and_the_sides_of_charts() {
        let low = |snap: Snap, to: DVec2| {
            let mut gesture = gesture(GestureKind::Move);
            gesture.follow(DVec2::new(3.0, 1.5) + to);
            SQUARE.low + gesture.movement(&places(snap)).transform_point2(DVec2::ZERO)
        };
        assert_near(low(Snap::Pixels, DVec2::new(0.004, 0.006)), DVec2::new(1.0, 1.01));
        assert_near(low(Snap::Grid, DVec2::new(0.13, 0.1)), DVec2::new(1.25, 1.0));
        assert_near(low(Snap::Charts, DVec2::new(-0.45, 0.3)), DVec2::new(0.5, 1.3));
        assert_near(low(Snap::Charts, DVec2::new(-0.2, 0.3)), DVec2::new(0.8, 1.3));
    }

    #[test]
    fn alignments_move_sides_and_centres_to_those_of_the_selection() {
        let all = Bounds { low: DVec2::ZERO, high: DVec2::splat(10.0) };
        let expected = [(-1.0, 0.0), (3.0, 0.0), (7.0, 0.0), (0.0, 8.0), (0.0, 3.5), (0.0, -1.0)];
        for (alignment, (x, y)) in Alignment::ALL.into_iter().zip(expected) {
            assert_near(alignment.shift(SQUARE, all), DVec2::new(x, y));
        }
    }
}
