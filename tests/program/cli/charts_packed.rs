//! `freebound flatten` on meshes of several charts: packing into a picture.

use std::fmt::Write as _;
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

#[test]
fn files_of_one_density_have_equal_pixels_per_unit_and_pictures_large_enough() {
    let program = Program::new();
    let parts = [grid(4, 4), grid(2, 6), grid(1, 1)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("several.obj", &obj_text(&interleaved(&parts, &mut Random(3))));
    program.write("one.obj", &obj_text(&parts[0]));
    let pictures = ["several.obj", "one.obj"].map(|mesh| {
        let arguments = ["flatten", mesh, "-o", "out.obj", "--report", "-", "--pack", "64x32", "--density", "11.5"];
        let report = program.run(&arguments).expect(0).json();
        assert_eq!(report["packing"]["density"], json!(11.5));
        assert_eq!(report["atlas"]["planar"], json!(true));
        let picture = DVec2::new(64.0, 32.0) * report["packing"]["picture"][0].as_f64().expect("a number") / 64.0;
        for [a, b, c] in triangles(&read_mesh(&program.path("out.obj")).expect("written")) {
            let area = ((b - a) * picture).perp_dot((c - a) * picture) / 2.0;
            assert!((area / (0.5 * 11.5 * 11.5) - 1.0).abs() < 1e-9, "half of a square of the surface: {area}");
        }
        picture.x
    });
    assert_eq!(pictures, [128.0, 128.0]);
    let beyond = program.run(&["flatten", "one.obj", "--density", "1e9", "--report", "-"]).expect(4).json();
    assert_eq!(beyond["packing"]["wanted_density"], json!(1e9));
    assert!(beyond["packing"]["density"].as_f64().is_some_and(|density| density < 1e5), "{beyond:#}");
    for wrong in ["0", "-3", "nan", "inf", "x"] {
        program.run(&["flatten", "one.obj", "--density", wrong]).expect(2);
    }
    let steps = program.run(&["flatten", "one.obj", "--density", "5", "--steps", "here"]).expect(2);
    assert_message("charts-packed-steps-at-a-density", &steps.stderr);
}

/// Tile of each chart of a report, in order.
fn tiles(report: &Value) -> Vec<u64> {
    report["charts"].as_array().expect("charts").iter().map(|chart| chart["tile"].as_u64().expect("a tile")).collect()
}

/// Three parts of one mesh: a square with a material of its own, and two strips that share one.
fn parts_with_materials(program: &Program) {
    let parts = [grid(4, 4), grid(2, 6), grid(1, 1)].map(|mesh| PolygonMesh::from(&mesh));
    let mut text = String::new();
    let mut first = 1;
    for (part, material) in parts.iter().zip(["wood", "iron", "wood"]) {
        for position in &part.positions {
            writeln!(text, "v {} {} {}", position.x + 100.0 * f64::from(first), position.y, position.z).expect("text");
        }
        writeln!(text, "usemtl {material}").expect("text");
        for face in 0..part.face_count() {
            let corners: Vec<String> =
                part.face(face).iter().map(|vertex| (vertex.number() + first).to_string()).collect();
            writeln!(text, "f {}", corners.join(" ")).expect("text");
        }
        first += u32::try_from(part.positions.len()).expect("few vertices");
    }
    program.write("in.obj", &text);
}

#[test]
fn charts_lie_in_tiles_of_one_density() {
    let program = Program::new();
    parts_with_materials(&program);
    let arguments = ["flatten", "in.obj", "-o", "out.obj", "--report", "-", "--pack", "64x64"];
    let report_with = |more: &[&str]| program.run(&[&arguments[..], more].concat()).expect(0).json();
    let density = |report: &Value| report["packing"]["density"].as_f64().expect("a number");
    let [one, three] = [report_with(&[]), report_with(&["--tiles", "3"])];
    assert_eq!((&one["packing"]["tiles"], tiles(&one)), (&json!(1), vec![1001; 3]));
    assert_eq!(three["atlas"]["planar"], json!(true));
    assert!(density(&three) > density(&one) && three["packing"]["tiles"].as_u64() > Some(1), "{three:#}");
    let materials = report_with(&["--tiles", "materials"]);
    assert_eq!((&materials["packing"]["tiles"], tiles(&materials)), (&json!(2), vec![1001, 1002, 1001]));
    let widths: Vec<f64> = read_mesh(&program.path("out.obj"))
        .map_or(Vec::new(), |file| triangles(&file).into_iter().flatten().map(|uv| uv.x).collect());
    assert!(widths.iter().all(|u| (0.0..2.0).contains(u)) && widths.iter().any(|&u| u > 1.0), "{widths:?}");
    let dense = report_with(&["--tiles", "9", "--density", "15"]);
    assert_eq!((&dense["packing"]["density"], &dense["packing"]["picture"]), (&json!(15.0), &json!([128, 128])));
    for wrong in ["0", "1001", "x", "-1"] {
        program.run(&["flatten", "in.obj", "--tiles", wrong]).expect(2);
    }
    let groups = program.run(&["flatten", "in.obj", "--tiles", "groups"]).expect(2);
    assert_message("charts-packed-tiles-without-groups", &groups.stderr);
}

#[test]
fn locked_charts_stay_and_the_others_are_packed_around_them() {
    let program = Program::new();
    let parts = [grid(4, 4), grid(2, 6), grid(1, 1)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(3))));
    program.run(&["flatten", "in.obj", "-o", "flat.obj", "--pack", "128x128"]).expect(0);
    let is_of_strip =
        |vertex: VertexId, file: &MeshFile| (100.0..200.0).contains(&file.polygons.positions[vertex.index()].x);
    let part_of = |file: &MeshFile, triangle: usize| is_of_strip(file.polygons.corners[3 * triangle], file);
    let before = read_mesh(&program.path("flat.obj")).expect("written");
    let report = |more: &[&str]| {
        let arguments = ["flatten", "flat.obj", "--start", "uv", "--charts", "uv", "-o", "out.obj", "--report", "-"];
        program.run(&[&arguments[..], &["--pack", "128x128", "--gap", "9"], more].concat())
    };
    let all = report(&[]).expect(0).json();
    let first_face_is_of_strip = |chart: &Value| {
        let face = chart["first_face"].as_u64().and_then(|face| usize::try_from(face).ok()).expect("a face");
        is_of_strip(before.polygons.face(face)[0], &before)
    };
    let charts = all["charts"].as_array().expect("charts");
    let strip = charts.iter().position(first_face_is_of_strip).expect("the strip is a chart").to_string();
    for more in [&[][..], &["--density", "5"], &["--density", "60"], &["--tiles", "2"]] {
        let locked = report(&[&["--lock", &strip], more].concat()).expect(0).json();
        assert_eq!(locked["atlas"]["planar"], json!(true));
        let placements: Vec<&Value> =
            locked["charts"].as_array().expect("charts").iter().map(|chart| &chart["placement"]).collect();
        assert_eq!(placements.iter().filter(|placement| **placement == "locked").count(), 1);
        assert_eq!(placements.iter().filter(|placement| **placement == "packed").count(), 2);
        let after = read_mesh(&program.path("out.obj")).expect("written");
        let side = locked["packing"]["picture"][0].as_f64().expect("a number");
        let (old, new) = (triangles(&before), triangles(&after));
        assert!((0..old.len()).filter(|&triangle| part_of(&before, triangle)).all(|k| old[k] == new[k]), "it stays");
        let pixels: Vec<[DVec2; 3]> = new.into_iter().map(|corners| corners.map(|uv| uv * side)).collect();
        for (a, b) in (0..pixels.len()).flat_map(|a| (0..pixels.len()).map(move |b| (a, b))) {
            if part_of(&after, a) && !part_of(&after, b) {
                let pairs = pixels[a].iter().flat_map(|p| pixels[b].iter().map(move |q| p.distance(*q)));
                assert!(pairs.fold(f64::INFINITY, f64::min) >= 9.0 - 1e-6, "{more:?}");
            }
        }
    }
    let other = report(&["--lock", "3"]).expect(2);
    assert_message("charts-packed-lock-of-no-chart", &other.stderr);
    let sized = report(&["--lock", "0", "--chart-size", "0=2"]).expect(2);
    assert_message("charts-packed-size-of-a-locked-chart", &sized.stderr);
    program.run(&["flatten", "in.obj", "--lock", "0"]).expect(2);
}

