//! Maps in a project file: positions of vertices in the plane, bit for bit, with a checksum.
//!
//! ```text
//! "maps": { "0": { "positions": "AAAAAAAA8D8AAAAAAAAAAA==", "sha256": "…" } }
//! ```
//!
//! Positions are x and y of each vertex, 64-bit floating-point numbers in little-endian order, in base64. The checksum is
//! of these bytes.

use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use freebound_core::problem::Embedding;
use glam::DVec2;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use sha2::{Digest, Sha256};

/// Bytes of a vertex.
const BYTES: usize = 2 * size_of::<f64>();

/// Map of a chart. Empty if the map in the file is damaged.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedMap(pub Arc<Embedding>);

#[derive(Serialize, Deserialize)]
struct Fields {
    positions: String,
    sha256: String,
}

impl Serialize for SavedMap {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self.0.iter().flat_map(DVec2::to_array).flat_map(f64::to_le_bytes).collect();
        Fields { positions: STANDARD.encode(&bytes), sha256: digest(&bytes) }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SavedMap {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Fields { positions, sha256 } = Fields::deserialize(deserializer)?;
        // A damaged map is no reason to refuse the project: the mesh can be solved again.
        let bytes = STANDARD.decode(positions).ok().filter(|bytes| digest(bytes) == sha256).unwrap_or_default();
        let (vertices, _) = bytes.as_chunks::<BYTES>();
        let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("8 bytes"));
        let position = |bytes: &[u8; BYTES]| DVec2::new(number(&bytes[..8]), number(&bytes[8..]));
        Ok(Self(Arc::new(vertices.iter().map(position).collect())))
    }
}

fn digest(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}
