//! Turns in which a chart is tried.

use glam::DVec2;

use crate::geom::Bounds;

/// Turn by 22.5°.
const EIGHTH: DVec2 = DVec2::new(0.923_879_532_511_286_7, 0.382_683_432_365_089_8);

/// Exact quarter turns.
pub(crate) const QUARTERS: [DVec2; 4] = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];

/// Width and height of the bounding box of turned points.
pub(crate) fn size_of(points: &[DVec2], turn: DVec2) -> DVec2 {
    Bounds::of(points.iter().map(|&point| turn.rotate(point))).size()
}

/// Quarter turns of a turn, then of turns by multiples of 22.5° from it; `steps` of these, at most 4.
pub(crate) fn fan(turn: DVec2, steps: usize) -> Vec<DVec2> {
    let starts = std::iter::successors(Some(turn), |&turn| Some(EIGHTH.rotate(turn)));
    starts.take(steps).flat_map(|start| QUARTERS.map(|quarter| quarter.rotate(start))).collect()
}
