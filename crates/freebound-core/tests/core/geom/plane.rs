//! Plane geometry: orientation, hulls, triangulations, similarities and the picture's frame.

use freebound_core::geom::{
    Bounds, Orientation, PictureFrame, Similarity, VAxis, clip_polygon, clip_segment, constrained_triangles,
    convex_hull, delaunay_triangles, look_mirrored, orientation, outside_triangles,
};
use glam::DVec2;

use super::closed_polygon::points;

fn double_area(corners: &[DVec2]) -> f64 {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Twice the total area of the triangles; asserts that all are positive.
fn covered(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
    let corners = triangles.iter().map(|t| t.map(|c| points[c as usize]));
    corners
        .map(|[a, b, c]| {
            assert_eq!(orientation(a, b, c), Some(Orientation::CounterClockwise));
            double_area(&[a, b, c])
        })
        .sum()
}

#[test]
fn a_convex_polygon_has_no_pockets() {
    assert_eq!(outside_triangles(&points(&[[0, 0], [4, 0], [5, 3], [1, 4]]), &[]), Some(Vec::new()));
}

#[test]
fn corners_in_the_middle_of_a_hull_side_make_no_pocket() {
    let square = points(&[[0, 0], [2, 0], [4, 0], [4, 4], [0, 4], [0, 1]]);
    assert_eq!(outside_triangles(&square, &[]), Some(Vec::new()));
}

#[test]
fn pockets_fill_the_hull() {
    let comb = points(&[[0, 0], [9, 0], [9, 5], [7, 1], [5, 5], [3, 1], [1, 4], [0, 5]]);
    let triangles = outside_triangles(&comb, &[]).unwrap();
    let hull = points(&[[0, 0], [9, 0], [9, 5], [5, 5], [0, 5]]);
    assert_eq!(double_area(&comb) + covered(&comb, &triangles), double_area(&hull));
}

#[test]
fn a_pocket_within_a_spiral_is_found() {
    let spiral = points(&[
        [0, 0],
        [9, 0],
        [9, 9],
        [1, 9],
        [1, 3],
        [6, 3],
        [6, 6],
        [4, 6],
        [4, 5],
        [5, 5],
        [5, 4],
        [2, 4],
        [2, 8],
        [8, 8],
        [8, 1],
        [0, 1],
    ]);
    let triangles = outside_triangles(&spiral, &[]).unwrap();
    let hull = points(&[[0, 0], [9, 0], [9, 9], [1, 9], [0, 1]]);
    assert_eq!(double_area(&spiral) + covered(&spiral, &triangles), double_area(&hull));
}

#[test]
fn a_frame_is_filled_up_to_the_polygon() {
    let ell = points(&[[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]]);
    let frame = points(&[[-9, -9], [9, -9], [9, 9], [-9, 9]]);
    let triangles = outside_triangles(&ell, &frame).unwrap();
    let all: Vec<DVec2> = ell.iter().chain(&frame).copied().collect();
    assert_eq!(double_area(&ell) + covered(&all, &triangles), double_area(&frame));
}

#[test]
fn a_polygon_that_is_not_simple_is_refused() {
    assert_eq!(outside_triangles(&points(&[[0, 0], [2, 2], [2, 0], [0, 2]]), &[]), None);
    assert_eq!(outside_triangles(&points(&[[0, 0], [4, 0], [4, 4], [4, 0], [0, 4]]), &[]), None);
    assert_eq!(outside_triangles(&[DVec2::ZERO, DVec2::X, DVec2::NAN], &[]), None);
}

fn hull(points: &[[f64; 2]]) -> Vec<usize> {
    convex_hull(&points.iter().map(|&p| DVec2::from_array(p)).collect::<Vec<_>>())
}

#[test]
fn the_corners_of_a_square_in_turn() {
    assert_eq!(hull(&[[1.0, 1.0], [0.0, 0.0], [0.5, 0.5], [1.0, 0.0], [0.0, 1.0]]), [1, 3, 0, 4]);
}

#[test]
fn points_on_a_side_and_twins_are_no_corners() {
    assert_eq!(hull(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 0.0], [1.0, 1.0]]), [0, 2, 3]);
}

#[test]
fn what_spans_no_area_has_no_polygon() {
    assert!(hull(&[]).is_empty());
    assert!(hull(&[[1.0, 2.0], [1.0, 2.0], [f64::NAN, 0.0]]).len() < 3);
    assert!(hull(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]).len() < 3);
}

