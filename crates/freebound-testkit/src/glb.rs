//! Makes glTF files, and reads them with an independent reader, the crate `gltf`.

use std::ops::ControlFlow;

use base64::Engine as _;
use glam::{DMat4, DVec2, DVec3, Mat4};
use serde_json::{Value, json};

use freebound_io::{Instances, MeshFile, ReadError, ReadOptions, Texture, read_stream, read_stream_with, write_glb};

/// Component types of accessors.
pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// Builder of a glTF file.
pub struct GlbMaker {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl Default for GlbMaker {
    fn default() -> Self {
        Self::new()
    }
}

impl GlbMaker {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0", "generator": "tests", "extras": {"kept": [1, 2.5, "x"]}},
            "accessors": [], "bufferViews": [], "meshes": [], "nodes": [],
        });
        Self { json, binary: Vec::new() }
    }

    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn floats(&mut self, shape: &str, numbers: &[f32]) -> usize {
        let width = if shape == "SCALAR" { 1 } else { usize::from(shape.as_bytes()[3] - b'0') };
        let view = self.view(&bytes_of(numbers), None);
        let mut accessor = json!({
            "bufferView": view, "componentType": F32, "count": numbers.len() / width, "type": shape
        });
        if width == 3 {
            let column = |at: usize| numbers.iter().skip(at).step_by(3).copied();
            accessor["min"] = json!([0, 1, 2].map(|at| column(at).fold(f32::INFINITY, f32::min)));
            accessor["max"] = json!([0, 1, 2].map(|at| column(at).fold(f32::NEG_INFINITY, f32::max)));
        }
        self.push("accessors", accessor)
    }

    pub fn integers(&mut self, shape: &str, kind: u32, numbers: &[u32]) -> usize {
        let size = match kind {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()[..size].to_vec()).collect();
        let width = if shape == "SCALAR" { 1 } else { usize::from(shape.as_bytes()[3] - b'0') };
        let view = self.view(&bytes, None);
        let count = numbers.len() / width;
        self.push("accessors", json!({"bufferView": view, "componentType": kind, "count": count, "type": shape}))
    }

    /// JSON with its buffer.
    pub fn finished(&self, uri: Option<String>) -> Value {
        let mut json = self.json.clone();
        if !self.binary.is_empty() {
            json["buffers"] = json!([{"byteLength": self.binary.len(), "name": "all"}]);
        }
        if let Some(uri) = uri {
            json["buffers"][0]["uri"] = json!(uri);
        }
        json
    }

    pub fn glb(&self) -> Vec<u8> {
        glb_of(&self.finished(None), &self.binary)
    }

    /// Text file that embeds its buffer.
    pub fn text(&self) -> String {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.binary);
        self.finished(Some(format!("data:application/octet-stream;base64,{data}"))).to_string()
    }
}

pub fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Binary file of JSON and bytes.
pub fn glb_of(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut padded = binary.to_vec();
    padded.resize(binary.len().next_multiple_of(4), 0);
    let length = |bytes: &[u8]| u32::try_from(bytes.len()).expect("few").to_le_bytes();
    let mut body = [&length(&text)[..], b"JSON", &text].concat();
    if !padded.is_empty() {
        body.extend([&length(&padded)[..], b"BIN\0", &padded].concat());
    }
    let whole = u32::try_from(body.len() + 12).expect("few").to_le_bytes();
    [&b"glTF\x02\0\0\0"[..], &whole, &body].concat()
}

/// Triangle with its texture coordinates, v down as in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    pub corners: [DVec3; 3],
    pub texture: Option<[DVec2; 3]>,
}

/// Triangles of a file's scene, as the independent reader reads them.
pub fn seen(glb: &[u8]) -> Vec<Seen> {
    let file = gltf::Gltf::from_slice(glb).expect("another reader takes it");
    let blob = file.blob.as_deref().expect("a binary chunk");
    let mut found = Vec::new();
    let mut walk: Vec<(gltf::Node<'_>, DMat4)> = Vec::new();
    let roots: Vec<gltf::Node<'_>> = if let Some(scene) = file.default_scene() {
        scene.nodes().collect()
    } else {
        let children: Vec<usize> = file.nodes().flat_map(|node| node.children()).map(|n| n.index()).collect();
        file.nodes().filter(|node| !children.contains(&node.index())).collect()
    };
    walk.extend(roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY)));
    while let Some((node, outer)) = walk.pop() {
        let own = outer * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
            of_primitive(&primitive, blob, own, &mut found);
        }
        walk.extend(node.children().collect::<Vec<_>>().into_iter().rev().map(|child| (child, own)));
    }
    found
}

