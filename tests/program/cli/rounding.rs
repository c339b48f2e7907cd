//! Texture coordinates of 32 bits: the verdict applies to these rounded numbers, and corners move if the nearest
//! ones fold a face.

use std::collections::BTreeSet;

use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{RoundingGrid, is_planar, rounded};
use freebound_io::read_mesh;
use glam::DVec2;
use proptest::prelude::*;

use super::program::{Program, coordinates_by_vertex, obj_text};
use freebound_testkit::{Random, assert_message, grid, quad_sheet};

#[expect(clippy::cast_possible_truncation, reason = "that is what is asked")]
fn is_f32(x: f64) -> bool {
    f64::from(x as f32) == x
}

proptest! {
    #[test]
    fn numbers_below_a_turned_axis_are_of_32_bits_and_turn_over_without_rounding(
        u in -1e6..1e6_f64,
        v in prop_oneof![-2.0..2.0_f64, -1e-7..1e-7_f64, 0.999_999..1.000_001_f64, -1e9..1e9_f64],
    ) {
        let z = RoundingGrid::TurnedOver.nearest(DVec2::new(u, v));
        prop_assert!(is_f32(z.x) && is_f32(1.0 - z.y));
        prop_assert_eq!(1.0 - (1.0 - z.y), z.y);
        // Half a unit in the last place of 1 − v, and half of the 64-bit unit of v.
        let unit = f64::from(f32::EPSILON) * (1.0 - v).abs() + f64::EPSILON;
        prop_assert!((z.y - v).abs() <= unit, "{} {}", z.y, v);
        let z = RoundingGrid::Upright.nearest(DVec2::new(u, v));
        prop_assert!(is_f32(z.x) && is_f32(z.y));
        prop_assert!((z.y - v).abs() <= f64::from(f32::EPSILON) * v.abs());
    }
}

/// Grid with squares of `units` units in the last place, each vertex displaced by at most `jitter` of that.
fn fine_map(mesh: &DiskMesh, units: f64, jitter: f64, random: &mut Random) -> Embedding {
    // Units of numbers between one half and 1.
    let size = units * f64::from(f32::EPSILON) / 2.0;
    let mut off = || jitter * (2.0 * random.unit() - 1.0);
    let positions = &mesh.mesh().positions;
    positions.iter().map(|p| DVec2::new(0.6, 0.7) + size * (p.truncate() + DVec2::new(off(), off()))).collect()
}

#[test]
fn where_the_nearest_numbers_fold_faces_corners_move_by_a_few_units_until_it_is_proved() {
    let disk = DiskMesh::try_from(grid(6, 6)).expect("a disk");
    let held: BTreeSet<VertexId> = [0, 17, 24].map(VertexId::new).into();
    let (mut folded, mut rescued) = (0, 0);
    for seed in 0..60 {
        let map = fine_map(&disk, 2.0, 0.3, &mut Random(seed));
        let grid = if seed % 2 == 0 { RoundingGrid::Upright } else { RoundingGrid::TurnedOver };
        let nearest: Embedding = map.iter().map(|&z| grid.nearest(z)).collect();
        let found = rounded(&disk, &map, grid, &held);
        assert!(is_planar(&disk, &map));
        assert!(found.embedding.iter().all(|z| is_f32(z.x) && is_f32(if seed % 2 == 0 { z.y } else { 1.0 - z.y })));
        for vertex in &held {
            assert_eq!(found.embedding[*vertex], nearest[*vertex], "held");
        }
        let farthest = map.iter().zip(found.embedding.iter()).map(|(a, b)| (*a - *b).abs().max_element());
        // Four units of numbers up to 1, and half a unit more.
        assert!(farthest.fold(0.0, f64::max) <= 4.5 * f64::from(f32::EPSILON) / 2.0);
        if is_planar(&disk, &nearest) {
            assert_eq!((found.embedding, found.moved), (nearest, 0), "nothing is moved without need");
        } else {
            folded += 1;
            rescued += usize::from(is_planar(&disk, &found.embedding));
            assert!(found.moved > 0);
            assert_eq!(rounded(&disk, &map, grid, &held), found, "the same each time");
        }
    }
    assert!(folded >= 10 && rescued == folded, "{rescued} of {folded}");
}

#[test]
fn what_is_folded_already_or_too_fine_is_rounded_and_no_more() {
    let disk = DiskMesh::try_from(grid(40, 40)).expect("a disk");
    let too_fine = fine_map(&disk, 0.01, 0.0, &mut Random(1));
    let found = rounded(&disk, &too_fine, RoundingGrid::Upright, &BTreeSet::new());
    assert!(!is_planar(&disk, &found.embedding));
    let mut turned = fine_map(&disk, 4.0, 0.2, &mut Random(1));
    turned[VertexId::new(60)] += DVec2::splat(1e-3);
    let found = rounded(&disk, &turned, RoundingGrid::Upright, &BTreeSet::new());
    assert_eq!(found.moved, 0);
}

