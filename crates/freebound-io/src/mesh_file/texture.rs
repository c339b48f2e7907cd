//! Mesh over a file's texture coordinates: the surface as it is cut in the plane.

use std::collections::HashMap;

use glam::DVec2;

use super::{MeshFile, NO_TEXTURE, Texture, TextureError};
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_core::pipeline::LayoutSurface;
use freebound_core::problem::Embedding;

/// Mesh over texture vertices, with the embedding in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureMesh {
    /// Triangles over texture vertices, at their positions in space.
    pub mesh: TriMesh,
    /// Texture coordinates, one per texture vertex.
    pub embedding: Embedding,
    /// Vertex of the file for each texture vertex.
    pub vertex_of: Vec<VertexId>,
}

impl MeshFile {
    /// Merges all corners that share a vertex and a texture coordinate into one texture vertex.
    ///
    /// Coordinates are equal if their bits are, except that −0 equals 0. So charts are cut along seams, and copies of
    /// a coordinate are joined. Texture vertices are ordered by the file's vertices, and at one vertex by first use.
    /// Without seams, vertices thus keep their numbers.
    ///
    /// # Errors
    ///
    /// [`TextureError`] if there are no texture coordinates, or some corners have none.
    ///
    /// # Panics
    ///
    /// If an index of the mesh is out of range, which the readers exclude.
    pub fn texture_mesh(&self) -> Result<TextureMesh, TextureError> {
        Ok(self.texture_mesh_without(self.complete_texture()?, &[]))
    }

    /// Texture mesh of the faces that have coordinates at all corners, and the other faces.
    ///
    /// # Errors
    ///
    /// [`TextureError`] if no face has texture coordinates.
    pub fn partial_texture_mesh(&self) -> Result<(TextureMesh, Vec<u32>), TextureError> {
        let texture = self.texture.as_ref().ok_or(TextureError::None)?;
        let bare = self.bare_faces(texture);
        if bare.len() == self.polygons.face_count() {
            return Err(TextureError::Missing(bare));
        }
        Ok((self.texture_mesh_without(texture, &bare), bare))
    }

    /// Texture mesh without the faces `bare`, ascending: all others have coordinates at all corners.
    fn texture_mesh_without(&self, texture: &Texture, bare: &[u32]) -> TextureMesh {
        let corners = &self.polygons.corners;
        let mut has_place = vec![true; corners.len()];
        for &face in bare {
            has_place[self.polygons.corner_range(face as usize)].fill(false);
        }
        let coordinate = |place: u32| texture.coordinates[texture.corners[place as usize] as usize];
        let bits = |place: u32| coordinate_key(coordinate(place));
        let mut texture_vertex = vec![0_u32; corners.len()];
        let (mut positions, mut vertex_of, mut embedding) = (Vec::new(), Vec::new(), Vec::new());
        let mut first_places: Vec<u32> = Vec::new();
        // Corners of each vertex; vertices without corners have none.
        let mut places_of = vec![Vec::new(); self.polygons.positions.len()];
        for (place, vertex) in (0_u32..).zip(corners).filter(|(place, _)| has_place[*place as usize]) {
            places_of[vertex.index()].push(place);
        }
        for places in &mut places_of {
            // Sort by coordinate first, so that equal ones are adjacent, then order the groups by their first corner.
            places.sort_unstable_by_key(|&place| (bits(place), place));
            first_places.clear();
            first_places.extend(places.chunk_by(|&a, &b| bits(a) == bits(b)).map(|group| group[0]));
            first_places.sort_unstable();
            for group in places.chunk_by(|&a, &b| bits(a) == bits(b)) {
                let rank = first_places.binary_search(&group[0]).expect("every group has a first place");
                for &place in group {
                    texture_vertex[place as usize] = VertexId::from_index(vertex_of.len() + rank).number();
                }
            }
            for &place in &first_places {
                let vertex = corners[place as usize];
                vertex_of.push(vertex);
                embedding.push(coordinate(place));
                positions.push(self.polygons.positions[vertex.index()]);
            }
        }
        let (triangles, polygon_of) = self.polygons.triangle_places();
        let renumbered = |places: &[u32; 3]| places.map(|place| VertexId::new(texture_vertex[place as usize]));
        let stays = |places: &[u32; 3]| has_place[places[0] as usize];
        let polygon = |face: usize| polygon_of.as_ref().map_or(face, |of| of[face] as usize);
        let kept = || triangles.iter().enumerate().filter(|(_, places)| stays(places));
        let number = |(face, _): (usize, &[u32; 3])| VertexId::from_index(polygon(face)).number();
        let polygon_of = (polygon_of.is_some() || !bare.is_empty()).then(|| kept().map(number).collect());
        let triangles = kept().map(|(_, places)| renumbered(places)).collect();
        TextureMesh { mesh: TriMesh { positions, triangles, polygon_of }, embedding: embedding.into(), vertex_of }
    }

