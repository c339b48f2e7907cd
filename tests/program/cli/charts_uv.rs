//! `--charts uv`: meshes cut along the seams of their texture coordinates.

use freebound_core::mesh::{Charts, PolygonMesh, Preparation, Repaired, parts};
use freebound_io::{MeshFile, NO_TEXTURE, Texture, read_mesh, write_obj};
use glam::DVec2;
use serde_json::json;

use super::charts::{assert_one_to_one, charts_proved};
use super::program::Program;
use freebound_testkit::many_parts::{interleaved, torus};
use freebound_testkit::{Random, assert_message, band, grid, quad_sheet};

/// Mesh with grouped faces: corners share a coordinate if they have equal vertex and group.
pub(crate) fn grouped(polygons: PolygonMesh, group: impl Fn(usize) -> usize) -> MeshFile {
    let count = polygons.positions.len();
    let groups = (0..polygons.face_count()).map(&group).max().map_or(0, |most| most + 1);
    let coordinates = (0..groups * count).map(|k| DVec2::new((k % count) as f64, (k / count) as f64)).collect();
    let at = |face: usize| polygons.face(face).iter().map(|v| v.index() + group(face) * count).collect::<Vec<_>>();
    let corners = (0..polygons.face_count()).flat_map(at).map(|k| u32::try_from(k).expect("few")).collect();
    MeshFile { texture: Some(Texture { coordinates, corners }), polygons, ..MeshFile::default() }
}

pub(crate) fn write(program: &Program, name: &str, file: &MeshFile) {
    let mut bytes = Vec::new();
    write_obj(&mut bytes, file, file.texture.as_ref().unwrap_or(&Texture::default())).expect("memory");
    program.write(name, std::str::from_utf8(&bytes).expect("text"));
}

fn repaired(file: &MeshFile, form: &Preparation) -> Repaired {
    form.repaired_along(&file.polygons, Some(&file.texture_labels().expect("coordinates")))
}

#[test]
fn the_charts_are_those_of_the_texture_coordinates() {
    let mut random = Random(3);
    let mut several = 0;
    for case in 0..60 {
        let sheet = quad_sheet(6, 5, 0.1, &mut random);
        let of_face: Vec<usize> = (0..sheet.face_count()).map(|_| random.index(3)).collect();
        let file = grouped(sheet, |face| of_face[face]);
        let found = repaired(&file, &Preparation::default());
        let texture = file.texture_mesh().expect("complete");
        let expected = parts(&texture.mesh).expect("pieces of a sheet");
        let are_disks = expected.iter().all(|part| part.loops().len() == 1);
        let charts = Charts::of(found);
        assert_eq!(charts.is_some(), are_disks && expected.len() > 1, "case {case}");
        let Some(charts) = charts else { continue };
        several += 1;
        // The parts found by `check` have these faces, in equal order.
        assert_eq!(charts.count(), expected.len());
        for (number, part) in expected.iter().enumerate() {
            let mut faces: Vec<u32> = part.face_of().iter().map(|face| texture.mesh.polygon(*face)).collect();
            let mut own = charts.chart(number).repaired.triangulate().polygon_of.expect("numbers of the file");
            faces.dedup();
            own.dedup();
            assert_eq!(own, faces, "case {case}");
        }
    }
    assert!(several > 20, "{several}");
}

#[test]
fn faces_turned_around_are_cut_along_the_same_seams() {
    let mut random = Random(5);
    let file = grouped(quad_sheet(6, 4, 0.1, &mut random), |face| face % 6 / 2);
    let as_given = repaired(&file, &Preparation::default());
    let turned = repaired(&file.turned(), &Preparation { faces_turned: true, ..Preparation::default() });
    assert_eq!(turned.polygons(), &as_given.polygons().turned());
    assert_eq!(turned.done(), as_given.done());
}

#[test]
fn each_chart_of_a_layout_is_flattened_packed_and_proved() {
    let program = Program::new();
    // The torus in twelve patches; most seams meet inside the surface.
    let file = grouped((&torus(8, 12)).into(), |face| face / 2 % 8 / 4 * 6 + face / 16 / 2);
    write(&program, "in.obj", &file);
    let run = program.run(&["flatten", "in.obj", "--charts", "uv", "-o", "out.obj", "--report", "-"]).expect(0);
    let atlas = &run.json()["atlas"];
    assert_eq!((&atlas["planar"], atlas["charts"].as_array().map(Vec::len)), (&json!(true), Some(12)));
    assert_eq!(charts_proved(&program, "out.obj"), 12);
    let written = read_mesh(&program.path("out.obj")).expect("written");
    assert_one_to_one(&written);
    assert_eq!(written.polygons, file.polygons);
    // Flattened again from the output, it is cut along equal seams.
    program.run(&["flatten", "out.obj", "--charts", "uv", "-o", "again.obj"]).expect(0);
    let [first, second] = ["out.obj", "again.obj"].map(|name| std::fs::read(program.path(name)).expect("written"));
    assert!(first == second, "the same layout");
}

