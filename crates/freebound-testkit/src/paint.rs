//! Colours of the portrait: skin, hair, eyes, lips, brows and cloth, at a position in a light.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::relief::Matter;
use super::sculpt::{EYE, EYE_HALF_WIDTH, Lids, Lips, PUPIL_RISE, bump, lids, lips, ramp};

/// A sample of the portrait.
pub(super) struct Spot {
    /// Position in the picture's plane, y up.
    pub(super) place: DVec2,
    /// Position on the sculpture.
    pub(super) on_face: DVec3,
    /// Normal, y up, z towards the eye.
    pub(super) normal: DVec3,
    /// Depth of the surface behind its surroundings.
    pub(super) hollow: f64,
    /// Matter of the surface.
    pub(super) matter: Matter,
}

const fn rgb(r: f64, g: f64, b: f64) -> DVec3 {
    DVec3::new(r, g, b)
}

// Linear light from here on; the last step converts it to sRGB.
const SKIN: DVec3 = rgb(0.66, 0.36, 0.235);
const BLUSH: DVec3 = rgb(0.66, 0.21, 0.155);
const LIP: DVec3 = rgb(0.48, 0.105, 0.095);
const HAIR: DVec3 = rgb(0.085, 0.040, 0.022);
const HAIR_LIGHT: DVec3 = rgb(0.42, 0.20, 0.085);
const CLOTH: DVec3 = rgb(0.045, 0.12, 0.17);
const IRIS: DVec3 = rgb(0.075, 0.19, 0.21);
const IRIS_LIGHT: DVec3 = rgb(0.30, 0.42, 0.33);
const DARK: DVec3 = rgb(0.018, 0.010, 0.008);

/// Direction of the main light.
const KEY: DVec3 = rgb(-0.46, 0.55, 0.70);
/// Direction of the weaker light.
const FILL: DVec3 = rgb(0.80, 0.10, 0.59);

/// Colour of a sample in sRGB, each part in `[0, 1]` or a little beyond.
pub(super) fn colour(spot: &Spot) -> DVec3 {
    let light = match spot.matter {
        Matter::Air => background(spot.place),
        Matter::Skin => skin(spot),
        Matter::Hair => hair(spot),
        Matter::Cloth => cloth(spot),
    };
    light.max(DVec3::ZERO).powf(1.0 / 2.2)
}

/// Repeatable noise on whole numbers, in `[0, 1)`.
fn speckle(x: i64, y: i64) -> f64 {
    let mut h = (x.cast_unsigned().wrapping_mul(0x9e37_79b9_7f4a_7c15))
        ^ (y.cast_unsigned().wrapping_mul(0xc2b2_ae3d_27d4_eb4f));
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h ^= h >> 32;
    (h >> 11) as f64 / (1_u64 << 53) as f64
}

/// Smooth noise in `[0, 1)` with features about 1 wide.
fn noise(p: DVec2) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let s = f * f * (3.0 - 2.0 * f);
    let (i, j) = (cell.x as i64, cell.y as i64);
    let low = speckle(i, j) + (speckle(i + 1, j) - speckle(i, j)) * s.x;
    let high = speckle(i, j + 1) + (speckle(i + 1, j + 1) - speckle(i, j + 1)) * s.x;
    low + (high - low) * s.y
}

/// Noise of three scales, in `[0, 1)`.
fn clouds(p: DVec2) -> f64 {
    (4.0 * noise(p) + 2.0 * noise(2.1 * p + 17.0) + noise(4.3 * p + 5.0)) / 7.0
}

fn background(place: DVec2) -> DVec3 {
    let glow = bump((place - DVec2::new(-0.35, 0.35)).length(), 1.25);
    let strokes = clouds(DVec2::new(3.0 * place.x + 1.5 * place.y, 9.0 * place.y - 4.0 * place.x));
    rgb(0.055, 0.085, 0.095).lerp(rgb(0.36, 0.41, 0.38), 0.85 * glow) * (0.86 + 0.28 * strokes)
}

/// Light on a surface that scatters some of it below, red the farthest.
fn soft_light(spot: &Spot) -> DVec3 {
    let (key, fill) = (spot.normal.dot(KEY), spot.normal.dot(FILL).max(0.0));
    let wrap = |by: f64| ((key + by) / (1.0 + by)).max(0.0).powf(1.25);
    let key = rgb(1.12 * wrap(0.42), 1.06 * wrap(0.28), 0.98 * wrap(0.22));
    let sky = 0.5 + 0.5 * spot.normal.y;
    let shade = 1.0 - 9.0 * spot.hollow.clamp(0.0, 0.055) + 2.0 * (-spot.hollow).clamp(0.0, 0.04);
    (key + fill * rgb(0.13, 0.15, 0.19) + rgb(0.10, 0.11, 0.14).lerp(rgb(0.19, 0.21, 0.24), sky)) * shade
}

