//! Charts with final coordinates, and all of them joined to one proved mesh.

use std::collections::{BTreeMap, HashSet};

use super::StackedChart;
use crate::mesh::{DiskMesh, FaceId, Part, Polygon, Refinement, TriMesh, VertexId, parts};
use crate::parallel::prelude::*;
use crate::problem::Embedding;
use crate::verify::{AtlasVerdict, ChartRelations, Verdict, stacked_atlas_verdict, verdict};

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
    /// Place on another chart. Absent for a chart with a place of its own.
    pub stacked: Option<StackedChart>,
    /// Group of the chart: it may overlap charts of other groups. Absent if it overlaps no other chart.
    pub group: Option<u32>,
}

impl<'a> LaidChart<'a> {
    /// Only chart of a mesh, with a place of its own.
    pub fn only(mesh: &'a DiskMesh, coordinates: Embedding, verdict: Verdict, held: Vec<VertexId>) -> Self {
        Self { mesh, refinement: None, vertex_of: None, coordinates, verdict, held, stacked: None, group: None }
    }
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

/// Lays every stacked chart on its representative again, and proves it there. Needed after coordinates change.
///
/// # Panics
///
/// If a chart is stacked on one that is not in the list.
pub fn restack(charts: &mut [LaidChart<'_>]) {
    let on = |chart: &LaidChart<'_>| {
        let stacked = chart.stacked.as_ref()?;
        Some(stacked.coordinates(&charts[stacked.on.chart].coordinates))
    };
    let coordinates: Vec<Option<Embedding>> = charts.iter().map(on).collect();
    charts.par_iter_mut().zip(coordinates).for_each(|(chart, coordinates)| {
        if let Some(coordinates) = coordinates {
            chart.verdict = verdict(chart.mesh, &coordinates);
            chart.coordinates = coordinates;
        }
    });
}

/// Verdict on the joined charts, with faces numbered as in the file. Charts that are stacked on purpose may overlap.
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
    let face_counts = charts.iter().map(|chart| chart.mesh.mesh().real_face_count()).enumerate();
    let charts_of_faces: Vec<usize> =
        face_counts.flat_map(|(chart, faces)| std::iter::repeat_n(chart, faces)).collect();
    let on = |chart: usize| Some(charts[chart].stacked.as_ref()?.on.chart);
    let chart_of_face = |face: FaceId| charts_of_faces[face.index()];
    let stacked_on = stacked_parts(&parts, chart_of_face, on);
    let groups = parts.iter().map(|part| charts[chart_of_face(part.face_of()[0])].group).collect();
    stacked_atlas_verdict(&parts, &coordinates, &ChartRelations { stacked_on, groups }).as_in_file(&mesh)
}

/// Part whose place each part shares on purpose. `chart_of_face` is the chart of each triangle, and `on` is the chart
/// whose place a chart shares.
pub(super) fn stacked_parts(
    parts: &[Part],
    chart_of_face: impl Fn(FaceId) -> usize,
    on: impl Fn(usize) -> Option<usize>,
) -> Vec<Option<usize>> {
    let chart_of = |part: &Part| chart_of_face(part.face_of()[0]);
    let mut part_of = BTreeMap::new();
    for (number, part) in parts.iter().enumerate() {
        part_of.entry(chart_of(part)).or_insert(number);
    }
    parts.iter().map(|part| part_of.get(&on(chart_of(part))?).copied()).collect()
}
