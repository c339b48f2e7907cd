//! `--stack`: charts with congruent surfaces in one place, and `check --stacked`.

use freebound_core::mesh::PolygonMesh;
use freebound_io::read_mesh;
use freebound_testkit::{assert_message, grid, shaped};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::charts::triangles;
use super::program::{Program, obj_text};
use freebound_testkit::many_parts::interleaved;
use freebound_testkit::{Random, table};

/// A bent sheet that is not congruent to its mirror image.
fn chiral_sheet() -> PolygonMesh {
    (&shaped(4, 3, |x, y| DVec3::new(x + 0.1 * y * y, y, 0.05 * x * x * y))).into()
}

/// Three copies of a sheet, a mirror image of it, and another sheet, with faces and vertices in random order.
fn sheets() -> PolygonMesh {
    let mut mirrored = chiral_sheet().turned();
    mirrored.positions.iter_mut().for_each(|position| position.x = -position.x);
    let parts = [chiral_sheet(), mirrored, chiral_sheet(), PolygonMesh::from(&grid(6, 1)), chiral_sheet()];
    interleaved(&parts, &mut Random(5))
}

/// Area in the plane of all triangles, those that are turned over counted negative.
fn signed_areas(program: &Program, name: &str) -> Vec<f64> {
    let file = read_mesh(&program.path(name)).expect("written");
    let area = |[a, b, c]: [DVec2; 3]| (b - a).perp_dot(c - a) / 2.0;
    triangles(&file).into_iter().map(area).collect()
}

#[test]
fn copies_of_a_chart_share_a_place_and_are_reported() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&sheets()));
    let arguments = ["flatten", "in.obj", "-o", "out.obj", "--report", "-"];
    let report = |more: &[&str]| program.run(&[&arguments[..], more].concat()).expect(0).json();
    let apart = report(&[]);
    assert!(apart["atlas"].get("stacks").is_none());
    let stacked = report(&["--stack"]);
    assert_eq!(stacked["atlas"]["stacks"], json!(1));
    let count = |report: &Value, field: &str| {
        let charts = report["charts"].as_array().expect("charts");
        charts.iter().filter(|chart| chart.get(field).is_some_and(|value| *value != json!(false))).count()
    };
    assert_eq!([count(&stacked, "stacked_on"), count(&stacked, "mirrored")], [2, 0]);
    assert!(signed_areas(&program, "out.obj").iter().all(|&area| area > 0.0));
    let mirrored = report(&["--stack", "mirrored", "--precision", "f32"]);
    assert_eq!(count(&mirrored, "stacked_on"), 3);
    // The first of the four in the file decides which ones are mirrored.
    let images = count(&mirrored, "mirrored");
    assert!(images == 1 || images == 3, "{images}");
    assert_eq!(mirrored["atlas"]["planar"], json!(true));
    let turned = signed_areas(&program, "out.obj").iter().filter(|&&area| area < 0.0).count();
    assert_eq!(turned, 24 * images);
    let density = |report: &Value| report["packing"]["density"].as_f64().expect("a number");
    assert!(density(&mirrored) >= density(&stacked) && density(&stacked) > 1.1 * density(&apart));
    let covered = |report: &Value| report["packing"]["covered"].as_f64().expect("a number");
    assert!(covered(&mirrored) < 1.0 && covered(&mirrored) > 0.3);
}

#[test]
fn check_accepts_stacks_if_it_is_told_of_them() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&sheets()));
    for precision in ["f32", "f64"] {
        let arguments = ["flatten", "in.obj", "-o", "out.obj", "--stack", "mirrored", "--precision", precision];
        program.run(&arguments).expect(0);
        let refused = program.run(&["check", "out.obj"]).expect(4);
        assert!(refused.stdout.contains("error stacked"), "{}", refused.stdout);
        let accepted = program.run(&["check", "out.obj", "--stacked", "--report", "-"]).expect(0).json();
        assert_eq!(accepted["atlas"]["stacks"], json!(1));
        let verdicts = accepted["atlas"]["charts"].as_array().expect("charts");
        assert_eq!(verdicts.iter().filter(|chart| chart.get("stacked_on").is_some()).count(), 3);
    }
    // A chart that only overlaps another is no stack.
    program.write(
        "shifted.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0 0\nvt 1 0\nvt 0 0.9999999\n\
         f 1/1 2/2 3/3\nf 4/4 5/5 6/6\n",
    );
    assert_message("stacks-check-shifted", &program.run(&["check", "shifted.obj", "--stacked"]).expect(4).stdout);
}

#[test]
fn stacks_survive_all_file_formats_and_a_layout_to_start_from() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&table()));
    for name in ["out.obj", "out.ply", "out.glb"] {
        let arguments = ["unwrap", "in.obj", "-o", name, "--stack", "mirrored", "--report", "-"];
        assert_eq!(program.run(&arguments).expect(0).json()["atlas"]["stacks"], json!(1));
        program.run(&["check", name, "--stacked"]).expect(0);
    }
    let arguments = ["flatten", "out.obj", "--charts", "uv", "--start", "uv", "-o", "again.obj"];
    program.run(&arguments).expect(0);
    program.run(&["check", "again.obj"]).expect(0);
    program.run(&[&arguments[..], &["--stack"]].concat()).expect(0);
    program.run(&["check", "again.obj", "--stacked"]).expect(0);
    program.run(&["flatten", "in.obj", "--stack", "some"]).expect(2);
}
