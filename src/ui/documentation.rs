//! Pages of the book for users, which the window shows under Help, and a search in their sections.

use std::ops::Range;
use std::sync::LazyLock;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

macro_rules! pages {
    ($($path:literal),* $(,)?) => {
        [$(BookPage { path: $path, text: include_str!(concat!("../../book/src/", $path)) }),*]
    };
}

/// Pages in the order of the book's summary.
pub(in crate::ui) static PAGES: [BookPage; 26] = pages![
    "introduction.md",
    "why.md",
    "tutorials.md",
    "tutorials/first-flattening.md",
    "tutorials/photo-on-a-face.md",
    "tutorials/unwrap-a-model.md",
    "tutorials/scan-with-holes.md",
    "tutorials/many-charts.md",
    "tutorials/repair-a-layout.md",
    "tutorials/batch.md",
    "tutorials/to-blender-and-back.md",
    "window.md",
    "command-line.md",
    "methods.md",
    "constraints.md",
    "files.md",
    "python.md",
    "blender.md",
    "limits.md",
    "how/paper.md",
    "how/linear-solves.md",
    "how/planar-start.md",
    "how/continuation.md",
    "how/new-vertices.md",
    "how/cutting.md",
    "how/verdict.md",
];

/// Characters that the fonts of the window lack, and how they are written there.
const WITHOUT_GLYPH: [(char, &str); 6] = [
    ('\u{1d40}', "^T"),
    ('\u{1d34}', "^H"),
    ('\u{1d56}', "^p"),
    ('\u{1d62}', "_i"),
    ('\u{2c7c}', "_j"),
    ('\u{304}', ""),
];

/// Sections of all pages, in the order of the pages.
static SECTIONS: LazyLock<Vec<Vec<Section>>> = LazyLock::new(|| PAGES.iter().map(BookPage::sections).collect());

/// Greatest number of sections that a search returns.
const MOST_FOUND: usize = 60;

/// Page of the book.
#[derive(Debug)]
pub(in crate::ui) struct BookPage {
    /// Path in the book, for example `how/paper.md`.
    pub(in crate::ui) path: &'static str,
    /// Markdown text.
    text: &'static str,
}

/// Page of the book, with a heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::ui) struct BookAnchor {
    /// Page, by its place in the list.
    pub(in crate::ui) page: usize,
    /// Anchor of the heading. `None` is the top of the page.
    pub(in crate::ui) heading: Option<String>,
}

impl BookAnchor {
    /// Target of a link such as `window.md#pins` or `#pins` from a page of this path. `None` if it leads to no page of
    /// the list.
    fn of_link(link: &str, from: &str) -> Option<Self> {
        let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
        let mut names: Vec<&str> = from.split('/').collect();
        if !path.is_empty() {
            names.pop();
        }
        for name in path.split('/').filter(|name| !name.is_empty()) {
            match name {
                ".." => drop(names.pop()),
                name => names.push(name),
            }
        }
        let path = names.join("/");
        let page = PAGES.iter().position(|page| page.path == path)?;
        Some(Self { page, heading: anchor.map(str::to_owned) })
    }

    /// Target of a path with an anchor, for example `window.md#pins`. Default: the first page.
    pub(in crate::ui) fn of(path: &str) -> Self {
        Self::of_link(path, "").unwrap_or(Self { page: 0, heading: None })
    }
}

/// Section of a page: its heading and its text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::ui) struct Section {
    pub(in crate::ui) title: String,
    pub(in crate::ui) anchor: String,
    text: String,
}

/// Block of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::ui) enum PageBlock {
    /// Markdown text: headings have their anchors, and pictures are left out. Only links that lead somewhere stay links.
    Text(String),
    /// Lines of code.
    Code(String),
    /// Rows of a table, the head first, with the Markdown text of each cell.
    Table(Vec<Vec<String>>),
}

impl PageBlock {
    fn texts_mut(&mut self) -> Vec<&mut String> {
        match self {
            Self::Text(text) | Self::Code(text) => vec![text],
            Self::Table(rows) => rows.iter_mut().flatten().collect(),
        }
    }
}

