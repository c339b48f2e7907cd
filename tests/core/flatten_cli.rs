//! `freebound flatten` as a script meets it: exit status, messages, files, report.

use std::collections::BTreeSet;
use std::fs;

use freebound::examples::Example;
use freebound::io::{ObjMesh, read_mesh};
use freebound::mesh::{DiskMesh, PolygonMesh, VertexId};
use freebound::solver::verdict;
use glam::{DVec2, DVec3};
use serde_json::Value;

use crate::common::{corpus_disks, manifest};
use crate::program::{Program, argument, obj_text};

/// Exit status of `flatten` and of `check` for each file of `corpus/bad`, and a word of the message of each.
const BAD: [(&str, i32, i32, &str, &str); 14] = [
    ("closed_fish.obj", 3, 3, "closed", "closed"),
    ("nonmanifold_ArtDemo.obj", 3, 3, "non-manifold-edges", "non-manifold-edges"),
    ("multicomp.obj", 3, 3, "several-components", "several-components"),
    ("holes_plane.obj", 3, 3, "several-boundary-loops", "several-boundary-loops"),
    ("degenerate_capsule.obj", 3, 3, "zero-area", "zero-area"),
    ("moebius.obj", 3, 3, "non-orientable", "non-orientable"),
    ("torus_one_hole.obj", 3, 3, "handles", "handles"),
    ("raw_nancolor.obj", 3, 3, "closed", "closed"),
    // Its texture coordinates are two charts, and `check` looks at the mesh cut along their seams.
    ("raw_negative_indices.obj", 3, 3, "closed", "several-components"),
    ("raw_empty.obj", 3, 3, "no faces", "no faces"),
    ("raw_notenoughindices.obj", 3, 3, "line 9", "line 9"),
    ("raw_polygonfaces.obj", 0, 0, "", ""),
    ("raw_joined_tetrahedra.obj", 3, 3, "non-manifold-edges", "non-manifold-edges"),
    ("raw_corrupted_invalid_double.off", 3, 3, "format not read yet: OFF", "format not read yet: OFF"),
];

/// Every output that there is, by its option.
const ALL_OUTPUTS: [&str; 8] = ["-o", "out.obj", "--svg", "out.svg", "--png", "out.png", "--report", "out.json"];

/// A built-in mesh as a file in the program's folder.
fn example_file(program: &Program, example: Example) -> DiskMesh {
    let mesh = DiskMesh::try_from(example.mesh()).unwrap();
    program.write("in.obj", &obj_text(&PolygonMesh::from(mesh.mesh())));
    mesh
}

/// Texture coordinates by vertex of a file that gives every vertex one.
fn coordinates_by_vertex(file: &ObjMesh) -> Vec<DVec2> {
    let texture = file.texture.as_ref().expect("the file has texture coordinates");
    let mut found = vec![DVec2::NAN; file.polygons.positions.len()];
    for (vertex, &place) in file.polygons.corners.iter().zip(&texture.corners) {
        found[vertex.index()] = texture.coordinates[place as usize];
    }
    found
}

#[test]
fn every_bad_file_ends_as_the_table_says_and_leaves_no_file() {
    for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
        let name = entry.file.trim_start_matches("bad/");
        let (_, flatten, check, of_flatten, of_check) =
            BAD.iter().find(|row| row.0 == name).expect("the table has every bad file");
        let program = Program::new();
        let path = argument(&entry.path);
        let run = program.run(&[&["flatten", path][..], &ALL_OUTPUTS].concat()).expect(*flatten);
        assert!(run.stderr.contains(of_flatten), "{name}: {}", run.stderr);
        let written: &[&str] = if *flatten == 0 { &["out.json", "out.obj", "out.png", "out.svg"] } else { &[] };
        assert_eq!(program.files(), written, "{name}");
        let program = Program::new();
        let run = program.run(&["check", path, "--report", "out.json"]).expect(*check);
        assert!(run.stderr.contains(of_check), "{name}: {}", run.stderr);
        assert!(*check == 0 || program.files().is_empty(), "{name}: {:?}", program.files());
        if *flatten == 3 {
            assert_eq!(run.stdout, "", "{name}: nothing to say but the fault");
        }
    }
}

