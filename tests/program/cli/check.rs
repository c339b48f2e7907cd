//! `freebound check` on files as other programs write them, and Ctrl-C.

#![allow(clippy::float_cmp, reason = "whole numbers are read without rounding")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use freebound_core::mesh::{DiskMesh, PolygonMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{Verdict, verdict};
use glam::DVec2;
use serde_json::{Value, json};

use super::program::{Program, obj_text, polygons_of, textured_text};
use freebound_testkit::{assert_message, corpus, corpus_disks, corpus_test, grid};

/// Meshes of the corpus with a published map, and the maps, one position per vertex.
fn published() -> Vec<(String, DiskMesh, Embedding)> {
    let folder = corpus();
    let disks = corpus_disks();
    let mapped = ["cow_seamster", "fran_face", "maze", "cortex_conte69_R"];
    mapped
        .into_iter()
        .map(|name| {
            let entry = disks.iter().find(|entry| entry.file == format!("{name}.obj")).expect("the mesh is there");
            let map = read_map(&folder.join(format!("constrained/{name}.publishedmap.txt")));
            (name.to_owned(), entry.disk(), map)
        })
        .collect()
}

/// Reads lines "vertex u v", in the order of vertices.
fn read_map(path: &Path) -> Embedding {
    let text = fs::read_to_string(path).expect("the map is there");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .enumerate()
        .map(|(k, line)| {
            let words: Vec<f64> = line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
            assert_eq!(words[0], k as f64);
            DVec2::new(words[1], words[2])
        })
        .collect()
}

/// Verdict of `check` on a file; asserts the matching exit status.
fn checked(program: &Program, text: &str) -> Value {
    program.write("in.obj", text);
    let run = program.run(&["check", "in.obj", "--report", "-"]);
    let report = run.json();
    let status = if report["verdict"]["planar"] == true { 0 } else { 4 };
    assert_eq!(run.status, Some(status), "{}", report["verdict"]);
    report["verdict"].clone()
}

fn value(verdict: &Verdict) -> Value {
    serde_json::to_value(verdict).expect("a verdict is plain data")
}

/// OBJ text with one texture coordinate per vertex.
fn by_vertex(polygons: &PolygonMesh, map: &[DVec2]) -> String {
    textured_text(polygons, map, |face, k| [polygons.face(face)[k].index(); 2])
}

corpus_test! {
    fn published_maps_get_the_verdict_of_the_library() {
        for (name, mesh, map) in published() {
            let expected = verdict(&mesh, &map);
            println!("{name}: {}", expected.summary());
            assert_eq!(checked(&Program::new(), &by_vertex(&polygons_of(&mesh), &map)), value(&expected), "{name}");
        }
    }
}

corpus_test! {
    fn a_map_cut_along_seams_gets_the_verdict_of_the_mesh_cut_there() {
        let mut welded_away = 0;
        for (name, mesh, map) in published().into_iter().filter(|(name, ..)| name != "cortex_conte69_R") {
            // One vertex per position, so that the seams remain in the texture coordinates alone.
            let mut first_at: BTreeMap<[u64; 3], usize> = BTreeMap::new();
            let mut welded = PolygonMesh::default();
            let new_number: Vec<usize> = mesh
                .mesh()
                .positions
                .iter()
                .map(|p| {
                    *first_at.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
                        welded.positions.push(*p);
                        welded.positions.len() - 1
                    })
                })
                .collect();
            let cut = polygons_of(&mesh);
            welded.corners = cut.corners.iter().map(|v| VertexId::from_index(new_number[v.index()])).collect();
            welded_away += cut.positions.len() - welded.positions.len();
            let text =
                textured_text(&welded, &map, |face, k| [welded.face(face)[k].index(), cut.face(face)[k].index()]);
            let expected = verdict(&mesh, &map);
            let found = checked(&Program::new(), &text);
            // Faces and edges keep their numbers; vertices along the seams do not.
            let mut expected_value = value(&expected);
            expected_value["overwound_vertices"] = found["overwound_vertices"].clone();
            assert_eq!(found, expected_value, "{name}");
            let overwound = found["overwound_vertices"].as_array().unwrap().len();
            assert_eq!(overwound, expected.overwound_vertices.len(), "{name}");
        }
        assert!(welded_away > 100, "only {welded_away} vertices were welded");
    }
}

