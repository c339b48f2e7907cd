//! Verdicts on any triangles of the plane: overlaps against clipping in rational numbers, and every kind of finding.

use freebound_core::geom::Random;
use freebound_core::mesh::TriMesh;
use freebound_core::problem::Embedding;
use freebound_core::verify::{
    FindingCode, FindingSeverity, LayoutOptions, LayoutVerdict, PixelGap, PlaneLayout, layout_verdict,
};
use freebound_testkit::oracle::overlapping_pairs;
use freebound_testkit::{grid, tetrahedron};
use glam::{DVec2, DVec3};

/// Triangles in space at the coordinates, over them in the layout.
fn flat(coordinates: &[[f64; 2]], triangles: &[[u32; 3]]) -> (TriMesh, Embedding) {
    let positions = coordinates.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
    (TriMesh::new(positions, triangles), coordinates.iter().map(|&[x, y]| DVec2::new(x, y)).collect())
}

fn judged(mesh: &TriMesh, coordinates: &Embedding) -> LayoutVerdict {
    judged_with(mesh, coordinates, LayoutOptions::default())
}

fn judged_with(mesh: &TriMesh, coordinates: &Embedding, options: LayoutOptions) -> LayoutVerdict {
    layout_verdict(PlaneLayout { mesh, coordinates, groups: &[], bare_faces: &[] }, options)
}

fn codes(verdict: &LayoutVerdict) -> Vec<FindingCode> {
    verdict.findings.iter().map(|finding| finding.code).collect()
}

/// Elements of the finding with a code, as numbers.
fn elements(verdict: &LayoutVerdict, code: FindingCode) -> Vec<Vec<u32>> {
    let finding = verdict.findings.iter().find(|finding| finding.code == code);
    let Some(finding) = finding else { return Vec::new() };
    let faces = finding.faces.iter().map(|face| vec![face.number()]);
    faces.chain(finding.pairs.iter().map(|pair| pair.iter().map(|face| face.number()).collect())).collect()
}

#[test]
fn overlaps_are_those_of_exact_clipping() {
    let mut random = Random(5);
    let mut planar = 0;
    for case in 0..400 {
        // Few places, so that corners, sides and whole triangles often coincide.
        let place = |random: &mut Random| [f64::from(random.below(5)), f64::from(random.below(5))];
        let points: Vec<[f64; 2]> = (0..9).map(|_| place(&mut random)).collect();
        let count = 2 + random.below(4);
        let triangles: Vec<[u32; 3]> = (0..count).map(|_| [0; 3].map(|_| random.below(9))).collect();
        let (mut mesh, coordinates) = flat(&points, &triangles);
        // No two vertices agree in space, so that every triangle without a shared vertex is a chart.
        mesh.positions.iter_mut().enumerate().for_each(|(k, p)| p.z = k as f64);
        let verdict = judged(&mesh, &coordinates);
        let kinds = [FindingCode::Overlap, FindingCode::OverlapOfCharts, FindingCode::OverlapMirrored];
        let found: Vec<Vec<u32>> = kinds.into_iter().flat_map(|code| elements(&verdict, code)).collect();
        let listed = |code| elements(&verdict, code).concat();
        let (stacked, duplicates) = (listed(FindingCode::Stacked), listed(FindingCode::Duplicate));
        let overlapping: Vec<Vec<u32>> = overlapping_pairs(&triangles, &coordinates)
            .into_iter()
            .map(|[a, b]| [b, a].map(|face| u32::try_from(face).expect("few")).to_vec())
            .collect();
        let words = format!("case {case}: {points:?} {triangles:?} {:?}", verdict.findings);
        assert!(found.iter().all(|pair| overlapping.contains(pair)), "{words}");
        let is_told = |pair: &Vec<u32>| {
            found.contains(pair) || pair.iter().any(|face| stacked.contains(face) || duplicates.contains(face))
        };
        assert!(overlapping.iter().all(is_told), "{words}");
        assert!(stacked.iter().all(|face| overlapping.iter().any(|pair| pair.contains(face))), "{words}");
        planar += usize::from(verdict.planar);
    }
    assert!(planar > 5, "only {planar} layouts are planar");
}

#[test]
fn a_flat_map_is_planar_and_has_no_findings() {
    let mesh = grid(4, 3);
    let coordinates: Embedding = mesh.positions.iter().map(|p| p.truncate() / 8.0).collect();
    let verdict = judged(&mesh, &coordinates);
    assert!(verdict.planar && verdict.planar_in_f32 && verdict.passes);
    assert_eq!((verdict.charts, verdict.triangles, codes(&verdict)), (1, mesh.face_count(), Vec::new()));
}

