//! `freebound transfer` and `freebound bake`: layouts and pictures on other meshes.

use std::fs;

use freebound_core::geom::Picture;
use freebound_core::mesh::PolygonMesh;
use freebound_io::raster::write_png;
use freebound_io::{PictureFile, read_mesh};
use freebound_testkit::many_parts::ball;
use freebound_testkit::{assert_message, grid, shaped};
use glam::DVec3;
use serde_json::json;

use super::program::{Program, obj_text};

/// Folder with a fine ball that has a layout, and a coarse ball without.
fn balls() -> Program {
    let program = Program::new();
    program.write("fine.obj", &obj_text(&PolygonMesh::from(&ball(32, 20))));
    program.write("coarse.obj", &obj_text(&PolygonMesh::from(&ball(18, 11))));
    program.run(&["unwrap", "fine.obj", "-o", "fine-uv.obj"]).expect(0);
    program
}

fn put_picture(program: &Program, name: &str, picture: &Picture) {
    let mut bytes = Vec::new();
    write_png(picture, &mut bytes).expect("memory");
    fs::write(program.path(name), bytes).expect("the folder can be written to");
}

#[test]
fn a_layout_is_copied_to_a_coarser_mesh_and_proved_there() {
    let program = balls();
    for name in ["coarse-uv.obj", "coarse-uv.ply", "coarse-uv.glb"] {
        let report = program.run(&["transfer", "fine-uv.obj", "coarse.obj", "-o", name, "--report", "-"]).expect(0);
        let report = report.json();
        assert_eq!(report["layout"]["planar"], json!(true), "{name}");
        assert_eq!(report["transfer"]["by"], json!("nearest-points"));
        let [largest, diagonal] = ["largest_distance", "diagonal"].map(|field| report["transfer"][field].as_f64());
        assert!(largest < diagonal.map(|diagonal| 0.02 * diagonal), "{name}: {report}");
        // The file agrees with its report.
        let checked = program.run(&["check", name, "--report", "-"]).expect(0).json();
        assert_eq!(checked["layout"]["planar"], json!(true), "{name}");
        assert_eq!(checked["layout"]["charts"], report["layout"]["charts"], "{name}");
    }
}

#[test]
fn meshes_with_equal_faces_are_matched_corner_by_corner_whatever_their_shape() {
    let program = balls();
    let squashed = ball(32, 20).positions.iter().map(|p| *p * DVec3::new(1.0, 3.0, 0.1)).collect();
    let mesh = PolygonMesh { positions: squashed, ..PolygonMesh::from(&ball(32, 20)) };
    program.write("squashed.obj", &obj_text(&mesh));
    let run = program.run(&["transfer", "fine-uv.obj", "squashed.obj", "-o", "out.obj", "--report", "-"]).expect(0);
    assert_eq!(run.json()["transfer"], json!({"by": "corners"}));
    let [given, copied] = ["fine-uv.obj", "out.obj"].map(|name| read_mesh(&program.path(name)).expect("a mesh"));
    assert_eq!(given.texture_mesh().expect("a layout").embedding, copied.texture_mesh().expect("a layout").embedding);
    assert_eq!(copied.polygons.positions, mesh.positions);
}

#[test]
fn a_copy_that_is_not_planar_is_written_and_said() {
    let program = Program::new();
    // Two sheets on one layout.
    let text = obj_text(&PolygonMesh::from(&grid(3, 3)));
    program.write("plain.obj", &text);
    program.run(&["flatten", "plain.obj", "-o", "sheet.obj"]).expect(0);
    let mut double = grid(3, 3);
    let lifted = double.positions.iter().map(|p| *p + 0.001 * DVec3::Z).collect::<Vec<_>>();
    let offset = u32::try_from(double.positions.len()).expect("few");
    double.triangles.extend(
        grid(3, 3).triangles.iter().map(|t| t.map(|v| freebound_core::mesh::VertexId::new(v.number() + offset))),
    );
    double.positions.extend(lifted);
    program.write("double.obj", &obj_text(&PolygonMesh::from(&double)));
    let run = program.run(&["transfer", "sheet.obj", "double.obj", "-o", "out.obj"]).expect(4);
    assert!(run.stdout.contains("error overlap") || run.stdout.contains("error stacked"), "{}", run.stdout);
    assert!(program.path("out.obj").is_file());
}

