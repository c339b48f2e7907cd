//! Picture of one layout, drawn anew for another layout of the surface.
//!
//! Every pixel of the new picture shows the point of the surface that the new layout has there. Its colour is that of
//! the old picture at the nearest point of the old surface. Charts are drawn beyond their edges by a margin, so that
//! filters and smaller sizes of the picture mix no background into them.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixel numbers and colours come from floats that were cut to their range before"
)]

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;

use super::Registration;
use freebound_core::geom::{Bounds, Picture, double_area};
use freebound_core::mesh::{FaceId, point_at};
use freebound_core::pipeline::{LayoutSurface, SurfaceSearch};
use freebound_core::problem::{Control, SolveError};

/// Samples of a pixel in each direction.
const SAMPLES: usize = 2;

/// Rows of pixels that one task draws.
const ROWS: usize = 16;

/// Distance of two surfaces from which they lie apart, relative to the diagonal of their box.
pub(crate) const FAR_APART: f64 = 0.05;

/// Size and margin of a baked picture, and the place of the surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BakeOptions {
    /// Width and height, pixels.
    pub pixels: [u32; 2],
    /// Margin around the charts, pixels.
    pub margin: u32,
    /// Place of the old surface beside the new one.
    pub registration: Registration,
}

impl BakeOptions {
    /// Usual margin, pixels.
    pub const DEFAULT_MARGIN: u32 = 8;

    /// Longest side of a baked picture, pixels.
    pub const LONGEST_SIDE: u32 = 1 << 14;

    /// Size of a picture, reduced so that no side is longer than [`LONGEST_SIDE`](Self::LONGEST_SIDE).
    pub fn size_for(picture: &Picture) -> [u32; 2] {
        let sides = [picture.width, picture.height].map(u64::from);
        let [longest, limit] = [sides[0].max(sides[1]), u64::from(Self::LONGEST_SIDE)];
        sides.map(|side| if longest > limit { (side * limit / longest).max(1) as u32 } else { side as u32 })
    }
}

/// Surface with the picture that its layout shows.
#[derive(Clone, Copy, Debug)]
pub struct PaintedSurface<'a> {
    /// Surface with its layout.
    pub layout: LayoutSurface<'a>,
    /// Picture of the layout. It repeats beyond the unit square.
    pub picture: &'a Picture,
}

/// Picture that was drawn for another layout.
#[derive(Clone, Debug)]
pub struct BakedPicture {
    /// Picture. Pixels outside the charts and their margin are transparent.
    pub picture: Picture,
    /// Summary of the drawing.
    pub report: BakeReport,
}

/// Summary of a baked picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BakeReport {
    /// Share of the pixels that charts cover, without their margin.
    pub covered: f64,
    /// Triangles that lie outside the unit square, at least in part: the picture does not show all of them.
    pub outside: usize,
    /// Largest distance of a drawn point to the old surface, mesh units.
    pub largest_distance: f64,
    /// Diagonal of the box around the old surface, mesh units.
    pub diagonal: f64,
}

impl BakeReport {
    /// True if some point of the new surface is farther from the old one than 5 % of the diagonal.
    pub fn is_apart(&self) -> bool {
        self.largest_distance > FAR_APART * self.diagonal
    }
}

/// Draws the picture of an old layout for a new layout of the surface, by nearest points.
///
/// If charts of the new layout overlap, the face with the lowest number is seen.
///
/// # Errors
///
/// [`SolveError::Cancelled`] if the caller cancels.
pub fn bake(
    old: PaintedSurface<'_>,
    new: LayoutSurface<'_>,
    options: BakeOptions,
    control: Control<'_>,
) -> Result<BakedPicture, SolveError> {
    let used = new.mesh.triangles.iter().flatten().map(|vertex| new.mesh.positions[vertex.index()]);
    let surface = options.registration.applied(old.layout.mesh, used);
    let search = SurfaceSearch::new(&surface);
    control.go_on()?;
    let [width, height] = options.pixels.map(|pixels| pixels as usize);
    let sense = search.sense(new.mesh.face_count(), |face| {
        let face = FaceId::from_index(face);
        (point_at(new.mesh.corners(face), [1.0 / 3.0; 3]), new.mesh.double_area_vector(face))
    });
    let drawing = Drawing { old, new, search, sense, width, height };
    let triangles_of_bands = drawing.triangles_of_bands();
    let bands: Vec<Band> = triangles_of_bands
        .par_iter()
        .enumerate()
        .map(|(band, triangles)| control.go_on().map(|()| drawing.band(band, triangles)))
        .collect::<Result<_, _>>()?;
    let largest_distance = bands.iter().map(|band| band.largest_squared).fold(0.0, f64::max).sqrt();
    let colours: Vec<Option<[u8; 4]>> = bands.into_iter().flat_map(|band| band.colours).collect();
    let covered = colours.iter().flatten().count() as f64 / colours.len().max(1) as f64;
    let report = BakeReport {
        covered,
        outside: drawing.triangles().filter(|&triangle| !drawing.is_inside(triangle)).count(),
        largest_distance,
        diagonal: drawing.search.diagonal(),
    };
    let colours = with_margin(colours, [width, height], options.margin, control)?;
    let pixels = colours.into_iter().flat_map(Option::unwrap_or_default).collect();
    let [width, height] = options.pixels;
    Ok(BakedPicture { picture: Picture { width, height, pixels }, report })
}

