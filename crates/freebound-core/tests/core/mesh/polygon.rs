//! Triangulation of polygons.

use std::time::{Duration, Instant};

use freebound_core::mesh::{FaceId, PolygonMesh, TriMesh, VertexId};
use glam::{DQuat, DVec3};

use freebound_testkit::Random;

/// Mesh of a single polygon.
fn polygon(points: &[[f64; 3]]) -> PolygonMesh {
    let count = u32::try_from(points.len()).expect("small");
    PolygonMesh {
        positions: points.iter().copied().map(DVec3::from).collect(),
        corners: (0..count).map(VertexId::new).collect(),
        starts: Some(vec![0, count]),
    }
}

/// Asserts that triangles fill a flat polygon once: all face the polygon's side, have an area, and add up to `area`.
fn assert_fills(mesh: &TriMesh, normal: DVec3, area: f64) {
    let areas: Vec<f64> =
        (0..mesh.face_count()).map(|f| mesh.double_area_vector(FaceId::from_index(f)).dot(normal) / 2.0).collect();
    assert!(areas.iter().all(|&a| a > 1e-12 * area), "{:?} {areas:?}", mesh.triangles);
    assert!((areas.iter().sum::<f64>() - area).abs() < 1e-9 * area, "{areas:?}, not {area}");
}

#[test]
fn triangles_come_through_untouched() {
    let mesh = PolygonMesh { corners: [3, 1, 2, 0, 1, 3].map(VertexId::new).to_vec(), ..polygon(&[[0.0; 3]; 4]) };
    let triangles = [[3, 1, 2], [0, 1, 3]].map(|t| t.map(VertexId::new));
    for (starts, polygon_of) in [(None, None), (Some(vec![0, 3, 6]), Some(vec![0, 1]))] {
        let cut = PolygonMesh { starts, ..mesh.clone() }.triangulate();
        assert_eq!((cut.triangles.as_slice(), cut.polygon_of), (triangles.as_slice(), polygon_of));
    }
}

#[test]
fn a_quad_takes_the_diagonal_that_lies_inside() {
    // An arrowhead with its notch at each of the four corners.
    let arrow = [[0.0, 0.0, 0.0], [2.0, -1.0, 0.0], [0.5, 0.0, 0.0], [2.0, 1.0, 0.0]];
    for shift in 0..4 {
        let mut points = arrow;
        points.rotate_left(shift);
        let cut = polygon(&points).triangulate();
        assert_eq!(cut.face_count(), 2);
        assert_fills(&cut, DVec3::Z, 0.5);
    }
}

#[test]
fn a_quad_takes_the_better_of_two_diagonals_and_the_first_of_equals() {
    let kite = [[0.0, 0.0, 0.0], [5.0, -1.0, 0.0], [10.0, 0.0, 0.0], [5.0, 1.0, 0.0]];
    let numbers = |mesh: TriMesh| mesh.triangles.iter().map(|t| t.map(VertexId::number)).collect::<Vec<_>>();
    assert_eq!(numbers(polygon(&kite).triangulate()), [[0, 1, 3], [1, 2, 3]]);
    let square = [[0.1, 0.1, 0.3], [0.4, 0.1, 0.3], [0.4, 0.4, 0.3], [0.1, 0.4, 0.3]];
    assert_eq!(numbers(polygon(&square).triangulate()), [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn concave_polygons_are_filled_once_in_any_plane() {
    let mut random = Random(3);
    for _ in 0..300 {
        let corner_count = 5 + random.below(30);
        // Star-shaped around the origin: simple, and mostly concave.
        let mut flat: Vec<DVec3> = Vec::new();
        for k in 0..corner_count {
            let angle = std::f64::consts::TAU * (f64::from(k) + 0.8 * random.unit()) / f64::from(corner_count);
            flat.push(DVec3::new(angle.cos(), angle.sin(), 0.0) * (0.1 + random.unit()));
        }
        let next = flat.iter().cycle().skip(1);
        let area = flat.iter().zip(next).map(|(a, b)| a.cross(*b).z / 2.0).sum();
        let turn =
            DQuat::from_euler(glam::EulerRot::XYZ, 6.0 * random.unit(), 6.0 * random.unit(), 6.0 * random.unit());
        let points: Vec<[f64; 3]> = flat.iter().map(|&p| (turn * p + DVec3::new(3.0, -2.0, 7.0)).to_array()).collect();
        let cut = polygon(&points).triangulate();
        assert_eq!(cut.face_count(), points.len() - 2);
        assert_fills(&cut, turn * DVec3::Z, area);
    }
}

#[test]
fn corners_on_a_straight_side_get_triangles_with_area() {
    let with_midpoints: Vec<[f64; 3]> =
        [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [3, 3], [2, 3], [0, 3], [0, 1]]
            .iter()
            .map(|&[x, y]| [f64::from(x), f64::from(y), 0.0])
            .collect();
    for shift in 0..with_midpoints.len() {
        let mut points = with_midpoints.clone();
        points.rotate_left(shift);
        assert_fills(&polygon(&points).triangulate(), DVec3::Z, 9.0);
    }
}

#[test]
fn a_polygon_bridged_to_its_hole_is_filled_once() {
    let corners = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]];
    let points: Vec<[f64; 3]> = corners.iter().map(|&[x, y]| [f64::from(x), f64::from(y), 0.0]).collect();
    let mut mesh = polygon(&points);
    mesh.corners[4] = VertexId::new(0);
    mesh.corners[9] = VertexId::new(5);
    assert_fills(&mesh.triangulate(), DVec3::Z, 12.0);
}

#[test]
fn polygons_that_cannot_be_cut_well_are_cut_all_the_same() {
    let bow_tie = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 2.0, 0.0]];
    for points in [bow_tie, [[1.0; 3]; 5], [[f64::NAN; 3]; 5], [[f64::MAX; 3]; 5]] {
        assert_eq!(polygon(&points).triangulate().face_count(), 3);
        assert_eq!(polygon(&points[..4]).triangulate().face_count(), 2);
    }
    assert_eq!(polygon(&bow_tie[..2]).triangulate().face_count(), 0);
}

