//! `freebound flatten` on meshes of several charts: solved, packed, proved together and written into their file.

use std::fmt::Write as _;
use std::fs;

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_io::{MeshFile, read_mesh};
use glam::DVec2;
use serde_json::{Value, json};

use super::atlas::shared_area;
use super::flatten_files::xml_elements;
use super::program::{Program, argument, obj_text};
use freebound_testkit::many_parts::{disks, interleaved, surfaces};
use freebound_testkit::{Entry, Random, assert_message, corpus_disks, corpus_test, data_disks, grid, manifest};

/// Disks and closed surfaces with interleaved faces, in a file.
fn mixed(program: &Program, seed: u64) -> PolygonMesh {
    let mut random = Random(seed);
    let parts = surfaces(&mut random);
    let source = interleaved(&parts, &mut random);
    program.write("in.obj", &obj_text(&source));
    source
}

/// Triangles in the plane, polygons split as a fan from their first corner.
pub(crate) fn triangles(file: &MeshFile) -> Vec<[DVec2; 3]> {
    let texture = file.texture.as_ref().expect("coordinates");
    let at = |place: usize| texture.coordinates[texture.corners[place] as usize];
    let fan = |face: usize| {
        let range = file.polygons.corner_range(face);
        (range.start + 1..range.end - 1).map(move |k| [at(range.start), at(k), at(k + 1)])
    };
    (0..file.polygons.face_count()).flat_map(fan).collect()
}

/// Asserts by clipping that no two triangles share an area, and that none is flipped.
#[track_caller]
pub(crate) fn assert_one_to_one(file: &MeshFile) {
    let triangles = triangles(file);
    for (k, &a) in triangles.iter().enumerate() {
        assert!((a[1] - a[0]).perp_dot(a[2] - a[0]) > 0.0, "{a:?}");
        for &b in &triangles[k + 1..] {
            // The least of these triangles has an area of about 1e-4.
            assert!(shared_area(a, b) < 1e-12, "{a:?} {b:?}");
        }
    }
}

#[track_caller]
fn report_of(program: &Program, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(program.path(name)).expect("written")).expect("JSON")
}

/// Number of charts that `check` proves in a file.
#[track_caller]
pub(crate) fn charts_proved(program: &Program, name: &str) -> usize {
    let report = program.run(&["check", name, "--report", "-"]).expect(0).json();
    assert_eq!((&report["atlas"]["planar"], &report["atlas"]["f32"]), (&json!(true), &json!(true)));
    report["atlas"]["charts"].as_array().expect("charts").len()
}

#[test]
fn every_part_becomes_a_chart_and_the_layout_is_one_to_one() {
    for seed in 0..3 {
        let program = Program::new();
        let source = mixed(&program, seed);
        let arguments = ["flatten", "in.obj", "--cut", "shortest", "--report", "out.json"];
        for name in ["out.obj", "out.ply"] {
            program.run(&[&arguments[..], &["-o", name]].concat()).expect(0);
            assert_eq!(charts_proved(&program, name), 8);
            let written = read_mesh(&program.path(name)).expect("written");
            // A PLY file of 32 bits has copies of vertices after the others.
            assert_eq!(written.polygons.positions[..source.positions.len()], source.positions);
            let places =
                |mesh: &PolygonMesh| mesh.corners.iter().map(|v| mesh.positions[v.index()]).collect::<Vec<_>>();
            assert_eq!(places(&written.polygons), places(&source));
            assert_one_to_one(&written);
        }
        let report = report_of(&program, "out.json");
        let charts = report["charts"].as_array().expect("charts");
        assert_eq!(charts.len(), 8);
        let faces: u64 = charts.iter().map(|chart| chart["faces"].as_u64().expect("a count")).sum();
        assert_eq!(report["mesh"]["faces"], json!(faces));
        assert_eq!(report["atlas"]["charts"].as_array().map(Vec::len), Some(8));
        for (chart, proved) in charts.iter().zip(report["atlas"]["charts"].as_array().expect("charts")) {
            assert_eq!(chart["first_face"], proved["first_face"]);
            assert_eq!(chart["placement"], json!("packed"));
        }
    }
}

