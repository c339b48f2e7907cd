//! Sheet as a drawing exchange file (DXF, release 12, plain text) in millimetres.
//!
//! Every value is a line with a group code, followed by a line with the value. Lines are `POLYLINE` entities, which all
//! readers of release 12 know. Release 12 has no `$INSUNITS`; readers of later releases take it as the unit.

use std::io::{self, Write};

use super::drawing::{PatternLayer, PatternLine, PatternSheet, PatternWords};

/// Code of millimetres for `$INSUNITS`.
const MILLIMETRES: u32 = 4;

/// Colour number of a layer.
const fn colour_of(layer: PatternLayer) -> u32 {
    match layer {
        PatternLayer::Cut => 7,
        PatternLayer::Sew => 5,
        PatternLayer::Notch => 1,
        PatternLayer::Text => 3,
    }
}

const fn line_type_of(layer: PatternLayer) -> &'static str {
    match layer {
        PatternLayer::Sew => "DASHED",
        PatternLayer::Cut | PatternLayer::Notch | PatternLayer::Text => "CONTINUOUS",
    }
}

pub(super) fn write_dxf(out: &mut impl Write, sheet: &PatternSheet) -> io::Result<()> {
    let size = sheet.size;
    write!(out, "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n{MILLIMETRES}\n")?;
    write!(out, "9\n$MEASUREMENT\n70\n1\n9\n$EXTMIN\n10\n0.0\n20\n0.0\n30\n0.0\n")?;
    write!(out, "9\n$EXTMAX\n10\n{:.6}\n20\n{:.6}\n30\n0.0\n0\nENDSEC\n", size.x, size.y)?;
    write_tables(out)?;
    write!(out, "0\nSECTION\n2\nENTITIES\n")?;
    for line in &sheet.lines {
        write_line(out, line)?;
    }
    for words in &sheet.words {
        write_words(out, words)?;
    }
    write!(out, "0\nENDSEC\n0\nEOF\n")
}

fn write_tables(out: &mut impl Write) -> io::Result<()> {
    write!(out, "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLTYPE\n70\n2\n")?;
    write!(out, "0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0.0\n")?;
    write!(out, "0\nLTYPE\n2\nDASHED\n70\n0\n3\nDashed line\n72\n65\n73\n2\n40\n4.5\n49\n3.0\n49\n-1.5\n0\nENDTAB\n")?;
    write!(out, "0\nTABLE\n2\nLAYER\n70\n{}\n", PatternLayer::ALL.len())?;
    for layer in PatternLayer::ALL {
        let (name, colour, line_type) = (layer.name(), colour_of(layer), line_type_of(layer));
        write!(out, "0\nLAYER\n2\n{name}\n70\n0\n62\n{colour}\n6\n{line_type}\n")?;
    }
    write!(out, "0\nENDTAB\n0\nENDSEC\n")
}

fn write_line(out: &mut impl Write, line: &PatternLine) -> io::Result<()> {
    let (name, closed) = (line.layer.name(), u32::from(line.is_closed));
    write!(out, "0\nPOLYLINE\n8\n{name}\n66\n1\n70\n{closed}\n10\n0.0\n20\n0.0\n30\n0.0\n")?;
    for point in &line.points {
        write!(out, "0\nVERTEX\n8\n{name}\n10\n{:.6}\n20\n{:.6}\n30\n0.0\n", point.x, point.y)?;
    }
    write!(out, "0\nSEQEND\n8\n{name}\n")
}

fn write_words(out: &mut impl Write, words: &PatternWords) -> io::Result<()> {
    // Plain text has no other letters.
    let plain = |c: char| match c {
        ' '..='~' => c,
        '−' => '-',
        '×' => 'x',
        _ => '?',
    };
    let text: String = words.text.chars().map(plain).collect();
    let (x, y, degrees) = (words.at.x, words.at.y, words.along.y.atan2(words.along.x).to_degrees());
    write!(out, "0\nTEXT\n8\n{}\n10\n{x:.6}\n20\n{y:.6}\n30\n0.0\n", PatternLayer::Text.name())?;
    // Code 72: centred on the second point.
    write!(out, "40\n{:.4}\n1\n{text}\n50\n{degrees:.4}\n72\n1\n11\n{x:.6}\n21\n{y:.6}\n31\n0.0\n", words.size)
}
