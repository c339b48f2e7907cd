//! A page as a drawing (SVG).

use std::io::{self, Write};

use glam::DVec2;

use super::{Anchor, Area, Item, Page, Path, Words, colours};
use crate::io::raster::Colour;

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
        let clips = self.clips();
        for (number, area) in clips.iter().enumerate() {
            let size = area.size();
            writeln!(
                out,
                r#"<clipPath id="clip{number}"><rect x="{:.3}" y="{:.3}" width="{:.3}" height="{:.3}"/></clipPath>"#,
                area.low.x, area.low.y, size.x, size.y
            )?;
        }
        for item in &self.items {
            match item {
                Item::Path(path) => write_path(out, path, &clips)?,
                Item::Words(words) => write_words(out, words)?,
            }
        }
        writeln!(out, "</svg>")
    }

    /// The areas that paths are cut to, each once.
    fn clips(&self) -> Vec<Area> {
        let mut clips = Vec::new();
        for item in &self.items {
            if let Item::Path(Path { clip: Some(area), .. }) = item
                && !clips.contains(area)
            {
                clips.push(*area);
            }
        }
        clips
    }
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn write_path(out: &mut impl Write, path: &Path, clips: &[Area]) -> io::Result<()> {
    let fill = path.ink.fill.map_or_else(|| "none".to_owned(), hex);
    write!(out, r#"<path fill="{fill}""#)?;
    if let Some((colour, width)) = path.ink.stroke {
        write!(out, r#" stroke="{}" stroke-width="{width:.3}""#, hex(colour))?;
    }
    if let Some(number) = path.clip.and_then(|area| clips.iter().position(|&clip| clip == area)) {
        write!(out, r#" clip-path="url(#clip{number})""#)?;
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
