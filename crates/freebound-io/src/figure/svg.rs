//! Page as a drawing (SVG).

use std::io::{self, Write};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::DVec2;

use super::{Anchor, Item, Page, Path, Words, colours};
use crate::raster::Colour;
use crate::raster::write_png;
use freebound_core::geom::{Bounds, Picture};

impl Page {
    /// Writes the page as SVG.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_svg(&self, out: &mut impl Write) -> io::Result<()> {
        let DVec2 { x, y } = self.size;
        write!(out, r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {x:.1} {y:.1}" "#)?;
        write!(out, r#"width="{x:.1}" height="{y:.1}" stroke-linejoin="round" stroke-linecap="round" "#)?;
        writeln!(out, r#"font-family="Helvetica, Arial, sans-serif">"#)?;
        writeln!(out, r#"<rect width="{x:.1}" height="{y:.1}" fill="{}"/>"#, hex(colours::PAPER))?;
        for item in &self.items {
            match item {
                Item::Path(path) => write_path(out, path)?,
                Item::Words(words) => write_words(out, words)?,
                Item::Picture(area, picture) => write_picture(out, *area, picture)?,
            }
        }
        writeln!(out, "</svg>")
    }
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn write_path(out: &mut impl Write, path: &Path) -> io::Result<()> {
    let fill = path.ink.fill.map_or_else(|| "none".to_owned(), hex);
    write!(out, r#"<path fill="{fill}""#)?;
    if let Some((colour, width)) = path.ink.stroke {
        write!(out, r#" stroke="{}" stroke-width="{width:.3}""#, hex(colour))?;
    }
    write!(out, r#" d=""#)?;
    for line in &path.lines {
        for (k, point) in line.iter().enumerate() {
            write!(out, "{}{:.2} {:.2}", if k == 0 { 'M' } else { 'L' }, point.x, point.y)?;
        }
        if path.is_closed {
            write!(out, "Z")?;
        }
    }
    writeln!(out, r#""/>"#)
}

fn write_picture(out: &mut impl Write, area: Bounds, picture: &Picture) -> io::Result<()> {
    let mut png = Vec::new();
    write_png(picture, &mut png)?;
    let (DVec2 { x, y }, size) = (area.low, area.size());
    write!(out, r#"<image x="{x:.2}" y="{y:.2}" width="{:.2}" height="{:.2}" "#, size.x, size.y)?;
    writeln!(out, r#"href="data:image/png;base64,{}"/>"#, BASE64_STANDARD.encode(&png))
}

fn write_words(out: &mut impl Write, words: &Words) -> io::Result<()> {
    let anchor = match words.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
    };
    let text = words.text.replace('&', "&amp;").replace('<', "&lt;");
    writeln!(
        out,
        r#"<text x="{:.2}" y="{:.2}" font-size="{}" text-anchor="{anchor}" fill="{}">{text}</text>"#,
        words.at.x,
        words.at.y,
        words.size,
        hex(colours::INK)
    )
}
