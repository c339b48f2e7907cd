//! What `freebound flatten` says of a map that is planar, but serves badly.

use std::fmt::Write as _;

use crate::program::Program;

/// Vertices along a side of a sheet.
const SIDE: usize = 9;

/// Sheets with a thin tower on each, which no map without cuts lays flat without shrinking it.
fn towers(count: usize) -> String {
    let mut text = String::new();
    for sheet in 0..count {
        for vertex in 0..SIDE * SIDE {
            let (x, y) = (vertex % SIDE, vertex / SIDE);
            let height = if (3..=5).contains(&x) && (3..=5).contains(&y) { 2000 } else { 0 };
            writeln!(text, "v {} {y} {height}", x + 20 * sheet).expect("memory");
        }
        for (x, y) in (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| (x, y))) {
            let a = sheet * SIDE * SIDE + y * SIDE + x + 1;
            let [b, c, d] = [a + 1, a + SIDE, a + SIDE + 1];
            writeln!(text, "f {a} {b} {d}\nf {a} {d} {c}").expect("memory");
        }
    }
    text
}

const CONVEX: [&str; 8] = ["flatten", "towers.obj", "-o", "out.obj", "--method", "convex", "--family", "uniform"];

/// The line on areas that differ, if there is one.
fn areas(program: &Program, further: &[&str]) -> Option<String> {
    let run = program.run(&[&CONVEX[..], further].concat()).expect(0);
    run.stdout.lines().find(|line| line.starts_with("areas differ")).map(str::to_owned)
}

#[test]
fn areas_that_differ_badly_are_told_with_what_can_be_done() {
    let program = Program::new();
    program.write("towers.obj", &towers(1));
    let line = areas(&program, &["--relax", "0"]).expect("a line on areas");
    assert!(line.contains(" : 1 between mesh and map: --relax 20"), "{line}");
}

#[test]
fn of_several_charts_the_one_is_named_whose_areas_differ_most() {
    let program = Program::new();
    // The second sheet is no tower, and its chart is that of face 128.
    let second = towers(1).lines().count();
    let flat = towers(2).lines().enumerate().fold(String::new(), |mut text, (number, line)| {
        let line = if number >= second { line.replace(" 2000", " 0") } else { line.to_owned() };
        writeln!(text, "{line}").expect("memory");
        text
    });
    program.write("towers.obj", &flat);
    let line = areas(&program, &["--relax", "0", "--cut", "auto"]).expect("a line on areas");
    assert!(line.contains("in the chart of face 0: --relax 20"), "{line}");
    program.write("towers.obj", &flat.replace(" 2000", " 0"));
    assert_eq!(areas(&program, &["--cut", "auto"]), None, "nothing is distorted");
}
