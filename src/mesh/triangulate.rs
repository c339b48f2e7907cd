//! Cuts one polygon into triangles by clipping ears.
//!
//! The polygon is looked at in its best plane: along Newell's normal, the sum of the cross products of its corners. An
//! ear is a corner that turns left and whose triangle holds no other corner, not even on its rim; every simple polygon
//! has one (Meisters 1975), and clipping it leaves a simple polygon. A quad takes the diagonal that leaves the better
//! triangles, if both diagonals lie inside. Where no ear is left, because the polygon crosses itself or is seen edge-on,
//! the remaining corners are clipped as they come: the result always has `n − 2` triangles over the same corners.
//!
//! A corner where only two polygons meet, inside the surface, is *bare*. Were it clipped from both, the two ears would be
//! the same triangle.
//!
//! Time: linear for convex polygons, `n` times the reflex corners at worst.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::polygons::newell_normal;

/// A diagonal has to be better than the first by this factor, so that rounding does not decide between equals.
const CLEARLY_BETTER: f64 = 1.0 + 1e-9;

/// Calls `emit` with places `0..n` of the corners of each triangle. At a corner that `is_bare` an ear is clipped only
/// where it cannot be otherwise.
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
    // Area over squared lengths, negative where the triangle is turned over: 0 at worst, largest when equilateral.
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

/// The polygon as seen along its normal, so that it runs counter-clockwise.
fn in_best_plane(points: &[DVec3]) -> Vec<DVec2> {
    let normal = newell_normal(points).try_normalize().unwrap_or(DVec3::Z);
    let (x, y) = normal.any_orthonormal_pair();
    // The pair completes a right-handed frame in either order; take the one that looks down the normal.
    let (x, y) = if x.cross(y).dot(normal) > 0.0 { (x, y) } else { (y, x) };
    points
        .iter()
        .map(|&p| (p - points[0]).dot(x))
        .zip(points.iter().map(|&p| (p - points[0]).dot(y)))
        .map(DVec2::from)
        .collect()
}

/// Twice the signed area, with the exact sign.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// A polygon from which corners are taken one by one.
struct Ring<'a> {
    points: &'a [DVec2],
    next: Vec<usize>,
    previous: Vec<usize>,
    /// Corners that do not turn left: only these can lie in an ear. May hold corners that have changed since.
    blockers: Vec<usize>,
    clipped: Vec<bool>,
}

impl Ring<'_> {
    /// Whether the polygon turns left here. With a NaN it does not.
    fn is_convex(&self, at: usize) -> bool {
        turn(self.points[self.previous[at]], self.points[at], self.points[self.next[at]]) > 0.0
    }

    fn is_ear(&self, at: usize) -> bool {
        if !self.is_convex(at) {
            return false;
        }
        let corners = [self.previous[at], at, self.next[at]].map(|c| self.points[c]);
        let [a, b, c] = corners;
        let holds = |p: DVec2| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        // Corners at the same place as one of the ear's own (a bridge to a hole) do not block it.
        !self.blockers.iter().any(|&v| !self.clipped[v] && !corners.contains(&self.points[v]) && holds(self.points[v]))
    }

    /// Forgets blockers that are clipped or turn left by now.
    fn drop_idle_blockers(&mut self) {
        let mut blockers = std::mem::take(&mut self.blockers);
        blockers.retain(|&v| !self.clipped[v] && !self.is_convex(v));
        self.blockers = blockers;
    }

    fn clip(&mut self, at: usize) -> [usize; 3] {
        let (before, after) = (self.previous[at], self.next[at]);
        self.next[before] = after;
        self.previous[after] = before;
        self.clipped[at] = true;
        [before, at, after]
    }
}

fn clip_ears(points: &[DVec2], is_bare: &impl Fn(usize) -> bool, emit: &mut impl FnMut([usize; 3])) {
    let n = points.len();
    let mut ring = Ring {
        points,
        next: (1..n).chain([0]).collect(),
        previous: [n - 1].into_iter().chain(0..n - 1).collect(),
        blockers: Vec::new(),
        clipped: vec![false; n],
    };
    ring.blockers = (0..n).filter(|&v| !ring.is_convex(v)).collect();
    let mut at = 1;
    let mut remaining = n;
    let mut tried = 0;
    // Bare corners are spared until no other one is an ear.
    let mut spares = true;
    let mut simple = true;
    while remaining > 3 {
        // When all corners were tried in vain, the polygon is not simple, and looking for more ears is idle.
        if tried >= remaining {
            (simple, tried) = (simple && spares, 0);
            spares = false;
        }
        if simple && !(ring.is_ear(at) && !(spares && is_bare(at))) {
            tried += 1;
            at = ring.next[at];
            continue;
        }
        let triangle = ring.clip(at);
        emit(triangle);
        remaining -= 1;
        tried = 0;
        if remaining.is_power_of_two() {
            ring.drop_idle_blockers();
        }
        // Goes past the new side, so that ears are taken all around rather than from one corner.
        at = ring.next[triangle[2]];
    }
    emit([ring.previous[at], at, ring.next[at]]);
}
