//! The two panes on the graphics card: pipelines, buffers, and the callbacks that egui runs.
//!
//! A pane is drawn into a target of its own (four samples a pixel, depth) before egui paints, and only when something
//! that it shows has changed; egui then merely puts the finished picture into its rectangle. Buffers are made once per
//! revision of what they hold. A frame in which nothing changed sends nothing and draws two triangles.
//!
//! ```text
//! view::{MeshArrays, PlaneArrays, FacePaint, EdgeList, Picture}   immutable, shared by Arc, each with a revision
//!         │
//! MeshFrame, PlaneFrame      what one pane shows in this frame: arrays, camera, style, palette
//!         │ mesh_pane, plane_pane
//! egui::PaintCallback        add it to the painter
//! ```
//!
//! | file | what |
//! |---|---|
//! | `frame.rs` | what a pane shows |
//! | `callback.rs` | the way into egui |
//! | `plan.rs`, `uniforms.rs` | from a frame to draw calls and the small numbers of the shaders |
//! | `gpu.rs`, `pipelines.rs`, `cache.rs` | what lives on the device |
//!
//! [`install`] must have run once; without it, or where egui runs without a graphics card, a pane stays empty.

mod cache;
mod callback;
mod frame;
mod gpu;
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
