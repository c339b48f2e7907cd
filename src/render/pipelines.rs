//! Render pipelines: shader, vertex buffers, blending and depth of each. Also the textures that they draw a pane
//! into: colour and depth with four samples per pixel, and the picture that these resolve to.

use eframe::wgpu;
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction};

use super::plan::{MESH_LINE_STRIDE, PLANE_LINE_STRIDE, PLANE_POINT_STRIDE};
use super::uniforms::{LineUniforms, PaneUniforms};

/// Samples per pixel. Every driver offers four.
const SAMPLES: u32 = 4;
/// Linear light, stored with the sRGB curve.
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Shader with its shared parts in front.
#[derive(Clone, Copy, Debug)]
pub struct ShaderFile {
    /// File in `shaders/`.
    pub name: &'static str,
    /// Full source text.
    pub source: &'static str,
}

macro_rules! shader {
    ($($file:literal),+) => {
        ShaderFile {
            name: [$($file),+][[$($file),+].len() - 1],
            source: concat!($(include_str!(concat!("../../shaders/", $file)), "\n"),+),
        }
    };
}

const MESH: ShaderFile = shader!("common.wgsl", "faces.wgsl", "mesh.wgsl");
const PLANE: ShaderFile = shader!("common.wgsl", "faces.wgsl", "plane.wgsl");
const BACKGROUND: ShaderFile = shader!("common.wgsl", "background.wgsl");
const LINES: ShaderFile = shader!("common.wgsl", "lines.wgsl");
const BLIT: ShaderFile = shader!("common.wgsl", "blit.wgsl");

/// All shaders, for tests that read them without a GPU.
pub const SHADERS: [ShaderFile; 5] = [MESH, PLANE, BACKGROUND, LINES, BLIT];

/// Objects created once per device.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub(super) pane_layout: wgpu::BindGroupLayout,
    pub(super) line_layout: wgpu::BindGroupLayout,
    pub(super) blit_layout: wgpu::BindGroupLayout,
    pub(super) mesh_faces: wgpu::RenderPipeline,
    pub(super) mesh_lines: wgpu::RenderPipeline,
    pub(super) plane_background: wgpu::RenderPipeline,
    pub(super) plane_faces: wgpu::RenderPipeline,
    pub(super) plane_fills: wgpu::RenderPipeline,
    pub(super) plane_lines: wgpu::RenderPipeline,
    pub(super) blit: wgpu::RenderPipeline,
}

impl Pipelines {
    pub(super) fn new(device: &wgpu::Device, window_format: wgpu::TextureFormat) -> Self {
        let [pane_layout, line_layout, blit_layout] = layouts(device);
        let blit_entry = if window_format.is_srgb() { "fs_linear" } else { "fs_gamma" };
        let pane: Layouts<'_> = &[Some(&pane_layout)];
        let lines: Layouts<'_> = &[Some(&pane_layout), Some(&line_layout)];
        let pipeline = |recipe: &Recipe<'_>| recipe.build(device);
        Self {
            mesh_faces: pipeline(&Recipe { buffers: &MESH_BUFFERS, ..Recipe::faces(MESH, "fs_shaded", pane) }),
            plane_faces: pipeline(&Recipe {
                buffers: &PLANE_BUFFERS,
                blend: Some(COUNTING),
                writes: ColorWrites::ALL,
                ..Recipe::faces(PLANE, "fs_flat", pane)
            }),
            plane_background: pipeline(&Recipe {
                depth: Some((CompareFunction::Always, false)),
                ..Recipe::faces(BACKGROUND, "fs_background", pane)
            }),
            mesh_lines: pipeline(&Recipe {
                vertex_entry: "vs_mesh",
                buffers: &MESH_LINE_BUFFERS,
                ..Recipe::lines(lines)
            }),
            plane_fills: pipeline(&Recipe {
                vertex_entry: "vs_fill",
                fragment_entry: "fs_fill",
                buffers: &PLANE_FILL_BUFFERS,
                ..Recipe::lines(lines)
            }),
            plane_lines: pipeline(&Recipe {
                vertex_entry: "vs_plane",
                buffers: &PLANE_LINE_BUFFERS,
                depth: Some((CompareFunction::Always, false)),
                ..Recipe::lines(lines)
            }),
            blit: pipeline(&Recipe {
                depth: None,
                samples: 1,
                format: window_format,
                writes: ColorWrites::ALL,
                ..Recipe::faces(BLIT, blit_entry, &[Some(&blit_layout)])
            }),
            pane_layout,
            line_layout,
            blit_layout,
        }
    }
}

/// Colour covers by the share in the pass's blend constant; alpha counts the faces that lie over each other.
const COUNTING: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::Constant,
        dst_factor: BlendFactor::OneMinusConstant,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
};

