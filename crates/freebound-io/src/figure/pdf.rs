//! Page as a document (PDF 1.4): one page of paths, pictures and words.
//!
//! Words use the standard font Helvetica, which every reader has, so they can be selected and searched. Words with a
//! character outside the font's encoding are drawn as strokes. Later objects refer to earlier ones by number; the table
//! at the end lists their byte offsets.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec2;

use super::{Anchor, Item, Page, Path, Words, colours};
use crate::raster::Colour;
use freebound_core::geom::{Bounds, Picture};

/// Widths of the characters 32 to 126 in Helvetica, thousandths of the type size.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];

/// Width of all other characters, thousandths of the type size. Only centred words depend on it.
const OTHER_WIDTH: u16 = 556;

/// Characters of the encoding outside ASCII and Latin-1, with their codes.
const SPECIAL: [(char, u8); 8] =
    [('€', 0x80), ('…', 0x85), ('‘', 0x91), ('’', 0x92), ('“', 0x93), ('”', 0x94), ('–', 0x96), ('—', 0x97)];

/// Numbers of the fixed objects. Pictures follow.
const CATALOGUE: usize = 1;
const PAGES: usize = 2;
const PAGE: usize = 3;
const CONTENT: usize = 4;
const FONT: usize = 5;
const FIRST_PICTURE: usize = 6;

impl Page {
    /// Writes the page as PDF. A point of the page is a point of the document.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_pdf(&self, out: &mut impl Write) -> io::Result<()> {
        let mut content = Vec::new();
        let pictures = self.write_content(&mut content)?;
        let names = (FIRST_PICTURE..).zip(&pictures).map(|(number, _)| format!("/P{number} {number} 0 R"));
        let names = names.collect::<Vec<_>>().join(" ");
        let mut file = PdfFile::begin(out)?;
        file.object(&format!("<< /Type /Catalog /Pages {PAGES} 0 R >>"))?;
        file.object(&format!("<< /Type /Pages /Kids [{PAGE} 0 R] /Count 1 >>"))?;
        let DVec2 { x, y } = self.size;
        let resources = format!("<< /Font << /F1 {FONT} 0 R >> /XObject << {names} >> >>");
        file.object(&format!(
            "<< /Type /Page /Parent {PAGES} 0 R /MediaBox [0 0 {x:.2} {y:.2}] /Resources {resources} \
             /Contents {CONTENT} 0 R >>"
        ))?;
        file.stream("", &content)?;
        file.object("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>")?;
        for picture in pictures {
            file.stream(
                &format!(
                    "/Type /XObject /Subtype /Image /Width {} /Height {} /ColorSpace /DeviceRGB /BitsPerComponent 8 ",
                    picture.width, picture.height
                ),
                &on_paper(picture),
            )?;
        }
        file.end()
    }

    /// Writes the operators that draw the page. Returns its pictures in the order of their objects.
    fn write_content(&self, out: &mut Vec<u8>) -> io::Result<Vec<&Picture>> {
        let DVec2 { x, y } = self.size;
        let mut pictures = Vec::new();
        write_colour(out, colours::PAPER, "rg")?;
        writeln!(out, "0 0 {x:.2} {y:.2} re f 1 J 1 j")?;
        // From here on y points down, as on the page.
        writeln!(out, "1 0 0 -1 0 {y:.2} cm")?;
        for item in &self.items {
            match item {
                Item::Path(path) => write_path(out, path)?,
                Item::Words(words) => write_words(out, words)?,
                Item::Picture(area, picture) => {
                    write_picture(out, *area, FIRST_PICTURE + pictures.len())?;
                    pictures.push(picture);
                }
            }
        }
        Ok(pictures)
    }
}

/// File under construction: counts bytes, and keeps the offset of every object.
pub(crate) struct PdfFile<'a, W> {
    out: &'a mut W,
    written: usize,
    offsets: Vec<usize>,
}

