//! Layouts of several charts: each against the verdict on disks, and pairs of faces against clipped polygons.

use freebound_core::mesh::{Part, TriMesh, VertexId, parts};
use freebound_core::problem::Embedding;
use freebound_core::verify::{AtlasVerdict, atlas_verdict, verdict};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::program::{Program, textured_text};
use freebound_testkit::{Random, assert_message, band, disk, grid};

/// Meshes merged into one.
fn together(meshes: &[TriMesh]) -> TriMesh {
    let mut whole = TriMesh::new(Vec::new(), &[]);
    for mesh in meshes {
        let offset = whole.vertex_count();
        whole.positions.extend(&mesh.positions);
        let moved = mesh.triangles.iter().map(|t| t.map(|v| VertexId::from_index(v.index() + offset)));
        whole.triangles.extend(moved);
    }
    whole
}

fn charts(mesh: &TriMesh) -> Vec<Part> {
    parts(mesh).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Positions of a flat mesh as an embedding, moved by a vector.
fn flat(mesh: &TriMesh, by: DVec2) -> Vec<DVec2> {
    mesh.positions.iter().map(|p| p.truncate() + by).collect()
}

fn of_layout(meshes: &[TriMesh], moves: &[[f64; 2]]) -> AtlasVerdict {
    let places: Vec<DVec2> = meshes.iter().zip(moves).flat_map(|(mesh, by)| flat(mesh, DVec2::from(*by))).collect();
    atlas_verdict(&charts(&together(meshes)), &places.into())
}

#[test]
fn a_chart_without_holes_gets_the_verdict_of_disks() {
    let mut random = Random(3);
    let mut planar = 0;
    for case in 0..400 {
        let mesh = grid(2 + random.below(3), 2 + random.below(3));
        let disturb = f64::from(random.below(3)) * 0.9;
        let mut places = flat(&mesh, DVec2::ZERO);
        for z in &mut places {
            *z += disturb * DVec2::new(random.unit(), random.unit());
        }
        if random.below(4) == 0 {
            for z in &mut places {
                z.x = -z.x;
            }
        }
        let embedding = Embedding::from(places);
        let expected = verdict(&disk(mesh.clone()), &embedding);
        let found = atlas_verdict(&charts(&mesh), &embedding);
        assert_eq!(found.planar, expected.planar, "case {case}");
        assert_eq!(found.planar_in_f32, expected.planar_in_f32, "case {case}");
        assert_eq!(found.charts[0].flipped_faces, expected.flipped_faces, "case {case}");
        assert_eq!(found.charts[0].mirrored, expected.mirrored, "case {case}");
        planar += usize::from(expected.planar);
    }
    assert!((50..350).contains(&planar), "both verdicts occur: {planar}");
}

/// Common area of two triangles, by clipping one with the sides of the other.
pub(crate) fn shared_area(a: [DVec2; 3], b: [DVec2; 3]) -> f64 {
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let upright = |[a, b, c]: [DVec2; 3]| if turn(a, b, c) > 0.0 { [a, b, c] } else { [a, c, b] };
    let clip = upright(b);
    let mut polygon = upright(a).to_vec();
    for k in 0..3 {
        let [from, to] = [clip[k], clip[(k + 1) % 3]];
        let mut kept = Vec::new();
        for i in 0..polygon.len() {
            let [p, q] = [polygon[i], polygon[(i + 1) % polygon.len()]];
            let [at_p, at_q] = [turn(from, to, p), turn(from, to, q)];
            if at_p >= 0.0 {
                kept.push(p);
            }
            if at_p * at_q < 0.0 {
                kept.push(p.lerp(q, at_p / (at_p - at_q)));
            }
        }
        polygon = kept;
    }
    (1..polygon.len().max(2) - 1).map(|i| turn(polygon[0], polygon[i], polygon[i + 1])).sum()
}

#[test]
fn two_faces_overlap_where_clipping_leaves_an_area() {
    let mut random = Random(17);
    let mut overlapping = 0;
    for case in 0..20_000 {
        // Few integer coordinates, so touching and common sides and corners are frequent.
        let mut place = || DVec2::new(f64::from(random.below(7)), f64::from(random.below(7)));
        let [a, b] = [0, 1].map(|_| [place(), place(), place()]);
        if [a, b].iter().any(|[a, b, c]| (*b - *a).perp_dot(*c - *a) == 0.0) {
            continue;
        }
        let triangle = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]);
        let whole = together(&[triangle.clone(), triangle]);
        let found = atlas_verdict(&charts(&whole), &[a, b].concat().into());
        // The least common area of triangles with integer coordinates up to 6 is far above the rounding of the
        // clipping.
        let expected = shared_area(a, b) > 1e-9;
        assert_eq!(!found.overlapping_faces.is_empty(), expected, "case {case}: {a:?} {b:?}");
        overlapping += usize::from(expected);
    }
    assert!((2_000..18_000).contains(&overlapping), "both occur: {overlapping}");
}

