//! Pictures that the materials of a glTF file show, in files of their own or within it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::POSITION;
use super::container::{Buffers, Chunks, beside, embedded};
use super::document::Document;
use crate::mesh_file::{MeshFile, ReadError, SourceFormat};

/// Extension that moves a picture on its faces.
const MOVED: &str = "KHR_texture_transform";

/// Extension with the pictures of an older kind of material.
const OLDER: &str = "KHR_materials_pbrSpecularGlossiness";

/// Files of the pictures that the materials of a mesh from a glTF file show, the picture with the most triangles first.
/// A picture within the file counts as the file itself, `path`.
pub(crate) fn pictures_of(mesh: &MeshFile, path: &Path) -> Vec<PathBuf> {
    let Some(SourceFormat::Gltf(scene)) = mesh.source.as_ref().map(|source| &source.format) else { return Vec::new() };
    let json: Value = serde_json::from_slice(&scene.json).unwrap_or_default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let file = |image| json["images"][image]["uri"].as_str().and_then(|uri| beside(uri, folder));
    shown_images(&json).into_iter().map(|image| file(image).unwrap_or_else(|| path.to_owned())).collect()
}

/// Bytes of the picture with the most triangles of a glTF file. Fails with the reason as text.
pub(crate) fn picture_in(bytes: Vec<u8>, folder: &Path) -> Result<Vec<u8>, String> {
    let words = |error: ReadError| error.to_string();
    let (json, binary) = Chunks::split(bytes).map_err(words)?;
    let document = Document::of(&json).map_err(words)?;
    let value: Value = serde_json::from_slice(&json).unwrap_or_default();
    let first = shown_images(&value).first().copied();
    let image = &value["images"][first.ok_or("its materials show no picture")?];
    if let Some(uri) = image["uri"].as_str() {
        // Only regular files are opened: reading a pipe could block for ever.
        let file = || fs::read(beside(uri, folder).filter(|path| path.is_file())?).ok();
        return embedded(uri).and_then(Result::ok).or_else(file).ok_or_else(|| "its picture is missing".to_owned());
    }
    let buffers = Buffers::of(&document, binary, Some(folder)).map_err(words)?;
    let of_view = || {
        let view = document.buffer_views.get(usize::try_from(image["bufferView"].as_u64()?).ok()?)?;
        let start = buffers.starts.get(view.buffer)?.checked_add(usize::try_from(view.byte_offset).ok()?)?;
        buffers.bytes.get(start..start.checked_add(usize::try_from(view.byte_length).ok()?)?)
    };
    of_view().map(<[u8]>::to_vec).ok_or_else(|| "its picture is missing".to_owned())
}

/// Images that materials show, the one with the most triangles first.
fn shown_images(json: &Value) -> Vec<usize> {
    let list = |name: &str| json[name].as_array().map(Vec::as_slice).unwrap_or_default();
    let mut corners_of: BTreeMap<usize, u64> = BTreeMap::new();
    for (number, mesh) in list("meshes").iter().enumerate() {
        let is_of_mesh = |node: &&Value| node["mesh"].as_u64() == Some(number as u64);
        let shows = if list("nodes").is_empty() { 1 } else { list("nodes").iter().filter(is_of_mesh).count() };
        for primitive in mesh["primitives"].as_array().into_iter().flatten() {
            let accessor = primitive["indices"].as_u64().or_else(|| primitive["attributes"][POSITION].as_u64());
            let count = accessor.and_then(|at| json["accessors"].get(usize::try_from(at).ok()?)?["count"].as_u64());
            if let Some(image) = image_of(json, &primitive["material"]).filter(|_| shows > 0) {
                *corners_of.entry(image).or_default() += count.unwrap_or(0).saturating_mul(shows as u64);
            }
        }
    }
    let mut images: Vec<(usize, u64)> = corners_of.into_iter().collect();
    images.sort_by_key(|&(image, corners)| (std::cmp::Reverse(corners), image));
    images.into_iter().map(|(image, _)| image).collect()
}

/// Image of a material's base colour. `None` if there is none, it belongs to other texture coordinates, or it is moved
/// on its faces.
fn image_of(json: &Value, material: &Value) -> Option<usize> {
    let at = |list: &str, index: &Value| json[list].get(usize::try_from(index.as_u64()?).ok()?);
    let material = at("materials", material)?;
    let look = &material["pbrMetallicRoughness"]["baseColorTexture"];
    let look = if look.is_null() { &material["extensions"][OLDER]["diffuseTexture"] } else { look };
    let is_usable = look["texCoord"].as_u64().unwrap_or(0) == 0 && look["extensions"][MOVED].is_null();
    let image = at("textures", look.get("index").filter(|_| is_usable)?)?.get("source")?;
    at("images", image)?;
    usize::try_from(image.as_u64()?).ok()
}
