//! Least-area rectangle around points, compared with all rotations.

use freebound_core::geom::{Bounds, convex_hull, least_box_turn};
use glam::DVec2;

use freebound_testkit::Random;

/// Area of the bounding box of rotated points.
fn box_area(points: &[DVec2], turn: DVec2) -> f64 {
    Bounds::of(points.iter().map(|z| turn.rotate(*z))).size().element_product()
}

#[test]
fn no_turn_gives_points_a_smaller_box() {
    let mut random = Random(21);
    for case in 0..300 {
        let count = 3 + random.index(30);
        let stretch = 0.05 + random.unit();
        let by = DVec2::from_angle(random.unit() * std::f64::consts::TAU);
        let mut place = || by.rotate(DVec2::new(random.unit(), random.unit() * stretch));
        let points: Vec<DVec2> = (0..count).map(|_| place()).collect();
        let turn = least_box_turn(&points);
        assert!((turn.length() - 1.0).abs() < 1e-12);
        let least = box_area(&points, turn);
        let hull = convex_hull(&points);
        let sides = (0..hull.len()).map(|k| points[hull[(k + 1) % hull.len()]] - points[hull[k]]);
        let turns = sides.map(|along| DVec2::new(along.x, -along.y).try_normalize().expect("a side has a length"));
        let angles = (0..720).map(|k| DVec2::from_angle(f64::from(k) * std::f64::consts::PI / 720.0));
        for other in turns.chain(angles) {
            assert!(least <= box_area(&points, other) * (1.0 + 1e-12), "case {case}: {turn} {other}");
        }
    }
}

#[test]
fn a_turned_rectangle_is_brought_upright() {
    for degrees in 0..90 {
        let by = DVec2::from_angle(f64::from(degrees).to_radians());
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(|z| by.rotate(DVec2::from(z)));
        let area = box_area(&corners, least_box_turn(&corners));
        assert!((area - 3.0).abs() < 1e-12, "{degrees}: {area}");
    }
}

#[test]
fn points_that_span_no_area_need_no_turn_or_lie_on_an_axis() {
    assert_eq!(least_box_turn(&[]), DVec2::X);
    assert_eq!(least_box_turn(&[DVec2::ONE; 3]), DVec2::X);
    let line: Vec<DVec2> = (0..4).map(|k| f64::from(k) * DVec2::new(3.0, 4.0)).collect();
    assert!(box_area(&line, least_box_turn(&line)) < 1e-12);
    let hole = [DVec2::ZERO, DVec2::NAN, DVec2::X, DVec2::ONE];
    assert!(least_box_turn(&hole).is_finite());
}
