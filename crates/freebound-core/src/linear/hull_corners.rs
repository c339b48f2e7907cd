//! Convex hull of the boundary projected to its best-fitting plane: an outline that resembles the boundary.
//!
//! The plane is fitted by least squares through the centroid of the boundary: its normal is the direction of least
//! extent. Each vertex is weighted by the length of its edges.
//!
//! The corners of the hull are vertices of the boundary. On the outline they must have the order of the loop. If the
//! projected boundary crosses itself, some corners break this order; then the longest run in order is used. Omitting
//! corners keeps the outline convex.
//!
//! Source: Y. Lee, H. S. Kim, S. Lee, "Mesh Parameterization with a Virtual Boundary", 2002, propose the outline.

use glam::{DVec2, DVec3};
use nalgebra::{Matrix3, SymmetricEigen};

use super::convex::Corner;
use crate::geom::convex_hull;

/// Ratio of the second extent of a boundary to the first below which the boundary counts as a line.
const THINNEST: f64 = 1e-9;

/// Turning angle in radians below which a corner counts as rounding of a straight boundary.
const STRAIGHT: f64 = 1e-9;

/// Largest number of corners among which a run is searched; more corners are thinned out evenly first.
const MOST_CORNERS: usize = 256;

/// Corners of the outline in the order of the loop; `None` if fewer than three are in order.
pub(crate) fn hull_corners(boundary: &[DVec3]) -> Option<Vec<Corner>> {
    let seen = projected(boundary)?;
    let double_area: f64 = seen.iter().zip(seen.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum();
    let mirrored: Vec<DVec2> = seen.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
    // Both sides of the plane are tried. If both show equally many corners, the side from which the loop runs
    // counter-clockwise wins.
    let sides = if double_area < 0.0 { [mirrored, seen] } else { [seen, mirrored] };
    let [first, second] = sides.map(|seen| in_order(&clear_corners(&seen), &seen));
    let found = if second.len() > first.len() { second } else { first };
    (found.len() >= 3).then_some(found)
}

/// Points in their best-fitting plane, relative to their centroid and extent; `None` if they lie on a line.
fn projected(points: &[DVec3]) -> Option<Vec<DVec2>> {
    let count = points.len();
    let length = |place: usize| points[place % count].distance(points[(place + 1) % count]);
    let weights: Vec<f64> = (0..count).map(|place| length(place) + length(place + count - 1)).collect();
    let total: f64 = weights.iter().sum();
    let middle = points.iter().zip(&weights).map(|(p, weight)| *p * (weight / total)).sum::<DVec3>();
    let extent = points.iter().map(|p| (*p - middle).abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let around: Vec<DVec3> = points.iter().map(|p| (*p - middle) / extent).collect();
    let mut spread = Matrix3::zeros();
    for (p, weight) in around.iter().zip(&weights) {
        let p = nalgebra::Vector3::new(p.x, p.y, p.z);
        spread += p * p.transpose() * (weight / total);
    }
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigenvalues[j].total_cmp(&eigenvalues[i]).then(i.cmp(&j)));
    if eigenvalues[order[1]] <= THINNEST * THINNEST * eigenvalues[order[0]] {
        return None;
    }
    let axis = |k: usize| DVec3::from_array(eigenvectors.column(order[k]).into_owned().into());
    let (first, second) = (axis(0), axis(1));
    Some(around.iter().map(|p| DVec2::new(p.dot(first), p.dot(second))).collect())
}

/// Corners of the hull that turn clearly, as indices into the points.
fn clear_corners(seen: &[DVec2]) -> Vec<usize> {
    let hull = convex_hull(seen);
    let at = |k: usize| seen[hull[k % hull.len()]];
    let turns = |k: &usize| {
        let (before, after) = (at(*k) - at(k + hull.len() - 1), at(k + 1) - at(*k));
        before.perp_dot(after) > STRAIGHT * before.length() * after.length()
    };
    (0..hull.len()).filter(turns).map(|k| hull[k]).collect()
}

/// Longest run of corners of a hull in the order of the loop, from any first corner.
fn in_order(hull: &[usize], seen: &[DVec2]) -> Vec<Corner> {
    let corner = |&place: &usize| Corner { place, at: seen[place] };
    let falls = hull.iter().zip(hull.iter().cycle().skip(1)).filter(|(place, next)| next < place).count();
    if falls <= 1 {
        return hull.iter().map(corner).collect();
    }
    let step = hull.len().div_ceil(MOST_CORNERS);
    let thinned: Vec<usize> = hull.iter().copied().step_by(step).collect();
    let from = |start: usize| {
        let around = (0..thinned.len()).map(|k| thinned[(start + k) % thinned.len()]);
        let ahead: Vec<usize> = around.map(|place| (place + seen.len() - thinned[start]) % seen.len()).collect();
        longest_increasing(&ahead).into_iter().map(|k| thinned[(start + k) % thinned.len()]).collect::<Vec<_>>()
    };
    let runs = (0..thinned.len()).map(from);
    let longest = runs.reduce(|best, run| if run.len() > best.len() { run } else { best });
    longest.unwrap_or_default().iter().map(corner).collect()
}

/// Indices of a longest strictly increasing subsequence.
fn longest_increasing(values: &[usize]) -> Vec<usize> {
    // For each length, the index of the least value that ends a subsequence of that length.
    let mut ends: Vec<usize> = Vec::new();
    let mut before = vec![None; values.len()];
    for (place, value) in values.iter().enumerate() {
        let length = ends.partition_point(|&end| values[end] < *value);
        before[place] = length.checked_sub(1).map(|shorter| ends[shorter]);
        if length == ends.len() {
            ends.push(place);
        } else {
            ends[length] = place;
        }
    }
    let mut run: Vec<usize> = std::iter::successors(ends.last().copied(), |&place| before[place]).collect();
    run.reverse();
    run
}
