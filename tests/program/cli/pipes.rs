//! Standard output and standard error that cannot be written to: a closed pipe, a full disk.
#![cfg(unix)]

use std::fs::File;
use std::process::Stdio;

use super::program::{Program, Run};
use super::report_schema::TENT;
use crate::house::sources::sources;
use freebound_testkit::assert_message;

/// Commands that write to standard output, with their exit status.
const COMMANDS: [(&[&str], i32); 5] = [
    (&["methods"], 0),
    (&["check", "in.obj"], 0),
    (&["flatten", "in.obj"], 0),
    (&["flatten", "in.obj", "--report", "-"], 0),
    (&["flatten", "in.obj", "-o", "-"], 0),
];

fn program() -> Program {
    let program = Program::new();
    program.write("in.obj", TENT);
    program
}

#[test]
fn a_closed_pipe_ends_quietly_with_the_status_of_the_work() {
    let program = program();
    for (arguments, status) in COMMANDS {
        let mut child = program.command(arguments).spawn().unwrap();
        // The reader closes before anything is written.
        drop(child.stdout.take());
        let run = Run::from(child.wait_with_output().unwrap());
        assert_eq!((run.status, run.stderr.as_str()), (Some(status), ""), "{arguments:?}");
    }
}

#[test]
fn a_full_disk_is_an_error_that_names_standard_output() {
    let program = program();
    let messages = COMMANDS.map(|(arguments, _)| {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let run = Run::from(program.command(arguments).stdout(full).output().unwrap());
        assert_eq!(run.status, Some(1), "{arguments:?}: {}", run.stderr);
        run.stderr
    });
    assert_message("pipes-full-disk", &messages.concat());
}

#[test]
fn where_standard_error_takes_nothing_the_status_still_tells() {
    let program = program();
    let full = File::options().write(true).open("/dev/full").unwrap();
    let status = program.command(&["flatten", "missing.obj"]).stdout(Stdio::null()).stderr(full).status().unwrap();
    assert_eq!(status.code(), Some(3));
}

#[test]
fn no_words_go_around_the_checked_ones() {
    for source in sources(&["src"]) {
        for name in ["println!(", "print!(", "eprintln!(", "eprint!("] {
            let is_used = source.text.lines().any(|line| !line.trim_start().starts_with("//") && line.contains(name));
            assert!(!is_used, "{} writes with {name}", source.path);
        }
    }
}
