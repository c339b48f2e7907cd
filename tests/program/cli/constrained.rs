//! Constrained problems of the corpus, and constraints on the command line.

use std::fs;
use std::path::Path;

use freebound::examples::Example;
use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Pins, Settings, Stage};
use freebound_io::read_mesh;
use glam::DVec2;
use serde_json::Value;

use super::program::{Program, argument, coordinates_by_vertex, example_file};
use freebound_testkit::{assert_message, corpus, corpus_test};

/// Constraint sets with their meshes.
const SETS: [(&str, &str); 9] = [
    ("fran_face_k6", "fran_face"),
    ("fran_face_k20", "fran_face"),
    ("cow_seamster_k6", "cow_seamster"),
    ("cow_seamster_k16", "cow_seamster"),
    ("ict_face_neutral_lm10", "ict_face_neutral"),
    ("ict_face_neutral_lm68", "ict_face_neutral"),
    ("maze_k4", "maze"),
    ("maze_k12", "maze"),
    ("cortex_conte69_R_k10", "cortex_conte69_R"),
];

/// Targets of a constraint file, parsed without the reader under test.
fn targets(text: &str) -> Vec<(usize, DVec2)> {
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().map(|word| word.parse().unwrap()).collect() };
    let lines = text.lines().map(numbers).filter(|numbers| !numbers.is_empty());
    let vertex = |number: f64| (0..1 << 20).find(|&v: &usize| v as f64 == number).expect("a whole number");
    lines.map(|numbers| (vertex(numbers[0]), DVec2::new(numbers[1], numbers[2]))).collect()
}

/// Flattens the sets whose names begin with one of `words`; there must be `count`.
fn flatten_sets(words: &[&str], count: usize) {
    let folder = corpus();
    let chosen: Vec<_> = SETS.iter().filter(|(set, _)| words.iter().any(|word| set.starts_with(*word))).collect();
    assert_eq!(chosen.len(), count, "{words:?}");
    for (set, mesh) in chosen {
        flatten_set(&folder, set, mesh);
    }
}

/// Flattens one set with the program. Asserts that it is planar with exactly met constraints, and that the report
/// agrees with `check` and the file.
fn flatten_set(folder: &Path, set: &str, mesh: &str) {
    let [mesh, file] = [format!("{mesh}.obj"), format!("constrained/{set}.txt")].map(|name| folder.join(name));
    let program = Program::new();
    let arguments = ["flatten", argument(&mesh), "--constraints", argument(&file), "-o", "out.obj", "--report", "-"];
    let run = program.run(&arguments);
    let report = run.json();
    assert_eq!(run.status, Some(0), "{set}: {} not met, {}", report["pins"]["unmet"], report["verdict"]);
    let targets = targets(&fs::read_to_string(&file).unwrap());
    let written = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    let bits = |z: DVec2| z.to_array().map(f64::to_bits);
    for &(vertex, target) in &targets {
        assert_eq!(bits(written[vertex]), bits(target), "{set}: vertex {vertex}");
    }
    let pins = &report["pins"];
    assert_eq!(pins["count"], targets.len(), "{set}");
    assert_eq!([&pins["max_error"], &pins["max_hard_error"]], [0.0, 0.0], "{set}");
    assert_eq!(pins["soft"].as_array().unwrap().len(), 0, "{set}");
    assert_eq!(pins["unmet"].as_array().unwrap().len(), 0, "{set}");
    assert_eq!(report["verdict"]["planar"], true, "{set}: {}", report["verdict"]);
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["verdict"], report["verdict"], "{set}");
    let [new, last] = [&report["new_vertices"], report["steps"].as_array().unwrap().last().unwrap()];
    // Meshes with a planar published map and a simple boundary need no new vertices.
    let needs_none = ["maze", "fran_face", "cow_seamster"].iter().any(|mesh| set.starts_with(mesh));
    assert!(*new == 0 || !needs_none, "{set}: {new} new vertices");
    println!("{set}: {} pins, step {} ({}), {new} new vertices", targets.len(), last["index"], last["stage"]);
}

corpus_test! {
    fn the_corpus_has_all_nine_sets_with_their_meshes() {
        let folder = corpus();
        for (set, mesh) in SETS {
            let [mesh, file] = [format!("{mesh}.obj"), format!("constrained/{set}.txt")].map(|name| folder.join(name));
            let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            assert!(mesh.is_file(), "{}", mesh.display());
            // The name ends with the number of constraints: "_k6", "_lm10".
            let number = set.rsplit(['k', 'm']).next().unwrap();
            assert_eq!(targets(&text).len().to_string(), number, "{set}");
        }
    }
}

