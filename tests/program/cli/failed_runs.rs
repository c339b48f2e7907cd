//! Files left by a failed run: a report with the error, and no report of an earlier run.

use std::fmt::Write as _;
use std::fs;

use serde_json::{Value, json};

use super::program::{Program, Run};
use super::report_schema::TENT;
use freebound_testkit::assert_message;

/// Runs `flatten` on a text, with an earlier report at the path of the new one.
fn flattened(text: &str, options: &[&str]) -> (Run, Option<Value>) {
    let program = Program::new();
    program.write("in.obj", text);
    program.write("out.json", "{\"schema\": 1, \"from\": \"an earlier run\"}");
    let run = program.run(&[&["flatten", "in.obj", "--report", "out.json"][..], options].concat());
    let report = fs::read(program.path("out.json")).ok().map(|bytes| serde_json::from_slice(&bytes).unwrap());
    (run, report)
}

#[test]
fn the_faults_of_a_mesh_stand_in_the_report_with_their_elements_and_remedies() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 9 9 9\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    let (run, report) = flattened(text, &[]);
    let run = run.expect(3);
    assert_message("failed-runs-faults-of-a-mesh", &run.stderr);
    let report = report.expect("a report");
    assert_eq!([&report["schema"], &report["mesh"]["path"]], [&json!(2), &json!("in.obj")]);
    let error = &report["error"];
    assert_eq!([&error["exit_status"], &error["kind"]], [&json!(3), &json!("not-a-disk")]);
    assert!(run.stderr.contains(error["message"].as_str().unwrap()), "{error}");
    let faults = error["faults"].as_array().unwrap();
    let of = |kind: &str| faults.iter().find(|fault| fault["kind"] == kind).unwrap_or_else(|| panic!("{error:#}"));
    assert_eq!(of("unreferenced-vertices")["vertices"], json!([5]));
    assert_eq!(of("non-manifold-edges")["edges"], json!([[0, 1]]));
    let remedies: Vec<String> = faults.iter().map(|fault| format!("{}: {}", fault["kind"], fault["remedy"])).collect();
    assert_message("failed-runs-remedies-of-a-mesh", &remedies.join("\n"));
}

#[test]
fn the_lines_of_a_broken_file_stand_in_the_report() {
    let (run, report) = flattened("v 0 0 0\nv 1 0 x\nv 1 1 0\nf 1 2 x\nf 1 2 3\n", &[]);
    let run = run.expect(3);
    assert_message("failed-runs-lines-of-a-broken-file", &run.stderr);
    let error = &report.expect("a report")["error"];
    let found: Vec<&Value> = error["faults"].as_array().unwrap().iter().map(|fault| &fault["line"]).collect();
    assert_eq!(found, [&json!(2), &json!(4)]);
    assert!(run.stderr.trim_end().ends_with(error["remedy"].as_str().unwrap()), "{error}");
}

#[test]
fn a_run_that_breaks_off_takes_the_report_of_an_earlier_one_away_and_wrong_use_leaves_it() {
    let (run, report) = flattened(TENT, &["-o", "no/such/folder/out.obj"]);
    run.expect(1);
    assert_eq!(report, None, "nothing is known of this run");
    let (run, report) = flattened(TENT, &["--boundary", "square"]);
    run.expect(2);
    assert_eq!(report.expect("left as it was")["from"], "an earlier run");
}

#[test]
fn a_mesh_whose_faces_all_lack_texture_coordinates_names_them() {
    let program = Program::new();
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3\nf 1 3/1 4\n");
    let run = program.run(&["check", "in.obj", "--report", "-"]).expect(3);
    let error = &run.json()["error"];
    assert_eq!([&error["kind"], &error["faults"][0]["faces"]], [&json!("texture-coordinates"), &json!([0, 1])]);
    assert!(run.stderr.starts_with("freebound: in.obj: "), "{}", run.stderr);
}

#[test]
fn every_message_names_the_file_first() {
    let program = Program::new();
    program.write("tent.obj", TENT);
    for (name, text) in [("empty.obj", ""), ("mesh.dae", "mesh\n"), ("bad.txt", "0 x y\n"), ("text.png", "none")] {
        program.write(name, text);
    }
    program.write("pins.txt", "0 0 0\n1 1 0\n");
    let unusable: [(&[&str], &str, &str); 6] = [
        (&["missing.obj"], "missing.obj", "unreadable"),
        (&["empty.obj"], "empty.obj", "no-faces"),
        (&["mesh.dae"], "mesh.dae", "format-not-read"),
        (&["tent.obj", "--constraints", "bad.txt"], "bad.txt", "constraints"),
        (&["tent.obj", "--constraints", "gone.txt"], "gone.txt", "constraints"),
        (&["tent.obj", "--picture", "text.png"], "text.png", "picture"),
    ];
    let assert_first = |run: &Run, file: &str| {
        assert!(run.stderr.starts_with(&format!("freebound: {file}: ")), "{file}: {}", run.stderr);
    };
    for (arguments, file, kind) in unusable {
        let run = program.run(&[&["flatten"], arguments, &["--report", "-"]].concat()).expect(3);
        assert_eq!(run.json()["error"]["kind"], kind, "{arguments:?}");
        assert_first(&run, file);
    }
    assert_first(&program.run(&["flatten", "tent.obj", "-o", "no/out.obj"]).expect(1), "no/out.obj");
    let wrong: [(&[&str], &str, &str); 4] = [
        (&["--pin", "7:0,0"], "tent.obj", "no-such-vertex"),
        (&["--pin", "0:0,0", "--pin", "0:0,1"], "tent.obj", "pinned-twice"),
        (&["--constraints", "pins.txt", "--pin", "1:1,1"], "pins.txt", "vertex-in-file-and-option"),
        (&["--constraints", "pins.txt", "--pin", "2:1,0"], "pins.txt", "target-in-file-and-option"),
    ];
    for (arguments, file, topic) in wrong {
        let run = program.run(&[&["flatten", "tent.obj"], arguments].concat()).expect(2);
        assert_first(&run, file);
        assert_message(&format!("failed-runs-{topic}"), &run.stderr);
    }
}

#[test]
fn triangle_soup_is_told_to_merge_its_vertices() {
    let mut text = String::new();
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        for [x, y, z] in triangle.map(|corner: usize| corners[corner]) {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    text += "f 1 2 3\nf 4 5 6\n";
    let (run, report) = flattened(&text, &[]);
    let run = run.expect(3);
    assert_message("failed-runs-triangle-soup", &run.stderr);
    let fault = &report.expect("a report")["error"]["faults"][0];
    assert_eq!([&fault["kind"], &fault["vertices"]], [&json!("coincident-vertices"), &json!([3, 4])]);
    flattened(&text, &["--repair", "all"]).0.expect(0);
}

#[test]
fn parts_that_touch_stay_apart_and_are_named() {
    // Two squares of two triangles each, side by side, with vertices of their own.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\n\
                f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n";
    let (run, report) = flattened(text, &[]);
    run.expect(0);
    let report = report.expect("a report");
    assert_eq!(report["mesh"]["touching_vertices"], json!(2));
    assert_eq!(report["charts"].as_array().map(Vec::len), Some(2));
    let (run, report) = flattened(text, &["--repair", "all"]);
    run.expect(0);
    assert_eq!(report.expect("a report")["mesh"].get("touching_vertices"), None);
    // The split edge is a seam if that is asked for.
    let (run, report) = flattened(text, &["--repair", "all", "--seams", "splits"]);
    run.expect(0);
    assert_eq!(report.expect("a report")["charts"].as_array().map(Vec::len), Some(2));
}
