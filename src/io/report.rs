//! The report: one JSON object per run.

use std::io::{self, Write};

use serde::Serialize;

use crate::mesh::{DiskMesh, Done, FaceId, Part, TriMesh, VertexId};
use crate::solver::{AtlasVerdict, Choice as _, DistortionSummary, Family, Method, Step, Treatment, Verdict};

/// Version of the form of reports, which `docs/report.schema.json` describes. It counts up where a field goes or changes
/// its meaning, not where one comes.
pub const REPORT_SCHEMA: u32 = 1;

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
    /// Pinned vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pins: Option<PinsReport>,
    /// Whether the boundary is free, or convex: laid on a convex shape, or bent to one to make it simple.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<&'static str>,
    /// Where the coordinates lie.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// Each step of each rung.
    pub steps: Vec<StepReport>,
    /// The exact verdict on the coordinates as written; absent where there are none, as the distortion is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// The exact verdict on a layout of several charts, or of one with holes, in place of the verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub atlas: Option<AtlasVerdict>,
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

/// Where an embedding lies that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// On the user's pins.
    Pins,
    /// Within the picture.
    Picture,
    /// In the unit square.
    Unit,
    /// As large as the surface.
    True,
    /// Scaled by a power of two and not moved, because the numbers of the unit square would fold it.
    Unmoved,
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

/// The pins of a run.
#[derive(Debug, Serialize)]
pub struct PinsReport {
    /// How the pinned vertices' equations are treated in the step that is written.
    pub treatment: Treatment,
    /// Pins of the user's.
    pub count: usize,
    /// Largest distance of a pinned vertex from its target, in texture coordinates, as all errors here.
    pub max_error: f64,
    /// The same of those that are to be met exactly; absent where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_hard_error: Option<f64>,
    /// The same of those that pull by a weight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_weighted_error: Option<f64>,
    /// Vertices that are to be met exactly and are not.
    pub unmet: Vec<VertexId>,
    /// Each of those that pull by a weight.
    pub weighted: Vec<WeightedPinReport>,
}

/// A pin that pulls by a weight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeightedPinReport {
    /// The vertex.
    pub vertex: VertexId,
    /// How strongly it is pulled.
    pub weight: f64,
    /// Its distance from its target.
    pub error: f64,
}

/// One step of one rung.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepReport {
    /// The rung's method.
    pub rung: Method,
    /// Place in the run.
    pub index: usize,
    /// Flipped faces.
    pub flipped_faces: usize,
    /// Concave polygons.
    pub concave_polygons: usize,
    /// Holes that meet themselves or are turned inside out.
    pub crossed_holes: usize,
    /// Boundary crossings.
    pub boundary_crossings: usize,
    /// Overwound vertices.
    pub overwound_vertices: usize,
    /// Turning number of the boundary.
    pub turning_number: Option<i64>,
    /// Largest move of a vertex since the step before.
    pub max_move: Option<f64>,
    /// ‖Ax − b‖ / ‖b‖ of the linear solve; null where there is none, as in the next.
    pub residual: Option<f64>,
    /// ‖A z‖ of all vertex equations, pinned ones included, relative to the sum of their terms' sizes.
    pub equation_residual: Option<f64>,
    /// Pivots that were too small and replaced.
    pub replaced_pivots: usize,
    /// Degenerate corners whose weight was bounded.
    pub bounded_corners: usize,
    /// Boundary vertices that were bent to a convex polygon to make the boundary simple.
    pub bent_vertices: usize,
    /// Bytes of the matrix's factors.
    pub factor_bytes: usize,
    /// Seconds of the step.
    pub seconds: f64,
    /// Proved one-to-one.
    pub planar: bool,
    /// Mean energy of the faces' maps, 4 where nothing is distorted; null where it was not asked for, as the
    /// next two are.
    pub energy: Option<f64>,
    /// Smallest determinant of a face's map, at equal total areas.
    pub least_determinant: Option<f64>,
    /// Largest distance of an exact pin from its target, in the plane.
    pub distance_left: Option<f64>,
    /// Remark on the step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// A number as a cell of a table; empty where there is none.
fn cell(number: impl Into<Option<f64>>) -> String {
    number.into().filter(|number| number.is_finite()).map(|number| format!("{number:?}")).unwrap_or_default()
}

impl StepReport {
    /// The fields as a row of a table, each with the head of its column; empty where there is no value.
    pub fn row(&self) -> [(&'static str, String); 21] {
        [
            ("rung", self.rung.name().to_owned()),
            ("index", self.index.to_string()),
            ("flipped_faces", self.flipped_faces.to_string()),
            ("concave_polygons", self.concave_polygons.to_string()),
            ("crossed_holes", self.crossed_holes.to_string()),
            ("boundary_crossings", self.boundary_crossings.to_string()),
            ("overwound_vertices", self.overwound_vertices.to_string()),
            ("turning_number", self.turning_number.map(|turns| turns.to_string()).unwrap_or_default()),
            ("max_move", cell(self.max_move)),
            ("residual", cell(self.residual)),
            ("equation_residual", cell(self.equation_residual)),
            ("replaced_pivots", self.replaced_pivots.to_string()),
            ("bounded_corners", self.bounded_corners.to_string()),
            ("bent_vertices", self.bent_vertices.to_string()),
            ("factor_bytes", self.factor_bytes.to_string()),
            ("seconds", cell(self.seconds)),
            ("planar", self.planar.to_string()),
            ("energy", cell(self.energy)),
            ("least_determinant", cell(self.least_determinant)),
            ("distance_left", cell(self.distance_left)),
            ("note", self.note.clone().unwrap_or_default()),
        ]
    }

    /// The numbers of a step.
    pub fn of(step: &Step) -> Self {
        let (solution, verdict) = (&step.solution, &step.verdict);
        let counts = solution.linear.unwrap_or_default();
        Self {
            rung: step.rung,
            index: step.index,
            flipped_faces: verdict.flipped_faces.len(),
            concave_polygons: verdict.concave_polygons.len(),
            crossed_holes: verdict.crossed_holes.len(),
            boundary_crossings: verdict.boundary_crossings.len(),
            overwound_vertices: verdict.overwound_vertices.len(),
            turning_number: verdict.turning_number,
            max_move: step.max_move,
            residual: solution.linear.map(|linear| linear.residual),
            equation_residual: solution.linear.map(|linear| linear.equation_residual),
            replaced_pivots: counts.replaced_pivots,
            bounded_corners: counts.bounded_corners,
            bent_vertices: step.bent_vertices,
            factor_bytes: counts.factor_bytes,
            seconds: step.seconds(),
            planar: verdict.planar,
            energy: step.progress.map(|progress| progress.energy),
            least_determinant: step.progress.map(|progress| progress.least_determinant),
            distance_left: step.progress.map(|progress| progress.distance_left),
            note: step.note.clone(),
        }
    }

    /// Flipped faces, concave polygons, crossed holes, boundary crossings and overwound vertices together.
    pub fn defect_count(&self) -> usize {
        self.flipped_faces
            + self.concave_polygons
            + self.crossed_holes
            + self.boundary_crossings
            + self.overwound_vertices
    }
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

/// Most memory that this process has held so far, where the system tells (Linux).
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