#[test]
fn a_mesh_that_comes_out_planar_ends_with_0_and_a_folded_one_with_4() {
    for entry in corpus_disks().iter().filter(|e| ["cathead.obj", "cow_seamster.obj"].contains(&e.file.as_str())) {
        let planar = entry.file == "cathead.obj";
        let program = Program::new();
        let arguments = ["flatten", argument(&entry.path), "-o", "out.obj", "--report", "out.json"];
        let run = program.run(&arguments).expect(if planar { 0 } else { 4 });
        assert_eq!(run.stdout.contains("planar: proved one-to-one"), planar, "{}", run.stdout);
        assert_eq!(run.stdout.contains("boundary crossing"), !planar, "{}", run.stdout);
        assert_eq!(program.files(), ["out.json", "out.obj"], "a result that is not planar is written all the same");
    }
}

#[test]
fn wrong_use_ends_with_2_and_says_what_to_do() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases: [(&[&str], &str); 14] = [
        (&["--family", "uniform"], "convex"),
        (&["--family", "power:x"], "power:P"),
        (&["--method", "best"], "natural"),
        (&["--pin", "0:0,0", "--pin", "0:1,1"], "v0 is pinned twice"),
        (&["--pin", "0:0,0", "--pin", "7:0,0"], "same place"),
        (&["--pin", "0:nan,0"], "not finite"),
        (&["--pin", "99999:0,0"], "99999"),
        (&["--pin", "0"], "VERTEX:U,V"),
        (&["--threads", "0"], "threads"),
        (&["--threads", "many"], "threads"),
        (&["--fit", "tight"], "unit"),
        (&["--boundary", "heart"], "circle"),
        (&["--method", "convex", "--pin", "0:0,0"], "convex"),
        (&["--unknown"], "--unknown"),
    ];
    for (options, word) in cases {
        let run = program.run(&[&["flatten", "in.obj"][..], options, &ALL_OUTPUTS].concat()).expect(2);
        assert!(run.stderr.contains(word), "{options:?}: {}", run.stderr);
        assert_eq!(program.files(), ["in.obj"], "{options:?}");
    }
    program.run(&["flatten"]).expect(2);
    program.run(&["check"]).expect(2);
}

#[test]
fn a_square_of_three_boundary_vertices_is_wrong_use() {
    let program = Program::new();
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let run = program.run(&["flatten", "in.obj", "--method", "convex", "--boundary", "square"]).expect(2);
    assert!(run.stderr.contains("choose a circle"), "{}", run.stderr);
    program.run(&["flatten", "in.obj", "--method", "convex"]).expect(0);
}

#[test]
fn a_missing_file_and_one_that_cannot_be_written_are_named() {
    let program = Program::new();
    let run = program.run(&["flatten", "nowhere.obj"]).expect(3);
    assert!(run.stderr.contains("nowhere.obj"), "{}", run.stderr);
    let run = program.run(&["check", "nowhere.obj"]).expect(3);
    assert!(run.stderr.contains("nowhere.obj"), "{}", run.stderr);
    example_file(&program, Example::Dome);
    let run = program.run(&["flatten", "in.obj", "-o", "no/such/folder/out.obj"]).expect(1);
    assert!(run.stderr.contains("no/such/folder/out.obj"), "{}", run.stderr);
    assert_eq!(program.files(), ["in.obj"]);
}

fn keys(value: &Value) -> BTreeSet<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn assert_keys(value: &Value, expected: &[&str]) {
    assert_eq!(keys(value), expected.iter().copied().collect(), "{value:#}");
}

