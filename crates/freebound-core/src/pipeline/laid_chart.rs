//! Charts with final coordinates, and all of them joined to one proved mesh.

use std::collections::HashSet;

use crate::mesh::{DiskMesh, FaceId, Polygon, Refinement, TriMesh, VertexId, parts};
use crate::problem::Embedding;
use crate::verify::{AtlasVerdict, Verdict, atlas_verdict};

/// A chart with final coordinates. Most meshes have only one chart.
#[derive(Debug)]
pub struct LaidChart<'a> {
    /// Mesh of the coordinates: the chart as given, or its refinement.
    pub mesh: &'a DiskMesh,
    /// Refinement with the new vertices, if there are any.
    pub refinement: Option<&'a Refinement>,
    /// Number of each vertex of the chart in the repaired mesh. Absent if the mesh has only one chart.
    pub vertex_of: Option<&'a [VertexId]>,
    /// Texture coordinate of each vertex, v up.
    pub coordinates: Embedding,
    /// Verdict on these coordinates.
    pub verdict: Verdict,
    /// Vertices with hard pins.
    pub held: Vec<VertexId>,
}

/// Charts joined to one mesh. Vertices and faces of each chart follow those of the chart before.
#[derive(Debug)]
pub struct JoinedCharts {
    /// Positions and triangles. Faces keep their numbers in the file.
    pub mesh: TriMesh,
    /// Texture coordinate of each vertex.
    pub coordinates: Embedding,
    /// Faces that the verdict of their chart lists as flipped.
    pub flipped: Vec<FaceId>,
}

/// Joins charts to one mesh, without the virtual faces and vertices that fill their holes.
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

/// Verdict on the joined charts, with faces numbered as in the file.
///
/// # Panics
///
/// If the joined charts have faults. Charts of disks have none.
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