fn shine(spot: &Spot, sharpness: f64) -> f64 {
    let half = (KEY + DVec3::Z).try_normalize().unwrap_or(DVec3::Z);
    spot.normal.dot(half).max(0.0).powf(sharpness)
}

fn skin(spot: &Spot) -> DVec3 {
    let p = spot.on_face;
    let side = p.x.abs();
    let mut base = SKIN * (0.93 + 0.14 * clouds(7.0 * spot.place));
    let red = 0.50 * bump(DVec2::new((side - 0.37) / 1.1, p.y + 0.22).length(), 0.19)
        + 0.40 * bump(DVec2::new(side, p.y + 0.24).length(), 0.13)
        + 0.25 * bump(DVec2::new(side - 0.72, p.y).length(), 0.16)
        + 0.12 * bump(DVec2::new(side, p.y + 0.90).length(), 0.14);
    base = base.lerp(BLUSH, red.min(0.6));
    // The socket is a little darker and cooler.
    let socket = bump(DVec2::new(side - EYE.x, 1.3 * (p.y - EYE.y - 0.02)).length(), 0.16);
    base = base.lerp(rgb(0.46, 0.22, 0.17), 0.22 * socket);
    let mut light = base * soft_light(spot) + 0.10 * shine(spot, 26.0);
    if p.z > 0.2 {
        light = paint_lips(spot, light);
        light = paint_eye(spot, light);
        light = paint_brow(spot, light);
    }
    // Nostrils and the shadow under the nose.
    let nostril = bump(DVec2::new((side - 0.070) / 1.35, p.y + 0.322).length(), 0.026);
    light.lerp(DARK, 0.75 * nostril)
}

fn paint_lips(spot: &Spot, under: DVec3) -> DVec3 {
    let Lips { line, arch, upper, lower } = lips(spot.on_face);
    let height = if line > 0.0 { upper } else { lower };
    let cover = (1.0 - ramp(height, 0.93, 1.12)) * ramp(arch, -0.01, 0.06);
    let tone = if line > 0.0 { 0.78 } else { 1.12 };
    let creases = 0.90 + 0.20 * noise(DVec2::new(60.0 * spot.on_face.x, 4.0 * spot.on_face.y));
    let gloss = 0.16 * shine(spot, 30.0) + 0.10 * bump(lower - 0.45, 0.16) * bump(spot.on_face.x + 0.04, 0.10);
    let lip = LIP * tone * creases * soft_light(spot) + gloss;
    let painted = under.lerp(lip, 0.90 * cover);
    painted.lerp(DARK, 0.85 * bump(line, 0.0075) * ramp(arch, -0.05, 0.12))
}

fn paint_eye(spot: &Spot, under: DVec3) -> DVec3 {
    let p = spot.on_face;
    let Lids { upper, lower, opening, arch } = lids(p);
    let mut light = under;
    // The fold above the lid.
    light = light.lerp(rgb(0.16, 0.065, 0.045), 0.55 * bump(upper - 0.036, 0.007) * ramp(arch, -0.10, 0.35));
    let inside = 1.0 - ramp(opening, -0.003, 0.003);
    if inside > 0.0 {
        light = light.lerp(eyeball(p, upper), inside);
    }
    // The lower rim is moist and light, the upper one dark with lashes; the lashes grow towards the outer corner.
    light = light.lerp(rgb(0.62, 0.34, 0.27), 0.6 * bump(lower - 0.004, 0.005) * ramp(arch, 0.02, 0.3));
    let outwards = (p.x.abs() - EYE.x) / EYE_HALF_WIDTH;
    let thick = 0.006 + 0.006 * ramp(outwards, -0.6, 1.0);
    let lash = bump(upper - 0.4 * thick, thick) * ramp(arch, -0.22, 0.08);
    light = light.lerp(DARK, 0.93 * lash);
    light.lerp(DARK, 0.35 * bump(lower - 0.010, 0.005) * ramp(arch, 0.0, 0.3) * ramp(outwards, -0.3, 0.8))
}