/// Page for the window, and the links to other pages.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::ui) struct ShownPage {
    pub(in crate::ui) blocks: Vec<PageBlock>,
    /// Links as the text has them, with their targets.
    pub(in crate::ui) links: Vec<(String, BookAnchor)>,
}

impl BookPage {
    fn events(&self) -> impl Iterator<Item = (Event<'static>, Range<usize>)> {
        Parser::new_ext(self.text, Options::ENABLE_TABLES).into_offset_iter()
    }

    /// Title: the first heading.
    fn title(&self) -> String {
        self.sections().into_iter().next().map(|section| section.title).unwrap_or_default()
    }

    /// Sections in their order.
    pub(in crate::ui) fn sections(&self) -> Vec<Section> {
        let mut sections = vec![Section::default()];
        let mut is_heading = false;
        for (event, _) in self.events() {
            match event {
                Event::Start(Tag::Heading { .. }) => {
                    sections.push(Section::default());
                    is_heading = true;
                }
                Event::End(TagEnd::Heading(_)) => {
                    let section = sections.last_mut().expect("a heading begins a section");
                    section.anchor = anchor_of(&section.title);
                    is_heading = false;
                }
                Event::Text(words) | Event::Code(words) => {
                    let section = sections.last_mut().expect("the list begins with a section");
                    let field = if is_heading { &mut section.title } else { &mut section.text };
                    field.push_str(&words);
                }
                Event::SoftBreak | Event::HardBreak | Event::End(_) => {
                    sections.last_mut().expect("the list begins with a section").text.push(' ');
                }
                _ => {}
            }
        }
        sections.retain(|section| !section.title.is_empty());
        sections
    }

    /// Page as the window shows it.
    pub(in crate::ui) fn shown(&self) -> ShownPage {
        let mut shown = ShownPage::default();
        let mut edits: Vec<(Range<usize>, PageBlock)> = Vec::new();
        let mut sections = self.sections().into_iter();
        // Words of a link to nowhere, and lines of code, as far as they are read.
        let (mut unlinked, mut code) = (None, None);
        for (event, range) in self.events() {
            match event {
                Event::Start(Tag::Heading { .. }) => {
                    let end = range.start + self.text[range].trim_end().len();
                    let anchor = sections.next().map(|section| section.anchor).unwrap_or_default();
                    edits.push((end..end, PageBlock::Text(format!(" {{#{anchor}}}"))));
                }
                Event::Start(Tag::Image { .. }) => edits.push((range, PageBlock::Text(String::new()))),
                Event::Start(Tag::Link { dest_url, .. }) => {
                    let is_elsewhere = dest_url.contains("://");
                    match BookAnchor::of_link(&dest_url, self.path) {
                        Some(anchor) => shown.links.push((dest_url.to_string(), anchor)),
                        None if !is_elsewhere => unlinked = Some(String::new()),
                        None => {}
                    }
                }
                // Slanted letters reach into the space after them.
                Event::End(TagEnd::Emphasis) if unlinked.is_none() && self.text[range.end..].starts_with(' ') => {
                    edits.push((range.end..range.end, PageBlock::Text("\u{2009}".to_owned())));
                }
                Event::Start(Tag::CodeBlock(_)) => code = Some(String::new()),
                Event::Text(words) | Event::Code(words) => {
                    [&mut unlinked, &mut code].into_iter().flatten().for_each(|text| text.push_str(&words));
                }
                Event::End(TagEnd::Link) => edits.extend(unlinked.take().map(|words| (range, PageBlock::Text(words)))),
                Event::End(TagEnd::CodeBlock) => {
                    // Numbers that differ from run to run are left out in the book.
                    let lines = code.take().map(|lines| lines.trim_end().replace("[..]", "…"));
                    edits.extend(lines.map(|lines| (range, PageBlock::Code(lines))));
                }
                _ => {}
            }
        }
        edits.sort_by_key(|(range, _)| range.start);
        let split = |block: PageBlock| match block {
            PageBlock::Text(text) => with_tables_apart(&text),
            other => vec![other],
        };
        shown.blocks = blocks(self.text, edits).into_iter().flat_map(split).collect();
        for text in shown.blocks.iter_mut().flat_map(PageBlock::texts_mut) {
            for (character, otherwise) in WITHOUT_GLYPH {
                *text = text.replace(character, otherwise);
            }
        }
        shown
    }
}

