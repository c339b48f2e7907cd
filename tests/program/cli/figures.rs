//! `freebound figures`: the files, their numbers, and the underlying pairs of pins.

use std::fs;

use freebound::cli::pairs::{PAIRS, TOP_AND_BOUNDARY, WEIGHTS, settings};
use freebound::examples::Example;
use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::mesh::{DiskMesh, FaceId};
use freebound_core::problem::{Control, Embedding, Method, Settings, fixed_pins};
use freebound_io::figure::{has_glyph, zones_of};
use freebound_io::raster::Colour;
use glam::DVec2;

use super::program::Program;
use freebound_testkit::{csv_rows, grid};

const NUMBERS: [u32; 7] = [1, 3, 4, 5, 6, 8, 9];

/// Red of a flipped face in figures.
const RED: Colour = freebound_io::figure::colours::FLIPPED;

fn made() -> Program {
    let program = Program::new();
    program.run(&["figures", "out"]).expect(0);
    program
}

/// Rows of the table without its head.
fn rows(program: &Program) -> Vec<Vec<String>> {
    let text = fs::read_to_string(program.path("out/figures.csv")).expect("the table is there");
    let rows = csv_rows(&text);
    assert_eq!(rows[0], ["figure", "panel", "shows", "flips", "crossings", "turning_number", "steps"]);
    rows[1..].to_vec()
}

fn share_of(picture: &image::RgbaImage, [r, g, b]: Colour) -> f64 {
    let count = picture.pixels().filter(|p| p.0 == [r, g, b, 255]).count();
    count as f64 / f64::from(picture.width() * picture.height())
}

#[test]
fn every_figure_is_a_drawing_and_a_picture_with_all_its_panels() {
    let program = made();
    let mut expected: Vec<String> =
        NUMBERS.iter().flat_map(|n| ["png", "svg"].map(|kind| format!("figure-{n}.{kind}"))).collect();
    expected.push("figures.csv".to_owned());
    let mut names: Vec<String> =
        fs::read_dir(program.path("out")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, expected);
    let rows = rows(&program);
    for number in NUMBERS {
        let svg = fs::read_to_string(program.path(&format!("out/figure-{number}.svg"))).unwrap();
        // Embedded pictures are base64 text that may contain any letters.
        let svg: String = svg.lines().filter(|line| !line.starts_with("<image ")).flat_map(|l| [l, "\n"]).collect();
        assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf"));
        let letters: Vec<&str> =
            rows.iter().filter(|row| row[0] == number.to_string()).map(|row| row[1].as_str()).collect();
        assert_eq!(letters, ["a", "b", "c", "d", "e", "f"][..letters.len()], "figure {number}");
        for letter in letters {
            assert!(svg.contains(&format!(">({letter}) ")), "figure {number} has no panel {letter}");
        }
        assert!(svg.contains(&format!(">Figure {number}. ")), "figure {number} has no caption");
        let picture = image::open(program.path(&format!("out/figure-{number}.png"))).unwrap().to_rgba8();
        assert!(picture.width() >= 1200 && picture.height() >= 600, "{:?}", picture.dimensions());
        // The flipped faces of the built-in face are thinner than pixels, so figure 9 is checked by its drawing.
        let [r, g, b] = RED;
        let is_drawn = svg.contains(&format!("fill=\"#{r:02x}{g:02x}{b:02x}\""));
        let has_red = if number == 9 { is_drawn } else { share_of(&picture, RED) > 1e-4 };
        assert_eq!(has_red, number >= 4 && number != 8, "flipped faces in figure {number}");
    }
}

#[test]
fn the_words_of_the_figures_can_all_be_drawn() {
    let program = made();
    for number in NUMBERS {
        let svg = fs::read_to_string(program.path(&format!("out/figure-{number}.svg"))).unwrap();
        let words = svg.split("<text ").skip(1).filter_map(|rest| rest.split(['>', '<']).nth(1));
        let mut count = 0;
        for c in words.flat_map(str::chars) {
            count += 1;
            assert!(has_glyph(c), "no glyph for {c:?} in figure {number}");
        }
        assert!(count > 50, "figure {number}");
    }
    assert!(!has_glyph('☃'));
}

#[test]
fn the_same_bytes_come_out_again_and_on_standard_output_the_table() {
    let program = made();
    let run = program.run(&["figures", "again"]).expect(0);
    for entry in fs::read_dir(program.path("out")).unwrap() {
        let name = entry.unwrap().file_name();
        let [one, two] = ["out", "again"].map(|folder| fs::read(program.path(folder).join(&name)).unwrap());
        assert!(one == two, "{} differs", name.display());
    }
    for row in rows(&program) {
        let line = row.iter().filter(|cell| !cell.is_empty()).flat_map(|cell| cell.split_whitespace());
        let wanted: Vec<&str> = line.collect();
        let is_printed = |line: &str| line.split_whitespace().eq(wanted.iter().copied());
        assert!(run.stdout.lines().any(is_printed), "{wanted:?} in {}", run.stdout);
    }
}