#[test]
fn charts_around_a_locked_one_get_its_density_and_no_more() {
    let program = Program::new();
    let parts = [grid(6, 6), grid(2, 3), grid(2, 2)].map(|mesh| PolygonMesh::from(&mesh));
    program.write("in.obj", &obj_text(&interleaved(&parts, &mut Random(5))));
    let first = program.run(&["flatten", "in.obj", "--report", "-"]).expect(0).json();
    let faces = |report: &Value| {
        let charts = report["charts"].as_array().expect("charts").clone();
        charts.iter().map(|chart| chart["faces"].as_u64().expect("a number")).collect::<Vec<_>>()
    };
    let large = faces(&first).iter().position(|&count| count == 72).expect("the large chart").to_string();
    program.run(&["flatten", "in.obj", "-o", "flat.obj", "--chart-size", &format!("{large}=0.3")]).expect(0);
    let start = ["flatten", "flat.obj", "--start", "uv", "--charts", "uv", "--pack", "1024x1024", "--report", "-"];
    let locked = program.run(&[&start[..], &["--lock", &large]].concat()).expect(0).json();
    assert_eq!(faces(&first), faces(&locked));
    let densities: Vec<f64> = locked["charts"]
        .as_array()
        .expect("charts")
        .iter()
        .map(|chart| chart["density"].as_f64().expect("a number"))
        .collect();
    assert_eq!(locked["packing"]["picture"], json!([1024, 1024]));
    for density in &densities {
        assert!((density / densities[0] - 1.0).abs() < 0.01, "{densities:?}");
    }
}
