//! Sheet on pages of paper that overlap, after a page with an overview.
//!
//! Columns are numbered from the left and rows lettered from the top: A1, A2, … Page B3 shows the third part of the second
//! row. Neighbouring pages share a strip. Crosses at the corners of the parts come to lie on each other. Parts without
//! lines or words have no page.

use std::io::{self, Write};

use glam::{DVec2, UVec2};

use super::PatternPaper;
use super::drawing::{PatternLayer, PatternLine, PatternSheet, PatternWords};
use super::pdf::{PatternPage, write_pages};
use freebound_core::geom::{Bounds, clip_segment};

/// Greatest number of pages that a pattern is divided into.
pub(super) const MOST_PAGES: u64 = 4000;

/// Margin of a page, which printers leave empty, millimetres.
const MARGIN: f64 = 10.0;

/// Width of the strip that neighbouring pages share, millimetres.
const OVERLAP: f64 = 10.0;

/// Half the size of a cross, millimetres.
const CROSS: f64 = 4.0;

/// Type size of the label of a page, millimetres.
const LABEL: f64 = 5.0;

/// Height of the foot of the overview, which has a bar of 100 mm, millimetres.
const FOOT: f64 = 25.0;

impl PatternPaper {
    /// Width and height of an upright page, millimetres.
    fn size(self) -> DVec2 {
        match self {
            Self::Letter => DVec2::new(215.9, 279.4),
            Self::A4 | Self::Sheet => DVec2::new(210.0, 297.0),
        }
    }
}

/// Part of the sheet on one page.
struct Tile {
    name: String,
    part: Bounds,
}

/// Division of a sheet.
struct Tiling {
    page: DVec2,
    tiles: Vec<Tile>,
}

impl Tiling {
    /// Upright or lying pages, whichever are fewer.
    fn of(sheet: &PatternSheet, paper: PatternPaper) -> Self {
        let upright = paper.size();
        let [upright, lying] = [upright, DVec2::new(upright.y, upright.x)].map(|page| Self::on(sheet, page));
        if lying.tiles.len() < upright.tiles.len() { lying } else { upright }
    }

    fn on(sheet: &PatternSheet, page: DVec2) -> Self {
        let part = page - 2.0 * MARGIN;
        let step = part - OVERLAP;
        let counts = counts_on(sheet, page);
        let mut tiles = Vec::new();
        for row in 0..counts.y {
            for column in 0..counts.x {
                let corner = DVec2::new(f64::from(column), f64::from(row + 1));
                let low = DVec2::new(corner.x * step.x, sheet.size.y - corner.y * step.y - OVERLAP);
                let part = Bounds::at(low, part);
                if has_content(sheet, part) {
                    tiles.push(Tile { name: format!("{}{}", letters_of(row), column + 1), part });
                }
            }
        }
        Self { page, tiles }
    }
}

/// Columns and rows of pages that cover a sheet.
fn counts_on(sheet: &PatternSheet, page: DVec2) -> UVec2 {
    let step = page - 2.0 * MARGIN - OVERLAP;
    ((sheet.size - OVERLAP) / step).ceil().max(DVec2::ONE).as_uvec2()
}

/// Number of upright pages that cover a sheet; 1 for a page of the size of the sheet.
pub(super) fn pages_to_cover(sheet: &PatternSheet, paper: PatternPaper) -> u64 {
    if paper == PatternPaper::Sheet {
        return 1;
    }
    let counts = counts_on(sheet, paper.size());
    u64::from(counts.x) * u64::from(counts.y)
}

/// Name of a row: A to Z, then AA, AB, …
fn letters_of(row: u32) -> String {
    let letter = char::from(b'A' + u8::try_from(row % 26).unwrap_or(0));
    let before = if row >= 26 { letters_of(row / 26 - 1) } else { String::new() };
    format!("{before}{letter}")
}

