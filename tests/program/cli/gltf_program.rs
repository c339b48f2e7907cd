//! Reading and writing glTF files with the program: buffers and pictures, seams of exporters, and no overwritten
//! inputs.

use std::fs;

use freebound_io::read_mesh;
use serde_json::{Value, json};

use super::program::Program;
use freebound_testkit::assert_message;
use freebound_testkit::glb::{GlbMaker, U16, json_of, plain, read, read_unique, written};

/// Ball as exporters write it: doubled vertices along the seam and at the poles, and degenerate triangles there.
fn ball(columns: u32, rows: u32) -> GlbMaker {
    let mut maker = GlbMaker::new();
    let (mut positions, mut texture, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for y in 0..=rows {
        for x in 0..=columns {
            let around = std::f32::consts::TAU * (x % columns) as f32 / columns as f32;
            let down = std::f32::consts::PI * y as f32 / rows as f32;
            let radius = if y == 0 || y == rows { 0.0 } else { down.sin() };
            positions.extend([radius * around.cos(), down.cos(), radius * around.sin()]);
            texture.extend([x as f32 / columns as f32, y as f32 / rows as f32]);
            if y < rows && x < columns {
                let [a, b] = [y * (columns + 1) + x, (y + 1) * (columns + 1) + x];
                indices.extend([a, a + 1, b, a + 1, b + 1, b]);
            }
        }
    }
    let position = maker.floats("VEC3", &positions);
    let uv = maker.floats("VEC2", &texture);
    let indices = maker.integers("SCALAR", U16, &indices);
    let attributes = json!({"POSITION": position, "NORMAL": position, "TEXCOORD_0": uv});
    maker.push("meshes", json!({"primitives": [{"attributes": attributes, "indices": indices}]}));
    maker.push("nodes", json!({"mesh": 0}));
    maker
}

#[test]
fn a_ball_with_the_seams_of_its_exporter_is_one_closed_surface_and_two_balls_become_two_charts() {
    let program = Program::new();
    let mut maker = ball(12, 8);
    fs::write(program.path("ball.glb"), maker.glb()).expect("written");
    let closed = read(&maker.glb()).polygons;
    assert_eq!(closed.positions.len(), 12 * 7 + 2, "welded");
    let refused = program.run(&["flatten", "ball.glb"]).expect(3);
    assert!(refused.stderr.contains("closed"), "{}", refused.stderr);
    let options = ["--repair", "all", "--cut", "shortest"];
    program.run(&[&["flatten", "ball.glb", "-o", "one.glb"][..], &options].concat()).expect(0);
    program.run(&["check", "one.glb"]).expect(0);
    maker.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}]);
    fs::write(program.path("balls.glb"), maker.glb()).expect("written");
    let balls = [&["flatten", "balls.glb", "--report", "-", "-o", "two.glb"][..], &options].concat();
    let charts = |arguments: &[&str]| {
        let report = program.run(&[&balls, arguments].concat()).expect(0).json();
        let count = report["charts"].as_array().map_or(1, Vec::len);
        let json = json_of(&fs::read(program.path("two.glb")).expect("it is there"));
        (count, json["meshes"].as_array().map_or(0, Vec::len), report["mesh"]["warnings"].clone())
    };
    let shared = json!([{"kind": "shared-instances", "count": 1}]);
    assert_eq!(charts(&[]), (1, 1, shared), "both nodes share one mesh and its map");
    program.run(&["check", "two.glb"]).expect(0);
    program.run(&["check", "two.glb", "--unique-instances"]).expect(4);
    assert_eq!(charts(&["--unique-instances"]), (2, 2, Value::Null), "each node has a mesh of its own");
    program.run(&["check", "two.glb", "--unique-instances"]).expect(0);
    let found = read_unique(&fs::read(program.path("two.glb")).expect("it is there")).unwrap();
    assert_eq!(found.polygons, read_unique(&maker.glb()).unwrap().polygons, "the surface is what it was");
}

#[test]
fn files_that_belong_to_a_mesh_are_not_written_over() {
    let program = Program::new();
    let mut maker = plain(4, U16);
    maker.json["images"] = json!([{"uri": "skin.png"}]);
    fs::write(program.path("skin.png"), b"\x89PNG\r\n\x1a\n").expect("written");
    fs::write(program.path("all.bin"), &maker.binary).expect("written");
    fs::write(program.path("in.gltf"), maker.finished(Some("all.bin".into())).to_string()).expect("written");
    for (option, name) in [("--report", "all.bin"), ("--png", "skin.png"), ("-o", "in.gltf")] {
        let before = fs::read(program.path(name)).expect("it is there");
        program.run(&["flatten", "in.gltf", option, name]).expect(2);
        assert_eq!(fs::read(program.path(name)).expect("it is there"), before, "{name}");
    }
}

