//! First triangle that a ray meets.

use glam::DVec3;

use super::Ray;
use freebound_core::mesh::TriangleTree;

/// Returns the first triangle of a tree that a ray meets before `limit`, with the distance and the weights of corners 1
/// and 2. `triangle` returns the corners of a triangle.
///
/// Triangles that fail `accept` are ignored.
pub(super) fn first_hit(
    tree: &TriangleTree,
    ray: Ray,
    limit: f64,
    triangle: impl Fn(u32) -> [DVec3; 3],
    accept: impl Fn(u32) -> bool,
) -> Option<(u32, [f64; 3])> {
    let inverse = ray.direction.recip();
    let best = std::cell::Cell::new(limit);
    let mut found = None;
    tree.visit(
        |low, high| enters(ray, inverse, [low, high], best.get()),
        |number| {
            let hit = meet(ray, triangle(number)).filter(|hit| hit[0] < best.get());
            if let Some(hit) = hit.filter(|_| accept(number)) {
                best.set(hit[0]);
                found = Some((number, hit));
            }
        },
    );
    found
}

/// True if a ray enters a box before `limit`.
fn enters(ray: Ray, inverse: DVec3, [low, high]: [DVec3; 2], limit: f64) -> bool {
    let a = (low - ray.origin) * inverse;
    let b = (high - ray.origin) * inverse;
    // A ray that runs in a side of the box gives 0 · ∞ = NaN; `min` and `max` ignore NaN.
    let (mut enter, mut leave) = (0.0_f64, limit);
    for axis in 0..3 {
        enter = enter.max(a[axis].min(b[axis]));
        leave = leave.min(a[axis].max(b[axis]));
    }
    enter <= leave * (1.0 + 1e-12)
}

/// Returns the intersection of a ray and a triangle, from either side: distance, weight of corner 1, weight of
/// corner 2.
///
/// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997).
fn meet(ray: Ray, corners: [DVec3; 3]) -> Option<[f64; 3]> {
    let [to_b, to_c] = [corners[1] - corners[0], corners[2] - corners[0]];
    let p = ray.direction.cross(to_c);
    let determinant = to_b.dot(p);
    let from_a = ray.origin - corners[0];
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(to_b);
    let v = ray.direction.dot(q) / determinant;
    let distance = to_c.dot(q) / determinant;
    // A determinant of zero gives NaN or ∞, which fails these tests.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance.is_finite()).then_some([distance, u, v])
}
