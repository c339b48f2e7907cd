//! SIGINT and SIGTERM end the program promptly during any work. They are sent to processes that these tests started.
#![cfg(target_os = "linux")]

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use freebound_core::mesh::{PolygonMesh, TriMesh};
use freebound_core::problem::SolveError;
use freebound_io::{ReadError, discard_unfinished, write_atomically};
use glam::DVec2;

use super::program::{Program, Run, obj_text};
use freebound_testkit::{Random, grid};

/// A tenth of a second, plus the time to start `kill` and end a process on a busy machine.
const SOON: Duration = Duration::from_secs(3);

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.expect("there is a kill").success());
}

/// True if the program said that its work was cancelled.
fn says_cancelled(run: &Run) -> bool {
    let messages = [SolveError::Cancelled.to_string(), ReadError::Cancelled.to_string()];
    messages.iter().any(|message| run.stderr.contains(message))
}

/// Starts the program, and sends it a signal after a while. Asserts that it ends soon as interrupted, without
/// partial files. Returns false if it had ended before.
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
    assert!(says_cancelled(&run), "{}", run.stderr);
    let unfinished: Vec<String> = program.files().into_iter().filter(|name| name.starts_with('.')).collect();
    assert!(unfinished.is_empty(), "{arguments:?} {signal} after {after:?}: {unfinished:?}");
    true
}

/// Duration of an uninterrupted run, up to a limit.
fn length_of_run(program: &Program, arguments: &[&str]) -> Duration {
    const LONG_ENOUGH: Duration = Duration::from_secs(4);
    let mut child = program.command(arguments).spawn().expect("the program starts");
    let start = Instant::now();
    while start.elapsed() < LONG_ENOUGH && child.try_wait().expect("it can be waited for").is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let length = start.elapsed();
    if child.try_wait().expect("it can be waited for").is_none() {
        send(&child, "-TERM");
    }
    let run = Run::from(child.wait_with_output().expect("it ends"));
    assert!(matches!(run.status, Some(0 | 130)), "{arguments:?}: {run:?}");
    length
}

/// Sends both signals at several moments of a run, whatever its duration on this machine. Asserts that some arrived
/// while the program was working.
fn assert_ends_soon(program: &Program, arguments: &[&str]) {
    let length = length_of_run(program, arguments);
    let moments = [0.1, 0.3, 0.5, 0.7].map(|share| length.mul_f64(share));
    let hits = moments.iter().zip(["-INT", "-TERM"].iter().cycle());
    let hits = hits.filter(|(after, signal)| ends_soon(program, arguments, signal, **after)).count();
    assert!(hits > 0, "{arguments:?} was over before any signal came, after {length:?}");
}

fn write_mesh(program: &Program, mesh: &TriMesh) {
    program.write("in.obj", &obj_text(&PolygonMesh::from(mesh)));
}

fn in_square(random: &mut Random) -> DVec2 {
    DVec2::new(random.unit(), random.unit())
}

/// Writes `pins.txt`.
fn write_pins(program: &Program, vertices: impl Iterator<Item = usize>, mut target: impl FnMut(usize) -> DVec2) {
    let mut text = String::new();
    for v in vertices {
        let uv = target(v);
        writeln!(text, "{v} {} {}", uv.x, uv.y).unwrap();
    }
    program.write("pins.txt", &text);
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
    let positions = &mesh.positions;
    write_pins(&program, (0..positions.len()).step_by(3), |v| positions[v].truncate() + in_square(&mut random));
    assert_ends_soon(&program, &["flatten", "in.obj", "--constraints", "pins.txt", "-o", "out.obj"]);
}

#[test]
fn the_matchmaker_with_permuted_pins_ends_soon() {
    let program = Program::new();
    let mesh = grid(50, 50);
    write_mesh(&program, &mesh);
    let mut random = Random(5);
    // More pins would exceed the limit of new vertices.
    write_pins(&program, (0..mesh.positions.len()).step_by(200), |_| in_square(&mut random));
    let arguments = ["flatten", "in.obj", "--method", "matchmaker", "--constraints", "pins.txt", "-o", "out.obj"];
    assert_ends_soon(&program, &arguments);
}

/// Starts the program on a mesh that never arrives, so that it cannot end by itself. Sends it signals in direct
/// succession.
fn ended_by(program: &Program, signals: &[&str], after: Duration) -> Run {
    let child = program.command(&["flatten", "never.obj", "-o", "out.obj"]).spawn().expect("the program starts");
    std::thread::sleep(after);
    let kills: Vec<String> = signals.iter().map(|signal| format!("kill {signal} {}", child.id())).collect();
    let sent = Command::new("sh").args(["-c", &kills.join("; ")]).status();
    assert!(sent.expect("there is a shell").success());
    Run::from(child.wait_with_output().expect("it ends"))
}

#[test]
fn a_second_signal_does_not_wait_for_the_first() {
    let program = Program::new();
    let made = Command::new("mkfifo").arg(program.path("never.obj")).status();
    assert!(made.expect("there is a mkfifo").success());
    let once = ended_by(&program, &["-INT"], Duration::from_millis(500));
    assert!(once.status == Some(130) && says_cancelled(&once), "after its grace, with a last word: {once:?}");
    // On a busy machine the grace period may end before the second signal arrives.
    let is_at_once = |after| {
        let twice = ended_by(&program, &["-INT", "-TERM"], Duration::from_millis(after));
        assert_eq!(twice.status, Some(130), "{twice:?}");
        twice.stderr.is_empty()
    };
    assert!([500, 1000, 1500, 2000].into_iter().any(is_at_once), "the second signal waited for the last word");
}

/// Environment variable of a process that writes files and is ended.
const WRITES_INTO: &str = "FREEBOUND_TEST_WRITES_INTO";

/// Writes files without pause until the clean-up, then allows time for errors after it.
fn write_until_the_clean_up(folder: &Path) -> ! {
    static FAILED: AtomicBool = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for number in 0..4 {
            let path = folder.join(format!("{number}.txt"));
            scope.spawn(move || {
                loop {
                    if write_atomically(&path, |out| out.write_all(b"whole")).is_err() {
                        FAILED.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
        // On a busy machine, a thread may begin late.
        let is_written = |number: u32| folder.join(format!("{number}.txt")).exists();
        while !(0..4).all(is_written) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(50));
        discard_unfinished();
        std::thread::sleep(Duration::from_millis(50));
        std::process::exit(if FAILED.load(Ordering::Relaxed) { 1 } else { 130 })
    })
}

/// Runs this very test again in a separate process, since nothing can be written there after the clean-up.
#[test]
fn the_clean_up_at_the_end_leaves_nothing_behind() {
    if let Some(folder) = std::env::var_os(WRITES_INTO) {
        write_until_the_clean_up(Path::new(&folder));
    }
    for _ in 0..5 {
        let program = Program::new();
        let this = std::env::current_exe().expect("the tests are a program");
        let mut again = Command::new(this);
        again.args(["--exact", "cli::signals::the_clean_up_at_the_end_leaves_nothing_behind"]);
        let output = again.env(WRITES_INTO, program.path("")).output().expect("it starts again");
        assert_eq!(output.status.code(), Some(130), "no write fails: it waits for the end");
        assert_eq!(program.files(), ["0.txt", "1.txt", "2.txt", "3.txt"]);
    }
}
