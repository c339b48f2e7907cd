//! Convex polygons of the user: valid ones survive a round trip, others are refused with the reason.

use freebound_core::geom::{ConvexPolygon, PolygonFault};
use glam::DVec2;
use proptest::prelude::*;

fn fault(text: &str) -> PolygonFault {
    ConvexPolygon::parse(text).expect_err(text)
}

#[test]
fn corners_stand_on_lines_or_between_semicolons_with_spaces_or_commas() {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    for text in [
        "0 0\n1 0\n1 1\n0 1\n",
        "0 0; 1 0; 1 1; 0 1",
        "# a square\r\n0,0\r\n\r\n1, 0 # and on\r\n1e0\t1; 0 1;",
        " 0 -0;1 0\n1 1;0 1",
    ] {
        assert_eq!(ConvexPolygon::parse(text).expect(text).corners(), square, "{text:?}");
    }
}

#[test]
fn what_is_no_convex_polygon_is_refused_with_its_reason() {
    assert_eq!(fault(""), PolygonFault::TooFewCorners { found: 0 });
    assert_eq!(fault("0 0; 1 0"), PolygonFault::TooFewCorners { found: 2 });
    for (text, line, point) in
        [("0 0\n1 x\n", 2, "1 x"), ("0 0; 1", 1, "1"), ("\n\n1 2 3", 3, "1 2 3"), ("inf 0", 1, "inf 0")]
    {
        assert_eq!(fault(text), PolygonFault::NotAPoint { line, text: point.to_owned() }, "{text:?}");
    }
    assert_eq!(fault("0 0; 0 1; 1 1; 1 0"), PolygonFault::Clockwise);
    assert_eq!(fault("0 0; 2 0; 2 2; 1 0.5"), PolygonFault::NotConvex { corner: 4, x: 1.0, y: 0.5 });
    // A straight corner, and two coinciding corners.
    assert_eq!(fault("0 0; 1 0; 2 0; 1 1"), PolygonFault::NotConvex { corner: 2, x: 1.0, y: 0.0 });
    assert!(matches!(fault("0 0; 1 0; 1 0; 0 1"), PolygonFault::NotConvex { .. }));
    // A corner that is straight up to one unit in the last place is distinguished from a turn.
    let bent = |y: f64| ConvexPolygon::new(&[DVec2::ZERO, DVec2::new(1.0, y), DVec2::new(2.0, 0.0), DVec2::Y]);
    assert!(bent(-f64::MIN_POSITIVE).is_ok() && bent(0.0).is_err());
    let star = (0..5).map(|k| DVec2::from_angle(f64::from(2 * k) / 5.0 * std::f64::consts::TAU));
    assert_eq!(ConvexPolygon::new(&star.collect::<Vec<_>>()), Err(PolygonFault::WindsAround { turns: 2 }));
    assert_eq!(fault("0 0; 1e200 0; 0 1"), PolygonFault::OutOfRange { corner: 2 });
    assert_eq!(fault("0 0; 1e-200 0; 0 1e-200"), PolygonFault::OutOfRange { corner: 1 });
    let many: Vec<DVec2> =
        (0..10_001).map(|k| DVec2::from_angle(f64::from(k) / 10_001.0 * std::f64::consts::TAU)).collect();
    assert_eq!(ConvexPolygon::new(&many), Err(PolygonFault::TooManyCorners { found: 10_001, most: 10_000 }));
    assert!(ConvexPolygon::new(&many[..10_000]).is_ok());
}

#[test]
fn the_usual_polygon_is_one() {
    let hexagon = ConvexPolygon::HEXAGON;
    assert_eq!(ConvexPolygon::new(hexagon.corners()), Ok(hexagon));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_again_bit_for_bit_and_clones_share_it(
        gaps in prop::collection::vec(0.2..1.0_f64, 3..9), size in -90..90_i32, middle in -1e3..1e3_f64,
    ) {
        let total: f64 = gaps.iter().sum();
        let mut angle = 0.0;
        let corners: Vec<DVec2> = gaps.iter().map(|gap| {
            angle += gap / total * std::f64::consts::TAU;
            (DVec2::from_angle(angle) + middle) * 10_f64.powi(size)
        }).collect();
        let polygon = ConvexPolygon::new(&corners).expect("on a circle");
        let again = ConvexPolygon::parse(&polygon.to_string()).expect("written by itself");
        prop_assert_eq!(again.corners(), &corners[..]);
        let clone = polygon.clone();
        prop_assert!(std::ptr::eq(clone.corners(), polygon.corners()), "shared");
        prop_assert_eq!(again, polygon);
    }
}
