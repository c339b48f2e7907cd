//! `--start uv`: `freebound flatten` starts from the texture coordinates of the file.

use std::fs;

use freebound_core::mesh::{PolygonMesh, TriMesh, VertexId};
use freebound_io::{MeshFile, read_mesh};
use glam::{DVec2, DVec3};
use serde_json::json;

use super::charts::charts_proved;
use super::charts_uv::{grouped, write};
use super::program::{Program, coordinates_by_vertex, textured_text};
use freebound_testkit::many_parts::torus;
use freebound_testkit::surfaces::bump;
use freebound_testkit::{assert_message, grid};

/// View of the bumpy sheet from above, sheared.
fn layout_of(mesh: &TriMesh) -> Vec<DVec2> {
    mesh.positions.iter().map(|p| DVec2::new(0.1 * p.x + 0.05 * p.y, 0.03 * p.y)).collect()
}

/// Bumpy sheet with a planar layout; `pulled` moves one vertex over its neighbours.
fn sheet(pulled: f64) -> String {
    let mesh = bump(6);
    let mut layout = layout_of(&mesh);
    layout[24].x += pulled;
    let polygons = PolygonMesh::from(&mesh);
    textured_text(&polygons, &layout, |face, k| [polygons.face(face)[k].index(); 2])
}