impl<'a, W: Write> PdfFile<'a, W> {
    pub(crate) fn begin(out: &'a mut W) -> io::Result<Self> {
        let mut file = Self { out, written: 0, offsets: Vec::new() };
        // Bytes above 127 in the second line tell programs that the file is not plain text.
        file.put(b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n")?;
        Ok(file)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.written += bytes.len();
        self.out.write_all(bytes)
    }

    /// Writes the next object.
    pub(crate) fn object(&mut self, body: &str) -> io::Result<()> {
        self.offsets.push(self.written);
        let number = self.offsets.len();
        self.put(format!("{number} 0 obj\n{body}\nendobj\n").as_bytes())
    }

    /// Writes the next object as a compressed stream. `entries` are entries of its dictionary.
    pub(crate) fn stream(&mut self, entries: &str, data: &[u8]) -> io::Result<()> {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
        packed.write_all(data)?;
        let packed = packed.finish()?;
        self.offsets.push(self.written);
        let number = self.offsets.len();
        let length = packed.len();
        self.put(format!("{number} 0 obj\n<< {entries}/Length {length} /Filter /FlateDecode >>\nstream\n").as_bytes())?;
        self.put(&packed)?;
        self.put(b"\nendstream\nendobj\n")
    }

    /// Writes the table of offsets and the trailer.
    pub(crate) fn end(mut self) -> io::Result<()> {
        let (start, count) = (self.written, self.offsets.len() + 1);
        self.put(format!("xref\n0 {count}\n0000000000 65535 f \n").as_bytes())?;
        for offset in std::mem::take(&mut self.offsets) {
            self.put(format!("{offset:010} 00000 n \n").as_bytes())?;
        }
        let trailer = format!("trailer\n<< /Size {count} /Root {CATALOGUE} 0 R >>\nstartxref\n{start}\n%%EOF\n");
        self.put(trailer.as_bytes())
    }
}

fn write_colour(out: &mut impl Write, colour: Colour, operator: &str) -> io::Result<()> {
    let [r, g, b] = colour.map(|channel| f64::from(channel) / 255.0);
    write!(out, "{r:.4} {g:.4} {b:.4} {operator} ")
}

fn write_path(out: &mut impl Write, path: &Path) -> io::Result<()> {
    let paint = match (path.ink.fill, path.ink.stroke) {
        (Some(_), Some(_)) => "B",
        (Some(_), None) => "f",
        (None, Some(_)) => "S",
        (None, None) => return Ok(()),
    };
    if let Some(colour) = path.ink.fill {
        write_colour(out, colour, "rg")?;
    }
    if let Some((colour, width)) = path.ink.stroke {
        write_colour(out, colour, "RG")?;
        write!(out, "{width:.3} w ")?;
    }
    for line in &path.lines {
        for (k, point) in line.iter().enumerate() {
            write!(out, "{:.2} {:.2} {} ", point.x, point.y, if k == 0 { 'm' } else { 'l' })?;
        }
        if path.is_closed {
            write!(out, "h ")?;
        }
    }
    writeln!(out, "{paint}")
}

fn write_picture(out: &mut impl Write, area: Bounds, number: usize) -> io::Result<()> {
    let (low, size) = (area.low, area.size());
    // Pictures fill the unit square with their first row at the top, where y points up.
    let top = low.y + size.y;
    writeln!(out, "q {:.2} 0 0 {:.2} {:.2} {top:.2} cm /P{number} Do Q", size.x, -size.y, low.x)
}

fn write_words(out: &mut impl Write, words: &Words) -> io::Result<()> {
    let codes: Option<Vec<u8>> = words.text.chars().map(code_of).collect();
    let Some(codes) = codes else { return write_path(out, &words.as_strokes()) };
    let thousandths: f64 = codes.iter().map(|&code| f64::from(width_of_code(code))).sum();
    let shift = match words.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => thousandths * words.size / 2000.0,
    };
    write_colour(out, colours::INK, "rg")?;
    write!(out, "BT /F1 {} Tf 1 0 0 -1 {:.2} {:.2} Tm (", words.size, words.at.x - shift, words.at.y)?;
    out.write_all(&escaped(codes.into_iter()))?;
    writeln!(out, ") Tj ET")
}

/// Codes as they stand between the brackets of a text.
fn escaped(codes: impl Iterator<Item = u8>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for code in codes {
        match code {
            b'(' | b')' | b'\\' => bytes.extend([b'\\', code]),
            b' '..=b'~' => bytes.push(code),
            _ => bytes.extend(format!("\\{code:03o}").into_bytes()),
        }
    }
    bytes
}

/// Text as it stands between brackets. Characters without a code become question marks.
pub(crate) fn text_operand(text: &str) -> Vec<u8> {
    escaped(text.chars().map(|c| code_of(c).unwrap_or(b'?')))
}

/// Width of a text in Helvetica of a size.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let widths = text.chars().map(|c| f64::from(width_of_code(code_of(c).unwrap_or(b'?'))));
    widths.sum::<f64>() * size / 1000.0
}

/// Code of a character in the encoding of the font.
fn code_of(c: char) -> Option<u8> {
    match c {
        ' '..='~' | '\u{a0}'..='\u{ff}' => u8::try_from(u32::from(c)).ok(),
        // The font has no minus sign; its en dash has the same shape.
        '−' => Some(0x96),
        _ => SPECIAL.iter().find(|(special, _)| *special == c).map(|(_, code)| *code),
    }
}

fn width_of_code(code: u8) -> u16 {
    code.checked_sub(b' ').and_then(|place| WIDTHS.get(usize::from(place)).copied()).unwrap_or(OTHER_WIDTH)
}

