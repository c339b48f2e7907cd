//! `freebound flatten` on meshes that are not disks: default repairs, and repairs on request.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use freebound_core::mesh::{DiskMesh, Repair, VertexId};
use freebound_io::read_mesh;
use serde_json::{Value, json};

use super::program::{Program, obj_text};
use freebound_testkit::{assert_message, band, tetrahedron};

fn repairs(report: &Value) -> &Value {
    &report["mesh"]["repairs"]
}

#[test]
fn harmless_faults_are_no_reason_to_refuse_a_mesh_unless_none_may_be_mended() {
    let program = Program::new();
    // An unreferenced vertex; a duplicate face; a quad with a repeated corner; a degenerate face.
    program.write(
        "odd.obj",
        "v 9 9 9\nv 0 0 0\nv 1 0 .2\nv 1 1 0\nv 0 1 .1\nv 2 0 0\nv 2 1 0\nv 1 .5 .1\n\
         f 2 3 4\nf 2 4 5\nf 4 2 3\nf 3 6 6 7\nf 3 7 4 8\nf 3 8 4\n",
    );
    let run = program.run(&["flatten", "odd.obj", "-o", "out.obj", "--report", "out.json"]).expect(0);
    let line = run.stdout.lines().find(|line| line.starts_with("mesh")).expect("a line on repairs");
    assert_message("repair-of-harmless-faults", line);
    let text = std::fs::read_to_string(program.path("out.json")).expect("written");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["verdict"]["planar"], json!(true));
    let expected = json!([
        {"repair": "drop-repeated-corners", "count": 1},
        {"repair": "stack-duplicates", "count": 1},
    ]);
    assert_eq!(repairs(&report), &expected);
    assert_eq!(report["mesh"]["unused_vertices"], json!(1));
    // The file keeps its text, with coordinates added at all corners, those of dropped faces included.
    let (before, after) =
        ["odd.obj", "out.obj"].map(|name| std::fs::read_to_string(program.path(name)).expect("text")).into();
    let without: Vec<&str> = after.lines().filter(|line| !line.starts_with("vt ")).collect();
    for (before, after) in before.lines().zip(&without) {
        let bare: Vec<&str> = after.split(' ').map(|word| word.split('/').next().unwrap_or(word)).collect();
        assert_eq!(bare.join(" "), before);
        assert!(!after.starts_with('f') || after.split(' ').skip(1).all(|corner| corner.contains('/')), "{after}");
    }
    assert_eq!(without.len(), before.lines().count());
    program.run(&["check", "out.obj"]).expect(0);
    let refused = program.run(&["flatten", "odd.obj", "--repair", "none"]).expect(3);
    for name in ["duplicate-faces", "unreferenced-vertices", "repeated-vertices"] {
        assert!(refused.stderr.contains(name), "{name}: {}", refused.stderr);
    }
}

#[test]
fn a_closed_surface_is_refused_with_the_way_on_and_cut_open_where_that_is_asked_for() {
    let program = Program::new();
    program.write("closed.obj", &obj_text(&(&tetrahedron()).into()));
    let refused = program.run(&["flatten", "closed.obj"]).expect(3);
    assert_message("repair-closed-surface", &refused.stderr);
    let run = program.run(&["flatten", "closed.obj", "--cut", "shortest", "-o", "out.obj", "--report", "-"]);
    let report = run.expect(0).json();
    assert_eq!(repairs(&report), &json!([{"repair": "cut", "count": 3}]));
    // The proof applies to the file: its seams make it the disk that was flattened.
    let written = read_mesh(&program.path("out.obj")).expect("written").texture_mesh().expect("complete");
    let disk = DiskMesh::try_from(written.mesh).expect("cut along its seams");
    assert_eq!(disk.boundary_loop().len(), 6);
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["verdict"]["planar"], json!(true));
    assert_eq!(check["distortion"], report["distortion"]);
}

#[test]
fn a_pin_on_the_side_of_a_cut_that_is_new_is_met() {
    let program = Program::new();
    program.write("ring.obj", &obj_text(&(&band(8, 0)).into()));
    let arguments = ["flatten", "ring.obj", "--holes", "cut", "--cut", "shortest", "--report", "-"];
    let report = program.run(&[&arguments[..], &["--pin", "0:0,0", "--pin", "16:1,0"]].concat()).expect(0).json();
    assert_eq!(report["pins"]["unmet"], json!([]));
    assert_eq!(report["pins"]["count"], json!(2));
}

