//! Closed polygons in the plane: self-intersections, turning number, winding number.

use std::time::{Duration, Instant};

use freebound_core::geom::{
    CROSSINGS_LISTED, Crossings, crossings, is_simple, segments_meet, turning_number, winding_number,
};
use glam::DVec2;

use freebound_testkit::Random;

pub(crate) fn points(corners: &[[i32; 2]]) -> Vec<DVec2> {
    corners.iter().map(|&[x, y]| DVec2::new(f64::from(x), f64::from(y))).collect()
}

#[test]
fn a_convex_polygon_has_none() {
    assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 3], [2, 5], [0, 3]])), Crossings::default());
}

#[test]
fn corners_in_the_middle_of_a_side_are_no_crossings() {
    assert_eq!(crossings(&points(&[[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [0, 1]])), Crossings::default());
}

#[test]
fn a_bow_tie_has_one() {
    assert_eq!(crossings(&points(&[[0, 0], [2, 2], [2, 0], [0, 2]])).pairs, [[0, 2]]);
}

#[test]
fn a_corner_that_touches_an_edge_crosses_it_with_both_its_edges() {
    let touching = points(&[[0, 0], [6, 0], [6, 4], [3, 0], [0, 4]]);
    assert_eq!(crossings(&touching).pairs, [[0, 2], [0, 3]]);
}

#[test]
fn two_corners_in_one_place_cross_with_all_their_edges() {
    let pinched = points(&[[0, 0], [2, 2], [4, 0], [4, 4], [2, 2], [0, 4]]);
    assert_eq!(crossings(&pinched).pairs, [[0, 3], [0, 4], [1, 3], [1, 4]]);
}

#[test]
fn edges_that_overlap_cross() {
    let overlapping = points(&[[0, 0], [4, 0], [4, 2], [6, 2], [6, 0], [3, 0], [3, -2], [0, -2]]);
    assert!(crossings(&overlapping).pairs.contains(&[0, 4]));
}

#[test]
fn an_edge_that_folds_back_crosses_its_neighbour() {
    assert_eq!(crossings(&points(&[[0, 0], [4, 0], [2, 0], [2, 3]])).pairs, [[0, 1], [0, 2]]);
    // The spike at the first corner.
    assert_eq!(crossings(&points(&[[4, 0], [2, 0], [2, 3], [0, 0]])).pairs, [[0, 3], [1, 3]]);
}

#[test]
fn an_edge_of_length_zero_lets_its_neighbours_meet() {
    assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 0], [0, 4]])).pairs, [[0, 2]]);
    assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 0]])).pairs, [[0, 2]]);
}

#[test]
fn corners_that_are_not_finite_take_no_part() {
    let mut bow_tie = points(&[[0, 0], [2, 2], [2, 0], [0, 2]]);
    bow_tie[3].x = f64::NAN;
    assert_eq!(crossings(&bow_tie), Crossings::default());
}

#[test]
fn beyond_the_limit_crossings_are_no_longer_looked_for() {
    // Two combs laid across each other: 400 teeth across 400 teeth, at least 4 · 400² pairs.
    let teeth = 400;
    let mut corners = Vec::new();
    for tooth in 0..teeth {
        corners.extend([[2 * tooth, -1], [2 * tooth, 2 * teeth], [2 * tooth + 1, 2 * teeth], [2 * tooth + 1, -1]]);
    }
    corners.push([2 * teeth, -1]);
    for tooth in 0..teeth {
        corners.extend([[2 * teeth, 2 * tooth], [-1, 2 * tooth], [-1, 2 * tooth + 1], [2 * teeth, 2 * tooth + 1]]);
    }
    let found = crossings(&points(&corners));
    assert!(found.has_more);
    assert_eq!(found.pairs.len(), CROSSINGS_LISTED);
    assert!(found.pairs.is_sorted());
}

#[test]
fn the_crossings_listed_are_the_first_of_all_pairs() {
    let mut random = Random(12);
    let corners: Vec<DVec2> = (0..2000).map(|_| DVec2::new(random.unit(), random.unit())).collect();
    let edge = |k: usize| [corners[k], corners[(k + 1) % corners.len()]];
    let later = |i: usize| (i + 2..corners.len()).map(move |j| [i, j]);
    let are_neighbours = |[i, j]: [usize; 2]| i == 0 && j + 1 == corners.len();
    let meet = |&[i, j]: &[usize; 2]| !are_neighbours([i, j]) && segments_meet(edge(i), edge(j));
    let expected = (0..corners.len()).flat_map(later).filter(meet).take(CROSSINGS_LISTED);
    let expected: Vec<[u32; 2]> = expected.map(|pair| pair.map(|k| u32::try_from(k).unwrap())).collect();
    let found = crossings(&corners);
    assert!(found.has_more);
    assert!(found.pairs == expected);
    assert!(!is_simple(&corners));
}

#[test]
fn a_boundary_of_random_edges_is_judged_in_good_time() {
    let mut random = Random(4);
    let corners: Vec<DVec2> = (0..40_000).map(|_| DVec2::new(random.unit(), random.unit())).collect();
    let start = Instant::now();
    // Nearly a quarter of all pairs, 190 million.
    assert!(crossings(&corners).has_more);
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}

#[test]
fn fewer_than_three_corners_are_no_trouble() {
    assert_eq!(crossings(&[]), Crossings::default());
    assert_eq!(crossings(&points(&[[1, 1]])), Crossings::default());
    assert_eq!(crossings(&points(&[[0, 0], [1, 1]])).pairs, [[0, 1]]);
}

#[test]
fn a_square_turns_once_whichever_corner_comes_first() {
    let mut square = points(&[[0, 0], [1, 0], [1, 1], [0, 1]]);
    for _ in 0..4 {
        assert_eq!(turning_number(&square), Some(1));
        square.rotate_left(1);
    }
    square.reverse();
    assert_eq!(turning_number(&square), Some(-1));
}

#[test]
fn a_bow_tie_does_not_turn() {
    assert_eq!(turning_number(&points(&[[0, 0], [1, 1], [1, 0], [0, 1]])), Some(0));
}

#[test]
fn a_pentagram_turns_twice_and_winds_twice_around_its_middle() {
    let star = points(&[[0, 10], [-6, -8], [9, 3], [-9, 3], [6, -8]]);
    assert_eq!(turning_number(&star), Some(2));
    assert_eq!(winding_number(&star, DVec2::ZERO), Some(2));
    assert_eq!(winding_number(&star, DVec2::new(0.0, 8.0)), Some(1));
    assert_eq!(winding_number(&star, DVec2::new(20.0, 3.0)), Some(0));
}

#[test]
fn corners_in_the_middle_of_a_side_change_nothing() {
    assert_eq!(turning_number(&points(&[[0, 0], [1, 0], [2, 0], [2, 2], [1, 2], [0, 2], [0, 1]])), Some(1));
}

#[test]
fn an_edge_of_length_zero_or_a_spike_has_no_turning_number() {
    assert_eq!(turning_number(&points(&[[0, 0], [1, 0], [1, 0], [0, 1]])), None);
    assert_eq!(turning_number(&points(&[[0, 0], [2, 0], [1, 0], [0, 1]])), None);
}

#[test]
fn there_is_no_winding_around_a_point_of_the_polygon() {
    let square = points(&[[0, 0], [2, 0], [2, 2], [0, 2]]);
    for on_it in [DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(0.0, 2.0)] {
        assert_eq!(winding_number(&square, on_it), None);
    }
    assert_eq!(winding_number(&square, DVec2::ONE), Some(1));
}
