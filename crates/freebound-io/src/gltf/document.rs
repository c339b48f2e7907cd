//! JSON of a glTF file, as far as meshes need it.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use crate::mesh_file::ReadError;

/// Extensions that compress the numbers of a file, so that they cannot be read.
const COMPRESSIONS: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Extension that shows the mesh of a node many times.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Document of a glTF file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Document {
    asset: Asset,
    extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    pub(super) scenes: Vec<SceneNodes>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<BufferView>,
    pub(super) buffers: Vec<Buffer>,
}

#[derive(Debug, Deserialize)]
struct Asset {
    version: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct SceneNodes {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    #[serde(default)]
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    skin: Option<IgnoredAny>,
    #[serde(default)]
    extensions: Value,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) primitives: Vec<Primitive>,
}

/// Accessors by the name of their attribute.
pub(super) type Attributes = BTreeMap<String, usize>;

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) mode: Option<u32>,
    #[serde(default)]
    pub(super) targets: Vec<Attributes>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<Sparse>,
}

/// Elements that replace those in the view.
#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: Part,
    pub(super) values: Part,
}

/// Position of the indices or the values of a sparse accessor.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Part {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: Option<u32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: u64,
}

impl Document {
    /// Parses the document from JSON.
    pub(super) fn of(json: &[u8]) -> Result<Self, ReadError> {
        check_objects(json)?;
        let mut text = serde_json::Deserializer::from_slice(json);
        let document: Self = serde_path_to_error::deserialize(&mut text).map_err(|error| ReadError::Json {
            field: Some(error.path().to_string()).filter(|path| path != ".").unwrap_or_else(|| "JSON".to_owned()),
            reason: error.inner().to_string(),
        })?;
        if !document.asset.version.starts_with("2.") {
            return Err(ReadError::NotReadYet("glTF of a version other than 2"));
        }
        let missing = document.extensions_required.iter().find(|name| COMPRESSIONS.contains(&name.as_str()));
        missing.map_or(Ok(()), |name| Err(ReadError::NeedsExtension(name.clone())))?;
        Ok(document)
    }
}

/// Fails if a list stands in place of an object: serde would read a struct from it, which no file intends.
fn check_objects(json: &[u8]) -> Result<(), ReadError> {
    let Ok(root) = serde_json::from_slice::<Value>(json) else { return Ok(()) };
    let refused = |field: &str| ReadError::Json { field: field.to_owned(), reason: "not an object".to_owned() };
    if !root.is_object() {
        return Err(refused("JSON"));
    }
    for field in ["scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"] {
        let entries = root[field].as_array().into_iter().flatten();
        let primitives = entries.clone().filter_map(|entry| entry["primitives"].as_array()).flatten();
        if entries.chain(primitives).any(|entry| !entry.is_object()) {
            return Err(refused(field));
        }
    }
    Ok(())
}

impl Default for Document {
    fn default() -> Self {
        Self {
            asset: Asset { version: String::new() },
            extensions_required: Vec::new(),
            scene: None,
            scenes: Vec::new(),
            nodes: Vec::new(),
            meshes: Vec::new(),
            accessors: Vec::new(),
            buffer_views: Vec::new(),
            buffers: Vec::new(),
        }
    }
}

impl Node {
    /// Transform from the node's space to its parent's; `None` for the identity.
    pub(super) fn transform(&self) -> Option<DAffine3> {
        let transform = if let Some(matrix) = self.matrix {
            let columns = DMat4::from_cols_array(&matrix);
            DAffine3::from_mat4(DMat4 { w_axis: columns.w_axis.truncate().extend(1.0), ..without_last_row(columns) })
        } else {
            let turn = DQuat::from_vec4(DVec4::from(self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0])));
            let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
            let (scale, place) = (self.scale.unwrap_or([1.0; 3]), self.translation.unwrap_or_default());
            DAffine3::from_scale_rotation_translation(DVec3::from(scale), turn, DVec3::from(place))
        };
        (transform != DAffine3::IDENTITY).then_some(transform)
    }

    /// True if an extension shows the node's mesh many times.
    pub(super) fn is_repeated(&self) -> bool {
        self.extensions.get(INSTANCING).is_some()
    }

    /// True if joints place the node instead of its own transform.
    pub(super) fn is_skinned(&self) -> bool {
        self.skin.is_some()
    }
}

fn without_last_row(columns: DMat4) -> DMat4 {
    let [x, y, z] = [columns.x_axis, columns.y_axis, columns.z_axis].map(|axis| axis.truncate().extend(0.0));
    DMat4::from_cols(x, y, z, columns.w_axis)
}

impl Primitive {
    /// Topology of the triangles; `None` for points or lines.
    pub(super) fn topology(&self) -> Option<Topology> {
        match self.mode.unwrap_or(4) {
            4 => Some(Topology::Triangles),
            5 => Some(Topology::Strip),
            6 => Some(Topology::Fan),
            _ => None,
        }
    }
}

/// Arrangement of triangles in a list of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Topology {
    Triangles,
    Strip,
    Fan,
}

impl Topology {
    /// Number of triangles for a number of vertices.
    pub(super) fn count(self, vertices: u64) -> u64 {
        if self == Self::Triangles { vertices / 3 } else { vertices.saturating_sub(2) }
    }

    /// Indices of a triangle's corners in the list of vertices.
    pub(super) fn triangle(self, number: usize) -> [usize; 3] {
        match self {
            Self::Triangles => [3 * number, 3 * number + 1, 3 * number + 2],
            Self::Strip => [number, number + 1 + number % 2, number + 2 - number % 2],
            Self::Fan => [number + 1, number + 2, 0],
        }
    }
}
