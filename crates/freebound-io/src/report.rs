//! Report of a run: one JSON object.

use std::io::{self, Write};

use serde::Serialize;

use super::bake::FAR_APART;
use super::file_data::FileData;
use super::{BakeReport, CarryReport, MeshFile, Precision, ReadWarning, RoundingReport, StepReport, peak_memory_bytes};
use freebound_core::mesh::{DiskMesh, Done, FaceId, Part, TriMesh, VertexId};
use freebound_core::pipeline::{
    AutomaticSeams, PackingSummary, PinsSummary, Placement, PreparedMesh, RepackedChart, StackedOn,
};
use freebound_core::problem::{BoundaryShape, Family, Method, Settings, Spacing};
use freebound_core::verify::{AtlasVerdict, DistortionSummary, LayoutVerdict, Verdict};

/// Version of the report format, which `docs/report.schema.json` describes. Incremented if a field is removed or
/// changes its meaning, not if a field is added.
pub const REPORT_SCHEMA: u32 = 2;

/// Report of a run. Field names are part of the interface.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Version of the report format.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// Input mesh.
    pub mesh: MeshReport,
    /// Method; absent if texture coordinates were only checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
    /// Weight family, if the method has a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// Origin of the layout that the run started from: `uv` for the texture coordinates of the input file, or the
    /// path of another file. Absent if the run started from the surface alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Pinned vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pins: Option<PinsSummary>,
    /// Kind of the boundary: `free`, or `convex` if it was laid on a convex shape or bent to one to make it simple.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<&'static str>,
    /// Convex shape that the boundary, or the padding around it, was laid on; absent if the method uses none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<ShapeReport>,
    /// Position of the coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// Bits of the written coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<Precision>,
    /// Effect of rounding to 32 bits; absent for 64 bits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounding: Option<RoundingReport>,
    /// Data of the file that the written meshes do not hold.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_kept: Vec<FileData>,
    /// Steps of all stages.
    pub steps: Vec<StepReport>,
    /// Index of the written step. Absent if it is the last one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written_step: Option<usize>,
    /// Exact verdict on the written coordinates. Absent without coordinates, as is the distortion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// Exact verdict on a layout of several charts, or of one chart with holes. Replaces `verdict`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub atlas: Option<AtlasVerdict>,
    /// Verdict on a given layout, with findings. Decides the exit status of `check`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layout: Option<LayoutVerdict>,
    /// Correspondence between the meshes of a copied layout; absent if no layout was copied.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer: Option<TransferReport>,
    /// Picture that was drawn for another layout; absent if none was drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baked: Option<BakeReport>,
    /// Constraints that were carried to another mesh; absent if none were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<CarryReport>,
    /// Automatic seams; absent if none were looked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seams: Option<SeamsReport>,
    /// Charts, in the order of the verdict on all of them; absent for a single chart that is not packed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub charts: Vec<ChartReport>,
    /// Charts of a given layout at their new places, in the order of their first faces; absent if it was not packed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub packed_charts: Vec<RepackedChart>,
    /// Packing of the charts; absent if none are packed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingSummary>,
    /// Summary of the distortion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distortion: Option<DistortionSummary>,
    /// Number of vertices added to the mesh.
    pub new_vertices: usize,
    /// Edges that the new vertices lie on, by their end vertices.
    pub split_edges: Vec<[VertexId; 2]>,
    /// Polygons that were split into triangles in the output, by their numbers in the file.
    pub cut_polygons: Vec<FaceId>,
    /// Time by phase.
    pub seconds: Seconds,
    /// Peak memory of the process, if the system tells.
    pub peak_memory_bytes: Option<u64>,
}

impl Report {
    /// Report on a mesh alone.
    pub fn of_mesh(mesh: MeshReport) -> Self {
        Self {
            schema: REPORT_SCHEMA,
            freebound: env!("CARGO_PKG_VERSION"),
            mesh,
            peak_memory_bytes: peak_memory_bytes(),
            ..Self::default()
        }
    }

    /// Vertices with hard pins that are not at their targets, of all charts.
    pub fn unmet_pins(&self) -> Vec<VertexId> {
        let of_charts = self.charts.iter().map(|chart| &chart.pins);
        self.pins.iter().chain(of_charts).flat_map(|pins| pins.unmet.iter().copied()).collect()
    }

    /// True if all hard pins are at their targets, and charts have the density that was asked for.
    pub fn meets_request(&self) -> bool {
        self.unmet_pins().is_empty() && self.packing.is_none_or(|packing| packing.unmet_density().is_none())
    }
}

/// Automatic seams of a mesh.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SeamsReport {
    /// Length of the seams, in units of the mesh.
    pub length: f64,
    /// Length of the seams relative to the root of the area.
    pub relative_length: f64,
    /// Bound on the mean symmetric Dirichlet energy of each part.
    pub bound: f64,
}

impl SeamsReport {
    /// Report on seams.
    pub fn of(seams: &AutomaticSeams) -> Self {
        Self { length: seams.length, relative_length: seams.relative_length(), bound: seams.bound }
    }
}

/// Mean distance from which surfaces of different sizes lie apart, relative to the diagonal.
const FAR_IF_SIZES_DIFFER: f64 = 0.01;

/// Largest ratio of the diagonals of surfaces of one size.
const ONE_SIZE: f64 = 1.25;

