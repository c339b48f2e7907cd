//! The convex hull of points, by Andrew's monotone chain with the exact predicate.
//!
//! Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.

use glam::DVec2;

use super::{Orientation, orientation};

/// The corners of the convex hull by their places among the points, counter-clockwise from the leftmost. Points on a
/// side are no corners. Points that are not finite are left out; without three that span an area the hull has fewer
/// than three corners.
pub fn convex_hull(points: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].is_finite()).collect();
    order.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x).then(points[i].y.total_cmp(&points[j].y)));
    order.dedup_by(|i, j| points[*i] == points[*j]);
    let chain = |places: &mut dyn Iterator<Item = usize>| {
        let mut corners: Vec<usize> = Vec::new();
        for place in places {
            while let [.., a, b] = corners[..]
                && orientation(points[a], points[b], points[place]) != Some(Orientation::CounterClockwise)
            {
                corners.pop();
            }
            corners.push(place);
        }
        corners
    };
    let mut lower = chain(&mut order.iter().copied());
    let mut upper = chain(&mut order.iter().rev().copied());
    // Each chain ends where the other begins.
    lower.pop();
    upper.pop();
    lower.append(&mut upper);
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

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
        // The fourth point lies on the lower side but for the last bit, above it and below it.
        let dented = |y: f64| hull(&[[0.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, y]]).len();
        assert_eq!((dented(1.0 + f64::EPSILON), dented(1.0), dented(1.0 - f64::EPSILON)), (3, 3, 4));
    }
}
