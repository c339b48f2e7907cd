//! Sheet as a drawing (SVG), a unit of the drawing is a millimetre.

use std::io::{self, Write};

use glam::DVec2;

use super::drawing::{PatternLayer, PatternSheet, PatternWords};

/// Colours of the layers.
const fn colour_of(layer: PatternLayer) -> &'static str {
    match layer {
        PatternLayer::Cut | PatternLayer::Text => "#000000",
        PatternLayer::Sew => "#1f5fbf",
        PatternLayer::Notch => "#c0392b",
    }
}

pub(super) fn write_svg(out: &mut impl Write, sheet: &PatternSheet) -> io::Result<()> {
    let DVec2 { x: width, y: height } = sheet.size;
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width:.4}mm" height="{height:.4}mm" viewBox="0 0 {width:.4} {height:.4}" fill="none" stroke-linejoin="round">"#
    )?;
    for layer in PatternLayer::ALL {
        let dashes = layer.dashes().map(|[on, off]| format!(r#" stroke-dasharray="{on} {off}""#)).unwrap_or_default();
        let (name, colour, line) = (layer.name(), colour_of(layer), layer.width());
        writeln!(out, r#"<g id="{name}" stroke="{colour}" stroke-width="{line}"{dashes}>"#)?;
        for line in sheet.lines_of(layer) {
            write!(out, r#"<path d=""#)?;
            for (place, point) in line.points.iter().enumerate() {
                let command = if place == 0 { 'M' } else { 'L' };
                write!(out, "{command}{:.4} {:.4}", point.x, height - point.y)?;
            }
            writeln!(out, r#"{}"/>"#, if line.is_closed { "Z" } else { "" })?;
        }
        writeln!(out, "</g>")?;
    }
    writeln!(
        out,
        r##"<g id="WORDS" fill="#000000" font-family="Helvetica, Arial, sans-serif" text-anchor="middle">"##
    )?;
    for words in &sheet.words {
        write_words(out, words, height)?;
    }
    writeln!(out, "</g>\n</svg>")
}

fn write_words(out: &mut impl Write, words: &PatternWords, height: f64) -> io::Result<()> {
    let (x, y) = (words.at.x, height - words.at.y);
    let degrees = -words.along.y.atan2(words.along.x).to_degrees();
    let turn =
        if degrees == 0.0 { String::new() } else { format!(r#" transform="rotate({degrees:.3} {x:.4} {y:.4})""#) };
    let text = words.text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    writeln!(out, r#"<text x="{x:.4}" y="{y:.4}" font-size="{:.3}"{turn}>{text}</text>"#, words.size)
}