corpus_test! {
    fn texture_coordinates_repeated_for_every_corner_change_nothing() {
        for (name, mesh, map) in published().into_iter().filter(|(name, ..)| name == "fran_face") {
            let polygons = polygons_of(&mesh);
            let repeated: Embedding = polygons.corners.iter().map(|v| map[v.index()]).collect();
            let text = textured_text(&polygons, &repeated, |face, k| [polygons.face(face)[k].index(), 3 * face + k]);
            assert_eq!(checked(&Program::new(), &text), value(&verdict(&mesh, &map)), "{name}");
        }
    }
}

corpus_test! {
    fn a_mirrored_map_is_as_planar_as_the_map_and_says_that_it_is_mirrored() {
        for (name, mesh, map) in published().into_iter().filter(|(name, ..)| name == "fran_face" || name == "maze") {
            let straight = verdict(&mesh, &map);
            let mirror: Embedding = map.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
            let found = checked(&Program::new(), &by_vertex(&polygons_of(&mesh), &mirror));
            assert_eq!(found["planar"], straight.planar, "{name}");
            assert_eq!(found["turning_number"], straight.turning_number.map_or(Value::Null, |n| (-n).into()), "{name}");
            if straight.planar {
                assert_eq!(found["mirrored"], !straight.mirrored, "{name}");
            }
        }
    }
}

/// Flat grid with itself as its map.
fn mapped_grid() -> (PolygonMesh, Embedding) {
    let mesh = grid(3, 2);
    let map = mesh.positions.iter().map(|p| p.truncate()).collect();
    (PolygonMesh::from(&mesh), map)
}

#[test]
fn a_folded_face_is_named_and_ends_with_4() {
    let (polygons, mut map) = mapped_grid();
    // The middle vertex 5 is pulled over its neighbours' edge.
    map[5] = DVec2::new(2.5, 1.5);
    let program = Program::new();
    let found = checked(&program, &by_vertex(&polygons, &map));
    assert_eq!(found["planar"], false);
    assert!(!found["flipped_faces"].as_array().unwrap().is_empty());
    let run = program.run(&["check", "in.obj"]).expect(4);
    assert_message("check-flipped-faces", &run.stdout);
}

#[test]
fn check_says_whether_a_map_holds_in_32_bits() {
    let (polygons, mut map) = mapped_grid();
    for (height, holds) in [(1.0, true), (1e-9, false)] {
        // The middle row of vertices approaches the lowest row, at a distance from the origin that costs digits.
        map.iter_mut().skip(4).take(4).for_each(|z| z.y = height);
        let far: Embedding = map.iter().map(|z| *z + DVec2::splat(8.0)).collect();
        let program = Program::new();
        assert_eq!(checked(&program, &by_vertex(&polygons, &far))["f32"], holds);
        let run = program.run(&["check", "in.obj"]).expect(0);
        let topic = if holds { "check-holds-in-32-bits" } else { "check-does-not-hold-in-32-bits" };
        assert_message(topic, &run.stdout);
    }
}

#[test]
fn a_mesh_without_texture_coordinates_is_described_and_reported() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&mapped_grid().0));
    let run = program.run(&["check", "in.obj"]).expect(0);
    assert_message("check-no-texture-coordinates", &run.stdout);
    let report = program.run(&["check", "in.obj", "--report", "-"]).expect(0).json();
    assert_eq!([&report["mesh"]["vertices"], &report["mesh"]["faces"]], [12, 12]);
    assert!(report.get("verdict").is_none() && report.get("distortion").is_none(), "{report:#}");
    program.run(&["check", "in.obj", "--report", "out.json"]).expect(0);
    let in_file: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
    assert_eq!(in_file["mesh"], report["mesh"]);
}

