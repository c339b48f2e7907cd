//! Normals and colours of a mesh, for a file of another format than the one that the mesh was read from.
//!
//! OBJ files have normals at corners and colours at vertices, PLY files have both at vertices, and glTF files have both
//! at vertices of their own, of which a vertex of the mesh may have several. Here both are at corners of the mesh.
//!
//! A new vertex lies on an edge of a face of the file. Its values are between those of the ends in that face. Corners
//! without a normal get the normal of their face.
//!
//! Colours of OBJ and PLY files are in sRGB, those of glTF files are linear. They are converted.
//!
//! Source: "glTF 2.0 Specification", Khronos Group, 2021, §3.7.2; IEC 61966-2-1 for sRGB.

use glam::{DVec3, DVec4};

use crate::file_values::FileValues;
use crate::mesh_file::{MeshFile, Source, SourceFormat};
use freebound_core::mesh::{NewVertex, PolygonMesh, VertexId};

/// Normals and colours at the corners of a mesh, in the order of its corners.
#[derive(Debug, Default)]
pub(crate) struct CornerData {
    /// Unit normals. Absent if the file has none.
    pub(crate) normals: Option<Vec<DVec3>>,
    /// Colours with alpha, in sRGB, 0 to 1. Absent if the file has none.
    pub(crate) colours: Option<Vec<DVec4>>,
}

impl CornerData {
    /// Normals and colours of the file that a mesh was read from.
    pub(crate) fn of(mesh: &MeshFile) -> Self {
        let Some(source) = &mesh.source else { return Self::default() };
        let (normals, colours) = match &source.format {
            SourceFormat::Obj => crate::obj::corner_values(&source.bytes),
            SourceFormat::Ply(header) => header.vertex_values(&source.bytes),
            SourceFormat::Gltf(scene) => scene.corner_values(&source.bytes),
        };
        let polygons = &mesh.polygons;
        let normals = normals.map(|normals| {
            let found = at_corners(&normals, polygons, source);
            let mut all = Vec::with_capacity(found.len());
            for face in 0..polygons.face_count() {
                let own = polygons.corner_range(face).map(|corner| found[corner]);
                all.extend(own.map(|normal| unit(normal, || normal_of(polygons, face))));
            }
            all
        });
        let white = |colour: Option<DVec4>| colour.filter(|colour| colour.is_finite()).unwrap_or(DVec4::ONE);
        let colours = colours.map(|colours| at_corners(&colours, polygons, source).into_iter().map(white).collect());
        Self { normals, colours }
    }
}

/// Normal of length 1, or the fallback if there is none.
fn unit(normal: Option<DVec4>, fallback: impl Fn() -> DVec3) -> DVec3 {
    let own = normal.and_then(|normal| normal.truncate().try_normalize());
    own.unwrap_or_else(fallback)
}

/// Normal of a polygon, by its area vector. Up if the polygon has no area.
fn normal_of(mesh: &PolygonMesh, face: usize) -> DVec3 {
    let corners = mesh.face(face);
    let at = |k: usize| mesh.positions[corners[k % corners.len()].index()] - mesh.positions[corners[0].index()];
    let area: DVec3 = (0..corners.len()).map(|k| at(k).cross(at(k + 1))).sum();
    area.try_normalize().unwrap_or(DVec3::Z)
}

/// Value of each vertex: the value at its first corner, or the default for a vertex without corners.
pub(crate) fn at_vertices<T: Copy>(mesh: &PolygonMesh, at_corners: &[T], default: T) -> Vec<T> {
    let mut found = vec![None; mesh.positions.len()];
    for (vertex, value) in mesh.corners.iter().zip(at_corners) {
        found[vertex.index()].get_or_insert(*value);
    }
    found.into_iter().map(|value| value.unwrap_or(default)).collect()
}

/// Normal of each vertex; `None` if a vertex has several in 32 bits.
pub(crate) fn normals_of_vertices(mesh: &PolygonMesh, at_corners: &[DVec3]) -> Option<Vec<DVec3>> {
    let found = at_vertices(mesh, at_corners, DVec3::Z);
    let is_same = |(vertex, normal): (&VertexId, &DVec3)| found[vertex.index()].as_vec3() == normal.as_vec3();
    mesh.corners.iter().zip(at_corners).all(is_same).then_some(found)
}

/// Value at each corner of the mesh, if it has one.
fn at_corners(values: &FileValues, mesh: &PolygonMesh, source: &Source) -> Vec<Option<DVec4>> {
    let mut found = Vec::with_capacity(mesh.corners.len());
    for face in 0..mesh.face_count() {
        let of_file = source.face_of(face) as usize;
        found.extend(mesh.face(face).iter().enumerate().map(|(at, &vertex)| {
            let new = vertex.index().checked_sub(source.vertex_count);
            match new.and_then(|new| source.new_vertices.get(new)) {
                None => values.at(of_file, at, vertex),
                Some(&NewVertex { edge: [a, b], at: share }) => {
                    let [a, b] = [values.at(of_file, at, a)?, values.at(of_file, at, b)?];
                    Some(a + share * (b - a))
                }
            }
        }));
    }
    found
}