#[test]
#[expect(clippy::too_many_lines, reason = "one list of all fields")]
fn the_report_is_one_json_object_with_the_fields_of_the_design() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    let run = program.run(&["flatten", "in.obj", "--report", "-"]).expect(0);
    let report = run.json();
    // In the order of DESIGN §7.
    assert_keys(
        &report,
        &[
            "freebound",
            "mesh",
            "method",
            "family",
            "pins",
            "steps",
            "verdict",
            "distortion",
            "new_vertices",
            "seconds",
            "peak_memory_bytes",
        ],
    );
    assert_keys(&report["mesh"], &["path", "vertices", "faces", "boundary_vertices", "dividing_edges", "ears"]);
    assert_keys(&report["pins"], &["treatment", "count", "max_error"]);
    // The last three are not in the design.
    assert_keys(
        &report["steps"][0],
        &[
            "rung",
            "index",
            "flipped_faces",
            "boundary_crossings",
            "overwound_vertices",
            "turning_number",
            "max_move",
            "residual",
            "equation_residual",
            "seconds",
            "replaced_pivots",
            "bounded_corners",
            "factor_bytes",
        ],
    );
    assert_keys(
        &report["verdict"],
        &[
            "planar",
            "flipped_faces",
            "boundary_crossings",
            "overwound_vertices",
            "turning_number",
            "zero_area_faces",
            "mirrored",
        ],
    );
    assert_keys(&report["distortion"], &["angle", "area", "stretch_l2", "stretch_linf"]);
    assert_keys(&report["distortion"]["angle"], &["mean", "p99", "max"]);
    assert_keys(&report["distortion"]["area"], &["mean", "p99", "max"]);
    assert_keys(&report["seconds"], &["read", "solve", "verify", "write", "total"]);
    assert_eq!(report["freebound"], env!("CARGO_PKG_VERSION"));
    assert_eq!(report["mesh"]["path"], "in.obj");
    assert_eq!(report["mesh"]["vertices"], mesh.vertex_count());
    assert_eq!(report["mesh"]["faces"], mesh.face_count());
    assert_eq!(report["mesh"]["boundary_vertices"], mesh.boundary_loop().len());
    assert_eq!([&report["method"], &report["family"]], ["natural", "conformal"]);
    assert_eq!(report["pins"]["count"], 0);
    assert_eq!(report["steps"].as_array().unwrap().len(), 1);
    assert_eq!(report["verdict"]["planar"], true);
    assert_eq!(report["verdict"]["turning_number"], 1);
    assert!(report["steps"][0]["residual"].as_f64().unwrap() <= 1e-10);
    assert!(report["seconds"]["total"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_report_in_a_file_is_the_report_on_standard_output() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let mut on_screen = program.run(&["flatten", "in.obj", "--report", "-"]).expect(0).json();
    program.run(&["flatten", "in.obj", "--report", "out.json"]).expect(0);
    let mut in_file: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
    for report in [&mut on_screen, &mut in_file] {
        forget_the_clock(report);
    }
    assert_eq!(on_screen, in_file);
}

/// Takes out what differs from run to run.
fn forget_the_clock(report: &mut Value) {
    report["seconds"] = Value::Null;
    report["peak_memory_bytes"] = Value::Null;
    report["steps"][0]["seconds"] = Value::Null;
}

#[test]
fn the_same_run_writes_the_same_bytes_and_the_number_of_threads_changes_no_verdict() {
    let program = Program::new();
    example_file(&program, Example::Face);
    for family in ["conformal", "mean-value"] {
        let run = |threads: &str, out: &str| {
            let arguments = ["flatten", "in.obj", "--family", family, "--threads", threads, "-o", out, "--report", "-"];
            let mut report = program.run(&arguments).json();
            forget_the_clock(&mut report);
            (report, fs::read(program.path(out)).unwrap())
        };
        let [(one, text), (again, same_text), (two, _)] = [run("1", "a.obj"), run("1", "b.obj"), run("2", "c.obj")];
        assert_eq!(one, again);
        assert!(text == same_text, "{family}: the same run wrote other bytes");
        assert_eq!(one["verdict"], two["verdict"], "{family}");
        assert_eq!(one["mesh"], two["mesh"], "{family}");
        let read = |name| coordinates_by_vertex(&read_mesh(&program.path(name)).unwrap());
        let off = read("a.obj").iter().zip(read("c.obj")).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        assert!(off <= 1e-10, "{family}: the second thread moved a vertex by {off:e}");
    }
}

#[test]
fn the_written_mesh_is_the_one_that_was_read_and_check_agrees_with_the_report() {
    let files = ["cathead.obj", "fran_face.obj", "cow_seamster.obj", "flat_bump_domain.obj"];
    for entry in corpus_disks().iter().filter(|entry| files.contains(&entry.file.as_str())) {
        let program = Program::new();
        let arguments = ["flatten", argument(&entry.path), "-o", "out.obj", "--report", "out.json"];
        let status = program.run(&arguments).status.expect("the program was not killed");
        let (before, after) = (entry.read(), read_mesh(&program.path("out.obj")).unwrap());
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        assert!(before.polygons.positions.iter().map(bits).eq(after.polygons.positions.iter().map(bits)));
        assert_eq!(before.polygons, after.polygons, "{}", entry.file);
        // The verdict of the report, of the library on the file as written, and of `check` are one.
        let report: Value = serde_json::from_slice(&fs::read(program.path("out.json")).unwrap()).unwrap();
        let on_file = verdict(&entry.disk(), &coordinates_by_vertex(&after));
        assert_eq!(report["verdict"], serde_json::to_value(&on_file).unwrap(), "{}", entry.file);
        let check = program.run(&["check", "out.obj", "--report", "-"]).expect(status).json();
        assert_eq!(check["verdict"], report["verdict"], "{}", entry.file);
        assert_eq!(check["distortion"], report["distortion"], "{}", entry.file);
        assert_eq!(keys(&check["mesh"]), keys(&report["mesh"]));
    }
}

#[test]
fn an_earlier_result_can_be_flattened_again_in_place() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["flatten", "in.obj", "-o", "in.obj"]).expect(0);
    let once = fs::read(program.path("in.obj")).unwrap();
    program.run(&["flatten", "in.obj", "-o", "in.obj"]).expect(0);
    assert!(once == fs::read(program.path("in.obj")).unwrap(), "the second run changed the file");
    assert_eq!(program.files(), ["in.obj"]);
}

