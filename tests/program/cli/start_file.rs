//! `--start FILE`: `freebound flatten` starts from the texture coordinates of another file of the mesh.

use freebound_core::mesh::{PolygonMesh, TriMesh};
use freebound_io::{MeshFile, read_mesh};
use glam::DVec2;
use serde_json::{Value, json};

use super::charts_uv::{grouped, write};
use super::program::{Program, coordinates_by_vertex, textured_text};
use freebound_testkit::grid;
use freebound_testkit::surfaces::bump;

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
    let note = report["steps"][1]["note"].as_str().expect("a note");
    assert!(note.contains("restarted from scratch: the layout of the file is not one-to-one"), "{note}");
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
    let refused = |options: &[&str], status: i32, words: &[&str]| {
        let run = program.run(&[&["flatten", "in.obj"], options].concat()).expect(status);
        for word in words {
            assert!(run.stderr.contains(word), "{word}: {}", run.stderr);
        }
    };
    refused(&["--start", "missing.obj"], 3, &["missing.obj"]);
    refused(&["--start", "in.obj"], 2, &["in.obj", "no texture coordinates", "remove --start"]);
    other(&program, "small.obj", &grid(2, 2), |v| DVec2::new((v % 3) as f64, (v / 3) as f64));
    refused(
        &["--start", "small.obj"],
        2,
        &["small.obj", "no texture coordinates for vertex v", "a layout of this mesh"],
    );
    write(&program, "torn.obj", &grouped((&bump(6)).into(), |face| face / 2 % 6 / 3));
    refused(&["--start", "torn.obj"], 2, &["torn.obj: vertex v", "several texture coordinates", "--charts uv"]);
    refused(&["--start", "five.obj", "-o", "five.obj"], 2, &["five.obj", "the layout to start from"]);
    refused(&["--start", "five.obj", "--method", "lscm"], 2, &["--method lscm does not use --start"]);
    let both = program.run(&["flatten", "-", "--start", "-"]).expect(2);
    assert!(both.stderr.contains("cannot be both the mesh and --start"), "{}", both.stderr);
}

#[test]
fn a_layout_that_folds_is_shown_and_solved_afresh() {
    let program = with_five();
    let mesh = bump(6);
    other(&program, "heap.obj", &mesh, |v| DVec2::new((v * 7 % 13) as f64, (v * 5 % 11) as f64));
    let report = report(&program, &[&FIVE[..], &["--start", "heap.obj"]].concat());
    assert!(report["steps"][0]["flipped_faces"].as_u64() > Some(0));
    let note = report["steps"][1]["note"].as_str().expect("a note");
    assert!(note.contains("restarted from scratch: the layout of the file is not one-to-one"), "{note}");
}
