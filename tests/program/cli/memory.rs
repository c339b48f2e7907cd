//! Memory estimate of a mesh file before it is read; on Linux, which reports the machine's memory.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use freebound_io::{MemoryShortage, check_memory, machine_memory_bytes, memory_to_read};
use serde_json::json;

use super::program::{HUGE, Program, argument};
use super::report_schema::TENT;
use freebound_testkit::assert_message;

/// Memory limit: far more than the program needs for a small mesh, far less than for a large one, KiB.
const ROOM: u64 = 2 << 20;

/// Time limit for a refused file: the program's start on a machine under load.
const MOMENT: Duration = Duration::from_secs(5);

#[test]
fn the_memory_that_a_file_takes_is_told_by_its_length_and_the_ending_of_its_name() {
    let program = Program::new();
    let cases = [("a.stl", 5), ("a.OFF", 7), ("a.obj", 8), ("a.ply", 13), ("a.glb", 13), ("a.gltf", 13), ("a", 13)];
    for (name, per_byte) in cases {
        let path = program.write(name, "0123456789");
        assert_eq!(memory_to_read(&path).unwrap(), 10 * per_byte, "{name}");
    }
    assert_eq!(memory_to_read(&program.path("")).unwrap(), 0, "a folder has no bytes to read");
    assert!(memory_to_read(&program.path("missing.obj")).is_err());
}

#[test]
fn a_file_may_take_half_of_the_memory_and_not_a_byte_more() {
    let program = Program::new();
    let path = program.write("ten.obj", "0123456789");
    assert_eq!(check_memory(&path, Some(160)), Ok(()));
    assert_eq!(check_memory(&path, Some(159)), Err(MemoryShortage { needed: 80, memory: 159 }));
    assert_eq!(check_memory(&path, None), Ok(()), "where the memory is not known nothing is asked");
    assert_eq!(check_memory(Path::new("missing.obj"), Some(1)), Ok(()), "reading it says that it is not there");
}

#[test]
fn a_shortage_is_told_in_units_that_can_be_read() {
    for (topic, needed, memory) in [("gibibytes", 3_u64 << 29, 2_u64 << 30), ("exbibytes", u64::MAX, 1023)] {
        assert_message(&format!("memory-shortage-of-{topic}"), &MemoryShortage { needed, memory }.to_string());
    }
}

#[test]
fn the_memory_of_the_machine_is_known() {
    let free = fs::read_to_string("/proc/meminfo").unwrap();
    let available: u64 = free
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:")?.trim().strip_suffix(" kB")?.parse().ok())
        .expect("a line with the memory available");
    let all = machine_memory_bytes().expect("a number");
    assert!(all > available * 1024 && all < HUGE, "{all}, of which {available} KiB are available");
}

#[test]
fn a_file_beyond_the_memory_of_the_machine_is_named_at_once_and_without_taking_any() {
    let program = Program::new();
    for (name, command) in [("huge.obj", "flatten"), ("huge.stl", "check")] {
        program.write_huge(name);
        let freebound = program.command(&[]);
        let script = format!("ulimit -v {ROOM}; exec \"$0\" {command} {name} --report out.json");
        let begun = Instant::now();
        let run = Command::new("sh")
            .args(["-c", &script, argument(Path::new(freebound.get_program()))])
            .current_dir(program.path(""))
            .output()
            .unwrap();
        assert!(begun.elapsed() < MOMENT, "{:?}", begun.elapsed());
        let said = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(3), "{said}");
        assert!(said.starts_with(&format!("freebound: {name}: ")) && said.contains(" TiB"), "{said}");
        let report: serde_json::Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
        assert_eq!(report["error"]["kind"], json!("too-large-for-memory"), "{report:#}");
        let remedy = report["error"]["remedy"].as_str().unwrap();
        assert!(remedy.contains("--large") && said.trim_end().ends_with(remedy), "{said}");
    }
}

#[test]
fn a_large_file_is_read_where_that_is_asked_for() {
    let program = Program::new();
    program.write("tent.obj", TENT);
    program.run(&["flatten", "tent.obj", "--large"]).expect(0);
    program.run(&["check", "tent.obj", "--large"]).expect(0);
    // Zeros are not text: reading stops after the first of them.
    program.write_huge("huge.obj");
    for command in ["flatten", "check"] {
        let run = program.run(&[command, "huge.obj", "--large", "--report", "-"]).expect(3);
        assert!(run.stderr.starts_with("freebound: huge.obj: "), "{}", run.stderr);
        assert_eq!(run.json()["error"]["kind"], json!("not-understood"), "{}", run.stderr);
    }
}
