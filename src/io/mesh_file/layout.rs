//! The layout of a file: its texture coordinates as an embedding of the mesh, to go on from.

use glam::DVec2;

use super::texture::bits;
use super::{MeshFile, TextureError};
use crate::mesh::{Repaired, TriMesh, VertexId};
use crate::solver::Embedding;

/// Why the texture coordinates of a file are no embedding of its mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
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
        let texture = self.texture.as_ref().ok_or(TextureError::None)?;
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
