//! Pictures of meshes without a screen: a small z-buffer rasterizer.
//!
//! Light and shade are fixed: a key light from the upper left of the camera, a weaker one from the right, and a sky.
//! Triangles are drawn in horizontal bands, one per task, each band in file order: the picture does not depend on the
//! number of threads. Several samples per pixel are averaged.
//!
//! | file    | contents                                                               |
//! |---------|------------------------------------------------------------------------|
//! | `mod`   | view, canvas and paint; pictures of meshes and of embeddings           |
//! | `scene` | triangles in samples, drawn band by band into a z-buffer; light        |

mod scene;

use std::io::{self, Write};

use glam::{DVec2, DVec3};
use image::ImageEncoder as _;
use rayon::prelude::*;

use self::scene::{Scene, vertex_normals};
use freebound_core::geom::Picture;
use freebound_core::mesh::{EdgeTable, VertexId};
use freebound_core::problem::Embedding;

/// Colour without opacity, sRGB.
pub type Colour = [u8; 3];

/// Colours of the light theme.
pub mod colours {
    use super::Colour;

    /// Outer side of the surface.
    pub const CLAY: Colour = [0xd8, 0xd4, 0xcc];
    /// Inner side of the surface.
    pub const CLAY_BACK: Colour = [0xa9, 0xa3, 0x9a];
    /// Background.
    pub const BACKGROUND: Colour = [0xf4, 0xf4, 0xf2];
    /// Flipped face.
    pub const FLIPPED: Colour = [0xd9, 0x2d, 0x3a];
    /// Edges of faces.
    pub const WIRE: Colour = [0x6e, 0x6b, 0x66];
    /// Boundary loop.
    pub const BOUNDARY: Colour = [0x2c, 0x2b, 0x29];
    /// Dark fields of the checker.
    pub const CHECKER: Colour = [0x6f, 0x8f, 0xb8];
}

/// Relative length below which a sum of vectors counts as zero. Rounding leaves about 1e-13 for a million vectors; a
/// surface that faces some side leaves far more.
const CANCELLED: f64 = 1e-6;

/// Direction of view. The projection is parallel and fits the mesh into the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Direction from the mesh to the eye, of any length.
    pub eye: DVec3,
    /// Approximate upward direction of the picture.
    pub up: DVec3,
}

impl View {
    /// View from the front (+z), y up.
    pub const FRONT: Self = Self { eye: DVec3::Z, up: DVec3::Y };

    /// View rotated around y by an angle, radians: positive shows more of the +x side.
    pub fn turned(angle: f64) -> Self {
        Self { eye: DVec3::new(angle.sin(), 0.0, angle.cos()), up: DVec3::Y }
    }

    /// View from the side that most of a surface faces, given the area vectors of its faces. Up is y, or z if the eye
    /// is along y. View from the front if the vectors cancel out, as those of a closed surface do.
    pub fn facing(areas: impl IntoIterator<Item = DVec3>) -> Self {
        let add = |(sum, total): (DVec3, f64), area: DVec3| (sum + area, total + area.length());
        let (eye, total) = areas.into_iter().fold((DVec3::ZERO, 0.0), add);
        let is_side = eye.length() > CANCELLED * total;
        let is_steep = eye.cross(DVec3::Y).length() <= CANCELLED * eye.length();
        match (is_side, is_steep) {
            (false, _) => Self::FRONT,
            (true, false) => Self { eye, up: DVec3::Y },
            (true, true) => Self { eye, up: DVec3::Z },
        }
    }

    /// Coordinates of points in the axes of the view: right, up and towards the eye.
    pub(super) fn see(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let [right, up, towards] = self.axes();
        positions.par_iter().map(|p| DVec3::new(p.dot(right), p.dot(up), p.dot(towards))).collect()
    }

    /// Axes of the view: right, up and towards the eye; orthonormal for any input.
    fn axes(&self) -> [DVec3; 3] {
        let towards = self.eye.try_normalize().unwrap_or(DVec3::Z);
        let right = self.up.cross(towards).try_normalize().unwrap_or_else(|| towards.any_orthonormal_vector());
        [right, towards.cross(right), towards]
    }
}