/// Ring of squares in the plane.
fn ring() -> TriMesh {
    let mut mesh = grid(3, 3);
    mesh.triangles.drain(8..10);
    mesh
}

#[test]
fn a_chart_may_have_holes_and_another_chart_may_lie_in_one() {
    let small = TriMesh { positions: grid(1, 1).positions.iter().map(|p| *p * 0.5).collect(), ..grid(1, 1) };
    let found = of_layout(&[ring(), small.clone()], &[[0.0, 0.0], [1.25, 1.25]]);
    assert!(found.planar && found.planar_in_f32, "{}", found.summary());
    assert_eq!(found.charts[0].boundary_loops, 2);
    let found = of_layout(&[ring(), small], &[[0.0, 0.0], [0.75, 1.25]]);
    assert!(!found.planar && !found.overlapping_faces.is_empty(), "{}", found.summary());
}

#[test]
fn charts_may_touch_and_must_not_overlap() {
    let beside = of_layout(&[grid(2, 2), grid(2, 2)], &[[0.0, 0.0], [2.0, 0.5]]);
    assert!(beside.planar, "{}", beside.summary());
    let over = of_layout(&[grid(2, 2), grid(2, 2)], &[[0.0, 0.0], [2.0_f64.next_down(), 0.5]]);
    assert!(!over.planar && over.charts.iter().all(|chart| chart.planar), "{}", over.summary());
    let stacked = of_layout(&[grid(30, 30), grid(30, 30)], &[[0.0; 2]; 2]);
    assert!(stacked.more_overlaps && stacked.overlapping_faces.len() == 1000);
}

#[test]
fn what_is_pulled_through_its_own_hole_is_no_chart() {
    // Inverts a ring, so that its outer loop becomes the inner one and all faces flip.
    let mut ring = ring();
    let middle = DVec3::new(1.5, 1.5, 0.0);
    for p in &mut ring.positions {
        let away = *p - middle;
        *p = middle + away / away.length_squared();
    }
    let inside_out = of_layout(&[ring.clone()], &[[0.0; 2]]);
    assert!(
        inside_out.charts[0].mirrored && inside_out.planar,
        "a mirror image, its loops changed over: it is one-to-one"
    );
    // A ring that goes around twice: every face is positive, no loop is simple.
    let strip = band(16, 0);
    let twice: Vec<DVec2> = (0..strip.vertex_count())
        .map(|v| {
            let (place, radius) = if v % 2 == 0 { (v / 2, 1.0) } else { (v / 2, 2.0) };
            let turn = 2.0 * std::f64::consts::TAU * place as f64 / 16.0;
            radius * DVec2::from_angle(turn)
        })
        .collect();
    let found = atlas_verdict(&charts(&strip), &twice.into());
    let chart = &found.charts[0];
    assert!(!found.planar, "{}", found.summary());
    assert!(chart.flipped_faces.is_empty() && chart.crossed_loops == 2 && !chart.is_bounded, "{chart:?}");
}

#[test]
fn check_proves_a_layout_of_thirty_charts_and_names_what_overlaps() {
    let program = Program::new();
    let meshes = vec![grid(6, 5); 30];
    let mut places: Vec<Vec<DVec2>> = meshes
        .iter()
        .enumerate()
        .map(|(k, mesh)| flat(mesh, DVec2::new((k % 6) as f64 * 7.0, (k / 6) as f64 * 6.0)))
        .collect();
    let whole = together(&meshes);
    let polygons = (&whole).into();
    let text = |places: &[Vec<DVec2>]| {
        textured_text(&polygons, &places.concat(), |face, k| [whole.triangles[face][k].index(); 2])
    };
    program.write("in.obj", &text(&places));
    let run = program.run(&["check", "in.obj"]).expect(0);
    assert_message("atlas-thirty-charts", &run.stdout);
    let report = program.run(&["check", "in.obj", "--report", "-"]).expect(0).json();
    assert_eq!(report["atlas"]["charts"].as_array().map(Vec::len), Some(30));
    assert_eq!((&report["atlas"]["planar"], &report["atlas"]["f32"]), (&json!(true), &json!(true)));
    assert_eq!(report["verdict"], Value::Null);
    places[7].iter_mut().for_each(|z| z.x += 1.5);
    program.write("in.obj", &text(&places));
    let run = program.run(&["check", "in.obj"]).expect(4);
    assert_message("atlas-overlapping-charts", &run.stdout);
    let atlas = &program.run(&["check", "in.obj", "--report", "-"]).expect(4).json()["atlas"];
    assert_eq!(atlas["planar"], json!(false));
    assert!(atlas["overlapping_faces"].as_array().is_some_and(|pairs| !pairs.is_empty()), "{atlas}");
}

#[test]
fn handles_and_closed_parts_are_no_charts() {
    let sphere = freebound_testkit::tetrahedron();
    assert_eq!(parts(&together(&[grid(1, 1), sphere])).expect_err("closed").faults[0].name(), "closed");
}
