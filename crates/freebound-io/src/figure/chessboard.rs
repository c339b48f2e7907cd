//! Chessboard with a letter and a digit in each square, from A1 at the lower left to H8 at the upper right.
//!
//! Charts with the picture show at once if they are mirrored or turned. Columns differ in hue and neighbours in
//! lightness, so that a square is also found by its colour.

use glam::DVec2;

use super::{Ink, Page, strokes_of, width_of};
use crate::raster::Colour;
use freebound_core::geom::Picture;

/// Squares along a side.
const CHESSBOARD_SQUARES: u32 = 8;

/// Letters of the columns.
const COLUMNS: [char; CHESSBOARD_SQUARES as usize] = ['A', 'B', 'C', 'D', 'E', 'F', 'G', 'H'];

/// Size of the letters, relative to a square, and width of their strokes.
const LETTERS: f64 = 0.62;
const STROKE: f64 = 0.085;

/// Height of capitals relative to the size of letters.
const CAPITALS: f64 = 0.7;

/// Saturation and brightness of the light and of the dark squares.
const TONES: [[f64; 2]; 2] = [[0.22, 0.97], [0.62, 0.50]];

/// Colours of the letters on the light and on the dark squares.
const INKS: [Colour; 2] = [[0x1c, 0x1e, 0x22], [0xff, 0xff, 0xff]];

/// Picture of the chessboard with squares of this many pixels. Equal on every system.
pub fn chessboard(square: u32) -> Picture {
    let count = f64::from(CHESSBOARD_SQUARES);
    let mut page = Page::new(DVec2::splat(count));
    for (row, column) in (0..CHESSBOARD_SQUARES).flat_map(|row| (0..CHESSBOARD_SQUARES).map(move |c| (row, c))) {
        let low = DVec2::new(f64::from(column), count - 1.0 - f64::from(row));
        let tone = usize::from((row + column) % 2 == 1);
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|corner| low + corner);
        page.path(vec![corners.to_vec()], true, Ink::fill(colour(column, tone)));
        let text = format!("{}{}", COLUMNS[column as usize], row + 1);
        let shift = DVec2::new(-width_of(&text, LETTERS), CAPITALS * LETTERS) / 2.0;
        let lines = strokes_of(&text, low + 0.5 + shift, LETTERS);
        page.path(lines, false, Ink::stroke(INKS[tone], STROKE));
    }
    page.picture(f64::from(square))
}

/// Colour of the squares of a column, in the light tone 0 or the dark tone 1.
fn colour(column: u32, tone: usize) -> Colour {
    let [saturation, brightness] = TONES[tone];
    let hue = f64::from(column) / f64::from(CHESSBOARD_SQUARES);
    // The hexcone model (Smith 1978): channel n lies 2n sixths of a turn behind red.
    [5.0, 3.0, 1.0].map(|offset: f64| {
        let k = (offset + 6.0 * hue) % 6.0;
        let value = brightness * (1.0 - saturation * k.min(4.0 - k).clamp(0.0, 1.0));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
        let byte = (255.0 * value).round() as u8;
        byte
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Side of a square in the tests, pixels.
    const SIDE: u32 = 40;

    fn square(picture: &Picture, [column, row]: [u32; 2]) -> Vec<[u8; 4]> {
        let [left, top] = [column * SIDE, (CHESSBOARD_SQUARES - 1 - row) * SIDE];
        let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        places.map(|(x, y)| picture.pixel(left + x, top + y).expect("inside")).collect()
    }

    #[test]
    fn every_square_is_unlike_all_others_however_they_are_turned_or_mirrored() {
        let picture = chessboard(SIDE);
        assert_eq!([picture.width, picture.height], [8 * SIDE; 2]);
        let mut seen = BTreeSet::new();
        for place in (0..8).flat_map(|row| (0..8).map(move |column| [column, row])) {
            let own = square(&picture, place);
            let inked: Vec<bool> = own.iter().map(|pixel| *pixel != own[0]).collect();
            let share = inked.iter().filter(|is_inked| **is_inked).count() * 100 / inked.len();
            assert!((8..40).contains(&share), "{place:?}: letters cover {share} %");
            assert!(seen.insert(own), "{place:?} is as another");
        }
    }

    #[test]
    fn a1_is_below_at_the_left_and_neighbours_differ_in_lightness() {
        let picture = chessboard(SIDE);
        let lightness = |place| {
            let [r, g, b, _] = square(&picture, place)[0].map(u32::from);
            2 * r + 5 * g + b
        };
        for [column, row] in (0..7).flat_map(|row| (0..7).map(move |column| [column, row])) {
            let own = lightness([column, row]);
            for other in [[column + 1, row], [column, row + 1]] {
                assert!(own.abs_diff(lightness(other)) > 300, "{column} {row} and {other:?}");
            }
        }
        let mut page = Page::new(DVec2::splat(8.0));
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|corner| DVec2::new(0.0, 7.0) + corner);
        page.path(vec![corners.to_vec()], true, Ink::fill(colour(0, 0)));
        let at = DVec2::new(0.5 - width_of("A1", LETTERS) / 2.0, 7.5 + CAPITALS * LETTERS / 2.0);
        page.path(strokes_of("A1", at, LETTERS), false, Ink::stroke(INKS[0], STROKE));
        let written = square(&page.picture(f64::from(SIDE)), [0, 0]);
        let own = square(&picture, [0, 0]);
        let dark = |pixels: &[[u8; 4]]| pixels.iter().map(|pixel| pixel[0] < 0x60).collect::<Vec<_>>();
        assert_eq!(dark(&written), dark(&own), "A1");
    }
}