#[test]
fn the_program_writes_and_proves_numbers_of_32_bits_where_it_is_asked_or_the_format_has_no_others() {
    let program = Program::new();
    program.write("in.obj", &obj_text(&quad_sheet(9, 9, 0.3, &mut Random(4))));
    for (output, options, precision) in [
        ("a.obj", &[][..], "f64"),
        ("b.obj", &["--precision", "f32"], "f32"),
        ("c.ply", &["--precision", "f32"], "f32"),
        ("c-usual.ply", &[], "f32"),
        ("c-exact.ply", &["--precision", "f64"], "f64"),
        ("d.glb", &[], "f32"),
        ("e.glb", &["--precision", "f32"], "f32"),
    ] {
        let run = [&["flatten", "in.obj", "-o", output, "--report", "r.json"][..], options].concat();
        program.run(&run).expect(0);
        let report: serde_json::Value =
            serde_json::from_slice(&std::fs::read(program.path("r.json")).unwrap()).unwrap();
        assert_eq!(report["precision"], precision, "{output}");
        assert_eq!(report["rounding"].is_object(), precision == "f32");
        assert_eq!([&report["verdict"]["planar"], &report["verdict"]["f32"]], [true, true]);
        let file = read_mesh(&program.path(output)).expect("it is right");
        let is_turned_over = output.ends_with("glb");
        let is_short = |z: &DVec2| is_f32(z.x) && is_f32(if is_turned_over { 1.0 - z.y } else { z.y });
        let texture = file.texture.as_ref().expect("texture coordinates");
        assert_eq!(texture.coordinates.iter().all(is_short), precision == "f32", "{output}");
        program.run(&["check", output]).expect(0);
    }
    let exact = coordinates_by_vertex(&read_mesh(&program.path("a.obj")).unwrap());
    let short = coordinates_by_vertex(&read_mesh(&program.path("b.obj")).unwrap());
    let nearest: Embedding = exact.iter().map(|&z| RoundingGrid::Upright.nearest(z)).collect();
    assert_eq!(short, nearest);
}

/// Fan with its middle so near its rim that 32 bits have no number between.
#[test]
fn what_32_bits_cannot_hold_is_said_with_a_way_on() {
    let program = Program::new();
    // With a pinned boundary, the inner vertex lies in a needle between three boundary vertices.
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 0.5 1 0\nv 0.5 0.3 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    let pins = ["--pin", "0:0.5,0.5", "--pin", "1:0.500000000000001,0.5", "--pin", "2:0.5,0.500000000000001"];
    let options = ["--method", "natural", "--report", "r.json"];
    let run = |output: &str, status| {
        program.run(&[&["flatten", "in.obj", "-o", output][..], &options, &pins].concat()).expect(status)
    };
    run("a.obj", 0);
    let said = run("a.glb", 4);
    let line = said.stdout.lines().find(|line| line.starts_with("planar")).expect("a line on rounding");
    assert_message("rounding-folds-the-map", line);
    let report: serde_json::Value = serde_json::from_slice(&std::fs::read(program.path("r.json")).unwrap()).unwrap();
    assert_eq!(report["rounding"]["folded"], true);
    assert_eq!(report["verdict"]["planar"], false);
    program.run(&["check", "a.glb"]).expect(4);
}

#[test]
fn a_map_that_32_bits_would_fold_is_written_to_ply_in_64() {
    let program = Program::new();
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 0.5 1 0\nv 0.5 0.3 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    let pins = ["--pin", "0:0.5,0.5", "--pin", "1:0.500000000000001,0.5", "--pin", "2:0.5,0.500000000000001"];
    let arguments = ["flatten", "in.obj", "-o", "a.ply", "--method", "natural", "--report", "r.json"];
    let report = |options: &[&str], status| {
        program.run(&[&arguments[..], &pins, options].concat()).expect(status);
        let bytes = std::fs::read(program.path("r.json")).expect("a report");
        serde_json::from_slice::<serde_json::Value>(&bytes).expect("JSON")
    };
    let usual = report(&[], 0);
    assert_eq!((&usual["precision"], usual["rounding"].is_object()), (&"f64".into(), false));
    assert_eq!(usual["verdict"]["planar"], true);
    program.run(&["check", "a.ply"]).expect(0);
    let asked = report(&["--precision", "f32"], 4);
    assert_eq!((&asked["precision"], &asked["rounding"]["folded"]), (&"f32".into(), &true.into()));
}