/// Text with edits, cut at its code.
fn blocks(text: &str, edits: Vec<(Range<usize>, PageBlock)>) -> Vec<PageBlock> {
    let (mut blocks, mut now, mut end) = (Vec::new(), String::new(), 0);
    for (range, block) in edits {
        now.push_str(&text[end..range.start]);
        end = range.end;
        match block {
            PageBlock::Text(words) => now.push_str(&words),
            other => blocks.extend([PageBlock::Text(std::mem::take(&mut now)), other]),
        }
    }
    now.push_str(&text[end..]);
    blocks.push(PageBlock::Text(now));
    blocks
}

/// Text cut at its tables.
fn with_tables_apart(text: &str) -> Vec<PageBlock> {
    let (mut edits, mut rows) = (Vec::new(), Vec::new());
    for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        match event {
            Event::Start(Tag::TableHead | Tag::TableRow) => rows.push(Vec::new()),
            // A bar within a cell is written with a backslash before it.
            Event::Start(Tag::TableCell) => {
                let cell = text[range].trim_matches('|').trim().replace("\\|", "|");
                rows.last_mut().into_iter().for_each(|row: &mut Vec<String>| row.push(cell.clone()));
            }
            Event::End(TagEnd::Table) => edits.push((range, PageBlock::Table(std::mem::take(&mut rows)))),
            _ => {}
        }
    }
    blocks(text, edits)
}

/// Anchor of a heading, as the book has it.
fn anchor_of(title: &str) -> String {
    let kept = title.to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Titles of the pages.
pub(in crate::ui) static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| PAGES.iter().map(BookPage::title).collect());

/// Section that a search found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::ui) struct FoundSection {
    pub(in crate::ui) anchor: BookAnchor,
    /// Title of the section.
    pub(in crate::ui) title: String,
}