corpus_test! {
    fn the_sets_of_the_faces_end_planar_and_met_to_the_last_bit() {
        flatten_sets(&["fran_face", "ict_face"], 4);
    }
}

corpus_test! {
    fn the_sets_of_the_maze_and_the_cow_end_planar_and_met_to_the_last_bit() {
        flatten_sets(&["maze", "cow"], 4);
    }
}

corpus_test! {
    #[ignore = "half a minute without optimization: cargo test --release --test core the_set_of_the_cortex -- --ignored"]
    fn the_set_of_the_cortex_ends_planar_and_met_to_the_last_bit() {
        flatten_sets(&["cortex"], 1);
    }
}

/// Three corners of a face of the dome, to be flipped.
fn turned_over(mesh: &DiskMesh) -> [u32; 3] {
    let face = mesh.faces().find(|&f| mesh.face(f).iter().all(|&v| mesh.boundary_place(v).is_none()));
    mesh.face(face.expect("an inner face")).map(VertexId::number)
}

#[test]
fn constraints_that_contradict_each_other_are_named_beforehand_and_without_new_vertices_afterwards_too() {
    let program = Program::new();
    let [a, b, c] = turned_over(&example_file(&program, Example::Dome));
    program.write("turned.txt", &format!("{a} 0 0\n{b} 0 1\n{c} 1 0\n"));
    let turned = ["flatten", "in.obj", "--constraints", "turned.txt", "--no-new-vertices", "-o", "out.obj"];
    let run = program.run(&turned).expect(4);
    assert!(run.stderr.contains(&format!("v{a}, v{b}, v{c}:")), "{}", run.stderr);
    let report = program.run(&[&turned[..], &["--report", "-"]].concat()).expect(4).json();
    assert_eq!(report["verdict"]["planar"], true, "the best planar embedding: {}", report["verdict"]);
    let unmet = report["pins"]["unmet"].as_array().unwrap();
    assert!(!unmet.is_empty() && unmet.iter().all(|v| [a, b, c].iter().any(|w| v == w)), "{unmet:?}");
    let names: Vec<String> = unmet.iter().map(|v| format!("v{v}")).collect();
    let listed = run.stdout.lines().find(|line| line.starts_with("constraints:")).expect("a line on the constraints");
    assert!(listed.ends_with(&names.join(", ")), "{listed}");
    assert!(report["pins"]["max_hard_error"].as_f64().unwrap() > 0.0);
    assert_eq!(report["new_vertices"], 0);
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["verdict"]["planar"], true, "what is written is planar");
}

#[test]
fn a_step_of_continuation_has_its_own_numbers_and_no_residual() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["flatten", "in.obj", "-o", "flat.obj"]).expect(0);
    let free = coordinates_by_vertex(&read_mesh(&program.path("flat.obj")).unwrap());
    // Four vertices at their unconstrained positions, except one that is moved a little.
    let moved = |v: usize| if v == 3 { free[v] + DVec2::new(0.03, 0.02) } else { free[v] };
    let lines: Vec<String> =
        [3, 40, 11, 25].iter().map(|&v| format!("{v} {:?} {:?}", moved(v).x, moved(v).y)).collect();
    program.write("four.txt", &lines.join("\n"));
    let arguments = ["flatten", "in.obj", "--constraints", "four.txt", "--method", "continuation", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    let steps = report["steps"].as_array().unwrap();
    let relaxed = steps.last().unwrap();
    let last = steps.iter().rfind(|step| step["stage"] == "continuation").unwrap();
    assert_eq!([&last["planar"], &relaxed["planar"]], [&Value::Bool(true); 2]);
    assert!(relaxed["stage"] == "relax" && relaxed["energy"].as_f64() < last["energy"].as_f64(), "{relaxed}");
    assert_eq!([&last["residual"], &last["equation_residual"], &relaxed["residual"]], [&Value::Null; 3]);
    assert!(last["energy"].as_f64().unwrap() > 2.0 && last["least_determinant"].as_f64().unwrap() > 0.0, "{last}");
    assert_eq!(last["distance_left"], 0.0);
    let summary = program.run(&arguments[..arguments.len() - 2]).expect(0).stdout;
    let of_method = summary.lines().find(|line| line.starts_with("continuation:")).expect("a line on the method");
    assert!(of_method.contains(&format!("({})", Stage::Relax.words())), "{of_method}");
}

/// Four landmarks of the dome, as lines of a file.
const FOUR: &str = "# vertex u v\n3 0.1 0.1\n\n40 0.9 0.2 # lower right\n11 0.8 0.9\n25 0.2 0.8\n";

