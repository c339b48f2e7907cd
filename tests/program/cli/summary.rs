//! Messages of `freebound flatten` on a planar map with large distortion.

use freebound_core::mesh::{TriMesh, VertexId};
use glam::DVec3;

use super::program::{Program, obj_text};
use freebound_testkit::{sheet, tower};

const CONVEX: [&str; 8] = ["flatten", "in.obj", "-o", "out.obj", "--method", "convex", "--family", "uniform"];

/// Program with two sheets side by side in its file; the faces of the first come first.
fn with_both(first: &TriMesh, second: &TriMesh) -> Program {
    let offset = u32::try_from(first.positions.len()).expect("a small mesh");
    let moved = second.positions.iter().map(|p| *p + 2.0 * DVec3::X);
    let positions = first.positions.iter().copied().chain(moved).collect();
    let of_second = second.triangles.iter().map(|t| t.map(|v| v.number() + offset));
    let triangles: Vec<[u32; 3]> = first.triangles.iter().map(|t| t.map(VertexId::number)).chain(of_second).collect();
    let program = Program::new();
    program.write("in.obj", &obj_text(&(&TriMesh::new(positions, &triangles)).into()));
    program
}

/// Line on differing areas, if there is one.
fn areas(program: &Program, further: &[&str]) -> Option<String> {
    let run = program.run(&[&CONVEX[..], further].concat()).expect(0);
    run.stdout.lines().find(|line| line.starts_with("areas of ")).map(str::to_owned)
}

#[test]
fn areas_that_differ_badly_are_told_with_what_can_be_done() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&(&tower()).into()));
    let line = areas(&program, &["--relax", "0"]).expect("a line on areas");
    assert!(line.contains("areas of mesh and map differ by "), "{line}");
}

#[test]
fn of_several_charts_the_one_is_named_whose_areas_differ_most() {
    let flat = sheet(8, 0.0);
    for (first, second, face) in [(&tower(), &flat, 0), (&flat, &tower(), flat.triangles.len())] {
        let line = areas(&with_both(first, second), &["--relax", "0", "--cut", "auto"]).expect("a line on areas");
        assert!(line.contains(&format!("mesh and map in the chart of face {face} differ by ")), "{line}");
    }
    assert_eq!(areas(&with_both(&flat, &flat), &["--cut", "auto"]), None, "nothing is distorted");
}
