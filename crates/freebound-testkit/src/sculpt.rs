//! The face as a signed distance: ellipsoids and tapered bars, blended into each other or cut out.
//!
//! y is up and z is forward. Numbers are lengths in mesh units; the face is about two units high. Everything is
//! mirrored at x = 0. Formulas of the primitives and of the quadratic blend follow I. Quilez' published notes.

use glam::DVec3;

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Approximate distance to an ellipsoid.
pub(super) fn ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    let q = (p - centre) / radii;
    let (k, g) = (q.length(), (q / radii).length());
    if g > 0.0 { k * (k - 1.0) / g } else { -radii.min_element() }
}

/// Distance to a bar from `a` to `b`, whose radius changes linearly from the first to the second.
pub(super) fn bar(p: DVec3, [a, b]: [DVec3; 2], [from, to]: [f64; 2]) -> f64 {
    let (pa, ba) = (p - a, b - a);
    let share = (pa.dot(ba) / ba.length_squared()).clamp(0.0, 1.0);
    (pa - ba * share).length() - (from + (to - from) * share)
}

/// Union, blended if the two are nearer than `blend` to each other.
pub(super) fn join(a: f64, b: f64, blend: f64) -> f64 {
    let h = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - h * h * blend / 4.0
}

/// The first without the second, blended.
pub(super) fn cut(a: f64, b: f64, blend: f64) -> f64 {
    -join(-a, b, blend)
}

/// Width of the strip around the mirror that is made smooth.
const MIRROR: f64 = 0.02;

/// Approximate signed distance, negative inside.
pub(super) fn distance(p: DVec3) -> f64 {
    // Rounded at the mirror, where there would be a crease.
    let p = at(p.x.hypot(MIRROR), p.y, p.z);
    let mut d = skull(p);
    d = nose(p, d);
    d = mouth(p, d);
    eyes(p, d)
}