#[test]
fn texture_coordinates_may_be_many_charts_and_faces_without_any_are_named() {
    let (polygons, map) = mapped_grid();
    let program = Program::new();
    // Every face separate: as many charts as faces.
    let repeated: Embedding =
        (0..).zip(&polygons.corners).map(|(k, v)| map[v.index()] + DVec2::X * f64::from(k / 3)).collect();
    program.write("in.obj", &textured_text(&polygons, &repeated, |f, k| [polygons.face(f)[k].index(), 3 * f + k]));
    let report = || serde_json::from_slice::<Value>(&fs::read(program.path("out.json")).unwrap()).unwrap();
    program.run(&["check", "in.obj", "--report", "out.json"]).expect(0);
    let atlas = &report()["atlas"];
    assert_eq!((&atlas["planar"], atlas["charts"].as_array().map(Vec::len)), (&json!(true), Some(12)));
    // Some corners without coordinates.
    let text = by_vertex(&polygons, &map).replacen("f 1/1 2/2 6/6", "f 1 2 6", 1);
    program.write("in.obj", &text);
    program.run(&["check", "in.obj", "--report", "out.json"]).expect(0);
    let finding = &report()["layout"]["findings"][0];
    assert_eq!([&finding["code"], &finding["faces"]], [&json!("no-coordinates"), &json!([0])]);
    program.run(&["check", "in.obj", "--deny", "no-coordinates"]).expect(4);
    program.run(&["check", "in.obj", "--deny", "warnings", "--ignore", "no-coordinates,outside"]).expect(0);
    assert_eq!(program.files(), ["in.obj", "out.json"]);
}

/// Ctrl-C, sent to a process that this test started.
#[cfg(target_os = "linux")]
mod interrupt {
    use std::io::Write as _;
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    use super::*;
    use crate::cli::program::Run;

    /// Waits until the process catches SIGINT, then sends one.
    fn interrupt(child: &Child) {
        let status = format!("/proc/{}/status", child.id());
        let start = Instant::now();
        let catches = || {
            let text = fs::read_to_string(&status).unwrap_or_default();
            let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:")).map(str::trim).unwrap_or_default();
            u64::from_str_radix(mask, 16).is_ok_and(|mask| mask & 0b10 != 0)
        };
        while !catches() {
            // An ended process is a zombie, which catches nothing; there is nothing to interrupt.
            if fs::read_to_string(&status).is_ok_and(|text| text.contains("State:\tZ")) {
                return;
            }
            assert!(start.elapsed() < Duration::from_secs(20), "the program does not catch SIGINT");
            std::thread::sleep(Duration::from_millis(1));
        }
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(sent.expect("there is a kill").success());
    }

    /// Runs the program on a large mesh and interrupts it after `delay`.
    fn interrupted(program: &Program, arguments: &[&str], delay: Duration) -> Run {
        let child = program.command(arguments).spawn().expect("the program starts");
        std::thread::sleep(delay);
        interrupt(&child);
        Run::from(child.wait_with_output().expect("the program ends"))
    }

    #[test]
    fn an_interrupted_flattening_ends_with_130_and_leaves_no_file() {
        let program = Program::new();
        program.write("in.obj", &obj_text(&PolygonMesh::from(&grid(300, 300))));
        let arguments =
            ["flatten", "in.obj", "-o", "out.obj", "--svg", "out.svg", "--png", "out.png", "--steps", "steps"];
        for delay in [0, 100] {
            let run = interrupted(&program, &arguments, Duration::from_millis(delay));
            assert_eq!(run.status, Some(130), "after {delay} ms: {run:?}");
            assert!(run.stderr.starts_with("freebound: "), "it says why it ends: {}", run.stderr);
            assert_eq!(program.files(), ["in.obj"], "after {delay} ms");
        }
    }

