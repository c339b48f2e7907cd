//! Runs that once never ended: a stage's result, rejected by the verdict, was requested again and again.

use freebound_core::mesh::{PolygonMesh, VertexId};
use glam::DVec3;

use super::program::{Program, obj_text};
use freebound_testkit::{Random, grid, quad_sheet};

/// Eight by eight quads. One quad contains a vertex with only two edges: two polygons that cannot both be convex.
fn with_bare_vertex() -> PolygonMesh {
    let mut mesh = quad_sheet(8, 8, 0.0, &mut Random(1));
    let quad: Vec<VertexId> = mesh.face(27).to_vec();
    let middle: DVec3 = quad.iter().map(|v| mesh.positions[v.index()]).sum::<DVec3>() / 4.0;
    let bare = VertexId::from_index(mesh.positions.len());
    mesh.positions.push(middle + 0.1 * DVec3::Z);
    let range = mesh.corner_range(27);
    mesh.corners.splice(range, [quad[0], quad[1], quad[2], bare, quad[0], bare, quad[2], quad[3]]);
    let starts = mesh.starts.as_mut().expect("polygons");
    starts.iter_mut().skip(28).for_each(|start| *start += 4);
    starts.insert(28, starts[28] - 4);
    mesh
}

#[test]
fn constraints_on_polygons_that_cannot_be_convex_come_to_an_end() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&with_bare_vertex()));
    let pins = ["--pin", "0:0,0", "--pin", "8:1,0", "--pin", "80:1,1", "--pin", "72:0,1.2"];
    let run = |options: &[&str]| program.run(&[&["flatten", "in.obj"][..], &pins, options].concat());
    let ended = run(&["--report", "-", "-o", "out.obj"]).expect(0).json();
    let stages: Vec<&str> =
        ended["steps"].as_array().unwrap().iter().filter_map(|step| step["stage"].as_str()).collect();
    assert!(stages.contains(&"cut") && !stages.contains(&"matchmaker"), "a cut makes no new vertices: {stages:?}");
    for options in [&["--no-new-vertices"][..], &["--method", "continuation"], &["--no-new-vertices", "--relax", "30"]]
    {
        let verdict = &run(&[options, &["--report", "-"]].concat()).expect(4).json()["verdict"];
        let concave = verdict["concave_polygons"].as_array().expect("a list");
        assert!(!concave.is_empty(), "{options:?}: {verdict}");
    }
}

#[test]
fn collinear_targets_at_an_aspect_come_to_an_end() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&quad_sheet(6, 6, 0.0, &mut Random(1))));
    let pins = ["--pin", "16:0.1,0.1", "--pin", "17:0.2,0.2", "--pin", "24:0.3,0.3"];
    let run = program.run(&[&["flatten", "in.obj", "--aspect", "3:1", "--report", "-"][..], &pins].concat());
    assert!(matches!(run.status, Some(0 | 4)), "{run:?}");
    assert_eq!(run.json()["verdict"]["planar"] == true, run.status == Some(0));
}

#[test]
fn targets_beside_which_numbers_run_out_come_to_an_end() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&PolygonMesh::from(&grid(12, 12))));
    let pin = |vertex: u32, x: &str, y: &str| ["--pin".to_owned(), format!("{vertex}:{x},{y}")];
    let (near, far) = ("400000000000000", "400000000000000.5");
    let pins = [pin(0, near, "0"), pin(12, far, "0"), pin(156, near, "0.5"), pin(168, far, "0.5")].concat();
    let pins: Vec<&str> = pins.iter().map(String::as_str).collect();
    let run = program.run(&[&["flatten", "in.obj"][..], &pins].concat());
    assert_eq!(run.status, Some(4), "{run:?}");
}
