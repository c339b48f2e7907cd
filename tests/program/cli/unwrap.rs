//! Command `unwrap`: any mesh, cut open along short seams of low distortion.

use std::fmt::Write as _;

use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_io::read_mesh;
use freebound_testkit::assert_message;
use serde_json::json;

use super::program::Program;

/// Report of a run as JSON.
fn report(program: &Program, arguments: &[&str]) -> serde_json::Value {
    program.run(&[arguments, &["--report", "report.json"]].concat()).expect(0);
    let text = std::fs::read_to_string(program.path("report.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

/// Number of a repair in a report.
fn count(report: &serde_json::Value, repair: &str) -> u64 {
    let repairs = report["mesh"]["repairs"].as_array().expect("repairs");
    repairs
        .iter()
        .find(|done| done["repair"] == json!(repair))
        .map_or(0, |done| done["count"].as_u64().expect("a count"))
}

#[test]
fn a_closed_mesh_is_unwrapped_by_one_word_and_its_file_is_proved() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    let report = report(&program, &["unwrap", "ball.obj", "-o", "flat.obj"]);
    assert_eq!((&report["verdict"]["planar"], &report["verdict"]["f32"]), (&json!(true), &json!(true)));
    assert!(report["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("an energy") <= 4.1);
    assert_eq!(report["steps"][0]["stage"], json!("seams"));
    assert!(count(&report, "cut") > 20);
    program.run(&["check", "flat.obj"]).expect(0);
}

#[test]
fn a_larger_bound_cuts_fewer_edges_and_the_shortest_cut_cuts_the_least_it_can() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    let cut = |options: &[&str]| count(&report(&program, &[&["unwrap", "ball.obj"], options].concat()), "cut");
    let [loose, usual, tight] = ["4.6", "4.1", "4.02"].map(|bound| cut(&["--distortion", bound]));
    assert!(loose < usual && usual < tight, "{loose}, {usual}, {tight}");
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    let shortest = report(&program, &["flatten", "ball.obj", "--cut", "shortest"]);
    assert!(shortest["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("an energy") > 4.6);
}

#[test]
fn a_disk_is_cut_by_flatten_if_a_bound_is_given_and_left_whole_without() {
    let program = Program::new();
    program.run(&["example", "dome", "."]).expect(0);
    let whole = report(&program, &["flatten", "dome.obj", "--cut", "auto"]);
    assert_eq!(count(&whole, "cut"), 0);
    let cut = report(&program, &["flatten", "dome.obj", "--cut", "auto", "--distortion", "4.02"]);
    let [before, after] =
        [&whole, &cut].map(|report| report["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("an energy"));
    assert!(after <= 4.02 && before > 4.02, "{before}, {after}");
    assert!(count(&cut, "cut") > 0);
}

#[test]
fn several_parts_each_meet_the_bound() {
    let program = Program::new();
    program.run(&["example", "table", "."]).expect(0);
    let report = report(&program, &["unwrap", "table.obj", "-o", "flat.obj"]);
    let charts = report["charts"].as_array().expect("charts");
    assert_eq!(charts.len(), 5);
    for chart in charts {
        assert!(chart["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("an energy") <= 4.1, "{chart}");
    }
    assert_eq!(report["atlas"]["planar"], json!(true));
}

#[test]
fn seams_of_a_file_are_kept_and_completed() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    program.write("seams.txt", "924 923\n923 922\n922 921\n921 920\n");
    let report = report(&program, &["unwrap", "ball.obj", "--cut", "seams.txt"]);
    assert_eq!(count(&report, "cut-seams"), 4);
    assert!(count(&report, "cut") > 10);
    assert!(report["distortion"]["symmetric_dirichlet"]["mean"].as_f64().expect("an energy") <= 4.1);
}

#[test]
fn a_part_without_area_is_drawn_with_a_positive_area() {
    let program = Program::new();
    program.write("part.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 3.5 0 0\nv 4 0 0\nf 1 2 3 4\nf 5 6 7\n");
    for command in ["unwrap", "flatten"] {
        let report = report(&program, &[command, "part.obj", "-o", "flat.obj"]);
        assert_eq!(report["atlas"]["planar"], json!(true), "{command}");
        program.run(&["check", "flat.obj"]).expect(0);
    }
}

#[test]
fn bounds_that_no_map_meets_or_that_nothing_uses_are_refused() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    let isometric = program.run(&["unwrap", "ball.obj", "--distortion", "4"]).expect(2);
    assert_message("unwrap-bound-of-an-isometric-map", &isometric.stderr);
    let unused = program.run(&["flatten", "ball.obj", "--cut", "shortest", "--distortion", "4.2"]).expect(2);
    assert_message("unwrap-bound-without-automatic-seams", &unused.stderr);
}

#[test]
fn the_file_is_the_same_for_any_number_of_threads() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    for threads in ["1", "2", "5"] {
        program.run(&["unwrap", "ball.obj", "--threads", threads, "-o", &format!("{threads}.obj")]).expect(0);
    }
    let [one, two, five] = ["1.obj", "2.obj", "5.obj"].map(|name| std::fs::read(program.path(name)).expect("written"));
    assert!(one == two && two == five);
}

#[test]
fn seams_avoid_the_edges_that_a_file_makes_costly() {
    let program = Program::new();
    program.run(&["example", "ball", "."]).expect(0);
    let mesh = read_mesh(&program.path("ball.obj")).expect("a mesh");
    let length = |options: &[&str]| {
        let report = report(&program, &[&["unwrap", "ball.obj", "-o", "flat.obj"], options].concat());
        report["seams"]["length"].as_f64().expect("a length")
    };
    let plain = length(&[]);
    // Every edge of the upper half.
    let above = |vertex: &VertexId| mesh.polygons.positions[vertex.index()].z > 0.0;
    let mut lines = String::from("# costs\n");
    for face in 0..mesh.polygons.face_count() {
        let corners = mesh.polygons.face(face);
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)).filter(|(a, b)| above(a) && above(b)) {
            writeln!(lines, "{} {} 1000", a.number(), b.number()).expect("memory");
        }
    }
    std::fs::write(program.path("costs.txt"), lines).expect("written");
    assert_ne!(length(&["--cut-weights", "costs.txt"]), plain);
    let flat = read_mesh(&program.path("flat.obj")).expect("a mesh").texture_mesh().expect("coordinates");
    let disk = DiskMesh::try_from(flat.mesh).expect("one chart");
    let is_high = |vertex: &&VertexId| disk.position(**vertex).z > 0.3;
    assert_eq!(disk.boundary_loop().iter().filter(is_high).count(), 0);
}

#[test]
fn a_faulty_file_of_costs_is_refused_with_its_line() {
    for (line, fault) in [("0 1", "form"), ("0 1 x", "cost"), ("0 1 0", "low"), ("0 0 2", "twice"), ("0 9999 2", "far")]
    {
        let program = Program::new();
        program.run(&["example", "ball", "."]).expect(0);
        std::fs::write(program.path("costs.txt"), format!("# costs\n{line}\n")).expect("written");
        let run = program.run(&["unwrap", "ball.obj", "-o", "flat.obj", "--cut-weights", "costs.txt"]);
        assert_message(&format!("unwrap-costs-{fault}"), &run.expect(3).stderr);
        assert!(!program.path("flat.obj").exists());
    }
    let program = Program::new();
    program.run(&["example", "dome", "."]).expect(0);
    std::fs::write(program.path("costs.txt"), "0 1 2\n").expect("written");
    let idle = program.run(&["flatten", "dome.obj", "--cut-weights", "costs.txt"]);
    assert_message("unwrap-costs-idle", &idle.expect(2).stderr);
}

#[test]
fn a_part_whose_corners_coincide_is_drawn_beside_the_others() {
    let program = Program::new();
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3 4\nf 5 6 7\n";
    std::fs::write(program.path("point.obj"), text).expect("written");
    let report = report(&program, &["unwrap", "point.obj", "-o", "flat.obj"]);
    assert_eq!(report["atlas"]["planar"], json!(true));
    assert_eq!(report["charts"].as_array().map(Vec::len), Some(2));
    program.run(&["check", "flat.obj"]).expect(0);
}
