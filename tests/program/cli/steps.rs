//! `freebound flatten --steps`, and the options that control steps.

use std::collections::BTreeMap;
use std::fs;

use freebound::examples::Example;
use freebound::session::Model;
use freebound_core::flatten::{Flattener, to_unit_square};
use freebound_core::mesh::{DiskMesh, Preparation, TriMesh};
use freebound_core::pipeline::{Fit, Outcome, Placement, Problem};
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings};
use freebound_core::verify::verdict;
use freebound_io::read_mesh;
use glam::DVec2;
use serde_json::Value;

use super::program::{Program, argument, coordinates_by_vertex, example_file};
use freebound_testkit::{Entry, assert_message, corpus_disks, corpus_test, csv_rows, data_disks, fan, grid};

/// Pins at two opposite corners of the cube's top: with them mean-value weights fold 8 faces.
const FOLDING: [&str; 4] = ["--pin", "12:0,0", "--pin", "36:1,0"];

fn files_in(program: &Program, folder: &str) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(program.path(folder))
        .expect("the folder is there")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn flatten(program: &Program, options: &[&str], status: i32) -> Value {
    program.run(&[&["flatten", "in.obj", "--report", "-"][..], options].concat()).expect(status).json()
}

/// Table of the steps, by column names of the report.
fn table(program: &Program, folder: &str) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(program.path(folder).join("steps.csv")).expect("the table is there");
    let mut rows = csv_rows(&text).into_iter();
    let head = rows.next().expect("a head");
    rows.map(|row| head.iter().cloned().zip(row).collect()).collect()
}

/// Value of the report as a cell.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// Summary's line on the method and its verdict, without the digits of the residual.
fn verdict_line(stdout: &str) -> String {
    let line = stdout.lines().find(|line| line.contains("weights")).expect("a line on the verdict");
    let parts = line.split("; ").map(|part| if part.starts_with("residual") { "residual" } else { part });
    parts.collect::<Vec<_>>().join("; ")
}

#[test]
fn the_table_of_the_steps_is_the_report() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let options = [&["--family", "mean-value", "--steps", "new/steps"][..], &FOLDING].concat();
    let report = flatten(&program, &options, 0);
    let steps = report["steps"].as_array().expect("a list");
    assert!(steps.len() >= 2, "the first step folds: {report}");
    let rows = table(&program, "new/steps");
    assert_eq!(rows.len(), steps.len());
    for (row, step) in rows.iter().zip(steps) {
        let fields = step.as_object().expect("an object");
        // Inner iterations of another method's step are in three columns.
        assert!(!fields.contains_key("convergence"));
        assert_eq!(row.len(), fields.len() + 3 + usize::from(!fields.contains_key("note")));
        for (key, value) in fields {
            // Reading JSON may lose the last digit.
            let same_number = || {
                let (ours, theirs) = (row[key].parse::<f64>().ok()?, value.as_f64()?);
                Some((ours - theirs).abs() <= 4.0 * f64::EPSILON * theirs.abs())
            };
            assert!(row[key] == cell(value) || same_number() == Some(true), "{key}: {} and {value}", row[key]);
        }
        assert!(row.keys().all(|key| step.get(key).is_some() || row[key].is_empty()), "{row:?}");
    }
}

#[test]
fn there_is_a_drawing_of_every_step_with_its_flipped_faces() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let report = flatten(&program, &[&["--family", "mean-value", "--steps", "steps"][..], &FOLDING].concat(), 0);
    let steps = report["steps"].as_array().expect("a list");
    let mut expected: Vec<String> = steps
        .iter()
        .map(|step| format!("step-{:03}-{}.svg", step["index"].as_u64().unwrap(), step["stage"].as_str().unwrap()))
        .collect();
    assert_eq!(expected[..2], ["step-000-natural.svg", "step-001-iterate.svg"]);
    for (name, step) in expected.iter().zip(steps) {
        let text = fs::read_to_string(program.path("steps").join(name)).unwrap();
        let red = text.lines().find(|line| line.contains("fill=\"#d92d3a\"")).expect("the flipped faces' path");
        assert_eq!(red.matches('Z').count(), step["flipped_faces"], "{name}");
    }
    expected.push("steps.csv".to_owned());
    assert_eq!(files_in(&program, "steps"), expected);
    assert_eq!(program.files(), ["in.obj", "steps"], "nothing is left aside");
}

