//! `freebound flatten --cut FILE` and `--seams`: from files to files.

use std::fmt::Write as _;
use std::fs;

use freebound_core::mesh::VertexId;
use freebound_io::{EdgeFault, parse_edges, read_mesh, write_edges};
use glam::DVec2;
use serde_json::json;

use super::program::{Program, obj_text};
use freebound_testkit::cubes::{cross, cube, edge};
use freebound_testkit::{Random, assert_message, band, quad_sheet};

/// Seam file of a cross, with comments.
const CROSS: &str = "\u{feff}# a cross\n0 4\r\n5 1  # upright\n\n 2\t6\n3 7\n5 7\n7 6\n6 4\n6 4\n";

/// Cube with other contents of a file besides positions and faces.
fn rich_cube() -> String {
    let mut text = "# a cube\r\no Würfel\r\nvn 0 0 1\r\nusemtl red\r\n".to_owned();
    let bare = obj_text(&cube());
    let (vertices, faces): (Vec<&str>, Vec<&str>) = bare.lines().partition(|line| line.starts_with('v'));
    for line in vertices {
        write!(text, "{line} 0.5 0.25 1\r\n").expect("memory");
    }
    for (number, line) in faces.iter().enumerate() {
        if number == 2 {
            text += "g sides\r\nusemtl blue\r\ns off\r\n";
        }
        let corners = line.replace(' ', "//1 ").replacen("//1 ", " ", 1);
        write!(text, "{corners}//1\r\n").expect("memory");
    }
    text + "l 1 2\r\n# the end\r\n"
}

#[test]
fn a_cube_cut_along_a_cross_unfolds_to_its_net() {
    let program = Program::new();
    program.write("cube.obj", &rich_cube());
    program.write("cross.txt", CROSS);
    let arguments = ["flatten", "cube.obj", "--cut", "cross.txt", "--fit", "true", "-o", "out.obj", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(report["verdict"]["planar"], json!(true));
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "cut-seams", "count": 7}]));
    let file = read_mesh(&program.path("out.obj")).expect("written");
    let texture = file.texture.expect("coordinates");
    // Every side and every diagonal keeps its length: the map is an isometry.
    let mut sides: Vec<[[i64; 2]; 2]> = Vec::new();
    for face in 0..6 {
        let at: Vec<DVec2> = file
            .polygons
            .corner_range(face)
            .map(|corner| texture.coordinates[texture.corners[corner] as usize])
            .collect();
        for k in 0..4 {
            assert!((at[k].distance(at[(k + 1) % 4]) - 1.0).abs() < 1e-9, "{at:?}");
            assert!((at[k].distance(at[(k + 2) % 4]) - 2_f64.sqrt()).abs() < 1e-9, "{at:?}");
            let key = |z: DVec2| (z * 1e6).round().as_i64vec2().to_array();
            let [a, b] = [key(at[k]), key(at[(k + 1) % 4])];
            sides.push([a.min(b), a.max(b)]);
        }
    }
    sides.sort_unstable();
    sides.dedup();
    assert_eq!(sides.len(), 24 - 5, "the six squares hang together at five sides");
}

#[test]
fn the_file_comes_back_as_it_was_but_for_its_texture_coordinates() {
    let program = Program::new();
    program.write("cube.obj", &rich_cube());
    program.write("cross.txt", CROSS);
    program.run(&["flatten", "cube.obj", "--cut", "cross.txt", "-o", "out.obj"]).expect(0);
    let after = fs::read_to_string(program.path("out.obj")).expect("written");
    let bare = |line: &str| {
        let corners = line.split(' ').map(|corner| corner.split('/').next().unwrap_or_default());
        corners.collect::<Vec<_>>().join(" ")
    };
    let before: Vec<String> = rich_cube().split('\n').map(bare).collect();
    let after: Vec<String> = after.split('\n').filter(|line| !line.starts_with("vt ")).map(bare).collect();
    assert_eq!(after, before);
    let again = program.run(&["flatten", "cube.obj", "--cut", "cross.txt", "-o", "again.obj", "--threads", "1"]);
    again.expect(0);
    let [first, second] = ["out.obj", "again.obj"].map(|name| fs::read(program.path(name)).expect("written"));
    assert!(first == second, "the same bytes with one thread");
}