fn has_content(sheet: &PatternSheet, part: Bounds) -> bool {
    let crosses = |line: &PatternLine| {
        let ends = line.points.iter().zip(line.points.iter().cycle().skip(1));
        let count = line.points.len() - usize::from(!line.is_closed);
        ends.take(count).any(|(&from, &to)| clip_segment([from, to], part).is_some())
    };
    let holds = |words: &PatternWords| Bounds::of([words.at]).meets(part);
    sheet.lines.iter().any(crosses) || sheet.words.iter().any(holds)
}

/// Number of pages, with the overview.
pub(super) fn page_count(sheet: &PatternSheet, paper: PatternPaper) -> usize {
    1 + Tiling::of(sheet, paper).tiles.len()
}

/// Writes the overview and the pages.
pub(super) fn write_tiles(out: &mut impl Write, sheet: &PatternSheet, paper: PatternPaper) -> io::Result<()> {
    let tiling = Tiling::of(sheet, paper);
    let mut pages = vec![overview(sheet, &tiling)?];
    for tile in &tiling.tiles {
        pages.push(tile_page(sheet, tile, tiling.page)?);
    }
    write_pages(out, &pages)
}

fn tile_page(sheet: &PatternSheet, tile: &Tile, size: DVec2) -> io::Result<PatternPage> {
    let mut page = PatternPage::new(size);
    let low = DVec2::splat(MARGIN);
    page.draw(sheet, tile.part, low, 1.0)?;
    page.style(PatternLayer::Text, 1.0)?;
    let area = Bounds::at(low, tile.part.size());
    // The middle of the shared strips: pages are cut there, or laid over each other until the crosses meet.
    let half = OVERLAP / 2.0;
    let inner = Bounds { low: area.low + half, high: area.high - half };
    for corner in inner.corners() {
        for arm in [DVec2::X, DVec2::Y] {
            page.line(&open(vec![corner - arm * CROSS, corner + arm * CROSS]))?;
        }
    }
    let at = DVec2::new(area.low.x + 12.0, area.low.y - 6.0);
    page.words(&words(at, LABEL, tile.name.clone()))?;
    Ok(page)
}

/// Small drawing of the sheet with the places of the pages, and a bar of 100 mm in true size.
fn overview(sheet: &PatternSheet, tiling: &Tiling) -> io::Result<PatternPage> {
    let mut page = PatternPage::new(tiling.page);
    let room = tiling.page - 2.0 * MARGIN - DVec2::new(0.0, FOOT);
    let scale = (room / sheet.size).min_element().min(1.0);
    let low = DVec2::new(MARGIN, MARGIN + FOOT);
    page.draw(sheet, Bounds::at(DVec2::ZERO, sheet.size), low, scale)?;
    page.style(PatternLayer::Text, 1.0)?;
    for tile in &tiling.tiles {
        let inner = Bounds { low: tile.part.low + OVERLAP / 2.0, high: tile.part.high - OVERLAP / 2.0 };
        let corners = inner.corners().map(|corner| low + corner.clamp(DVec2::ZERO, sheet.size) * scale);
        page.line(&PatternLine { is_closed: true, ..open(corners.to_vec()) })?;
        page.words(&words(
            corners[0].midpoint(corners[2]),
            (0.2 * tiling.page.x * scale).clamp(2.0, 8.0),
            tile.name.clone(),
        ))?;
    }
    let [from, to] = [DVec2::new(MARGIN, 14.0), DVec2::new(MARGIN + 100.0, 14.0)];
    page.line(&open(vec![from, to]))?;
    for end in [from, to] {
        page.line(&open(vec![end - DVec2::Y * 1.5, end + DVec2::Y * 1.5]))?;
    }
    let text = format!("100 mm if printed in true size; {} pages, overview 1 : {:.1}", tiling.tiles.len(), 1.0 / scale);
    page.words(&words(DVec2::new(MARGIN + 50.0, 18.0), 4.0, text))?;
    Ok(page)
}

fn open(points: Vec<DVec2>) -> PatternLine {
    PatternLine { layer: PatternLayer::Text, points, is_closed: false }
}

fn words(at: DVec2, size: f64, text: String) -> PatternWords {
    PatternWords { at, size, along: DVec2::X, text }
}
