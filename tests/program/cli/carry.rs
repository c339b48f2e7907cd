//! `freebound carry`: constraints of one mesh on another.

use std::fs;

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_io::Constraints;
use freebound_testkit::{assert_message, shaped};
use glam::DVec3;
use serde_json::json;

use super::program::{Program, obj_text};

/// Bent sheet of one size, with this many squares along each side.
fn sheet(side: u32) -> PolygonMesh {
    let step = 12.0 / f64::from(side);
    PolygonMesh::from(&shaped(side, side, |x, y| DVec3::new(x * step, y * step, (0.4 * x * step).sin())))
}

/// Folder with a coarse and a fine sheet, and constraints on the corners of the coarse one.
fn sheets() -> Program {
    let program = Program::new();
    program.write("coarse.obj", &obj_text(&sheet(4)));
    program.write("fine.obj", &obj_text(&sheet(12)));
    program.write("corners.txt", "0 0 0 # first\n4 1 0\n20 0 1 2.5\n24 1 1\n");
    program
}

#[test]
fn constraints_of_a_coarse_mesh_hold_the_same_places_of_a_fine_one() {
    let program = sheets();
    let arguments = ["carry", "coarse.obj", "fine.obj", "--constraints", "corners.txt", "-o", "fine.txt"];
    let run = program.run(&arguments).expect(0);
    assert_message("carried-constraints", &run.stdout);
    let carried = Constraints::read(&program.path("fine.txt"), 169).expect("constraints");
    let [old, new] = [[0, 4, 20, 24], [0, 12, 156, 168]].map(|list| list.map(VertexId::new));
    let given = Constraints::read(&program.path("corners.txt"), 25).expect("constraints");
    assert_eq!(carried.targets.keys().copied().collect::<Vec<_>>(), new);
    assert_eq!(new.map(|vertex| carried.targets[&vertex]), old.map(|vertex| given.targets[&vertex]));
    assert_eq!(carried.notes[&new[0]], given.notes[&old[0]]);
    // The written file serves a run.
    program.run(&["flatten", "fine.obj", "--constraints", "fine.txt"]).expect(0);
}

#[test]
fn the_report_counts_what_was_carried_and_names_what_is_lost() {
    let program = sheets();
    let arguments = ["carry", "coarse.obj", "coarse.obj", "-c", "corners.txt", "-o", "same.txt", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(report["carried"]["same_faces"], json!(true));
    assert_eq!(report["carried"]["count"], json!(4));
    assert_eq!(report["carried"]["vertices"][3], json!({"from": 24, "to": 24, "distance": 0.0}));
    // Five neighbours of a fine mesh do not fit on the four corners of a square.
    program.write("crowd.txt", "0 0 0\n1 0.1 0\n2 0.2 0\n13 0 0.1\n14 0.1 0.1\n");
    program.write("square.obj", &obj_text(&sheet(1)));
    let arguments = ["carry", "fine.obj", "square.obj", "-c", "crowd.txt", "-o", "few.txt", "--report", "-"];
    let report = program.run(&arguments).expect(4).json();
    let vertices = report["carried"]["vertices"].as_array().expect("a list");
    let lost = vertices.iter().filter(|vertex| vertex["to"].is_null()).count();
    assert!((1..5).contains(&lost), "{report}");
    assert_eq!(report["carried"]["count"], json!(5 - lost), "{report}");
}

#[test]
fn meshes_that_lie_apart_are_said_and_fitted() {
    let program = sheets();
    let positions = sheet(12).positions.iter().map(|place| 0.01 * *place + DVec3::splat(7.0)).collect();
    program.write("small.obj", &obj_text(&PolygonMesh { positions, ..sheet(12) }));
    let arguments = ["carry", "coarse.obj", "small.obj", "-c", "corners.txt", "-o", "small.txt"];
    let run = program.run(&arguments);
    assert_message("carried-constraints-apart", &run.stdout);
    program.run(&[&arguments[..], &["--fit"]].concat()).expect(0);
    let carried = fs::read_to_string(program.path("small.txt")).expect("written");
    program.run(&["carry", "coarse.obj", "fine.obj", "-c", "corners.txt", "-o", "fine.txt"]).expect(0);
    assert_eq!(carried, fs::read_to_string(program.path("fine.txt")).expect("written"));
}

#[test]
fn inputs_are_not_written_over_and_a_wrong_list_is_refused() {
    let program = sheets();
    for output in ["coarse.obj", "fine.obj", "corners.txt"] {
        let before = fs::read(program.path(output)).expect("there");
        program.run(&["carry", "coarse.obj", "fine.obj", "-c", "corners.txt", "-o", output]).expect(2);
        assert_eq!(fs::read(program.path(output)).expect("there"), before);
    }
    program.write("wrong.txt", "99 0 0\n");
    let run = program.run(&["carry", "coarse.obj", "fine.obj", "-c", "wrong.txt", "-o", "out.txt"]).expect(3);
    assert_message("carry-wrong-constraints", &run.stderr);
    assert!(!program.path("out.txt").exists());
}
