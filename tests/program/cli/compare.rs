//! `freebound compare`: several methods on one mesh, as a script uses it.

use std::collections::BTreeSet;
use std::fs;

use freebound::examples::Example;
use freebound_core::problem::{Method, NamedOption};
use freebound_io::Column;
use serde_json::Value;

use super::program::{Program, example_file};
use super::report_schema::TENT;
use freebound_testkit::{assert_message, csv_rows};

/// Three pins of a tent, which act as constraints.
const PINS: [&str; 6] = ["--pin", "0:0,0", "--pin", "1:1,0.2", "--pin", "2:0.9,1"];

/// File of an example's mesh.
pub(crate) const IN: &str = "in.obj";

pub(crate) fn tent() -> Program {
    let program = Program::new();
    program.write("tent.obj", TENT);
    program
}

/// Methods of a comparison, from its report.
pub(crate) fn methods(program: &Program, arguments: &[&str]) -> Vec<Value> {
    let report = program.run(&[&["compare"], arguments, &["--report", "-"]].concat()).expect(0).json();
    report["methods"].as_array().expect("a list").clone()
}

pub(crate) fn names(methods: &[Value]) -> Vec<&str> {
    methods.iter().map(|method| method["name"].as_str().expect("a name")).collect()
}

/// Verdict of `flatten`'s report with lists replaced by their counts.
fn counted(verdict: &Value) -> Value {
    let mut counts = verdict.clone();
    let fields = counts.as_object_mut().expect("an object");
    for (_, field) in fields.iter_mut() {
        if let Some(list) = field.as_array() {
            *field = Value::from(list.len());
        }
    }
    fields.remove("zero_area_faces");
    fields.entry("more_crossings").or_insert(Value::Bool(false));
    counts
}

/// Step without its seconds.
fn timeless(step: &Value) -> Value {
    let mut step = step.clone();
    step.as_object_mut().expect("an object").remove("seconds");
    step
}

#[test]
fn each_method_comes_out_as_it_does_by_itself() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let compared = methods(&program, &[IN]);
    assert!(compared.len() >= 8, "{:?}", names(&compared));
    for method in compared {
        let name = method["method"].as_str().expect("a name").to_owned();
        let run = program.run(&["flatten", IN, "--method", &name, "--fit", "true", "--report", "-"]);
        assert!(matches!(run.status, Some(0 | 4)), "{run:#?}");
        let alone = run.json();
        let result = &method["result"];
        assert_eq!(result["verdict"], counted(&alone["verdict"]), "{name}");
        for field in ["distortion", "boundary", "new_vertices", "pins"] {
            assert_eq!(result[field], alone[field], "{field} of {name}");
        }
        let steps: Vec<Value> = method["steps"].as_array().unwrap().iter().map(|of| timeless(&of["step"])).collect();
        let alone: Vec<Value> = alone["steps"].as_array().unwrap().iter().map(timeless).collect();
        assert_eq!(steps, alone, "{name}");
    }
}

#[test]
fn without_a_list_all_methods_run_that_have_something_to_do() {
    let program = tent();
    let free = methods(&program, &["tent.obj"]);
    let named = |name: &str| Method::named(name).expect("a method");
    let all: Vec<Method> = names(&free).into_iter().map(named).collect();
    let wanted: Vec<Method> = Method::ALL.iter().filter(|method| !method.only_meets_constraints()).cloned().collect();
    assert_eq!(all, wanted);
    let constrained = methods(&program, &[&["tent.obj"][..], &PINS].concat());
    let all: Vec<Method> = names(&constrained).into_iter().map(named).collect();
    let wanted: Vec<Method> = Method::ALL.iter().filter(|method| method.takes_constraints()).cloned().collect();
    assert_eq!(all, wanted);
    assert!(constrained.iter().all(|method| method["result"]["pins"]["count"] == 3));
}

#[test]
fn the_table_of_steps_has_its_head_where_no_method_took_one() {
    let program = tent();
    let steps = |list: &str| {
        let arguments = [&["compare", "tent.obj", "--methods", list, "--steps-csv", "-"], &PINS[..]].concat();
        csv_rows(&program.run(&arguments).expect(0).stdout)
    };
    let (none, some) = (steps("virtual-boundary"), steps("natural"));
    assert!(some.len() > 1);
    assert_eq!(none, some[..1]);
}

