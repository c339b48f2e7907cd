//! Where a pane is drawn: colour and depth with four samples a pixel, and the picture that they resolve to.

use eframe::wgpu;

/// Samples per pixel. Every driver offers four.
pub(super) const SAMPLES: u32 = 4;
/// Linear light, stored with the sRGB curve.
pub(super) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The textures of one pane, of one size.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) size: [u32; 2],
    pub(super) samples: wgpu::TextureView,
    pub(super) depth: wgpu::TextureView,
    pub(super) picture: wgpu::TextureView,
}

impl Target {
    /// Textures of a size, which must not be zero.
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
