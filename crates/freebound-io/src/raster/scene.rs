//! Triangles in samples, drawn band by band into a z-buffer; paint, light and edges of a face.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "samples and colours come from floats that were cut to the picture and to bytes before"
)]
#![allow(clippy::many_single_char_names, reason = "corners of a triangle are a, b, c")]

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::{Canvas, Colour, RasterPaint, RasterShading, colours};
use freebound_core::geom::{Picture, SpaceBounds};
use freebound_core::mesh::VertexId;
use freebound_core::problem::Embedding;

/// Margin around the mesh on each side, as a fraction of the picture.
const MARGIN: f32 = 0.04;

/// Height of a band in samples: enough bands for any number of threads, few enough to sort triangles into.
const BAND: usize = 64;

/// Size in samples below which the edges of a triangle fade out, because they would only blacken the picture.
const FAINT: f32 = 8.0;

/// Normals of the vertices: sums of the faces' area vectors, scaled to length 1.
pub(super) fn vertex_normals(seen: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; seen.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| seen[v.index()]);
        let area = (b - a).cross(c - a);
        for v in t {
            sums[v.index()] += area;
        }
    }
    sums.into_iter().map(|n| n.try_normalize().unwrap_or(DVec3::Z).as_vec3()).collect()
}

/// Points projected to samples, ready to be drawn band by band.
pub(super) struct Scene<'a> {
    canvas: Canvas,
    /// Projected points: x right, y down, z towards the eye, all in samples.
    pub(super) points: Vec<Vec3>,
    triangles: &'a [[VertexId; 3]],
    paint: RasterPaint<'a>,
    normals: &'a [Vec3],
    width: usize,
    height: usize,
}

/// Depth and colour of the samples of one band.
struct Band {
    top: usize,
    rows: usize,
    depth: Vec<f32>,
    colour: Vec<Colour>,
}

impl<'a> Scene<'a> {
    pub(super) fn new(
        seen: &[DVec3],
        triangles: &'a [[VertexId; 3]],
        canvas: &Canvas,
        paint: RasterPaint<'a>,
        normals: &'a [Vec3],
    ) -> Self {
        let samples = canvas.samples.max(1) as usize;
        let (width, height) = (canvas.width as usize * samples, canvas.height as usize * samples);
        let SpaceBounds { low, high } = SpaceBounds::of(seen.iter().copied());
        let (centre, extent) = ((low + high) / 2.0, (high - low).max(DVec3::splat(f64::MIN_POSITIVE)));
        let room = f64::from(1.0 - 2.0 * MARGIN);
        let scale = (width as f64 * room / extent.x).min(height as f64 * room / extent.y);
        let middle = DVec3::new(width as f64 / 2.0, height as f64 / 2.0, 0.0);
        let flip_y = DVec3::new(1.0, -1.0, 1.0);
        let points = seen.par_iter().map(|p| (middle + scale * flip_y * (*p - centre)).as_vec3()).collect();
        Self { canvas: *canvas, points, triangles, paint, normals, width, height }
    }

    pub(super) fn picture(&self, boundary: &[[VertexId; 2]]) -> Picture {
        let samples = self.canvas.samples.max(1) as usize;
        // A band holds whole pixels.
        let rows = BAND.div_ceil(samples) * samples;
        let lists = self.sort_into_bands(rows);
        let strips: Vec<Vec<u8>> = lists
            .par_iter()
            .enumerate()
            .map(|(i, list)| {
                let top = i * rows;
                let mut band = Band::new(top, rows.min(self.height - top), self.width);
                for &f in list {
                    self.draw(&mut band, f as usize);
                }
                for &[a, b] in boundary {
                    self.stroke(&mut band, [a, b].map(|v| self.points[v.index()].truncate()));
                }
                band.average(self.width, samples)
            })
            .collect();
        Picture { width: self.canvas.width, height: self.canvas.height, pixels: strips.concat() }
    }

    /// Faces that may touch each band, in file order.
    fn sort_into_bands(&self, rows: usize) -> Vec<Vec<u32>> {
        let mut lists = vec![Vec::new(); self.height.div_ceil(rows)];
        let last = lists.len().saturating_sub(1);
        for (f, t) in (0_u32..).zip(self.triangles) {
            let [a, b, c] = t.map(|v| self.points[v.index()].y);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            if !(a + b + c).is_finite() || high < 0.0 || low >= self.height as f32 {
                continue;
            }
            for list in &mut lists[low as usize / rows..=(high as usize / rows).min(last)] {
                list.push(f);
            }
        }
        lists
    }

