//! Writer of binary glTF files: the file that a mesh was read from with other texture coordinates, or a new one.
//!
//! The format holds 32-bit numbers, so coordinates are rounded to the nearest. Coordinates that are unchanged since
//! they were read come back bit for bit.

use std::collections::HashMap;
use std::io::{self, Write};

use glam::{DVec3, DVec4};
use serde_json::json;

use super::carried::write_carried;
use super::growing::Growing;
use super::read::turned_over;
use super::shading::Shading;
use super::{COLOUR, NORMAL, POSITION, TEXTURE};
use crate::corner_data::CornerData;
use crate::file_values::linear_from_srgb;
use crate::finite::check_finite;
use crate::mesh_file::{MeshFile, NO_TEXTURE, SourceFormat, Texture};
use freebound_core::mesh::VertexId;

/// Writes a mesh with these texture coordinates as a binary glTF file (GLB).
///
/// If the mesh was read from glTF, all of that file is kept. Otherwise the file holds triangles, texture coordinates,
/// normals and colours. It has a plain material, because programs ignore texture coordinates without one. Corners
/// without new texture coordinates keep those of the file, or have 0, 0.
///
/// # Errors
///
/// If `out` cannot be written, a texture coordinate is infinite or not a number, a position is beyond 32-bit numbers,
/// or the file would exceed 4 GiB.
pub fn write_glb(out: &mut impl Write, mesh: &MeshFile, texture: &Texture) -> io::Result<()> {
    write_glb_with(out, mesh, texture, None)
}

/// Writes as [`write_glb`] does. A mesh of another format gets these materials.
pub(crate) fn write_glb_with(
    out: &mut impl Write,
    mesh: &MeshFile,
    texture: &Texture,
    shading: Option<&Shading>,
) -> io::Result<()> {
    check_finite(&texture.coordinates)?;
    if let Some(source) = &mesh.source
        && let SourceFormat::Gltf(scene) = &source.format
    {
        return write_carried(out, mesh, source, scene, texture);
    }
    write_plain(out, mesh, texture, shading)
}

/// Vertices of a new file.
struct NewVertices {
    /// Vertex and coordinate of the mesh of each vertex.
    vertices: Vec<(VertexId, u32)>,
    triangles: Vec<[u32; 3]>,
    /// Polygon of each triangle. `None` if all polygons are triangles.
    face_of: Option<Vec<u32>>,
    normals: Option<Vec<[f32; 3]>>,
    /// Linear colours with alpha.
    colours: Option<Vec<[f32; 4]>>,
}

/// Vertex and coordinate of a mesh, with the bits of normal and colour: these make a vertex of the file.
type Key = ((VertexId, u32), Option<[u32; 3]>, Option<[u32; 4]>);

impl NewVertices {
    fn of(mesh: &MeshFile, texture: &Texture) -> Self {
        let polygons = &mesh.polygons;
        let data = CornerData::of(mesh);
        let normal = |corner: usize| data.normals.as_ref().map(|normals| normals[corner].as_vec3().to_array());
        let linear = |colour: DVec4| linear_from_srgb(colour).as_vec4().to_array();
        let colour = |corner: usize| data.colours.as_ref().map(|colours| linear(colours[corner]));
        let bits = |x: f32| (x + 0.0).to_bits();
        let mut number_of: HashMap<Key, u32> = HashMap::new();
        let mut vertices: Vec<(VertexId, u32)> = Vec::new();
        // Corner at which each vertex was found first.
        let mut first_corner: Vec<usize> = Vec::new();
        let mut number = |place: u32| {
            let corner = place as usize;
            let coordinate = texture.corners.get(corner).copied().unwrap_or(NO_TEXTURE);
            let vertex = (polygons.corners[corner], coordinate);
            let key = (vertex, normal(corner).map(|n| n.map(bits)), colour(corner).map(|c| c.map(bits)));
            *number_of.entry(key).or_insert_with(|| {
                vertices.push(vertex);
                first_corner.push(corner);
                VertexId::from_index(vertices.len() - 1).number()
            })
        };
        let (places, face_of) = polygons.triangle_places();
        let triangles = places.iter().map(|places| places.map(&mut number)).collect();
        let normals =
            data.normals.is_some().then(|| first_corner.iter().filter_map(|&corner| normal(corner)).collect());
        let colours =
            data.colours.is_some().then(|| first_corner.iter().filter_map(|&corner| colour(corner)).collect());
        Self { vertices, triangles, face_of, normals, colours }
    }
}

fn write_plain(out: &mut impl Write, mesh: &MeshFile, texture: &Texture, shading: Option<&Shading>) -> io::Result<()> {
    let polygons = &mesh.polygons;
    let NewVertices { vertices, triangles, face_of, normals, colours } = NewVertices::of(mesh, texture);
    let mut file = Growing::of(
        json!({
            "asset": { "version": "2.0", "generator": concat!("Freebound ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
        }),
        &[],
    );
    let positions: Vec<[f32; 3]> =
        vertices.iter().map(|&(vertex, _)| polygons.positions[vertex.index()].as_vec3().to_array()).collect();
    if let Some(at) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
        let place = polygons.positions[vertices[at].0.index()];
        let text = format!("{} is at {place}, beyond the range of 32-bit numbers: write PLY or OBJ", vertices[at].0);
        return Err(io::Error::new(io::ErrorKind::InvalidData, text));
    }
    let position = file.vectors(positions.iter().copied());
    let bound = |pick: fn(DVec3, DVec3) -> DVec3, begin: f64| {
        let all = positions.iter().map(|position| DVec3::from(position.map(f64::from)));
        all.fold(DVec3::splat(begin), pick).to_array()
    };
    file.json["accessors"][position]["min"] = json!(bound(DVec3::min, f64::INFINITY));
    file.json["accessors"][position]["max"] = json!(bound(DVec3::max, f64::NEG_INFINITY));
    let mut attributes = json!({ POSITION: position });
    if !texture.coordinates.is_empty() {
        let coordinates = vertices.iter().map(|&(_, coordinate)| {
            let uv = texture.coordinates.get(coordinate as usize).copied();
            uv.map_or([0.0; 2], turned_over)
        });
        attributes[TEXTURE] = json!(file.vectors(coordinates));
    }
    if let Some(normals) = normals {
        attributes[NORMAL] = json!(file.vectors(normals.into_iter()));
    }
    if let Some(colours) = colours {
        attributes[COLOUR] = json!(file.vectors(colours.into_iter()));
    }
    let (divided, materials) = match shading {
        Some(shading) => (shading.divided(&triangles, face_of.as_deref()), shading.put_into(&mut file)),
        None => (vec![triangles], vec![file.default_material()]),
    };
    let mut primitives = Vec::new();
    for (triangles, material) in divided.iter().zip(materials) {
        let indices = file.indices(triangles);
        primitives.push(json!({ "attributes": attributes, "indices": indices, "material": material }));
    }
    file.push("meshes", json!({ "primitives": primitives }));
    file.write(out)
}