#[test]
fn a_layout_of_one_chart_changes_nothing() {
    let program = Program::new();
    write(&program, "in.obj", &grouped((&grid(4, 3)).into(), |_| 0));
    program.run(&["flatten", "in.obj", "-o", "parts.obj"]).expect(0);
    program.run(&["flatten", "in.obj", "--charts", "uv", "-o", "uv.obj"]).expect(0);
    let [parts, uv] = ["parts.obj", "uv.obj"].map(|name| std::fs::read(program.path(name)).expect("written"));
    assert!(parts == uv);
}

#[test]
fn parts_that_have_seams_too_become_the_charts_of_both() {
    let program = Program::new();
    let meshes = [(&grid(4, 4)).into(), (&grid(3, 2)).into()];
    let source = interleaved(&meshes, &mut Random(8));
    let left = |face: usize| source.face(face).iter().any(|v| source.positions[v.index()].x < 1.5);
    let file = grouped(source.clone(), |face| usize::from(left(face)));
    write(&program, "in.obj", &file);
    program.run(&["flatten", "in.obj", "--charts", "uv", "-o", "out.obj"]).expect(0);
    assert_eq!(charts_proved(&program, "out.obj"), 3);
}

#[test]
fn a_chart_with_a_hole_is_cut_where_that_is_asked_for() {
    let program = Program::new();
    // A cylinder, whose two boundary loops wind around it.
    let ring = band(12, 0);
    write(&program, "in.obj", &grouped(interleaved(&[(&ring).into(), (&grid(2, 2)).into()], &mut Random(2)), |_| 0));
    let refused = program.run(&["flatten", "in.obj", "--charts", "uv", "--holes", "cut", "--report", "-"]).expect(3);
    let error = &refused.json()["error"];
    let faults = error["faults"].as_array().expect("a list");
    assert!(faults.iter().any(|fault| fault["kind"] == "several-boundary-loops"), "{error:#}");
    assert_message("charts-uv-hole-that-is-not-cut", &refused.stderr);
    program
        .run(&["flatten", "in.obj", "--charts", "uv", "--holes", "cut", "--cut", "shortest", "-o", "out.obj"])
        .expect(0);
    assert_eq!(charts_proved(&program, "out.obj"), 2);
}

#[test]
fn a_pin_on_a_seam_holds_the_side_that_comes_first() {
    let program = Program::new();
    let file = grouped((&grid(4, 2)).into(), |face| face / 2 % 4 / 2);
    write(&program, "in.obj", &file);
    // Vertices 2, 7 and 12 lie on the seam; the left half comes first.
    let pins = ["--pin", "2:0.5,0.125", "--pin", "12:0.5,0.625"];
    program.run(&[&["flatten", "in.obj", "--charts", "uv", "-o", "out.obj"], &pins[..]].concat()).expect(0);
    let written = read_mesh(&program.path("out.obj")).expect("written");
    let texture = written.texture.expect("coordinates");
    let at: Vec<DVec2> = (0..written.polygons.corners.len())
        .filter(|&corner| written.polygons.corners[corner].index() == 2)
        .map(|corner| texture.coordinates[texture.corners[corner] as usize])
        .collect();
    assert_eq!(at[0], DVec2::new(0.5, 0.125));
    assert_ne!(at[at.len() - 1], at[0], "the right half has a place of its own");
    assert!(texture.coordinates.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0));
    program.run(&["check", "out.obj"]).expect(0);
}

#[test]
fn a_file_without_all_coordinates_has_no_charts_of_them() {
    let program = Program::new();
    let mut file = grouped((&grid(2, 2)).into(), |_| 0);
    write(&program, "none.obj", &MeshFile { texture: None, ..file.clone() });
    let run = program.run(&["flatten", "none.obj", "--charts", "uv"]).expect(2);
    assert_message("charts-uv-no-texture-coordinates", &run.stderr);
    let texture = file.texture.as_mut().expect("coordinates");
    texture.corners[4] = NO_TEXTURE;
    write(&program, "some.obj", &file);
    let run = program.run(&["flatten", "some.obj", "--charts", "uv", "--report", "-"]).expect(3);
    let error = &run.json()["error"];
    assert_eq!([&error["kind"], &error["faults"][0]["faces"]], [&json!("texture-coordinates"), &json!([1])]);
}