    fn draw(&self, band: &mut Band, f: usize) {
        let corners = self.triangles[f];
        let [a, b, c] = corners.map(|v| self.points[v.index()]);
        let double_area = (b - a).truncate().perp_dot((c - a).truncate());
        if double_area == 0.0 || !double_area.is_finite() {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let columns = low.x.floor().max(0.0) as usize..(high.x.ceil().max(0.0) as usize).min(self.width);
        let first = (low.y.floor().max(0.0) as usize).max(band.top);
        let last = (high.y.ceil().max(0.0) as usize).min(band.top + band.rows);
        let brush = Brush::new(self, f, double_area);
        for y in first..last {
            for x in columns.clone() {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let share = |u: Vec3, v: Vec3| (v.truncate() - u.truncate()).perp_dot(p - u.truncate()) / double_area;
                let shares = Vec3::new(share(b, c), share(c, a), share(a, b));
                if shares.min_element() < 0.0 {
                    continue;
                }
                let depth = shares.dot(Vec3::new(a.z, b.z, c.z));
                let at = (y - band.top) * self.width + x;
                if depth > band.depth[at] {
                    band.depth[at] = depth;
                    band.colour[at] = brush.colour(self, shares);
                }
            }
        }
    }

    /// Draws a segment of the boundary over the faces.
    fn stroke(&self, band: &mut Band, [a, b]: [Vec2; 2]) {
        let half = 0.9 * self.canvas.samples.max(1) as f32;
        let (low, high) = (a.min(b) - half, a.max(b) + half);
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        let length_squared = (b - a).length_squared().max(f32::MIN_POSITIVE);
        let first = (low.y.max(0.0) as usize).max(band.top);
        let last = (high.y.max(0.0) as usize + 1).min(band.top + band.rows);
        for y in first..last {
            for x in low.x.max(0.0) as usize..(high.x.max(0.0) as usize + 1).min(self.width) {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let share = ((p - a).dot(b - a) / length_squared).clamp(0.0, 1.0);
                if p.distance(a.lerp(b, share)) <= half {
                    band.colour[(y - band.top) * self.width + x] = colours::BOUNDARY;
                }
            }
        }
    }
}

impl Band {
    fn new(top: usize, rows: usize, width: usize) -> Self {
        let count = rows * width;
        Self { top, rows, depth: vec![f32::NEG_INFINITY; count], colour: vec![colours::BACKGROUND; count] }
    }

    /// Pixels of the band: means of their samples.
    fn average(&self, width: usize, samples: usize) -> Vec<u8> {
        let count = u32::try_from(samples * samples).expect("few samples per pixel");
        let mut pixels = Vec::with_capacity(4 * self.colour.len() / (samples * samples).max(1));
        for y in 0..self.rows / samples {
            for x in 0..width / samples {
                let mut sum = [0_u32; 3];
                for at in
                    (0..samples).flat_map(|j| (0..samples).map(move |i| (samples * y + j) * width + samples * x + i))
                {
                    for (s, &c) in sum.iter_mut().zip(&self.colour[at]) {
                        *s += u32::from(c);
                    }
                }
                pixels.extend(sum.map(|s| u8::try_from((s + count / 2) / count).expect("a mean of bytes")));
                pixels.push(255);
            }
        }
        pixels
    }
}

/// Appearance of a face.
struct Brush {
    corners: [VertexId; 3],
    base: Colour,
    normals: [Vec3; 3],
    /// Distance of each corner from the opposite side, samples.
    heights: [f32; 3],
    wire: f32,
}

impl Brush {
    /// Prepares a face of a scene; `double_area` is twice its signed area in the picture, y down.
    fn new(scene: &Scene, f: usize, double_area: f32) -> Self {
        let corners = scene.triangles[f];
        let [a, b, c] = corners.map(|v| scene.points[v.index()]);
        // y points down in the picture, so a face seen from outside has a negative area there.
        let is_front = double_area < 0.0;
        let base = match scene.paint {
            RasterPaint::Faces(colours) => colours[f],
            RasterPaint::Clay if is_front => colours::CLAY,
            RasterPaint::Clay => colours::CLAY_BACK,
            RasterPaint::Checker { .. } | RasterPaint::Picture { .. } => colours::BACKGROUND,
        };
        let own = (b - a).cross(c - a) * Vec3::new(1.0, -1.0, 1.0);
        let own = (-own).try_normalize().unwrap_or(Vec3::Z);
        let normals = match scene.canvas.shading {
            RasterShading::Smooth if scene.normals.len() == scene.points.len() => {
                corners.map(|v| scene.normals[v.index()])
            }
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

    /// Colour at a point, given by its barycentric coordinates.
    fn colour(&self, scene: &Scene, shares: Vec3) -> Colour {
        let mut colour = match scene.paint {
            RasterPaint::Clay | RasterPaint::Faces(_) => self.base,
            RasterPaint::Checker { coordinates, size } => {
                let at = self.mean(coordinates, shares) / size;
                let odd = (at.x.floor() + at.y.floor()).rem_euclid(2.0) >= 1.0;
                if odd { colours::CHECKER } else { colours::BACKGROUND }
            }
            RasterPaint::Picture { coordinates, picture } => picture.sample(self.mean(coordinates, shares)),
        };
        if scene.canvas.shading != RasterShading::Unlit {
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

    /// Interpolated coordinate at barycentric coordinates.
    fn mean(&self, coordinates: &Embedding, shares: Vec3) -> DVec2 {
        let [a, b, c] = self.corners.map(|v| coordinates[v.index()]);
        a * f64::from(shares.x) + b * f64::from(shares.y) + c * f64::from(shares.z)
    }
}

fn mix(a: Colour, b: Colour, share: f32) -> Colour {
    [0, 1, 2].map(|k| (f32::from(a[k]) + (f32::from(b[k]) - f32::from(a[k])) * share).round() as u8)
}

/// Colour in the fixed light, for a normal in camera axes.
fn lit(colour: Colour, normal: Vec3) -> Colour {
    const KEY: Vec3 = Vec3::new(-0.41, 0.55, 0.73);
    const FILL: Vec3 = Vec3::new(0.80, -0.10, 0.59);
    let key = normal.dot(KEY).max(0.0);
    let fill = normal.dot(FILL).max(0.0);
    let sky = 0.5 + 0.5 * normal.y;
    // Light adds up linearly; the square root approximates the sRGB curve.
    let light = (0.07 + 0.12 * sky + 0.90 * key * key + 0.22 * fill).sqrt();
    colour.map(|c| (f32::from(c) * light).min(255.0).round() as u8)
}
