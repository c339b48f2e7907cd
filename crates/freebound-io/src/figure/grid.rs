//! Cells laid out on a grid, each a drawing with a title and lines of numbers. Below them are a colour bar with its
//! numbers, and a caption.

use glam::DVec2;

use super::sheet::wrapped;
use super::{Anchor, Curves, Ink, Item, Page, TintedDrawing, colours};
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
        let rows = self.cells.len().div_ceil(columns);
        let line_count = self.cells.iter().map(|cell| cell.lines.len()).max().unwrap_or(0);
        let cell = DVec2::new(SIDE, SIDE + TITLE_LINE + LINE * line_count as f64);
        // A single cell still leaves space for the bar and a line of words.
        let width = 2.0 * MARGIN + columns.max(2) as f64 * (SIDE + GAP) - GAP;
        let caption = wrapped(&self.caption, WORDS, width - 2.0 * MARGIN);
        let below_cells = MARGIN + rows as f64 * (cell.y + GAP);
        let below_bar = below_cells + if self.bar.is_some() { BAR_ROOM } else { 0.0 };
        let mut page = Page::new(DVec2::new(width, below_bar + LINE * caption.len() as f64 + MARGIN));
        for (k, of) in self.cells.iter().enumerate() {
            let place = DVec2::new((k % columns) as f64, (k / columns) as f64);
            of.draw(&mut page, Bounds::at(place * (cell + GAP) + MARGIN, cell));
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

impl GridCell {
    fn draw(&self, page: &mut Page, cell: Bounds) {
        let area = Bounds::at(cell.low, DVec2::splat(SIDE));
        self.content.draw(page, area);
        let below = area.high.y + 0.75 * TITLE_LINE;
        page.words(DVec2::new(cell.low.x, below), Anchor::Start, TITLE, &self.title);
        for (k, line) in self.lines.iter().enumerate() {
            let at = DVec2::new(cell.low.x, below + LINE * (k as f64 + 1.0));
            page.words(at, Anchor::Start, WORDS, line);
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