fn of_primitive(primitive: &gltf::Primitive<'_>, blob: &[u8], transform: DMat4, found: &mut Vec<Seen>) {
    use gltf::mesh::Mode;
    let reader = primitive.reader(|_| Some(blob));
    let positions: Vec<DVec3> =
        reader.read_positions().expect("positions").map(|p| DVec3::from(p.map(f64::from))).collect();
    let texture: Option<Vec<DVec2>> =
        reader.read_tex_coords(0).map(|all| all.into_f32().map(|uv| DVec2::from(uv.map(f64::from))).collect());
    let listed: Vec<usize> = match reader.read_indices() {
        Some(indices) => indices.into_u32().map(|index| index as usize).collect(),
        None => (0..positions.len()).collect(),
    };
    let triangles: Vec<[usize; 3]> = match primitive.mode() {
        Mode::Triangles => listed.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        Mode::TriangleStrip => {
            let turned = |(k, t): (usize, &[usize])| if k % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] };
            let all = listed.windows(3).enumerate().map(turned);
            all.filter(|[a, b, c]| a != b && b != c && c != a).collect()
        }
        Mode::TriangleFan => listed[1..].windows(2).map(|t| [t[0], t[1], listed[0]]).collect(),
        _ => Vec::new(),
    };
    let is_mirrored = transform.determinant() < 0.0;
    for [a, b, c] in triangles {
        let own = if is_mirrored { [a, c, b] } else { [a, b, c] };
        found.push(Seen {
            corners: own.map(|v| transform.transform_point3(positions[v])),
            texture: texture.as_ref().map(|all| own.map(|v| all[v])),
        });
    }
}

/// Sheet of `n` by `n` squares: positions, texture coordinates, triangles. Its numbers need all 32 bits.
pub fn sheet(n: u32) -> (Vec<f32>, Vec<f32>, Vec<u32>) {
    let (mut positions, mut texture, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for y in 0..=n {
        for x in 0..=n {
            let (u, v) = (x as f32 / n as f32, y as f32 / n as f32);
            positions.extend([u * 1.1, v * 0.7, (u * 3.0).sin() * 0.1]);
            texture.extend([u * 0.9 + 0.05, v * 0.8 + 0.1]);
        }
    }
    let at = |x, y| y * (n + 1) + x;
    for y in 0..n {
        for x in 0..n {
            let [low, right, far, left] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            indices.extend([low, right, far, low, far, left]);
        }
    }
    (positions, texture, indices)
}

/// File with a sheet in one node.
pub fn plain(n: u32, kind: u32) -> GlbMaker {
    let mut maker = GlbMaker::new();
    let (positions, texture, indices) = sheet(n);
    let position = maker.floats("VEC3", &positions);
    let texture = maker.floats("VEC2", &texture);
    let indices = maker.integers("SCALAR", kind, &indices);
    maker.push(
        "meshes",
        json!({"primitives": [{"attributes": {"POSITION": position, "TEXCOORD_0": texture}, "indices": indices}]}),
    );
    maker.push("nodes", json!({"mesh": 0}));
    maker
}

pub fn read(bytes: &[u8]) -> MeshFile {
    read_stream(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// Reads a mesh of its own for each node.
///
/// # Errors
///
/// Errors of the reader.
pub fn read_unique(bytes: &[u8]) -> Result<MeshFile, ReadError> {
    let options = ReadOptions { instances: Instances::Unique };
    read_stream_with(bytes, options, &mut |_| ControlFlow::Continue(()))
}

pub fn written(mesh: &MeshFile, texture: &Texture) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_glb(&mut bytes, mesh, texture).expect("memory takes all");
    bytes
}

/// JSON of a file.
pub fn json_of(glb: &[u8]) -> Value {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}
