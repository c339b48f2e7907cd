//! What a face looks like: its paint, light and edges.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "colours are cut to bytes before")]
#![allow(clippy::many_single_char_names, reason = "corners of a triangle are a, b, c")]

use glam::{DVec2, Vec3};

use super::scene::Scene;
use super::{Colour, Paint, Shading, colours};
use crate::mesh::VertexId;
use crate::solver::Embedding;

/// Edges of triangles smaller than this many samples across fade out, since they would only blacken the picture.
const FAINT: f32 = 8.0;

/// What a face looks like.
pub(super) struct Brush {
    corners: [VertexId; 3],
    base: Colour,
    normals: [Vec3; 3],
    /// Distance of each corner from the opposite side, samples.
    heights: [f32; 3],
    wire: f32,
}

impl Brush {
    /// Prepares a face of a scene; the area is twice its own in the picture, y down.
    pub(super) fn new(scene: &Scene, f: usize, double_area: f32) -> Self {
        let corners = scene.triangles[f];
        let [a, b, c] = corners.map(|v| scene.points[v.index()]);
        // y points down in the picture, so that a face seen from outside has a negative area there.
        let is_front = double_area < 0.0;
        let base = match scene.paint {
            Paint::Faces(colours) => colours[f],
            Paint::Clay if is_front => colours::CLAY,
            Paint::Clay => colours::CLAY_BACK,
            Paint::Checker { .. } | Paint::Picture { .. } => colours::BACKGROUND,
        };
        let own = (b - a).cross(c - a) * Vec3::new(1.0, -1.0, 1.0);
        let own = (-own).try_normalize().unwrap_or(Vec3::Z);
        let normals = match scene.canvas.shading {
            Shading::Smooth if scene.normals.len() == scene.points.len() => corners.map(|v| scene.normals[v.index()]),
            _ => [own; 3],
        };
        let sides = [[b, c], [c, a], [a, b]].map(|[u, v]| u.truncate().distance(v.truncate()));
        let heights = sides.map(|side| double_area.abs() / side.max(f32::MIN_POSITIVE));
        let fade = (heights[0].min(heights[1]).min(heights[2]) / FAINT).min(1.0);
        Self {
            corners,
            base,
            normals: if is_front { normals } else { normals.map(|n| -n) },
            heights,
            wire: scene.canvas.wire * fade,
        }
    }

    /// The colour of a place, given by its shares of the corners.
    pub(super) fn colour(&self, scene: &Scene, shares: Vec3) -> Colour {
        let mut colour = match scene.paint {
            Paint::Clay | Paint::Faces(_) => self.base,
            Paint::Checker { coordinates, size } => {
                let at = self.mean(coordinates, shares) / size;
                let odd = (at.x.floor() + at.y.floor()).rem_euclid(2.0) >= 1.0;
                if odd { colours::CHECKER } else { colours::BACKGROUND }
            }
            Paint::Picture { coordinates, picture } => picture.sample(self.mean(coordinates, shares)),
        };
        if scene.canvas.shading != Shading::Unlit {
            let [a, b, c] = self.normals;
            let normal = (a * shares.x + b * shares.y + c * shares.z).try_normalize().unwrap_or(Vec3::Z);
            colour = lit(colour, normal);
        }
        if self.wire > 0.0 {
            let edge = (shares * Vec3::from(self.heights)).min_element();
            let cover = (0.5 * scene.canvas.samples.max(1) as f32 + 0.5 - edge).clamp(0.0, 1.0) * self.wire;
            colour = mix(colour, colours::WIRE, cover);
        }
        colour
    }
}

impl Brush {
    /// The mean of what the corners have, by shares.
    fn mean(&self, coordinates: &Embedding, shares: Vec3) -> DVec2 {
        let [a, b, c] = self.corners.map(|v| coordinates[v.index()]);
        a * f64::from(shares.x) + b * f64::from(shares.y) + c * f64::from(shares.z)
    }
}

fn mix(a: Colour, b: Colour, share: f32) -> Colour {
    [0, 1, 2].map(|k| (f32::from(a[k]) + (f32::from(b[k]) - f32::from(a[k])) * share).round() as u8)
}

/// A colour in the fixed light, for a normal in camera axes.
fn lit(colour: Colour, normal: Vec3) -> Colour {
    const KEY: Vec3 = Vec3::new(-0.41, 0.55, 0.73);
    const FILL: Vec3 = Vec3::new(0.80, -0.10, 0.59);
    let key = normal.dot(KEY).max(0.0);
    let fill = normal.dot(FILL).max(0.0);
    let sky = 0.5 + 0.5 * normal.y;
    // Light adds up linearly; the square root is near enough to the sRGB curve.
    let light = (0.07 + 0.12 * sky + 0.90 * key * key + 0.22 * fill).sqrt();
    colour.map(|c| (f32::from(c) * light).min(255.0).round() as u8)
}