/// Colours of a picture on white paper, without its opacity.
fn on_paper(picture: &Picture) -> Vec<u8> {
    let blend = |channel: u8, alpha: u8| {
        let (channel, alpha) = (u32::from(channel), u32::from(alpha));
        u8::try_from((channel * alpha + 255 * (255 - alpha) + 127) / 255).unwrap_or(255)
    };
    picture.pixels.chunks_exact(4).flat_map(|pixel| [0, 1, 2].map(|k| blend(pixel[k], pixel[3]))).collect()
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;

    use super::*;
    use crate::figure::Ink;
    use crate::figure::font::width_of;

    fn page() -> Page {
        let mut page = Page::new(DVec2::new(200.0, 100.0));
        page.outlines(vec![vec![DVec2::ZERO, DVec2::X, DVec2::Y]], Ink::fill(colours::FACE), None);
        page.lines(vec![vec![DVec2::ZERO, DVec2::splat(50.0)]], Ink::stroke(colours::INK, 1.0), None);
        page.words(DVec2::new(10.0, 20.0), Anchor::Middle, 10.0, "max (a\\b) −1 é");
        page.words(DVec2::new(10.0, 40.0), Anchor::Start, 10.0, "to ∞");
        page.items.push(Item::Picture(
            Bounds { low: DVec2::splat(60.0), high: DVec2::splat(80.0) },
            Picture { width: 2, height: 1, pixels: vec![255, 0, 0, 255, 0, 0, 0, 0] },
        ));
        page
    }

    fn position(bytes: &[u8], of: &[u8]) -> Option<usize> {
        bytes.windows(of.len()).position(|part| part == of)
    }

    /// Data of the stream in an object.
    fn unpacked(object: &[u8]) -> Vec<u8> {
        let begin = position(object, b"stream\n").expect("a stream") + 7;
        let head = String::from_utf8_lossy(&object[..begin]).into_owned();
        let length = head.split("/Length ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a length");
        let data = &object[begin..begin + length.parse::<usize>().expect("a number")];
        assert!(object[begin + data.len()..].starts_with(b"\nendstream\nendobj\n"));
        let mut plain = Vec::new();
        ZlibDecoder::new(data).read_to_end(&mut plain).expect("a whole stream");
        plain
    }

    /// Objects of a file, found by its table of offsets.
    fn objects(bytes: &[u8]) -> Vec<Vec<u8>> {
        let text = String::from_utf8_lossy(&bytes[bytes.len() - 40..]).into_owned();
        let start = text.split("startxref\n").nth(1).and_then(|rest| rest.lines().next()).expect("a start");
        let start: usize = start.parse().expect("a number");
        let table = std::str::from_utf8(&bytes[start..]).expect("the table is text");
        let mut lines = table.split_inclusive('\n');
        assert_eq!(lines.next(), Some("xref\n"));
        let count: usize = lines.next().and_then(|line| line.trim_end()[2..].parse().ok()).expect("a count");
        let entries: Vec<&str> = lines.by_ref().take(count).collect();
        assert!(entries.iter().all(|entry| entry.len() == 20), "{entries:?}");
        assert!(table.contains(&format!("/Size {count} /Root 1 0 R")));
        let offset = |entry: &&str| entry[..10].parse::<usize>().expect("an offset");
        let offsets: Vec<usize> = entries[1..].iter().map(offset).chain([start]).collect();
        offsets.windows(2).map(|ends| bytes[ends[0]..ends[1]].to_vec()).collect()
    }

    #[test]
    fn the_table_leads_to_every_object_and_the_streams_hold_the_page() {
        let mut bytes = Vec::new();
        page().write_pdf(&mut bytes).expect("memory takes all");
        assert!(bytes.starts_with(b"%PDF-1.4\n") && bytes.ends_with(b"%%EOF\n"));
        let objects = objects(&bytes);
        assert_eq!(objects.len(), 6);
        for (number, object) in (1..).zip(&objects) {
            assert!(object.starts_with(format!("{number} 0 obj\n").as_bytes()) && object.ends_with(b"endobj\n"));
        }
        let page = String::from_utf8_lossy(&objects[PAGE - 1]).into_owned();
        assert!(page.contains("[0 0 200.00 100.00]") && page.contains("/P6 6 0 R"), "{page}");
        let content = String::from_utf8(unpacked(&objects[CONTENT - 1])).expect("operators are text");
        assert!(content.contains(r"(max \(a\\b\) \2261 \351) Tj"), "{content}");
        assert_eq!(content.matches("BT").count(), 1, "a sign without a code is drawn as strokes");
        assert!(content.contains("/P6 Do"));
        assert_eq!(unpacked(&objects[FIRST_PICTURE - 1]), [255, 0, 0, 255, 255, 255]);
    }

    #[test]
    fn layouts_by_strokes_leave_room_for_the_font() {
        let texts =
            ["Least-squares conformal map", "Mean value, 12 pins", "energy 4.061", "1234567890", "step 11: 111"];
        for text in texts {
            let codes = text.chars().map(|c| code_of(c).expect("has a code"));
            let of_font = codes.map(|code| f64::from(width_of_code(code))).sum::<f64>() / 100.0;
            assert!(of_font <= 1.15 * width_of(text, 10.0), "{text}: {of_font} and {}", width_of(text, 10.0));
        }
    }
}
