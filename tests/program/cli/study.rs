//! `freebound study`: table, plots and summary; rows that can be reproduced individually.

use std::collections::BTreeSet;
use std::fs;

use freebound_core::mesh::PolygonMesh;
use freebound_core::pipeline::study::summary;
use freebound_io::read_study;

use super::program::{Program, obj_text};
use freebound_testkit::surfaces::irregular_cube;
use freebound_testkit::{Random, assert_message, bumpy_cap_of, csv_rows};

/// Program with a cube and a cap in its folder.
fn with_meshes() -> Program {
    let program = Program::new();
    let cube = irregular_cube(3, &mut Random(3));
    program.write("cube.obj", &obj_text(&PolygonMesh::from(cube.mesh())));
    program.write("cap.obj", &obj_text(&PolygonMesh::from(&bumpy_cap_of(60, 2))));
    program
}

/// Rows of a table, accessed by column names.
struct Table(Vec<Vec<String>>);

impl Table {
    fn read(program: &Program, name: &str) -> Self {
        Self(csv_rows(&fs::read_to_string(program.path(name)).unwrap()))
    }

    fn rows(&self) -> &[Vec<String>] {
        &self.0[1..]
    }

    fn cell<'a>(&self, row: &'a [String], column: &str) -> &'a str {
        &row[self.0[0].iter().position(|head| head == column).unwrap()]
    }
}

#[test]
fn a_row_of_the_table_run_again_by_hand_gives_the_same_numbers() {
    let program = with_meshes();
    program
        .run(&["study", "cube.obj", "--runs", "24", "--csv", "runs.csv", "--seed", "5", "--max-steps", "9"])
        .expect(0);
    let table = Table::read(&program, "runs.csv");
    assert_eq!(table.rows().len(), 24);
    let mut outcomes = BTreeSet::new();
    for row in table.rows() {
        let cell = |column: &str| table.cell(row, column);
        assert_eq!(cell("past_stall"), "false");
        let mut arguments =
            vec!["flatten", "cube.obj", "--method", "iterate", "--family", cell("family"), "--report", "-"];
        arguments.extend(["--treatment", cell("treatment"), "--max-steps", cell("max_steps")]);
        arguments.extend(cell("pins").split(' ').flat_map(|pin| ["--pin", pin]));
        let run = program.run(&arguments);
        outcomes.insert(cell("outcome").to_owned());
        assert_eq!(run.status, Some(if cell("outcome") == "planar" { 0 } else { 4 }), "{row:?}");
        let report = run.json();
        let steps = report["steps"].as_array().unwrap();
        assert_eq!((steps.len() - 1).to_string(), cell("steps"), "{row:?}");
        let verdict = &report["verdict"];
        assert_eq!(verdict["flipped_faces"].as_array().unwrap().len().to_string(), cell("last_flips"));
        assert_eq!(verdict["boundary_crossings"].as_array().unwrap().len().to_string(), cell("last_crossings"));
        assert_eq!(verdict["turning_number"].to_string(), cell("last_turning_number"));
        if steps.len() == 1 {
            let mean = report["distortion"]["angle"]["mean"].as_f64().unwrap();
            assert_eq!(mean, cell("distortion").parse::<f64>().unwrap(), "{row:?}");
        }
    }
    assert!(outcomes.contains("planar") && outcomes.contains("stalled"), "{outcomes:?}");
}

#[test]
fn the_same_bytes_come_from_one_thread_and_from_three() {
    let program = with_meshes();
    let study = |name: &str, threads: &str| {
        let [table, plots] = ["csv", "svg"].map(|kind| format!("{name}.{kind}"));
        let arguments = ["study", "cap.obj", "cube.obj", "--runs", "12", "--threads", threads];
        let files = ["--csv", &table, "--svg", &plots];
        let run = program.run(&[&arguments[..], &files[..]].concat()).expect(0);
        (run.stdout, fs::read(program.path(&table)).unwrap(), fs::read(program.path(&plots)).unwrap())
    };
    assert!(study("one", "1") == study("three", "3"));
}

