//! Device state that lasts from frame to frame: pipelines, buffers, and a target per pane.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use eframe::wgpu;

use super::cache::{Cache, Key};
use super::frame::{PaneId, Sampling};
use super::overdraw::MostCovered;
use super::pipelines::{Pipelines, Target};
use super::plan::{Draw, Faces, Kind, LAYER_LIMIT, Layer, Plan, Planner, Shape, Textures};
use super::uniforms::{LineUniforms, PaneSize, PaneUniforms};
use crate::view::{PictureQuad, Revision};
use freebound_core::geom::Picture;

/// Stride of the uniforms of two lines in their buffer: the largest alignment that a device may require.
const LINE_STRIDE: u64 = 256;
/// Largest number of anisotropic samples.
const ANISOTROPY: u16 = 8;
/// Number of prepared panes after which a pane that was not among them is dropped.
const PANE_LIFETIME: u64 = 1000;

/// Work of the renderer since it was installed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Number of vertex buffers and pictures uploaded.
    pub uploads: u64,
    /// Bytes of these uploads.
    pub uploaded_bytes: u64,
    /// Number of pane pictures redrawn because their content had changed.
    pub drawn_panes: u64,
    /// Draw calls in these pictures.
    pub draw_calls: u64,
    /// Pixels of these pictures.
    pub pixels: u64,
}

/// Device state, stored among egui's callback resources.
pub(super) struct GpuResources {
    pipelines: Pipelines,
    cache: Cache,
    pictures: BTreeMap<Option<Revision>, wgpu::TextureView>,
    smooth: wgpu::Sampler,
    sharp: wgpu::Sampler,
    /// Sampler of tiles that repeat.
    tiled: wgpu::Sampler,
    panes: BTreeMap<PaneId, PaneState>,
    most_covered: MostCovered,
    tick: u64,
}

/// State of one pane that lasts from frame to frame.
struct PaneState {
    target: Target,
    uniforms: wgpu::Buffer,
    line_uniforms: wgpu::Buffer,
    line_group: wgpu::BindGroup,
    blit_group: wgpu::BindGroup,
    /// Plan of the picture in the target.
    shown: Option<Plan>,
    last_tick: u64,
}

