//! Files of a run that must not be one another, and standard input and output.

use std::fs;
use std::io::Write as _;
use std::process::Stdio;

use freebound::io::read_obj;
use image::RgbImage;

use crate::program::{Program, Run};
use crate::report_schema::TENT;

/// A folder with every kind of input.
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
                let words = format!("{option} would write over");
                assert!(run.stderr.contains(file) && run.stderr.contains(&words), "{arguments:?}: {}", run.stderr);
                assert_eq!(run.stdout, "", "nothing is computed before");
            }
        }
    }
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
    for [input, output] in [["in.obj", "soft.obj"], ["in.obj", "hard.obj"], ["soft.obj", "in.obj"]] {
        let run = program.run(&["flatten", input, "-o", output]).expect(2);
        assert!(run.stderr.contains("-o would write over the mesh"), "{}", run.stderr);
    }
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
    assert!(run.stderr.contains("--steps would write over the constraints"), "{}", run.stderr);
}

#[test]
fn two_results_do_not_go_to_one_place() {
    let program = inputs();
    for (options, words) in [
        (&["-o", "a.out", "--svg", "./a.out"][..], "-o and --svg would both write it"),
        (&["-o", "-", "--report", "-"], "standard output: -o and --report cannot both go there"),
        (&["--svg", "-", "--png", "-"], "standard output: --svg and --png cannot both go there"),
        (&["-o", "-", "--picture", "photo.png"], "standard output: -o has no folder there for --picture"),
    ] {
        let run = program.run(&[&["flatten", "in.obj"], options].concat()).expect(2);
        assert!(run.stderr.contains(words), "{options:?}: {}", run.stderr);
    }
    // What goes to the null device disturbs nobody.
    #[cfg(unix)]
    program.run(&["flatten", "in.obj", "-o", "/dev/null", "--svg", "/dev/null"]).expect(0);
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
    assert_eq!(report["mesh"]["path"], "standard input");
    let drawing = fed(&program, &["flatten", "-", "--svg", "-"], TENT).expect(0).stdout;
    assert!(drawing.starts_with("<svg ") || drawing.starts_with("<?xml"), "{drawing:.80}");
    fed(&program, &["check", "-"], &through.stdout).expect(0);
    let run = fed(&program, &["flatten", "-"], "f 1 2 3\n").expect(3);
    assert!(run.stderr.starts_with("freebound: standard input: line 1: vertex 1 is out of range"), "{}", run.stderr);
    assert_eq!(program.files(), ["in.obj", "out.json", "out.obj"]);
}

#[test]
fn a_mesh_on_standard_output_stands_alone_and_its_report_in_a_file() {
    let program = Program::new();
    let run = fed(&program, &["flatten", "-", "-o", "-", "--report", "out.json"], TENT).expect(0);
    assert_eq!(read_obj(run.stdout.as_bytes()).unwrap().polygons.face_count(), 4);
    assert_eq!([run.stdout.lines().next(), run.stderr.lines().next()], [Some("v 0.0 0.0 0.0"), None]);
    assert_eq!(program.files(), ["out.json"]);
}
