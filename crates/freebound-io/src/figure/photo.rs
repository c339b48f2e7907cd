//! Picture drawn into an area, with numbered marks.

use glam::DVec2;

use super::{Anchor, Ink, Item, Page, colours};
use freebound_core::geom::{Bounds, Picture};

/// Half the diagonal of a mark, points.
const MARK: f64 = 3.6;

/// Size of the marks' numbers.
const WORDS: f64 = 8.0;

/// Picture in a panel, as large as fits.
#[derive(Clone, Debug)]
pub struct PhotoDrawing {
    /// The picture.
    pub picture: Picture,
    /// Positions of marks, numbered from 1: fractions of the picture's width and height, from its lower left corner.
    pub marks: Vec<DVec2>,
}

impl PhotoDrawing {
    /// Draws the picture into an area.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        let pixels = DVec2::new(f64::from(self.picture.width), f64::from(self.picture.height));
        let size = pixels * (area.size() / pixels).min_element();
        let shown = Bounds::at(area.middle() - size / 2.0, size);
        page.items.push(Item::Picture(shown, self.picture.clone()));
        let place = |mark: &DVec2| shown.low + DVec2::new(mark.x, 1.0 - mark.y) * size;
        let diamond = |at: DVec2| [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|way| at + MARK * way).to_vec();
        let outlines = self.marks.iter().map(|mark| diamond(place(mark))).collect();
        page.outlines(outlines, Ink::both(colours::CONSTRAINT, colours::PAPER, 1.0), None);
        for (number, mark) in (1..).zip(&self.marks) {
            let text = format!("{number}");
            // The number is beside its mark, on the side away from the middle, which has fewer other marks.
            let beside = if mark.x < 0.5 { -2.6 * MARK } else { 1.3 * MARK };
            page.words(place(mark) + DVec2::new(beside, -0.6 * MARK), Anchor::Start, WORDS, &text);
        }
    }
}