#[test]
fn the_bytes_are_the_same_for_any_number_of_threads() {
    let program = Program::new();
    mixed(&program, 8);
    let files = |threads: &str| {
        let outputs = ["-o", "out.obj", "--svg", "out.svg", "--png", "out.png", "--report", "out.json"];
        program
            .run(&[&["flatten", "in.obj", "--cut", "shortest", "--threads", threads], &outputs[..]].concat())
            .expect(0);
        program.run(&["flatten", "in.obj", "--cut", "shortest", "--threads", threads, "-o", "out.ply"]).expect(0);
        let mut report = report_of(&program, "out.json");
        report["seconds"] = json!(null);
        report["peak_memory_bytes"] = json!(null);
        for chart in report["charts"].as_array_mut().expect("charts") {
            chart["steps"].as_array_mut().expect("steps").iter_mut().for_each(|step| step["seconds"] = json!(0));
        }
        let bytes =
            ["out.obj", "out.ply", "out.svg", "out.png"].map(|name| fs::read(program.path(name)).expect("written"));
        (bytes, report)
    };
    let (one, two) = (files("1"), files("2"));
    assert!(one.0 == two.0, "the files differ");
    assert_eq!(one.1, two.1);
}

#[test]
fn pins_hold_their_chart_and_the_others_lie_beside_the_square() {
    let program = Program::new();
    let mut random = Random(12);
    let parts = disks(&mut random);
    let source = interleaved(&parts, &mut random);
    program.write("in.obj", &obj_text(&source));
    // Vertices of the second part, with their numbers in the file.
    let of_part = |part: f64| {
        let is_there = move |x: f64| (part * 100.0 - 20.0..part * 100.0 + 80.0).contains(&x);
        (0..source.positions.len()).filter(move |&v| is_there(source.positions[v].x))
    };
    let held: Vec<usize> = of_part(1.0).collect();
    let [a, b, c] = [held[0], held[held.len() / 2], held[held.len() - 1]];
    let targets = [(a, DVec2::new(0.1, 0.25)), (b, DVec2::new(0.8, 0.3)), (c, DVec2::new(0.7, 1.0 / 3.0))];
    let lines: String = targets[1..].iter().fold(String::new(), |mut text, (v, uv)| {
        writeln!(text, "{v} {:?} {:?}", uv.x, uv.y).expect("memory");
        text
    });
    program.write("pins.txt", &lines);
    let pin = format!("{a}:0.1,0.25");
    let arguments = ["flatten", "in.obj", "--pin", &pin, "--constraints", "pins.txt", "--no-new-vertices"];
    program.run(&[&arguments[..], &["-o", "out.obj", "--report", "out.json"]].concat()).expect(0);
    let file = read_mesh(&program.path("out.obj")).expect("written");
    let texture = file.texture.as_ref().expect("coordinates");
    for (vertex, at) in file.polygons.corners.iter().zip(&texture.corners) {
        let uv = texture.coordinates[*at as usize];
        match targets.iter().find(|(pinned, _)| *pinned == vertex.index()) {
            Some((_, target)) => assert_eq!(uv, *target, "vertex {vertex}"),
            None if held.contains(&vertex.index()) => {}
            None => assert!(uv.x > 1.0 && (0.0..1.0).contains(&uv.y), "vertex {vertex} at {uv}"),
        }
    }
    assert_one_to_one(&file);
    let report = report_of(&program, "out.json");
    let placements: Vec<&str> =
        report["charts"].as_array().expect("charts").iter().filter_map(|chart| chart["placement"].as_str()).collect();
    assert_eq!(placements.iter().filter(|&&placement| placement == "pins").count(), 1, "{placements:?}");
    let counts: u64 =
        report["charts"].as_array().expect("charts").iter().filter_map(|chart| chart["pins"]["count"].as_u64()).sum();
    assert_eq!(counts, 3);
}