#[test]
fn the_table_is_sorted_as_asked_and_the_same_numbers_stand_in_the_file() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let list = "natural,convex/uniform,auto,convex/mean-value@square";
    let run = program.run(&["compare", IN, "--methods", list, "--sort", "energy"]).expect(0);
    let lines: Vec<&str> = run.stdout.lines().collect();
    let heads: Vec<&str> = Column::ALL.iter().map(|column| column.labels().title).collect();
    let head = lines.iter().position(|line| line.starts_with(heads[0])).expect("a head");
    assert!(heads.iter().all(|title| lines[head].contains(title)), "{}", lines[head]);
    let end = lines[head].chars().count();
    let rows = &lines[head + 1..head + 5];
    assert!(rows.iter().all(|row| row.chars().count() == end), "the last column ends at the right:\n{}", run.stdout);

    program
        .run(&["compare", IN, "--methods", list, "--sort", "energy", "--csv", "t.csv", "--report", "r.json"])
        .expect(0);
    let csv = csv_rows(&fs::read_to_string(program.path("t.csv")).unwrap());
    let at = |head: &str| csv[0].iter().position(|other| other == head).expect("a column");
    let energies: Vec<f64> = csv[1..].iter().map(|row| row[at("energy")].parse().unwrap()).collect();
    assert!(energies.is_sorted() && energies.len() == 4, "{energies:?}");
    let in_table: Vec<&str> = rows.iter().map(|row| row.split_whitespace().next().unwrap()).collect();
    let in_file: Vec<&str> = csv[1..].iter().map(|row| row[0].as_str()).collect();
    assert_eq!(in_table, in_file);
    let report: Value = serde_json::from_str(&fs::read_to_string(program.path("r.json")).unwrap()).unwrap();
    let reported = report["methods"].as_array().unwrap();
    assert_eq!(names(reported), list.split(',').collect::<Vec<_>>(), "a report has them as they were asked for");
    for row in &csv[1..] {
        let method = reported.iter().find(|method| method["name"] == row[0].as_str()).expect("the same methods");
        let distortion = &method["result"]["distortion"];
        for (head, number) in [
            ("angle", &distortion["angle"]["mean"]),
            ("angle_p99", &distortion["angle"]["p99"]),
            ("area", &distortion["area"]["mean"]),
            ("stretch_l2", &distortion["stretch_l2"]),
            ("stretch_linf", &distortion["stretch_linf"]),
            ("energy", &distortion["symmetric_dirichlet"]["mean"]),
        ] {
            assert_eq!(row[at(head)].parse::<f64>().unwrap(), number.as_f64().unwrap(), "{head}");
        }
        assert_eq!(row[at("flips")], method["result"]["verdict"]["flipped_faces"].to_string());
        assert_eq!(row[at("planar")], method["result"]["verdict"]["planar"].to_string());
        assert_eq!(row[at("ending")], method["ending"].as_str().unwrap());
    }
}

#[test]
fn the_steps_of_a_method_are_a_curve_over_time() {
    let program = Program::new();
    example_file(&program, Example::Cube);
    let arguments = ["compare", IN, "--methods", "natural,schnyder", "--steps-csv", "steps.csv"];
    program.run(&arguments).expect(0);
    let rows = csv_rows(&fs::read_to_string(program.path("steps.csv")).unwrap());
    let at = |head: &str| rows[0].iter().position(|other| other == head).expect("a column");
    let [method, elapsed, energy, stage] = ["method", "elapsed", "energy", "stage"].map(at);
    assert_eq!(rows[0].iter().collect::<BTreeSet<_>>().len(), rows[0].len(), "every column has a head of its own");
    for name in ["natural", "schnyder"] {
        let of: Vec<&Vec<String>> = rows[1..].iter().filter(|row| row[method] == name).collect();
        let times: Vec<f64> = of.iter().map(|row| row[elapsed].parse().unwrap()).collect();
        assert!(times[0] > 0.0 && times.windows(2).all(|pair| pair[0] < pair[1]), "{name}: {times:?}");
        let relaxed: Vec<f64> =
            of.iter().filter(|row| row[stage] == "relax").map(|row| row[energy].parse().unwrap()).collect();
        assert!(relaxed.last() <= relaxed.first(), "{name}: {relaxed:?}");
        assert_eq!(relaxed.is_empty(), name == "natural");
    }
}