#[test]
fn a_layout_that_is_planar_comes_back_to_the_last_bit() {
    let program = Program::new();
    program.write("in.obj", &sheet(0.0));
    program.run(&["flatten", "in.obj", "--start", "uv", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let report = fs::read_to_string(program.path("out.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!((&report["verdict"]["planar"], &report["placement"]), (&json!(true), &json!("file")));
    assert_eq!(report["steps"].as_array().map(Vec::len), Some(1));
    assert_eq!((&report["steps"][0]["stage"], &report["steps"][0]["planar"]), (&json!("given"), &json!(true)));
    assert_eq!(coordinates(&program, "out.obj"), coordinates(&program, "in.obj"));
}

fn coordinates(program: &Program, name: &str) -> Vec<DVec2> {
    coordinates_by_vertex(&read_mesh(&program.path(name)).expect("written")).to_vec()
}

/// Texture coordinates, one per corner.
fn at_corners(program: &Program, name: &str) -> Vec<DVec2> {
    let MeshFile { texture, .. } = read_mesh(&program.path(name)).expect("written");
    let texture = texture.expect("coordinates");
    texture.corners.iter().map(|&corner| texture.coordinates[corner as usize]).collect()
}

/// Sheets with layouts away from the origin, and unreferenced vertices: after all others, in a hole, or welded to
/// others.
fn sheets_with_unused_vertices() -> [(String, &'static [&'static str]); 3] {
    let mesh = bump(6);
    let layout: Vec<DVec2> = layout_of(&mesh).into_iter().map(|z| z + DVec2::new(5.0, 3.0)).collect();
    let plain = |mesh: &TriMesh| {
        let polygons = PolygonMesh::from(mesh);
        textured_text(&polygons, &layout, |face, k| [polygons.face(face)[k].index(); 2])
    };
    let behind = format!("{}v 90 -70 3\n", plain(&mesh));
    let mut holed = mesh.clone();
    holed.triangles.retain(|triangle| !triangle.contains(&VertexId::new(24)));
    let mut split = PolygonMesh::from(&mesh);
    let corner = split.corners.iter().rposition(|vertex| vertex.index() == 24).expect("a corner");
    split.corners[corner] = VertexId::from_index(split.positions.len());
    split.positions.push(split.positions[24] + DVec3::splat(1e-4));
    let count = mesh.positions.len();
    let split = textured_text(&split, &layout, |face, k| {
        let vertex = split.face(face)[k].index();
        [vertex, if vertex == count { 24 } else { vertex }]
    });
    [(behind, &[]), (plain(&holed), &[]), (split, &["--weld", "0.001"])]
}

#[test]
fn vertices_of_no_face_move_no_layout() {
    for (text, options) in sheets_with_unused_vertices() {
        let program = Program::new();
        program.write("in.obj", &text);
        let arguments = [&["flatten", "in.obj", "--start", "uv", "-o", "out.obj"], options].concat();
        program.run(&arguments).expect(0);
        let before = at_corners(&program, "in.obj");
        assert!(at_corners(&program, "out.obj") == before, "to the last bit, {options:?}");
        // A pin at the first corner translates everything; rounds of relaxation stay over the layout.
        program.run(&[&arguments[..], &["--pin", "0:2,2"]].concat()).expect(0);
        let moves: Vec<DVec2> = at_corners(&program, "out.obj").iter().zip(&before).map(|(z, at)| *z - *at).collect();
        assert!(
            moves.iter().all(|shift| shift.distance(DVec2::splat(2.0) - before[0]) < 1e-12),
            "{options:?} {:?}",
            &moves[..3]
        );
        program.run(&[&arguments[..], &["--relax", "2"]].concat()).expect(0);
        let middle = |all: &[DVec2]| all.iter().sum::<DVec2>() / all.len() as f64;
        let relaxed = at_corners(&program, "out.obj");
        assert!(relaxed != before && middle(&relaxed).distance(middle(&before)) < 0.05, "{options:?}");
    }
}

#[test]
fn of_several_charts_that_cannot_begin_the_first_is_named_on_any_number_of_threads() {
    // The first chart has the most faces, so others fail before it.
    let mut mesh = grid(60, 60);
    let first = mesh.triangles.len();
    for chart in 1..6 {
        let (small, begin) = (grid(2, 2), mesh.positions.len());
        mesh.positions.extend(small.positions.iter().map(|p| *p + DVec3::X * (100.0 * f64::from(chart))));
        let moved = |triangle: [VertexId; 3]| triangle.map(|v| VertexId::from_index(begin + v.index()));
        mesh.triangles.extend(small.triangles.into_iter().map(moved));
    }
    let program = Program::new();
    write(
        &program,
        "in.obj",
        &grouped((&mesh).into(), |face| usize::from(face + 1 == first || (face > first && face % 2 == 0))),
    );
    for threads in ["1", "2", "2", "2", "4", "4"] {
        let run = program.run(&["flatten", "in.obj", "--start", "uv", "--threads", threads]).expect(2);
        let number = |word: &str| word.strip_prefix('v')?.parse::<usize>().ok();
        let vertex = run.stderr.split(' ').find_map(number).expect("a vertex");
        assert!(vertex <= 61 * 61, "{threads} threads: {}", run.stderr);
    }
}

#[test]
fn a_gap_between_charts_packs_them_anew() {
    let program = Program::new();
    let file = grouped((&torus(8, 12)).into(), |face| face / 2 % 8 / 4 * 6 + face / 16 / 2);
    write(&program, "in.obj", &file);
    program.run(&["flatten", "in.obj", "--charts", "uv", "-o", "laid.obj"]).expect(0);
    let arguments = ["flatten", "laid.obj", "--charts", "uv", "--start", "uv", "--gap", "50", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(report["packing"]["gap"], json!(50));
}

#[test]
fn relaxing_begins_with_the_layout_in_every_format_on_any_number_of_threads() {
    let program = Program::new();
    program.write("in.obj", &sheet(0.0));
    program.run(&["flatten", "in.obj", "--start", "uv", "--precision", "f64", "-o", "in.ply"]).expect(0);
    assert_eq!(coordinates(&program, "in.ply"), coordinates(&program, "in.obj"));
    for name in ["in.obj", "in.ply"] {
        let mut written = Vec::new();
        for threads in ["1", "2"] {
            let arguments = ["flatten", name, "--start", "uv", "--relax", "4", "--threads", threads, "--report", "-"];
            let report = program.run(&arguments).expect(0).json();
            let steps = report["steps"].as_array().expect("steps");
            assert!(steps.len() > 2);
            assert!(steps.iter().all(|step| step["planar"] == json!(true)));
            let energies: Vec<f64> = steps[1..].iter().map(|step| step["energy"].as_f64().expect("a number")).collect();
            assert!(energies.is_sorted_by(|before, after| after <= before), "{energies:?}");
            program.run(&[&arguments[..8], &["-o", "out.obj"]].concat()).expect(0);
            written.push(coordinates(&program, "out.obj"));
        }
        assert_eq!(written[0], written[1], "{name}");
    }
}

#[test]
fn a_folded_layout_is_reported_with_its_faults_and_solved() {
    let program = Program::new();
    program.write("in.obj", &sheet(0.4));
    let checked = program.run(&["check", "in.obj", "--report", "-"]).expect(4).json();
    let flipped = checked["verdict"]["flipped_faces"].as_array().expect("a list").len();
    assert!(flipped > 0);
    let report = program.run(&["flatten", "in.obj", "--start", "uv", "--report", "-"]).expect(0).json();
    assert_eq!(report["steps"][0]["flipped_faces"], json!(flipped));
    let note = report["steps"][1]["note"].as_str().expect("a note");
    let restart = note.split("; ").find(|words| words.starts_with("restarted")).expect("a restart");
    assert_message("start-restarted-from-scratch", restart);
    let iterated =
        program.run(&["flatten", "in.obj", "--start", "uv", "--method", "iterate", "--report", "-"]).expect(0);
    assert_eq!(iterated.json()["steps"][1]["stage"], json!("iterate"));
}

#[test]
fn charts_stay_where_the_file_has_them_unless_they_are_to_be_packed() {
    let program = Program::new();
    let file = grouped((&torus(8, 12)).into(), |face| face / 2 % 8 / 4 * 6 + face / 16 / 2);
    write(&program, "in.obj", &file);
    program.run(&["flatten", "in.obj", "--charts", "uv", "-o", "laid.obj"]).expect(0);
    let arguments = ["flatten", "laid.obj", "--charts", "uv", "--start", "uv", "--report", "out.json"];
    program.run(&[&arguments[..], &["-o", "same.obj"]].concat()).expect(0);
    let texture = |name: &str| at_corners(&program, name);
    assert_eq!(texture("same.obj"), texture("laid.obj"));
    let report = fs::read_to_string(program.path("out.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    for chart in report["charts"].as_array().expect("charts") {
        assert_eq!((&chart["placement"], &chart["steps"][0]["stage"]), (&json!("file"), &json!("given")));
    }
    assert_eq!(report.get("packing"), None);
    program.run(&[&arguments[..], &["-o", "packed.obj", "--pack", "512x256"]].concat()).expect(0);
    assert_ne!(texture("packed.obj"), texture("laid.obj"));
    assert_eq!(charts_proved(&program, "packed.obj"), 12);
    // The layout of the first file is degenerate: each chart is solved from scratch, and all are packed.
    program.run(&["flatten", "in.obj", "--charts", "uv", "--start", "uv", "-o", "mended.obj"]).expect(0);
    assert_eq!(charts_proved(&program, "mended.obj"), 12);
}

#[test]
fn a_layout_that_is_cut_where_the_surface_is_not_is_refused_with_what_to_do() {
    let program = Program::new();
    write(&program, "cut.obj", &grouped((&grid(4, 2)).into(), |face| face / 2 % 4 / 2));
    let run = program.run(&["flatten", "cut.obj", "--start", "uv"]).expect(2);
    assert_message("start-layout-is-cut", &run.stderr);
    let file = grouped((&grid(2, 2)).into(), |_| 0);
    write(&program, "none.obj", &MeshFile { texture: None, ..file });
    let run = program.run(&["flatten", "none.obj", "--start", "uv"]).expect(2);
    assert_message("start-without-a-layout", &run.stderr);
}

#[test]
fn options_that_go_against_a_layout_are_refused() {
    let program = Program::new();
    program.write("in.obj", &sheet(0.0));
    let methods = ["natural", "lscm", "levy", "spectral", "abf", "abf++", "convex", "schnyder"];
    let refused = |method| program.run(&["flatten", "in.obj", "--start", "uv", "--method", method]).expect(2).stderr;
    assert_message("start-of-methods-that-do-not-use-it", &methods.map(refused).concat());
    let run = program.run(&["flatten", "in.obj", "--start", "uv", "--fit", "unit"]).expect(2);
    assert_message("start-with-fit-unit", &run.stderr);
    let full = program.run(&["flatten", "in.obj", "--start", "uv", "--fit", "true", "--report", "-"]).expect(0).json();
    assert_eq!(full["placement"], json!("true"));
    program.run(&["flatten", "in.obj", "--start", "uv", "--fit", "true", "-o", "out.obj"]).expect(0);
    let area = |corners: [DVec3; 3]| (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    let mesh = bump(6);
    let flat = coordinates(&program, "out.obj");
    let [surface, layout] = [mesh.positions.clone(), flat.iter().map(|z| z.extend(0.0)).collect::<Vec<DVec3>>()]
        .map(|places| mesh.triangles.iter().map(|t| area(t.map(|v| places[v.index()]))).sum::<f64>());
    assert!((surface / layout - 1.0).abs() < 1e-9, "{surface} {layout}");
}