impl GpuResources {
    pub(super) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        window_format: wgpu::TextureFormat,
        most_covered: MostCovered,
    ) -> Self {
        let sampler = |magnified, beyond| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("picture"),
                address_mode_u: beyond,
                address_mode_v: beyond,
                mag_filter: magnified,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                // Anisotropic sampling requires linear filters in every direction.
                anisotropy_clamp: if magnified == wgpu::FilterMode::Linear { ANISOTROPY } else { 1 },
                ..Default::default()
            })
        };
        // Placeholder for a missing picture.
        let clear = picture_view(device, queue, &[Arc::new(Picture::filled(1, 1, [0; 4]))]);
        Self {
            pipelines: Pipelines::new(device, window_format),
            cache: Cache::default(),
            pictures: BTreeMap::from([(None, clear)]),
            smooth: sampler(wgpu::FilterMode::Linear, wgpu::AddressMode::ClampToEdge),
            sharp: sampler(wgpu::FilterMode::Nearest, wgpu::AddressMode::ClampToEdge),
            tiled: sampler(wgpu::FilterMode::Linear, wgpu::AddressMode::Repeat),
            panes: BTreeMap::new(),
            most_covered,
            tick: 0,
        }
    }

    /// Most pixels that the faces of a pane may cover at full resolution.
    pub(super) fn most_covered(&self) -> MostCovered {
        self.most_covered
    }

    pub(super) fn stats(&self) -> Stats {
        self.cache.stats
    }

    /// Draws a pane into its target if its content has changed.
    pub(super) fn prepare(
        &mut self,
        io: &mut Io<'_>,
        BufferSlot { pane, size }: BufferSlot,
        textures: Textures<'_>,
        plan: impl FnOnce(&mut Planner<'_>) -> Plan,
    ) {
        let [width, height] = size.in_pixels;
        let limit = io.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            self.panes.remove(&pane);
            return;
        }
        let plan = plan(&mut Planner { device: io.device, cache: &mut self.cache, size });
        self.ensure_picture(io, textures.picture.map(|layer| &layer.picture));
        self.ensure_picture(io, textures.pattern);
        self.tick += 1;
        let tick = self.tick;
        if self.panes.get(&pane).is_none_or(|state| state.target.size != size.in_pixels) {
            self.panes.insert(pane, PaneState::new(io.device, &self.pipelines, size.in_pixels));
        }
        let state = self.panes.get_mut(&pane).expect("just put there");
        state.last_tick = tick;
        if state.shown.as_ref() != Some(&plan) {
            state.upload_uniforms(io.queue, &plan);
            let group = self.pane_group(io.device, &pane, &plan);
            let state = self.panes.get_mut(&pane).expect("just put there");
            let scene = Scene { pipelines: &self.pipelines, cache: &self.cache, group: &group };
            let draw_calls = scene.draw(io.encoder, state, &plan);
            self.cache.stats.drawn_panes += 1;
            self.cache.stats.draw_calls += draw_calls;
            self.cache.stats.pixels += u64::from(width) * u64::from(height);
            state.shown = Some(plan);
        }
        self.forget(tick);
    }

    /// Draws a pane's picture into egui's window.
    pub(super) fn paint(&self, pane: PaneId, pass: &mut wgpu::RenderPass<'static>) {
        let Some(state) = self.panes.get(&pane).filter(|state| state.shown.is_some()) else { return };
        pass.set_pipeline(&self.pipelines.blit);
        pass.set_bind_group(0, &state.blit_group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Uniforms and pictures of a pane for its shaders.
    fn pane_group(&self, device: &wgpu::Device, pane: &PaneId, plan: &Plan) -> wgpu::BindGroup {
        let state = &self.panes[pane];
        let view = |key| {
            let picture = self.pictures.get(&key).or_else(|| self.pictures.get(&None));
            wgpu::BindingResource::TextureView(picture.expect("the clear picture stays"))
        };
        let sampler = match plan.sampling {
            Sampling::Smooth => &self.smooth,
            Sampling::Sharp => &self.sharp,
        };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("pane"),
            layout: &self.pipelines.pane_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: state.uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: view(plan.picture) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(sampler) },
                wgpu::BindGroupEntry { binding: 3, resource: view(plan.pattern) },
                wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::Sampler(&self.tiled) },
            ],
        })
    }

    fn ensure_picture(&mut self, io: &Io<'_>, picture: Option<&Arc<PictureQuad>>) {
        let Some(picture) = picture else { return };
        let key = Some(picture.revision);
        if self.pictures.contains_key(&key) {
            return;
        }
        let sizes = picture.sizes_up_to(io.device.limits().max_texture_dimension_2d);
        self.cache.stats.uploads += 1;
        self.cache.stats.uploaded_bytes += sizes.iter().map(|picture| picture.pixels.len() as u64).sum::<u64>();
        self.pictures.insert(key, picture_view(io.device, io.queue, sizes));
    }

    /// Drops panes that are no longer prepared, and the buffers and pictures that no pane shows.
    fn forget(&mut self, tick: u64) {
        self.panes.retain(|_, state| tick - state.last_tick < PANE_LIFETIME);
        let shown = || self.panes.values().filter_map(|state| state.shown.as_ref());
        let used: BTreeSet<Key> = shown().flat_map(Plan::keys).collect();
        let pictures: BTreeSet<Revision> = shown().flat_map(|plan| [plan.picture, plan.pattern]).flatten().collect();
        self.cache.retain(&used);
        self.pictures.retain(|key, _| key.is_none_or(|revision| pictures.contains(&revision)));
    }
}

/// Objects that egui passes to a callback.
pub(super) struct Io<'a> {
    pub(super) device: &'a wgpu::Device,
    pub(super) queue: &'a wgpu::Queue,
    pub(super) encoder: &'a mut wgpu::CommandEncoder,
}