/// Sections that contain all words, in any order and case; those with all words in their titles come first.
pub(in crate::ui) fn find_sections(query: &str) -> Vec<FoundSection> {
    let query = query.to_lowercase();
    let has_all = |text: &str| query.split_whitespace().all(|word| text.to_lowercase().contains(word));
    let (mut by_title, mut by_text) = (Vec::new(), Vec::new());
    for (page, sections) in SECTIONS.iter().enumerate() {
        for Section { title, anchor, text } in sections {
            let list = if has_all(title) { &mut by_title } else { &mut by_text };
            if has_all(&format!("{title} {text}")) {
                let anchor = BookAnchor { page, heading: Some(anchor.clone()) };
                list.push(FoundSection { anchor, title: title.clone() });
            }
        }
    }
    by_title.append(&mut by_text);
    by_title.truncate(MOST_FOUND);
    by_title
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Parts of the summary that the window leaves out.
    const LEFT_OUT: [&str; 6] =
        ["options.md", "rust.md", "batch.md", "benchmarks.md", "convergence.md", "contributing/"];

    #[test]
    fn the_pages_are_those_of_the_summary_in_its_order() {
        let summary = include_str!("../../book/src/SUMMARY.md");
        let listed: Vec<&str> = summary
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
            .filter(|path| !LEFT_OUT.iter().any(|left_out| path.starts_with(left_out)))
            .collect();
        assert_eq!(PAGES.iter().map(|page| page.path).collect::<Vec<_>>(), listed);
    }

    #[test]
    fn every_page_has_a_title_and_every_link_leads_to_a_section() {
        let mut count = 0;
        for page in &PAGES {
            assert!(!page.title().is_empty(), "{}", page.path);
            for (link, to) in page.shown().links {
                count += 1;
                let anchors: BTreeSet<String> = PAGES[to.page].sections().into_iter().map(|s| s.anchor).collect();
                let is_there = to.heading.as_ref().is_none_or(|anchor| anchors.contains(anchor));
                assert!(is_there, "{}: {link}", page.path);
            }
        }
        assert!(count > 30, "{count} links");
    }

    #[test]
    fn a_shown_page_keeps_its_words_and_only_links_that_lead_somewhere() {
        let page = BookPage {
            path: "how/paper.md",
            text: "# The *paper*\n\n![A picture](a.png)\n\n[pins](../window.md#pins), [`run`](../benchmarks.md), [x](#y)\n\n\
                   ```console\n$ run\n```\n\nEnd\n",
        };
        let ShownPage { blocks, links } = page.shown();
        let text = "# The *paper* {#the-paper}\n\n\n\n[pins](../window.md#pins), run, [x](#y)\n\n";
        let [before, code, after] = blocks.as_slice() else { panic!("{blocks:?}") };
        assert_eq!(*before, PageBlock::Text(text.to_owned()));
        assert_eq!(*code, PageBlock::Code("$ run".to_owned()));
        assert!(matches!(after, PageBlock::Text(text) if text.trim() == "End"));
        let of = |path: &str, heading: &str| BookAnchor {
            page: PAGES.iter().position(|page| page.path == path).expect("a page"),
            heading: Some(heading.to_owned()),
        };
        let expected = [("../window.md#pins", of("window.md", "pins")), ("#y", of("how/paper.md", "y"))];
        assert_eq!(links, expected.map(|(link, to)| (link.to_owned(), to)));
    }

    #[test]
    fn tables_of_a_page_are_blocks_with_the_text_of_their_cells() {
        let text = "Before\n\n| a | b |\n|---|---|\n| *x* | `1 \\| 2` |\n| | [y](window.md) |\n\nAfter\n";
        let blocks = BookPage { path: "a.md", text }.shown().blocks;
        let [PageBlock::Text(before), PageBlock::Table(rows), PageBlock::Text(after)] = blocks.as_slice() else {
            panic!("{blocks:?}")
        };
        assert_eq!([before.trim(), after.trim()], ["Before", "After"]);
        assert_eq!(*rows, [["a", "b"], ["*x*", "`1 | 2`"], ["", "[y](window.md)"]]);
        let tables =
            |page: &BookPage| page.shown().blocks.iter().filter(|block| matches!(block, PageBlock::Table(_))).count();
        let is_even = |page: &BookPage| {
            let has_columns = |block: &PageBlock| match block {
                PageBlock::Table(rows) => rows.len() > 1 && rows.iter().all(|row| row.len() == rows[0].len()),
                _ => true,
            };
            page.shown().blocks.iter().all(has_columns)
        };
        assert!(PAGES.iter().map(tables).sum::<usize>() > 20);
        assert!(PAGES.iter().all(is_even));
    }

    #[test]
    fn every_character_of_the_pages_has_a_glyph() {
        use eframe::egui::{Context, FontId, RawInput};
        let context = Context::default();
        crate::ui::theme::install(&context);
        let mut missing = BTreeSet::new();
        let mut output = context.run_ui(RawInput::default(), |ui| {
            for mut block in PAGES.iter().flat_map(|page| page.shown().blocks) {
                let font = match block {
                    PageBlock::Code(_) => FontId::monospace(12.0),
                    _ => FontId::proportional(13.0),
                };
                let texts = block.texts_mut();
                let others = texts.iter().flat_map(|text| text.chars()).filter(|c| !c.is_ascii());
                missing.extend(others.filter(|c| !ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, *c))));
            }
        });
        output.textures_delta.clear();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn a_search_finds_titles_first_and_needs_all_words() {
        let found = find_sections("verdict");
        assert!(found.len() > 5 && found[0].title.to_lowercase().contains("verdict"), "{found:?}");
        let both = find_sections("verdict mirrored");
        assert!(!both.is_empty() && both.len() < found.len());
        assert!(find_sections("zebra crossing").is_empty());
    }
}