#[test]
fn pins_that_are_not_met_are_named_as_the_file_numbers_vertices() {
    let program = Program::new();
    let source = interleaved(&[(&grid(3, 3)).into(), (&grid(2, 2)).into()], &mut Random(6));
    program.write("in.obj", &obj_text(&source));
    // Two neighbours in swapped order between others: no straight path exists without new vertices.
    let corner = |x: f64, y: f64| {
        let is_here = |p: &glam::DVec3| p.x == x && p.y == y;
        VertexId::from_index(source.positions.iter().position(is_here).expect("a vertex of the first"))
    };
    let pins = [
        ([0., 0.], [0., 0.]),
        ([3., 0.], [1., 0.]),
        ([3., 3.], [1., 1.]),
        ([0., 3.], [0., 1.]),
        ([1., 1.], [0.7, 0.7]),
        ([2., 2.], [0.3, 0.3]),
    ]
    .map(|([x, y], [u, v])| format!("{}:{u},{v}", corner(x, y).number()));
    let mut arguments = vec!["flatten", "in.obj", "--no-new-vertices", "--report", "-"];
    for pin in &pins {
        arguments.extend(["--pin", pin]);
    }
    let report = program.run(&arguments).expect(4).json();
    let unmet: Vec<&Value> = report["charts"]
        .as_array()
        .expect("charts")
        .iter()
        .flat_map(|chart| chart["pins"]["unmet"].as_array().expect("a list"))
        .collect();
    let pinned: Vec<u64> =
        pins.iter().map(|pin| pin.split(':').next().expect("a vertex").parse().expect("a number")).collect();
    assert!(
        !unmet.is_empty() && unmet.iter().all(|vertex| pinned.contains(&vertex.as_u64().expect("a number"))),
        "{unmet:?}"
    );
}

#[test]
fn messages_name_vertices_as_the_file_numbers_them() {
    let program = Program::new();
    let source = interleaved(&disks(&mut Random(2)), &mut Random(6));
    program.write("in.obj", &obj_text(&source));
    let two: Vec<usize> = (0..source.positions.len()).filter(|&v| source.positions[v].x > 380.0).take(2).collect();
    let pins = two.iter().map(|v| format!("{v}:0.5,0.5")).collect::<Vec<_>>();
    let run = program.run(&["flatten", "in.obj", "--pin", &pins[0], "--pin", &pins[1]]).expect(2);
    let names: Vec<String> = two.iter().map(|v| format!("v{v}")).collect();
    let is_named = |line: &str, name: &str| line.split([' ', ':', ',']).any(|word| word == name);
    let lines: Vec<&str> = run.stderr.lines().collect();
    assert_eq!(lines.len(), 2, "a conflict, and the error: {}", run.stderr);
    for line in lines {
        assert!(names.iter().all(|name| is_named(line, name)), "{names:?}: {line}");
    }
}

#[test]
fn a_pin_of_a_vertex_that_the_mesh_does_not_have_is_refused() {
    let program = Program::new();
    program.write("one.obj", &obj_text(&(&grid(1, 1)).into()));
    program.write("two.obj", &obj_text(&interleaved(&[(&grid(1, 1)).into(), (&grid(1, 1)).into()], &mut Random(1))));
    for (file, count) in [("one.obj", 4), ("two.obj", 8)] {
        let run = program.run(&["flatten", file, "--pin", "9:0,0"]).expect(2);
        assert_message(&format!("charts-pin-beyond-{count}-vertices"), &run.stderr);
    }
}

#[test]
fn several_charts_are_drawn_at_their_true_size_unless_their_scales_differ() {
    // Extremely large meshes are scaled in the solver.
    for size in [1.0, 2.0_f64.powi(120)] {
        drawn_at_true_size(size);
    }
}

fn drawn_at_true_size(size: f64) {
    let program = Program::new();
    let mut parts: [PolygonMesh; 2] = [(&grid(2, 2)).into(), (&grid(1, 3)).into()];
    parts.iter_mut().flat_map(|part| &mut part.positions).for_each(|place| *place *= size);
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(6))));
    let draw = ["flatten", "in.obj", "--svg", "out.svg", "--svg-scale", "true"];
    program.run(&draw).expect(0);
    let text = fs::read_to_string(program.path("out.svg")).expect("it was drawn");
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let length = |line: &str| {
        let outline = line.split(" d=\"M").nth(1).and_then(|data| data.split('Z').next()).expect("a closed path");
        let points: Vec<DVec2> = outline
            .split('L')
            .map(|point| point.split_once(' ').map(|(x, y)| DVec2::new(number(x), number(y))).expect("a point"))
            .collect();
        (0..points.len()).map(|k| points[k].distance(points[(k + 1) % points.len()])).sum::<f64>()
    };
    let lengths: Vec<f64> = text.lines().filter(|line| line.contains("class=\"boundary\"")).map(length).collect();
    // The parts are flat and have faces of one unit, so that both outlines are eight units long.
    assert_eq!(lengths.len(), 2);
    assert!(lengths.iter().all(|length| (length / size - 8.0).abs() < 1e-3), "{lengths:?}");
    for own_scale in [["--chart-size", "0=2"], ["--pin", "0:0,0"]] {
        let run = program.run(&[&draw[..], &own_scale[..]].concat()).expect(2);
        assert_message("charts-refuse-svg-scale", &run.stderr);
    }
}

