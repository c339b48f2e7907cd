//! Layout of a file: its texture coordinates, or those of another file, as an embedding of the mesh to continue from.

use glam::DVec2;

use super::texture::coordinate_key;
use super::{MeshFile, NO_TEXTURE, Texture, TextureError};
use freebound_core::mesh::{Repaired, TriMesh, VertexId};
use freebound_core::problem::Embedding;

/// Reasons that the texture coordinates of a file are not an embedding of its mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LayoutError {
    /// Texture coordinates are missing.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The texture coordinates are cut along an edge that is not cut on the surface.
    #[error("vertex {vertex} has several texture coordinates, but the surface is not cut there")]
    Torn {
        /// First vertex with several coordinates, as numbered in the file.
        vertex: VertexId,
    },
    /// The layout of another file has no coordinate for a vertex of the mesh.
    #[error("the layout has no texture coordinates for vertex {vertex} of the mesh")]
    NoVertex {
        /// First vertex without a coordinate, as numbered in the file of the mesh.
        vertex: VertexId,
    },
}

impl MeshFile {
    /// Texture coordinates, one per vertex of `mesh`. `mesh` holds the file's triangles, or those of the repaired
    /// mesh or chart `repaired`. Unreferenced vertices are at the origin. The additional vertex of a hole filling is
    /// at the mean of the hole's boundary loop.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] if texture coordinates are missing, or a vertex has several.
    pub fn layout(&self, repaired: Option<&Repaired>, mesh: &TriMesh) -> Result<Embedding, LayoutError> {
        self.layout_by(self.texture.as_ref().ok_or(TextureError::None)?, repaired, mesh)
    }

    /// Texture coordinates of another file for the corners of this one. If both files have equal faces, they are
    /// copied corner by corner. Otherwise they are assigned by vertex number, which needs one coordinate per vertex.
    /// An example is a file of this mesh with split edges.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] if the other file has no texture coordinates, some corners have none, or a vertex has several
    /// or none.
    pub fn texture_of(&self, other: &Self) -> Result<Texture, LayoutError> {
        let [own, theirs] = [&self.polygons, &other.polygons];
        if own.corners == theirs.corners && own.starts == theirs.starts {
            return Ok(other.complete_texture()?.clone());
        }
        let texture = other.texture.as_ref().ok_or(TextureError::None)?;
        let mut found = vec![NO_TEXTURE; theirs.positions.len()];
        for (&vertex, &corner) in
            theirs.corners.iter().zip(&texture.corners).filter(|(_, corner)| **corner != NO_TEXTURE)
        {
            let before = std::mem::replace(&mut found[vertex.index()], corner);
            let [a, b] =
                [before, corner].map(|corner| texture.coordinates.get(corner as usize).copied().map(coordinate_key));
            if a.is_some() && a != b {
                return Err(LayoutError::Torn { vertex });
            }
        }
        let of = |&vertex: &VertexId| {
            let corner = found.get(vertex.index()).copied().filter(|corner| *corner != NO_TEXTURE);
            corner.ok_or(LayoutError::NoVertex { vertex })
        };
        Ok(Texture {
            coordinates: texture.coordinates.clone(),
            corners: own.corners.iter().map(of).collect::<Result<_, _>>()?,
        })
    }

    /// Layout for given texture coordinates, such as those of another file; otherwise like [`layout`](Self::layout).
    ///
    /// # Errors
    ///
    /// [`LayoutError`], like [`layout`](Self::layout).
    pub fn layout_by(
        &self,
        texture: &Texture,
        repaired: Option<&Repaired>,
        mesh: &TriMesh,
    ) -> Result<Embedding, LayoutError> {
        let polygons = repaired.map_or(&self.polygons, Repaired::polygons);
        let mut found: Vec<Option<DVec2>> = vec![None; mesh.vertex_count()];
        for (corner, vertex) in polygons.corners.iter().enumerate() {
            let of = repaired.map_or(corner, |repaired| repaired.corner_of(corner));
            let Some(&uv) = texture.coordinates.get(texture.corners[of] as usize) else {
                self.complete_texture()?;
                continue;
            };
            if found[vertex.index()].replace(uv).is_some_and(|other| coordinate_key(other) != coordinate_key(uv)) {
                return Err(LayoutError::Torn { vertex: self.polygons.corners[of] });
            }
        }
        for hole in mesh.holes() {
            let rim: Vec<DVec2> = hole.rim.iter().filter_map(|vertex| found[vertex.index()]).collect();
            let middle = rim.iter().sum::<DVec2>() / rim.len().max(1) as f64;
            for vertex in mesh.triangles[hole.faces].iter().flatten() {
                found[vertex.index()].get_or_insert(middle);
            }
        }
        Ok(found.into_iter().map(Option::unwrap_or_default).collect())
    }
}
