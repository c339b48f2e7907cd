//! `freebound flatten` on meshes of several charts: packing into a picture.

use std::fs;

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_io::{MeshFile, read_mesh};
use glam::DVec2;
use serde_json::{Value, json};

use super::charts::triangles;
use super::program::{Program, obj_text};
use freebound_testkit::many_parts::interleaved;
use freebound_testkit::{Random, assert_message, grid};

#[test]
fn charts_are_packed_into_the_picture_with_their_gap_at_one_density() {
    let program = Program::new();
    let parts = [grid(4, 4), grid(2, 6), grid(1, 1)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(3))));
    let arguments = ["flatten", "in.obj", "-o", "out.obj", "--report", "-", "--pack", "600x300", "--gap", "10"];
    program.run(&arguments[..4]).expect(0);
    let without = fs::read(program.path("out.obj")).expect("written");
    let run = program.command(&arguments).output().expect("it runs");
    let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_ne!(fs::read(program.path("out.obj")).expect("written"), without);
    assert_eq!(report["packing"]["picture"], json!([600, 300]));
    assert_eq!(report["packing"]["gap"], json!(10));
    let density = report["packing"]["density"].as_f64().expect("a number");
    let file = read_mesh(&program.path("out.obj")).expect("written");
    let pixels: Vec<[DVec2; 3]> =
        triangles(&file).into_iter().map(|corners| corners.map(|uv| uv * DVec2::new(600.0, 300.0))).collect();
    // Each part is flat: every triangle is half of a square of the surface.
    for [a, b, c] in &pixels {
        let area = (*b - *a).perp_dot(*c - *a) / 2.0;
        assert!((area / (0.5 * density * density) - 1.0).abs() < 1e-9, "{area} {density}");
        for z in [a, b, c] {
            assert!(z.cmpge(DVec2::splat(5.0 - 1e-6)).all() && z.cmple(DVec2::new(595.0, 295.0) + 1e-6).all(), "{z}");
        }
    }
    for chart in report["charts"].as_array().expect("charts") {
        let energy = chart["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("a number");
        assert!((energy - 4.0).abs() < 1e-9, "flat as it came: {energy}");
    }
    let covered = 29.0 * density * density / (600.0 * 300.0);
    assert!((report["packing"]["covered"].as_f64().expect("a number") - covered).abs() < 1e-9);
    assert_apart(&file, &pixels, 10.0);
}

#[test]
fn a_chart_is_packed_as_many_times_as_large_as_is_asked_for() {
    let program = Program::new();
    let parts = [grid(4, 4), grid(2, 6), grid(1, 1)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(3))));
    let arguments = ["flatten", "in.obj", "-o", "out.obj", "--report", "-", "--pack", "600x300"];
    let run = program.run(&[&arguments[..], &["--chart-size", "0=0.5,2=3"]].concat()).expect(0);
    let report = run.json();
    let density = report["packing"]["density"].as_f64().expect("a number");
    let file = read_mesh(&program.path("out.obj")).expect("written");
    // Each part occupies a different hundred along x.
    let part_of = |vertex: VertexId| {
        let aside = file.polygons.positions[vertex.index()].x;
        [0.0, 100.0, 200.0].iter().rposition(|&begin| aside >= begin).expect("one of three")
    };
    let first_vertex = |chart: &Value| {
        let face = chart["first_face"].as_u64().and_then(|face| usize::try_from(face).ok()).expect("a face");
        file.polygons.face(face)[0]
    };
    let mut sizes = [1.0; 3];
    for (triangle, corners) in triangles(&file).into_iter().enumerate() {
        let [a, b, c] = corners.map(|uv| uv * DVec2::new(600.0, 300.0));
        sizes[part_of(file.polygons.corners[3 * triangle])] = (b - a).perp_dot(c - a).sqrt() / density;
    }
    let given = report["charts"]
        .as_array()
        .expect("charts")
        .iter()
        .map(|chart| (part_of(first_vertex(chart)), chart["density"].as_f64().expect("a number") / density));
    for ((part, reported), asked) in given.zip([0.5, 1.0, 3.0]) {
        assert!((sizes[part] / asked - 1.0).abs() < 1e-9, "chart with {} is {} as large", asked, sizes[part]);
        assert!((reported / asked - 1.0).abs() < 1e-9, "{reported} {asked}");
    }
    let other = program.run(&[&arguments[..], &["--chart-size", "3=2"]].concat()).expect(2);
    assert_message("charts-packed-size-of-no-chart", &other.stderr);
    let twice = program.run(&[&arguments[..], &["--chart-size", "0=2,0=3"]].concat()).expect(2);
    assert_message("charts-packed-two-sizes", &twice.stderr);
    let pin = format!("{}:2,2", first_vertex(&report["charts"][1]).number());
    let held = program.run(&[&arguments[..], &["--pin", &pin, "--chart-size", "0=2,1=3"]].concat()).expect(2);
    assert_message("charts-packed-size-of-a-pinned-chart", &held.stderr);
    for wrong in ["0", "0=0", "0=-1", "0=nan", "x=1", "0=1000"] {
        program.run(&[&arguments[..], &["--chart-size", wrong]].concat()).expect(2);
    }
}

/// Asserts the least distance between corners of different charts. Corners suffice since the charts are squares.
fn assert_apart(file: &MeshFile, pixels: &[[DVec2; 3]], gap: f64) {
    let part =
        |triangle: usize| (file.polygons.positions[file.polygons.corners[3 * triangle].index()].x / 100.0).floor();
    for (a, b) in (0..pixels.len()).flat_map(|a| (0..a).map(move |b| (a, b))).filter(|&(a, b)| part(a) != part(b)) {
        for (p, q) in pixels[a].iter().flat_map(|p| pixels[b].iter().map(move |q| (p, q))) {
            assert!((*p - *q).abs().max_element() >= gap - 1e-6, "{p} {q}");
        }
    }
}

#[test]
fn free_rotations_leave_no_less_room_than_quarter_turns_and_none_keeps_every_chart_upright() {
    let program = Program::new();
    let parts = [grid(9, 1), grid(7, 2), grid(5, 3), grid(1, 8)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(5))));
    let density = |rotations: &str| {
        let arguments = ["flatten", "in.obj", "-o", "out.obj", "--report", "-", "--rotations", rotations];
        let run = program.command(&arguments).output().expect("it runs");
        let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
        assert_eq!(report["atlas"]["planar"], json!(true));
        report["packing"]["density"].as_f64().expect("a number")
    };
    let [free, quarter, none] = ["free", "quarter", "none"].map(density);
    assert!(free >= 0.98 * quarter && quarter >= none, "{free} {quarter} {none}");
    program.run(&["flatten", "in.obj", "--rotations", "some"]).expect(2);
}