#[test]
fn several_charts_are_written_at_their_true_size_side_by_side() {
    let program = Program::new();
    let parts: [PolygonMesh; 2] = [(&grid(2, 2)).into(), (&grid(1, 3)).into()];
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(6))));
    let flatten = ["flatten", "in.obj", "--fit", "true", "-o", "out.obj", "--report", "-"];
    let report = program.run(&flatten).expect(0).json();
    for chart in report["charts"].as_array().expect("charts") {
        assert_eq!([&chart["placement"], &chart["density"]], [&json!("true"), &json!(1.0)]);
    }
    assert_eq!([&report["packing"], &report["atlas"]["planar"]], [&Value::Null, &json!(true)]);
    program.run(&["check", "out.obj"]).expect(0);
    let written = read_mesh(&program.path("out.obj")).expect("a mesh");
    let (mesh, texture) = (&written.polygons, written.texture.as_ref().expect("texture coordinates"));
    for face in 0..mesh.face_count() {
        let corners: Vec<usize> = mesh.corner_range(face).collect();
        for (k, &corner) in corners.iter().enumerate() {
            let next = corners[(k + 1) % corners.len()];
            let in_space = |corner: usize| mesh.positions[mesh.corners[corner].index()];
            let on_map = |corner: usize| texture.coordinates[texture.corners[corner] as usize];
            let [long, laid] = [in_space(corner).distance(in_space(next)), on_map(corner).distance(on_map(next))];
            assert!((long - laid).abs() < 1e-9, "face {face}: {laid} for {long}");
        }
    }
    program.run(&["flatten", "out.obj", "--start", "uv", "--fit", "true", "-o", "again.obj"]).expect(0);
    let cases: [&[&str]; 5] =
        [&["--chart-size", "0=2"], &["--pin", "0:0,0"], &["--tiles", "4"], &["--density", "9"], &["--steps", "s"]];
    for options in cases {
        program.run(&[&flatten, options].concat()).expect(2);
    }
}

#[test]
fn what_means_nothing_to_several_charts_is_refused_and_so_are_pins_of_no_face() {
    let program = Program::new();
    let mut source = interleaved(&[(&grid(2, 2)).into(), (&grid(1, 3)).into()], &mut Random(6));
    source.positions.push(glam::DVec3::ONE);
    let (unused, beyond) = (source.positions.len() - 1, source.positions.len());
    program.write("in.obj", &obj_text(&source));
    let run = program.run(&["flatten", "in.obj", "--steps", "steps"]).expect(2);
    assert_message("charts-refuse-steps", &run.stderr);
    for (options, word) in [
        (["--pack", "0x10"], "WIDTHxHEIGHT"),
        (["--pack", "100"], "WIDTHxHEIGHT"),
        (["--pack", "65537x1"], "65536"),
        (["--gap", "1025"], "1024"),
    ] {
        let run = program.run(&[&["flatten", "in.obj"], &options[..]].concat()).expect(2);
        assert!(run.stderr.contains(word), "{}", run.stderr);
    }
    for (vertex, place) in [(unused, "of-no-face"), (beyond, "beyond-the-mesh")] {
        let pin = format!("{vertex}:0,0");
        let run = program.run(&["flatten", "in.obj", "--pin", &pin]).expect(2);
        assert_message(&format!("charts-pin-{place}"), &run.stderr);
    }
    assert_eq!(program.files(), ["in.obj"], "nothing was written");
    let picture = ["--picture", "picture.png", "--pack", "64x64"];
    program.run(&[&["flatten", "in.obj"], &picture[..]].concat()).expect(2);
    // On a mesh of one part these options are accepted without effect.
    program.write("one.obj", &obj_text(&(&grid(2, 2)).into()));
    program.run(&["flatten", "one.obj", "--pack", "64x64", "--gap", "0"]).expect(0);
}

