//! Triangulation of a polygon by ear clipping.
//!
//! The polygon is projected to its best-fit plane, along Newell's normal, the sum of the cross products of its
//! corners. An ear is a corner that turns left and whose triangle contains no other corner, not even on its rim. Every
//! simple polygon has an ear (Meisters 1975), and clipping it leaves a simple polygon. A quad gets the diagonal with
//! the better triangles, if both diagonals lie inside. No ear remains if the polygon crosses itself or is seen
//! edge-on. Then the remaining corners are clipped in order, so the result always has `n − 2` triangles over the given
//! corners.
//!
//! A corner is *bare* if only two polygons meet there, inside the surface. Clipping it from both polygons would make
//! the two ears one triangle.
//!
//! Time: linear for convex polygons. A tree of boxes (`blockers.rs`) finds corners in a triangle. A corner that is not
//! an ear is tested again only after one of its neighbours was clipped.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::blockers::Blockers;
use super::polygons::newell_normal;

/// Factor by which the second diagonal must be better than the first, so that rounding does not decide between equals.
const CLEARLY_BETTER: f64 = 1.0 + 1e-9;

/// Calls `emit` with the corner positions `0..n` of each triangle. An ear at a corner that `is_bare` is clipped only
/// if unavoidable.
pub(super) fn triangulate(points: &[DVec3], is_bare: impl Fn(usize) -> bool, mut emit: impl FnMut([usize; 3])) {
    match points.len() {
        0..=2 => {}
        3 => emit([0, 1, 2]),
        4 => quad([points[0], points[1], points[2], points[3]], is_bare).into_iter().for_each(emit),
        _ => clip_ears(&in_best_plane(points), &is_bare, &mut emit),
    }
}

fn quad(points: [DVec3; 4], is_bare: impl Fn(usize) -> bool) -> [[usize; 3]; 2] {
    const FIRST: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    const SECOND: [[usize; 3]; 2] = [[0, 1, 3], [1, 2, 3]];
    let normal = newell_normal(&points);
    // Area over the sum of squared lengths, −1 for a flipped triangle; largest for an equilateral triangle.
    let quality = |[a, b, c]: [usize; 3]| {
        let (ab, ac, bc) = (points[b] - points[a], points[c] - points[a], points[c] - points[b]);
        let area = ab.cross(ac);
        let size = area.length() / (ab.length_squared() + ac.length_squared() + bc.length_squared());
        if area.dot(normal) > 0.0 { size } else { -1.0 }
    };
    match (is_bare(0) || is_bare(2), is_bare(1) || is_bare(3)) {
        (true, false) => return FIRST,
        (false, true) => return SECOND,
        _ => {}
    }
    let worst = |pair: [[usize; 3]; 2]| quality(pair[0]).min(quality(pair[1]));
    let (first, second) = (worst(FIRST), worst(SECOND));
    if second > 0.0 && second > first * CLEARLY_BETTER { SECOND } else { FIRST }
}

/// Projects the polygon along its normal, so that it is counter-clockwise.
fn in_best_plane(points: &[DVec3]) -> Vec<DVec2> {
    let normal = newell_normal(points).try_normalize().unwrap_or(DVec3::Z);
    let (x, y) = normal.any_orthonormal_pair();
    // The pair completes a right-handed frame in one of its two orders. Choose the order that looks down the normal.
    let (x, y) = if x.cross(y).dot(normal) > 0.0 { (x, y) } else { (y, x) };
    points
        .iter()
        .map(|&p| (p - points[0]).dot(x))
        .zip(points.iter().map(|&p| (p - points[0]).dot(y)))
        .map(DVec2::from)
        .collect()
}

/// Twice the signed area, with the exact sign.
pub(super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Polygon from which corners are clipped one by one.
struct Ring<'a> {
    points: &'a [DVec2],
    next: Vec<usize>,
    previous: Vec<usize>,
    /// Corners that did not turn left at the start: only these can lie in an ear.
    blockers: Blockers<'a>,
    /// Corners that may be ears. Any other corner failed its last test and has had the neighbours of that test since.
    candidates: BTreeSet<usize>,
    /// True while all ears so far were found without clipping a bare one.
    spares_bare: bool,
}

impl<'a> Ring<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let n = points.len();
        let next: Vec<usize> = (1..n).chain([0]).collect();
        let previous: Vec<usize> = [n - 1].into_iter().chain(0..n - 1).collect();
        let turns_left = |at: usize| turn(points[previous[at]], points[at], points[next[at]]) > 0.0;
        let blockers = Blockers::new(points, (0..n).filter(|&at| !turns_left(at)).collect());
        Self { points, next, previous, blockers, candidates: (0..n).collect(), spares_bare: true }
    }

    /// True if the polygon turns left here and no corner lies in the triangle. False if a coordinate is NaN.
    fn is_ear(&self, at: usize) -> bool {
        let corners = [self.previous[at], at, self.next[at]].map(|corner| self.points[corner]);
        let [a, b, c] = corners;
        turn(a, b, c) > 0.0 && !self.blockers.any_in(corners)
    }

    /// Returns the first ear from a corner on, preferring ears that are not bare. `None` if the polygon is not simple.
    fn ear_from(&mut self, mut at: usize, is_bare: &impl Fn(usize) -> bool) -> Option<usize> {
        for is_second_look in [false, true] {
            if is_second_look {
                // If the polygon touches itself, an earlier clipped corner may have lain in an ear.
                self.spares_bare = false;
                self.candidates.extend(std::iter::successors(Some(at), |&v| Some(self.next[v]).filter(|&v| v != at)));
            }
            while let Some(&candidate) = self.candidates.range(at..).next().or(self.candidates.first()) {
                if !(self.spares_bare && is_bare(candidate)) && self.is_ear(candidate) {
                    return Some(candidate);
                }
                self.candidates.remove(&candidate);
                at = candidate;
            }
        }
        None
    }

    fn clip(&mut self, at: usize) -> [usize; 3] {
        let (before, after) = (self.previous[at], self.next[at]);
        self.next[before] = after;
        self.previous[after] = before;
        self.blockers.remove(at);
        self.candidates.remove(&at);
        self.candidates.extend([before, after]);
        [before, at, after]
    }
}

fn clip_ears(points: &[DVec2], is_bare: &impl Fn(usize) -> bool, emit: &mut impl FnMut([usize; 3])) {
    let mut ring = Ring::new(points);
    let mut at = 1;
    let mut is_simple = true;
    for _ in 3..points.len() {
        // Without an ear there is no point in further search.
        let ear = is_simple.then(|| ring.ear_from(at, is_bare)).flatten();
        is_simple = ear.is_some();
        let triangle = ring.clip(ear.unwrap_or(at));
        emit(triangle);
        // Continues beyond the new side, so that ears are clipped all around instead of from one corner.
        at = ring.next[triangle[2]];
    }
    emit([ring.previous[at], at, ring.next[at]]);
}