#[test]
fn a_dent_of_one_bit_is_seen() {
    // The fourth point is on the lower side up to the last bit, above it and below it.
    let dented = |y: f64| hull(&[[0.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, y]]).len();
    assert_eq!((dented(1.0 + f64::EPSILON), dented(1.0), dented(1.0 - f64::EPSILON)), (3, 3, 4));
}

#[test]
fn a_square_with_a_point_in_it_has_four_triangles_around_that_point() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.4, 1e-300]].map(DVec2::from);
    assert_eq!(delaunay_triangles(&points[..4]).map(|triangles| triangles.len()), Some(2));
    let inside = [points[0], points[1], points[2], points[3], DVec2::new(0.4, 0.5)];
    assert_eq!(delaunay_triangles(&inside), Some(vec![[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 3, 4]]));
    // A coordinate close to zero counts as zero, so the point lies on the lower side.
    assert_eq!(delaunay_triangles(&points).map(|triangles| triangles.len()), Some(3));
}

#[test]
fn points_that_coincide_are_refused() {
    assert_eq!(delaunay_triangles(&[DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::X]), None);
    assert_eq!(delaunay_triangles(&[DVec2::ZERO, DVec2::X, DVec2::NAN]), None);
}

#[test]
fn the_picture_stands_upright_whichever_way_v_runs() {
    let uv = DVec2::new(0.25, 0.125);
    for (v_axis, height) in [(VAxis::Up, 0.125), (VAxis::Down, 0.875)] {
        let frame = PictureFrame { aspect: 2.0, v_axis };
        let [low, high] = frame.corners();
        let place = frame.plane_from_uv(uv);
        assert_eq!((place - low) / (high - low), DVec2::new(0.25, height), "{v_axis:?}");
        assert_eq!(frame.uv_from_plane(place), uv);
    }
}

#[test]
fn the_best_similarity_gives_an_exact_one_back() {
    let points = [DVec2::new(0.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(-1.0, 3.0)];
    let moved = |z: DVec2| DVec2::new(0.3, -0.4).rotate(z) + DVec2::new(5.0, 6.0);
    let found = Similarity::fitting(&points.map(|z| [z, moved(z)])).expect("there is one");
    for z in points {
        assert!(found.apply(z).distance(moved(z)) < 1e-14);
    }
}

#[test]
fn no_similarity_spreads_what_lies_in_one_place() {
    assert!(Similarity::fitting(&[[DVec2::ONE, DVec2::ZERO], [DVec2::ONE, DVec2::X]]).is_none());
}

#[test]
fn integers_and_the_adaptive_predicate_agree_where_both_hold() {
    // Scaling is exact, and numbers this small are left to integer arithmetic.
    let tiny = 2_f64.powi(-500);
    // A line of slope 1 sampled around (0.5, 0.5) in steps of one ulp: Kettner et al. 2008, figure 1.
    for i in 0..64_u64 {
        for k in 0..64_u64 {
            let nudged = |n: u64| f64::from_bits(0.5_f64.to_bits() + n);
            let (a, b, c) = (DVec2::new(nudged(i), nudged(k)), DVec2::new(12.0, 12.0), DVec2::new(24.0, 24.0));
            let exact = orientation(tiny * a, tiny * b, tiny * c);
            assert!(exact.is_some());
            assert_eq!(orientation(a, b, c), exact, "{i} {k}");
        }
    }
}

#[test]
fn a_coordinate_that_is_no_number_has_no_orientation() {
    let (o, x) = (DVec2::ZERO, DVec2::X);
    assert_eq!(orientation(o, x, DVec2::new(f64::NAN, 0.0)), None);
    assert_eq!(orientation(o, x, DVec2::new(0.0, f64::INFINITY)), None);
}

const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(1.9, 1.0), DVec2::new(-0.2, 1.3)];

fn pairs_to(map: impl Fn(DVec2) -> DVec2) -> Vec<[DVec2; 2]> {
    CORNERS.iter().map(|&z| [z, map(z)]).collect()
}

#[test]
fn what_is_turned_does_not_look_mirrored() {
    let turn = DVec2::new(0.3, -1.2);
    assert!(!look_mirrored(&pairs_to(|z| turn.rotate(z) + DVec2::ONE)));
}

