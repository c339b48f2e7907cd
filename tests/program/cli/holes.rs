//! `freebound flatten` on surfaces with holes: fillings are not written.

use std::fs;

use freebound_core::mesh::PolygonMesh;
use freebound_io::read_mesh;
use serde_json::{Value, json};

use super::program::{Program, argument, obj_text};
use freebound_testkit::surfaces::without_faces;
use freebound_testkit::{Random, assert_message, band, corpus_entry, corpus_test, quad_sheet};

/// Bent sheet of quads with two holes, one of two quads.
fn sheet() -> PolygonMesh {
    without_faces(&quad_sheet(6, 6, 0.0, &mut Random(1)), |face| [14, 15, 28].contains(&face))
}

fn lines<'a>(text: &'a str, keyword: &str) -> Vec<&'a str> {
    text.lines().filter(|line| line.split(' ').next() == Some(keyword)).collect()
}

/// Lines of a text without texture coordinates.
fn without_texture(text: &str) -> Vec<String> {
    let bare =
        |line: &str| line.split(' ').map(|word| word.split('/').next().unwrap_or(word)).collect::<Vec<_>>().join(" ");
    text.lines().filter(|line| !line.starts_with("vt ")).map(bare).collect()
}

#[test]
fn a_file_with_holes_comes_back_with_coordinates_and_nothing_else() {
    let program = Program::new();
    let text = format!("# two holes\n{}l 1 2 3\n", obj_text(&sheet()));
    program.write("sheet.obj", &text);
    let run = program.run(&["flatten", "sheet.obj", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let repairs = run.stdout.lines().find(|line| line.starts_with("mesh:")).expect("a line on the mesh");
    assert_message("holes-filled", repairs);
    let written = fs::read_to_string(program.path("out.obj")).unwrap();
    assert_eq!(without_texture(&written), text.lines().collect::<Vec<_>>());
    assert_eq!(lines(&written, "vt").len(), 49, "one for each vertex of the file");
    let report: Value = serde_json::from_str(&fs::read_to_string(program.path("out.json")).unwrap()).unwrap();
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "fill-holes", "count": 2}]));
    assert_eq!([&report["mesh"]["vertices"], &report["mesh"]["faces"]], [&json!(49), &json!(66)]);
    assert_eq!(report["verdict"]["planar"], json!(true));
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["atlas"]["planar"], json!(true));
    assert_eq!(check["atlas"]["charts"][0]["boundary_loops"], json!(3));
    let diagnosis = program.run(&["check", "sheet.obj"]).expect(0).stdout;
    let (surface, _) = diagnosis.split_once(',').expect("numbers after the kind of the surface");
    assert_message("holes-disk-with-holes", surface);
    let check = program.run(&["check", "sheet.obj", "--report", "-"]).expect(0).json();
    assert_eq!([&check["mesh"]["vertices"], &check["mesh"]["faces"]], [&json!(49), &json!(66)]);
}

#[test]
fn a_ply_file_with_holes_comes_back_with_coordinates() {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&sheet()));
    program.run(&["flatten", "sheet.obj", "-o", "out.ply"]).expect(0);
    let back = read_mesh(&program.path("out.ply")).unwrap();
    assert_eq!((back.polygons.positions.len(), back.polygons.face_count()), (49, 33));
    program.run(&["check", "out.ply"]).expect(0);
}

#[test]
fn a_file_that_is_repaired_and_gets_new_vertices_keeps_its_text() {
    let program = Program::new();
    // A repeated corner, so that it is repaired too; a comment and a line that a rewritten file would lose.
    let mesh = sheet();
    let text = format!("# kept\n{}f 1 1 2\nl 1 2 3\n", obj_text(&mesh));
    program.write("sheet.obj", &text);
    // The corners of the sheet in place, a quad flipped.
    let pins = ["0:0,0", "6:1,0", "48:1,1", "42:0,1", "16:.6,.4", "17:.4,.4", "24:.4,.6", "23:.6,.6"];
    let pins: Vec<&str> = pins.iter().flat_map(|pin| ["--pin", *pin]).collect();
    let run = program.run(&[&["flatten", "sheet.obj", "-o", "out.obj", "--report", "-"][..], &pins].concat()).expect(0);
    let report = run.json();
    let new = usize::try_from(report["new_vertices"].as_u64().unwrap()).unwrap();
    assert!(new > 0, "{report}");
    let written = fs::read_to_string(program.path("out.obj")).unwrap();
    let kept = without_texture(&written);
    assert_eq!([&kept[0], &kept[kept.len() - 1]], ["# kept", "l 1 2 3"]);
    let vertices = lines(&written, "v");
    assert_eq!(vertices.len(), 49 + new);
    assert_eq!(vertices[..49], lines(&text, "v"));
    assert_eq!(lines(&written, "vt").len(), 49 + new, "one for each vertex that is written");
    // Every new vertex has a face, and is on the edge named in the report.
    let back = read_mesh(&program.path("out.obj")).unwrap();
    for number in 49..49 + new {
        assert!(back.polygons.corners.iter().any(|corner| corner.index() == number), "vertex {number}");
        let at = back.polygons.positions[number];
        let is_between = |edge: &Value| {
            let [a, b] = [0, 1].map(|end| mesh.positions[usize::try_from(edge[end].as_u64().unwrap()).unwrap()]);
            (a.distance(at) + at.distance(b) - a.distance(b)).abs() < 1e-12
        };
        assert!(report["split_edges"].as_array().unwrap().iter().any(is_between), "vertex {number}");
    }
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["atlas"]["charts"][0]["boundary_loops"], json!(3));
}

