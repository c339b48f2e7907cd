//! Texture coordinates of charts, assigned to the corners of one mesh file.

use std::borrow::Cow;
use std::collections::HashSet;

use super::{MeshFile, NO_TEXTURE, ProvedEmbedding, Refined, RefinedChart, Texture};
use freebound_core::mesh::{NewVertex, PolygonMesh, Repaired, VertexId};
use freebound_core::pipeline::LaidChart;
use freebound_core::problem::Embedding;

/// Chart with its verdict, at another embedding.
pub(crate) fn proved_at<'b>(chart: &'b LaidChart<'_>, embedding: &'b Embedding) -> ProvedEmbedding<'b> {
    ProvedEmbedding { mesh: chart.mesh, embedding, verdict: &chart.verdict }
}

fn refined<'b>(chart: &'b LaidChart<'_>) -> RefinedChart<'b> {
    RefinedChart { mesh: chart.mesh, refinement: chart.refinement, vertex_of: chart.vertex_of }
}

/// Mesh of a file with texture coordinates.
#[derive(Clone, Debug)]
pub struct TexturedMesh<'a> {
    /// Mesh of the file, with the new vertices if there are any.
    pub mesh: Cow<'a, MeshFile>,
    /// Texture coordinates, per corner.
    pub texture: Texture,
    /// New vertices, on edges of the file. Their numbers follow those of the file's vertices.
    pub new_vertices: Vec<NewVertex>,
    /// Face of the file that each face is, or is a part of. Absent if the faces are those of the file.
    pub face_of: Option<Vec<u32>>,
}

impl<'a> TexturedMesh<'a> {
    /// File without new vertices.
    fn of_file(source: &'a MeshFile, texture: Texture) -> Self {
        Self { mesh: Cow::Borrowed(source), texture, new_vertices: Vec::new(), face_of: None }
    }
}

/// Mesh of the file, with the new vertices if there are any, and the coordinates of its charts, per corner.
pub(crate) fn textured<'a>(
    charts: &[LaidChart<'_>],
    source: &'a MeshFile,
    repaired: Option<&Repaired>,
) -> TexturedMesh<'a> {
    if let ([LaidChart { refinement: None, coordinates, .. }], None) = (charts, repaired) {
        return TexturedMesh::of_file(source, Texture::per_vertex(&source.polygons, coordinates));
    }
    if let Some(repaired) = repaired.filter(|_| charts.iter().all(|chart| chart.refinement.is_none())) {
        let texture = texture_of_repaired(charts, &source.polygons, repaired);
        let left_out = repaired.left_out().iter().map(|&face| LeftOut { face: face as usize, in_file: face as usize });
        return TexturedMesh::of_file(source, beside_own(texture, source, &source.polygons, left_out));
    }
    let parts: Vec<RefinedChart<'_>> = charts.iter().map(refined).collect();
    let refined = Refined::of_charts(source, repaired, &parts);
    let coordinates: Embedding = charts.iter().flat_map(|chart| chart.coordinates.iter().copied()).collect();
    let texture = refined.texture(&coordinates);
    let left_out: HashSet<u32> = repaired.into_iter().flat_map(Repaired::left_out).copied().collect();
    let faces = refined.face_of.iter().enumerate().filter(|(_, of)| left_out.contains(of));
    let faces = faces.map(|(face, &of)| LeftOut { face, in_file: of as usize });
    let texture = beside_own(texture, source, &refined.mesh.polygons, faces);
    let (new_vertices, face_of) = (refined.new_vertices, Some(refined.face_of));
    TexturedMesh { mesh: Cow::Owned(refined.mesh), texture, new_vertices, face_of }
}

/// Face of a part that was left out: its number in the written mesh and in the file.
struct LeftOut {
    face: usize,
    in_file: usize,
}

/// Adds the new texture coordinates to the file's own ones, which the faces of left-out parts keep. The file's own
/// coordinates come first, so that they keep their numbers.
fn beside_own(
    new: Texture,
    source: &MeshFile,
    written: &PolygonMesh,
    left_out: impl Iterator<Item = LeftOut>,
) -> Texture {
    let mut left_out = left_out.peekable();
    let Some(own) = source.texture.as_ref().filter(|_| left_out.peek().is_some()) else { return new };
    let first = u32::try_from(own.coordinates.len()).expect("fewer than 2^32 coordinates");
    let moved = |&number: &u32| if number == NO_TEXTURE { NO_TEXTURE } else { number + first };
    let mut corners: Vec<u32> = new.corners.iter().map(moved).collect();
    for LeftOut { face, in_file } in left_out {
        corners[written.corner_range(face)].copy_from_slice(&own.corners[source.polygons.corner_range(in_file)]);
    }
    Texture { coordinates: [&own.coordinates[..], &new.coordinates].concat(), corners }
}

fn texture_of_repaired(charts: &[LaidChart<'_>], source: &PolygonMesh, repaired: &Repaired) -> Texture {
    if let [LaidChart { vertex_of: None, coordinates, .. }] = charts {
        return Texture::of_repaired(repaired, source, coordinates);
    }
    let mut numbers = vec![NO_TEXTURE; repaired.polygons().positions.len()];
    let mut coordinates = Vec::new();
    for chart in charts {
        for (vertex, uv) in chart.vertex_of.unwrap_or_default().iter().zip(&chart.coordinates) {
            numbers[vertex.index()] = VertexId::from_index(coordinates.len()).number();
            coordinates.push(*uv);
        }
    }
    let number = |vertex: Option<VertexId>| vertex.map_or(NO_TEXTURE, |vertex| numbers[vertex.index()]);
    let corners = repaired.vertices_at_corners(source).into_iter().map(number).collect();
    Texture { coordinates, corners }
}