#[test]
fn the_table_shows_folds_in_figure_4_and_their_repair_in_5_and_6() {
    let program = made();
    let rows = rows(&program);
    let cells = |figure: &str, panel: &str| {
        let row = rows.iter().find(|row| row[0] == figure && row[1] == panel).expect("a row");
        [&row[3], &row[4], &row[5], &row[6]].map(|cell| cell.parse::<usize>().expect("a number"))
    };
    assert_eq!(cells("1", "a"), [0, 0, 1, 0]);
    assert_eq!(cells("1", "b"), [0, 0, 1, 1]);
    assert_eq!(cells("1", "c"), [0, 0, 1, 1]);
    for (k, panel) in ["a", "b", "c", "d", "e", "f"].iter().enumerate() {
        let [flips, crossings, turning, steps] = cells("4", panel);
        assert_eq!(flips, PAIRS[k / 3].flipped_faces[k % 3], "4 {panel}");
        assert_eq!([crossings, turning, steps], [0, 1, 1], "4 {panel}");
    }
    for (panel, weights) in [("b", 0), ("e", 1)] {
        assert_eq!(cells("5", panel), [0, 0, 1, 1 + TOP_AND_BOUNDARY.iterations[weights]]);
    }
    for (panel, of_4) in [("a", "a"), ("c", "a"), ("d", "b"), ("f", "b")] {
        assert_eq!(cells("5", panel), cells("4", of_4), "5 {panel}");
    }
    for panel in ["a", "b", "c", "e"] {
        assert_eq!(cells("6", panel), cells("4", "b"), "6 {panel}");
    }
    for panel in ["d", "f"] {
        assert_eq!(cells("6", panel), [0, 0, 1, 2], "6 {panel}");
    }
}

#[test]
fn the_table_shows_how_weights_fold_the_face_and_the_iteration_repairs_it() {
    let program = made();
    let rows = rows(&program);
    let cells = |figure: &str, panel: &str| {
        let row = rows.iter().find(|row| row[0] == figure && row[1] == panel).expect("a row");
        [&row[3], &row[4], &row[5], &row[6]].map(|cell| cell.parse::<usize>().expect("a number"))
    };
    let [flips, crossings, turning, steps] = cells("8", "c");
    assert_eq!([flips, crossings, turning], [0, 0, 1], "8 c");
    assert!((3..=7).contains(&steps), "8 c: {steps} linear solves");
    for [before, after, on_mesh] in [["a", "b", "c"], ["d", "e", "f"]] {
        let [flips, crossings, turning, steps] = cells("9", before);
        assert!(flips > 0, "9 {before}");
        assert_eq!([crossings, turning, steps], [0, 1, 1], "9 {before}");
        let [flips, crossings, turning, _] = cells("9", after);
        assert_eq!([flips, crossings, turning], [0, 0, 1], "9 {after}");
        assert_eq!(cells("9", on_mesh), cells("9", after));
    }
    // Medium weights are farther off than large ones: "… off by 0.0123".
    let off = |panel: &str| -> f64 {
        let row = rows.iter().find(|row| row[0] == "9" && row[1] == panel).expect("a row");
        row[2].split_whitespace().next_back().expect("a number").parse().expect("a number")
    };
    assert!(off("f") > 2.0 * off("c"), "{} {}", off("c"), off("f"));
}

#[test]
fn the_pairs_fold_as_measured_and_both_methods_repair_what_they_fold() {
    let mesh = DiskMesh::try_from(Example::Cube.mesh()).unwrap();
    for pair in PAIRS {
        let [a, b] = pair.vertices;
        let distance = mesh.position(a).distance(mesh.position(b));
        let pins = fixed_pins([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))]);
        for (weights, (name, ..)) in WEIGHTS.iter().enumerate() {
            let folded = Flattener::new(settings(weights), pins.clone()).step(&mesh, Control::unattended()).unwrap();
            assert_eq!(folded.verdict.flipped_faces.len(), pair.flipped_faces[weights], "{a}, {b}, {name}");
            assert!(folded.has_simple_boundary(), "{a}, {b}, {name}");
            let repaired = |method: Method| {
                let settings = Settings { method: method.clone(), ..settings(weights) };
                let (mut count, mut last) = (0, None::<Step>);
                let mut run = Flattener::new(settings, pins.clone()).after(&folded);
                let ending = run.finish(&mesh, Control::unattended(), |step| {
                    count += 1;
                    last = Some(step);
                });
                assert_eq!(ending, Ok(Ending::Planar), "{a}, {b}, {name}, {method:?}");
                (count, last.expect("a folded embedding is repaired by a step"))
            };
            assert_eq!(repaired(Method::Iterate).0, pair.iterations[weights], "{a}, {b}, {name}");
            let (count, bent) = repaired(Method::VirtualBoundary);
            assert_eq!((count, bent.candidate.bent_vertices), (1, 0), "{a}, {b}, {name}");
        }
    }
}

#[test]
fn faces_near_each_other_are_one_zone_and_the_largest_comes_first() {
    let mesh = DiskMesh::try_from(grid(20, 20)).unwrap();
    let places: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    // The first face of the first square; three faces of the last two squares.
    let faces = [0, 797, 798, 799].map(FaceId::new);
    let zones = zones_of(&mesh, &places, &faces);
    assert_eq!(zones, [faces[1..].to_vec(), faces[..1].to_vec()]);
    assert!(zones_of(&mesh, &places, &[]).is_empty());
}

#[test]
fn a_folder_that_cannot_be_is_named_and_nothing_is_left() {
    let program = Program::new();
    program.write("taken", "a file");
    let run = program.run(&["figures", "taken"]).expect(1);
    assert!(run.stderr.contains("taken"), "{}", run.stderr);
    assert_eq!(program.files(), ["taken"]);
    program.run(&["figures"]).expect(2);
}