type Layouts<'a> = &'a [Option<&'a wgpu::BindGroupLayout>];

type Buffer = Option<wgpu::VertexBufferLayout<'static>>;

#[expect(clippy::unnecessary_wraps, reason = "a pipeline's descriptor takes options")]
const fn buffer(
    array_stride: u64,
    step_mode: wgpu::VertexStepMode,
    attributes: &'static [wgpu::VertexAttribute],
) -> Buffer {
    Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
}

const PER_VERTEX: wgpu::VertexStepMode = wgpu::VertexStepMode::Vertex;
const PER_LINE: wgpu::VertexStepMode = wgpu::VertexStepMode::Instance;

/// `MeshArrays::corner_positions`, `corner_normals`, `PlaneArrays::corners`, `FacePaint::corners`.
static MESH_BUFFERS: [Buffer; 4] = [
    buffer(12, PER_VERTEX, &wgpu::vertex_attr_array![0 => Float32x3]),
    buffer(8, PER_VERTEX, &wgpu::vertex_attr_array![1 => Snorm16x4]),
    buffer(16, PER_VERTEX, &wgpu::vertex_attr_array![2 => Float32x4]),
    buffer(4, PER_VERTEX, &wgpu::vertex_attr_array![3 => Unorm8x4]),
];
/// `PlaneArrays::corners`, `FacePaint::corners`.
static PLANE_BUFFERS: [Buffer; 2] = [
    buffer(16, PER_VERTEX, &wgpu::vertex_attr_array![0 => Float32x4]),
    buffer(4, PER_VERTEX, &wgpu::vertex_attr_array![1 => Unorm8x4]),
];
/// `DrawnFaces` in an embedding, corner by corner.
static PLANE_FILL_BUFFERS: [Buffer; 1] =
    [buffer(PLANE_POINT_STRIDE, PER_VERTEX, &wgpu::vertex_attr_array![0 => Float32x4])];
/// Two points in unit space.
static MESH_LINE_BUFFERS: [Buffer; 1] =
    [buffer(MESH_LINE_STRIDE, PER_LINE, &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3])];
/// Two split points.
static PLANE_LINE_BUFFERS: [Buffer; 1] =
    [buffer(PLANE_LINE_STRIDE, PER_LINE, &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4])];

/// Settings that differ between pipelines.
struct Recipe<'a> {
    shader: ShaderFile,
    vertex_entry: &'static str,
    fragment_entry: &'static str,
    layouts: Layouts<'a>,
    buffers: &'a [Buffer],
    blend: Option<BlendState>,
    writes: ColorWrites,
    /// Depth comparison, and true if depth is written.
    depth: Option<(CompareFunction, bool)>,
    samples: u32,
    format: wgpu::TextureFormat,
}

impl<'a> Recipe<'a> {
    fn faces(shader: ShaderFile, fragment_entry: &'static str, layouts: Layouts<'a>) -> Self {
        Self {
            shader,
            vertex_entry: "vs_main",
            fragment_entry,
            layouts,
            buffers: &[],
            blend: None,
            writes: ColorWrites::COLOR,
            depth: Some((CompareFunction::LessEqual, true)),
            samples: SAMPLES,
            format: COLOUR,
        }
    }

    fn lines(layouts: Layouts<'a>) -> Self {
        Self {
            blend: Some(BlendState::ALPHA_BLENDING),
            depth: Some((CompareFunction::LessEqual, false)),
            ..Self::faces(LINES, "fs_line", layouts)
        }
    }

    fn build(&self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.shader.name),
            source: wgpu::ShaderSource::Wgsl(self.shader.source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.shader.name),
            bind_group_layouts: self.layouts,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.shader.name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.vertex_entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: self.depth.map(|(compare, write)| wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(write),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.fragment_entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.format,
                    blend: self.blend,
                    write_mask: self.writes,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Bind group layouts of a pane, of a layer, and of the picture that goes to the window.
fn layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 3] {
    use wgpu::{BindingType, ShaderStages};
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    // One buffer holds the uniforms of all layers; a dynamic offset selects one.
    let uniforms = |size: usize, has_dynamic_offset: bool| BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset,
        min_binding_size: std::num::NonZeroU64::new(size as u64),
    };
    let pane = entry(0, ShaderStages::VERTEX_FRAGMENT, uniforms(size_of::<PaneUniforms>(), false));
    let line = entry(0, ShaderStages::VERTEX_FRAGMENT, uniforms(size_of::<LineUniforms>(), true));
    let texture = BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let [pattern, tiled] = [(3, texture), (4, sampler)].map(|(at, ty)| entry(at, ShaderStages::FRAGMENT, ty));
    let texture = entry(1, ShaderStages::FRAGMENT, texture);
    let sampler = entry(2, ShaderStages::FRAGMENT, sampler);
    [("pane", vec![pane, texture, sampler, pattern, tiled]), ("line", vec![line]), ("blit", vec![pane, texture])].map(
        |(label, entries)| {
            let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries };
            device.create_bind_group_layout(&descriptor)
        },
    )
}

/// Textures of one pane at one size.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) size: [u32; 2],
    pub(super) samples: wgpu::TextureView,
    pub(super) depth: wgpu::TextureView,
    pub(super) picture: wgpu::TextureView,
}

impl Target {
    /// Creates the textures. The size must not be zero.
    pub(super) fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let make = |format, sample_count, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("freebound pane"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            size,
            samples: make(COLOUR, SAMPLES, attachment),
            depth: make(DEPTH, SAMPLES, attachment),
            picture: make(COLOUR, 1, attachment | wgpu::TextureUsages::TEXTURE_BINDING),
        }
    }
}
