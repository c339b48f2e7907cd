//! Charts with their final coordinates: each by itself, and all of them as one proved mesh.

use std::collections::HashSet;

use crate::mesh::{DiskMesh, FaceId, Polygon, Refinement, TriMesh, VertexId, parts};
use crate::problem::Embedding;
use crate::verify::{AtlasVerdict, Verdict, atlas_verdict};

/// A chart with its final coordinates. Most meshes have only one.
#[derive(Debug)]
pub struct LaidChart<'a> {
    /// Mesh of the coordinates: the chart as given, or its refinement.
    pub mesh: &'a DiskMesh,
    /// Refinement with the new vertices, if there are any.
    pub refinement: Option<&'a Refinement>,
    /// Vertex of the repaired mesh that each own vertex is. Absent if the mesh has only one chart.
    pub vertex_of: Option<&'a [VertexId]>,
    /// One texture coordinate per vertex, v up.
    pub coordinates: Embedding,
    /// The verdict on these coordinates.
    pub verdict: Verdict,
    /// Vertices that pins hold exactly.
    pub held: Vec<VertexId>,
}

/// Charts as one mesh: the vertices of each follow those of the one before, and so do the faces.
#[derive(Debug)]
pub struct JoinedCharts {
    /// Positions and triangles; faces keep their numbers in the file.
    pub mesh: TriMesh,
    /// One texture coordinate per vertex.
    pub coordinates: Embedding,
    /// Faces that their charts' verdicts call flipped.
    pub flipped: Vec<FaceId>,
}

/// Charts as one mesh, without what fills their holes.
pub fn joined(charts: &[LaidChart<'_>]) -> JoinedCharts {
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
    JoinedCharts { mesh, coordinates: coordinates.into(), flipped }
}

/// The verdict on charts as they are written, faces as the file numbers them.
///
/// # Panics
///
/// If a chart is no disk, which none is.
pub fn prove_atlas(charts: &[LaidChart<'_>]) -> AtlasVerdict {
    let JoinedCharts { mesh, coordinates, .. } = joined(charts);
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
