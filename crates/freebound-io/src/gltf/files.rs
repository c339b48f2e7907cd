//! Files that belong to a glTF file.

use std::path::PathBuf;

use serde::Deserialize;

use super::container::beside;
use crate::mesh_file::{MeshFile, SourceFormat};

/// Parts of the JSON that name files.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Named {
    buffers: Vec<Thing>,
    images: Vec<Thing>,
}

#[derive(Deserialize)]
struct Thing {
    uri: Option<String>,
}

/// Paths of the buffers and pictures beside the glTF file that a mesh was read from. The files may be missing.
pub(crate) fn files_beside(mesh: &MeshFile) -> Vec<PathBuf> {
    let Some(SourceFormat::Gltf(scene)) = mesh.source.as_ref().map(|source| &source.format) else { return Vec::new() };
    let Some(folder) = &scene.folder else { return Vec::new() };
    let named: Named = serde_json::from_slice(&scene.json).unwrap_or_default();
    let uris = named.buffers.into_iter().chain(named.images).filter_map(|thing| thing.uri);
    uris.filter_map(|uri| beside(&uri, folder)).collect()
}