#[test]
fn a_drawing_shows_all_charts_and_is_a_page_as_the_picture() {
    let program = Program::new();
    mixed(&program, 2);
    program.run(&["flatten", "in.obj", "--cut", "shortest", "--svg", "out.svg", "--pack", "512x256"]).expect(0);
    let elements = xml_elements(&fs::read_to_string(program.path("out.svg")).expect("written"));
    assert!(elements[0].contains(r#"viewBox="0 0 1000 500""#), "{}", elements[0]);
    assert_eq!(elements.iter().filter(|element| element.contains(r#"class="boundary""#)).count(), 8);
}

/// Bad files beyond repair: no faces, a malformed number.
const UNUSABLE: [&str; 2] = ["raw_empty.obj", "raw_corrupted_invalid_double.off"];

corpus_test! {
    fn every_bad_file_is_mended_cut_and_proved_or_refused_with_the_reason() {
        for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
            let program = Program::new();
            let arguments = ["flatten", argument(&entry.path), "--repair", "all", "--cut", "shortest", "-o", "out.obj"];
            if UNUSABLE.iter().any(|name| entry.file.ends_with(name)) {
                let report = program.run(&[&arguments[..], &["--report", "-"]].concat()).expect(3).json();
                assert!(report["error"]["remedy"].is_string(), "{}: {report:#}", entry.file);
                continue;
            }
            // Relaxation comes after the proof, so it is not needed.
            let report = program.run(&[&arguments[..], &["--relax", "0", "--report", "-"]].concat()).expect(0).json();
            let verdict = if report["atlas"].is_null() { &report["verdict"] } else { &report["atlas"] };
            assert_eq!(verdict["planar"], json!(true), "{}", entry.file);
            program.run(&["check", "out.obj"]).expect(0);
        }
    }
}

fn assert_the_options_for_bad_files_change_no_byte_of_a_disk(disks: Vec<Entry>) {
    for entry in disks {
        let program = Program::new();
        program.run(&["flatten", argument(&entry.path), "-o", "plain.obj"]).expect(0);
        let options = ["--repair", "all", "--cut", "shortest", "--pack", "512x512", "-o", "mended.obj"];
        program.run(&[&["flatten", argument(&entry.path)], &options[..]].concat()).expect(0);
        let [plain, with_all_repairs] =
            ["plain.obj", "mended.obj"].map(|name| fs::read(program.path(name)).expect("written"));
        assert!(plain == with_all_repairs, "{}", entry.file);
    }
}

#[test]
fn the_options_for_bad_files_change_no_byte_of_a_disk() {
    assert_the_options_for_bad_files_change_no_byte_of_a_disk(data_disks());
}

corpus_test! {
    fn the_options_for_bad_files_change_no_byte_of_a_disk_in_the_corpus() {
        let is_small = |entry: &Entry| entry.number("F").is_some_and(|faces| faces < 2000);
        let small = corpus_disks().into_iter().filter(is_small);
        assert_the_options_for_bad_files_change_no_byte_of_a_disk(small.collect());
    }
}

#[test]
fn thousands_of_loose_triangles_are_one_atlas() {
    let program = Program::new();
    let mut text = String::new();
    let mut random = Random(1);
    for k in 0..2000_u32 {
        for _ in 0..3 {
            let [x, y, z] = [random.unit(), random.unit(), random.unit()];
            writeln!(text, "v {x} {} {z}", y + f64::from(k)).expect("memory");
        }
        writeln!(text, "f {} {} {}", 3 * k + 1, 3 * k + 2, 3 * k + 3).expect("memory");
    }
    program.write("in.obj", &text);
    let atlas = &program.run(&["flatten", "in.obj", "-o", "out.obj", "--report", "-"]).expect(0).json()["atlas"];
    assert_eq!((&atlas["planar"], atlas["charts"].as_array().map(Vec::len)), (&json!(true), Some(2000)));
    assert_eq!(charts_proved(&program, "out.obj"), 2000);
}

#[test]
fn hundreds_of_small_grids_are_one_atlas() {
    let program = Program::new();
    let parts: Vec<PolygonMesh> = (0..500).map(|k| (&grid(2 + k % 3, 3)).into()).collect();
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(5))));
    program.run(&["flatten", "in.obj", "-o", "out.obj"]).expect(0);
    assert_eq!(charts_proved(&program, "out.obj"), 500);
}
