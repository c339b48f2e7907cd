//! Conflicting files of a run, and standard input and output.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::process::Stdio;

use freebound_io::read_stream;
use image::RgbImage;

use super::program::{Program, Run};
use super::report_schema::TENT;
use freebound_testkit::assert_message;

/// Folder with every kind of input.
fn inputs() -> Program {
    let program = Program::new();
    program.write("in.obj", &format!("mtllib looks.mtl\nusemtl skin\n{TENT}"));
    program.write("looks.mtl", "newmtl skin\nmap_Kd -s 1 1 1 skin.png\nbump dents.png\n");
    program.write("pins.txt", "0 0 0\n");
    for name in ["skin.png", "dents.png", "photo.png"] {
        RgbImage::new(2, 1).save(program.path(name)).unwrap();
    }
    program
}

#[test]
fn no_input_is_written_over() {
    let program = inputs();
    fs::create_dir(program.path("folder")).unwrap();
    let files = ["in.obj", "looks.mtl", "pins.txt", "skin.png", "dents.png", "photo.png"];
    let contents = || files.map(|file| fs::read(program.path(file)).unwrap());
    let before = contents();
    let mut messages = BTreeSet::new();
    for file in files {
        for path in [file.to_owned(), format!("./{file}"), format!("folder/../{file}")] {
            for option in ["-o", "--svg", "--png", "--report"] {
                let mut arguments = vec!["flatten", "in.obj", option, &path];
                match file {
                    "pins.txt" => arguments.extend(["--constraints", "pins.txt"]),
                    "photo.png" => arguments.extend(["--picture", "photo.png"]),
                    _ => {}
                }
                let run = program.run(&arguments).expect(2);
                assert!(run.stderr.contains(file) && run.stderr.contains(option), "{arguments:?}: {}", run.stderr);
                assert_eq!(run.stdout, "", "nothing is computed before");
                messages.insert(run.stderr);
            }
        }
    }
    assert_message("places-over-the-inputs", &String::from_iter(messages));
    program.run(&["check", "in.obj", "--report", "in.obj"]).expect(2);
    assert!(before == contents());
}

#[cfg(unix)]
#[test]
fn links_to_an_input_are_the_input() {
    let program = inputs();
    std::os::unix::fs::symlink(program.path("in.obj"), program.path("soft.obj")).unwrap();
    fs::hard_link(program.path("in.obj"), program.path("hard.obj")).unwrap();
    let before = fs::read(program.path("in.obj")).unwrap();
    let links = [["in.obj", "soft.obj"], ["in.obj", "hard.obj"], ["soft.obj", "in.obj"]];
    let messages = links.map(|[input, output]| program.run(&["flatten", input, "-o", output]).expect(2).stderr);
    assert_message("places-links-to-the-mesh", &messages.concat());
    assert!(before == fs::read(program.path("in.obj")).unwrap());
}

#[test]
fn steps_do_not_replace_an_input() {
    let program = Program::new();
    fs::create_dir(program.path("steps")).unwrap();
    program.write("in.obj", TENT);
    program.write("steps/steps.csv", "0 0 0\n");
    let arguments = ["flatten", "in.obj", "--constraints", "steps/steps.csv", "--steps", "./steps"];
    let run = program.run(&arguments).expect(2);
    assert_message("places-steps-over-the-constraints", &run.stderr);
}

#[test]
fn two_results_do_not_go_to_one_place() {
    let program = inputs();
    for (case, options) in [
        ("one-file-twice", &["-o", "a.out", "--svg", "./a.out"][..]),
        ("mesh-and-report-on-one-stream", &["-o", "-", "--report", "-"]),
        ("drawings-on-one-stream", &["--svg", "-", "--png", "-"]),
        ("picture-beside-a-stream", &["-o", "-", "--picture", "photo.png"]),
    ] {
        let run = program.run(&[&["flatten", "in.obj"], options].concat()).expect(2);
        assert_message(&format!("places-{case}"), &run.stderr);
    }
    assert_eq!(program.files(), inputs().files(), "told before anything is written");
    // The null device conflicts with nothing.
    #[cfg(unix)]
    program.run(&["flatten", "in.obj", "-o", "/dev/null", "--svg", "/dev/null"]).expect(0);
}

#[test]
fn a_result_does_not_lie_where_the_steps_go() {
    let program = inputs();
    fs::create_dir(program.path("folder")).unwrap();
    let mut messages = BTreeSet::new();
    for is_there in [false, true] {
        for path in ["steps/step-000-natural.svg", "./steps/steps.csv", "folder/../steps/step-123-relax.svg", "steps"] {
            for option in ["-o", "--svg", "--png", "--report"] {
                let run = program.run(&["flatten", "in.obj", option, path, "--steps", "steps"]).expect(2);
                let is_named = [option, "--steps", path].iter().all(|word| run.stderr.contains(word));
                assert!(is_named, "{option} {path}: {}", run.stderr);
                messages.insert(run.stderr);
            }
        }
        assert_eq!(program.path("steps").is_dir(), is_there, "nothing is computed before");
        fs::create_dir_all(program.path("steps")).unwrap();
    }
    assert_message("places-results-among-the-steps", &String::from_iter(messages));
    // A drawing with another name conflicts with no step.
    program.run(&["flatten", "in.obj", "--svg", "steps/last.svg", "--steps", "steps"]).expect(0);
    assert!(program.path("steps/last.svg").is_file() && program.path("steps/steps.csv").is_file());
}

