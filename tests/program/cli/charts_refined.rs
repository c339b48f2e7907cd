//! Charts with new vertices: everything else in the file is preserved.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

use freebound_io::read_mesh;
use serde_json::{Value, json};

use super::charts::charts_proved;
use super::program::Program;

/// Two sheets of quads and a ring of quads, with normals, colours, comments and names; faces of the sheets
/// alternate.
fn text() -> String {
    let mut text = String::from("# made by hand\r\nmtllib some.mtl\r\n");
    for (x, y) in (0..32).map(|v| (v % 4, v / 4)) {
        let (sheet, y) = (y / 4, y % 4);
        writeln!(text, "v {}.50 {y}.0 {}e-1 0.{x} 0.{y} 1\r", x + 10 * sheet, x * y).expect("memory");
        writeln!(text, "vn 0.0 0.{x}0 1\r").expect("memory");
    }
    for k in 0..8 {
        let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
        for z in 0..2 {
            writeln!(text, "v {} {} {z} 0 0 0\r", 30.0 + turn.cos(), turn.sin()).expect("memory");
        }
    }
    text += "o sheets\r\n";
    for (x, y) in (0..9).map(|face| (face % 3, face / 3)) {
        for sheet in 0..2 {
            let [a, b, c, d] = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| 16 * sheet + 4 * (y + j) + x + i + 1);
            writeln!(text, "f {a}//{a} {b}//{b}  {c}//{c} {d}//{d} # of sheet {sheet}\r").expect("memory");
        }
        writeln!(text, "s {x}\r").expect("memory");
    }
    text += "g ring\r\nusemtl ring\r\n";
    for k in 0..8 {
        let [a, b, c, d] = [2 * k, 2 * ((k + 1) % 8), 2 * ((k + 1) % 8) + 1, 2 * k + 1].map(|v| v + 33);
        writeln!(text, "f {a} {b} {c} {d}\r").expect("memory");
    }
    text + "l 1 2 3\r\nunknown line\r\n"
}

/// Pins of the first sheet: its corners, and those of its middle quad with two opposite ones swapped. Every
/// triangulation of the quad has a flipped face with three pinned corners, so new vertices are needed.
const PINS: [&str; 16] = [
    "--pin",
    "0:0,0",
    "--pin",
    "3:1,0",
    "--pin",
    "15:1,1",
    "--pin",
    "12:0,1",
    "--pin",
    "5:0.7,0.7",
    "--pin",
    "6:0.7,0.3",
    "--pin",
    "9:0.3,0.7",
    "--pin",
    "10:0.3,0.3",
];

fn run(program: &Program, output: &str) -> Value {
    let arguments = ["flatten", "in.obj", "--holes", "cut", "--cut", "shortest", "-o", output, "--report", "-"];
    program.run(&[&arguments[..], &PINS].concat()).expect(0).json()
}

/// True if a line defines geometry (`v`, `vn`, `vt` or `f`), which may be changed or new.
fn is_new(line: &str) -> bool {
    ["v ", "vn ", "vt ", "f "].iter().any(|word| line.starts_with(word))
}

#[test]
fn lines_that_do_not_change_come_back_byte_for_byte_in_their_order() {
    let program = Program::new();
    program.write("in.obj", &text());
    let report = run(&program, "out.obj");
    assert!(report["new_vertices"].as_u64().is_some_and(|count| count > 0), "{}", report["new_vertices"]);
    assert_eq!(report["mesh"]["repairs"], json!([{"repair": "cut", "count": 1}]));
    assert_eq!(charts_proved(&program, "out.obj"), 3);
    let (before, after) = (text(), fs::read_to_string(program.path("out.obj")).expect("written"));
    let mut rest = after.split_inclusive('\n').peekable();
    for line in before.split_inclusive('\n').filter(|line| !line.starts_with("f ")) {
        while rest.next_if(|next| *next != line && is_new(next)).is_some() {}
        assert_eq!(rest.next(), Some(line), "{after}");
    }
    // Faces of the second sheet are whole: they are unchanged except for texture coordinates.
    let bare = |line: &str| {
        let corner = |word: &str| match word.split('/').collect::<Vec<_>>()[..] {
            [v, _, n] => format!("{v}//{n}"),
            [v, _] => v.to_owned(),
            _ => word.to_owned(),
        };
        line.trim_end().split(' ').map(corner).collect::<Vec<_>>().join(" ")
    };
    let written: Vec<String> = after.split_inclusive('\n').filter(|line| line.starts_with("f ")).map(bare).collect();
    for line in before.split_inclusive('\n').filter(|line| line.starts_with("f ")) {
        let is_of_first = line.contains("# of sheet 0");
        assert!(is_of_first || written.iter().any(|face| face == line.trim_end()), "{line} in {written:?}");
    }
    // New vertices have a colour, and a normal at faces with normals.
    let new = after.lines().filter(|line| line.starts_with("v ")).skip(48);
    assert!(new.clone().count() > 0 && new.clone().all(|line| line.split(' ').count() == 7), "{after}");
    assert!(after.lines().filter(|line| line.contains("# of sheet 0")).all(|line| line.matches("//").count() == 0));
}

#[test]
fn new_vertices_lie_on_the_edges_that_the_report_names() {
    let program = Program::new();
    program.write("in.obj", &text());
    let report = run(&program, "out.obj");
    let [before, after] = ["in.obj", "out.obj"].map(|name| read_mesh(&program.path(name)).expect("a mesh").polygons);
    let old = before.positions.len();
    assert_eq!(after.positions[..old], before.positions);
    assert_eq!(json!(after.positions.len() - old), report["new_vertices"]);
    let pairs: Vec<[usize; 2]> = serde_json::from_value(report["split_edges"].clone()).expect("pairs");
    assert!(pairs.is_sorted() && pairs.iter().flatten().all(|&vertex| vertex < 16), "of the first sheet: {pairs:?}");
    for new in &after.positions[old..] {
        let is_between = |&[a, b]: &[usize; 2]| {
            let [a, b] = [a, b].map(|end| before.positions[end]);
            (a.distance(*new) + new.distance(b) - a.distance(b)).abs() < 1e-9
        };
        assert!(pairs.iter().any(is_between), "{new} is on none of {pairs:?}");
    }
    let used: BTreeSet<usize> = after.corners.iter().map(|vertex| vertex.index()).collect();
    assert_eq!(used.len(), after.positions.len(), "every new vertex is a corner");
}

#[test]
fn ply_and_glb_files_hold_the_same_charts() {
    let program = Program::new();
    program.write("in.obj", &text());
    for name in ["out.ply", "out.glb"] {
        run(&program, name);
        assert_eq!(charts_proved(&program, name), 3, "{name}");
    }
}
