//! wgpu pipelines and buffers.
