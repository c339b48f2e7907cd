//! `freebound flatten` as a script uses it: exit status, messages, files, report.

use std::collections::BTreeSet;
use std::fs;

use freebound::examples::Example;
use freebound_core::mesh::PolygonMesh;
use freebound_io::read_mesh;
use serde_json::Value;

use super::program::{Program, argument, coordinates_by_vertex, example_file, obj_text};
use freebound_testkit::{assert_message, corpus_entry, corpus_test, grid, manifest};

/// Exit status of `flatten` and of `check` for each file of `corpus/bad`, and a name in the error's report of each.
const BAD: [(&str, i32, i32, &str, &str); 14] = [
    ("closed_fish.obj", 3, 3, "closed", "closed"),
    ("nonmanifold_ArtDemo.obj", 3, 3, "non-manifold-edges", "non-manifold-edges"),
    ("multicomp.obj", 3, 3, "several-components", "several-components"),
    ("holes_plane.obj", 0, 0, "", ""),
    ("degenerate_capsule.obj", 0, 0, "", ""),
    ("moebius.obj", 3, 3, "non-orientable", "non-orientable"),
    ("torus_one_hole.obj", 3, 3, "handles", "handles"),
    ("raw_nancolor.obj", 3, 3, "closed", "closed"),
    // Its texture coordinates form charts, and `check` examines the mesh cut along their seams.
    ("raw_negative_indices.obj", 3, 4, "closed", ""),
    ("raw_empty.obj", 3, 3, "no-faces", "no-faces"),
    ("raw_notenoughindices.obj", 0, 0, "", ""),
    ("raw_polygonfaces.obj", 0, 0, "", ""),
    ("raw_joined_tetrahedra.obj", 3, 3, "non-manifold-edges", "non-manifold-edges"),
    ("raw_corrupted_invalid_double.off", 3, 3, "line 4", "line 4"),
];

/// All outputs, each by its option.
const ALL_OUTPUTS: [&str; 8] = ["-o", "out.obj", "--svg", "out.svg", "--png", "out.png", "--report", "out.json"];

/// Names in the error of the report `out.json`: its kind, then the kinds of its faults, each with its line.
fn names_of_error(program: &Program) -> Vec<String> {
    let report: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
    let Some(kind) = report["error"]["kind"].as_str() else { return Vec::new() };
    let faults = report["error"]["faults"].as_array().unwrap().iter();
    let of_fault = |fault: &Value| {
        let kind = fault["kind"].as_str().unwrap();
        fault["line"].as_u64().map_or_else(|| kind.to_owned(), |line| format!("{kind} {line}"))
    };
    std::iter::once(kind.to_owned()).chain(faults.map(of_fault)).collect()
}

/// Asserts that the error of the report `out.json` has this name, or that there is none for the empty name.
#[track_caller]
fn assert_named(program: &Program, file: &str, name: &str) {
    let names = names_of_error(program);
    assert_eq!(names.is_empty(), name.is_empty(), "{file}: {names:?}");
    assert!(name.is_empty() || names.iter().any(|other| other == name), "{file}: {names:?}");
}

corpus_test! {
    fn every_bad_file_ends_as_the_table_says_and_leaves_its_report_alone() {
        for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
            let name = entry.file.trim_start_matches("bad/");
            let (_, flatten, check, of_flatten, of_check) =
                BAD.iter().find(|row| row.0 == name).expect("the table has every bad file");
            let program = Program::new();
            let path = argument(&entry.path);
            program.run(&[&["flatten", path][..], &ALL_OUTPUTS].concat()).expect(*flatten);
            assert_named(&program, name, of_flatten);
            let written: &[&str] =
                if *flatten == 0 { &["out.json", "out.obj", "out.png", "out.svg"] } else { &["out.json"] };
            assert_eq!(program.files(), written, "{name}");
            let program = Program::new();
            let run = program.run(&["check", path, "--report", "out.json"]).expect(*check);
            assert_named(&program, name, of_check);
            assert_eq!(program.files(), ["out.json"], "{name}");
            if *check == 3 {
                assert_eq!(run.stdout, "", "{name}: nothing to say but the fault");
            }
        }
    }
}