#[test]
fn a_file_and_options_give_the_same_bytes() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.write("four.txt", FOUR);
    program.run(&["flatten", "in.obj", "--constraints", "four.txt", "-o", "file.obj"]);
    let pins = ["3:0.1,0.1", "40:0.9,0.2", "11:0.8,0.9", "25:0.2,0.8"].map(|pin| ["--pin", pin]).concat();
    program.run(&[&["flatten", "in.obj", "-o", "options.obj"][..], &pins].concat());
    let [a, b] = ["file.obj", "options.obj"].map(|name| fs::read(program.path(name)).unwrap());
    assert!(a == b);
}

#[test]
fn a_constraint_file_at_fault_ends_with_3_and_names_the_line() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases = [
        ("3 0.1\n", 1),
        ("# x\n3 0.1 0.1\n3 0.2 0.2\n", 3),
        ("3 0.1 0.1\n4 0.1 0.1\n", 2),
        ("3 0.1 nan\n", 1),
        ("\n99999 0.1 0.2\n", 2),
        ("3 0.1 0.1 -2\n", 1),
        ("3 0.1 x\n", 1),
    ];
    let arguments = ["flatten", "in.obj", "--constraints", "bad.txt", "-o", "out.obj", "--report", "-"];
    for (text, line) in cases {
        program.write("bad.txt", text);
        let run = program.run(&arguments).expect(3);
        let error = &run.json()["error"];
        assert_eq!(error["kind"], "constraints", "{text:?}");
        assert_eq!(error["faults"][0]["line"], line, "{text:?}: {error}");
        assert!(run.stderr.starts_with("freebound: bad.txt: "), "{text:?}: {}", run.stderr);
        assert_eq!(program.files(), ["bad.txt", "in.obj"], "{text:?}");
    }
    let run = program.run(&["flatten", "in.obj", "--constraints", "gone.txt"]).expect(3);
    assert!(run.stderr.contains("gone.txt"), "{}", run.stderr);
}

#[test]
fn an_option_that_clashes_with_the_file_ends_with_2_and_names_the_line() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.write("four.txt", FOUR);
    for (pin, topic) in [("11:0.5,0.5", "one-vertex"), ("7:0.9,0.2", "one-target")] {
        let arguments = ["flatten", "in.obj", "--constraints", "four.txt", "--pin", pin, "-o", "out.obj"];
        let run = program.run(&arguments).expect(2);
        assert_message(&format!("constrained-{topic}-in-file-and-option"), &run.stderr);
        assert_eq!(program.files(), ["four.txt", "in.obj"]);
    }
    let run = program.run(&["flatten", "in.obj", "--method", "convex", "--constraints", "four.txt"]).expect(2);
    assert!(run.stderr.contains("--constraints"), "{}", run.stderr);
    program.run(&["flatten", "in.obj", "--constraints", "four.txt", "--pin", "7:0.9,0.2:1", "--report", "-"]);
}

#[test]
fn the_report_lists_what_weights_make_of_each_soft_constraint() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.write("mixed.txt", "3 0.1 0.1\n40 0.9 0.2\n11 0.8 0.9 0.5\n25 0.1 0.6 0.25\n");
    // A single solve: the iteration would change the equations until they agree with the constraints.
    let natural = ["flatten", "in.obj", "--constraints", "mixed.txt", "--method", "natural"];
    let run = program.run(&[&natural[..], &["-o", "out.obj", "--report", "-"]].concat());
    let pins = &run.json()["pins"];
    let written = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    assert_eq!([&pins["count"], &pins["max_hard_error"]], [4.0, 0.0]);
    let listed = pins["soft"].as_array().unwrap();
    assert_eq!(listed.len(), 2);
    let mut largest = 0.0_f64;
    for (entry, (vertex, weight, target)) in listed.iter().zip([(11_u32, 0.5, [0.8, 0.9]), (25, 0.25, [0.1, 0.6])]) {
        assert_eq!([&entry["vertex"], &entry["weight"]], [f64::from(vertex), weight]);
        let error = written[vertex as usize].distance(target.into());
        assert_eq!(entry["error"], error, "vertex {vertex}");
        assert!(error > 1e-6, "a weight does not hold vertex {vertex} exactly");
        largest = largest.max(error);
    }
    assert_eq!([&pins["max_soft_error"], &pins["max_error"]], [largest; 2]);
    let summary = program.run(&natural).stdout;
    let line = summary.lines().find(|line| line.starts_with("constraints:")).expect("a line on the constraints");
    let (met, _) = line.split_once(" within ").expect("an error of the soft ones");
    assert_message("constrained-hard-and-soft", met);
}