#[derive(Clone, Copy)]
pub(super) struct BufferSlot {
    pub(super) pane: PaneId,
    pub(super) size: PaneSize,
}

impl PaneState {
    fn new(device: &wgpu::Device, pipelines: &Pipelines, size: [u32; 2]) -> Self {
        let target = Target::new(device, size);
        let uniforms = uniform_buffer(device, size_of::<PaneUniforms>() as u64);
        let line_uniforms = uniform_buffer(device, LINE_STRIDE * LAYER_LIMIT as u64);
        let line_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("line"),
            layout: &pipelines.line_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &line_uniforms,
                    offset: 0,
                    size: std::num::NonZeroU64::new(size_of::<LineUniforms>() as u64),
                }),
            }],
        });
        let blit_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("blit"),
            layout: &pipelines.blit_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&target.picture) },
            ],
        });
        Self { target, uniforms, line_uniforms, line_group, blit_group, shown: None, last_tick: 0 }
    }

    fn upload_uniforms(&self, queue: &wgpu::Queue, plan: &Plan) {
        queue.write_buffer(&self.uniforms, 0, &plan.uniforms);
        for (place, layer) in (0..).zip(&plan.layers) {
            queue.write_buffer(&self.line_uniforms, place * LINE_STRIDE, &layer.uniforms);
        }
    }
}

/// Objects that the draw calls of a pane share.
struct Scene<'a> {
    pipelines: &'a Pipelines,
    cache: &'a Cache,
    group: &'a wgpu::BindGroup,
}

impl Scene<'_> {
    /// Records the pane's picture and returns the number of draw calls.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder, state: &PaneState, plan: &Plan) -> u64 {
        let [r, g, b, a] = plan.clear;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("freebound pane"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &state.target.samples,
                depth_slice: None,
                resolve_target: Some(&state.target.picture),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &state.target.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, self.group, &[]);
        let (faces, lines) = match plan.kind {
            Kind::Mesh => (&self.pipelines.mesh_faces, &self.pipelines.mesh_lines),
            Kind::Plane => (&self.pipelines.plane_faces, &self.pipelines.plane_lines),
        };
        let mut calls = 0;
        if plan.kind == Kind::Plane {
            pass.set_pipeline(&self.pipelines.plane_background);
            pass.draw(0..3, 0..1);
            calls += 1;
        }
        pass.set_pipeline(faces);
        for Faces { draw, opacity } in &plan.faces {
            if self.bind(&mut pass, draw) {
                pass.set_blend_constant(wgpu::Color { r: *opacity, g: *opacity, b: *opacity, a: 1.0 });
                pass.draw(0..draw.count, 0..1);
                calls += 1;
            }
        }
        for (Layer { shape, draw, .. }, offset) in plan.layers.iter().zip((0_u32..).step_by(256)) {
            if self.bind(&mut pass, draw) {
                let (pipeline, vertices, instances) = match shape {
                    Shape::Fill => (&self.pipelines.plane_fills, draw.count, 1),
                    Shape::Line => (lines, 6, draw.count),
                };
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, &state.line_group, &[offset]);
                pass.draw(0..vertices, 0..instances);
                calls += 1;
            }
        }
        calls
    }

    /// Binds the vertex buffers of a draw call. Returns false if one is missing.
    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw) -> bool {
        for (slot, &key) in (0..).zip(&draw.buffers) {
            let Some(buffer) = self.cache.get(key) else { return false };
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        true
    }
}

fn uniform_buffer(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("freebound uniforms"),
        size,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Texture with a picture in several sizes, each half the one before.
fn picture_view(device: &wgpu::Device, queue: &wgpu::Queue, sizes: &[Arc<Picture>]) -> wgpu::TextureView {
    let extent =
        |picture: &Picture| wgpu::Extent3d { width: picture.width, height: picture.height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: extent(&sizes[0]),
        mip_level_count: u32::try_from(sizes.len()).unwrap_or(1),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, picture) in (0..).zip(sizes) {
        let to = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * picture.width),
            rows_per_image: Some(picture.height),
        };
        queue.write_texture(to, &picture.pixels, layout, extent(picture));
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