#[test]
fn faces_that_run_both_ways_are_planar_and_named() {
    let (mesh, coordinates) = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[[0, 1, 2], [0, 3, 2]]);
    let verdict = judged(&mesh, &coordinates);
    assert!(verdict.planar && verdict.charts == 1);
    assert_eq!(elements(&verdict, FindingCode::Turned), [[1]]);
    assert_eq!(verdict.findings[0].severity, FindingSeverity::Note);
}

#[test]
fn a_folded_face_is_flipped_and_lies_over_its_neighbour() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.75, 0.25], [0.0, 1.0]];
    let (mut mesh, coordinates) = flat(&points, &[[0, 1, 2], [0, 2, 3], [0, 2, 4]]);
    mesh.positions[3] = DVec3::new(0.0, 1.0, 0.0);
    mesh.positions[4] = DVec3::new(0.0, 1.0, 5.0);
    let verdict = judged(&mesh, &coordinates);
    assert!(!verdict.planar && !verdict.passes);
    // The edge of three faces relates no two of them, so that none of them is turned over against another.
    assert_eq!(elements(&verdict, FindingCode::Overlap), [[0, 1]]);
    let (mesh, coordinates) = (TriMesh { triangles: mesh.triangles[..2].to_vec(), ..mesh }, coordinates);
    let verdict = judged(&mesh, &coordinates);
    assert_eq!(elements(&verdict, FindingCode::Flipped).len(), 1);
    assert_eq!(elements(&verdict, FindingCode::Overlap), [[0, 1]]);
}

#[test]
fn charts_and_parts_of_a_chart_may_touch() {
    // Two squares that share a corner in the plane, and a third one beside the first.
    let square = |x: f64, y: f64| [[x, y], [x + 0.25, y], [x + 0.25, y + 0.25], [x, y + 0.25]];
    let points = [square(0.0, 0.0), square(0.25, 0.25), square(0.25, 0.0)].concat();
    let triangles: Vec<[u32; 3]> =
        (0..3).flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]).collect();
    let (mut mesh, coordinates) = flat(&points, &triangles);
    mesh.positions[8..].iter_mut().for_each(|p| p.z = 1.0);
    let verdict = judged(&mesh, &coordinates);
    assert!(verdict.planar, "{:?}", verdict.findings);
    assert_eq!(verdict.charts, 3);
}

#[test]
fn a_closed_surface_pressed_flat_overlaps_itself() {
    let mesh = tetrahedron();
    let pressed = |p: &DVec3| p.truncate() + 0.25 * p.z * DVec2::ONE;
    let coordinates: Embedding = mesh.positions.iter().map(pressed).collect();
    let verdict = judged(&mesh, &coordinates);
    assert!(!verdict.planar);
    assert!(codes(&verdict).contains(&FindingCode::Overlap), "{:?}", verdict.findings);
}

#[test]
fn what_has_no_place_is_named_and_an_error_only_if_it_is_much() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.5], [0.5, 0.5], [0.5, 0.5]];
    let (mut mesh, coordinates) = flat(&points, &[[0, 1, 2], [3, 4, 5]]);
    mesh.positions[4].x += 0.05;
    mesh.positions[5].y += 0.05;
    let layout = PlaneLayout { mesh: &mesh, coordinates: &coordinates, groups: &[], bare_faces: &[7, 9] };
    let verdict = layout_verdict(layout, LayoutOptions::default());
    assert!(verdict.planar && verdict.charts == 1);
    assert_eq!(elements(&verdict, FindingCode::NoPlace), [[1]]);
    assert_eq!(elements(&verdict, FindingCode::NoCoordinates), [[7], [9]]);
    mesh.positions[5].y += 5.0;
    let verdict = judged(&mesh, &coordinates);
    assert!(!verdict.planar);
    assert_eq!((codes(&verdict), verdict.findings[0].severity), (vec![FindingCode::NoPlace], FindingSeverity::Error));
}

#[test]
fn a_face_on_a_line_is_an_error_unless_it_has_no_area_in_space_either() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0]];
    let (mut mesh, coordinates) = flat(&points, &[[0, 1, 2], [1, 0, 3]]);
    assert!(judged(&mesh, &coordinates).planar);
    mesh.positions[3].y = -1.0;
    let verdict = judged(&mesh, &coordinates);
    assert!(!verdict.planar);
    assert_eq!(elements(&verdict, FindingCode::Degenerate), [[1]]);
}

#[test]
fn coordinates_that_are_no_numbers_are_named_as_such() {
    let (mesh, _) = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[[0, 1, 2], [0, 2, 3]]);
    for bad in [f64::NAN, f64::INFINITY] {
        let coordinates: Embedding =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, bad]].iter().map(|&[x, y]| DVec2::new(x, y)).collect();
        let verdict = judged(&mesh, &coordinates);
        assert_eq!(codes(&verdict), [FindingCode::NotFinite]);
        assert_eq!(elements(&verdict, FindingCode::NotFinite), [[1]]);
    }
}