#[test]
fn what_is_mirrored_does() {
    let turn = DVec2::new(0.3, -1.2);
    assert!(look_mirrored(&pairs_to(|z| turn.rotate(DVec2::new(z.x, -z.y)))));
}

#[test]
fn a_square_in_the_mirror_does_though_no_rotation_fits_it_at_all() {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    assert!(look_mirrored(&square.map(|z| [z, DVec2::new(-z.x, z.y)])));
}

#[test]
fn a_line_fits_both_ways() {
    let line = [0.0, 1.0, 2.5].map(|x| [DVec2::new(x, 0.0), DVec2::new(1.0, x)]);
    assert!(!look_mirrored(&line));
}

const UNIT: Bounds = Bounds { low: DVec2::ZERO, high: DVec2::ONE };

#[test]
fn a_segment_is_cut_on_both_sides_or_left_out() {
    let segment = |a: [f64; 2], b: [f64; 2]| clip_segment([a, b].map(DVec2::from), UNIT);
    assert_eq!(segment([-1.0, 0.5], [3.0, 0.5]), Some([DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5)]));
    assert_eq!(segment([0.25, 0.25], [0.5, 0.5]), Some([DVec2::splat(0.25), DVec2::splat(0.5)]));
    assert_eq!(segment([-1.0, 0.5], [0.5, 3.0]), None);
    assert_eq!(segment([2.0, 0.0], [2.0, 1.0]), None);
}

#[test]
fn a_polygon_is_cut_to_its_part_inside() {
    let area = |p: &[DVec2]| p.iter().zip(p.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum::<f64>() / 2.0;
    let around = [[-1.0, -1.0], [2.0, -1.0], [2.0, 2.0], [-1.0, 2.0]].map(DVec2::from);
    assert!((area(&clip_polygon(&around, UNIT)) - 1.0).abs() < 1e-12);
    let half = [[-1.0, 0.0], [0.5, 0.0], [0.5, 1.0], [-1.0, 1.0]].map(DVec2::from);
    assert!((area(&clip_polygon(&half, UNIT)) - 0.5).abs() < 1e-12);
    let beside = [[2.0, 0.0], [3.0, 0.0], [3.0, 1.0]].map(DVec2::from);
    assert!(clip_polygon(&beside, UNIT).is_empty());
}

#[test]
fn a_similarity_goes_back_and_in_parts_that_make_up_the_whole() {
    let similarity = Similarity::new(DVec2::from_angle(2.5) * 3.0, DVec2::new(1.0, -2.0), DVec2::new(-4.0, 7.0));
    for z in [DVec2::ZERO, DVec2::new(1.0, -2.0), DVec2::new(-0.3, 12.0)] {
        assert!(similarity.inverse().apply(similarity.apply(z)).distance(z) < 1e-14 * 20.0);
        assert!(similarity.part(0.0).apply(z).distance(z) < 1e-14);
        assert!(similarity.part(1.0).apply(z).distance(similarity.apply(z)) < 1e-13);
    }
    // Half of the similarity rotates by half the angle and scales by the root of the factor.
    let half = similarity.part(0.5);
    let arm = half.apply(DVec2::new(2.0, -2.0)) - half.apply(DVec2::new(1.0, -2.0));
    assert!(arm.distance(DVec2::from_angle(1.25) * 3_f64.sqrt()) < 1e-14);
    assert!(half.apply(DVec2::new(1.0, -2.0)).distance(DVec2::new(-1.5, 2.5)) < 1e-14);
}

#[test]
fn a_triangulation_has_the_sides_that_are_asked_for() {
    // The longer diagonal is not a Delaunay edge.
    let kite = points(&[[0, 0], [4, -1], [8, 0], [4, 1]]);
    let has = |triangles: &[[u32; 3]], [a, b]: [u32; 2]| triangles.iter().any(|t| t.contains(&a) && t.contains(&b));
    let free = constrained_triangles(&kite, &[]).unwrap();
    assert_eq!((free.len(), has(&free, [1, 3]), has(&free, [0, 2])), (2, true, false));
    let with_side = constrained_triangles(&kite, &[[2, 0]]).unwrap();
    assert_eq!((with_side.len(), has(&with_side, [1, 3]), has(&with_side, [0, 2])), (2, false, true));
    assert_eq!(constrained_triangles(&kite, &[[0, 2], [1, 3]]), None, "sides that cross");
}
