//! Binary glTF file under construction: its JSON, its old bytes, and added bytes.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::accessor::Component;
use super::container::{BINARY, CHUNK_HEAD, FILE_HEAD, JSON, MAGIC};

/// Target of a view: vertices or indices.
pub(super) const VERTICES: u32 = 34_962;
pub(super) const INDICES: u32 = 34_963;

/// Alignment of views and chunks, bytes.
pub(super) const ALIGNMENT: usize = 4;

/// Name of the material of surfaces without one.
pub(super) const DEFAULT_MATERIAL: &str = "default";

/// Largest usable index of 16 bits; 65,535 restarts strips.
const MAX_U16: usize = 65_534;

/// File under construction.
pub(super) struct Growing<'a> {
    pub(super) json: Value,
    /// Bytes of the original file.
    old: &'a [u8],
    added: Vec<u8>,
}

impl<'a> Growing<'a> {
    pub(super) fn of(json: Value, old: &'a [u8]) -> Self {
        Self { json, old, added: vec![0; old.len().next_multiple_of(ALIGNMENT) - old.len()] }
    }

    /// Appends an entry to a list of the JSON, which is created if missing, and returns its index.
    pub(super) fn push(&mut self, list: &str, thing: Value) -> usize {
        let list = &mut self.json[list];
        if !list.is_array() {
            *list = json!([]);
        }
        let list = list.as_array_mut().expect("made above");
        list.push(thing);
        list.len() - 1
    }

    /// Appends bytes with a view of them, and returns the index of the view.
    pub(super) fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let begin = self.old.len() + self.added.len();
        self.added.extend_from_slice(bytes);
        self.added.resize(self.added.len() + bytes.len().next_multiple_of(ALIGNMENT) - bytes.len(), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": begin, "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.push("bufferViews", view)
    }

    /// Plain material for surfaces without one, which is appended at the first call.
    pub(super) fn default_material(&mut self) -> usize {
        let plain = json!({ "name": DEFAULT_MATERIAL, "pbrMetallicRoughness": { "metallicFactor": 0.0 } });
        let found = self.json["materials"].as_array().and_then(|all| all.iter().position(|own| *own == plain));
        found.unwrap_or_else(|| self.push("materials", plain))
    }

    /// Appends an accessor of vectors of `N` 32-bit numbers.
    pub(super) fn vectors<const N: usize>(&mut self, vectors: impl Iterator<Item = [f32; N]>) -> usize {
        let mut bytes = Vec::new();
        let mut count = 0;
        for vector in vectors {
            bytes.extend(vector.iter().flat_map(|x| x.to_le_bytes()));
            count += 1;
        }
        let view = self.view(&bytes, Some(VERTICES));
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": Component::F32.code(), "count": count, "type": format!("VEC{N}") }),
        )
    }

    /// Appends an accessor of triangle indices, in 16 bits if they fit.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let all = triangles.as_flattened();
        let largest = all.iter().max().map_or(0, |&index| index as usize);
        let (kind, size) = if largest <= MAX_U16 { (Component::U16, 2) } else { (Component::U32, 4) };
        let bytes: Vec<u8> = all.iter().flat_map(|index| index.to_le_bytes().into_iter().take(size)).collect();
        let view = self.view(&bytes, Some(INDICES));
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": kind.code(), "count": all.len(), "type": "SCALAR" }),
        )
    }

    /// Writes the file.
    pub(super) fn write(mut self, out: &mut impl Write) -> io::Result<()> {
        let binary = self.old.len() + self.added.len();
        let before = self.json.pointer_mut("/buffers/0").map(Value::take).filter(Value::is_object);
        let mut buffer = before.unwrap_or_else(|| json!({}));
        buffer.as_object_mut().map(|fields| fields.remove("uri"));
        buffer["byteLength"] = json!(binary);
        self.json["buffers"] = json!([buffer]);
        let mut text = serde_json::to_vec(&self.json)?;
        text.resize(text.len().next_multiple_of(ALIGNMENT), b' ');
        let whole = FILE_HEAD + 2 * CHUNK_HEAD + text.len() + binary;
        out.write_all(MAGIC)?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&length(whole)?)?;
        out.write_all([length(text.len())?, *JSON].as_flattened())?;
        out.write_all(&text)?;
        out.write_all([length(binary)?, *BINARY].as_flattened())?;
        out.write_all(self.old)?;
        out.write_all(&self.added)
    }
}

fn length(bytes: usize) -> io::Result<[u8; 4]> {
    let too_large = |_| io::Error::new(io::ErrorKind::FileTooLarge, "a GLB file is limited to 4 GiB: write PLY");
    Ok(u32::try_from(bytes).map_err(too_large)?.to_le_bytes())
}