#[test]
fn the_program_reads_and_writes_glb_files_and_takes_pictures_and_buffers_along() {
    let program = Program::new();
    let mut maker = plain(4, U16);
    maker.json["images"] = json!([{"uri": "skin.png"}, {"uri": "missing.png"}]);
    fs::write(program.path("skin.png"), b"\x89PNG\r\n\x1a\n").expect("written");
    fs::write(program.path("all.bin"), &maker.binary).expect("written");
    fs::write(program.path("in.gltf"), maker.finished(Some("all.bin".into())).to_string()).expect("written");
    program.run(&["flatten", "in.gltf", "-o", "out.glb"]).expect(0);
    program.run(&["check", "out.glb"]).expect(0);
    let glb = fs::read(program.path("out.glb")).expect("it is there");
    let json = json_of(&glb);
    assert_eq!(json["images"][0]["mimeType"], "image/png");
    assert_eq!(json["images"][1], json!({"uri": "missing.png"}));
    let blob = gltf::Gltf::from_slice(&glb).expect("another reader takes it").blob.expect("a chunk");
    let view = &json["bufferViews"][usize::try_from(json["images"][0]["bufferView"].as_u64().unwrap()).unwrap()];
    let begin = usize::try_from(view["byteOffset"].as_u64().unwrap()).unwrap();
    assert!(blob[begin..].starts_with(b"\x89PNG\r\n\x1a\n"));
    let refused = program.run(&["flatten", "out.glb", "-o", "out.gltf"]).expect(2);
    assert_message("gltf-program-not-written", &refused.stderr);
    program.run(&["flatten", "out.glb", "-o", "out.obj"]).expect(0);
    program.run(&["flatten", "out.obj", "-o", "again.GLB"]).expect(0);
    program.run(&["check", "again.GLB"]).expect(0);
    let file = read_mesh(&program.path("again.GLB")).expect("it is right");
    assert_eq!(file.polygons.positions.len(), 25);
}

#[test]
fn what_a_file_holds_compressed_beside_what_is_read_does_not_come_along() {
    let mut maker = plain(3, U16);
    maker.json["bufferViews"][0]["extensions"] =
        json!({"EXT_meshopt_compression": {"buffer": 1, "byteLength": 4}, "EXT_other": {"kept": 1}});
    maker.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}, "EXT_other": {"kept": 2}});
    let file = read(&maker.glb());
    let after = json_of(&written(&file, file.texture.as_ref().expect("it has some")));
    assert_eq!(after["bufferViews"][0]["extensions"], json!({"EXT_other": {"kept": 1}}));
    assert_eq!(after["meshes"][0]["primitives"][0]["extensions"], json!({"EXT_other": {"kept": 2}}));
}

#[test]
fn what_the_format_of_the_written_mesh_does_not_hold_is_named() {
    let program = Program::new();
    let mut maker = plain(4, U16);
    let tangents = maker.floats("VEC4", &[1.0, 0.0, 0.0, 1.0].repeat(25));
    maker.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
    maker.json["meshes"][0]["name"] = json!("sheet");
    maker.json["materials"] = json!([{"name": "A"}]);
    maker.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    maker.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [9, 0, 0]}]);
    fs::write(program.path("in.glb"), maker.glb()).expect("written");
    let edge =
        "o a\nv 0 0 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nvn 0 0 1\nvn 1 0 0\nusemtl b\nf 1//1 2//1 3//1\nf 2//2 4//2 3//2\n";
    program.write("in.obj", edge);
    let colours = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 1 2 3 9\n1 0 0 1 2 3 9\n0 1 0 1 2 3 9\n3 0 1 2\n";
    program.write("in.ply", colours);
    let cases = [
        ("in.glb", "out.glb", json!(["tangents"])),
        ("in.glb", "out.obj", json!(["materials", "names", "tangents", "copies"])),
        ("in.obj", "out.obj", Value::Null),
        ("in.obj", "out.glb", json!(["names"])),
        ("in.obj", "out.ply", json!(["materials", "names", "normals"])),
        ("in.ply", "out.ply", Value::Null),
        ("in.ply", "out.glb", Value::Null),
        ("in.ply", "out.obj", json!(["colours"])),
    ];
    for (from, to, wanted) in cases {
        let report = program.run(&["flatten", from, "-o", to, "--report", "-"]).expect(0).json();
        assert_eq!(report["not_kept"], wanted, "{from} to {to}");
    }
    program.run(&["flatten", "in.obj", "-o", "flat.obj"]).expect(0);
    let report = program.run(&["pack", "flat.obj", "-o", "out.ply", "--report", "-"]).expect(0).json();
    assert_eq!(report["not_kept"], json!(["materials", "names", "normals"]));
    let kept =
        program.run(&["flatten", "out.glb", "--start", "uv", "-o", "again.glb", "--report", "-"]).expect(0).json();
    assert_eq!(kept["not_kept"], Value::Null, "the texture coordinates are as they were");
}
