//! SIGINT and SIGTERM end the program in a moment, whatever it is doing. Sent to processes that these tests started.
#![cfg(target_os = "linux")]

use std::fmt::Write as _;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use freebound::mesh::{PolygonMesh, TriMesh};

use crate::makers::{Random, grid};

use crate::program::{Program, Run, obj_text};

/// A tenth of a second, and what a machine with much other work takes to start `kill` and to end a process.
const SOON: Duration = Duration::from_secs(3);

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.expect("there is a kill").success());
}

/// Starts the program, lets it work for a while, and sends it a signal. It must end soon after, as an interrupted one,
/// and leave no file that is not whole. Returns false where it had ended by itself before.
fn ends_soon(program: &Program, arguments: &[&str], signal: &str, after: Duration) -> bool {
    let mut child = program.command(arguments).spawn().expect("the program starts");
    std::thread::sleep(after);
    if child.try_wait().expect("it can be waited for").is_some() {
        return false;
    }
    let start = Instant::now();
    send(&child, signal);
    let run = Run::from(child.wait_with_output().expect("it ends"));
    let took = start.elapsed();
    if run.status == Some(0) {
        return false;
    }
    assert_eq!(run.status, Some(130), "{arguments:?} {signal} after {after:?}: {run:?}");
    assert!(took < SOON, "{arguments:?} {signal} after {after:?}: {took:?}");
    assert!(run.stderr.contains("cancelled"), "{}", run.stderr);
    let unfinished: Vec<String> = program.files().into_iter().filter(|name| name.starts_with('.')).collect();
    assert!(unfinished.is_empty(), "{arguments:?} {signal} after {after:?}: {unfinished:?}");
    true
}

/// Sends both signals at several times, and asserts that some of them came while the program was at work.
fn assert_ends_soon(program: &Program, arguments: &[&str]) {
    let times = [300, 900, 1700, 2900].map(Duration::from_millis);
    let hits = times.iter().zip(["-INT", "-TERM"].iter().cycle());
    let hits = hits.filter(|(after, signal)| ends_soon(program, arguments, signal, **after)).count();
    assert!(hits > 0, "{arguments:?} was over before any signal came: make the input larger");
}

fn write_mesh(program: &Program, mesh: &TriMesh) {
    program.write("in.obj", &obj_text(&PolygonMesh::from(mesh)));
}

#[test]
fn reading_and_a_large_solve_end_soon() {
    let program = Program::new();
    write_mesh(&program, &grid(250, 250));
    assert_ends_soon(&program, &["flatten", "in.obj", "-o", "out.obj", "--steps", "steps"]);
}

#[test]
fn a_solve_with_many_pins_ends_soon() {
    let program = Program::new();
    let mesh = grid(120, 120);
    write_mesh(&program, &mesh);
    let mut random = Random(3);
    let mut text = String::new();
    for (v, x) in mesh.positions.iter().enumerate().step_by(3) {
        writeln!(text, "{v} {} {}", x.x + random.unit(), x.y + random.unit()).unwrap();
    }
    program.write("pins.txt", &text);
    assert_ends_soon(&program, &["flatten", "in.obj", "--constraints", "pins.txt", "-o", "out.obj"]);
}

#[test]
fn the_matchmaker_with_permuted_pins_ends_soon() {
    let program = Program::new();
    let mesh = grid(15, 15);
    write_mesh(&program, &mesh);
    let mut random = Random(5);
    let mut text = String::new();
    for v in (0..mesh.positions.len()).step_by(4) {
        writeln!(text, "{v} {} {}", random.unit(), random.unit()).unwrap();
    }
    program.write("pins.txt", &text);
    let arguments = ["flatten", "in.obj", "--method", "matchmaker", "--constraints", "pins.txt", "-o", "out.obj"];
    assert_ends_soon(&program, &arguments);
}
