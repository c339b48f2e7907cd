//! Sheet as a document (PDF): lengths in points, 72 to an inch.

use std::io::{self, Write};

use glam::DVec2;

use super::drawing::{PatternLayer, PatternLine, PatternSheet, PatternWords};
use crate::figure::{PdfFile, text_operand, text_width};
use freebound_core::geom::Bounds;

/// Points per millimetre.
pub(super) const POINTS: f64 = 72.0 / 25.4;

/// Page of a document: its size in millimetres, and its operators. Lengths in the operators are millimetres.
pub(super) struct PatternPage {
    pub(super) size: DVec2,
    pub(super) content: Vec<u8>,
}

impl PatternPage {
    pub(super) fn new(size: DVec2) -> Self {
        Self { size, content: format!("{POINTS:.12} 0 0 {POINTS:.12} 0 0 cm 1 J 1 j\n").into_bytes() }
    }

    /// Draws what a box of the sheet holds, with the low corner of the box at a point of the page.
    pub(super) fn draw(&mut self, sheet: &PatternSheet, part: Bounds, at: DVec2, scale: f64) -> io::Result<()> {
        let size = part.size() * scale;
        write!(self.content, "q {:.4} {:.4} {:.4} {:.4} re W n ", at.x, at.y, size.x, size.y)?;
        let shift = at - part.low * scale;
        writeln!(self.content, "{scale:.8} 0 0 {scale:.8} {:.6} {:.6} cm", shift.x, shift.y)?;
        for layer in PatternLayer::ALL {
            let lines: Vec<&PatternLine> = sheet.lines_of(layer).filter(|line| meets(line, part)).collect();
            if lines.is_empty() {
                continue;
            }
            self.style(layer, scale)?;
            for line in lines {
                self.line(line)?;
            }
        }
        write!(self.content, "[] 0 d 0 0 0 rg ")?;
        for words in sheet.words.iter().filter(|words| reaches(words, part)) {
            self.words(words)?;
        }
        writeln!(self.content, "Q")
    }

    /// Sets the style of a layer. Lines keep their width at any scale.
    pub(super) fn style(&mut self, layer: PatternLayer, scale: f64) -> io::Result<()> {
        let dashes = layer.dashes().map(|dashes| dashes.map(|length| format!("{length}")).join(" "));
        writeln!(self.content, "0 0 0 RG {:.4} w [{}] 0 d", layer.width() / scale, dashes.unwrap_or_default())
    }

    pub(super) fn line(&mut self, line: &PatternLine) -> io::Result<()> {
        for (place, point) in line.points.iter().enumerate() {
            write!(self.content, "{:.4} {:.4} {} ", point.x, point.y, if place == 0 { 'm' } else { 'l' })?;
        }
        writeln!(self.content, "{}", if line.is_closed { "s" } else { "S" })
    }

    pub(super) fn words(&mut self, words: &PatternWords) -> io::Result<()> {
        let DVec2 { x: cos, y: sin } = words.along;
        let start = words.at - words.along * (text_width(&words.text, words.size) / 2.0);
        write!(self.content, "BT /F1 {:.4} Tf {cos:.6} {sin:.6} {:.6} {cos:.6} ", words.size, -sin)?;
        write!(self.content, "{:.4} {:.4} Tm (", start.x, start.y)?;
        self.content.extend(text_operand(&words.text));
        writeln!(self.content, ") Tj ET")
    }
}

fn meets(line: &PatternLine, part: Bounds) -> bool {
    Bounds::of(line.points.iter().copied()).meets(part)
}

fn reaches(words: &PatternWords, part: Bounds) -> bool {
    let half = DVec2::splat(words.size.max(text_width(&words.text, words.size) / 2.0));
    Bounds { low: words.at - half, high: words.at + half }.meets(part)
}

/// Writes the sheet as one page.
pub(super) fn write_sheet(out: &mut impl Write, sheet: &PatternSheet) -> io::Result<()> {
    let mut page = PatternPage::new(sheet.size);
    page.draw(sheet, Bounds::at(DVec2::ZERO, sheet.size), DVec2::ZERO, 1.0)?;
    write_pages(out, &[page])
}

/// Writes pages. The catalogue, the list of pages and the font are the first objects; two for each page follow.
pub(super) fn write_pages(out: &mut impl Write, pages: &[PatternPage]) -> io::Result<()> {
    let mut file = PdfFile::begin(out)?;
    let kids: Vec<String> = (0..pages.len()).map(|page| format!("{} 0 R", 4 + 2 * page)).collect();
    file.object("<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>")?;
    file.object(&format!("<< /Type /Pages /Kids [{}] /Count {} >>", kids.join(" "), pages.len()))?;
    file.object("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>")?;
    for (place, page) in pages.iter().enumerate() {
        let DVec2 { x, y } = page.size * POINTS;
        file.object(&format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {x:.4} {y:.4}] /Resources << /Font << /F1 3 0 R >> >> \
             /Contents {} 0 R >>",
            5 + 2 * place
        ))?;
        file.stream("", &page.content)?;
    }
    file.end()
}