fn skull(p: DVec3) -> f64 {
    let mut d = ellipsoid(p, at(0.0, 0.43, -0.24), at(0.73, 0.82, 0.87));
    d = join(d, ellipsoid(p, at(0.0, -0.26, -0.05), at(0.61, 0.68, 0.62)), 0.25);
    // Cheekbones, cheeks, jaw, chin, neck.
    d = join(d, ellipsoid(p, at(0.41, -0.07, 0.26), at(0.19, 0.13, 0.20)), 0.20);
    d = join(d, ellipsoid(p, at(0.29, -0.38, 0.30), at(0.20, 0.24, 0.20)), 0.20);
    d = join(d, bar(p, [at(0.44, -0.46, -0.16), at(0.06, -0.84, 0.42)], [0.11, 0.11]), 0.24);
    d = join(d, ellipsoid(p, at(0.0, -0.84, 0.49), at(0.15, 0.14, 0.14)), 0.18);
    d = join(d, bar(p, [at(0.0, -0.6, -0.30), at(0.0, -1.5, -0.34)], [0.36, 0.38]), 0.15);
    // Brow ridge over the bridge, temples pressed in.
    d = join(d, bar(p, [at(0.04, 0.31, 0.570), at(0.34, 0.355, 0.475)], [0.055, 0.05]), 0.16);
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

/// Rises from 0 at `from` to 1 at `to`, smoothly.
pub(super) fn ramp(x: f64, from: f64, to: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A bump of height 1 and about this width.
pub(super) fn bump(x: f64, width: f64) -> f64 {
    (-(x / width).powi(2)).exp()
}

/// Half the width of the mouth.
pub(super) const MOUTH_HALF_WIDTH: f64 = 0.262;

/// Position of a point relative to the lips, seen from the front.
pub(super) struct Lips {
    /// Height above the line between the lips.
    pub(super) line: f64,
    /// 1 in the middle, 0 at the corners, less beyond.
    pub(super) arch: f64,
    /// Height above the line, as a share of the height of the upper lip.
    pub(super) upper: f64,
    /// Depth below the line, as a share of the height of the lower lip.
    pub(super) lower: f64,
}

/// Position of a point relative to the lips.
pub(super) fn lips(p: DVec3) -> Lips {
    let x = p.x / MOUTH_HALF_WIDTH;
    let arch = 1.0 - x * x;
    let full = arch.max(0.0);
    let line = p.y + 0.560 + 0.010 * x * x - 0.006 * bump(p.x, 0.05);
    let upper = line / (0.022 + 0.046 * full + 0.012 * bump(p.x.abs() - 0.055, 0.045));
    Lips { line, arch, upper, lower: -line / (0.022 + 0.074 * full) }
}

/// The lips stand out from the muzzle by an amount that depends on the place seen from the front.
fn mouth(p: DVec3, d: f64) -> f64 {
    let d = join(d, ellipsoid(p, at(0.0, -0.53, 0.40), at(0.28, 0.25, 0.25)), 0.14);
    let d = cut(d, ellipsoid(p, at(0.0, -0.735, 0.70), at(0.15, 0.045, 0.075)), 0.12);
    let front = ramp(p.z, 0.25, 0.40);
    if front == 0.0 || (p.y + 0.52).abs() > 0.3 {
        return d;
    }
    let Lips { line, arch, upper, lower } = lips(p);
    let height = if line > 0.0 {
        0.024 * ramp(upper, -0.1, 0.60) * (1.0 - ramp(upper, 0.55, 1.35))
    } else {
        0.029 * ramp(lower, -0.2, 0.70) * (1.0 - ramp(lower, 0.60, 1.35))
    };
    let philtrum = ramp(p.y, -0.515, -0.475) * (1.0 - ramp(p.y, -0.385, -0.340));
    let philtrum = philtrum * (0.009 * bump(p.x - 0.052, 0.026) - 0.014 * bump(p.x, 0.030));
    let groove = 0.014 * bump(line, if line > 0.0 { 0.014 } else { 0.024 }) * ramp(arch, -0.02, 0.20);
    let corner = 0.022 * bump((p.x - 0.262).hypot(p.y + 0.572), 0.035);
    d - front * (height * ramp(arch, 0.0, 0.45) + philtrum - groove - corner)
}

/// Centre of the eyeball on the positive side.
pub(super) const EYE: DVec3 = at(0.295, 0.125, 0.346);
/// Radius of the eyeball.
const EYE_RADIUS: f64 = 0.190;
/// Thickness of the lids.
const LID: f64 = 0.021;
/// Half the width of the opening.
pub(super) const EYE_HALF_WIDTH: f64 = 0.142;
/// Height of the outer corner above the middle. The inner corner lies lower by this amount.
pub(super) const EYE_TILT: f64 = 0.012;
/// Height of the pupil above the middle of the eye.
pub(super) const PUPIL_RISE: f64 = 0.010;

/// Position of a point relative to the lids of the eye on its side, seen from the front.
pub(super) struct Lids {
    /// Height above the edge of the upper lid.
    pub(super) upper: f64,
    /// Depth below the edge of the lower lid.
    pub(super) lower: f64,
    /// Below zero between the lids.
    pub(super) opening: f64,
    /// 1 in the middle, 0 at the corners, less beyond.
    pub(super) arch: f64,
}

/// Position of a point relative to the lids.
pub(super) fn lids(p: DVec3) -> Lids {
    let x = (p.x.abs() - EYE.x) / EYE_HALF_WIDTH;
    let y = p.y - EYE.y - EYE_TILT * x;
    let arch = 1.0 - x * x;
    let upper = y - 0.058 * arch * (1.0 - 0.10 * x);
    let lower = -0.042 * arch * (1.0 + 0.10 * x) - y;
    Lids { upper, lower, opening: -join(-upper, -lower, 0.02), arch }
}

fn eyes(p: DVec3, d: f64) -> f64 {
    let d = cut(d, ellipsoid(p, at(0.27, 0.150, 0.62), at(0.19, 0.115, 0.13)), 0.14);
    let q = p - EYE;
    let ball = q.length() - EYE_RADIUS;
    // The lids, a shell around the ball that fades into the socket.
    let d = join(d, ball - LID + 0.05 * ramp(q.y.abs(), 0.07, 0.20), 0.05);
    let Lids { upper, opening, arch, .. } = lids(p);
    // The fold above the upper lid, fading out at the corners.
    let fold = 0.016 * bump(upper - 0.040, 0.013) * ramp(arch, -0.15, 0.35) * ramp(q.z, 0.0, 0.08);
    let d = cut(d + fold, opening.max(-ball - 0.03).max(-q.z), 0.022);
    // The ball, with the iris pressed in and the pupil deeper.
    let iris = q.x.hypot(q.y - PUPIL_RISE);
    let hollow = 0.013 * (1.0 - ramp(iris, 0.038, 0.056)) + 0.016 * (1.0 - ramp(iris, 0.006, 0.028));
    d.min(ball + ramp(q.z, 0.0, 0.05) * hollow)
}