#[test]
fn plots_have_labelled_axes_and_the_summary_a_line_for_each_group() {
    let program = with_meshes();
    let files = ["--csv", "runs.csv", "--svg", "plots.svg"];
    let run = program.run(&[&["study", "cap.obj", "cube.obj", "--runs", "30"], &files[..]].concat()).expect(0);
    let groups = summary(&read_study(&program.path("runs.csv")).expect("it was written just now"));
    let svg = fs::read_to_string(program.path("plots.svg")).unwrap();
    assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf"));
    assert!(svg.contains(">100<"), "per cent go up to 100");
    let texts = svg.split("<text ").skip(1).filter_map(|rest| rest.split(['<', '>']).nth(1));
    // Numbers at axes and names of groups depend on the runs.
    let is_fixed = |text: &&str| text.parse::<u32>().is_err() && !groups.iter().any(|group| group.name.contains(*text));
    let texts: BTreeSet<&str> = texts.filter(is_fixed).collect();
    assert_message("study-words-of-the-plots", &Vec::from_iter(texts).join("\n"));
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_message("study-columns", &lines[0].split_whitespace().collect::<Vec<_>>().join(" "));
    let cells: Vec<&str> = lines[1].split_whitespace().collect();
    assert_eq!(cells[..2], ["runs", "60"]);
    let (rows, heads): (Vec<&str>, Vec<&str>) = lines[2..].iter().copied().partition(|line| line.starts_with(' '));
    assert_message("study-kinds-of-groups", &heads.join("\n"));
    assert_eq!(rows.len(), groups.len() - 1, "all but the group of all runs: {}", run.stdout);
    for (row, group) in rows.iter().zip(&groups[1..]) {
        let cells = row.strip_prefix(&format!("  {}  ", group.name)).expect("the groups in their order");
        assert_eq!(cells.split_whitespace().next(), Some(group.runs.to_string().as_str()), "{row}");
    }
    for name in ["eliminate", "wachspress", "cap.obj", "cube.obj"] {
        assert!(groups.iter().any(|group| group.name == name), "{name} in {}", run.stdout);
    }
}

#[test]
fn tables_are_put_together_as_if_all_had_been_run_at_once() {
    let program = with_meshes();
    let study = ["study", "--runs", "10", "--seed", "3", "--csv"];
    let run = |arguments: &[&str]| program.run(&[&study[..], arguments].concat()).expect(0).stdout;
    run(&["cap.csv", "cap.obj"]);
    let added = run(&["sum.csv", "cube.obj", "--add", "cap.csv", "--svg", "sum.svg"]);
    let whole = run(&["whole.csv", "cap.obj", "cube.obj", "--svg", "whole.svg"]);
    assert_eq!(added, whole);
    for [a, b] in [["sum.csv", "whole.csv"], ["sum.svg", "whole.svg"]] {
        assert!(fs::read(program.path(a)).unwrap() == fs::read(program.path(b)).unwrap(), "{a}");
    }
    // Without a mesh it summarises existing rows.
    let again = program.run(&["study", "--add", "sum.csv"]).expect(0);
    assert_eq!(again.stdout, whole);
}

#[test]
fn large_meshes_have_fewer_runs_where_that_is_asked_for() {
    let program = with_meshes();
    let limits = ["--runs", "8", "--most-faces", "300", "--csv", "runs.csv"];
    program.run(&[&["study", "cap.obj", "cube.obj"], &limits[..]].concat()).expect(0);
    let table = Table::read(&program, "runs.csv");
    for mesh in ["cap.obj", "cube.obj"] {
        let rows: Vec<_> = table.rows().iter().filter(|row| table.cell(row, "mesh") == mesh).collect();
        let faces: usize = table.cell(rows[0], "faces").parse().unwrap();
        assert_eq!(rows.len(), (300 / faces).clamp(1, 8), "{mesh} of {faces} faces");
    }
}

#[test]
fn past_a_stall_no_run_is_called_stalled() {
    let program = with_meshes();
    let options = ["--runs", "12", "--max-steps", "20", "--past-stall", "--csv", "runs.csv"];
    program.run(&[&["study", "cube.obj"], &options[..]].concat()).expect(0);
    let table = Table::read(&program, "runs.csv");
    let outcomes: Vec<&str> = table.rows().iter().map(|row| table.cell(row, "outcome")).collect();
    assert!(outcomes.contains(&"limit") && !outcomes.contains(&"stalled"), "{outcomes:?}");
    let told = |row: &Vec<String>| table.cell(row, "past_stall") == "true" && table.cell(row, "max_steps") == "20";
    assert!(table.rows().iter().all(told));
}

#[test]
fn a_mesh_of_two_charts_is_refused_by_name() {
    let program = Program::new();
    let square = |height: usize, first: usize| {
        let corners = ["0 0", "1 0", "1 1", "0 1"].map(|corner| format!("v {corner} {height}\n")).concat();
        let [a, b, c, d] = std::array::from_fn(|k| first + k);
        format!("{corners}f {a} {b} {c}\nf {a} {c} {d}\n")
    };
    program.write("two.obj", &(square(0, 1) + &square(5, 5)));
    let before = program.files();
    let run = program.run(&["study", "two.obj", "--runs", "2", "--csv", "runs.csv"]).expect(2);
    assert_message("study-two-charts", &run.stderr);
    assert_eq!(program.files(), before);
}