/// Surfaces and pictures of a bake.
struct Drawing<'a> {
    old: PaintedSurface<'a>,
    new: LayoutSurface<'a>,
    search: SurfaceSearch<'a>,
    /// -1 if the new surface is the old one inside out, else 1.
    sense: f64,
    width: usize,
    height: usize,
}

/// Rows of pixels.
struct Band {
    /// Colour of each pixel. `None` outside the charts.
    colours: Vec<Option<[u8; 4]>>,
    /// Largest squared distance of a drawn point to the old surface.
    largest_squared: f64,
}

/// Sums over the samples of a pixel.
#[derive(Clone, Copy, Default)]
struct Samples {
    sum: [u32; 4],
    count: u32,
    /// Samples that a triangle covers, one bit each.
    taken: u32,
}

impl Drawing<'_> {
    fn triangles(&self) -> impl Iterator<Item = u32> {
        (0..).take(self.new.mesh.face_count())
    }

    /// Corners of a triangle in the picture, pixels from its top left.
    fn in_picture(&self, triangle: u32) -> [DVec2; 3] {
        let size = DVec2::new(self.width as f64, self.height as f64);
        self.new.mesh.triangles[triangle as usize].map(|vertex| {
            let uv = self.new.coordinates[vertex];
            DVec2::new(uv.x, 1.0 - uv.y) * size
        })
    }

    fn is_inside(&self, triangle: u32) -> bool {
        let corners = self.new.mesh.triangles[triangle as usize].map(|vertex| self.new.coordinates[vertex]);
        corners.iter().all(|uv| uv.cmpge(DVec2::ZERO).all() && uv.cmple(DVec2::ONE).all())
    }

    /// Triangles that may cover samples of each band, ascending.
    fn triangles_of_bands(&self) -> Vec<Vec<u32>> {
        let mut bands = vec![Vec::new(); self.height.div_ceil(ROWS)];
        for triangle in self.triangles() {
            let bounds = Bounds::of(self.in_picture(triangle));
            if !(bounds.low.is_finite() && bounds.high.is_finite()) || bounds.high.y < 0.0 {
                continue;
            }
            let [first, last] = [bounds.low.y, bounds.high.y].map(|y| y.max(0.0) as usize / ROWS);
            if let Some(bands) = bands.get_mut(first..=last.min(self.height.div_ceil(ROWS).saturating_sub(1))) {
                for band in bands {
                    band.push(triangle);
                }
            }
        }
        bands
    }

    fn band(&self, band: usize, triangles: &[u32]) -> Band {
        let first = band * ROWS;
        let rows = ROWS.min(self.height - first);
        let mut pixels = vec![Samples::default(); rows * self.width];
        let (mut near, mut largest_squared) = (None, 0.0_f64);
        for &triangle in triangles {
            let surface = self.new.mesh.corners(FaceId::new(triangle));
            let direction = self.sense * self.new.mesh.double_area_vector(FaceId::new(triangle));
            for (sample, weights) in self.samples(triangle, first..first + rows) {
                let pixel = &mut pixels[sample.pixel - first * self.width];
                if pixel.taken & sample.bit != 0 {
                    continue;
                }
                pixel.taken |= sample.bit;
                let point: DVec3 = point_at(surface, weights);
                let Some(found) = self.search.nearest(point, direction, near) else { continue };
                (near, largest_squared) = (Some(found.triangle), largest_squared.max(found.distance_squared));
                let colour = self.colour(found.triangle, found.weights);
                pixel.sum.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += u32::from(channel));
                pixel.count += 1;
            }
        }
        let mean = |samples: Samples| {
            let rounded = |sum: u32| ((sum + samples.count / 2) / samples.count) as u8;
            (samples.count > 0).then(|| samples.sum.map(rounded))
        };
        Band { colours: pixels.into_iter().map(mean).collect(), largest_squared }
    }

    /// Samples of some rows of pixels that a triangle covers, with the barycentric weights of its corners.
    fn samples(
        &self,
        triangle: u32,
        rows: std::ops::Range<usize>,
    ) -> impl Iterator<Item = (Sample, [f64; 3])> + use<'_> {
        let corners @ [a, b, c] = self.in_picture(triangle);
        let bounds = Bounds::of(corners);
        let scale = SAMPLES as f64;
        // Samples lie at the centres of the cells of a grid.
        let from = |low: f64, least: usize| ((low * scale - 0.5).ceil().max(0.0) as usize).max(least);
        let until = |high: f64, most: usize| ((high * scale - 0.5).floor().max(-1.0) + 1.0).min(most as f64) as usize;
        let x_range = from(bounds.low.x, 0)..until(bounds.high.x, self.width * SAMPLES);
        let y_range = from(bounds.low.y, rows.start * SAMPLES)..until(bounds.high.y, rows.end * SAMPLES);
        let area = double_area(corners);
        let width = self.width;
        y_range.flat_map(move |y| x_range.clone().map(move |x| [x, y])).filter_map(move |[x, y]| {
            let at = (DVec2::new(x as f64, y as f64) + 0.5) / scale;
            let weights = [[at, b, c], [a, at, c], [a, b, at]].map(|part| double_area(part) / area);
            let pixel = y / SAMPLES * width + x / SAMPLES;
            let bit = 1 << (y % SAMPLES * SAMPLES + x % SAMPLES);
            weights.iter().all(|&weight| weight >= 0.0).then_some((Sample { pixel, bit }, weights))
        })
    }

    /// Colour of the old picture at a point of the old surface.
    fn colour(&self, triangle: u32, weights: [f64; 3]) -> [u8; 4] {
        let uv = self.old.layout.at(triangle, weights);
        let is_inside = uv.cmpge(DVec2::ZERO).all() && uv.cmple(DVec2::ONE).all();
        self.old.picture.sample_with_opacity(if is_inside { uv } else { uv - uv.floor() })
    }
}

