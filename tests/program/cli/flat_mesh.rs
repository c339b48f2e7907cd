//! `--flat-mesh`: the layout as geometry in the plane z = 0.

use freebound_core::mesh::PolygonMesh;
use freebound_io::{MeshFile, read_mesh};
use freebound_testkit::cubes::cube;
use freebound_testkit::many_parts::ball;
use freebound_testkit::{Random, assert_message, quad_sheet};
use glam::DVec3;

use super::program::{Program, obj_text};

/// Area of all polygons, split as a fan from their first corner.
fn area(mesh: &PolygonMesh) -> f64 {
    let at = |corner: usize| mesh.positions[mesh.corners[corner].index()];
    let of_face = |face: usize| {
        let range = mesh.corner_range(face);
        let fan = range.start + 1..range.end - 1;
        let doubled: DVec3 = fan.map(|k| (at(k) - at(range.start)).cross(at(k + 1) - at(range.start))).sum();
        doubled.length() / 2.0
    };
    (0..mesh.face_count()).map(of_face).sum()
}

/// Largest difference between positions and texture coordinates at one scale.
fn difference(file: &MeshFile, scale: f64) -> f64 {
    let texture = file.texture.as_ref().expect("a layout");
    let corners = file.polygons.corners.iter().zip(&texture.corners);
    let apart = corners.map(|(vertex, &corner)| {
        let position = file.polygons.positions[vertex.index()];
        position.distance((scale * texture.coordinates[corner as usize]).extend(0.0))
    });
    apart.fold(0.0, f64::max)
}

#[test]
fn a_flat_mesh_has_the_polygons_and_the_area_of_the_surface_and_lies_like_its_layout() {
    let program = Program::new();
    let sheet = quad_sheet(7, 5, 0.3, &mut Random(3));
    // The area of a bent quad depends on its diagonal.
    for (name, mesh, tolerance) in [("ball", PolygonMesh::from(&ball(24, 15)), 1e-4), ("sheet", sheet, 0.05)] {
        program.write("in.obj", &obj_text(&mesh));
        let arguments = ["unwrap", "in.obj", "-o", "uv.obj", "--flat-mesh"];
        for flat in ["flat.obj", "flat.ply", "flat.glb"] {
            program.run(&[&arguments[..], &[flat]].concat()).expect(0);
            let [uv, flat] = ["uv.obj", flat].map(|name| read_mesh(&program.path(name)).expect("a mesh"));
            let triangles = |file: &MeshFile| file.polygons.corners.len() - 2 * file.polygons.face_count();
            assert_eq!(triangles(&flat), triangles(&uv), "{name}");
            assert!(flat.polygons.positions.iter().all(|p| p.z == 0.0), "{name}");
            let (before, after) = (area(&mesh), area(&flat.polygons));
            assert!((before - after).abs() < tolerance * before, "{name}: {before} {after}");
            let sizes = |file: &MeshFile| {
                let longest = file.polygons.positions.iter().map(|p| p.truncate().max_element()).fold(0.0, f64::max);
                let coordinates = &file.texture.as_ref().expect("a layout").coordinates;
                longest / coordinates.iter().map(|uv| uv.max_element()).fold(0.0, f64::max)
            };
            let scale = sizes(&flat);
            assert!(difference(&flat, scale) < 1e-5 * scale, "{name}: {}", difference(&flat, scale));
        }
    }
}

#[test]
fn parts_that_are_left_out_are_not_in_the_flat_mesh() {
    let program = Program::new();
    let mut text = obj_text(&PolygonMesh::from(&ball(8, 6)));
    text += "v 9 0 0\nv 10 0 0\nv 9 1 0\nvt 0.5 0.5\nvt 0.6 0.5\nvt 0.5 0.6\nf -3/-3 -2/-2 -1/-1\n";
    program.write("in.obj", &text);
    program.run(&["unwrap", "in.obj", "--parts", "largest", "--flat-mesh", "flat.obj"]).expect(0);
    let flat = read_mesh(&program.path("flat.obj")).expect("a mesh");
    assert_eq!(flat.polygons.face_count(), ball(8, 6).face_count());
}

#[test]
fn quads_stay_quads() {
    let program = Program::new();
    program.write("cube.obj", &obj_text(&cube()));
    program.run(&["unwrap", "cube.obj", "--flat-mesh", "flat.obj"]).expect(0);
    let flat = read_mesh(&program.path("flat.obj")).expect("a mesh");
    assert_eq!(flat.polygons.face_count(), 6);
    assert!((0..6).all(|face| flat.polygons.corner_range(face).len() == 4));
    // Each square of the cube stays a unit square.
    assert!((area(&flat.polygons) - area(&cube())).abs() < 1e-9);
}

#[test]
fn a_flat_mesh_that_cannot_be_written_is_refused_before_the_run() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&PolygonMesh::from(&ball(8, 6))));
    let cases = [("flat.stl", "flat-mesh-format"), ("-", "flat-mesh-stream"), ("in.obj", "flat-mesh-over-input")];
    for (path, name) in cases {
        let run = program.run(&["unwrap", "in.obj", "--flat-mesh", path]).expect(2);
        assert_message(name, &run.stderr);
    }
    let twice = program.run(&["unwrap", "in.obj", "-o", "out.obj", "--flat-mesh", "out.obj"]).expect(2);
    assert_message("flat-mesh-twice", &twice.stderr);
    assert_eq!(program.files(), ["in.obj"]);
}