#[test]
fn a_long_polygon_that_crosses_itself_is_cut_in_good_time() {
    let mut random = Random(8);
    let points: Vec<[f64; 3]> = (0..20_000).map(|_| [random.unit(), random.unit(), 0.0]).collect();
    assert_eq!(polygon(&points).triangulate().face_count(), points.len() - 2);
}

#[test]
fn a_polygon_with_many_corners_is_cut_in_good_time() {
    let corner_count = 20_000;
    let angle = |k| std::f64::consts::TAU * f64::from(k) / f64::from(corner_count);
    let points: Vec<[f64; 3]> = (0..corner_count).map(|k| [angle(k).cos(), angle(k).sin(), 0.0]).collect();
    let cut = polygon(&points).triangulate();
    assert_eq!(cut.face_count(), points.len() - 2);
    assert!((cut.area() - std::f64::consts::PI).abs() < 1e-6);
}

/// Corner indices of all triangles.
fn places(mesh: &TriMesh) -> Vec<[u32; 3]> {
    mesh.triangles.iter().map(|t| t.map(VertexId::number)).collect()
}

#[test]
fn a_comb_of_many_teeth_and_a_spiral_are_cut_in_good_time() {
    let teeth = 8_000;
    let mut comb = vec![[0.0, -1.0, 0.0]];
    comb.push([2.0 * f64::from(teeth), -1.0, 0.0]);
    for tooth in (0..teeth).rev() {
        let x = 2.0 * f64::from(tooth);
        comb.extend([[x + 2.0, 0.0, 0.0], [x + 1.5, 100.0, 0.0], [x + 1.0, 100.0, 0.0], [x + 0.5, 0.0, 0.0]]);
    }
    let mut spiral = Vec::new();
    let arm = |k: i32, gap: f64| {
        let angle = 0.01 * f64::from(k);
        [(angle + gap) * angle.cos(), (angle + gap) * angle.sin(), 0.0]
    };
    spiral.extend((200..10_000).map(|k| arm(k, 2.0)));
    spiral.extend((200..10_000).rev().map(|k| arm(k, 0.0)));
    for points in [comb, spiral] {
        let start = Instant::now();
        let cut = polygon(&points).triangulate();
        assert!(start.elapsed() < Duration::from_mins(1), "{:?}", start.elapsed());
        let next = points.iter().cycle().skip(1);
        let area = points.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum();
        assert_eq!(cut.face_count(), points.len() - 2);
        assert_fills(&cut, DVec3::Z, area);
    }
}

#[test]
fn every_triangle_of_a_polygon_is_an_ear_that_holds_no_corner() {
    let mut random = Random(23);
    for _ in 0..40 {
        let corner_count = 60 + random.below(60);
        let radius: Vec<f64> = (0..corner_count).map(|_| 0.05 + random.unit()).collect();
        let spoke = |(k, r): (u32, &f64)| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(corner_count);
            [r * angle.cos(), r * angle.sin(), 0.0]
        };
        let points: Vec<[f64; 3]> = (0..).zip(&radius).map(spoke).collect();
        let turn = |a: u32, b: u32, c: u32| {
            let [a, b, c] = [a, b, c].map(|k| points[k as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        for [a, b, c] in places(&polygon(&points).triangulate()) {
            let others = (0..corner_count).filter(|&p| ![a, b, c].contains(&p));
            let inside = others.filter(|&p| turn(a, b, p) > 0.0 && turn(b, c, p) > 0.0 && turn(c, a, p) > 0.0);
            assert_eq!(inside.count(), 0, "{a} {b} {c}");
        }
    }
}
