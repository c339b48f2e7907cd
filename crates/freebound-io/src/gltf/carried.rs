//! The glTF file that a mesh was read from, written as a single binary file with other texture coordinates.
//!
//! All of its JSON and of its buffers is kept, and new data are appended. Tangents are dropped if texture coordinates
//! change: a program that reads the file computes them. Vertices whose corners have different
//! texture coordinates are duplicated with all their attributes. Without such vertices, indices and all attributes
//! except texture coordinates stay unchanged. A mesh that several nodes show stays one mesh, unless the
//! nodes were read with a mesh of their own each. Pictures
//! beside the file are embedded.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use serde_json::{Value, json};

use super::accessor::Elements;
use super::container::{Buffers, beside};
use super::document::{Attributes, Document};
use super::growing::{Growing, VERTICES};
use super::grown::{Origin, grown};
use super::placed::{Placed, PlacedSet};
use super::scene::Scene;
use super::{TANGENT, TEXTURE};
use crate::mesh_file::{MeshFile, Source, Texture};

/// Mode of a primitive with separate triangles.
const TRIANGLES: u32 = 4;

/// Extension that stores a primitive's numbers a second time.
const DRACO: &str = "KHR_draco_mesh_compression";

/// Extensions that store the bytes of a view a second time, in another buffer.
const COMPRESSED_VIEWS: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// First bytes of pictures, with the media type of such files.
const PICTURES: [(&[u8], &str); 2] = [(b"\x89PNG", "image/png"), (b"\xFF\xD8\xFF", "image/jpeg")];

/// Writes a mesh as the file that it was read from.
pub(super) fn write_carried(
    out: &mut impl Write,
    mesh: &MeshFile,
    source: &Source,
    scene: &Scene,
    texture: &Texture,
) -> io::Result<()> {
    let document = Document::of(&scene.json).map_err(io::Error::other)?;
    let buffers = Buffers { bytes: source.bytes.clone(), starts: scene.starts.clone() };
    let before = PlacedSet::all(&document, &buffers, scene)?;
    let placed = Placed::of(mesh, source, scene, texture, before)?;
    let file = Growing::of(serde_json::from_slice(&scene.json)?, &source.bytes);
    let mut carried = Carried { document: &document, buffers: &buffers, scene, file };
    carried.join_buffers();
    let meshes = carried.part_meshes();
    let sets = (0..placed.sets.len()).map(|set| carried.attributes(set, &placed.sets[set]));
    let sets = sets.collect::<io::Result<Vec<_>>>()?;
    let mut needs_material = Vec::new();
    for (number, part) in scene.shown.parts.iter().enumerate() {
        let has_grown = !placed.sets[part.set].added.is_empty();
        let is_bare =
            document.meshes[scene.shown.instances[part.instance].mesh].primitives[part.primitive].indices.is_none();
        let needs_indices = placed.has_changed[number] || (has_grown && is_bare);
        let indices = needs_indices.then(|| carried.file.indices(&placed.triangles[number]));
        let primitive = &mut carried.file.json["meshes"][meshes[part.instance]]["primitives"][part.primitive];
        sets[part.set].put_into(primitive);
        if primitive.get("material").is_none() {
            needs_material.push((meshes[part.instance], part.primitive));
        }
        if let Some(indices) = indices {
            primitive["indices"] = json!(indices);
            primitive["mode"] = json!(TRIANGLES);
        }
        if let Some(extensions) = primitive.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.remove(DRACO);
        }
    }
    // Programs ignore texture coordinates without a material.
    for (mesh, primitive) in needs_material {
        let material = carried.file.default_material();
        carried.file.json["meshes"][mesh]["primitives"][primitive]["material"] = json!(material);
    }
    if let Some(folder) = &scene.folder {
        carried.embed_pictures(folder);
    }
    carried.file.write(out)
}

/// File under construction.
struct Carried<'a> {
    document: &'a Document,
    buffers: &'a Buffers,
    scene: &'a Scene,
    file: Growing<'a>,
}

/// Accessors of a set of vertices.
struct SetAccessors {
    attributes: Attributes,
    targets: Vec<Attributes>,
}

impl SetAccessors {
    fn put_into(&self, primitive: &mut Value) {
        primitive["attributes"] = json!(self.attributes);
        for (number, target) in self.targets.iter().enumerate() {
            primitive["targets"][number] = json!(target);
        }
    }
}