#[test]
fn tables_of_other_limits_are_not_put_together_and_one_without_limits_is_none() {
    let program = with_meshes();
    let study = ["study", "--runs", "3", "--csv"];
    for table in [
        &["cap.csv", "cap.obj"][..],
        &["few.csv", "cube.obj", "--max-steps", "9"],
        &["past.csv", "cube.obj", "--past-stall"],
    ] {
        program.run(&[&study[..], table].concat()).expect(0);
    }
    for [table, words] in [["few.csv", "--max-steps 9"], ["past.csv", "--max-steps 60 --past-stall"]] {
        for run in [
            program.run(&["study", "--add", "cap.csv", "--add", table]),
            program.run(&["study", "cap.obj", "--runs", "1", "--add", table]),
        ] {
            let run = run.expect(2);
            assert!(run.stderr.contains(table) && run.stderr.contains(words), "{}", run.stderr);
        }
        program.run(&["study", "--add", table]).expect(0);
    }
    let old: String = fs::read_to_string(program.path("cap.csv"))
        .unwrap()
        .lines()
        .map(|line| line.rsplitn(3, ',').last().unwrap().to_owned() + "\n")
        .collect();
    program.write("old.csv", &old);
    let run = program.run(&["study", "--add", "old.csv"]).expect(3);
    assert!(run.stderr.contains("old.csv") && run.stderr.contains("max_steps"), "{}", run.stderr);
}

#[test]
fn options_of_runs_are_refused_where_there_is_no_mesh_to_run_on() {
    let program = with_meshes();
    program.run(&["study", "cap.obj", "--runs", "2", "--csv", "one.csv"]).expect(0);
    for idle in [
        &["--runs", "7"][..],
        &["--most-faces", "9"],
        &["--seed", "1"],
        &["--max-steps", "60"],
        &["--past-stall"],
        &["--large"],
    ] {
        let run = program.run(&[&["study", "--add", "one.csv"], idle].concat()).expect(2);
        assert!(run.stderr.contains(idle[0]), "{}", run.stderr);
    }
    program.run(&["study", "--add", "one.csv", "--threads", "1"]).expect(0);
}

/// The missing mesh is reported only if the outputs can be written.
#[test]
fn outputs_are_tried_before_all_work() {
    let program = with_meshes();
    fs::create_dir(program.path("folder")).unwrap();
    let before = program.files();
    for place in ["none/runs", "folder"] {
        for option in ["--csv", "--svg"] {
            let run = program.run(&["study", "missing.obj", option, place]).expect(1);
            assert!(run.stderr.contains(place), "{}", run.stderr);
        }
    }
    program.run(&["study", "missing.obj", "--csv", "runs.csv"]).expect(3);
    // Nothing is written if one of two outputs cannot be.
    program.run(&["study", "cap.obj", "--runs", "1", "--csv", "runs.csv", "--svg", "folder"]).expect(1);
    assert_eq!(program.files(), before);
}

#[test]
fn what_cannot_be_studied_is_told_with_its_exit_status() {
    let program = with_meshes();
    program.write("closed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    program.write("no.csv", "mesh,run\ncap.obj,x\n");
    program.run(&["study", "cap.obj", "--runs", "1", "--csv", "one.csv"]).expect(0);
    let before = program.files();
    for wrong in [
        &["study"][..],
        &["study", "cap.obj", "--runs", "0"],
        &["study", "cap.obj", "--most-faces", "0"],
        &["study", "cap.obj", "--threads", "0"],
        &["study", "cap.obj", "--csv", "cap.obj"],
        &["study", "cap.obj", "--csv", "both", "--svg", "both"],
        &["study", "cap.obj", "--csv", "-"],
        &["study", "cap.obj", "cap.obj"],
        &["study", "cap.obj", "--add", "one.csv"],
        &["study", "cube.obj", "--add", "one.csv", "--csv", "one.csv"],
    ] {
        program.run(wrong).expect(2);
    }
    for unusable in [
        &["study", "none.obj"][..],
        &["study", "closed.obj"],
        &["study", "--add", "none.csv"],
        &["study", "--add", "no.csv"],
    ] {
        let run = program.run(unusable).expect(3);
        assert!(run.stderr.contains(unusable[unusable.len() - 1]), "{}", run.stderr);
    }
    program.run(&["study", "cap.obj", "--runs", "1", "--csv", "none/runs.csv"]).expect(1);
    assert_eq!(program.files(), before);
}
