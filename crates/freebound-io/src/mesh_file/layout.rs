//! The layout of a file: its texture coordinates, or those of another file, as an embedding of the mesh, to go on from.

use glam::DVec2;

use super::texture::bits;
use super::{MeshFile, NO_TEXTURE, Texture, TextureError};
use freebound_core::mesh::{Repaired, TriMesh, VertexId};
use freebound_core::problem::Embedding;

/// Why the texture coordinates of a file are no embedding of its mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LayoutError {
    /// They are not all there.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// They are cut where the surface is not.
    #[error("vertex {vertex} has several texture coordinates, where the surface is not cut")]
    Torn {
        /// The first vertex that has several, as the file numbers it.
        vertex: VertexId,
    },
    /// The layout is that of another file, which has none for a vertex of the mesh.
    #[error("it has no texture coordinates for vertex {vertex} of the mesh")]
    NoVertex {
        /// The first vertex that has none, as the file of the mesh numbers it.
        vertex: VertexId,
    },
}

impl MeshFile {
    /// The texture coordinates, one per vertex of `mesh`, which are the file's triangles, or those of its repaired mesh or chart
    /// `repaired`. Vertices of no face lie at the origin, and what fills a hole around a vertex of its own has that in the middle
    /// of the loop.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] where there are no texture coordinates, not at all corners, or several at a vertex.
    pub fn layout(&self, repaired: Option<&Repaired>, mesh: &TriMesh) -> Result<Embedding, LayoutError> {
        self.layout_by(self.texture.as_ref().ok_or(TextureError::None)?, repaired, mesh)
    }

    /// The texture coordinates of another file for the corners of this one: corner by corner where both have the same faces;
    /// otherwise by the numbers of vertices, each of which has one, as in a file of the same mesh with split edges.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] where the other file has none, not at all corners, or several or none for a vertex.
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
            let [a, b] = [before, corner].map(|corner| texture.coordinates.get(corner as usize).copied().map(bits));
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

    /// As [`layout`](Self::layout), by texture coordinates that are those of another file for the corners of this one.
    ///
    /// # Errors
    ///
    /// As [`layout`](Self::layout).
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
            if found[vertex.index()].replace(uv).is_some_and(|other| bits(other) != bits(uv)) {
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
