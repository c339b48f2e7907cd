//! Paint callbacks for egui.

use std::sync::Arc;

use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use eframe::{egui, wgpu};
use egui::epaint::ViewportInPixels;

use super::frame::{MeshFrame, PaneId, PictureLayer, PlaneFrame};
use super::gpu::{BufferSlot, GpuResources, Io, Stats};
use super::overdraw::{MostCovered, affordable};
use super::plan::{Plan, Planner, Textures};
use super::uniforms::PaneSize;
use crate::view::PictureQuad;

/// Compiles the pipelines and stores them in egui's callback resources. Call once per window.
///
/// egui's own render pass must have its defaults: no multisampling and no depth buffer.
pub fn install(state: &RenderState) {
    let most_covered = MostCovered::of(state.adapter.get_info().device_type);
    let gpu = GpuResources::new(&state.device, &state.queue, state.target_format, most_covered);
    state.renderer.write().callback_resources.insert(gpu);
}

/// Counters of the renderer since [`install`]; `None` before it.
pub fn stats(state: &RenderState) -> Option<Stats> {
    state.renderer.read().callback_resources.get::<GpuResources>().map(GpuResources::stats)
}

/// Paint callback of the 3D pane. The rectangle must lie within the window.
pub fn mesh_pane(pane: PaneId, rect: egui::Rect, frame: MeshFrame) -> egui::PaintCallback {
    let (picture, pattern) = (frame.picture.clone(), frame.pattern.clone());
    let plan = Box::new(move |planner: &mut Planner<'_>| planner.mesh(&frame));
    let resolution = Box::new(|size, _| size);
    Callback::new_paint_callback(rect, PaneCallback { pane, rect, picture, pattern, resolution, plan })
}

/// Paint callback of the embedding's pane. The rectangle must lie within the window.
pub fn plane_pane(pane: PaneId, rect: egui::Rect, frame: PlaneFrame) -> egui::PaintCallback {
    let (picture, pattern) = (frame.picture.clone(), frame.pattern.clone());
    let frame = Arc::new(frame);
    let measured = Arc::clone(&frame);
    let resolution = Box::new(move |size, most| affordable(&measured, size, most));
    let plan = Box::new(move |planner: &mut Planner<'_>| planner.plane(&frame));
    Callback::new_paint_callback(rect, PaneCallback { pane, rect, picture, pattern, resolution, plan })
}

struct PaneCallback {
    pane: PaneId,
    rect: egui::Rect,
    picture: Option<PictureLayer>,
    pattern: Option<Arc<PictureQuad>>,
    /// Size of the picture of the pane, which may have fewer pixels than the pane.
    resolution: Box<dyn Fn(PaneSize, MostCovered) -> PaneSize + Send + Sync>,
    plan: Box<dyn Fn(&mut Planner<'_>) -> Plan + Send + Sync>,
}

impl CallbackTrait for PaneCallback {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(gpu) = resources.get_mut::<GpuResources>() {
            let mut io = Io { device, queue, encoder };
            let size = (self.resolution)(pane_size(self.rect, screen), gpu.most_covered());
            let place = BufferSlot { pane: self.pane, size };
            let textures = Textures { picture: self.picture.as_ref(), pattern: self.pattern.as_ref() };
            gpu.prepare(&mut io, place, textures, &self.plan);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        render_pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(gpu) = resources.get::<GpuResources>() {
            gpu.paint(self.pane, render_pass);
        }
    }
}

/// Size of the rectangle in whole pixels, rounded as egui rounds its viewport.
fn pane_size(rect: egui::Rect, screen: &ScreenDescriptor) -> PaneSize {
    let viewport = ViewportInPixels::from_points(&rect, screen.pixels_per_point, screen.size_in_pixels);
    let side = |length: i32| u32::try_from(length).unwrap_or(0);
    PaneSize {
        in_pixels: [side(viewport.width_px), side(viewport.height_px)],
        pixels_per_point: screen.pixels_per_point,
    }
}