#[test]
fn where_areas_of_a_planar_map_differ_a_hundred_times_the_summary_offers_to_relax() {
    let program = Program::new();
    // A sheet with a tall hill: its natural map crowds the top.
    let mut hill = grid(24, 24);
    for x in &mut hill.positions {
        x.z = 24.0 * (-0.03 * ((x.x - 12.0).powi(2) + (x.y - 12.0).powi(2))).exp();
    }
    program.write("hill.obj", &obj_text(&PolygonMesh::from(&hill)));
    let natural = program.run(&["flatten", "hill.obj", "--relax", "0", "-o", "out.obj"]).expect(0);
    let offer = natural.stdout.lines().find(|line| line.contains("--relax")).expect("an offer");
    assert_message("flatten-offers-to-relax", offer);
    let relaxed = program.run(&["flatten", "hill.obj", "--relax", "20", "-o", "relaxed.obj"]).expect(0);
    assert!(!relaxed.stdout.contains("--relax"), "{}", relaxed.stdout);
}

corpus_test! {
    fn a_mesh_that_comes_out_planar_ends_with_0_and_a_folded_one_with_4() {
        for entry in ["cathead.obj", "cow_seamster.obj"].map(corpus_entry) {
            let planar = entry.file == "cathead.obj";
            let program = Program::new();
            let path = argument(&entry.path);
            let arguments = ["flatten", path, "--method", "natural", "-o", "out.obj", "--report", "out.json"];
            program.run(&arguments).expect(if planar { 0 } else { 4 });
            let report: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
            assert_eq!(report["verdict"]["planar"], planar, "{}", entry.file);
            let crossings = report["verdict"]["boundary_crossings"].as_array().unwrap();
            assert_eq!(crossings.is_empty(), planar, "{}", entry.file);
            assert_eq!(program.files(), ["out.json", "out.obj"], "a result that is not planar is written all the same");
        }
    }
}

#[test]
fn wrong_use_ends_with_2_and_says_what_to_do() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases: [(&[&str], &str); 42] = [
        (&["--family", "uniform"], "Convex boundary"),
        (&["--family", "power:x"], "power:P"),
        (&["--method", "best"], "natural"),
        (&["--pin", "99999:0,0"], "99999"),
        (&["--pin", "0"], "VERTEX:U,V"),
        (&["--aspect", "wide"], "WIDTH:HEIGHT"),
        (&["--aspect", "1:1", "--picture", "x.png"], "--picture"),
        (&["--aspect", "2:1", "--fit", "true"], "--fit"),
        (&["--method", "convex", "--constraints", "x.txt"], "--constraints"),
        (&["--svg-scale", "large"], "unit"),
        (&["--threads", "0"], "--threads"),
        (&["--threads", "many"], "--threads"),
        (&["--fit", "tight"], "unit"),
        (&["--boundary", "heart"], "circle"),
        (&["--method", "convex", "--pin", "0:0,0"], "convex"),
        (&["--method", "convex", "--treatment", "eliminate"], "--treatment"),
        (&["--treatment", "ignore"], "least-squares"),
        (&["--method", "natural", "--max-steps", "3"], "--max-steps"),
        (&["--method", "virtual-boundary", "--max-steps", "3"], "--max-steps"),
        (&["--max-steps=-1"], "--max-steps"),
        (&["--method", "iterate", "--growth", "one"], "--growth"),
        (&["--method", "levy", "--growth", "double"], "--growth"),
        (&["--growth", "two"], "double"),
        (&["--method", "relax"], "continuation"),
        (&["--method", "continuation", "--family", "mean-value"], "--family"),
        (&["--method", "matchmaker", "--no-new-vertices"], "--no-new-vertices"),
        (&["--method", "natural", "--no-new-vertices"], "--no-new-vertices"),
        (&["--boundary", "square"], "--boundary"),
        (&["--method", "lscm", "--family", "mean-value"], "--family"),
        (&["--method", "slim", "--boundary", "square"], "--boundary"),
        (&["--method", "natural", "--spacing", "even"], "--spacing"),
        (&["--method", "convex", "--layers", "2"], "--layers"),
        (&["--method", "lee", "--layers", "0"], "--layers"),
        (&["--method", "stretch", "--family", "uniform"], "--family"),
        (&["--method", "stretch", "--pin", "0:0,0"], "--pin"),
        (&["--method", "lee", "--max-steps", "3"], "--max-steps"),
        (&["--method", "convex", "--boundary", "polygon:missing.txt"], "missing.txt"),
        (&["--method", "spectral", "--family", "mean-value"], "--family"),
        (&["--method", "abf++", "--treatment", "weighted"], "--treatment"),
        (&["--method", "abf+"], "abf++"),
        (&["--steps"], "--steps"),
        (&["--unknown"], "--unknown"),
    ];
    for (options, word) in cases {
        let run = program.run(&[&["flatten", "in.obj"][..], options, &ALL_OUTPUTS].concat()).expect(2);
        assert!(run.stderr.contains(word), "{options:?}: {}", run.stderr);
        assert_eq!(program.files(), ["in.obj"], "{options:?}");
    }
    program.run(&["flatten"]).expect(2);
    program.run(&["check"]).expect(2);
}