#[test]
fn a_result_does_not_lie_where_copies_beside_the_mesh_go() {
    let program = inputs();
    fs::create_dir(program.path("out")).unwrap();
    let materials = &["-o", "out/flat.obj", "--copy-materials"][..];
    let picture = &["-o", "out/flat.obj", "--picture", "photo.png"][..];
    let cases = [
        (materials, "out/looks.mtl"),
        (materials, "out/skin.png"),
        (picture, "out/photo.png"),
        (picture, "./out/flat.mtl"),
    ];
    let mut messages = BTreeSet::new();
    let mut asserted = |options: &[&str], path: &str| {
        for option in ["--report", "--svg", "--png"] {
            let run = program.run(&[&["flatten", "in.obj", option, path], options].concat()).expect(2);
            let is_named = [option, options[2]].iter().all(|word| run.stderr.contains(word));
            assert!(is_named, "{option} {path} {options:?}: {}", run.stderr);
            messages.insert(run.stderr);
        }
    };
    for (options, path) in cases {
        asserted(options, path);
    }
    assert_eq!(fs::read_dir(program.path("out")).unwrap().count(), 0, "nothing is computed before");
    // The copies of an earlier run exist, and are not copied again.
    program.run(&[&["flatten", "in.obj"], materials].concat()).expect(0);
    program.run(&[&["flatten", "in.obj"], picture].concat()).expect(0);
    for (options, path) in cases {
        asserted(options, path);
    }
    // If the first name is taken by another file, the copy gets the second name.
    program.write("out/looks.mtl", "newmtl another\n");
    asserted(materials, "out/flat-looks.mtl");
    assert_message("places-results-among-copies", &String::from_iter(messages));
    let report = ["flatten", "in.obj", "--report", "out/flat.json"];
    program.run(&[&report, materials].concat()).expect(0);
}

#[test]
fn copies_do_not_lie_where_the_steps_go() {
    let program = inputs();
    fs::copy(program.path("photo.png"), program.path("step-000-natural.svg")).unwrap();
    let arguments = ["--picture", "step-000-natural.svg", "-o", "steps/flat.obj", "--steps", "steps"];
    let run = program.run(&[&["flatten", "in.obj"], &arguments[..]].concat()).expect(2);
    assert_message("places-copies-among-the-steps", &run.stderr);
    assert!(!program.path("steps").exists());
}

/// Runs the program with a file as standard input.
#[cfg(unix)]
fn fed_from(program: &Program, file: &str, arguments: &[&str]) -> Run {
    let input = fs::File::open(program.path(file)).unwrap();
    Run::from(program.command(arguments).stdin(input).output().unwrap())
}

#[cfg(unix)]
#[test]
fn the_file_that_standard_input_comes_from_is_not_written_over() {
    let program = Program::new();
    program.write("s.obj", TENT);
    fs::hard_link(program.path("s.obj"), program.path("hard.obj")).unwrap();
    let before = fs::read(program.path("s.obj")).unwrap();
    let mut messages = BTreeSet::new();
    for path in ["s.obj", "./s.obj", "hard.obj"] {
        for arguments in [
            &["flatten", "-", "-o", path][..],
            &["flatten", "-", "--png", path],
            &["flatten", "-", "--report", path],
            &["check", "-", "--report", path],
        ] {
            let run = fed_from(&program, "s.obj", arguments).expect(2);
            let option = arguments[2];
            assert!(run.stderr.contains(option) && run.stderr.contains(path), "{arguments:?}: {}", run.stderr);
            messages.insert(run.stderr);
        }
    }
    assert_message("places-over-the-source-of-standard-input", &String::from_iter(messages));
    assert!(before == fs::read(program.path("s.obj")).unwrap());
    fed_from(&program, "s.obj", &["flatten", "-", "-o", "other.obj"]).expect(0);
}

/// Runs the program with a text on standard input.
fn fed(program: &Program, arguments: &[&str], text: &str) -> Run {
    let mut child = program.command(arguments).stdin(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    Run::from(child.wait_with_output().unwrap())
}

#[test]
fn a_mesh_goes_in_and_out_without_a_file() {
    let program = Program::new();
    program.write("in.obj", TENT);
    program.run(&["flatten", "in.obj", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let through = fed(&program, &["flatten", "-", "-o", "-"], TENT).expect(0);
    assert_eq!(through.stdout, fs::read_to_string(program.path("out.obj")).unwrap());
    let report = fed(&program, &["flatten", "-", "--report", "-"], TENT).expect(0).json();
    assert_message("places-path-of-standard-input", report["mesh"]["path"].as_str().expect("a path"));
    let drawing = fed(&program, &["flatten", "-", "--svg", "-"], TENT).expect(0).stdout;
    assert!(drawing.starts_with("<svg ") || drawing.starts_with("<?xml"), "{drawing:.80}");
    fed(&program, &["check", "-"], &through.stdout).expect(0);
    let run = fed(&program, &["flatten", "-"], "f 1 2 3\n").expect(3);
    assert_message("places-fault-of-standard-input", &run.stderr);
    assert_eq!(program.files(), ["in.obj", "out.json", "out.obj"]);
}

#[test]
fn a_mesh_on_standard_output_stands_alone_and_its_report_in_a_file() {
    let program = Program::new();
    let run = fed(&program, &["flatten", "-", "-o", "-", "--report", "out.json"], TENT).expect(0);
    assert_eq!(read_stream(run.stdout.as_bytes()).unwrap().polygons.face_count(), 4);
    assert_eq!([run.stdout.lines().next(), run.stderr.lines().next()], [Some("v 0 0 0"), None]);
    assert_eq!(program.files(), ["out.json"]);
}