    #[test]
    fn files_that_were_whole_before_the_interrupt_stay_and_no_part_of_another() {
        let program = Program::new();
        program.write("in.obj", &obj_text(&PolygonMesh::from(&grid(120, 120))));
        for delay in [150, 300, 450, 600] {
            let arguments = ["flatten", "in.obj", "-o", "out.obj", "--svg", "out.svg"];
            let run = interrupted(&program, &arguments, Duration::from_millis(delay));
            assert!(matches!(run.status, Some(0 | 130)), "after {delay} ms: {run:?}");
            for name in program.files() {
                let text = fs::read_to_string(program.path(&name)).unwrap();
                match name.as_str() {
                    "in.obj" => {}
                    "out.obj" => assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count(), 2 * 120 * 120),
                    "out.svg" => assert!(text.ends_with("</svg>\n")),
                    other => panic!("{other} was left behind after {delay} ms"),
                }
            }
        }
    }

    #[test]
    fn waiting_for_a_mesh_on_standard_input_is_interrupted() {
        let program = Program::new();
        program.write("out.json", "{}");
        let mut command = program.command(&["flatten", "-", "-o", "out.obj", "--report", "out.json"]);
        let mut child = command.stdin(Stdio::piped()).spawn().expect("the program starts");
        // A partial mesh that must not be taken for the whole.
        let mut input = child.stdin.take().expect("a pipe");
        input.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("the program reads");
        interrupt(&child);
        let start = Instant::now();
        let run = Run::from(child.wait_with_output().expect("the program ends"));
        drop(input);
        assert_eq!(run.status, Some(130), "{run:?}");
        assert!(start.elapsed() < Duration::from_secs(2), "{:?}", start.elapsed());
        assert!(program.files().is_empty(), "{:?}", program.files());
    }

    #[test]
    fn interrupted_figures_end_with_130_and_leave_no_file() {
        let program = Program::new();
        let run = interrupted(&program, &["figures", "out"], Duration::ZERO);
        assert_eq!(run.status, Some(130), "{run:?}");
        assert!(program.files().is_empty(), "{:?}", program.files());
    }

    #[test]
    fn an_interrupted_study_ends_with_130_and_leaves_no_file() {
        let program = Program::new();
        program.write("in.obj", &obj_text(&PolygonMesh::from(&grid(60, 60))));
        let arguments = ["study", "in.obj", "--runs", "100000", "--csv", "out.csv", "--svg", "out.svg"];
        let run = interrupted(&program, &arguments, Duration::from_millis(100));
        assert_eq!(run.status, Some(130), "{run:?}");
        assert_eq!(program.files(), ["in.obj"]);
    }

    #[test]
    fn an_interrupted_check_ends_with_130_and_leaves_no_file() {
        let program = Program::new();
        let mesh = grid(300, 300);
        let map: Embedding = mesh.positions.iter().map(|p| p.truncate()).collect();
        program.write("in.obj", &by_vertex(&PolygonMesh::from(&mesh), &map));
        let run = interrupted(&program, &["check", "in.obj", "--report", "out.json"], Duration::ZERO);
        assert_eq!(run.status, Some(130), "{run:?}");
        assert_eq!(program.files(), ["in.obj"]);
    }
}

#[test]
fn a_mesh_without_texture_coordinates_is_diagnosed_whole() {
    let program = Program::new();
    // Two triangles apart, the second twice.
    program.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\nf 4 5 6\n");
    let report = program.run(&["check", "two.obj", "--report", "-"]).expect(0).json();
    assert_eq!((&report["mesh"]["vertices"], &report["mesh"]["faces"]), (&6.into(), &2.into()));
    assert_eq!(report["mesh"]["repairs"][0]["repair"], "stack-duplicates", "{report}");
    // Two triangles that share a vertex, which a default run splits.
    program.write("tie.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
    let report = program.run(&["check", "tie.obj", "--report", "-"]).expect(0).json();
    assert_eq!((&report["mesh"]["vertices"], &report["mesh"]["unused_vertices"]), (&6.into(), &0.into()), "{report}");
}
