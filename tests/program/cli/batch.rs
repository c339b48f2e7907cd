//! Command `batch`: many meshes side by side.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::{Duration, Instant};

use freebound_core::mesh::PolygonMesh;
use freebound_testkit::many_parts;
use serde_json::{Value, json};

use super::program::{Program, Run, obj_text};

/// Folder with balls of different sizes, and their number.
fn with_balls(count: u32) -> Program {
    let program = Program::new();
    std::fs::create_dir(program.path("in")).expect("a folder");
    for k in 0..count {
        let ball = PolygonMesh::from(&many_parts::ball(10 + k, 6));
        program.write(&format!("in/ball{k}.obj"), &obj_text(&ball));
    }
    program
}

/// Records on standard output, by the name of the mesh.
fn records(run: &Run) -> BTreeMap<String, Value> {
    let record = |line: &str| {
        let record: Value = serde_json::from_str(line).expect("a line of JSON");
        let name = Path::new(record["input"].as_str().expect("a path")).file_name().expect("a name");
        (name.to_string_lossy().into_owned(), record)
    };
    run.stdout.lines().map(record).collect()
}

fn bytes(program: &Program, name: &str) -> Vec<u8> {
    std::fs::read(program.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_mesh_of_a_folder_has_a_record_and_a_corrupt_one_stops_nothing() {
    let program = with_balls(3);
    std::fs::create_dir(program.path("in/deep")).expect("a folder");
    program.write("in/deep/broken.obj", "v 0 0 0\nv 1 0 nan\nf 1 2 3\n");
    program.write("in/notes.md", "no mesh");
    let run = program.run(&["batch", "in", "--output-dir", "out"]);
    assert_eq!(run.status, Some(3), "the worst status: {run:?}");
    let found = records(&run);
    assert_eq!(found.len(), 4);
    for k in 0..3 {
        let record = &found[&format!("ball{k}.obj")];
        assert_eq!((&record["status"], &record["exit_status"]), (&json!("proved"), &json!(0)));
        assert!(record["energy"].as_f64().expect("an energy") < 4.2 && record["faces"].as_u64() > Some(0));
        program.run(&["check", &format!("out/ball{k}.obj")]).expect(0);
    }
    let broken = &found["broken.obj"];
    assert_eq!((&broken["status"], &broken["output"]), (&json!("refused"), &json!(null)));
    assert!(broken["message"].as_str().expect("a message").contains("broken.obj"));
    assert!(program.path("out/deep/broken.obj.freebound.json").is_file());
}

#[test]
fn a_second_run_makes_only_what_has_changed() {
    let program = with_balls(4);
    let resume = ["batch", "in", "--output-dir", "out", "--resume"];
    let first = records(&program.run(&resume).expect(0));
    assert!(first.values().all(|record| record["resumed"] == json!(false)));
    let stamp = |k: u32| program.path(&format!("out/ball{k}.obj")).metadata().and_then(|data| data.modified()).unwrap();
    let before: Vec<_> = (0..4).map(stamp).collect();
    // A changed mesh, a damaged result, a lost record.
    let text = String::from_utf8(bytes(&program, "in/ball0.obj")).expect("text");
    program.write("in/ball0.obj", &format!("{text}# changed\n"));
    program.write("out/ball1.obj", "gone");
    std::fs::remove_file(program.path("out/ball2.obj.freebound.json")).expect("a record");
    let again = records(&program.run(&resume).expect(0));
    let resumed: Vec<bool> = (0..4).map(|k| again[&format!("ball{k}.obj")]["resumed"] == json!(true)).collect();
    assert_eq!(resumed, [false, false, false, true]);
    assert_eq!(stamp(3), before[3]);
    assert_eq!(again["ball1.obj"]["output_sha256"], first["ball1.obj"]["output_sha256"]);
    // Other options are another run, and so is one without --resume.
    let other = records(&program.run(&[&resume[..], &["--", "--distortion", "4.3"]].concat()).expect(0));
    assert!(other.values().all(|record| record["resumed"] == json!(false)));
    let anew = records(&program.run(&["batch", "in", "--output-dir", "out"]).expect(0));
    assert!(anew.values().all(|record| record["resumed"] == json!(false)));
}

#[test]
fn the_number_of_meshes_at_once_and_the_memory_change_no_byte() {
    let program = with_balls(5);
    program.run(&["batch", "in", "--output-dir", "one", "--jobs", "1"]).expect(0);
    program.run(&["batch", "in", "--output-dir", "four", "--jobs", "4"]).expect(0);
    program.run(&["batch", "in", "--output-dir", "little", "--jobs", "4", "--memory", "1K"]).expect(0);
    for k in 0..5 {
        let [one, four, little] =
            ["one", "four", "little"].map(|folder| bytes(&program, &format!("{folder}/ball{k}.obj")));
        assert!(one == four && four == little, "ball{k}");
    }
}

#[test]
fn wrong_options_end_a_batch_before_its_first_mesh() {
    let program = with_balls(2);
    for wrong in [
        &["batch", "in", "--output-dir", "out", "--", "--no-such-option"][..],
        &["batch", "in", "--output-dir", "out", "--", "-o", "x.obj"],
        &["batch", "in", "--output-dir", "out", "--memory", "much"],
        &["batch", "in/notes.md", "--output-dir", "out"],
        &["batch", "missing", "--output-dir", "out"],
        &["batch", "in", "--output-dir", "in"],
        &["batch", "in", "--output-dir", "out", "--", "--svg", "all.svg"],
        &["batch", "in", "--output-dir", "out", "--", "--steps", "steps"],
    ] {
        let run = program.run(wrong);
        assert_eq!((run.status, run.stdout.as_str()), (Some(2), ""), "{wrong:?}: {run:?}");
        assert!(!program.path("out").exists(), "{wrong:?}");
    }
}

#[test]
fn no_result_replaces_a_mesh_that_is_still_to_be_run_or_another_result() {
    let program = with_balls(1);
    std::fs::copy(program.path("in/ball0.obj"), program.path("in/ball0-2.obj")).expect("a copy");
    std::fs::rename(program.path("in/ball0.obj"), program.path("ball0.obj")).expect("moved");
    program.write("in/ball0.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    // The OFF file's result would be in/ball0.obj, which is free, but ball0-2.obj is a mesh.
    let meshes = ["batch", "in", "ball0.obj", "--output-dir", "in"];
    let run = program.run(&meshes);
    assert_eq!((run.status, run.stdout.as_str()), (Some(2), ""), "{run:?}");
    assert!(!program.path("in/ball0.obj").exists() && program.path("in/ball0-2.obj").is_file());
    let apart = records(&program.run(&["batch", "in", "ball0.obj", "--output-dir", "in/out"]).expect(0));
    let outputs: BTreeSet<&str> = apart.values().map(|record| record["output"].as_str().expect("a path")).collect();
    assert_eq!(outputs.len(), 3);
    // The folder of results holds no meshes to run.
    let again = program.run(&["batch", "in", "--output-dir", "in/out", "--resume"]).expect(0);
    assert_eq!(records(&again).len(), 2, "{again:?}");
}

#[test]
fn a_result_is_kept_for_any_number_of_jobs_and_made_again_if_a_file_of_an_option_changes() {
    let program = with_balls(1);
    std::fs::copy(program.path("in/ball0.obj"), program.path("in/other.obj")).expect("a copy");
    program.write("costs.txt", "0 1 1000\n");
    let run = |jobs: &str| {
        let options =
            ["batch", "in", "--output-dir", "out", "--resume", "--jobs", jobs, "--", "--cut-weights", "costs.txt"];
        let found = records(&program.run(&options).expect(0));
        found.values().filter(|record| record["resumed"] == json!(true)).count()
    };
    assert_eq!([run("1"), run("2"), run("1")], [0, 2, 2]);
    program.write("costs.txt", "0 1 10\n");
    assert_eq!(run("2"), 0);
}

#[test]
fn a_list_names_meshes_relative_to_itself_and_equal_names_are_told_apart() {
    let program = with_balls(1);
    std::fs::create_dir(program.path("other")).expect("a folder");
    std::fs::copy(program.path("in/ball0.obj"), program.path("other/ball0.obj")).expect("a copy");
    program.write("in/list.txt", "# two meshes and one that is missing\nball0.obj\n../other/ball0.obj\nmissing.obj\n");
    let run = program.run(&["batch", "in/list.txt", "--output-dir", "out", "--format", "ply", "--command", "unwrap"]);
    assert_eq!(run.status, Some(3), "{run:?}");
    let statuses: BTreeSet<String> = run
        .stdout
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON")["status"].as_str().expect("a status").to_owned())
        .collect();
    assert_eq!(statuses, ["proved", "refused"].map(str::to_owned).into());
    assert!(program.path("out/ball0.ply").is_file() && program.path("out/ball0-2.ply").is_file());
}

#[test]
fn a_mesh_that_is_not_planar_is_written_and_counts() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    // One linear solve folds if pins change places.
    let options = [
        "--", "--repair", "all", "--cut", "shortest", "--method", "natural", "--pin", "0:0,0", "--pin", "40:1,1",
        "--pin", "100:0,1", "--pin", "200:1,0",
    ];
    let run =
        program.run(&[&["batch", "ball.obj", "--output-dir", "out", "--command", "flatten"], &options[..]].concat());
    let record = &records(&run)["ball.obj"];
    assert_eq!((run.status, &record["status"]), (Some(4), &json!("not-proved")), "{run:?}");
    assert!(program.path("out/ball.obj").is_file());
}

#[test]
fn progress_is_told_in_lines_of_json() {
    let program = with_balls(2);
    let run = program.run(&["batch", "in", "--output-dir", "out", "--progress", "json"]).expect(0);
    let lines: Vec<Value> = run.stderr.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let last = lines.last().expect("lines of progress");
    assert_eq!((&last["done"], &last["total"]), (&json!(2), &json!(2)), "{}", run.stderr);
    let run =
        program.run(&["flatten", "in/ball0.obj", "--repair", "all", "--cut", "auto", "--progress", "json"]).expect(0);
    let lines: Vec<Value> = run.stderr.lines().map(|line| serde_json::from_str(line).expect("JSON alone")).collect();
    let last = lines.last().expect("lines of progress");
    assert!(last["stage"].is_string() && last["step"].is_u64() && last["seconds"].as_f64() > Some(0.0), "{last}");
    let quiet = program.run(&["flatten", "in/ball0.obj", "--repair", "all", "--cut", "auto", "--progress", "none"]);
    assert_eq!(quiet.expect(0).stderr, "");
}

#[cfg(unix)]
#[test]
fn a_killed_batch_goes_on_where_it_was_and_an_interrupted_one_leaves_nothing_unfinished() {
    let program = with_balls(24);
    let arguments = ["batch", "in", "--output-dir", "out", "--jobs", "2", "--resume"];
    let done = || {
        let names = (0..24).filter(|k| program.path(&format!("out/ball{k}.obj.freebound.json")).is_file());
        names.collect::<BTreeSet<u32>>()
    };
    let until = |count: usize, child: &mut std::process::Child| {
        let start = Instant::now();
        while done().len() < count && start.elapsed() < Duration::from_mins(1) {
            assert!(child.try_wait().expect("it can be waited for").is_none(), "it was over too soon");
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let mut child = program.command(&arguments).spawn().expect("the program starts");
    until(3, &mut child);
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
    let before = done();
    assert!(before.len() >= 3 && before.len() < 24, "{before:?}");
    let mut child = program.command(&arguments).spawn().expect("the program starts");
    until(before.len() + 2, &mut child);
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.expect("there is a kill").success());
    let ended = Run::from(child.wait_with_output().expect("it ends"));
    assert_eq!(ended.status, Some(130), "{ended:?}");
    let middle = done();
    assert!(middle.is_superset(&before) && middle.len() < 24, "{middle:?}");
    let run = program.run(&arguments).expect(0);
    let found = records(&run);
    assert_eq!(found.len(), 24);
    let resumed = found.values().filter(|record| record["resumed"] == json!(true)).count();
    assert_eq!(resumed, middle.len(), "what was finished stays");
    assert!((0..24).all(|k| program.path(&format!("out/ball{k}.obj")).is_file()));
    let unfinished = std::fs::read_dir(program.path("out")).expect("a folder");
    let names = unfinished.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    assert_eq!(names.filter(|name| name.starts_with('.')).count(), 0);
}
