//! Pictures that the materials of a glTF file show, in files of their own or within it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::container::{beside, embedded};
use super::scene::Scene;
use crate::mesh_file::{MeshFile, Source, SourceFormat};

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
    shown_images(&json, scene).into_iter().map(|image| file(image).unwrap_or_else(|| path.to_owned())).collect()
}

/// Bytes of the picture with the most triangles of a mesh from a glTF file in a folder. Fails with the reason as text.
pub(crate) fn picture_within(mesh: &MeshFile, folder: &Path) -> Result<Vec<u8>, String> {
    let none = "its materials show no picture";
    let Some(Source { format: SourceFormat::Gltf(scene), bytes, .. }) = &mesh.source else { return Err(none.into()) };
    let json: Value = serde_json::from_slice(&scene.json).unwrap_or_default();
    let first = shown_images(&json, scene).first().copied();
    let image = &json["images"][first.ok_or(none)?];
    let missing = || "its picture is missing".to_owned();
    if let Some(uri) = image["uri"].as_str() {
        // Only regular files are opened: reading a pipe could block for ever.
        let file = || fs::read(beside(uri, folder).filter(|path| path.is_file())?).ok();
        return embedded(uri).and_then(Result::ok).or_else(file).ok_or_else(missing);
    }
    let of_view = || {
        let number = |value: &Value| usize::try_from(value.as_u64()?).ok();
        let view = json["bufferViews"].get(number(&image["bufferView"])?)?;
        let offset = if view["byteOffset"].is_null() { 0 } else { number(&view["byteOffset"])? };
        let start = scene.starts.get(number(&view["buffer"])?)?.checked_add(offset)?;
        bytes.get(start..start.checked_add(number(&view["byteLength"])?)?)
    };
    of_view().map(<[u8]>::to_vec).ok_or_else(missing)
}

/// Images that the read parts of a file show, the one with the most triangles first.
fn shown_images(json: &Value, scene: &Scene) -> Vec<usize> {
    let mut faces_of: BTreeMap<usize, usize> = BTreeMap::new();
    let parts = &scene.shown.parts;
    for (number, part) in parts.iter().enumerate() {
        let end = parts.get(number + 1).map_or(scene.corners.len() / 3, |next| next.first_face);
        if let Some(image) = image_of(json, scene.material_of(json, part)) {
            *faces_of.entry(image).or_default() += end.saturating_sub(part.first_face);
        }
    }
    let mut images: Vec<(usize, usize)> = faces_of.into_iter().collect();
    images.sort_by_key(|&(image, faces)| (std::cmp::Reverse(faces), image));
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