#[test]
fn polygons_are_written_back_whole() {
    let program = Program::new();
    // A quad, a pentagon that is not convex, and a triangle, on one strip.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 2 .5 0\nv 3 1 0\nv 4 .5 1\n\
                g first\nf 1 2 3 4\nusemtl red\nf 2 5 6 7 3\nf 5 8 6\n";
    program.write("in.obj", text);
    program.run(&["flatten", "in.obj", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let (before, after) = (read_mesh(&program.path("in.obj")).unwrap(), read_mesh(&program.path("out.obj")).unwrap());
    assert_eq!(before.polygons, after.polygons);
    assert_eq!(before.statements, after.statements);
    let sizes: Vec<usize> = (0..3).map(|face| after.polygons.face(face).len()).collect();
    assert_eq!(sizes, [4, 5, 3]);
}

#[test]
fn pins_stand_in_the_written_file_digit_for_digit() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let arguments = [
        "flatten",
        "in.obj",
        "-o",
        "out.obj",
        "--pin",
        "3:-0.1,0.7",
        "--pin",
        "40:1e-17,0.3333333333333333",
        "--pin",
        "11:2.5,-1e3",
        "--report",
        "-",
    ];
    let run = program.run(&arguments);
    assert!(matches!(run.status, Some(0 | 4)), "{run:?}");
    let report = run.json();
    assert_eq!(report["pins"]["count"], 3);
    assert_eq!(report["pins"]["max_error"], 0.0);
    let found = coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap());
    for (vertex, target) in [(3, [-0.1, 0.7]), (40, [1e-17, 0.333_333_333_333_333_3]), (11, [2.5, -1e3])] {
        assert_eq!(found[vertex].to_array().map(f64::to_bits), target.map(f64::to_bits), "vertex {vertex}");
    }
}

#[test]
fn the_result_fits_the_unit_square_or_has_the_area_of_the_surface() {
    let program = Program::new();
    let mesh = example_file(&program, Example::Dome);
    let coordinates = |fit: &str| {
        program.run(&["flatten", "in.obj", "--fit", fit, "-o", "out.obj"]).expect(0);
        coordinates_by_vertex(&read_mesh(&program.path("out.obj")).unwrap())
    };
    let unit = coordinates("unit");
    let low = unit.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = unit.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    assert_eq!(low, DVec2::ZERO);
    assert!(high.max_element() == 1.0 && high.min_element() > 0.5, "{high}");
    let embedding = coordinates("true");
    let area = |face| {
        let [a, b, c] = mesh.face(face).map(|v: VertexId| embedding[v.index()]);
        (b - a).perp_dot(c - a) / 2.0
    };
    let ratio = mesh.faces().map(area).sum::<f64>() / mesh.mesh().area();
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
}

/// Walks over XML and asserts that tags are closed in order and attributes quoted; returns the elements' start tags.
fn xml_elements(text: &str) -> Vec<String> {
    let (mut open, mut elements) = (Vec::<String>::new(), Vec::new());
    for piece in text.split('<').skip(1) {
        let (tag, after) = piece.split_once('>').expect("a tag is closed");
        assert!(!after.contains('>') && !after.contains('&'), "text between tags: {after}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "tags are closed in order");
            continue;
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "attributes are quoted: {tag:.80}");
        let name = tag.split_whitespace().next().expect("a tag has a name").to_owned();
        if !tag.ends_with('/') {
            open.push(name);
        }
        elements.push(tag.to_owned());
    }
    assert!(open.is_empty(), "left open: {open:?}");
    elements
}

