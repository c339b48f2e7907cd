//! `--start FILE`: `freebound flatten` starts from the texture coordinates of another file of the mesh.

use freebound_core::mesh::{PolygonMesh, TriMesh};
use freebound_io::{MeshFile, read_mesh};
use glam::DVec2;
use serde_json::{Value, json};

use super::charts_uv::{grouped, write};
use super::program::{Program, coordinates_by_vertex, textured_text};
use freebound_testkit::surfaces::bump;
use freebound_testkit::{assert_message, grid};

/// Pins that pull the corners of the bumpy sheet apart and move a vertex in its middle.
const FIVE: [&str; 10] =
    ["--pin", "0:0,0", "--pin", "6:1.2,0.1", "--pin", "42:-0.1,0.9", "--pin", "48:1,1.1", "--pin", "24:0.55,0.6"];
/// Sixth pin in addition.
const SIXTH: [&str; 2] = ["--pin", "32:0.7,0.75"];

/// Folder with the bumpy sheet, flattened with five constraints into `five.obj`.
fn with_five() -> Program {
    let program = Program::new();
    let mesh = MeshFile::from(&bump(6));
    write(&program, "in.obj", &mesh);
    program.run(&[&["flatten", "in.obj", "-o", "five.obj"], &FIVE[..]].concat()).expect(0);
    program
}

fn coordinates(program: &Program, name: &str) -> Vec<DVec2> {
    coordinates_by_vertex(&read_mesh(&program.path(name)).expect("written")).to_vec()
}

fn report(program: &Program, options: &[&str]) -> Value {
    program.run(&[&["flatten", "in.obj", "--report", "-"], options].concat()).expect(0).json()
}

/// Note of the second step that it began from scratch.
fn restart(report: &Value) -> &str {
    let note = report["steps"][1]["note"].as_str().expect("a note");
    note.split("; ").find(|words| words.starts_with("restarted")).expect("a restart")
}

#[test]
fn what_a_run_has_written_comes_back_as_it_is_with_the_same_constraints() {
    let program = with_five();
    for method in ["auto", "continuation", "matchmaker"] {
        let options = [&FIVE[..], &["--start", "five.obj", "--method", method]].concat();
        let report = report(&program, &options);
        assert_eq!(report["start"], json!("five.obj"));
        let steps = report["steps"].as_array().expect("steps");
        assert_eq!(
            (steps.len(), &steps[0]["stage"], &steps[0]["planar"]),
            (1, &json!("given"), &json!(true)),
            "{method}"
        );
        assert_eq!((&report["placement"], &report["pins"]["max_error"]), (&json!("pins"), &json!(0.0)));
        program.run(&[&["flatten", "in.obj", "-o", "again.obj"], &options[..]].concat()).expect(0);
        assert_eq!(coordinates(&program, "again.obj"), coordinates(&program, "five.obj"), "to the last bit");
    }
}

#[test]
fn a_further_constraint_is_met_from_the_others_as_they_lie() {
    let program = with_five();
    let options = [&FIVE[..], &SIXTH].concat();
    let went_on = report(&program, &[&options[..], &["--start", "five.obj"]].concat());
    let stages: Vec<&str> =
        went_on["steps"].as_array().expect("steps").iter().map(|s| s["stage"].as_str().unwrap()).collect();
    assert!(stages[..2] == ["given", "continuation"] && stages.len() <= 6, "{stages:?}");
    assert!(went_on["steps"].as_array().expect("steps").iter().all(|step| step["planar"] == json!(true)));
    assert_eq!(went_on["pins"]["unmet"], json!([]));
    // Numbers in 32 bits work too: those of the pins are off by their rounding.
    program.run(&[&["flatten", "in.obj", "-o", "rounded.obj", "--precision", "f32"], &FIVE[..]].concat()).expect(0);
    let rounded = report(&program, &[&options[..], &["--start", "rounded.obj"]].concat());
    assert_eq!((&rounded["steps"][1]["stage"], &rounded["pins"]["max_error"]), (&json!("continuation"), &json!(0.0)));
    let distance = |report: &Value| report["steps"][1]["distance_left"].as_f64().expect("a number");
    assert!(distance(&rounded) <= distance(&went_on) + 1e-6);
}