#[test]
fn a_step_of_the_virtual_boundary_is_drawn_with_hull_and_pockets() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let options = ["--method", "virtual-boundary", "--family", "mean-value", "--steps", "steps"];
    // A corner of the top and one of the bottom: the boundary bends inward.
    let pins = ["--pin", "0:0,0", "--pin", "435:1.25,0"];
    let report = flatten(&program, &[&options[..], &pins].concat(), 0);
    let steps = report["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 2, "{report}");
    let text = fs::read_to_string(program.path("steps").join("step-001-virtual-boundary.svg")).unwrap();
    let path = |class: &str| {
        let marked = format!("class=\"{class}\"");
        text.lines().find(|line| line.contains(&marked)).unwrap_or_else(|| panic!("no {class}")).to_owned()
    };
    assert!(path("pockets").matches('Z').count() > 3);
    assert_eq!(path("hull").matches('Z').count(), 1);
    let first = fs::read_to_string(program.path("steps").join("step-000-natural.svg")).unwrap();
    assert!(!first.contains("pockets") && !first.contains("hull"));
}

#[test]
fn the_steps_of_an_earlier_run_go_and_other_files_stay() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    fs::create_dir(program.path("steps")).unwrap();
    let replaced = ["step-041-iterate.svg", "step-007-natural.svg", "step-1234-virtual-boundary.svg", "steps.csv"];
    let kept = [
        "my-step-001-a.svg",
        "notes.txt",
        "step-001-my drawing.svg",
        "step-001.svg",
        "step-1-natural.svg",
        "step-one.svg",
    ];
    for name in replaced.iter().chain(&kept) {
        program.write(&format!("steps/{name}"), "mine");
    }
    flatten(&program, &["--steps", "steps"], 0);
    let mut expected = [&kept[..], &["step-000-natural.svg", "steps.csv"]].concat();
    expected.sort_unstable();
    assert_eq!(files_in(&program, "steps"), expected);
    assert_eq!(table(&program, "steps").len(), 1);
    assert_eq!(fs::read_to_string(program.path("steps/notes.txt")).unwrap(), "mine");
}

#[test]
fn a_run_that_fails_leaves_no_steps() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["flatten", "in.obj", "--pin", "99999:0,0", "--steps", "steps"]).expect(2);
    assert_eq!(program.files(), ["in.obj"]);
    program.write("taken", "a file");
    let run = program.run(&["flatten", "in.obj", "--steps", "taken"]).expect(1);
    assert!(run.stderr.contains("taken"), "{}", run.stderr);
    assert_eq!(program.files(), ["in.obj", "taken"]);
}

#[test]
fn the_limit_of_steps_is_kept() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    // Elimination does not end planar with these two pins inside the surface.
    let options = ["--method", "iterate", "--family", "mean-value", "--treatment", "eliminate", "--max-steps"];
    for limit in ["0", "2"] {
        let report = flatten(&program, &[&options[..], &[limit], &FOLDING].concat(), 4);
        let count: usize = limit.parse().unwrap();
        assert_eq!(report["steps"].as_array().unwrap().len(), 1 + count, "the natural boundary and {limit} more");
    }
    let run = program.run(&[&["flatten", "in.obj"][..], &options, &["2"], &FOLDING].concat()).expect(4);
    let line = verdict_line(&run.stdout);
    let (_, ending) = line.split_once(" after ").expect("an ending");
    assert_message("steps-limit-is-reached", ending);
}

#[test]
fn the_treatment_is_the_one_that_was_asked_for_and_the_report_says_which_was_used() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let treatment_and_status = |options: &[&str], status: i32| {
        let report = flatten(&program, &[options, &FOLDING].concat(), status);
        report["pins"]["treatment"].as_str().unwrap().to_owned()
    };
    let mean_value = ["--family", "mean-value", "--method"];
    let with = |rest: &[&'static str]| [&mean_value[..], rest].concat();
    assert_eq!(treatment_and_status(&with(&["natural"]), 4), "eliminate");
    assert_eq!(treatment_and_status(&with(&["natural", "--treatment", "least-squares"]), 0), "least-squares");
    assert_eq!(treatment_and_status(&with(&["iterate"]), 0), "least-squares");
    assert_eq!(treatment_and_status(&with(&["iterate", "--treatment", "eliminate"]), 4), "eliminate");
    assert_eq!(treatment_and_status(&with(&["virtual-boundary"]), 0), "eliminate");
}

#[test]
fn the_growth_of_the_pinned_boundary_is_a_choice() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    // Two neighbours on the boundary: with mean-value weights it crosses itself, so more of it is pinned.
    let pins = ["--pin", "173:0,0", "--pin", "177:0.339,0", "--family", "mean-value", "--method", "virtual-boundary"];
    let bent = |growth: &[&str]| {
        let report = flatten(&program, &[growth, &pins].concat(), 0);
        assert_eq!(report["boundary"], "convex");
        report["steps"][1]["bent_vertices"].as_u64().expect("a number")
    };
    assert_eq!([bent(&[]), bent(&["--growth", "double"]), bent(&["--growth", "one"])], [4, 4, 3]);
}