#[test]
fn a_soup_with_a_pole_is_written_with_coordinates_at_every_corner_and_proves_again() {
    // Quads around a pole with separate corners: two corners of each coincide with the pole.
    let program = Program::new();
    let (mut text, mut count) = (String::new(), 0);
    let at = |ring: u32, k: u32| {
        let (tilt, turn) = (f64::from(ring) * 0.3, f64::from(k % 8) * std::f64::consts::FRAC_PI_4);
        format!("v {} {} {}\n", tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos())
    };
    for (ring, k) in (0..4).flat_map(|ring| (0..8).map(move |k| (ring, k))) {
        text += &[at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)].concat();
        writeln!(text, "f {} {} {} {}", count + 1, count + 2, count + 3, count + 4).expect("memory");
        count += 4;
    }
    program.write("soup.obj", &text);
    program.run(&["flatten", "soup.obj", "--repair", "all", "--cut", "shortest", "-o", "out.obj"]).expect(0);
    let written = std::fs::read_to_string(program.path("out.obj")).expect("written");
    let faces = || written.lines().filter(|line| line.starts_with("f "));
    let is_mapped = |face: &str| face.split(' ').skip(1).all(|corner| corner.contains('/'));
    assert!(faces().count() >= 32 && faces().all(is_mapped), "{written}");
    program.run(&["check", "out.obj"]).expect(0);
}

#[test]
fn check_names_faces_as_the_file_counts_them() {
    let program = Program::new();
    // Two quads, one above the other.
    let quad = |z: u32| format!("v 0 0 {z}\nv 1 0 {z}\nv 1 1 {z}\nv 0 1 {z}\n");
    let text = [quad(0), quad(1), "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n".to_owned()].concat();
    program.write("in.obj", &(text + "f 1/1 2/2 3/3 4/4\nf 5/1 6/2 7/3 8/4\n"));
    let run = program.run(&["check", "in.obj", "--report", "out.json"]).expect(4);
    assert_message("repair-overlapping-charts", &run.stdout);
    let text = std::fs::read_to_string(program.path("out.json")).expect("written");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["atlas"]["overlapping_faces"], json!([[0, 1]]));
}

/// Two triangles side by side with a small gap along their common edge; the second has the opposite orientation.
const APART: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.001 0 0\nv 0.001 1 0\nv 1 1 .3\nf 1 2 3\nf 4 5 6\n";