#[test]
fn wrong_pins_and_corners_end_with_2_and_are_named() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases: [(&[&str], &str); 6] = [
        (&["--pin", "0:0,0", "--pin", "0:1,1"], "pinned-twice"),
        (&["--pin", "0:0,0", "--pin", "7:0,0"], "two-pins-in-one-place"),
        (&["--pin", "0:nan,0"], "target-not-finite"),
        (&["--pin", "0:1,1:0"], "weight-of-zero"),
        (&["--method", "convex", "--boundary", "polygon:0 0; 0 1; 1 0"], "clockwise-polygon"),
        (&["--method", "convex", "--boundary", "polygon:0 0; 2 0; 2 2; 1.5 1; 0 2"], "concave-polygon"),
    ];
    for (options, topic) in cases {
        let run = program.run(&[&["flatten", "in.obj"][..], options, &ALL_OUTPUTS].concat()).expect(2);
        assert_message(&format!("flatten-{topic}"), &run.stderr);
        assert_eq!(program.files(), ["in.obj"], "{options:?}");
    }
}

#[test]
fn a_square_of_three_boundary_vertices_is_wrong_use() {
    let program = Program::new();
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let run = program.run(&["flatten", "in.obj", "--method", "convex", "--boundary", "square"]).expect(2);
    assert_message("flatten-square-of-three-vertices", &run.stderr);
    program.run(&["flatten", "in.obj", "--method", "convex"]).expect(0);
}

#[test]
fn a_polygon_is_read_from_its_file_said_in_the_report_and_not_written_over() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.write("shape.txt", "# a kite\n0 0\n2, -1\n3 0\n\n2 1 # the last\n");
    let convex =
        ["flatten", "in.obj", "--method", "convex", "--family", "mean-value", "--boundary", "polygon:shape.txt"];
    let report = program.run(&[&convex[..], &["--report", "-"]].concat()).json();
    let shape = serde_json::json!({"outline": "polygon:0 0; 2 -1; 3 0; 2 1", "spacing": "chord"});
    assert_eq!((&report["shape"], &report["boundary"]), (&shape, &serde_json::json!("convex")));
    let run = program.run(&[&convex[..], &["--svg", "shape.txt"]].concat()).expect(2);
    assert_message("flatten-overwrites-the-polygon", &run.stderr);
    program.write("shape.txt", "0 0\n1 0\n1 x\n");
    let run = program.run(&convex).expect(2);
    assert_message("flatten-line-that-is-no-point", &run.stderr);
}

