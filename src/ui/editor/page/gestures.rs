//! Gestures that move charts on the page. Each frame asks the session for a movement; an accepted one is drawn.

use std::collections::BTreeSet;

use glam::{DAffine2, DVec2};

use crate::session::{Action, ChartMove};
use crate::ui::Editor;
use crate::ui::state::{GestureKind, PageGesture, Snap, SnapPlaces};
use freebound_core::geom::Bounds;

/// Distance within which sides of charts attract, points of the screen.
const REACH: f64 = 8.0;

impl Editor {
    /// Starts a gesture on the selected charts at a point of the page's plane. Without a point, it starts where the
    /// pointer comes over the page. Returns true if there is something to move.
    pub(in crate::ui) fn begin_gesture(&mut self, kind: GestureKind, from: Option<DVec2>, is_drag: bool) -> bool {
        let Some(scene) = self.plane.page.scene.as_ref().filter(|_| self.session.can_move_charts()) else {
            return false;
        };
        let charts = self.movable_charts();
        if charts.is_empty() {
            return false;
        }
        let bounds = scene.bounds_of(charts.iter().copied());
        let gesture = PageGesture::new(kind, charts, bounds, from.unwrap_or(bounds.middle())).with_drag(is_drag);
        self.plane.page.gesture = Some(if from.is_some() { gesture } else { gesture.begun_elsewhere() });
        true
    }

    /// Selected charts that neither a lock nor pins hold.
    pub fn movable_charts(&self) -> BTreeSet<usize> {
        self.plane.page.selected().iter().copied().filter(|&chart| self.session.is_movable(chart)).collect()
    }

    /// Lets a gesture follow the pointer, in the page's plane. `has_ctrl` turns snapping on or off; `insists` lets charts
    /// overlap.
    pub(in crate::ui) fn follow_gesture(&mut self, pointer: Option<DVec2>, has_ctrl: bool, insists: bool) {
        let places = self.snap_places(has_ctrl);
        let Some(gesture) = &mut self.plane.page.gesture else { return };
        if let Some(pointer) = pointer {
            gesture.follow(pointer);
        }
        let by = gesture.movement(&places);
        let moves: Vec<ChartMove> = gesture.charts.iter().map(|&chart| (chart, by)).collect();
        self.ask_to_move(moves, insists);
    }

    /// Asks for movements, unless the last frame asked for the same.
    fn ask_to_move(&mut self, moves: Vec<ChartMove>, insists: bool) {
        let wanted = Some((moves.clone(), insists));
        let is_idle = self.plane.page.asked.is_none() && moves.iter().all(|(_, by)| *by == DAffine2::IDENTITY);
        if self.plane.page.asked != wanted && !is_idle && !self.session.is_ending_move() {
            self.plane.page.asked = wanted;
            self.session.handle(Action::MoveCharts { moves, insists });
        }
    }

    /// Drops a gesture whose charts or page have gone, and a gesture whose move the session has dropped. Call once per
    /// frame.
    pub(in crate::ui::editor) fn check_gesture(&mut self) {
        if self.plane.page.gesture.is_none() {
            return;
        }
        let is_dropped = self.plane.page.asked.is_some() && !self.session.is_moving_charts();
        if is_dropped || !self.shows_page() || self.plane.page.pane.rect().is_none() {
            self.drop_gesture();
        }
    }

    /// Moves charts in one edit.
    pub(super) fn move_at_once(&mut self, moves: Vec<ChartMove>) {
        if moves.is_empty() || self.session.is_moving_charts() {
            return;
        }
        self.plane.page.asked = Some((moves.clone(), false));
        self.session.handle(Action::MoveCharts { moves, insists: false });
        self.session.handle(Action::EndMove);
    }

    /// Ends the gesture; it becomes an edit. Returns true if there was one.
    pub(in crate::ui) fn end_gesture(&mut self) -> bool {
        let had_one = self.plane.page.gesture.take().is_some();
        if had_one {
            self.session.handle(Action::EndMove);
        }
        had_one
    }

    /// Drops the gesture. Returns true if there was one.
    pub(in crate::ui) fn drop_gesture(&mut self) -> bool {
        let had_one = self.plane.page.gesture.take().is_some();
        if had_one {
            self.plane.page.asked = None;
            self.session.handle(Action::GiveUpMove);
        }
        had_one
    }

    /// Places that the gesture snaps to. With Ctrl, snapping is off if it is on, and to pixels if it is off.
    pub(in crate::ui) fn snap_places(&self, has_ctrl: bool) -> SnapPlaces {
        let snap = match (self.plane.page.snap, has_ctrl) {
            (snap, false) => snap,
            (Snap::Off, true) => Snap::Pixels,
            (_, true) => Snap::Off,
        };
        let (Some(scene), Some(camera)) = (&self.plane.page.scene, self.plane.page.pane.camera()) else {
            return SnapPlaces { snap, pixel: DVec2::ONE, grid: 1.0, ..SnapPlaces::default() };
        };
        let [width, height] = self.session.packing().picture.map(f64::from);
        let others = || {
            let is_moved =
                |chart: &usize| self.plane.page.gesture.as_ref().is_some_and(|own| own.charts.contains(chart));
            let stay = (0..scene.spans.len()).filter(|chart| !is_moved(chart));
            let bounds: Vec<Bounds> = stay.map(|chart| scene.bounds_of([chart])).collect();
            std::iter::once(scene.page_box()).chain(bounds).collect()
        };
        SnapPlaces {
            snap,
            pixel: DVec2::new(scene.aspect / width, 1.0 / height),
            grid: camera.grid().step,
            others: if snap == Snap::Charts { others() } else { Vec::new() },
            reach: REACH / camera.points_per_unit(),
        }
    }

    /// Moves the selected charts by pixels of the picture; y points up.
    pub(in crate::ui) fn nudge_charts(&mut self, pixels: DVec2) {
        if self.session.is_moving_charts() {
            return;
        }
        let by = DAffine2::from_translation(pixels * self.snap_places(false).pixel);
        let moves = self.movable_charts().into_iter().map(|chart| (chart, by)).collect();
        self.move_at_once(moves);
    }
}
