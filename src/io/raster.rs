//! Pictures of meshes without a screen: a small z-buffer rasterizer.
//!
//! Light and shade are fixed: a key light from the upper left of the camera, a weaker one from the right, and a sky.
//! Triangles are drawn in horizontal bands, one per task, each band in file order: the picture does not depend on the
//! number of threads. Several samples per pixel are averaged.

use std::io::Write;

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use robust::{Coord, orient2d};

use crate::geom::Picture;
use crate::mesh::{EdgeTable, VertexId};

/// A colour without opacity, sRGB.
pub type Colour = [u8; 3];

/// Colours of the light theme.
pub mod colours {
    use super::Colour;

    /// The outer side of the surface.
    pub const CLAY: Colour = [0xd8, 0xd4, 0xcc];
    /// The inner side of the surface.
    pub const CLAY_BACK: Colour = [0xa9, 0xa3, 0x9a];
    /// Behind everything.
    pub const BACKGROUND: Colour = [0xf4, 0xf4, 0xf2];
    /// A flipped face.
    pub const FLIPPED: Colour = [0xd9, 0x2d, 0x3a];
    /// Edges of faces.
    pub const WIRE: Colour = [0x6e, 0x6b, 0x66];
    /// The boundary loop.
    pub const BOUNDARY: Colour = [0x2c, 0x2b, 0x29];
    /// The dark fields of the checker.
    pub const CHECKER: Colour = [0x6f, 0x8f, 0xb8];
}

/// The share of the picture that is left free around the mesh, on each side.
const MARGIN: f32 = 0.04;

/// Bands are this high, in samples: enough of them for any number of threads, few enough to sort triangles into.
const BAND: usize = 64;

/// Edges of triangles smaller than this many samples across fade out, since they would only blacken the picture.
const FAINT: f32 = 8.0;

/// Where a mesh is seen from. Parallel projection; the mesh is framed by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the mesh towards the eye; need not be of unit length.
    pub eye: DVec3,
    /// What is up in the picture, roughly.
    pub up: DVec3,
}

impl View {
    /// From the front (+z), y up.
    pub const FRONT: Self = Self { eye: DVec3::Z, up: DVec3::Y };

    /// Turned around y by an angle, radians: positive shows more of the +x side.
    pub fn turned(angle: f64) -> Self {
        Self { eye: DVec3::new(angle.sin(), 0.0, angle.cos()), up: DVec3::Y }
    }

    /// Right, up and towards the eye, orthonormal whatever was given.
    fn axes(&self) -> [DVec3; 3] {
        let towards = self.eye.try_normalize().unwrap_or(DVec3::Z);
        let right = self.up.cross(towards).try_normalize().unwrap_or_else(|| towards.any_orthonormal_vector());
        [right, towards.cross(right), towards]
    }
}

/// How faces are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// As if the surface were round between the vertices.
    Smooth,
    /// Each face by its own normal.
    Faceted,
    /// No light at all.
    Unlit,
}

/// Size and manner of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canvas {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples per pixel in each direction.
    pub samples: u32,
    /// How faces are shaded.
    pub shading: Shading,
    /// How strongly edges are drawn, from 0 (not at all) to 1.
    pub wire: f32,
}

impl Canvas {
    /// Lit clay without edges, 2 × 2 samples per pixel.
    pub const fn clay(width: u32, height: u32) -> Self {
        Self { width, height, samples: 2, shading: Shading::Smooth, wire: 0.0 }
    }

    /// Unlit faces with thin edges, 2 × 2 samples per pixel.
    pub const fn drawing(width: u32, height: u32) -> Self {
        Self { width, height, samples: 2, shading: Shading::Unlit, wire: 0.6 }
    }
}

/// What colour the faces are.
#[derive(Clone, Copy, Debug)]
pub enum Paint<'a> {
    /// Clay; flipped faces red in the plane.
    Clay,
    /// One colour per face.
    Faces(&'a [Colour]),
    /// A checker in coordinates given per vertex.
    Checker {
        /// One per vertex.
        coordinates: &'a [DVec2],
        /// Width of a field.
        size: f64,
    },
}

/// A picture of a mesh in space.
pub fn mesh_picture(
    positions: &[DVec3],
    triangles: &[[VertexId; 3]],
    view: &View,
    canvas: &Canvas,
    paint: Paint,
) -> Picture {
    let [right, up, towards] = view.axes();
    let seen: Vec<DVec3> = positions.par_iter().map(|p| DVec3::new(p.dot(right), p.dot(up), p.dot(towards))).collect();
    let normals = vertex_normals(&seen, triangles);
    let scene = Scene::new(&seen, triangles, canvas, paint, &normals);
    scene.picture(&[])
}

/// A picture of an embedding: thin edges, the boundary as a darker line and, in clay, flipped faces red.
pub fn plane_picture(embedding: &[DVec2], triangles: &[[VertexId; 3]], canvas: &Canvas, paint: Paint) -> Picture {
    let seen: Vec<DVec3> = embedding.iter().map(|p| p.extend(0.0)).collect();
    let flipped: Vec<Colour>;
    let paint = if let Paint::Clay = paint {
        flipped = triangles
            .par_iter()
            .map(|t| if is_flipped(embedding, *t) { colours::FLIPPED } else { colours::CLAY })
            .collect();
        Paint::Faces(&flipped)
    } else {
        paint
    };
    let table = EdgeTable::new(embedding.len(), triangles);
    let outer = |sides: &[u32]| (sides.len() == 1).then(|| sides[0] as usize);
    let boundary: Vec<[VertexId; 2]> =
        table.edges().filter_map(outer).map(|s| [triangles[s / 3][s % 3], triangles[s / 3][(s + 1) % 3]]).collect();
    let scene = Scene::new(&seen, triangles, canvas, paint, &[]);
    scene.picture(&boundary)
}