#[test]
fn weighted_treatment_holds_nothing_exactly() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.write("four.txt", FOUR);
    let natural = ["flatten", "in.obj", "--constraints", "four.txt", "--method", "natural"];
    let arguments = [&natural[..], &["--treatment", "weighted", "--report", "-"]].concat();
    let pins = program.run(&arguments).json()["pins"].clone();
    assert_eq!([&pins["treatment"], &pins["count"]], [&serde_json::json!("weighted"), &serde_json::json!(4)]);
    assert!(pins.get("max_hard_error").is_none() && pins["max_soft_error"].as_f64().unwrap() > 0.0, "{pins}");
    assert_eq!(pins["soft"].as_array().unwrap().len(), 4);
}

#[test]
fn angles_are_kept_on_a_picture_of_any_aspect_and_targets_to_the_last_bit() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Ell);
    // The L is flat: three of its vertices at their own positions on a 3:1 picture leave no distortion.
    let aspect = 3.0;
    let place = |v: usize| mesh.mesh().positions[v].truncate() * 0.1 / DVec2::new(aspect, 1.0);
    let pins: Vec<String> = [0, 20, 90].iter().map(|&v| format!("{v}:{:?},{:?}", place(v).x, place(v).y)).collect();
    let pins: Vec<&str> = pins.iter().flat_map(|pin| ["--pin", pin.as_str()]).collect();
    let arguments = [&["flatten", "in.obj", "--aspect", "3:1", "-o", "out.obj", "--report", "-"][..], &pins].concat();
    let report = program.run(&arguments).expect(0).json();
    assert!((report["distortion"]["angle"]["max"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{}", report["distortion"]);
    let written = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    for v in [0, 20, 90] {
        assert_eq!(written[v].to_array().map(f64::to_bits), place(v).to_array().map(f64::to_bits));
    }
    let off = (0..written.len()).map(|v| written[v].distance(place(v))).fold(0.0, f64::max);
    assert!(off < 1e-9, "{off:e}");
    let square = program.run(&[&["flatten", "in.obj", "--report", "-"][..], &pins].concat()).json();
    assert!(square["distortion"]["angle"]["max"].as_f64().unwrap() > 1.1, "without the aspect it is distorted");
}

#[test]
fn an_embedding_without_pins_lies_within_the_picture() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let arguments = ["flatten", "in.obj", "--aspect", "2:1", "-o", "out.obj", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(report["placement"], "picture");
    let written = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    let low = written.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = written.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    // A dome is round: half as wide in u as in v on a picture twice as wide as high.
    assert!(low.min_element() >= -1e-12 && high.max_element() <= 1.0 + 1e-12, "{low} {high}");
    assert!((high.y - low.y - 1.0).abs() < 1e-9 && (high.x - low.x) < 0.7, "{low} {high}");
    let run = program.run(&["flatten", "in.obj", "--aspect", "2:1", "--fit", "true"]).expect(2);
    assert!(run.stderr.contains("--fit"), "{}", run.stderr);
}

/// Steps of the built-in face with its landmarks, by the default method.
fn face_steps() -> (DiskMesh, Pins, Vec<Step>) {
    let mesh = DiskMesh::try_from(Example::Face.mesh()).unwrap();
    let landmarks = Example::Face.landmarks();
    let pins = freebound_core::problem::hard_pins(landmarks.iter().map(|l| (l.vertex, DVec2::from(l.target))));
    let mut steps = Vec::new();
    let mut run = Flattener::new(Settings::default(), pins.clone());
    run.finish(&mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    (mesh, pins, steps)
}

#[test]
fn the_face_folds_in_the_first_solve_and_a_few_iterations_repair_it() {
    let (_, pins, steps) = face_steps();
    assert!((8..=12).contains(&pins.len()));
    let flips: Vec<usize> = steps.iter().map(|step| step.verdict.flipped_faces.len()).collect();
    assert!(flips[0] >= 4, "the folds can be seen: {flips:?}");
    assert!(steps[0].has_simple_boundary(), "nothing but flipped faces is wrong");
    assert!((2..=6).contains(&(steps.len() - 1)), "{flips:?}");
    assert!(steps.last().unwrap().verdict.planar, "{flips:?}");
    for step in &steps {
        for (vertex, pin) in &pins {
            assert_eq!(step.candidate.solution.embedding[vertex], pin.target, "step {}: {vertex}", step.index);
        }
    }
}