#[test]
fn what_the_edges_leave_is_cut_as_auto_does() {
    let program = Program::new();
    program.write("cube.obj", &obj_text(&cube()));
    program.write("two.txt", "0 4\n4 5\n");
    let arguments = ["flatten", "cube.obj", "--cut", "two.txt", "-o", "out.obj", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    // With filled holes, a slit turns a closed surface into a disk.
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "cut-seams", "count": 2}]));
    program.write("none.txt", "# nothing\n");
    let report = program.run(&["flatten", "cube.obj", "--cut", "none.txt", "--report", "-"]).expect(0).json();
    assert_eq!(report["mesh"]["repairs"][0]["repair"], json!("cut"));
}

#[test]
fn creases_materials_and_groups_are_seams_by_name() {
    let program = Program::new();
    program.write("cube.obj", &rich_cube());
    // Lid and floor, of one material, are two charts; the sides are one.
    let cases = [("sharp", 6), ("sharp=90", 6), ("materials", 3), ("groups", 3), ("materials,groups", 3)];
    for (seams, charts) in cases {
        let run = program.run(&["flatten", "cube.obj", "--seams", seams, "--cut", "shortest", "--report", "-"]);
        let report = run.expect(0).json();
        assert_eq!(report["charts"].as_array().map(Vec::len), Some(charts), "{seams}");
    }
    let refused = program.run(&["flatten", "cube.obj", "--seams", "sharp=91", "--report", "-"]).expect(3).json();
    let faults = refused["error"]["faults"].as_array().expect("faults");
    assert!(faults.iter().any(|fault| fault["kind"] == "closed"), "{faults:?}");
}

#[test]
fn seams_that_the_file_does_not_have_are_named() {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&quad_sheet(3, 2, 0.1, &mut Random(1))));
    for seams in ["materials", "groups"] {
        let refused = program.run(&["flatten", "sheet.obj", "--seams", seams]).expect(2);
        assert_message(&format!("seams-without-{seams}"), &refused.stderr);
    }
    for wrong in ["sharp=0", "sharp=181", "sharp=x", "blunt", "materials=3"] {
        program.run(&["flatten", "sheet.obj", "--seams", wrong]).expect(2);
    }
}

#[test]
fn an_edge_that_is_none_is_refused_with_its_line() {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&quad_sheet(3, 2, 0.1, &mut Random(1))));
    for (case, text, line) in [("no-such-edge", "0 1\n# x\n0 5\n", 3), ("no-such-vertex", "0 12\n", 1)] {
        program.write("edges.txt", text);
        let run = program.run(&["flatten", "sheet.obj", "--cut", "edges.txt", "--report", "-"]).expect(3);
        assert_message(&format!("seams-{case}"), &run.stderr);
        let error = &run.json()["error"];
        assert_eq!([&error["kind"], &error["faults"][0]["line"]], [&json!("edges"), &json!(line)]);
    }
    let gone = program.run(&["flatten", "sheet.obj", "--cut", "gone.txt", "--report", "-"]).expect(3);
    let error = &gone.json()["error"];
    assert_eq!([&error["kind"], &error["faults"]], [&json!("edges"), &json!([])]);
    assert!(gone.stderr.contains("gone.txt"), "{}", gone.stderr);
    let over = program.run(&["flatten", "sheet.obj", "--cut", "edges.txt", "-o", "edges.txt"]).expect(2);
    assert_message("seams-over-the-edges", &over.stderr);
    program.write("long.txt", &"# a comment\n".repeat(100_000));
    let long = program.run(&["flatten", "sheet.obj", "--cut", "long.txt"]).expect(3);
    assert_message("seams-edges-file-is-too-long", &long.stderr);
}

#[test]
fn every_wrong_line_has_its_fault() {
    let cube = cube();
    let fault = |text: &str| parse_edges(text, &cube).expect_err("it is wrong");
    let v = VertexId::new;
    assert_eq!(fault("0"), (1, EdgeFault::Form("0".into())));
    assert_eq!(fault("\n0 1 3"), (2, EdgeFault::Form("0 1 3".into())));
    assert_eq!(fault("0,1"), (1, EdgeFault::Form("0,1".into())));
    assert_eq!(fault("-1 0"), (1, EdgeFault::BadVertex("-1".into())));
    assert_eq!(fault("0 4294967296"), (1, EdgeFault::BadVertex("4294967296".into())));
    assert_eq!(fault("3 3"), (1, EdgeFault::OneVertex(v(3))));
    assert_eq!(fault("3 8"), (1, EdgeFault::NoSuchVertex { vertex: v(8), count: 8 }));
    // Across a square; across the cube. The first faulty line is reported, whatever its fault.
    assert_eq!(fault("0 1\n3 0\n7 0\nx"), (2, EdgeFault::NoSuchEdge(edge(0, 3))));
    assert_eq!(fault("0 1\nx\n3 0"), (2, EdgeFault::Form("x".into())));
}

