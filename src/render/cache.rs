//! Vertex buffers by what they hold: made when first asked for, dropped when no pane uses them.

use std::collections::{BTreeMap, BTreeSet};

use eframe::wgpu;
use wgpu::util::DeviceExt as _;

use super::gpu::Stats;
use crate::view::Revision;

/// What a buffer holds.
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
    /// Zeros, so many bytes: stands for what is not there.
    Zeros(u64),
    /// Flipped faces of an embedding: corners, and their paint.
    FlippedPlane(Revision, Revision),
    /// Flipped faces' colours and flags.
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
    /// Sees to it that a buffer is there. Empty contents, or more than the device takes, make none, and what would be
    /// drawn with it is left out. The usual limit of 256 MiB is an embedding of 5.5 million faces.
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

    /// Sees to it that there is a buffer of zeros. Nothing is sent: the device clears what it hands out.
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

    /// The buffer, if it could be made.
    pub(super) fn get(&self, key: Key) -> Option<&wgpu::Buffer> {
        self.buffers.get(&key)
    }

    pub(super) fn retain(&mut self, used: &BTreeSet<Key>) {
        self.buffers.retain(|key, _| used.contains(key));
    }
}
