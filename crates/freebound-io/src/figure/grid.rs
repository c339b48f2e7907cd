//! Cells laid out on a grid, each a drawing with a title and lines of numbers. Below them are a colour bar with its
//! numbers, and a caption.
//!
//! Titles are broken into lines, and lines that are still too long have smaller letters: no words leave their cell.

use glam::DVec2;

use super::sheet::wrapped;
use super::{Anchor, Curves, Ink, Item, Page, TintedDrawing, colours, width_of};
use crate::raster::Colour;
use freebound_core::geom::{Bounds, Picture};

/// Margin around the page, points.
const MARGIN: f64 = 16.0;

/// Space between cells.
const GAP: f64 = 18.0;

/// Side of a cell's drawing.
const SIDE: f64 = 230.0;

/// Sizes of a title, and of the lines of numbers.
const TITLE: f64 = 12.0;
const WORDS: f64 = 10.0;

/// Distances to the next line, of a title and of numbers.
const TITLE_LINE: f64 = 17.0;
const LINE: f64 = 14.0;

/// Space for the line beside a name in a legend.
const KEY: f64 = 22.0;

/// Length and height of the colour bar, and the height with its numbers.
const BAR: DVec2 = DVec2::new(230.0, 9.0);
const BAR_ROOM: f64 = 44.0;

/// Content of a cell.
#[derive(Clone, Debug)]
pub enum CellContent {
    /// Embedding.
    Plane(TintedDrawing),
    /// Picture.
    Photo(Picture),
    /// Curves.
    Curves(Curves),
    /// Reason that there is no drawing.
    Words(String),
}

impl CellContent {
    /// Draws the content into a square area, with a line around it.
    pub(super) fn draw(&self, page: &mut Page, area: Bounds) {
        match self {
            Self::Plane(drawing) => drawing.draw(page, area),
            Self::Photo(picture) => page.items.push(Item::Picture(area, picture.clone())),
            Self::Curves(curves) => curves.draw(page, area),
            Self::Words(words) => {
                for (k, line) in wrapped(words, WORDS, area.size().x - 2.0 * MARGIN).iter().enumerate() {
                    page.words(area.middle() + DVec2::new(0.0, LINE * k as f64), Anchor::Middle, WORDS, line);
                }
            }
        }
        page.outlines(vec![area.corners().to_vec()], Ink::stroke(colours::EDGE, 0.5), None);
    }
}

/// Cell of a grid.
#[derive(Clone, Debug)]
pub struct GridCell {
    /// Line directly below the drawing.
    pub title: String,
    /// Lines below the title.
    pub lines: Vec<String>,
    /// Content of the drawing.
    pub content: CellContent,
}

/// Colour bar: colours and their meaning.
#[derive(Clone, Debug)]
pub struct ColourBar {
    /// Name of the coloured quantity.
    pub title: String,
    /// Colours from the low end to the high end.
    pub colours: Vec<Colour>,
    /// Labels along the bar: position from 0 to 1, and text.
    pub ticks: Vec<(f64, String)>,
}

/// Grid of cells in rows.
#[derive(Clone, Debug)]
pub struct PanelGrid {
    /// Cells, row by row.
    pub cells: Vec<GridCell>,
    /// Colour bar of all cells.
    pub bar: Option<ColourBar>,
    /// Caption of the grid.
    pub caption: String,
}

impl PanelGrid {
    /// Number of cells in a row of a grid of `count` cells. There are as few rows as with four cells per row, of
    /// about equal length.
    pub fn columns(count: usize) -> usize {
        let rows = count.div_ceil(4).max(1);
        count.div_ceil(rows).max(1)
    }

    /// Page with the cells, the bar and the caption.
    pub fn page(&self) -> Page {
        let columns = Self::columns(self.cells.len());
        let heights: Vec<f64> = self.cells.chunks(columns).map(row_height).collect();
        // A single cell still leaves space for the bar and a line of words.
        let width = 2.0 * MARGIN + columns.max(2) as f64 * (SIDE + GAP) - GAP;
        let caption = wrapped(&self.caption, WORDS, width - 2.0 * MARGIN);
        let below_cells = MARGIN + heights.iter().map(|height| height + GAP).sum::<f64>();
        let below_bar = below_cells + if self.bar.is_some() { BAR_ROOM } else { 0.0 };
        let mut page = Page::new(DVec2::new(width, below_bar + LINE * caption.len() as f64 + MARGIN));
        let mut y = MARGIN;
        for (cells, height) in self.cells.chunks(columns).zip(heights) {
            for (k, cell) in cells.iter().enumerate() {
                cell.draw(&mut page, DVec2::new(MARGIN + k as f64 * (SIDE + GAP), y));
            }
            y += height + GAP;
        }
        if let Some(bar) = &self.bar {
            bar.draw(&mut page, DVec2::new(MARGIN, below_cells));
        }
        for (k, line) in caption.iter().enumerate() {
            page.words(DVec2::new(MARGIN, below_bar + LINE * (k as f64 + 0.7)), Anchor::Start, WORDS, line);
        }
        page
    }
}

/// Height of a row: that of its highest cell.
fn row_height(cells: &[GridCell]) -> f64 {
    cells.iter().map(GridCell::height).fold(0.0, f64::max)
}