/// Sample of a pixel.
struct Sample {
    /// Pixel in the picture, row by row from the top.
    pixel: usize,
    /// Bit of the sample.
    bit: u32,
}

/// Grows the coloured pixels by a margin. Every round colours the neighbours of coloured pixels with their mean.
fn with_margin(
    mut colours: Vec<Option<[u8; 4]>>,
    [width, height]: [usize; 2],
    margin: u32,
    control: Control<'_>,
) -> Result<Vec<Option<[u8; 4]>>, SolveError> {
    let neighbours = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
    };
    let is_at_edge =
        |&pixel: &usize| colours[pixel].is_some() && neighbours(pixel).any(|other| colours[other].is_none());
    let mut newest: Vec<usize> = if margin > 0 { (0..colours.len()).filter(is_at_edge).collect() } else { Vec::new() };
    for _ in 0..margin {
        control.go_on()?;
        if newest.is_empty() {
            break;
        }
        let mut next: Vec<usize> =
            newest.iter().flat_map(|&pixel| neighbours(pixel)).filter(|&pixel| colours[pixel].is_none()).collect();
        next.sort_unstable();
        next.dedup();
        let mean = |pixel: usize| {
            let around: Vec<[u8; 4]> = neighbours(pixel).filter_map(|other| colours[other]).collect();
            let count = around.len() as u32;
            std::array::from_fn(|channel| {
                let sum: u32 = around.iter().map(|colour| u32::from(colour[channel])).sum();
                ((sum + count / 2) / count) as u8
            })
        };
        let grown: Vec<[u8; 4]> = next.iter().map(|&pixel| mean(pixel)).collect();
        for (&pixel, colour) in next.iter().zip(grown) {
            colours[pixel] = Some(colour);
        }
        newest = next;
    }
    Ok(colours)
}
