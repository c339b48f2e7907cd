//! Outputs of `freebound flatten`: the mesh, the drawing, the picture.

#![allow(clippy::float_cmp, reason = "the unit square is filled bit for bit")]

use std::collections::BTreeSet;
use std::fs;

use freebound::examples::Example;
use freebound_core::verify::verdict;
use freebound_io::read_mesh;
use glam::{DVec2, DVec3};
use serde_json::Value;

use super::program::{Program, argument, coordinates_by_vertex, example_file};
use super::report_schema::TENT;
use freebound_testkit::{corpus_entry, corpus_test};

corpus_test! {
    fn the_written_mesh_is_the_one_that_was_read_and_check_agrees_with_the_report() {
        let files = ["cathead.obj", "fran_face.obj", "cow_seamster.obj", "flat_bump_domain.obj"];
        for entry in files.map(corpus_entry) {
            let program = Program::new();
            let arguments = ["flatten", argument(&entry.path), "-o", "out.obj", "--report", "out.json"];
            let status = program.run(&arguments).status.expect("the program was not killed");
            let (before, after) = (entry.read(), read_mesh(&program.path("out.obj")).unwrap());
            let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
            assert!(before.polygons.positions.iter().map(bits).eq(after.polygons.positions.iter().map(bits)));
            assert_eq!(before.polygons, after.polygons, "{}", entry.file);
            // The verdicts of the report, of the library on the written file, and of `check` agree.
            let report: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
            let on_file = verdict(&entry.disk(), &coordinates_by_vertex(&after));
            assert_eq!(report["verdict"], serde_json::to_value(&on_file).unwrap(), "{}", entry.file);
            let check = program.run(&["check", "out.obj", "--report", "-"]).expect(status).json();
            assert_eq!(check["verdict"], report["verdict"], "{}", entry.file);
            assert_eq!(check["distortion"], report["distortion"], "{}", entry.file);
            assert_eq!(check["mesh"].as_object().unwrap().len(), report["mesh"].as_object().unwrap().len());
        }
    }
}

#[test]
fn polygons_are_written_back_whole() {
    let program = Program::new();
    // A quad, a non-convex pentagon, and a triangle, on one strip.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 2 .5 0\nv 3 1 0\nv 4 .5 1\n\
                g first\nf 1 2 3 4\nusemtl red\nf 2 5 6 7 3\nf 5 8 6\n";
    program.write("in.obj", text);
    program.run(&["flatten", "in.obj", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let (before, after) = (read_mesh(&program.path("in.obj")).unwrap(), read_mesh(&program.path("out.obj")).unwrap());
    assert_eq!(before.polygons, after.polygons);
    assert_eq!(before.statements, after.statements);
    let sizes: Vec<usize> = (0..3).map(|face| after.polygons.face(face).len()).collect();
    assert_eq!(sizes, [4, 5, 3]);
}

#[test]
fn pins_stand_in_the_written_file_digit_for_digit() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let arguments = [
        "flatten",
        "in.obj",
        "--method",
        "natural",
        "-o",
        "out.obj",
        "--pin",
        "3:-0.1,0.7",
        "--pin",
        "40:1e-17,0.3333333333333333",
        "--pin",
        "11:2.5,-1e3",
        "--report",
        "-",
    ];
    let run = program.run(&arguments);
    assert!(matches!(run.status, Some(0 | 4)), "{run:?}");
    let report = run.json();
    assert_eq!(report["pins"]["count"], 3);
    assert_eq!(report["pins"]["max_error"], 0.0);
    let found = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    for (vertex, target) in [(3, [-0.1, 0.7]), (40, [1e-17, 0.333_333_333_333_333_3]), (11, [2.5, -1e3])] {
        assert_eq!(found[vertex].to_array().map(f64::to_bits), target.map(f64::to_bits), "vertex {vertex}");
    }
}

#[test]
fn the_result_fits_the_unit_square_or_has_the_area_of_the_surface() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    let coordinates = |fit: &str| {
        program.run(&["flatten", "in.obj", "--fit", fit, "-o", "out.obj"]).expect(0);
        coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap())
    };
    let unit = coordinates("unit");
    let low = unit.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = unit.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    assert_eq!(low, DVec2::ZERO);
    assert!(high.max_element() == 1.0 && high.min_element() > 0.5, "{high}");
    let embedding = coordinates("true");
    let area = |face| {
        let [a, b, c] = embedding.corners(&mesh, face);
        (b - a).perp_dot(c - a) / 2.0
    };
    let ratio = mesh.faces().map(area).sum::<f64>() / mesh.mesh().area();
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
}