/// Two equal squares of different parts, at these places in the layout, the second one mirrored or not.
fn two_squares(second: [f64; 2], mirrored: bool) -> (TriMesh, Embedding) {
    let corners = [[0.0, 0.0], [0.25, 0.0], [0.25, 0.25], [0.0, 0.25]];
    let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let place = |[x, y]: [f64; 2]| {
        if mirrored { [second[0] + 0.25 - x, second[1] + y] } else { [second[0] + x, second[1] + y] }
    };
    let points: Vec<[f64; 2]> = corners.into_iter().chain(corners.map(place)).collect();
    let (mut mesh, coordinates) = flat(&points, &triangles);
    for (k, position) in mesh.positions.iter_mut().enumerate() {
        let [x, y] = corners[k % 4];
        *position = DVec3::new(x, y, if k < 4 { 0.0 } else { 3.0 });
    }
    (mesh, coordinates)
}

#[test]
fn overlaps_of_charts_are_told_apart_from_mirrored_and_stacked_ones() {
    let cases = [
        ([0.1, 0.1], false, FindingCode::OverlapOfCharts),
        ([0.1, 0.1], true, FindingCode::OverlapMirrored),
        ([0.0, 0.0], false, FindingCode::Stacked),
        ([0.0, 0.0], true, FindingCode::Stacked),
    ];
    for (place, mirrored, code) in cases {
        let (mesh, coordinates) = two_squares(place, mirrored);
        let verdict = judged(&mesh, &coordinates);
        assert_eq!(codes(&verdict)[0], code, "{place:?} {mirrored}: {:?}", verdict.findings);
        assert!(!verdict.planar);
        let options = LayoutOptions { accepts_stacks: true, ..LayoutOptions::default() };
        assert_eq!(judged_with(&mesh, &coordinates, options).planar, code == FindingCode::Stacked);
        // Each material has a picture of its own.
        let layout = PlaneLayout { mesh: &mesh, coordinates: &coordinates, groups: &[0, 0, 1, 1], bare_faces: &[] };
        assert!(layout_verdict(layout, LayoutOptions::default()).planar);
    }
}

#[test]
fn charts_beyond_the_square_too_close_or_of_another_scale_are_warned_of() {
    let gap = |least: f64| LayoutOptions {
        gap: Some(PixelGap { least, picture: DVec2::splat(1000.0) }),
        ..LayoutOptions::default()
    };
    let (mesh, coordinates) = two_squares([0.26, 0.0], false);
    assert_eq!(codes(&judged_with(&mesh, &coordinates, gap(9.9))), []);
    let close = judged_with(&mesh, &coordinates, gap(10.5));
    assert_eq!(elements(&close, FindingCode::Gap), [[0, 2]]);
    assert!(close.planar && close.passes);
    assert!(!close.clone().judged_by(&[], &[FindingCode::Gap]).passes);
    assert_eq!(codes(&close.judged_by(&[FindingCode::Gap], &[FindingCode::Gap])), []);

    let (mesh, coordinates) = two_squares([0.9, 0.0], false);
    assert_eq!(elements(&judged(&mesh, &coordinates), FindingCode::Outside), [[2]]);
    let (mesh, coordinates) = two_squares([2.5, 1.5], false);
    assert_eq!(codes(&judged(&mesh, &coordinates)), [FindingCode::Tiles]);
    let (mesh, coordinates) = two_squares([-1e5, 0.3], false);
    assert!(elements(&judged(&mesh, &coordinates), FindingCode::FarAway) == [[2], [3]]);
    let (mut mesh, coordinates) = two_squares([0.5, 0.5], true);
    assert_eq!(codes(&judged(&mesh, &coordinates)), [FindingCode::Mirrored]);
    mesh.positions[4..].iter_mut().for_each(|p| *p *= 2.5);
    assert!(codes(&judged(&mesh, &coordinates)).contains(&FindingCode::Scale));
}

#[test]
fn a_layout_that_folds_in_32_bits_says_so() {
    let far = 1e6;
    let points = [[far, far], [far + 1e-3, far], [far + 1e-3, far + 1e-3], [far, far + 1e-3]];
    let (mut mesh, coordinates) = flat(&points, &[[0, 1, 2], [0, 2, 3]]);
    mesh.positions.iter_mut().for_each(|p| *p = (*p - DVec3::new(far, far, 0.0)) * 1e3);
    let verdict = judged(&mesh, &coordinates);
    assert!(verdict.planar && !verdict.planar_in_f32);
}