#[test]
fn the_same_holes_give_the_same_bytes_whatever_the_threads() {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&sheet()));
    for (threads, name) in [("1", "one.obj"), ("3", "three.obj")] {
        program.run(&["flatten", "sheet.obj", "--relax", "3", "--threads", threads, "-o", name]).expect(0);
    }
    assert_eq!(fs::read(program.path("one.obj")).unwrap(), fs::read(program.path("three.obj")).unwrap());
}

#[test]
fn holes_are_cut_where_that_is_asked_for() {
    let program = Program::new();
    program.write("ring.obj", &obj_text(&(&band(8, 0)).into()));
    let refused = program.run(&["flatten", "ring.obj", "--holes", "cut", "--report", "-"]).expect(3).json();
    let faults = refused["error"]["faults"].as_array().unwrap();
    assert!(faults.iter().any(|fault| fault["kind"] == "several-boundary-loops"), "{refused:#}");
    program.run(&["flatten", "ring.obj", "--repair", "none"]).expect(3);
    let report =
        program.run(&["flatten", "ring.obj", "--holes", "cut", "--cut", "shortest", "--report", "-"]).expect(0).json();
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "cut", "count": 1}]));
    let report = program.run(&["flatten", "ring.obj", "--cut", "shortest", "--report", "-"]).expect(0).json();
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "fill-holes", "count": 1}]));
}

#[test]
fn a_pin_on_what_fills_a_hole_is_refused() {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&sheet()));
    let run = program.run(&["flatten", "sheet.obj", "--pin", "49:0,0"]).expect(2);
    assert_message("holes-pin-on-a-filling", &run.stderr);
}

corpus_test! {
    fn the_plane_with_27_loops_flattens_without_an_option() {
        let entry = corpus_entry("bad/holes_plane.obj");
        let program = Program::new();
        let arguments = ["flatten", argument(&entry.path), "-o", "out.obj", "--svg", "out.svg", "--report", "-"];
        let report = program.run(&arguments).expect(0).json();
        assert_eq!(report["mesh"]["repairs"], json!([{"repair": "fill-holes", "count": 26}]));
        assert_eq!([&report["verdict"]["planar"], &report["verdict"]["f32"]], [&json!(true), &json!(true)]);
        let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
        assert_eq!(check["atlas"]["charts"][0]["boundary_loops"], json!(27));
    }
}

#[test]
fn charts_with_holes_are_filled_each_by_itself() {
    let program = Program::new();
    let one = obj_text(&sheet());
    // A copy beside the first sheet, its faces after those of the first.
    let moved = |line: &str| match line.split_once(' ') {
        Some(("v", rest)) => {
            let (x, others) = rest.split_once(' ').unwrap();
            format!("v {} {others}\n", x.parse::<f64>().unwrap() + 20.0)
        }
        Some(("f", rest)) => {
            let corners = rest.split(' ').map(|corner| (corner.parse::<u32>().unwrap() + 49).to_string());
            format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
        }
        _ => format!("{line}\n"),
    };
    let text = format!("{one}{}", one.lines().map(moved).collect::<String>());
    program.write("two.obj", &text);
    let report = program.run(&["flatten", "two.obj", "-o", "out.obj", "--png", "out.png", "--report", "-"]).expect(0);
    let report = report.json();
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "fill-holes", "count": 4}]));
    assert_eq!(report["atlas"]["planar"], json!(true));
    assert_eq!(report["charts"][1]["faces"], json!(66));
    let written = fs::read_to_string(program.path("out.obj")).unwrap();
    assert_eq!(without_texture(&written), text.lines().collect::<Vec<_>>());
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    for chart in 0..2 {
        assert_eq!(check["atlas"]["charts"][chart]["boundary_loops"], json!(3));
    }
    // With the other treatment both are cut.
    let cut =
        program.run(&["flatten", "two.obj", "--holes", "cut", "--cut", "shortest", "--report", "-"]).expect(0).json();
    assert_eq!(cut["mesh"]["repairs"][0]["repair"], json!("cut"));
}
