//! The face as a signed distance: ellipsoids and tapered bars, blended into each other or cut out.
//!
//! y is up and z is forward; the figures are lengths in mesh units, of which the face is about two high. Everything
//! is mirrored at x = 0. Formulas of the primitives and of the quadratic blend after I. Quilez' published notes.

use glam::DVec3;

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Approximate distance to an ellipsoid.
fn ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    let q = (p - centre) / radii;
    let (k, g) = (q.length(), (q / radii).length());
    if g > 0.0 { k * (k - 1.0) / g } else { -radii.min_element() }
}

/// Distance to a bar from `a` to `b` whose radius goes from the first to the second.
fn bar(p: DVec3, [a, b]: [DVec3; 2], [from, to]: [f64; 2]) -> f64 {
    let (pa, ba) = (p - a, b - a);
    let share = (pa.dot(ba) / ba.length_squared()).clamp(0.0, 1.0);
    (pa - ba * share).length() - (from + (to - from) * share)
}

/// Union, blended where the two are nearer than `blend` to each other.
fn join(a: f64, b: f64, blend: f64) -> f64 {
    let h = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - h * h * blend / 4.0
}

/// The first without the second, blended.
fn cut(a: f64, b: f64, blend: f64) -> f64 {
    -join(-a, b, blend)
}

/// The signed distance, roughly: below zero inside.
pub(super) fn distance(p: DVec3) -> f64 {
    let p = at(p.x.abs(), p.y, p.z);
    let mut d = skull(p);
    d = nose(p, d);
    d = mouth(p, d);
    eyes(p, d)
}

fn skull(p: DVec3) -> f64 {
    let mut d = ellipsoid(p, at(0.0, 0.46, -0.24), at(0.74, 0.82, 0.87));
    d = join(d, ellipsoid(p, at(0.0, -0.28, -0.05), at(0.58, 0.72, 0.62)), 0.25);
    // Cheekbones, cheeks, jaw, chin, neck.
    d = join(d, ellipsoid(p, at(0.41, -0.07, 0.26), at(0.19, 0.13, 0.20)), 0.20);
    d = join(d, ellipsoid(p, at(0.29, -0.38, 0.30), at(0.20, 0.24, 0.20)), 0.20);
    d = join(d, bar(p, [at(0.47, -0.50, -0.12), at(0.10, -0.86, 0.40)], [0.12, 0.12]), 0.18);
    d = join(d, ellipsoid(p, at(0.0, -0.85, 0.49), at(0.17, 0.12, 0.14)), 0.16);
    d = join(d, bar(p, [at(0.0, -0.6, -0.30), at(0.0, -1.5, -0.34)], [0.36, 0.38]), 0.15);
    // Brow ridge over the bridge, temples pressed in.
    d = join(d, bar(p, [at(0.07, 0.31, 0.565), at(0.34, 0.355, 0.475)], [0.055, 0.05]), 0.16);
    d = join(d, bar(p, [at(0.34, 0.355, 0.475), at(0.54, 0.27, 0.29)], [0.05, 0.04]), 0.16);
    cut(d, ellipsoid(p, at(0.86, 0.36, 0.22), at(0.20, 0.26, 0.26)), 0.20)
}

fn nose(p: DVec3, d: f64) -> f64 {
    let bridge = bar(p, [at(0.0, 0.25, 0.565), at(0.0, -0.19, 0.765)], [0.045, 0.075]);
    let mut d = join(d, ellipsoid(p, at(0.0, -0.17, 0.57), at(0.145, 0.24, 0.17)), 0.12);
    d = join(d, bridge, 0.12);
    d = join(d, ellipsoid(p, at(0.0, -0.215, 0.795), at(0.088, 0.080, 0.085)), 0.07);
    d = join(d, ellipsoid(p, at(0.118, -0.262, 0.675), at(0.066, 0.066, 0.095)), 0.06);
    d = join(d, bar(p, [at(0.0, -0.25, 0.81), at(0.0, -0.325, 0.66)], [0.045, 0.035]), 0.05);
    cut(d, ellipsoid(p, at(0.064, -0.330, 0.735), at(0.032, 0.030, 0.055)), 0.035)
}

fn mouth(p: DVec3, d: f64) -> f64 {
    let mut d = join(d, ellipsoid(p, at(0.0, -0.53, 0.40), at(0.29, 0.25, 0.25)), 0.14);
    d = cut(d, bar(p, [at(0.0, -0.36, 0.700), at(0.0, -0.465, 0.690)], [0.022, 0.028]), 0.06);
    d = cut(d, ellipsoid(p, at(0.0, -0.725, 0.70), at(0.15, 0.045, 0.075)), 0.12);
    // Lips: a bow above, a fuller bar below, and the line between them.
    let upper = join(
        bar(p, [at(0.0, -0.515, 0.648), at(0.06, -0.503, 0.645)], [0.036, 0.040]),
        bar(p, [at(0.06, -0.503, 0.645), at(0.235, -0.560, 0.510)], [0.040, 0.020]),
        0.03,
    );
    let lower = join(
        bar(p, [at(0.0, -0.612, 0.632), at(0.09, -0.608, 0.618)], [0.052, 0.050]),
        bar(p, [at(0.09, -0.608, 0.618), at(0.225, -0.565, 0.515)], [0.050, 0.018]),
        0.03,
    );
    d = join(d, upper, 0.04);
    d = join(d, lower, 0.04);
    let line = bar(p, [at(0.0, -0.558, 0.705), at(0.10, -0.552, 0.685)], [0.020, 0.020]);
    let line = line.min(bar(p, [at(0.10, -0.552, 0.685), at(0.262, -0.570, 0.545)], [0.020, 0.018]));
    cut(d, line, 0.035)
}

/// Centre of the eyeball on the positive side.
const EYE: DVec3 = at(0.295, 0.125, 0.375);
/// Radius of the eyeball.
const EYE_RADIUS: f64 = 0.155;
/// Thickness of the lids.
const LID: f64 = 0.024;
/// Half the width of the opening.
const EYE_HALF_WIDTH: f64 = 0.142;

fn eyes(p: DVec3, d: f64) -> f64 {
    let d = cut(d, ellipsoid(p, at(0.27, 0.145, 0.62), at(0.19, 0.115, 0.13)), 0.14);
    let q = p - EYE;
    let ball = q.length() - EYE_RADIUS;
    let mut d = join(d, ball - LID, 0.05);
    // The opening, an almond seen from the front: below zero inside.
    let x = q.x / EYE_HALF_WIDTH;
    let arch = 1.0 - x * x;
    let tilt = 0.012 * x;
    let upper = q.y - tilt - 0.064 * arch * (1.0 - 0.10 * x);
    let lower = tilt - 0.046 * arch * (1.0 + 0.10 * x) - q.y;
    let opening = -join(-upper, -lower, 0.02);
    // The fold above the upper lid, fading out at the corners.
    let fold = (upper - 0.036).abs().max(q.x.abs() - EYE_HALF_WIDTH) - 0.004;
    d = cut(d, fold.max(ball - 0.06).max(-q.z), 0.035);
    d = cut(d, opening.max(-ball - 0.03).max(-q.z), 0.018);
    // The ball, with the iris pressed in.
    let iris = (q.x * q.x + (q.y - 0.008).powi(2)).sqrt();
    let rim = (iris - 0.052).abs() - 0.002;
    let ball = cut(ball, rim.max(-q.z), 0.012);
    let ball = cut(ball, (iris - 0.018).max(-q.z).max(-ball - 0.03), 0.02);
    d.min(ball)
}