#[test]
fn a_missing_file_and_one_that_cannot_be_written_are_named() {
    let program = Program::new();
    let run = program.run(&["flatten", "nowhere.obj"]).expect(3);
    assert!(run.stderr.contains("nowhere.obj"), "{}", run.stderr);
    let run = program.run(&["check", "nowhere.obj"]).expect(3);
    assert!(run.stderr.contains("nowhere.obj"), "{}", run.stderr);
    example_file(&program, Example::Dome);
    let run = program.run(&["flatten", "in.obj", "-o", "no/such/folder/out.obj"]).expect(1);
    assert!(run.stderr.contains("no/such/folder/out.obj"), "{}", run.stderr);
    assert_eq!(program.files(), ["in.obj"]);
}

#[test]
fn the_report_says_what_was_done() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    let report = program.run(&["flatten", "in.obj", "--report", "-"]).expect(0).json();
    assert_eq!(report["freebound"], env!("CARGO_PKG_VERSION"));
    assert_eq!(report["mesh"]["path"], "in.obj");
    assert_eq!(report["mesh"]["vertices"], mesh.vertex_count());
    assert_eq!(report["mesh"]["faces"], mesh.face_count());
    assert_eq!(report["mesh"]["boundary_vertices"], mesh.boundary_loop().len());
    assert_eq!([&report["method"], &report["family"]], ["auto", "conformal"]);
    assert_eq!([&report["boundary"], &report["placement"]], ["free", "unit"]);
    assert_eq!(report["pins"]["count"], 0);
    assert_eq!(report["steps"].as_array().unwrap().len(), 1);
    assert_eq!(report["verdict"]["planar"], true);
    assert_eq!(report["verdict"]["turning_number"], 1);
    assert!(report["steps"][0]["residual"].as_f64().unwrap() <= 1e-10);
    assert!(report["seconds"]["total"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_report_in_a_file_is_the_report_on_standard_output() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let mut on_screen = program.run(&["flatten", "in.obj", "--report", "-"]).expect(0).json();
    program.run(&["flatten", "in.obj", "--report", "out.json"]).expect(0);
    let mut in_file: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
    for report in [&mut on_screen, &mut in_file] {
        forget_the_clock(report);
    }
    assert_eq!(on_screen, in_file);
}

/// Removes values that differ from run to run.
fn forget_the_clock(report: &mut Value) {
    report["seconds"] = Value::Null;
    report["peak_memory_bytes"] = Value::Null;
    for step in report["steps"].as_array_mut().expect("a list") {
        step["seconds"] = Value::Null;
    }
}

#[test]
fn the_same_run_writes_the_same_bytes_and_the_number_of_threads_changes_no_verdict() {
    let program = Program::new();
    example_file(&program, Example::Face);
    for family in ["conformal", "mean-value"] {
        let run = |threads: &str, out: &str| {
            let arguments = ["flatten", "in.obj", "--family", family, "--threads", threads, "-o", out, "--report", "-"];
            let mut report = program.run(&arguments).json();
            forget_the_clock(&mut report);
            (report, fs::read(program.path(out)).unwrap())
        };
        let [(one, text), (again, same_text), (two, _)] = [run("1", "a.obj"), run("1", "b.obj"), run("2", "c.obj")];
        assert_eq!(one, again);
        assert!(text == same_text, "{family}: the same run wrote other bytes");
        assert_eq!(one["verdict"], two["verdict"], "{family}");
        assert_eq!(one["mesh"], two["mesh"], "{family}");
        let read = |name| coordinates_by_vertex(&read_mesh(&program.path(name)).unwrap());
        let off = read("a.obj").iter().zip(&read("c.obj")).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off <= 1e-10, "{family}: the second thread moved a vertex by {off:e}");
    }
}

