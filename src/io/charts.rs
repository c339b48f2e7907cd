//! The charts of a result: each as it is written, and all of them as one mesh with its texture coordinates.

use std::borrow::Cow;
use std::collections::HashSet;

use super::{MeshFile, NO_TEXTURE, ProvedEmbedding, Refined, RefinedChart, Texture};
use crate::mesh::{DiskMesh, FaceId, Polygon, PolygonMesh, Refinement, Repaired, TriMesh, VertexId, parts};
use crate::solver::{AtlasVerdict, Embedding, Verdict, atlas_verdict};

/// A chart as it is written; the only one, as a rule.
#[derive(Debug)]
pub struct OutputChart<'a> {
    /// The mesh that the coordinates are of: its triangles, or the refinement's.
    pub mesh: &'a DiskMesh,
    /// The mesh with its new vertices, where there are any.
    pub refinement: Option<&'a Refinement>,
    /// The vertex of the repaired mesh that each of its own is, where the mesh has several charts.
    pub vertex_of: Option<&'a [VertexId]>,
    /// One texture coordinate per vertex, v up.
    pub coordinates: Embedding,
    /// The verdict on these coordinates.
    pub verdict: Verdict,
    /// Vertices that pins hold exactly.
    pub held: Vec<VertexId>,
}

impl OutputChart<'_> {
    /// The chart with its verdict, laid elsewhere.
    pub(super) fn laid<'b>(&'b self, embedding: &'b Embedding) -> ProvedEmbedding<'b> {
        ProvedEmbedding { mesh: self.mesh, embedding, verdict: &self.verdict }
    }

    fn refined(&self) -> RefinedChart<'_> {
        RefinedChart { mesh: self.mesh, refinement: self.refinement, vertex_of: self.vertex_of }
    }
}

/// Charts as one mesh: the vertices of each follow those of the one before, and so do the faces.
#[derive(Debug)]
pub struct Together {
    /// Positions and triangles; faces keep their numbers in the file.
    pub mesh: TriMesh,
    /// One texture coordinate per vertex.
    pub coordinates: Embedding,
    /// Faces that their charts' verdicts call flipped.
    pub flipped: Vec<FaceId>,
}

/// Charts as one mesh, without what fills their holes.
pub fn together(charts: &[OutputChart<'_>]) -> Together {
    let (mut mesh, mut polygon_of) = (TriMesh::default(), Vec::new());
    let (mut coordinates, mut flipped) = (Vec::new(), Vec::new());
    for chart in charts {
        let (own, faces) = (chart.mesh.mesh(), mesh.triangles.len());
        let mut number_of = vec![VertexId::default(); own.vertex_count()];
        let mut hidden = chart.mesh.virtual_vertices().into_iter().peekable();
        for vertex in chart.mesh.vertices() {
            if hidden.next_if_eq(&vertex).is_none() {
                number_of[vertex.index()] = VertexId::from_index(mesh.positions.len());
                mesh.positions.push(own.positions[vertex.index()]);
                coordinates.push(chart.coordinates[vertex]);
            }
        }
        let moved = |vertex: VertexId| number_of[vertex.index()];
        mesh.triangles.extend(own.real_triangles().iter().map(|corners| corners.map(moved)));
        polygon_of.extend(chart.mesh.real_faces().map(|face| own.polygon(face)));
        flipped.extend(chart.verdict.flipped_faces.iter().map(|face| FaceId::from_index(faces + face.index())));
    }
    mesh.polygon_of = Some(polygon_of);
    Together { mesh, coordinates: coordinates.into(), flipped }
}

/// The verdict on charts as they are written, faces as the file numbers them.
///
/// # Panics
///
/// If a chart is no disk, which none is.
pub fn proved_together(charts: &[OutputChart<'_>]) -> AtlasVerdict {
    let Together { mesh, coordinates, .. } = together(charts);
    let mut parts = parts(&mesh).expect("charts are disks");
    // Polygons that are written as triangles may be concave.
    let whole = charts.iter().flat_map(|chart| {
        let number = |polygon: Polygon<'_>| chart.mesh.mesh().polygon(polygon.first_face);
        chart.mesh.polygons().map(number)
    });
    let whole: HashSet<u32> = whole.collect();
    for part in &mut parts {
        part.keep_polygons(&whole);
    }
    atlas_verdict(&parts, &coordinates).as_in_file(&mesh)
}

/// The file's mesh, with the new vertices where there are any, and the coordinates of charts as those of its corners.
pub(super) fn textured<'a>(
    charts: &[OutputChart<'_>],
    source: &'a MeshFile,
    repaired: Option<&Repaired>,
) -> (Cow<'a, MeshFile>, Texture) {
    if let ([OutputChart { refinement: None, coordinates, .. }], None) = (charts, repaired) {
        return (Cow::Borrowed(source), Texture::per_vertex(&source.polygons, coordinates));
    }
    if let Some(repaired) = repaired.filter(|_| charts.iter().all(|chart| chart.refinement.is_none())) {
        let texture = texture_of_repaired(charts, &source.polygons, repaired);
        let left_out = repaired.left_out().iter().map(|&face| LeftOut { face: face as usize, in_file: face as usize });
        return (Cow::Borrowed(source), beside_own(texture, source, &source.polygons, left_out));
    }
    let parts: Vec<RefinedChart<'_>> = charts.iter().map(OutputChart::refined).collect();
    let refined = Refined::of_charts(source, repaired, &parts);
    let coordinates: Embedding = charts.iter().flat_map(|chart| chart.coordinates.iter().copied()).collect();
    let texture = refined.texture(&coordinates);
    let left_out: HashSet<u32> = repaired.into_iter().flat_map(Repaired::left_out).copied().collect();
    let faces = refined.face_of.iter().enumerate().filter(|(_, of)| left_out.contains(of));
    let faces = faces.map(|(face, &of)| LeftOut { face, in_file: of as usize });
    let texture = beside_own(texture, source, &refined.mesh.polygons, faces);
    (Cow::Owned(refined.mesh), texture)
}

/// A face of a part that was left out, as it is written and as the file has it.
struct LeftOut {
    face: usize,
    in_file: usize,
}

/// Texture coordinates beside those that faces of parts that were left out have in their file. These come first, so that they
/// keep their numbers.
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

fn texture_of_repaired(charts: &[OutputChart<'_>], source: &PolygonMesh, repaired: &Repaired) -> Texture {
    if let [OutputChart { vertex_of: None, coordinates, .. }] = charts {
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