/// Type size of a line, smaller if the line would be wider than `width`.
fn fitting_size(line: &str, size: f64, width: f64) -> f64 {
    size * (width / width_of(line, size).max(f64::MIN_POSITIVE)).min(1.0)
}

impl GridCell {
    fn title_lines(&self) -> Vec<String> {
        wrapped(&self.title, TITLE, SIDE)
    }

    fn key(&self) -> Vec<(&str, Colour)> {
        if let CellContent::Curves(curves) = &self.content { curves.key().collect() } else { Vec::new() }
    }

    fn height(&self) -> f64 {
        let lines = self.lines.len() + self.key().len();
        SIDE + TITLE_LINE * self.title_lines().len() as f64 + LINE * lines as f64
    }

    /// Draws the cell with its upper left corner at a position.
    fn draw(&self, page: &mut Page, corner: DVec2) {
        let area = Bounds::at(corner, DVec2::splat(SIDE));
        self.content.draw(page, area);
        let mut at = DVec2::new(corner.x, area.high.y - 0.25 * TITLE_LINE);
        for line in self.title_lines() {
            at.y += TITLE_LINE;
            page.words(at, Anchor::Start, fitting_size(&line, TITLE, SIDE), &line);
        }
        for line in &self.lines {
            at.y += LINE;
            page.words(at, Anchor::Start, fitting_size(line, WORDS, SIDE), line);
        }
        for (name, colour) in self.key() {
            at.y += LINE;
            let middle = at - DVec2::new(0.0, 0.35 * WORDS);
            page.lines(vec![vec![middle, middle + DVec2::new(KEY - 6.0, 0.0)]], Ink::stroke(colour, 1.6), None);
            page.words(at + DVec2::new(KEY, 0.0), Anchor::Start, fitting_size(name, WORDS, SIDE - KEY), name);
        }
    }
}

impl ColourBar {
    /// Height of the bar, including its numbers.
    pub(super) const ROOM: f64 = BAR_ROOM;

    /// Draws the bar with its upper left corner at a position.
    pub(super) fn draw(&self, page: &mut Page, at: DVec2) {
        page.words(at + DVec2::new(0.0, 0.7 * LINE), Anchor::Start, WORDS, &self.title);
        let bar = Bounds::at(at + DVec2::new(0.0, LINE), BAR);
        let share = BAR.x / self.colours.len().max(1) as f64;
        for (k, &colour) in self.colours.iter().enumerate() {
            let part = Bounds::at(bar.low + DVec2::new(share * k as f64, 0.0), DVec2::new(share, BAR.y));
            page.outlines(vec![part.corners().to_vec()], Ink::fill(colour), None);
        }
        page.outlines(vec![bar.corners().to_vec()], Ink::stroke(colours::EDGE, 0.5), None);
        for (place, words) in &self.ticks {
            let at = DVec2::new(bar.low.x + place * BAR.x, bar.high.y);
            page.lines(vec![vec![at, at + DVec2::new(0.0, 3.0)]], Ink::stroke(colours::INK, 0.6), None);
            page.words(at + DVec2::new(0.0, LINE), Anchor::Middle, WORDS, words);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::{Curve, Words};

    /// Box around words, from the capitals to the descenders.
    fn bounds_of(words: &Words) -> Bounds {
        let width = width_of(&words.text, words.size);
        let left = if words.anchor == Anchor::Middle { words.at.x - width / 2.0 } else { words.at.x };
        let top = DVec2::new(left, words.at.y - 0.7 * words.size);
        Bounds { low: top, high: DVec2::new(left + width, words.at.y + 0.2 * words.size) }
    }

    fn cell(number: usize, content: CellContent) -> GridCell {
        let title = format!("Convex boundary {number}, Shape-preserving weights, on a regular polygon of many sides");
        let lines = vec!["planar, with 0 flipped faces and 0 crossings of the boundary in all".to_owned(); 4];
        GridCell { title, lines, content }
    }

    #[test]
    fn words_never_overlap_for_any_number_of_methods_with_long_names() {
        for count in 1..=17 {
            let mut cells: Vec<GridCell> =
                (0..count).map(|k| cell(k, CellContent::Words("no map".to_owned()))).collect();
            let curve = |cell: &GridCell| Curve {
                name: cell.title.clone(),
                points: (1..9).map(|k| DVec2::new(10_f64.powi(k - 6), 10_f64.powi(5 * k))).collect(),
            };
            let curves = cells.iter().map(curve).collect();
            let axes = ["seconds".to_owned(), "energy".to_owned()];
            cells.push(cell(count, CellContent::Curves(Curves { axes, curves })));
            let bar = ColourBar { title: "Angle".to_owned(), colours: vec![colours::FACE], ticks: Vec::new() };
            let page = PanelGrid { cells, bar: Some(bar), caption: "A caption of some words. ".repeat(9) }.page();
            let words = page.items.iter().filter_map(|item| if let Item::Words(of) = item { Some(of) } else { None });
            let words: Vec<&Words> = words.collect();
            for (k, first) in words.iter().enumerate() {
                let own = bounds_of(first);
                assert!(own.low.min_element() >= 0.0 && own.high.cmple(page.size).all(), "{count}: {first:?}");
                for second in &words[k + 1..] {
                    let other = bounds_of(second);
                    let is_apart = own.high.cmple(other.low).any() || other.high.cmple(own.low).any();
                    assert!(is_apart, "{count}: {first:?} and {second:?}");
                }
            }
        }
    }
}
