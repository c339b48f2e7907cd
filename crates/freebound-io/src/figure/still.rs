//! Large drawing with a title, lines of words and a colour bar below it. A title always takes two lines. So drawings
//! with equal numbers of lines, all with a bar or all without one, have equal sizes: they can be frames of an
//! animation.

use glam::DVec2;

use super::font::width_of;
use super::sheet::wrapped;
use super::{Anchor, CellContent, ColourBar, Page};
use freebound_core::geom::Bounds;

/// Margin around the page, points.
const MARGIN: f64 = 14.0;

/// Side of the drawing.
const SIDE: f64 = 320.0;

/// Sizes of the title and of the words.
const TITLE: f64 = 13.0;
const WORDS: f64 = 10.0;

/// Distances between lines of the title, and of words.
const TITLE_LINE: f64 = 20.0;
const LINE: f64 = 15.0;

/// Number of lines of a title.
const TITLE_LINES: usize = 2;

/// Ellipsis at the end of a title that is too long.
const REST: &str = "...";

/// Large drawing with words below it.
#[derive(Clone, Debug)]
pub struct Still {
    /// Content of the drawing.
    pub content: CellContent,
    /// Title below the drawing, in two lines if it is long.
    pub title: String,
    /// Lines below the title.
    pub lines: Vec<String>,
    /// Colour bar.
    pub bar: Option<ColourBar>,
}

impl Still {
    /// Page with the drawing and its words.
    pub fn page(&self) -> Page {
        let area = Bounds::at(DVec2::splat(MARGIN), DVec2::splat(SIDE));
        let below_lines = area.high.y + TITLE_LINE * TITLE_LINES as f64 + LINE * self.lines.len() as f64 + 0.5 * MARGIN;
        let bar_room = self.bar.as_ref().map_or(0.0, |_| ColourBar::ROOM);
        let mut page = Page::new(DVec2::new(2.0 * MARGIN + SIDE, below_lines + bar_room + 0.5 * MARGIN));
        self.content.draw(&mut page, area);
        let first = area.high.y + 0.75 * TITLE_LINE;
        let last = first + TITLE_LINE * (TITLE_LINES - 1) as f64;
        for (k, line) in title_lines(&self.title).iter().enumerate() {
            page.words(DVec2::new(MARGIN, first + TITLE_LINE * k as f64), Anchor::Start, TITLE, line);
        }
        for (k, line) in self.lines.iter().enumerate() {
            // Letters are smaller if a line would be too long.
            let size = WORDS * (SIDE / width_of(line, WORDS)).min(1.0);
            page.words(DVec2::new(MARGIN, last + LINE * (k as f64 + 1.0)), Anchor::Start, size, line);
        }
        if let Some(bar) = &self.bar {
            bar.draw(&mut page, DVec2::new(MARGIN, below_lines));
        }
        page
    }
}

/// Lines of a title, none wider than the drawing; a title that is too long is cut off.
fn title_lines(title: &str) -> Vec<String> {
    let mut lines = wrapped(title, TITLE, SIDE);
    let has_rest = lines.len() > TITLE_LINES;
    lines.truncate(TITLE_LINES);
    let last = lines.len() - 1;
    for (k, line) in lines.iter_mut().enumerate() {
        let is_cut = has_rest && k == last;
        if is_cut || width_of(line, TITLE) > SIDE {
            while width_of(&format!("{line}{REST}"), TITLE) > SIDE {
                line.pop();
            }
            line.push_str(REST);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_of_two_names_has_all_of_its_words_in_two_lines() {
        let title = "convex/shape-preserving@square to convex/shape-preserving@triangle";
        assert!(width_of(title, TITLE) > SIDE);
        let lines = title_lines(title);
        assert_eq!((lines.len(), lines.join(" ")), (2, title.to_owned()));
        assert_eq!(title_lines("natural"), ["natural"]);
    }

    #[test]
    fn what_does_not_fit_into_two_lines_is_cut_off_and_nothing_is_wider_than_the_drawing() {
        for title in ["word ".repeat(40), "m".repeat(200), format!("{} to {}", "a".repeat(90), "b".repeat(90))] {
            let lines = title_lines(&title);
            assert!(lines.len() <= TITLE_LINES && lines.last().unwrap().ends_with(REST), "{lines:?}");
            assert!(lines.iter().all(|line| width_of(line, TITLE) <= SIDE), "{lines:?}");
        }
        assert_eq!(title_lines(""), [""]);
    }
}