#[test]
fn the_summary_names_rung_and_number_of_steps() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let said =
        |options: &[&str]| verdict_line(&program.run(&[&["flatten", "in.obj"][..], options].concat()).expect(0).stdout);
    assert_message("steps-of-auto", &said(&[]));
    let iterated = said(&[&["--family", "mean-value", "--relax", "0"][..], &FOLDING].concat());
    assert_message("steps-of-an-iteration", &iterated);
    let bent = said(&[&["--family", "mean-value", "--method", "virtual-boundary"][..], &FOLDING].concat());
    assert_message("steps-of-the-virtual-boundary", &bent);
    assert_message("steps-of-a-linear-method", &said(&["--method", "natural"]));
}

fn assert_auto_ends_planar_and_proved_on_every_disk(disks: Vec<Entry>) {
    for entry in disks {
        let program = Program::new();
        let arguments = ["flatten", argument(&entry.path), "-o", "out.obj", "--report", "out.json"];
        program.run(&arguments).expect(0);
        let report: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
        assert_eq!(report["verdict"]["planar"], true, "{}", entry.file);
        assert_eq!(report["verdict"]["turning_number"], 1, "{}", entry.file);
        // Verifies the written file again.
        let written = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
        assert!(verdict(&entry.disk(), &written).planar, "{}", entry.file);
    }
}

#[test]
fn auto_ends_planar_and_proved_on_every_disk_of_tests_data() {
    assert_auto_ends_planar_and_proved_on_every_disk(data_disks());
}

corpus_test! {
    fn auto_ends_planar_and_proved_on_every_disk_of_the_corpus() {
        assert_eq!(corpus_disks().len(), 20);
        assert_auto_ends_planar_and_proved_on_every_disk(corpus_disks());
    }
}

/// Outcome of a solve with the embedding `places`.
fn outcome_with(mesh: &DiskMesh, places: Embedding) -> Outcome {
    let mut run = Flattener::new(Settings::new(Method::Natural, Family::Conformal), Pins::new());
    let mut step = run.step(mesh, Control::unattended()).expect("a fan is flat");
    step.verdict = verdict(mesh, &places);
    step.candidate.solution.embedding = places;
    Outcome::new(mesh, Problem { settings: run.settings().clone(), ..Problem::default() }, step)
}

fn finish(mesh: &TriMesh, places: Embedding) -> (bool, Placement, bool) {
    let disk = DiskMesh::try_from(mesh.clone()).expect("a disk");
    let program = Program::new();
    let path = program.write("in.obj", &super::program::obj_text(&super::program::polygons_of(&disk)));
    let model = Model::read(&path, Preparation::default()).expect("it was written just now");
    let outcome = outcome_with(&disk, places);
    let was_planar = outcome.step.verdict.planar;
    let finished = model.finished(&outcome, Vec::new(), Fit::Unit);
    (was_planar, finished.report.placement.expect("there are coordinates"), finished.charts[0].verdict.planar)
}

#[test]
fn what_the_unit_square_would_fold_is_written_where_it_was_solved() {
    // A square around the origin so small that adding half the extent destroys its shape.
    let mesh = grid(3, 3);
    let mut places: Embedding = mesh.positions.iter().map(|p| p.truncate() - DVec2::splat(1.0)).collect();
    // Vertices 5, 6, 9 and 10 are the corners of the square in the middle.
    for (vertex, place) in [(5, [-1e-18, -1e-18]), (6, [1e-18, -1e-18]), (9, [-1e-18, 1e-18]), (10, [1e-18, 1e-18])] {
        places[vertex] = DVec2::from(place);
    }
    let mut square = places.clone();
    to_unit_square(&mut square);
    let disk = DiskMesh::try_from(mesh.clone()).unwrap();
    assert!(!verdict(&disk, &square).planar, "the case is one");
    assert_eq!(finish(&mesh, places), (true, Placement::Unmoved, true));
}

#[test]
fn what_the_division_would_fold_is_scaled_by_a_power_of_two() {
    // The centre is next to the side from (0, 0) to (3, 3), above it by one digit, which a division by 3 may
    // destroy.
    let mesh = fan(3);
    let disk = DiskMesh::try_from(mesh.clone()).unwrap();
    let mut found = 0;
    for k in 1..200 {
        let x = f64::from(k) / 64.0;
        let corners = [DVec2::new(x, x.next_up()), DVec2::ZERO, DVec2::new(3.0, 3.0), DVec2::new(0.0, 3.0)];
        let places = Embedding::from(corners.to_vec());
        let mut square = places.clone();
        to_unit_square(&mut square);
        if !verdict(&disk, &places).planar || verdict(&disk, &square).planar {
            continue;
        }
        found += 1;
        assert_eq!(finish(&mesh, places), (true, Placement::Unit, true), "{x}");
    }
    assert!(found > 3, "{found} cases");
}