#[test]
fn a_method_that_fails_is_named_and_the_others_go_on() {
    let program = tent();
    let list = ["--methods", "virtual-boundary,natural"];
    let arguments = [&["compare", "tent.obj"], &list[..], &PINS].concat();
    let run = program.run(&arguments).expect(0);
    assert!(run.stdout.contains("too-many-pins"), "{}", run.stdout);
    let reason = run.stdout.lines().find(|line| line.starts_with("virtual-boundary:")).expect("a reason");
    assert_message("compare-too-many-pins", reason);
    let compared = methods(&program, &arguments[1..]);
    assert_eq!(compared[0]["ending"], "failed");
    assert_eq!(compared[0]["error"]["kind"], "too-many-pins");
    assert!(compared[0].get("result").is_none() && compared[1].get("error").is_none());
    assert_ne!(compared[1]["ending"], "failed");
}

#[test]
fn one_chart_of_several_is_compared() {
    let program = Program::new();
    let two = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf 1 2 3\nf 1 3 4\nf 5 6 7\n";
    program.write("two.obj", two);
    let of = |arguments: &[&str]| {
        let all = [&["compare", "two.obj", "--methods", "natural"], arguments, &["--report", "-"]].concat();
        program.run(&all).expect(0).json()
    };
    assert_eq!(of(&[])["chart"], serde_json::json!({"number": 0, "of": 2}));
    assert_eq!(of(&[])["mesh"]["faces"], 2);
    assert_eq!(of(&["--chart", "1"])["mesh"]["faces"], 1);
    // A pin uses the vertex number of the file.
    let pinned = of(&["--chart", "1", "--pin", "4:0,0", "--pin", "5:2,0"]);
    assert_eq!(pinned["methods"][0]["result"]["pins"]["max_error"], 0.0);
    let run = program.run(&["compare", "two.obj", "--pin", "4:0,0"]).expect(2);
    assert_message("compare-pin-on-another-chart", &run.stderr);
    let run = program.run(&["compare", "two.obj", "--chart", "2"]).expect(2);
    assert_message("compare-no-such-chart", &run.stderr);
}

#[test]
fn wrong_use_of_compare_ends_with_2_and_writes_nothing() {
    let program = tent();
    program.write("pins.txt", "0 0 0\n");
    let cases: [(&[&str], &str); 11] = [
        (&["--methods", "best"], "unknown-method"),
        (&["--methods", "natural,natural/conformal"], "run-twice"),
        (&["--methods", "natural,lscm", "--max-steps", "3"], "idle-max-steps"),
        (&["--methods", "convex", "--pin", "0:0,0"], "idle-pin"),
        (&["--methods", "natural,convex", "--shading", "area"], "shading-without-picture"),
        (&["--csv", "a", "--svg", "a"], "one-file-for-two"),
        (&["--csv", "-", "--report", "-"], "standard-output-for-two"),
        (&["--png", "tent.obj"], "overwrites-the-mesh"),
        (&["--constraints", "pins.txt", "--csv", "pins.txt"], "overwrites-the-constraints"),
        (&["--pin", "99:0,0"], "no-such-vertex"),
        (&["--start", "uv"], "no-layout-to-start-from"),
    ];
    for (arguments, topic) in cases {
        let run = program.run(&[&["compare", "tent.obj"], arguments].concat()).expect(2);
        assert_message(&format!("compare-{topic}"), &run.stderr);
        assert_eq!(run.stdout, "", "{arguments:?}");
        assert_eq!(program.files(), ["pins.txt", "tent.obj"], "{arguments:?}");
    }
    let run = program.run(&["compare", "missing.obj", "--report", "r.json"]).expect(3);
    assert!(run.stderr.contains("missing.obj"), "{}", run.stderr);
    assert_eq!(program.files(), ["pins.txt", "r.json", "tent.obj"]);
}

#[test]
fn what_goes_to_standard_output_stands_there_alone() {
    let program = tent();
    let of = |option: &str| {
        program.run(&["compare", "tent.obj", "--methods", "natural,convex", option, "-"]).expect(0).stdout
    };
    assert_eq!(csv_rows(&of("--csv")).len(), 3);
    assert_eq!(csv_rows(&of("--steps-csv")).len(), 3);
    assert!(of("--svg").starts_with("<svg ") && of("--svg").ends_with("</svg>\n"));
}
