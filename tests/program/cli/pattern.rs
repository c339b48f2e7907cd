//! Option `--pattern`: cutting patterns in true size.

use std::collections::BTreeMap;
use std::fs;

use freebound_core::geom::{distance_to_loop, is_simple};
use glam::DVec2;

use super::program::Program;

/// Closed or open lines and words of a DXF file.
#[derive(Default)]
struct Drawing {
    lines: Vec<(String, Vec<DVec2>)>,
    words: Vec<(String, DVec2)>,
}

impl Drawing {
    /// Reads pairs of a code and a value; an entity begins with code 0.
    fn read(text: &str) -> Self {
        let lines: Vec<&str> = text.lines().collect();
        let mut drawing = Self::default();
        let (mut kind, mut layer, mut at) = ("", "", DVec2::ZERO);
        for pair in lines.chunks(2) {
            match (pair[0].trim(), pair[1]) {
                ("0", name) => {
                    kind = name;
                    if kind == "POLYLINE" {
                        drawing.lines.push((String::new(), Vec::new()));
                    }
                }
                ("8", name) => layer = name,
                ("10", x) => at.x = x.parse().unwrap(),
                ("20", y) => {
                    at.y = y.parse().unwrap();
                    if let ("VERTEX", Some(line)) = (kind, drawing.lines.last_mut()) {
                        layer.clone_into(&mut line.0);
                        line.1.push(at);
                    }
                }
                ("1", text) if kind == "TEXT" => drawing.words.push((text.to_owned(), at)),
                _ => {}
            }
        }
        drawing
    }

    fn on<'a>(&'a self, layer: &'a str) -> impl Iterator<Item = &'a Vec<DVec2>> {
        self.lines.iter().filter(move |(own, _)| own == layer).map(|(_, line)| line)
    }
}

fn drawing(options: &[&str]) -> (Program, Drawing) {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    program.run(&[&["unwrap", "ball.obj", "--pattern", "p.dxf", "--unit", "m"], options].concat()).expect(0);
    let text = fs::read_to_string(program.path("p.dxf")).unwrap();
    assert!(text.starts_with("0\nSECTION\n") && text.ends_with("0\nEOF\n"));
    assert!(text.contains("$INSUNITS\n70\n4\n"));
    let drawing = Drawing::read(&text);
    (program, drawing)
}

#[test]
fn a_cutting_line_is_simple_and_keeps_the_allowance_from_the_sewing_line() {
    let (_, drawing) = drawing(&["--allowance", "8"]);
    let sewn: Vec<&Vec<DVec2>> = drawing.on("SEW").collect();
    assert!(!sewn.is_empty());
    for line in drawing.on("CUT") {
        assert!(is_simple(line));
        for &point in line {
            let distance = sewn.iter().map(|sewn| distance_to_loop(sewn, point)).fold(f64::INFINITY, f64::min);
            assert!((distance - 8.0).abs() < 1e-5 + 0.01, "{distance}");
        }
    }
}

#[test]
fn every_notch_has_its_number_on_both_sides_of_the_seam() {
    let (_, drawing) = drawing(&["--notches", "200"]);
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    let is_of_notch =
        |text: &str| text.split_once('.').is_some_and(|(seam, notch)| is_number(seam) && is_number(notch));
    for (text, _) in drawing.words.iter().filter(|(text, _)| is_of_notch(text)) {
        *count.entry(text).or_default() += 1;
    }
    assert!(count.len() > 3, "{count:?}");
    assert!(count.values().all(|&count| count == 2), "{count:?}");
    assert_eq!(drawing.on("NOTCH").count(), 2 * count.len());
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

#[test]
fn a_pattern_has_the_size_that_its_unit_gives_the_mesh() {
    let program = Program::new();
    fs::write(program.path("square.obj"), "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n").unwrap();
    program.run(&["flatten", "square.obj", "--pattern", "p.dxf", "--unit", "in", "--allowance", "0"]).expect(0);
    let drawing = Drawing::read(&fs::read_to_string(program.path("p.dxf")).unwrap());
    let lines: Vec<&Vec<DVec2>> = drawing.on("CUT").collect();
    assert_eq!(lines.len(), 1);
    let mut sides: Vec<f64> = (0..4).map(|k| lines[0][k].distance(lines[0][(k + 1) % 4])).collect();
    sides.sort_by(f64::total_cmp);
    for (side, wanted) in sides.into_iter().zip([25.4, 25.4, 50.8, 50.8]) {
        assert!((side - wanted).abs() < 1e-5, "{side}");
    }
}

#[test]
fn documents_and_drawings_have_pages_in_true_size() {
    let program = Program::new();
    program.run(&["example", "dome", "."]).expect(0);
    let paper = |paper: &str, file: &str| {
        program.run(&["flatten", "dome.obj", "--pattern", file, "--unit", "m", "--paper", paper]).expect(0);
        String::from_utf8_lossy(&fs::read(program.path(file)).unwrap()).into_owned()
    };
    assert_eq!(paper("sheet", "sheet.pdf").matches("/MediaBox").count(), 1);
    let a4 = paper("a4", "a4.pdf");
    assert!(a4.matches("/MediaBox").count() > 2);
    assert!(a4.contains("[0 0 595.2756 841.8898]") || a4.contains("[0 0 841.8898 595.2756]"));
    let letter = paper("letter", "letter.pdf");
    assert!(letter.contains("[0 0 612.0000 792.0000]") || letter.contains("[0 0 792.0000 612.0000]"));
    let svg = paper("sheet", "sheet.svg");
    let width = svg.split("width=\"").nth(1).and_then(|rest| rest.split("mm").next()).unwrap().to_owned();
    assert!(svg.contains(&format!("viewBox=\"0 0 {width} ")));
}

#[test]
fn patterns_that_cannot_be_made_are_named_and_write_nothing() {
    let program = Program::new();
    program.run(&["example", "dome", "."]).expect(0);
    let run = |options: &[&str]| program.run(&[&["flatten", "dome.obj", "--pattern"], options].concat());
    let failed = run(&["p.txt"]).expect(2);
    assert!(failed.stderr.contains("p.txt") && failed.stderr.contains("--pattern"), "{}", failed.stderr);
    let failed = run(&["p.pdf", "--sheet-width", "1"]).expect(2);
    assert!(failed.stderr.contains("chart 0"), "{}", failed.stderr);
    let failed = run(&["p.pdf", "--allowance", "100000", "--paper", "a4"]).expect(2);
    assert!(failed.stderr.contains("pages"), "{}", failed.stderr);
    assert!(!program.path("p.pdf").exists());
}
