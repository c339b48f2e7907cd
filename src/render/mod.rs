//! Both panes on the graphics card: pipelines, buffers, and the callbacks that egui runs.
//!
//! A pane is drawn into its own target (four samples per pixel, depth) before egui paints, and only if its content
//! has changed. egui then draws the finished picture into the pane's rectangle. Buffers are created once per
//! revision of their content. A frame without changes uploads nothing and draws two triangles.
//!
//! ```text
//! view::{MeshArrays, PlaneArrays, FacePaint, EdgeList, PictureQuad}   immutable, shared by Arc, with a revision
//!         │
//! MeshFrame, PlaneFrame      content of one pane in one frame: arrays, camera, style, palette
//!         │ mesh_pane, plane_pane
//! egui::PaintCallback        add it to the painter
//! ```
//!
//! | file | content |
//! |---|---|
//! | `frame.rs` | content of a pane |
//! | `callback.rs` | paint callbacks for egui |
//! | `plan.rs`, `uniforms.rs` | from a frame to draw calls and uniforms |
//! | `overdraw.rs` | resolution of a pane whose faces lie over each other |
//! | `gpu.rs`, `pipelines.rs`, `cache.rs` | state on the device |
//!
//! Call [`install`] once; without it, or if egui runs without a graphics card, a pane stays empty.

mod cache;
mod callback;
mod frame;
mod gpu;
mod overdraw;
mod pipelines;
mod plan;
mod uniforms;

pub use callback::{install, mesh_pane, plane_pane, stats};
pub use frame::{
    FaceShading, FillLayer, GhostLayer, LineLayer, MeshFrame, Normals, PaneId, PictureLayer, PlaneFrame, Sampling,
    Style, Surroundings,
};
pub use gpu::Stats;
pub use pipelines::{SHADERS, ShaderFile};