#[test]
fn coordinates_are_read_on_the_picture_as_pins_are() {
    let program = with_five();
    let wide = ["--aspect", "2:1", "--start", "wide.obj"];
    program.run(&[&["flatten", "in.obj", "-o", "wide.obj"], &FIVE[..], &wide[..2]].concat()).expect(0);
    let report = report(&program, &[&FIVE[..], &wide].concat());
    assert_eq!(report["steps"].as_array().map(Vec::len), Some(1));
    program.run(&[&["flatten", "in.obj", "-o", "again.obj"], &FIVE[..], &wide].concat()).expect(0);
    assert_eq!(coordinates(&program, "again.obj"), coordinates(&program, "wide.obj"));
}

#[test]
fn a_file_with_split_edges_is_read_by_the_numbers_of_vertices() {
    let program = with_five();
    // The corners of a face are flipped, which requires new vertices.
    let turned = ["--pin", "16:0.5,0.5", "--pin", "17:0.5,0.7", "--pin", "23:0.7,0.5"];
    let corners = &FIVE[..8];
    let run =
        program.run(&[&["flatten", "in.obj", "-o", "split.obj", "--report", "-"], corners, &turned].concat()).expect(0);
    assert!(run.json()["new_vertices"].as_u64().expect("a count") > 0);
    let report = report(&program, &[corners, &["--start", "split.obj"]].concat());
    assert_eq!(report["steps"][0]["stage"], json!("given"));
    // The flipped face stays flipped without its new vertices.
    assert_eq!(report["steps"][0]["flipped_faces"].as_u64().map(|count| count > 0), Some(true));
    assert_message("start-file-folds-without-its-new-vertices", restart(&report));
    assert_eq!(report["pins"]["unmet"], json!([]));
}

/// Writes a mesh with the given layout.
fn other(program: &Program, name: &str, mesh: &TriMesh, layout: impl Fn(usize) -> DVec2) {
    let layout: Vec<DVec2> = (0..mesh.positions.len()).map(layout).collect();
    let polygons = PolygonMesh::from(mesh);
    program.write(name, &textured_text(&polygons, &layout, |face, k| [polygons.face(face)[k].index(); 2]));
}

#[test]
fn what_is_no_layout_of_the_mesh_is_named_with_what_to_do() {
    let program = with_five();
    let gone = program.run(&["flatten", "in.obj", "--start", "missing.obj", "--report", "-"]).expect(3);
    assert_eq!(gone.json()["error"]["kind"], json!("unreadable"));
    assert!(gone.stderr.contains("missing.obj"), "{}", gone.stderr);
    let refused = |options: &[&str]| program.run(&[&["flatten", "in.obj"], options].concat()).expect(2).stderr;
    assert_message("start-file-without-a-layout", &refused(&["--start", "in.obj"]));
    other(&program, "small.obj", &grid(2, 2), |v| DVec2::new((v % 3) as f64, (v / 3) as f64));
    assert_message("start-file-of-another-mesh", &refused(&["--start", "small.obj"]));
    write(&program, "torn.obj", &grouped((&bump(6)).into(), |face| face / 2 % 6 / 3));
    assert_message("start-file-is-cut", &refused(&["--start", "torn.obj"]));
    assert_message("start-file-is-written", &refused(&["--start", "five.obj", "-o", "five.obj"]));
    assert_message("start-file-is-not-used", &refused(&["--start", "five.obj", "--method", "lscm"]));
    let both = program.run(&["flatten", "-", "--start", "-"]).expect(2);
    assert_message("start-file-is-the-stream-of-the-mesh", &both.stderr);
}

#[test]
fn a_layout_that_folds_is_shown_and_solved_afresh() {
    let program = with_five();
    let mesh = bump(6);
    other(&program, "heap.obj", &mesh, |v| DVec2::new((v * 7 % 13) as f64, (v * 5 % 11) as f64));
    let report = report(&program, &[&FIVE[..], &["--start", "heap.obj"]].concat());
    assert!(report["steps"][0]["flipped_faces"].as_u64() > Some(0));
    assert_message("start-file-folds", restart(&report));
}
