//! Pieces beside each other on a sheet, in rows.

use glam::DVec2;

use super::pieces::Piece;
use super::{PatternError, PatternOptions};
use freebound_core::geom::{Bounds, least_box_turn};

/// Distance between pieces, and to the edge of the sheet, millimetres.
pub(super) const GAP: f64 = 5.0;

/// Area of a sheet relative to the boxes of its pieces.
const SPARE: f64 = 1.15;

/// Turns each piece into its box of least area, the longer side upright, and lays the pieces in rows, the highest first.
/// A single piece keeps its direction. The lower left corner of the sheet is the origin.
pub(super) fn arranged(pieces: Vec<Piece>, options: PatternOptions) -> Result<Vec<Piece>, PatternError> {
    let is_alone = pieces.len() == 1 && options.sheet_width.is_none();
    let turned: Vec<Piece> = pieces.into_iter().map(|piece| if is_alone { piece } else { upright(piece) }).collect();
    let sizes: Vec<DVec2> = turned.iter().map(|piece| bounds_of(piece).size()).collect();
    let widest = sizes.iter().fold(0.0, |most: f64, size| most.max(size.x));
    let area: f64 = sizes.iter().map(|size| (size.x + GAP) * (size.y + GAP)).sum();
    let width = options.sheet_width.unwrap_or_else(|| (SPARE * area).sqrt().max(widest + 2.0 * GAP));
    if let Some(place) = sizes.iter().position(|size| size.x + 2.0 * GAP > width * (1.0 + f64::EPSILON)) {
        return Err(PatternError::TooWide {
            chart: turned[place].number,
            width: sizes[place].x + 2.0 * GAP,
            sheet: width,
        });
    }
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[b].y.total_cmp(&sizes[a].y).then(a.cmp(&b)));
    let mut corners = vec![DVec2::ZERO; sizes.len()];
    let (mut at, mut row) = (DVec2::splat(GAP), 0.0_f64);
    for place in order {
        if at.x > GAP && at.x + sizes[place].x + GAP > width {
            at = DVec2::new(GAP, at.y + row + GAP);
            row = 0.0;
        }
        corners[place] = at;
        at.x += sizes[place].x + GAP;
        row = row.max(sizes[place].y);
    }
    let placed = turned.into_iter().zip(corners).map(|(piece, corner)| {
        let shift = corner - bounds_of(&piece).low;
        piece.moved(|point| point + shift)
    });
    Ok(placed.collect())
}

/// Box around the cutting lines of a piece.
pub(super) fn bounds_of(piece: &Piece) -> Bounds {
    Bounds::of(piece.cut.iter().flatten().copied())
}

fn upright(piece: Piece) -> Piece {
    let points: Vec<DVec2> = piece.cut.iter().flatten().copied().collect();
    let turn = least_box_turn(&points);
    let piece = piece.moved(|point| turn.rotate(point));
    let size = bounds_of(&piece).size();
    if size.x > size.y { piece.moved(DVec2::perp) } else { piece }
}