#[test]
fn a_mesh_without_a_layout_an_empty_mesh_and_an_input_as_output_are_refused() {
    let program = balls();
    let run = program.run(&["transfer", "coarse.obj", "fine.obj", "-o", "out.obj"]).expect(3);
    assert_message("transfer-no-layout", &run.stderr);
    program.write("empty.obj", "v 0 0 0\n");
    let run = program.run(&["transfer", "fine-uv.obj", "empty.obj", "-o", "out.obj"]).expect(3);
    assert_message("transfer-no-faces", &run.stderr);
    for output in ["fine-uv.obj", "coarse.obj"] {
        program.run(&["transfer", "fine-uv.obj", "coarse.obj", "-o", output]).expect(2);
    }
    program.run(&["transfer", "-", "-", "-o", "out.obj"]).expect(2);
    assert!(!program.path("out.obj").exists());
}

#[test]
fn meshes_that_lie_apart_are_copied_with_a_warning() {
    let program = balls();
    let away = ball(18, 11).positions.iter().map(|p| *p + 3.0 * DVec3::X).collect();
    let mesh = PolygonMesh { positions: away, ..PolygonMesh::from(&ball(18, 11)) };
    program.write("away.obj", &obj_text(&mesh));
    let run = program.run(&["transfer", "fine-uv.obj", "away.obj", "-o", "out.obj"]);
    assert!(run.stdout.contains("lie apart"), "{}", run.stdout);
}

#[test]
fn the_file_is_the_same_for_any_number_of_threads() {
    let program = balls();
    let written = |threads: &str, name: &str| {
        let mut command = program.command(&["transfer", "fine-uv.obj", "coarse.obj", "-o", name]);
        let status = command.env("RAYON_NUM_THREADS", threads).status().expect("the program starts");
        assert_eq!(status.code(), Some(0));
        fs::read(program.path(name)).expect("a file")
    };
    assert!(written("1", "one.obj") == written("3", "three.obj"));
}

#[test]
fn a_picture_is_drawn_for_the_layout_of_another_mesh() {
    let program = Program::new();
    // The picture of the old layout is red where the sheet's x is small, and blue where it is large.
    let mesh = shaped(9, 9, |x, y| DVec3::new(x / 9.0, y / 9.0, 0.0));
    program.write("sheet.obj", &obj_text(&PolygonMesh::from(&mesh)));
    program
        .run(&["flatten", "sheet.obj", "-o", "old.obj", "--fit", "unit", "--pin", "0:0,0", "--pin", "9:1,0"])
        .expect(0);
    program
        .run(&["flatten", "sheet.obj", "-o", "new.obj", "--fit", "unit", "--pin", "0:1,1", "--pin", "9:0,1"])
        .expect(0);
    let row = |_: u32| (0..64).flat_map(|x| if x < 32 { [255, 0, 0, 255] } else { [0, 0, 255, 255] });
    put_picture(&program, "old.png", &Picture { width: 64, height: 64, pixels: (0..64).flat_map(row).collect() });
    let arguments = ["bake", "old.obj", "new.obj", "--picture", "old.png", "-o", "new.png", "--report", "-"];
    let report = program.run(&arguments).expect(0).json();
    assert!(report["baked"]["covered"].as_f64() > Some(0.9), "{report}");
    let drawn = PictureFile::read(&program.path("new.png")).expect("a picture").pixels;
    assert_eq!([drawn.width, drawn.height], [64, 64]);
    // The sheet is turned by a half: small x lies on the right now.
    assert_eq!(drawn.pixel(50, 30), Some([255, 0, 0, 255]));
    assert_eq!(drawn.pixel(14, 30), Some([0, 0, 255, 255]));
}

#[test]
fn the_picture_of_the_materials_is_the_usual_one_and_its_lack_is_said() {
    let program = Program::new();
    let text = obj_text(&PolygonMesh::from(&grid(3, 3)));
    program.write("sheet.obj", &text);
    program.run(&["flatten", "sheet.obj", "-o", "plain.obj"]).expect(0);
    let run = program.run(&["bake", "plain.obj", "plain.obj", "-o", "new.png"]).expect(2);
    assert_message("bake-no-picture", &run.stderr);
    put_picture(&program, "skin.png", &Picture::filled(8, 4, [9, 8, 7, 255]));
    program.run(&["flatten", "sheet.obj", "--picture", "skin.png", "-o", "painted.obj"]).expect(0);
    program.run(&["bake", "painted.obj", "plain.obj", "-o", "new.png", "--size", "40x20"]).expect(0);
    let drawn = PictureFile::read(&program.path("new.png")).expect("a picture").pixels;
    assert_eq!([drawn.width, drawn.height], [40, 20]);
    assert!(drawn.pixels.chunks(4).any(|pixel| pixel == [9, 8, 7, 255]));
    for output in ["painted.obj", "skin.png", "new.jpg"] {
        program.run(&["bake", "painted.obj", "plain.obj", "--picture", "skin.png", "-o", output]).expect(2);
    }
    program.run(&["bake", "painted.obj", "sheet.obj", "-o", "other.png"]).expect(3);
    assert!(!program.path("other.png").exists());
}

