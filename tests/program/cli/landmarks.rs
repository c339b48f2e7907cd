//! `--landmarks`: constraints at the landmarks of a picture.

use std::fs;

use freebound_core::geom::Picture;
use freebound_core::mesh::PolygonMesh;
use freebound_io::raster::write_png;
use freebound_testkit::{assert_message, grid};
use serde_json::json;

use super::program::{Program, obj_text};

/// A sheet, a picture of 20 × 10 pixels, and constraints of which two have the names of landmarks.
fn sheet() -> Program {
    let program = Program::new();
    program.write("sheet.obj", &obj_text(&PolygonMesh::from(&grid(4, 2))));
    let mut bytes = Vec::new();
    let picture = Picture { width: 20, height: 10, pixels: [90, 120, 150, 255].repeat(200) };
    write_png(&picture, &mut bytes).expect("memory");
    fs::write(program.path("picture.png"), bytes).expect("the folder can be written to");
    program.write("pins.txt", "0 0.1 0.1 # Point 1\n4 0.9 0.1 # point 2\n12 0.4 0.9 2 # chin\n");
    // Pixels are counted from the centre of the first one, which is (1, 1).
    program.write("face.pts", "version: 1\nn_points: 2\n{\n4.5 8.0\n18.5 6.5\n}\n");
    program
}

const ARGUMENTS: [&str; 6] = ["flatten", "sheet.obj", "--constraints", "pins.txt", "--landmarks", "face.pts"];

#[test]
fn constraints_move_to_the_landmarks_of_their_names_and_the_others_stay() {
    let program = sheet();
    let pinned = [&ARGUMENTS[..], &["--picture", "picture.png", "-o", "a.obj", "--report", "-"]].concat();
    let report = program.run(&pinned).expect(0).json();
    assert_eq!(report["pins"]["count"], json!(3));
    program.write("moved.txt", "0 0.2 0.25\n4 0.9 0.4\n12 0.4 0.9 2\n");
    let moved = ["flatten", "sheet.obj", "--constraints", "moved.txt", "--picture", "picture.png", "-o", "b.obj"];
    program.run(&moved).expect(0);
    let coordinates = |name: &str| {
        let text = fs::read_to_string(program.path(name)).expect("written");
        text.lines().filter(|line| line.starts_with("vt ")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(coordinates("a.obj"), coordinates("b.obj"));
}

#[test]
fn landmarks_without_a_picture_without_names_or_with_a_faulty_line_are_refused() {
    let program = sheet();
    let without_picture = program.run(&ARGUMENTS).expect(2);
    assert_message("landmarks-without-picture", &without_picture.stderr);
    program.write("bare.txt", "0 0.1 0.1\n");
    let with_picture = |constraints: &'static str, landmarks: &'static str| {
        let files = ["--constraints", constraints, "--landmarks", landmarks, "--picture", "picture.png"];
        program.run(&[&["flatten", "sheet.obj"][..], &files].concat())
    };
    assert_message("landmarks-without-names", &with_picture("bare.txt", "face.pts").expect(2).stderr);
    program.write("bad.pts", "version: 1\nn_points: 2\n{\n4.5 x\n18.5 6.5\n}\n");
    assert_message("landmarks-bad-line", &with_picture("pins.txt", "bad.pts").expect(3).stderr);
    let missing = with_picture("pins.txt", "missing.pts").expect(3);
    assert!(missing.stderr.contains("missing.pts"), "{}", missing.stderr);
    let over = [&ARGUMENTS[..], &["--picture", "picture.png", "-o", "face.pts"]].concat();
    program.run(&over).expect(2);
    let alone = program.run(&["flatten", "sheet.obj", "--landmarks", "face.pts", "--picture", "picture.png"]);
    alone.expect(2);
}