#[test]
fn all_methods_run_and_say_their_names() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases: [(&[&str], &str, Option<&str>); 23] = [
        (&["--method", "natural", "--family", "power:0.5"], "natural", Some("power:0.5")),
        (&["--method", "natural", "--family", "wachspress"], "natural", Some("wachspress")),
        (&[], "auto", Some("conformal")),
        (&["--method", "iterate", "--family", "mean-value"], "iterate", Some("mean-value")),
        (&["--method", "virtual-boundary", "--family", "power:0.5"], "virtual-boundary", Some("power:0.5")),
        (&["--method", "lscm"], "lscm", None),
        (&["--method", "levy"], "levy", None),
        (&["--method", "spectral"], "spectral", None),
        (&["--method", "abf"], "abf", None),
        (&["--method", "abf++"], "abf++", None),
        (&["--method", "convex"], "convex", Some("conformal")),
        (&["--method", "continuation"], "continuation", None),
        (&["--method", "matchmaker"], "matchmaker", None),
        (&["--method", "schnyder"], "schnyder", None),
        (&["--method", "convex", "--family", "uniform"], "convex", Some("uniform")),
        (&["--method", "convex", "--family", "shape-preserving"], "convex", Some("shape-preserving")),
        (&["--method", "convex", "--boundary", "square", "--family", "mean-value"], "convex", Some("mean-value")),
        (&["--method", "convex", "--boundary", "hull", "--spacing", "even"], "convex", Some("conformal")),
        (&["--method", "stretch", "--boundary", "hull", "--max-steps", "2"], "stretch", None),
        (&["--method", "slim"], "slim", None),
        (&["--method", "slim", "--max-steps", "3"], "slim", None),
        (&["--method", "lee"], "lee", Some("mean-value")),
        (&["--method", "lee", "--layers", "1", "--family", "uniform"], "lee", Some("uniform")),
    ];
    for (options, method, family) in cases {
        let run = program.run(&[&["flatten", "in.obj", "--report", "-"][..], options].concat());
        assert!(matches!(run.status, Some(0 | 4)), "{options:?}: {run:?}");
        let report = run.json();
        assert_eq!(report["method"], method, "{options:?}");
        assert_eq!(report.get("family").and_then(Value::as_str), family, "{options:?}");
        assert_eq!(report["verdict"]["planar"] == true, run.status == Some(0), "{options:?}");
    }
    let listed = program.run(&["methods"]).expect(0).stdout;
    let methods = [
        "auto",
        "natural",
        "iterate",
        "virtual-boundary",
        "convex",
        "lscm",
        "levy",
        "spectral",
        "abf",
        "abf++",
        "continuation",
        "matchmaker",
        "schnyder",
        "stretch",
        "slim",
        "lee",
    ];
    let families = ["conformal", "mean-value", "wachspress", "power:P", "uniform", "shape-preserving"];
    let names: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    for name in methods.iter().chain(&families) {
        assert!(names.contains(name), "{name} in {listed}");
    }
}

#[test]
fn without_a_screen_the_example_is_flattened_into_a_folder_that_is_named() {
    let program = Program::new();
    let run = program.run(&[]);
    assert_eq!(run.stderr.trim().lines().count(), 1, "one line says that there is no screen: {}", run.stderr);
    assert_eq!(program.files(), ["freebound-example"]);
    assert!(run.stdout.contains("freebound-example"), "{}", run.stdout);
    let folder = program.path("freebound-example");
    let names: BTreeSet<String> =
        fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(names, ["face-picture.png", "face.json", "face.mtl", "face.obj", "face.png"].map(str::to_owned).into());
    let report: Value = serde_json::from_slice(&fs::read(folder.join("face.json")).unwrap()).unwrap();
    assert_eq!(run.status, Some(0));
    assert_eq!(report["verdict"]["planar"], true);
    assert_eq!(report["pins"]["count"], Example::Face.landmarks().len());
    assert_eq!([&report["pins"]["max_hard_error"], &report["steps"][0]["planar"]], [&0.0.into(), &Value::Bool(false)]);
    program.run(&["check", "freebound-example/face.obj"]).expect(0);
}
