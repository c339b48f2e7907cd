//! Vertex buffers by content: created on first request, dropped when no pane uses them.

use std::collections::{BTreeMap, BTreeSet};

use eframe::wgpu;
use wgpu::util::DeviceExt as _;

use super::gpu::Stats;
use crate::view::Revision;

/// Content of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Key {
    /// Positions of a mesh, corner by corner.
    Positions(Revision),
    /// Normals of a mesh, corner by corner.
    Normals(Revision),
    /// An embedding, corner by corner.
    Plane(Revision),
    /// Colours and flags, corner by corner.
    Paint(Revision),
    /// Zeros, this number of bytes: a placeholder for a missing stream.
    Zeros(u64),
    /// Corners of the flipped faces of an embedding: revisions of the embedding and of the paint.
    FlippedPlane(Revision, Revision),
    /// Colours and flags of flipped faces.
    FlippedPaint(Revision),
    /// Lines of a list on a mesh.
    MeshLines(Revision, Revision),
    /// Lines of a list in an embedding.
    PlaneLines(Revision, Revision),
    /// Faces of a list in an embedding.
    PlaneFills(Revision, Revision),
}

/// Buffers in use.
#[derive(Debug, Default)]
pub(super) struct Cache {
    buffers: BTreeMap<Key, wgpu::Buffer>,
    pub(super) stats: Stats,
}

impl Cache {
    /// Creates the buffer if it does not exist. Empty contents, or contents larger than the device accepts, create
    /// none, and the draw calls that need them are skipped. The usual limit of 256 MiB is an embedding of 5.5
    /// million faces.
    pub(super) fn ensure<'a>(
        &mut self,
        device: &wgpu::Device,
        key: Key,
        contents: impl FnOnce() -> std::borrow::Cow<'a, [u8]>,
    ) {
        if self.buffers.contains_key(&key) {
            return;
        }
        let bytes = contents();
        if bytes.is_empty() || bytes.len() as u64 > device.limits().max_buffer_size {
            return;
        }
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("freebound vertices"),
            contents: &bytes,
            usage: wgpu::BufferUsages::VERTEX,
        });
        self.stats.uploads += 1;
        self.stats.uploaded_bytes += bytes.len() as u64;
        self.buffers.insert(key, buffer);
    }

    /// Creates a buffer of zeros if it does not exist. Nothing is uploaded, since the device clears new buffers.
    pub(super) fn ensure_zeros(&mut self, device: &wgpu::Device, size: u64) {
        if size == 0 || size > device.limits().max_buffer_size {
            return;
        }
        self.buffers.entry(Key::Zeros(size)).or_insert_with(|| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("freebound zeros"),
                size,
                usage: wgpu::BufferUsages::VERTEX,
                mapped_at_creation: false,
            })
        });
    }

    /// Returns the buffer if it could be created.
    pub(super) fn get(&self, key: Key) -> Option<&wgpu::Buffer> {
        self.buffers.get(&key)
    }

    pub(super) fn retain(&mut self, used: &BTreeSet<Key>) {
        self.buffers.retain(|key, _| used.contains(key));
    }
}
