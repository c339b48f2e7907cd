//! Uniforms that change every frame, in the layout of the shaders. This file needs no GPU.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, Vec3};

use super::frame::{FaceShading, MeshFrame, Normals, PictureLayer, PlaneFrame, Style};
use crate::view::{OrbitCamera, Palette, PlaneCamera, Sphere, Srgb, UnitPlane};
use freebound_core::geom::Bounds;

/// Bound of pixel coordinates. Points beyond it are far outside any pane, and their digits do not matter.
const FAR_PIXEL: f64 = 1e7;
/// Spacing in points at which grid lines start to fade in, and at which they show in full.
const GRID_FADE: [f64; 2] = [16.0, 45.0];

/// Checks along the side of a tile of a pattern. The plain checker repeats after two.
const CHECKS_PER_TILE: f64 = 8.0;

/// Matches `Pane` of shaders/common.wgsl, field by field.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct PaneUniforms {
    clip_from_unit: [[f32; 4]; 4],
    right: [f32; 4],
    up: [f32; 4],
    back: [f32; 4],
    eye: [f32; 4],
    plane_center: [f32; 4],
    plane_scale: [f32; 4],
    checker: [f32; 4],
    picture: [f32; 4],
    grid: [f32; 4],
    unit_square: [f32; 4],
    picture_box: [f32; 4],
    strength: [f32; 4],
    choice: [u32; 4],
    colours: [[f32; 4]; 12],
}

/// Matches `Line` of shaders/lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct LineUniforms {
    colour: [f32; 4],
    shape: [f32; 4],
}