#[test]
fn the_drawing_is_well_formed_and_shows_as_many_faults_as_the_report_counts() {
    let files = ["cathead.obj", "hand_lowres.obj", "cow_seamster.obj"];
    let mut flipped_seen = 0;
    for entry in corpus_disks().iter().filter(|entry| files.contains(&entry.file.as_str())) {
        let program = Program::new();
        let path = argument(&entry.path);
        let run = program.run(&["flatten", path, "--method", "levy", "--svg", "out.svg", "--report", "-"]);
        let report = run.json();
        let elements = xml_elements(&fs::read_to_string(program.path("out.svg")).unwrap());
        assert!(elements[0].starts_with("svg ") && elements[0].contains("http://www.w3.org/2000/svg"));
        let path_in = |colour: &str| {
            elements.iter().find(|e| e.starts_with("path ") && e.contains(colour)).expect("a path of this colour")
        };
        let count = |name: &str| report["verdict"][name].as_array().unwrap().len();
        // One closed outline per flipped face, two lines per crossing, one ring per overwound vertex.
        assert_eq!(path_in("fill=\"#d92d3a\"").matches('Z').count(), count("flipped_faces"), "{}", entry.file);
        assert_eq!(path_in("#e8700a").matches('M').count(), 2 * count("boundary_crossings"), "{}", entry.file);
        let rings = elements.iter().filter(|e| e.starts_with("circle ")).count();
        assert_eq!(rings, count("overwound_vertices"), "{}", entry.file);
        assert!(!elements.iter().any(|e| e.contains("NaN") || e.contains("inf")), "{}", entry.file);
        flipped_seen += count("flipped_faces");
    }
    assert!(flipped_seen > 0 || corpus_disks().is_empty(), "no file of these shows a flipped face");
}

#[test]
fn the_picture_has_its_size_and_shows_something_in_both_halves() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    program.run(&["flatten", "in.obj", "--png", "out.png"]).expect(0);
    let picture = image::open(program.path("out.png")).expect("the picture decodes").to_rgba8();
    assert_eq!(picture.dimensions(), (1800, 900), "two halves of 900 × 900");
    for half in [0, 900] {
        let colours: BTreeSet<[u8; 4]> = (0..900)
            .step_by(9)
            .flat_map(|y| (0..900).step_by(9).map(move |x| (x, y)))
            .map(|(x, y)| picture.get_pixel(half + x, y).0)
            .collect();
        assert!(colours.len() > 2, "the half at {half} shows {} colours", colours.len());
    }
}

#[test]
fn all_methods_run_and_say_their_names() {
    let program = Program::new();
    example_file(&program, Example::Dome);
    let cases: [(&[&str], &str, Option<&str>); 8] = [
        (&["--method", "natural", "--family", "power:0.5"], "natural", Some("power:0.5")),
        (&["--family", "wachspress"], "natural", Some("wachspress")),
        (&["--method", "lscm"], "lscm", None),
        (&["--method", "levy"], "levy", None),
        (&["--method", "convex"], "convex", Some("conformal")),
        (&["--method", "convex", "--family", "uniform"], "convex", Some("uniform")),
        (&["--method", "convex", "--family", "shape-preserving"], "convex", Some("shape-preserving")),
        (&["--method", "convex", "--boundary", "square", "--family", "mean-value"], "convex", Some("mean-value")),
    ];
    for (options, method, family) in cases {
        let run = program.run(&[&["flatten", "in.obj", "--report", "-"][..], options].concat());
        assert!(matches!(run.status, Some(0 | 4)), "{options:?}: {run:?}");
        let report = run.json();
        assert_eq!(report["method"], method, "{options:?}");
        assert_eq!(report.get("family").and_then(Value::as_str), family, "{options:?}");
        assert_eq!(report["verdict"]["planar"] == true, run.status == Some(0), "{options:?}");
    }
    let listed = program.run(&["methods"]).expect(0).stdout;
    for name in ["natural", "convex", "lscm", "levy", "conformal", "mean-value", "wachspress", "power:P", "uniform"] {
        assert!(listed.contains(name), "{name}");
    }
}

#[test]
fn without_a_screen_the_example_is_flattened_into_a_folder_that_is_named() {
    let program = Program::new();
    let run = program.run(&[]);
    assert_eq!(run.stderr.trim().lines().count(), 1, "one line says that there is no screen: {}", run.stderr);
    assert_eq!(program.files(), ["freebound-example"]);
    assert!(run.stdout.contains("freebound-example"), "{}", run.stdout);
    let folder = program.path("freebound-example");
    let names: BTreeSet<String> =
        fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(names, ["face.json", "face.obj", "face.png"].map(str::to_owned).into());
    let report: Value = serde_json::from_slice(&fs::read(folder.join("face.json")).unwrap()).unwrap();
    let status = if report["verdict"]["planar"] == true { 0 } else { 4 };
    assert_eq!(run.status, Some(status));
    program.run(&["check", "freebound-example/face.obj"]).expect(status);
}