/// Whether a face of an embedding does not run counter-clockwise; decided exactly.
fn is_flipped(embedding: &[DVec2], face: [VertexId; 3]) -> bool {
    let [a, b, c] = face.map(|v| embedding[v.index()]).map(|p| Coord { x: p.x, y: p.y });
    // Not a number is not counter-clockwise either.
    !(orient2d(a, b, c) > 0.0)
}

impl Picture {
    /// Writes the picture as a PNG.
    ///
    /// # Errors
    ///
    /// What the writer or the encoder reports.
    pub fn write_png(&self, writer: impl Write) -> image::ImageResult<()> {
        let encoder = image::codecs::png::PngEncoder::new(writer);
        image::ImageEncoder::write_image(
            encoder,
            &self.pixels,
            self.width,
            self.height,
            image::ExtendedColorType::Rgba8,
        )
    }
}

/// Sums of the faces' area vectors at each vertex, to length 1.
fn vertex_normals(seen: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<Vec3> {
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

/// Everything projected to samples, ready to be drawn band by band.
struct Scene<'a> {
    canvas: Canvas,
    /// x to the right, y down, z towards the eye, all in samples.
    points: Vec<Vec3>,
    triangles: &'a [[VertexId; 3]],
    paint: Paint<'a>,
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
    fn new(
        seen: &[DVec3],
        triangles: &'a [[VertexId; 3]],
        canvas: &Canvas,
        paint: Paint<'a>,
        normals: &'a [Vec3],
    ) -> Self {
        let samples = canvas.samples.max(1) as usize;
        let (width, height) = (canvas.width as usize * samples, canvas.height as usize * samples);
        let finite = || seen.iter().filter(|p| p.is_finite());
        let low = finite().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = finite().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (centre, extent) = ((low + high) / 2.0, (high - low).max(DVec3::splat(f64::MIN_POSITIVE)));
        let room = f64::from(1.0 - 2.0 * MARGIN);
        let scale = (width as f64 * room / extent.x).min(height as f64 * room / extent.y);
        let middle = DVec3::new(width as f64 / 2.0, height as f64 / 2.0, 0.0);
        let flip_y = DVec3::new(1.0, -1.0, 1.0);
        let points = seen.par_iter().map(|p| (middle + scale * flip_y * (*p - centre)).as_vec3()).collect();
        Self { canvas: *canvas, points, triangles, paint, normals, width, height }
    }

    fn picture(&self, boundary: &[[VertexId; 2]]) -> Picture {
        let samples = self.canvas.samples.max(1) as usize;
        // Whole pixels per band.
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

    /// The faces that may touch each band, in file order.
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
        let brush = self.brush(f, double_area);
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

    fn brush(&self, f: usize, double_area: f32) -> Brush {
        let corners = self.triangles[f];
        let [a, b, c] = corners.map(|v| self.points[v.index()]);
        // y points down in the picture, so that a face seen from outside has a negative area there.
        let is_front = double_area < 0.0;
        let base = match self.paint {
            Paint::Faces(colours) => colours[f],
            Paint::Clay if is_front => colours::CLAY,
            Paint::Clay => colours::CLAY_BACK,
            Paint::Checker { .. } => colours::BACKGROUND,
        };
        let own = (b - a).cross(c - a) * Vec3::new(1.0, -1.0, 1.0);
        let own = (-own).try_normalize().unwrap_or(Vec3::Z);
        let normals = match self.canvas.shading {
            Shading::Smooth if self.normals.len() == self.points.len() => corners.map(|v| self.normals[v.index()]),
            _ => [own; 3],
        };
        let sides = [[b, c], [c, a], [a, b]].map(|[u, v]| u.truncate().distance(v.truncate()));
        let heights = sides.map(|side| double_area.abs() / side.max(f32::MIN_POSITIVE));
        let fade = (heights[0].min(heights[1]).min(heights[2]) / FAINT).min(1.0);
        Brush {
            corners,
            base,
            normals: if is_front { normals } else { normals.map(|n| -n) },
            heights,
            wire: self.canvas.wire * fade,
        }
    }

    /// Draws a line of the boundary over what is there.
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

/// What a face looks like.
struct Brush {
    corners: [VertexId; 3],
    base: Colour,
    normals: [Vec3; 3],
    /// Distance of each corner from the opposite side, samples.
    heights: [f32; 3],
    wire: f32,
}

impl Brush {
    fn colour(&self, scene: &Scene, shares: Vec3) -> Colour {
        let mut colour = self.base;
        if let Paint::Checker { coordinates, size } = scene.paint {
            let [a, b, c] = self.corners.map(|v| coordinates[v.index()]);
            let at = (a * f64::from(shares.x) + b * f64::from(shares.y) + c * f64::from(shares.z)) / size;
            let odd = (at.x.floor() + at.y.floor()).rem_euclid(2.0) >= 1.0;
            colour = if odd { colours::CHECKER } else { colours::BACKGROUND };
        }
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

impl Band {
    fn new(top: usize, rows: usize, width: usize) -> Self {
        let count = rows * width;
        Self { top, rows, depth: vec![f32::NEG_INFINITY; count], colour: vec![colours::BACKGROUND; count] }
    }

    /// The band's pixels: means of their samples.
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
