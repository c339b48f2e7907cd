//! `freebound compare`: picture of methods side by side.

use std::collections::BTreeSet;
use std::fs;
use std::str::FromStr as _;

use freebound::examples::Example;
use freebound::view::Quantity;
use freebound_core::problem::{NamedOption as _, Variant};
use freebound_io::Column;
use freebound_io::figure::has_glyph;
use serde_json::Value;

use super::compare::IN;
use super::program::{Program, example_file};

/// Fills and strokes of an SVG file.
fn paths(svg: &str) -> impl Iterator<Item = &str> {
    svg.lines().filter(|line| line.starts_with("<path "))
}

#[test]
fn the_picture_has_every_method_with_its_numbers_at_one_scale() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let list = "natural,lscm,convex/uniform,auto";
    let files = ["--svg", "all.svg", "--png", "all.png", "--pdf", "all.pdf", "--report", "all.json"];
    program.run(&[&["compare", IN, "--methods", list, "--shading", "area"], &files[..]].concat()).expect(0);
    let svg = fs::read_to_string(program.path("all.svg")).unwrap();
    let words: Vec<&str> = svg.split("<text ").skip(1).filter_map(|rest| rest.split(['>', '<']).nth(1)).collect();
    for name in list.split(',') {
        let title = Variant::from_str(name).unwrap().title();
        assert!(words.join(" ").contains(&title), "{title} in {words:?}");
    }
    assert!(fs::read(program.path("all.pdf")).unwrap().starts_with(b"%PDF-"));
    assert!(words.contains(&Quantity::Area.title()), "{words:?}");
    assert!(words.iter().any(|line| line.split(' ').next() == Some(Column::Angle.name())), "{words:?}");
    assert!(words.iter().flat_map(|line| line.chars()).all(has_glyph), "{words:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let [r, g, b] = freebound_io::figure::colours::FLIPPED;
    let report: Value = serde_json::from_str(&fs::read_to_string(program.path("all.json")).unwrap()).unwrap();
    let has_flips =
        report["methods"].as_array().unwrap().iter().any(|of| of["result"]["verdict"]["flipped_faces"] != 0);
    assert_eq!(svg.contains(&format!("fill=\"#{r:02x}{g:02x}{b:02x}\"")), has_flips);

    // Two equal embeddings: natural and least squares agree to rounding, and so do their drawn boundaries.
    let boundaries: Vec<Vec<f64>> = paths(&svg)
        .filter(|line| line.contains("stroke-width=\"0.900\""))
        .map(|line| {
            line.split("d=\"").nth(1).unwrap().split(['M', 'L', 'Z', ' ', '"']).filter_map(|n| n.parse().ok()).collect()
        })
        .collect();
    assert_eq!(boundaries.len(), 4, "one for each method");
    let size = |of: &[f64], axis: usize| {
        let (low, high) = of.iter().skip(axis).step_by(2).fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
        high - low
    };
    for axis in 0..2 {
        assert!((size(&boundaries[0], axis) - size(&boundaries[1], axis)).abs() < 0.05, "{boundaries:?}");
    }
    let picture = image::open(program.path("all.png")).unwrap().to_rgba8();
    assert!(picture.width() >= 900 && picture.height() >= 500, "{:?}", picture.dimensions());
    let colours: BTreeSet<[u8; 4]> = picture.pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 100, "faces are coloured: {}", colours.len());
}

#[test]
fn the_same_drawing_comes_out_with_any_number_of_threads() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let draw = |threads: &str, name: &str| {
        // Times differ from run to run, so only the picture's paths are compared, not its texts.
        program.run(&["compare", IN, "--methods", "natural,convex", "--threads", threads, "--svg", name]).expect(0);
        let svg = fs::read_to_string(program.path(name)).unwrap();
        paths(&svg).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(draw("1", "one.svg") == draw("3", "three.svg"));
}

#[test]
fn a_checker_is_shown_on_the_mesh() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["compare", IN, "--methods", "natural,convex", "--shading", "checker", "--svg", "all.svg"]).expect(0);
    let svg = fs::read_to_string(program.path("all.svg")).unwrap();
    assert_eq!(svg.lines().filter(|line| line.starts_with("<image ")).count(), 2);
}