/// Parses XML and asserts that tags are closed in order and attributes quoted; returns the elements' start tags.
pub(crate) fn xml_elements(text: &str) -> Vec<String> {
    let (mut open, mut elements) = (Vec::<String>::new(), Vec::new());
    for piece in text.split('<').skip(1) {
        let (tag, after) = piece.split_once('>').expect("a tag is closed");
        assert!(!after.contains('>') && !after.contains('&'), "text between tags: {after}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "tags are closed in order");
            continue;
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "attributes are quoted: {tag:.80}");
        let name = tag.split_whitespace().next().expect("a tag has a name").to_owned();
        if !tag.ends_with('/') {
            open.push(name);
        }
        elements.push(tag.to_owned());
    }
    assert!(open.is_empty(), "left open: {open:?}");
    elements
}

corpus_test! {
    fn the_drawing_is_well_formed_and_shows_as_many_faults_as_the_report_counts() {
        let files = ["cathead.obj", "hand_lowres.obj", "cow_seamster.obj"];
        let mut flipped_seen = 0;
        for entry in files.map(corpus_entry) {
            let program = Program::new();
            let path = argument(&entry.path);
            let run = program.run(&["flatten", path, "--method", "levy", "--svg", "out.svg", "--report", "-"]);
            let report = run.json();
            let elements = xml_elements(&fs::read_to_string(program.path("out.svg")).unwrap());
            assert!(elements[0].starts_with("svg ") && elements[0].contains("http://www.w3.org/2000/svg"));
            let path_in = |colour: &str| {
                elements.iter().find(|e| e.starts_with("path ") && e.contains(colour)).expect("a path of this colour")
            };
            let count = |name: &str| report["verdict"][name].as_array().unwrap().len();
            // One closed outline per flipped face, two lines per crossing, one ring per overwound vertex.
            assert_eq!(path_in("fill=\"#d92d3a\"").matches('Z').count(), count("flipped_faces"), "{}", entry.file);
            assert_eq!(path_in("#e8700a").matches('M').count(), 2 * count("boundary_crossings"), "{}", entry.file);
            let rings = elements.iter().filter(|e| e.starts_with("circle ")).count();
            assert_eq!(rings, count("overwound_vertices"), "{}", entry.file);
            assert!(!elements.iter().any(|e| e.contains("NaN") || e.contains("inf")), "{}", entry.file);
            flipped_seen += count("flipped_faces");
        }
        assert!(flipped_seen > 0, "no file of these shows a flipped face");
    }
}

#[test]
fn the_picture_has_its_size_and_shows_something_in_both_halves() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["flatten", "in.obj", "--png", "out.png"]).expect(0);
    let picture = image::open(program.path("out.png")).expect("the picture decodes").to_rgba8();
    assert_eq!(picture.dimensions(), (1800, 900), "two halves of 900 × 900");
    for half in [0, 900] {
        let colours: BTreeSet<[u8; 4]> = (0..900)
            .step_by(9)
            .flat_map(|y| (0..900).step_by(9).map(move |x| (x, y)))
            .map(|(x, y)| picture.get_pixel(half + x, y).0)
            .collect();
        assert!(colours.len() > 2, "the half at {half} shows {} colours", colours.len());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_error_names_the_file_asked_for_and_none_that_is_written_aside() {
    let program = Program::new();
    program.write("in.obj", TENT);
    let cases = [
        ("-o", "missing/out.obj"),
        ("--svg", "in.obj/out.svg"),
        ("--report", "/proc/report.json"),
        ("--steps", "/proc/steps"),
    ];
    for (option, path) in cases {
        let run = program.run(&["flatten", "in.obj", option, path]).expect(1);
        let reason = run.stderr.strip_prefix(&format!("freebound: {path}: "));
        assert!(reason.is_some_and(|reason| !reason.contains(['/', '\\'])), "{}", run.stderr);
    }
}
