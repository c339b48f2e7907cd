//! Nearest points of triangles.

use freebound_core::geom::Random;
use freebound_core::mesh::{NearestPoint, TriangleTree, nearest_point, point_at};
use glam::DVec3;

fn point(random: &mut Random) -> DVec3 {
    DVec3::new(random.unit(), random.unit(), random.unit())
}

/// Small triangles; every seventh is a segment, every eleventh a point.
fn soup(count: usize, random: &mut Random) -> Vec<[DVec3; 3]> {
    let triangle = |number: usize| {
        let corner = point(random);
        let mut near = || corner + 0.2 * (point(random) - 0.5);
        match number {
            _ if number.is_multiple_of(11) => [corner; 3],
            _ if number.is_multiple_of(7) => {
                let end = near();
                [corner, end, corner.midpoint(end)]
            }
            _ => [corner, near(), near()],
        }
    };
    (0..count).map(triangle).collect()
}

#[test]
fn no_point_of_a_triangle_is_nearer_than_the_nearest() {
    let mut random = Random::of_run(3, 0);
    for triangle in soup(200, &mut random) {
        for _ in 0..20 {
            let query = 2.0 * point(&mut random) - 0.5;
            let NearestPoint { weights, distance_squared, .. } = nearest_point(query, triangle, 0);
            assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert_eq!(query.distance_squared(point_at(triangle, weights)), distance_squared);
            for _ in 0..50 {
                let (a, b) = (random.unit(), random.unit());
                let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                let other = query.distance_squared(point_at(triangle, [1.0 - a - b, a, b]));
                assert!(distance_squared <= other + 1e-14);
            }
        }
    }
}

#[test]
fn the_tree_finds_what_a_search_through_all_triangles_finds() {
    let mut random = Random::of_run(5, 0);
    let triangles = soup(500, &mut random);
    let tree = TriangleTree::new(&triangles);
    let corners = |number: u32| triangles[number as usize];
    for _ in 0..400 {
        let query = 2.0 * point(&mut random) - 0.5;
        let limit = 0.3 * random.unit();
        for accepted in [1, 3] {
            let accept = |number: u32| number.is_multiple_of(accepted);
            let all = (0..500).filter(|&number| accept(number));
            let all = all.map(|number| nearest_point(query, corners(number), number));
            let within = all.filter(|found| found.distance_squared <= limit);
            let expected = within.min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared));
            assert_eq!(tree.nearest(query, limit, corners, accept), expected);
        }
    }
}

#[test]
fn corners_are_met_exactly() {
    let mut random = Random::of_run(7, 0);
    for triangle in soup(300, &mut random) {
        for corner in triangle {
            let found = nearest_point(corner, triangle, 0);
            assert_eq!(found.distance_squared, 0.0);
            assert_eq!(point_at(triangle, found.weights), corner);
        }
    }
}

#[test]
fn a_tree_without_triangles_finds_none() {
    let nan = [[DVec3::NAN; 3]];
    for triangles in [&[][..], &nan] {
        let tree = TriangleTree::new(triangles);
        assert_eq!(tree.nearest(DVec3::ZERO, f64::INFINITY, |_| [DVec3::ZERO; 3], |_| true), None);
    }
}