/// Correspondence between the two meshes of a copied layout.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "by", rename_all = "kebab-case")]
pub enum TransferReport {
    /// The meshes have equal faces: coordinates are copied corner by corner.
    Corners,
    /// Nearest points of the surfaces.
    NearestPoints {
        /// Largest distance of a vertex to the surface of the layout, mesh units.
        largest_distance: f64,
        /// Mean distance of the vertices to the surface of the layout, mesh units.
        mean_distance: f64,
        /// Diagonal of the box around the surface of the layout, mesh units.
        diagonal: f64,
        /// Diagonal of the box around the mesh, mesh units.
        mesh_diagonal: f64,
    },
}

impl TransferReport {
    /// True if the two surfaces lie apart, in other places or sizes: on average by more than 5 % of the diagonal, or by
    /// more than 1 % if their sizes differ by a quarter. A part of a surface is smaller than it, and lies on it.
    pub fn is_apart(&self) -> bool {
        match *self {
            Self::Corners => false,
            Self::NearestPoints { mean_distance, diagonal, mesh_diagonal, .. } => {
                let have_one_size = mesh_diagonal <= ONE_SIZE * diagonal && diagonal <= ONE_SIZE * mesh_diagonal;
                mean_distance > if have_one_size { FAR_APART } else { FAR_IF_SIZES_DIFFER } * diagonal
            }
        }
    }
}

/// Writes a report as indented JSON.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_report(out: &mut impl Write, report: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, report)?;
    writeln!(out)
}

/// Convex shape of a boundary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeReport {
    /// Outline of the shape.
    pub outline: BoundaryShape,
    /// Spacing of the vertices on the outline.
    pub spacing: Spacing,
    /// Layers of virtual triangles between the boundary and the shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layers: Option<usize>,
}

impl ShapeReport {
    /// Shape of a method that lays a boundary on one; `None` for other methods.
    pub fn of(settings: &Settings) -> Option<Self> {
        let layers = settings.method.is_padded().then_some(settings.layers);
        settings.method.boundary_shape().cloned().map(|outline| Self { outline, spacing: settings.spacing, layers })
    }
}

/// Input mesh of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct MeshReport {
    /// Path or name of the mesh.
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
    /// Length added to every edge if faces have no area, in the mesh's units; 0 if all faces have area.
    pub mollification: f64,
    /// Repairs, in the order of their application.
    pub repairs: Vec<Done>,
    /// Faces without area that were left out, by their numbers in the file. All corners of such a face lie at one point
    /// of the map.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub degenerate_faces: Vec<u32>,
    /// Vertices at the position of a vertex of another part, with which they are not joined.
    #[serde(skip_serializing_if = "is_zero")]
    pub touching_vertices: usize,
    /// Elements of the file that were left out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<ReadWarning>,
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
            ..Self::default()
        }
    }

    /// Adds what was read and repaired.
    #[must_use]
    pub fn prepared(self, file: &MeshFile, prepared: &PreparedMesh) -> Self {
        let repaired = prepared.whole_repaired();
        Self {
            repairs: repaired.map(|repaired| repaired.done().to_vec()).unwrap_or_default(),
            degenerate_faces: repaired.map(|repaired| repaired.degenerate_faces().to_vec()).unwrap_or_default(),
            touching_vertices: prepared.touching_vertices,
            warnings: file.warnings.clone(),
            ..self
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl MeshReport {
    /// Describes a mesh of `vertices` vertices that came from `path`, by its charts.
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

    /// Describes a layout of charts over `vertices` vertices that came from `path`.
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

/// Chart of a mesh with several. Vertices are numbered by the mesh.
#[derive(Clone, Debug, Serialize)]
pub struct ChartReport {
    /// First face of the chart.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Pinned vertices.
    pub pins: PinsSummary,
    /// Kind of the boundary: `free` or `convex`.
    pub boundary: &'static str,
    /// Position of the coordinates.
    pub placement: Placement,
    /// Steps of all stages.
    pub steps: Vec<StepReport>,
    /// Index of the written step. Absent if it is the last one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written_step: Option<usize>,
    /// Summary of the distortion.
    pub distortion: DistortionSummary,
    /// Pixels per unit of length on the surface, on average, of the picture that the chart is packed into or pinned
    /// to.
    pub density: f64,
    /// UDIM number of the tile that holds the chart, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tile: Option<u32>,
    /// Number of vertices added to the chart.
    pub new_vertices: usize,
    /// Chart whose place this chart shares. Absent for a chart with a place of its own.
    #[serde(flatten)]
    pub stacked: Option<StackedOn>,
}

/// Seconds of a run, by phase.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading and diagnosing the mesh.
    pub read: f64,
    /// Search for automatic seams.
    pub cut: f64,
    /// Solving.
    pub solve: f64,
    /// Verdict and distortion.
    pub verify: f64,
    /// Writing the results, except for the report.
    pub write: f64,
    /// Time from the start of the run to the report.
    pub total: f64,
}

/// Verdict with faces numbered as in the file: a polygon is listed if one of its triangles is.
pub fn verdict_as_in_file(verdict: &Verdict, mesh: &TriMesh) -> Verdict {
    let in_file = |faces: &[FaceId]| {
        let mut polygons: Vec<FaceId> = faces.iter().map(|&face| FaceId::new(mesh.polygon(face))).collect();
        polygons.dedup();
        polygons
    };
    let (flipped_faces, concave_polygons) = (in_file(&verdict.flipped_faces), in_file(&verdict.concave_polygons));
    Verdict { flipped_faces, concave_polygons, ..verdict.clone() }
}
