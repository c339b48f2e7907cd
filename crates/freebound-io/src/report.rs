//! The report: one JSON object per run.

use std::io::{self, Write};

use serde::Serialize;

use super::{Precision, RoundingReport, StepReport, peak_memory_bytes};
use freebound_core::mesh::{DiskMesh, Done, FaceId, Part, TriMesh, VertexId};
use freebound_core::pipeline::{PackingSummary, PinsSummary, Placement};
use freebound_core::problem::{BoundaryShape, Family, Method, Settings, Spacing};
use freebound_core::verify::{AtlasVerdict, DistortionSummary, Verdict};

/// Version of the form of reports, which `docs/report.schema.json` describes. It counts up where a field goes or changes
/// its meaning, not where one comes.
pub const REPORT_SCHEMA: u32 = 2;

/// Everything that is reported of a run. Field names are part of the interface.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// Version of the report's form.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// The input.
    pub mesh: MeshReport,
    /// Method; absent where texture coordinates were only checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
    /// Family, where the method has a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// Where the layout comes from that the run started from: `uv`, the texture coordinates of its own file, or the path of another;
    /// absent where it started from the surface alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Pinned vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pins: Option<PinsSummary>,
    /// Whether the boundary is free, or convex: laid on a convex shape, or bent to one to make it simple.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<&'static str>,
    /// The convex shape that a boundary, or the padding around it, was laid on; absent where the method lays none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<ShapeReport>,
    /// Where the coordinates lie.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// How many bits the coordinates have as written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<Precision>,
    /// What rounding to 32 bits did; absent where there are 64.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounding: Option<RoundingReport>,
    /// Each step of each stage.
    pub steps: Vec<StepReport>,
    /// The exact verdict on the coordinates as written; absent where there are none, as the distortion is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// The exact verdict on a layout of several charts, or of one with holes, in place of the verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub atlas: Option<AtlasVerdict>,
    /// Each chart, in the order of the verdict on them all; absent where there is one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub charts: Vec<ChartReport>,
    /// How charts are packed; absent where none are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingSummary>,
    /// Distortion summed up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distortion: Option<DistortionSummary>,
    /// Vertices that the mesh did not have before.
    pub new_vertices: usize,
    /// The edges that they lie on, by their ends.
    pub split_edges: Vec<[VertexId; 2]>,
    /// Polygons that the output has as triangles, by their numbers in the file.
    pub cut_polygons: Vec<FaceId>,
    /// Where the time went.
    pub seconds: Seconds,
    /// Most memory that the process held, where the system tells.
    pub peak_memory_bytes: Option<u64>,
}

impl Report {
    /// A report on a mesh alone.
    pub fn of_mesh(mesh: MeshReport) -> Self {
        Self {
            schema: REPORT_SCHEMA,
            freebound: env!("CARGO_PKG_VERSION"),
            mesh,
            peak_memory_bytes: peak_memory_bytes(),
            ..Self::default()
        }
    }
}

/// Writes a report, as JSON that a person can read.
///
/// # Errors
///
/// What `out` says.
pub fn write_report(out: &mut impl Write, report: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, report)?;
    writeln!(out)
}

/// A convex shape, and what lies on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeReport {
    /// The shape.
    pub outline: BoundaryShape,
    /// How far apart vertices lie on it.
    pub spacing: Spacing,
    /// Layers of virtual triangles between the boundary and the shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layers: Option<usize>,
}

impl ShapeReport {
    /// That of these settings, where their method lays a boundary on a shape.
    pub fn of(settings: &Settings) -> Option<Self> {
        let layers = settings.method.is_padded().then_some(settings.layers);
        settings.method.boundary_shape().cloned().map(|outline| Self { outline, spacing: settings.spacing, layers })
    }
}