/// Eyeball between the lids: white with a shadow from the upper lid, iris with rays, pupil, and the lamp's
/// reflection.
fn eyeball(p: DVec3, upper: f64) -> DVec3 {
    let x = p.x.abs() - EYE.x;
    let from_pupil = DVec2::new(p.x - EYE.x * p.x.signum(), p.y - EYE.y - PUPIL_RISE + 0.004);
    let r = from_pupil.length();
    let corner = ramp(x.abs(), 0.06, 0.145);
    let mut light = rgb(0.72, 0.69, 0.66).lerp(rgb(0.50, 0.33, 0.29), 0.75 * corner);
    light = light.lerp(rgb(0.55, 0.20, 0.17), 0.8 * ramp(-x, 0.115, 0.140));
    let angle = from_pupil.to_angle() / TAU;
    let rays = noise(DVec2::new(70.0 * angle, 30.0 * r));
    let iris =
        IRIS.lerp(IRIS_LIGHT, (0.25 + 0.75 * rays) * ramp(r, 0.052, 0.024) + 0.35 * ramp(-from_pupil.y, -0.01, 0.05));
    let iris = iris.lerp(DARK, ramp(r, 0.044, 0.055));
    light = light.lerp(iris, 1.0 - ramp(r, 0.0525, 0.0565));
    light = light.lerp(DARK * 0.6, 1.0 - ramp(r, 0.0205, 0.0245));
    light *= 1.0 - 0.62 * ramp(upper, -0.034, 0.0);
    // Both eyes show the lamp on the same side.
    let lamp = 1.0 - ramp((from_pupil - DVec2::new(-0.018, 0.017)).length(), 0.0085, 0.0125);
    let window = 0.25 * bump((from_pupil - DVec2::new(0.022, -0.020)).length(), 0.012);
    light.lerp(rgb(1.0, 1.0, 0.98), lamp.max(window))
}

fn paint_brow(spot: &Spot, under: DVec3) -> DVec3 {
    let p = spot.on_face;
    let side = p.x.abs();
    let t = ((side - 0.100) / 0.40).clamp(0.0, 1.0);
    let middle = 0.268 + 0.105 * t - 0.100 * t.powi(3);
    let thick = 0.033 * ramp(t, -0.25, 0.15) * (1.0 - 0.72 * ramp(t, 0.35, 1.0));
    let ends = ramp(side, 0.085, 0.140) * (1.0 - ramp(side, 0.47, 0.52));
    let across = (p.y - middle) / thick;
    // Hairs lean outwards.
    let hairs = noise(DVec2::new(95.0 * (side - 0.55 * (p.y - middle)), 9.0 * p.y));
    let cover = (1.0 - ramp(across.abs(), 0.25 + 0.5 * hairs, 0.85 + 0.45 * hairs)) * ends;
    under.lerp(HAIR * 1.1 * (0.8 + 0.6 * hairs), 0.88 * cover)
}

fn hair(spot: &Spot) -> DVec3 {
    // Strands run from the parting, beside the middle, over the head.
    let from = spot.place - DVec2::new(-0.20, 0.89);
    let angle = from.y.atan2(from.x.abs() + 0.05) + 0.35 * from.length();
    let sign = from.x.signum();
    let coarse = noise(DVec2::new(14.0 * angle + 40.0 * sign, 2.5 * from.length()));
    let strands = noise(DVec2::new(70.0 * angle + 90.0 * sign, 5.0 * from.length()));
    let fine = noise(DVec2::new(190.0 * angle + 10.0 * sign, 9.0 * from.length()));
    let texture = 0.40 * coarse + 0.36 * strands + 0.24 * fine;
    let key = spot.normal.dot(KEY).max(0.0);
    let band = bump(spot.normal.dot(DVec3::new(-0.20, 0.62, 0.75)) - 0.97, 0.075);
    let base = HAIR.lerp(HAIR_LIGHT, 0.50 * ramp(texture, 0.35, 0.85));
    let shade = 1.0 - 7.0 * spot.hollow.clamp(0.0, 0.06);
    (base * (0.30 + 0.95 * key) + HAIR_LIGHT * band * 0.75 * ramp(texture, 0.25, 0.85)) * shade
}

fn cloth(spot: &Spot) -> DVec3 {
    let weave = 0.85 + 0.30 * clouds(DVec2::new(16.0 * spot.place.x, 5.0 * spot.place.y));
    let key = (0.25 + 0.75 * spot.normal.dot(KEY)).max(0.0);
    let shade = 1.0 - 8.0 * spot.hollow.clamp(0.0, 0.06);
    CLOTH * weave * (0.25 + 1.1 * key) * shade
}