/// A ball of another size, at another place.
fn moved_ball() -> PolygonMesh {
    let mut mesh = ball(32, 20);
    mesh.positions.iter_mut().for_each(|p| *p = 20.0 * *p + DVec3::new(40.0, 3.0, -7.0));
    PolygonMesh::from(&mesh)
}

#[test]
fn meshes_of_different_size_and_place_are_fitted_on_request_and_named_otherwise() {
    let program = balls();
    program.write("moved.obj", &obj_text(&moved_ball()));
    program.run(&["unwrap", "moved.obj", "-o", "moved-uv.obj"]).expect(0);
    let apart = program.run(&["transfer", "moved-uv.obj", "coarse.obj"]);
    assert!(apart.stdout.contains("--fit"), "{}", apart.stdout);
    let fitted = program.run(&["transfer", "moved-uv.obj", "coarse.obj", "--fit", "-o", "out.obj", "--report", "-"]);
    let report = fitted.expect(0).json();
    assert_eq!(report["layout"]["planar"], json!(true));
    let [mean, diagonal, of_mesh] = ["mean_distance", "diagonal", "mesh_diagonal"]
        .map(|field| report["transfer"][field].as_f64().expect("a number"));
    assert!(mean < 0.01 * diagonal && (diagonal - of_mesh).abs() < 1e-9 * of_mesh, "{report}");
}

#[test]
fn a_smaller_mesh_within_the_box_of_the_layout_lies_apart_and_a_part_of_it_does_not() {
    let program = balls();
    let shrunk = |by: f64| {
        let positions = ball(18, 11).positions.iter().map(|p| by * *p).collect();
        PolygonMesh { positions, ..PolygonMesh::from(&ball(18, 11)) }
    };
    // Apart by 3.5 % of the diagonal on average, less than surfaces of one size may be.
    program.write("shrunk.obj", &obj_text(&shrunk(0.75)));
    let warned = program.run(&["transfer", "fine-uv.obj", "shrunk.obj"]);
    assert!(warned.stdout.contains("--fit"), "{}", warned.stdout);
    let mut part = ball(18, 11);
    part.triangles.truncate(60);
    program.write("part.obj", &obj_text(&PolygonMesh::from(&part)));
    let silent = program.run(&["transfer", "fine-uv.obj", "part.obj"]);
    assert!(!silent.stdout.contains("--fit"), "{}", silent.stdout);
}

#[test]
fn the_picture_of_a_glb_file_is_baked_and_others_are_named() {
    let program = balls();
    put_picture(&program, "red.png", &Picture { width: 2, height: 2, pixels: [200, 10, 20, 255].repeat(4) });
    let with_library = |uses: &str| {
        let text = fs::read_to_string(program.path("fine-uv.obj")).expect("the layout");
        program.write("painted.obj", &format!("mtllib painted.mtl\n{}", text.replacen("\nf ", uses, 1)));
    };
    program.write("painted.mtl", "newmtl a\nmap_Kd red.png\nnewmtl b\nmap_Kd blue.png\n");
    with_library("\nusemtl a\nf ");
    program.run(&["pack", "painted.obj", "-o", "painted.glb"]).expect(0);
    program.run(&["bake", "painted.glb", "fine-uv.obj", "-o", "baked.png", "--size", "32x32"]).expect(0);
    let baked = PictureFile::read(&program.path("baked.png")).expect("a picture").pixels;
    let shown = baked.pixels.chunks(4).filter(|pixel| pixel[3] > 0);
    assert!(shown.clone().count() > 100 && shown.clone().all(|pixel| pixel == [200, 10, 20, 255]));
    with_library("\nusemtl b\nf 1 2 3\nusemtl a\nf ");
    let run = program.run(&["bake", "painted.obj", "fine-uv.obj", "-o", "baked.png", "--size", "32x32"]);
    let said = run.expect(0).stderr;
    assert!(said.contains("2 pictures") && said.contains("red.png"), "{said}");
}