#[test]
fn edges_that_are_written_are_read_again() {
    let cube = cube();
    let mut text = Vec::new();
    write_edges(&mut text, cross()).expect("memory");
    assert_eq!(parse_edges(std::str::from_utf8(&text).expect("text"), &cube), Ok(cross().to_vec()));
    let read = parse_edges(CROSS, &cube).expect("it is right");
    assert_eq!((read.len(), read[1]), (8, edge(5, 1)));
}

/// Three quads in a row, the middle one with the opposite orientation.
const MIXED: &str = "v 0 0 0\nv 1 0 0\nv 2 0 .3\nv 0 1 0\nv 1 1 0\nv 2 1 .3\nv 3 0 0\nv 3 1 0\n\
                     f 1 2 5 4\nf 2 5 6 3\nf 3 7 8 6\n";

#[test]
fn faces_that_run_the_other_way_are_turned_where_that_is_allowed_with_seams_too() {
    let program = Program::new();
    program.write("mixed.obj", MIXED);
    program.write("seam.txt", "2 5\n");
    let refused = program.run(&["flatten", "mixed.obj", "--cut", "seam.txt"]).expect(3);
    assert!(refused.stderr.contains("mixed-orientation"), "{}", refused.stderr);
    let turned = program.run(&["flatten", "mixed.obj", "--cut", "seam.txt", "--repair", "all", "--report", "-"]);
    assert_eq!(turned.expect(0).json()["mesh"]["repairs"][0], json!({"repair": "turn-faces", "count": 1}));
    // A one-sided strip becomes two-sided once cut, and then its faces have to be turned.
    program.write("band.obj", &obj_text(&(&band(13, 1)).into()));
    program.write("across.txt", "10 11\n");
    let report = program.run(&["flatten", "band.obj", "--cut", "across.txt", "--report", "-"]).expect(0).json();
    assert_eq!(report["mesh"]["repairs"][0], json!({"repair": "cut-seams", "count": 1}));
    assert_eq!(report["mesh"]["repairs"][1]["repair"], json!("turn-faces"));
}

#[test]
fn faces_that_touch_in_a_vertex_alone_stay_so_where_they_are_not_to_be_split() {
    let program = Program::new();
    let bow = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\nv -1 0 0\nv -1 1 0\n\
               f 1 2 3 4\nf 3 5 6 7\nf 8 1 4 9\n";
    program.write("bow.obj", bow);
    program.write("elsewhere.txt", "0 3\n");
    let refused = program.run(&["flatten", "bow.obj", "--cut", "elsewhere.txt", "--repair", "turn-faces"]).expect(3);
    assert!(refused.stderr.contains("non-manifold-vertices"), "{}", refused.stderr);
    let split = program.run(&["flatten", "bow.obj", "--cut", "elsewhere.txt", "--report", "-"]).expect(0).json();
    let expected = json!([{"repair": "split-vertices", "count": 1}, {"repair": "cut-seams", "count": 1}]);
    assert_eq!(split["mesh"]["repairs"], expected);
}

#[test]
fn the_way_on_names_what_is_to_be_added_to_the_options_that_are_given() {
    let program = Program::new();
    program.write("mixed.obj", MIXED);
    program.write("seam.txt", "2 5\n");
    let way_on = |arguments: &[&str]| {
        let refused = program.run(arguments).expect(3);
        refused.stderr.lines().next_back().expect("a way on").to_owned()
    };
    assert_message("seams-way-on-of-a-cut", &way_on(&["flatten", "mixed.obj", "--cut", "seam.txt"]));
    assert_message("seams-way-on-of-creases", &way_on(&["flatten", "mixed.obj", "--seams", "sharp=91"]));
    program.write("cube.obj", &obj_text(&cube()));
    let arguments = ["flatten", "cube.obj", "--seams", "sharp=91", "--repair", "all"];
    assert_message("seams-way-on-of-repairs", &way_on(&arguments));
}