/// Shading of faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RasterShading {
    /// By normals interpolated between the vertices.
    Smooth,
    /// By the normal of each face.
    Faceted,
    /// Without light.
    Unlit,
}

/// Size and style of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canvas {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples per pixel in each direction.
    pub samples: u32,
    /// Shading of faces.
    pub shading: RasterShading,
    /// Opacity of edges, from 0 (invisible) to 1.
    pub wire: f32,
}

impl Canvas {
    /// Lit clay without edges, 2 × 2 samples per pixel.
    pub const fn clay(width: u32, height: u32) -> Self {
        Self { width, height, samples: 2, shading: RasterShading::Smooth, wire: 0.0 }
    }

    /// Unlit faces with thin edges, 2 × 2 samples per pixel.
    pub const fn drawing(width: u32, height: u32) -> Self {
        Self { width, height, samples: 2, shading: RasterShading::Unlit, wire: 0.6 }
    }
}

/// Colour of the faces.
#[derive(Clone, Copy, Debug)]
pub enum RasterPaint<'a> {
    /// Clay, with its own tone for faces seen from behind.
    Clay,
    /// Colour of each face.
    Faces(&'a [Colour]),
    /// Checker in coordinates given per vertex.
    Checker {
        /// Coordinates, one per vertex.
        coordinates: &'a Embedding,
        /// Width of a field.
        size: f64,
    },
    /// Picture at texture coordinates given per vertex, v up; beyond its edges the nearest colour.
    Picture {
        /// Texture coordinates, one per vertex.
        coordinates: &'a Embedding,
        /// Picture to show.
        picture: &'a Picture,
    },
}

/// Picture of a mesh in space.
pub fn mesh_picture(
    positions: &[DVec3],
    triangles: &[[VertexId; 3]],
    view: &View,
    canvas: &Canvas,
    paint: RasterPaint,
) -> Picture {
    let seen = view.see(positions);
    let normals = vertex_normals(&seen, triangles);
    let scene = Scene::new(&seen, triangles, canvas, paint, &normals);
    scene.picture(&[])
}

/// Positions of points of a mesh in [`mesh_picture`]: fractions of its width and height, from its lower left corner.
pub fn mesh_places(positions: &[DVec3], view: &View, canvas: &Canvas) -> Vec<DVec2> {
    let seen = view.see(positions);
    let samples = f64::from(canvas.samples.max(1));
    let size = DVec2::new(f64::from(canvas.width), f64::from(canvas.height)) * samples;
    let scene = Scene::new(&seen, &[], canvas, RasterPaint::Clay, &[]);
    let place = |point: &glam::Vec3| {
        let share = point.as_dvec3().truncate() / size;
        DVec2::new(share.x, 1.0 - share.y)
    };
    scene.points.iter().map(place).collect()
}

/// Picture of an embedding: thin edges, the boundary as a darker line. The caller paints the faces that its verdict
/// lists as flipped.
pub fn plane_picture(
    embedding: &Embedding,
    triangles: &[[VertexId; 3]],
    canvas: &Canvas,
    paint: RasterPaint,
) -> Picture {
    let seen: Vec<DVec3> = embedding.iter().map(|p| p.extend(0.0)).collect();
    let table = EdgeTable::new(embedding.len(), triangles);
    let outer = |sides: &[u32]| (sides.len() == 1).then(|| sides[0] as usize);
    let boundary: Vec<[VertexId; 2]> =
        table.edges().filter_map(outer).map(|s| [triangles[s / 3][s % 3], triangles[s / 3][(s + 1) % 3]]).collect();
    let scene = Scene::new(&seen, triangles, canvas, paint, &[]);
    scene.picture(&boundary)
}

/// Writes a picture as a PNG.
///
/// # Errors
///
/// If `writer` or the encoder fails.
pub fn write_png(picture: &Picture, writer: impl Write) -> io::Result<()> {
    let encoder = image::codecs::png::PngEncoder::new(writer);
    let Picture { width, height, pixels } = picture;
    let written = encoder.write_image(pixels, *width, *height, image::ExtendedColorType::Rgba8);
    written.map_err(io::Error::other)
}