#[test]
fn vertices_are_welded_within_the_distance_that_is_asked_for_and_the_file_keeps_its_positions() {
    let program = Program::new();
    program.write("apart.obj", APART);
    let report = |options: &[&str]| {
        let arguments = ["flatten", "apart.obj", "--report", "-", "--output", "out.obj"];
        program.run(&[&arguments[..], options].concat()).expect(0).json()
    };
    assert_eq!(report(&["--weld", "0.0009"])["charts"].as_array().map(Vec::len), Some(2));
    let welded = report(&["--weld", "0.002", "--repair", "safe,turn-faces"]);
    let expected = json!([{"repair": "weld-vertices", "count": 2}, {"repair": "turn-faces", "count": 1}]);
    assert_eq!((repairs(&welded), &welded["verdict"]["planar"]), (&expected, &json!(true)));
    let written = std::fs::read_to_string(program.path("out.obj")).expect("written");
    let kept = |text: &str| text.lines().filter(|line| line.starts_with("v ")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(kept(&written), kept(APART));
    // Both sides of the common edge have equal coordinates.
    let texture = read_mesh(&program.path("out.obj")).expect("a mesh").texture.expect("coordinates");
    let at = |corner: usize| texture.coordinates[texture.corners[corner] as usize];
    assert_eq!([at(1), at(2)], [at(3), at(4)]);
}

#[test]
fn repairs_are_chosen_one_by_one_and_an_unknown_one_is_refused_with_the_names_of_all() {
    let program = Program::new();
    program.write("apart.obj", APART);
    // Welded but not turned, the faces have conflicting orientations.
    let refused = program.run(&["flatten", "apart.obj", "--weld", "0.002", "--repair", "none"]).expect(3);
    assert!(refused.stderr.contains("mixed-orientation"), "{}", refused.stderr);
    program.run(&["flatten", "apart.obj", "--weld", "0.002", "--repair", "turn-faces"]).expect(0);
    let unknown = program.run(&["flatten", "apart.obj", "--repair", "safe,turn"]).expect(2);
    assert_message("repair-unknown", &unknown.stderr);
    for repair in Repair::CHOSEN {
        assert!(unknown.stderr.contains(repair.name()), "{repair:?}: {}", unknown.stderr);
    }
    let odd = ["-1", "nan", "inf", "1cm"];
    let messages = odd.map(|odd| program.run(&["flatten", "apart.obj", "--weld", odd]).expect(2).stderr);
    assert_message("repair-odd-distances", &messages.concat());
}

#[test]
fn welding_excuses_no_fault_of_the_file_where_nothing_may_be_repaired() {
    let program = Program::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .2\n";
    let faces = "f 1 2 3\nf 1 3 4\n";
    let apart = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 0\nv 0 1 .2\nv 0 0 0\nf 1 2 3\nf 6 4 5\n";
    let refused = [
        ("duplicate-faces", format!("{square}{faces}f 2 3 1\n")),
        ("repeated-vertices", format!("{square}{faces}f 2 3 3\n")),
        ("unreferenced-vertices", format!("{square}v 5 5 5\n{faces}")),
        // These are welded.
        ("duplicate-faces", format!("{apart}f 2 3 1\n")),
        ("unreferenced-vertices", apart.replace("f 1", "v 9 9 9\nf 1")),
    ];
    for (fault, text) in refused {
        program.write("in.obj", &text);
        for options in [&["--repair", "none"][..], &["--repair", "none", "--weld", "0"]] {
            let run = program.run(&[&["flatten", "in.obj"], options].concat()).expect(3);
            let is_joined = text.contains("v 0 1 .2\nv 0 0 0") && options.len() == 2;
            assert!(is_joined || run.stderr.contains(fault), "{fault}: {}", run.stderr);
        }
        let arguments = ["flatten", "in.obj", "--repair", "turn-faces", "--weld", "0", "--report", "-"];
        let run = program.run(&arguments);
        assert!(fault != "duplicate-faces" || run.stderr.contains(fault), "{}", run.stderr);
    }
    program.write("in.obj", apart);
    let arguments = ["flatten", "in.obj", "--repair", "none", "--weld", "0", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert_eq!(repairs(&report), &json!([{"repair": "weld-vertices", "count": 2}]));
}

#[test]
fn a_pin_of_a_vertex_that_was_joined_is_refused_with_the_vertex_to_pin() {
    let program = Program::new();
    let far = "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 7 8 9\n";
    let mut messages = BTreeSet::new();
    for text in [APART.to_owned(), format!("{APART}{far}")] {
        program.write("in.obj", &text);
        let arguments = ["flatten", "in.obj", "--weld", "0.01", "--repair", "all", "--pin", "3:0,0"];
        messages.insert(program.run(&arguments).expect(2).stderr);
        let pinned = [&arguments[..6], &["--pin", "1:0,0"]].concat();
        program.run(&pinned).expect(0);
    }
    program.write("in.obj", &APART.replace(".001", "").replace("v  ", "v 0 "));
    // Welded in place.
    messages.insert(program.run(&["flatten", "in.obj", "--repair", "all", "--pin", "3:0,0"]).expect(2).stderr);
    assert_message("repair-pin-of-a-joined-vertex", &String::from_iter(messages));
}

#[test]
fn a_distance_that_leaves_no_face_is_refused_by_name() {
    let program = Program::new();
    program.write("apart.obj", APART);
    let refused = |repairs| program.run(&["flatten", "apart.obj", "--weld", "5", "--repair", repairs]).expect(2).stderr;
    let messages = BTreeSet::from(["none", "safe", "all"].map(refused));
    assert_message("repair-distance-leaves-no-face", &String::from_iter(messages));
}

#[test]
fn new_vertices_of_a_welded_mesh_lie_on_the_edges_of_the_file() {
    let program = Program::new();
    // Two squares with facing sides 0.3 apart, which are joined.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.3 0 0.2\nv 2 0 0.1\nv 2 1 0\nv 1.3 1 0.2\n\
                f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n";
    program.write("in.obj", text);
    let pins = ["0:0,0", "1:1,1", "2:1,0", "3:0,1", "5:2,0", "6:2,1"].map(|pin| format!("--pin={pin}"));
    let arguments = ["flatten", "in.obj", "--weld", "0.5", "--method", "matchmaker", "-o", "out.obj", "--report", "-"];
    let pins: Vec<&str> = pins.iter().map(String::as_str).collect();
    program.run(&[&arguments[..], &pins].concat()).expect(0);
    let written = read_mesh(&program.path("out.obj")).expect("written").polygons;
    let file = read_mesh(&program.path("in.obj")).expect("a mesh").polygons;
    assert!(written.positions.len() > file.positions.len());
    for new in &written.positions[file.positions.len()..] {
        let lies_on = |a: glam::DVec3, b: glam::DVec3| a.distance(*new) + new.distance(b) - a.distance(b) < 1e-12;
        let mut edges = (0..file.face_count()).flat_map(|face| {
            let corners = file.face(face);
            (0..3).map(move |k| [corners[k], corners[(k + 1) % 3]].map(VertexId::index))
        });
        assert!(edges.any(|[a, b]| lies_on(file.positions[a], file.positions[b])), "{new}");
    }
}