impl LineUniforms {
    /// Line with a width in points. In 3D it is lifted towards the eye by a share of its distance.
    pub(super) fn new(colour: Srgb, width_in_points: f32, pixels_per_point: f32, lift: f32) -> Self {
        let half_width = 0.5 * width_in_points * pixels_per_point;
        Self { colour: colour.to_linear(), shape: [half_width, lift, 0.0, 0.0] }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PaneSize {
    pub(super) in_pixels: [u32; 2],
    pub(super) pixels_per_point: f32,
}

impl PaneSize {
    fn in_points(self) -> DVec2 {
        self.pixels() / f64::from(self.pixels_per_point)
    }

    fn pixels(self) -> DVec2 {
        let [width, height] = self.in_pixels;
        DVec2::new(f64::from(width), f64::from(height))
    }
}

impl PaneUniforms {
    pub(super) fn of_mesh(frame: &MeshFrame, size: PaneSize) -> Self {
        let mut uniforms = Self::common(&frame.style, &frame.palette, size);
        uniforms.set_orbit(&frame.camera, frame.mesh.frame, size);
        if let Some(plane) = &frame.plane {
            let origin = plane.frame.center;
            uniforms.set_checker(plane.frame, origin, frame.style.check_size);
            if let Some(layer) = &frame.picture {
                uniforms.set_picture(plane.frame, origin, layer);
            }
        }
        // Without coordinates, or without a picture, there is nothing to map to the mesh.
        let shading = match frame.style.shading {
            FaceShading::Checker | FaceShading::Picture | FaceShading::Pattern if frame.plane.is_none() => {
                FaceShading::Plain
            }
            FaceShading::Picture if frame.picture.is_none() => FaceShading::Plain,
            FaceShading::Pattern if frame.pattern.is_none() => FaceShading::Checker,
            shading => shading,
        };
        uniforms.choice[0] = shading as u32;
        uniforms
    }

    pub(super) fn of_plane(frame: &PlaneFrame, size: PaneSize) -> Self {
        let mut uniforms = Self::common(&frame.style, &frame.palette, size);
        let unit = frame.plane.as_ref().map_or_else(|| UnitPlane::of(Bounds::UNIT), |plane| plane.frame);
        let center = frame.camera.center();
        let (unit_center, scale) = frame.camera.unit_view(unit, size.in_points());
        uniforms.plane_center = crate::view::split_point(unit_center);
        uniforms.plane_scale[..2].copy_from_slice(&scale.as_vec2().to_array());
        uniforms.set_checker(unit, center, frame.style.check_size);
        uniforms.set_grid(&frame.camera, size);
        uniforms.unit_square = pixel_box(frame.outlined, &frame.camera, size);
        if let Some(layer) = &frame.picture {
            uniforms.set_picture(unit, center, layer);
            uniforms.picture_box = pixel_box(layer.bounds, &frame.camera, size);
            uniforms.strength[1] = layer.opacity.clamp(0.0, 1.0);
        } else if frame.style.shading == FaceShading::Picture {
            uniforms.choice[0] = FaceShading::Plain as u32;
        }
        if frame.pattern.is_none() && frame.style.shading == FaceShading::Pattern {
            uniforms.choice[0] = FaceShading::Checker as u32;
        }
        uniforms
    }

    fn common(style: &Style, palette: &Palette, size: PaneSize) -> Self {
        let [width, height] = size.pixels().as_vec2().to_array();
        let half_wire = 0.5 * style.wire_in_points * size.pixels_per_point;
        let mut uniforms = Self {
            right: [1.0, 0.0, 0.0, size.pixels_per_point],
            plane_scale: [1.0, 1.0, width, height],
            choice: [style.shading as u32, u32::from(style.normals == Normals::Flat), 0, 0],
            colours: colours(palette),
            ..Self::zeroed()
        };
        uniforms.strength[2] = half_wire;
        if style.wire_in_points <= 0.0 {
            uniforms.colours[WIRE][3] = 0.0;
        }
        uniforms
    }

    fn set_orbit(&mut self, camera: &OrbitCamera, frame: Sphere, size: PaneSize) {
        self.clip_from_unit = camera.clip_from_unit(frame, size.in_points()).to_cols_array_2d();
        // Unit space is the world moved and scaled, so directions are equal.
        let axis = |k: usize| camera.view_from_world().row(k).truncate().as_vec3();
        self.right = with(axis(0), self.right[3]);
        self.up = with(axis(1), 0.0);
        self.back = with(axis(2), 0.0);
        self.eye = with(frame.unit_from_world(camera.eye()), 1.0);
    }

    /// Sets the checker, counted from the embedding's origin. The fraction is computed in f64, about the pane's
    /// middle.
    fn set_checker(&mut self, unit: UnitPlane, origin: DVec2, check_size: f64) {
        let size = if check_size.is_normal() && check_size > 0.0 { check_size } else { 1.0 };
        let offset = (origin / size).rem_euclid(DVec2::splat(CHECKS_PER_TILE)).as_vec2();
        self.checker = [single(unit.embedding_per_unit / size), offset.x, offset.y, 0.0];
    }

    fn set_picture(&mut self, unit: UnitPlane, origin: DVec2, layer: &PictureLayer) {
        // The picture's rows run downwards.
        let size = layer.bounds.size() * DVec2::new(1.0, -1.0);
        let corner = DVec2::new(layer.bounds.low.x, layer.bounds.high.y);
        let scale = (DVec2::splat(unit.embedding_per_unit) / size).as_vec2();
        let offset = ((origin - corner) / size).as_vec2();
        self.picture = [scale.x, scale.y, offset.x, offset.y];
    }

    fn set_grid(&mut self, camera: &PlaneCamera, size: PaneSize) {
        let grid = camera.grid();
        let per_major = f64::from(grid.steps_per_major);
        let offset = (camera.center() / grid.step).rem_euclid(DVec2::splat(per_major)).as_vec2();
        let spacing = camera.points_per_unit() * grid.step;
        let cells_per_pixel = 1.0 / (spacing * f64::from(size.pixels_per_point));
        self.grid = [single(cells_per_pixel), offset.x, offset.y, single(per_major)];
        let [none, full] = GRID_FADE;
        self.strength[0] = single(((spacing - none) / (full - none)).clamp(0.0, 1.0));
    }
}

/// Index of the wireframe's colour in [`colours`].
const WIRE: usize = 9;

/// Colours in the order of the fields of `Pane`.
fn colours(palette: &Palette) -> [[f32; 4]; 12] {
    [
        palette.background,
        palette.grid,
        palette.unit_square,
        palette.clay,
        palette.clay_back,
        palette.plane_face,
        palette.overlap,
        palette.checker[0],
        palette.checker[1],
        palette.wire,
        palette.wire_light,
        palette.flipped,
    ]
    .map(Srgb::to_linear)
}

/// Left, top, right and bottom of a box of the plane, pixels of the pane.
fn pixel_box(bounds: Bounds, camera: &PlaneCamera, size: PaneSize) -> [f32; 4] {
    let corners = [DVec2::new(bounds.low.x, bounds.high.y), DVec2::new(bounds.high.x, bounds.low.y)];
    let [a, b] = corners.map(|corner| {
        let pixel = camera.pane_from_embedding(corner, size.in_points()) * f64::from(size.pixels_per_point);
        pixel.clamp(DVec2::splat(-FAR_PIXEL), DVec2::splat(FAR_PIXEL)).as_vec2()
    });
    [a.x, a.y, b.x, b.y]
}

fn with(v: Vec3, fourth: f32) -> [f32; 4] {
    v.extend(fourth).to_array()
}

/// Converts a number to f32 for shaders.
fn single(value: f64) -> f32 {
    DVec2::splat(value).as_vec2().x
}

#[cfg(test)]
mod tests {
    use eframe::wgpu::naga;

    use super::*;
    use crate::render::SHADERS;

    /// Size of a structure, from the shader that declares it.
    fn size_in_shader(name: &str) -> usize {
        let sizes = SHADERS.iter().flat_map(|shader| {
            let module = naga::front::wgsl::parse_str(shader.source).expect("valid, as another test shows");
            let size = |ty: &naga::Type| match ty.inner {
                naga::TypeInner::Struct { span, .. } if ty.name.as_deref() == Some(name) => Some(span as usize),
                _ => None,
            };
            module.types.iter().filter_map(|(_, ty)| size(ty)).collect::<Vec<_>>()
        });
        sizes.max().expect("some shader has it")
    }

    #[test]
    fn the_shaders_structures_are_as_large_as_ours() {
        assert_eq!(size_of::<PaneUniforms>(), size_in_shader("Pane"));
        assert_eq!(size_of::<LineUniforms>(), size_in_shader("Line"));
    }
}