impl Carried<'_> {
    /// Joins all buffers into one.
    fn join_buffers(&mut self) {
        let starts = &self.scene.starts;
        for view in self.file.json.get_mut("bufferViews").and_then(Value::as_array_mut).into_iter().flatten() {
            let start = view["buffer"].as_u64().and_then(|buffer| starts.get(usize::try_from(buffer).ok()?));
            let offset = view["byteOffset"].as_u64().unwrap_or(0) + start.copied().unwrap_or(0) as u64;
            view["buffer"] = json!(0);
            if let Some(extensions) = view.get_mut("extensions").and_then(Value::as_object_mut) {
                for name in COMPRESSED_VIEWS {
                    extensions.remove(name);
                }
            }
            view["byteOffset"] = json!(offset);
        }
    }

    /// Gives each read instance its own mesh; returns the mesh of each instance.
    fn part_meshes(&mut self) -> Vec<usize> {
        let mut is_taken = vec![false; self.document.meshes.len()];
        let mut own = Vec::with_capacity(self.scene.shown.instances.len());
        for instance in &self.scene.shown.instances {
            let is_shared = std::mem::replace(&mut is_taken[instance.mesh], true);
            own.push(match instance.node.filter(|_| is_shared) {
                Some(node) => {
                    // Primitives are changed only after all meshes are copied, so this copy is still unchanged.
                    let copy = self.file.json["meshes"][instance.mesh].clone();
                    let mesh = self.file.push("meshes", copy);
                    self.file.json["nodes"][node]["mesh"] = json!(mesh);
                    mesh
                }
                None => instance.mesh,
            });
        }
        own
    }

    /// Accessors of a set, with texture coordinates and all added vertices.
    fn attributes(&mut self, number: usize, placed: &PlacedSet) -> io::Result<SetAccessors> {
        let set = &self.scene.shown.sets[number];
        let mut own = SetAccessors { attributes: set.attributes.clone(), targets: set.targets.clone() };
        if placed.has_new_texture {
            own.attributes.remove(TANGENT);
            for target in &mut own.targets {
                target.remove(TANGENT);
            }
        }
        if !placed.added.is_empty() {
            let mut new = BTreeMap::new();
            let all = own.attributes.iter_mut().chain(own.targets.iter_mut().flatten());
            for (name, accessor) in all.filter(|(name, _)| *name != TEXTURE) {
                let found = match new.get(&(*accessor, name.clone())) {
                    Some(&found) => found,
                    None => self.grown(*accessor, name, set.range.len(), &placed.added)?,
                };
                new.insert((*accessor, name.clone()), found);
                *accessor = found;
            }
        }
        let texture = self.file.vectors(placed.texture.iter().copied());
        own.attributes.insert(TEXTURE.to_owned(), texture);
        Ok(own)
    }

    /// Accessor with the elements of another, and added ones.
    fn grown(&mut self, accessor: usize, name: &str, count: usize, added: &[Origin]) -> io::Result<usize> {
        let elements = Elements::of(self.document, self.buffers, accessor).map_err(io::Error::other)?;
        if elements.count != count {
            let text = format!("accessor {accessor} has {} elements, but there are {count} positions", elements.count);
            return Err(io::Error::new(io::ErrorKind::InvalidData, text));
        }
        let (bytes, stride) = grown(&elements, name, added);
        let view = self.file.view(&bytes, Some(VERTICES));
        self.file.json["bufferViews"][view]["byteStride"] = json!(stride);
        let mut own = self.file.json["accessors"][accessor].clone();
        if let Some(fields) = own.as_object_mut() {
            fields.remove("sparse");
            fields.remove("byteOffset");
        }
        own["bufferView"] = json!(view);
        own["count"] = json!(count + added.len());
        Ok(self.file.push("accessors", own))
    }

    /// Embeds the pictures beside the file that was read. Missing pictures keep their address.
    fn embed_pictures(&mut self, folder: &Path) {
        for number in 0..self.file.json["images"].as_array().map_or(0, Vec::len) {
            let uri = self.file.json["images"][number]["uri"].as_str();
            let Some(path) = uri.and_then(|uri| beside(uri, folder)).filter(|path| path.is_file()) else { continue };
            let Ok(bytes) = fs::read(path) else { continue };
            let Some((_, kind)) = PICTURES.iter().find(|(mark, _)| bytes.starts_with(mark)) else { continue };
            let view = self.file.view(&bytes, None);
            let image = &mut self.file.json["images"][number];
            image["bufferView"] = json!(view);
            image["mimeType"] = json!(kind);
            image.as_object_mut().map(|fields| fields.remove("uri"));
        }
    }
}
