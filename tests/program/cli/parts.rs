//! `freebound flatten --parts`: flattens some parts of a mesh and keeps the others unchanged.

use std::fmt::Write as _;

use freebound_io::read_mesh;
use serde_json::json;

use super::program::{Program, obj_text};
use freebound_testkit::{assert_message, tetrahedron};

/// A tetrahedron, two sheets of two triangles each, and a larger one of four. The first sheet has texture
/// coordinates.
fn text() -> String {
    let mut text = obj_text(&(&tetrahedron()).into());
    let mut count = 4;
    for (sheet, columns) in [1, 1, 2].into_iter().enumerate() {
        for x in 0..=columns {
            writeln!(text, "v {x} 0 {}\nv {x} 1 {}", 3 * sheet + 3, 3 * sheet + 3).expect("memory");
        }
        if sheet == 0 {
            text += "vt 0.5 0.5\nvt .75 .5\nvt .5 .75\nvt 0.75 0.75\n";
        }
        for x in 0..columns {
            let [a, b, c, d] = [1, 2, 3, 4].map(|k| count + 2 * x + k);
            if sheet == 0 {
                writeln!(text, "f {a}/1 {c}/2 {b}/3\nf {b}/3 {c}/2 {d}/4").expect("memory");
            } else {
                writeln!(text, "f {a} {c} {b}\nf {b} {c} {d}").expect("memory");
            }
        }
        count += 2 * columns + 2;
    }
    text
}

fn faces(text: &str) -> Vec<&str> {
    text.lines().filter(|line| line.starts_with("f ")).collect()
}

#[test]
fn parts_that_are_left_out_stay_in_the_file_byte_for_byte_with_their_coordinates() {
    let program = Program::new();
    program.write("in.obj", &text());
    let arguments = ["flatten", "in.obj", "--parts", "2,3", "-o", "out.obj", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "leave-out-parts", "count": 2}]));
    assert_eq!(report["charts"].as_array().map(Vec::len), Some(2));
    assert_eq!(report["atlas"]["planar"], json!(true));
    let written = std::fs::read_to_string(program.path("out.obj")).expect("written");
    let before = text();
    let (before, after) = (faces(&before), faces(&written));
    assert_eq!(before[..6], after[..6], "the tetrahedron and the first sheet");
    assert!(after[6..].iter().all(|face| face.split(' ').skip(1).all(|corner| corner.contains('/'))), "{after:?}");
    let texture = read_mesh(&program.path("out.obj")).expect("a mesh").texture.expect("coordinates");
    assert_eq!(texture.coordinates[..2], [glam::DVec2::new(0.5, 0.5), glam::DVec2::new(0.75, 0.5)]);
}

#[test]
fn the_largest_part_is_flattened_alone_whatever_the_others_are() {
    let program = Program::new();
    program.write("in.obj", &text());
    program.run(&["flatten", "in.obj"]).expect(3);
    for parts in ["largest", "0"] {
        let refused = program.run(&["flatten", "in.obj", "--parts", parts]);
        // Among the parts with four faces the first is the tetrahedron, which is closed.
        refused.expect(3);
    }
    let run = program
        .run(&["flatten", "in.obj", "--parts", "largest", "--cut", "shortest", "--report", "-"])
        .expect(0)
        .json();
    assert_eq!(
        run["mesh"]["repairs"],
        json!([{"repair": "leave-out-parts", "count": 3}, {"repair": "cut", "count": 3}])
    );
    let one = program.run(&["flatten", "in.obj", "--parts", "3", "--report", "-", "-o", "one.glb"]).expect(0).json();
    assert_eq!(one["verdict"]["planar"], json!(true));
    assert_eq!(one["mesh"]["faces"], json!(4));
    program.run(&["flatten", "in.obj", "--parts", "1", "-o", "one.ply"]).expect(0);
}

#[test]
fn parts_that_there_are_not_are_refused_with_how_many_there_are() {
    let program = Program::new();
    program.write("in.obj", &text());
    let refused = program.run(&["flatten", "in.obj", "--parts", "1,4"]).expect(2);
    assert_message("parts-no-such-part", &refused.stderr);
    for odd in ["", "one", "1;2", "-1"] {
        program.run(&["flatten", "in.obj", &format!("--parts={odd}")]).expect(2);
    }
}