    /// Label for each corner, equal for equal texture coordinates: the index of the first such coordinate in the
    /// file's list.
    ///
    /// # Errors
    ///
    /// [`TextureError`], like [`texture_mesh`](Self::texture_mesh).
    pub fn texture_labels(&self) -> Result<Vec<u32>, TextureError> {
        let texture = self.complete_texture()?;
        let mut first: HashMap<[u64; 2], u32> = HashMap::new();
        let labels: Vec<u32> = (0..)
            .zip(&texture.coordinates)
            .map(|(place, uv)| *first.entry(coordinate_key(*uv)).or_insert(place))
            .collect();
        Ok(texture.corners.iter().map(|&corner| labels[corner as usize]).collect())
    }

    /// True if some vertex has several texture coordinates.
    ///
    /// # Errors
    ///
    /// [`TextureError`], like [`texture_mesh`](Self::texture_mesh).
    pub fn has_texture_seams(&self) -> Result<bool, TextureError> {
        let mut first = vec![None; self.polygons.positions.len()];
        let labels = self.texture_labels()?;
        let mut corners = self.polygons.corners.iter().zip(labels);
        Ok(corners.any(|(vertex, label)| *first[vertex.index()].get_or_insert(label) != label))
    }

    /// Texture coordinates, if all corners have one.
    pub(crate) fn complete_texture(&self) -> Result<&Texture, TextureError> {
        let texture = self.texture.as_ref().ok_or(TextureError::None)?;
        let faces = self.bare_faces(texture);
        if faces.is_empty() { Ok(texture) } else { Err(TextureError::Missing(faces)) }
    }

    /// Faces with a corner without texture coordinates, ascending.
    fn bare_faces(&self, texture: &Texture) -> Vec<u32> {
        let lacks = |&face: &u32| {
            let places = self.polygons.corner_range(face as usize);
            texture.corners[places].contains(&NO_TEXTURE)
        };
        let face_count = u32::try_from(self.polygons.face_count()).expect("faces fit");
        (0..face_count).filter(lacks).collect()
    }
}

/// Key for the equality of coordinates: their bits, except that −0 equals 0.
pub(crate) fn coordinate_key(coordinate: DVec2) -> [u64; 2] {
    (coordinate + DVec2::ZERO).to_array().map(f64::to_bits)
}

impl TextureMesh {
    /// Layout and its surface.
    pub fn surface(&self) -> LayoutSurface<'_> {
        LayoutSurface { mesh: &self.mesh, coordinates: &self.embedding }
    }

    /// Removes triangles with two corners at exactly one point, both in space and in the plane. Such triangles arise
    /// if a polygon names a point twice by different vertices. They have no area in space or in the plane.
    pub fn drop_collapsed_faces(&mut self) {
        self.mesh = std::mem::take(&mut self.mesh).without_collapsed(&self.embedding);
    }
}
