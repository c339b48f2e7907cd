//! Panels laid out on a page: rows of drawings with letters and captions, insets beside them, the figure's caption
//! below.

use glam::DVec2;

use super::font::width_of;
use super::{Anchor, Page, PhotoDrawing, PlaneDrawing, SpaceDrawing};
use freebound_core::geom::Bounds;

/// Margin around the page, points.
const MARGIN: f64 = 16.0;

/// Space between panels.
const GAP: f64 = 22.0;

/// Side of a panel's drawing.
const PANEL: f64 = 290.0;

/// Space between a drawing and its insets, and between insets.
const INSET_GAP: f64 = 8.0;

/// Size of the words below a panel.
const WORDS: f64 = 12.0;

/// Distance between lines of words.
const LINE: f64 = 17.0;

/// Drawing in a panel.
#[derive(Clone, Debug)]
pub enum Drawing {
    /// Embedding.
    Plane(PlaneDrawing),
    /// Mesh in space.
    Space(SpaceDrawing),
    /// Picture.
    Photo(PhotoDrawing),
}

/// Drawing of a figure with its words.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Line below the drawing, which begins with its letter.
    pub words: String,
    /// Drawing of the panel.
    pub drawing: Drawing,
}

impl Panel {
    fn inset_count(&self) -> usize {
        if let Drawing::Plane(plane) = &self.drawing { plane.insets.len() } else { 0 }
    }

    fn draw(&self, page: &mut Page, cell: Bounds, inset: f64) {
        // A drawing without insets is centred in its cell.
        let count = self.inset_count();
        let shift = if count > 0 { 0.0 } else { (cell.size().x - PANEL) / 2.0 };
        let area = Bounds::at(cell.low + DVec2::new(shift, 0.0), DVec2::splat(PANEL));
        match &self.drawing {
            Drawing::Space(drawing) => drawing.draw(page, area),
            Drawing::Photo(drawing) => drawing.draw(page, area),
            Drawing::Plane(drawing) => {
                drawing.draw(page, area);
                for number in 0..count {
                    let down = number as f64 * (inset + INSET_GAP);
                    let corner = DVec2::new(area.high.x + INSET_GAP, area.low.y + down);
                    drawing.draw_inset(page, Bounds::at(corner, DVec2::splat(inset)), number);
                }
            }
        }
        let at = DVec2::new(cell.middle().x, cell.low.y + PANEL + 8.0 + LINE * 0.7);
        // Letters are smaller if the line would reach into the next panel.
        let size = WORDS * (cell.size().x / width_of(&self.words, WORDS).max(f64::MIN_POSITIVE)).min(1.0);
        page.words(at, Anchor::Middle, size, &self.words);
    }
}

/// Figure with panels in rows, and a caption.
#[derive(Clone, Debug)]
pub struct PrintedSheet {
    /// Number of panels in a row.
    pub columns: usize,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Caption of the figure.
    pub caption: String,
}

impl PrintedSheet {
    /// Page with the panels and the caption.
    pub fn page(&self) -> Page {
        let inset_count = self.panels.iter().map(Panel::inset_count).max().unwrap_or(0);
        let inset = (PANEL - INSET_GAP) / 2.0;
        let insets_width = if inset_count > 0 { INSET_GAP + inset } else { 0.0 };
        let cell = DVec2::new(PANEL + insets_width, PANEL + 8.0 + LINE);
        let rows = self.panels.len().div_ceil(self.columns.max(1));
        let columns = self.columns.min(self.panels.len()) as f64;
        let width = 2.0 * MARGIN + columns * cell.x + (columns - 1.0) * GAP;
        let caption = wrapped(&self.caption, WORDS, width - 2.0 * MARGIN);
        let below = MARGIN + rows as f64 * (cell.y + GAP);
        let mut page = Page::new(DVec2::new(width, below + LINE * caption.len() as f64 + MARGIN));
        for (k, panel) in self.panels.iter().enumerate() {
            let (row, column) = (k / self.columns, k % self.columns);
            let corner = DVec2::new(column as f64, row as f64) * (cell + GAP) + MARGIN;
            panel.draw(&mut page, Bounds::at(corner, cell), inset);
        }
        for (k, line) in caption.iter().enumerate() {
            page.words(DVec2::new(MARGIN, below + LINE * (k as f64 + 0.7)), Anchor::Start, WORDS, line);
        }
        page
    }
}

/// Text broken into lines that fit a width, except for longer words.
pub(super) fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let longer = if lines[last].is_empty() { word.to_owned() } else { format!("{} {word}", lines[last]) };
        if width_of(&longer, size) <= width || lines[last].is_empty() {
            lines[last] = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