/// The input mesh.
#[derive(Debug, Default, Serialize)]
pub struct MeshReport {
    /// Where it came from.
    pub path: String,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub faces: usize,
    /// Vertices of the boundary loop.
    pub boundary_vertices: usize,
    /// Interior edges that join two boundary vertices.
    pub dividing_edges: usize,
    /// Triangles with two boundary edges.
    pub ears: usize,
    /// Vertices of no face.
    pub unused_vertices: usize,
    /// By how much every length was taken longer, where faces have no area; 0 where all have one. In the mesh's units.
    pub mollification: f64,
    /// What was repaired, in order.
    pub repairs: Vec<Done>,
}

impl MeshReport {
    /// Describes a mesh that came from `path`.
    pub fn new(path: String, mesh: &DiskMesh) -> Self {
        Self {
            path,
            vertices: mesh.real_vertex_count(),
            faces: mesh.mesh().real_face_count(),
            boundary_vertices: mesh.boundary_loop().len(),
            dividing_edges: mesh.dividing_edges().len(),
            ears: mesh.ears().len(),
            unused_vertices: mesh.vertex_count() - mesh.used_vertex_count(),
            mollification: mesh.mollification() * mesh.unit(),
            repairs: Vec::new(),
        }
    }
}

impl MeshReport {
    /// Describes a mesh of so many vertices that came from `path`, by its charts.
    pub fn of_disks<'a>(path: String, vertices: usize, charts: impl Iterator<Item = &'a DiskMesh>) -> Self {
        let mut whole = Self { path, vertices, unused_vertices: vertices, ..Self::default() };
        for chart in charts.map(|mesh| Self::new(String::new(), mesh)) {
            whole.faces += chart.faces;
            whole.boundary_vertices += chart.boundary_vertices;
            whole.dividing_edges += chart.dividing_edges;
            whole.ears += chart.ears;
            whole.unused_vertices -= chart.vertices - chart.unused_vertices;
            whole.mollification = whole.mollification.max(chart.mollification);
        }
        whole
    }

    /// Describes a layout of charts that came from `path`, over so many vertices.
    pub fn of_charts(path: String, vertices: usize, charts: &[Part]) -> Self {
        let loops = || charts.iter().flat_map(Part::loops);
        Self {
            path,
            vertices,
            faces: charts.iter().map(|chart| chart.mesh().face_count()).sum(),
            boundary_vertices: loops().map(Vec::len).sum(),
            ..Self::default()
        }
    }
}

/// One chart of several. Vertices are those of the mesh.
#[derive(Debug, Serialize)]
pub struct ChartReport {
    /// Its first face.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Pinned vertices.
    pub pins: PinsSummary,
    /// Whether the boundary is free, or convex.
    pub boundary: &'static str,
    /// Where the coordinates lie.
    pub placement: Placement,
    /// Each step of each stage.
    pub steps: Vec<StepReport>,
    /// Distortion summed up.
    pub distortion: DistortionSummary,
    /// Pixels of the picture that it is packed into, or held on, per unit of length on the surface, in the mean.
    pub density: f64,
    /// Vertices that it did not have before.
    pub new_vertices: usize,
}

/// Seconds by phase of a run.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading and diagnosing the mesh.
    pub read: f64,
    /// Solving.
    pub solve: f64,
    /// Verdict and distortion.
    pub verify: f64,
    /// Writing the results, the report excepted.
    pub write: f64,
    /// From the start to the report.
    pub total: f64,
}

/// The verdict with faces numbered as the file numbers them: a polygon is at fault where one of its triangles is.
pub fn verdict_as_in_file(verdict: &Verdict, mesh: &TriMesh) -> Verdict {
    let in_file = |faces: &[FaceId]| {
        let mut polygons: Vec<FaceId> = faces.iter().map(|&face| FaceId::new(mesh.polygon(face))).collect();
        polygons.dedup();
        polygons
    };
    let (flipped_faces, concave_polygons) = (in_file(&verdict.flipped_faces), in_file(&verdict.concave_polygons));
    Verdict { flipped_faces, concave_polygons, ..verdict.clone() }
}
