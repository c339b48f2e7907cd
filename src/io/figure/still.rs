//! One large drawing with lines of words and a bar of colours below it. Those with as many lines and with or without a bar alike
//! have one size, so that they can be frames of an animation.

use glam::DVec2;

use super::{Anchor, CellContent, ColourBar, Page};
use crate::geom::Bounds;

/// Free space around everything, points.
const MARGIN: f64 = 14.0;

/// Side of the drawing.
const SIDE: f64 = 320.0;

/// Size of the title, and of the words.
const TITLE: f64 = 13.0;
const WORDS: f64 = 10.0;

/// From one line to the next.
const TITLE_LINE: f64 = 20.0;
const LINE: f64 = 15.0;

/// One large drawing.
#[derive(Clone, Debug)]
pub struct Still {
    /// What is drawn.
    pub content: CellContent,
    /// The line right below it.
    pub title: String,
    /// The lines below that.
    pub lines: Vec<String>,
    /// The colours.
    pub bar: Option<ColourBar>,
}

impl Still {
    /// Lays everything out.
    pub fn page(&self) -> Page {
        let area = Bounds::at(DVec2::splat(MARGIN), DVec2::splat(SIDE));
        let below_lines = area.high.y + TITLE_LINE + LINE * self.lines.len() as f64 + 0.5 * MARGIN;
        let bar_room = self.bar.as_ref().map_or(0.0, |_| ColourBar::ROOM);
        let mut page = Page::new(DVec2::new(2.0 * MARGIN + SIDE, below_lines + bar_room + 0.5 * MARGIN));
        self.content.draw(&mut page, area);
        let first = area.high.y + 0.75 * TITLE_LINE;
        page.words(DVec2::new(MARGIN, first), Anchor::Start, TITLE, &self.title);
        for (k, line) in self.lines.iter().enumerate() {
            page.words(DVec2::new(MARGIN, first + LINE * (k as f64 + 1.0)), Anchor::Start, WORDS, line);
        }
        if let Some(bar) = &self.bar {
            bar.draw(&mut page, DVec2::new(MARGIN, below_lines));
        }
        page
    }
}
