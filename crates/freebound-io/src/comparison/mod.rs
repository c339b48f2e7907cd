//! Report of a comparison: several methods on one mesh, each with its steps, its end and its numbers.
//!
//! | file     | contents                                                                   |
//! |----------|----------------------------------------------------------------------------|
//! | `mod`    | the report (JSON)                                                          |
//! | `column` | columns of the table: heads, cells, and sorting by them                    |
//! | `lines`  | numbers of a method in a few short lines                                   |
//! | `morph`  | planar morphs between the maps of the methods                              |
//! | `table`  | the table as text and as a file; every step of every method as a file      |

mod column;
mod lines;
mod morph;
mod table;

use serde::Serialize;

use super::report::REPORT_SCHEMA;
use super::{MeshReport, StepReport, peak_memory_bytes};
use freebound_core::pipeline::PinsSummary;
use freebound_core::problem::{BoundaryShape, Family, Method, SolveError};
use freebound_core::verify::{DistortionSummary, Verdict};

pub use column::{Cell, Column, Direction};
pub use morph::{LeftOutReport, LegReport, MorphReport};

/// Report of a comparison. Field names are part of the interface.
#[derive(Debug, Serialize)]
pub struct ComparisonReport {
    /// Version of the report format.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// Input mesh, or the compared chart of it.
    pub mesh: MeshReport,
    /// Number of the compared chart; absent if the mesh has one chart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chart: Option<ChartNumber>,
    /// Width over height of the picture that holds the pins; 1 without a picture.
    pub aspect: f64,
    /// Methods in the order of the comparison.
    pub methods: Vec<MethodReport>,
    /// Planar morphs through the maps of the methods; absent if none were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub morph: Option<MorphReport>,
    /// Time of the comparison, without the methods.
    pub seconds: ComparisonSeconds,
    /// Peak memory of the process, if the system tells.
    pub peak_memory_bytes: Option<u64>,
}

/// Number of a chart in a mesh of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ChartNumber {
    /// Number of the chart, from 0.
    pub number: usize,
    /// Number of charts.
    pub of: usize,
}

/// Seconds of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ComparisonSeconds {
    /// Reading and diagnosing the mesh.
    pub read: f64,
    /// Time from the start of the run to the report.
    pub total: f64,
}

/// Method of a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct MethodReport {
    /// Name of the method: method, weights and boundary, in the form of the command line.
    pub name: String,
    /// Name of the method on the screen.
    #[serde(skip)]
    pub title: String,
    /// The method.
    pub method: Method,
    /// Weights, if the method has a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// Shape of the boundary, if the method lays it on one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<BoundaryShape>,
    /// Reason for the end: the name of an ending, or `failed`.
    pub ending: &'static str,
    /// Error of a method that failed; absent otherwise. Steps before the error are valid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<MethodError>,
    /// Steps of all stages.
    pub steps: Vec<TimedStep>,
    /// Result; absent if there is no embedding.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result: Option<ResultReport>,
    /// Time of the method.
    pub seconds: MethodSeconds,
    /// Bytes of the largest factors that a linear solve kept; null if no linear system was solved.
    pub factor_bytes: Option<usize>,
}

/// Error of a method.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MethodError {
    /// Fixed name of the error.
    pub kind: &'static str,
    /// Message of the error.
    pub message: String,
}

impl From<&SolveError> for MethodError {
    fn from(error: &SolveError) -> Self {
        Self { kind: error.name(), message: error.to_string() }
    }
}

/// Embedding that a method computed.
#[derive(Clone, Debug, Serialize)]
pub struct ResultReport {
    /// Counts of the exact verdict on the embedding.
    pub verdict: VerdictCounts,
    /// Kind of the boundary: `free`, or `convex` if it was laid on a convex shape or bent to one to make it simple.
    pub boundary: &'static str,
    /// Pins and their errors. Vertices are numbered by the file.
    pub pins: PinsSummary,
    /// Distortion of the embedding at equal total areas.
    pub distortion: DistortionSummary,
    /// Number of vertices added to the mesh.
    pub new_vertices: usize,
}

/// Verdict with counts instead of lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "the report's fields")]
pub struct VerdictCounts {
    /// True if the map is proved one-to-one.
    pub planar: bool,
    /// True if the map is proved one-to-one with all coordinates rounded to 32 bits.
    #[serde(rename = "f32")]
    pub planar_in_f32: bool,
    /// True if the map is a mirror image.
    pub mirrored: bool,
    /// Flipped faces.
    pub flipped_faces: usize,
    /// Polygons that another triangulation would fold.
    pub concave_polygons: usize,
    /// Holes that intersect themselves or are turned inside out.
    pub crossed_holes: usize,
    /// Boundary crossings that the verdict lists.
    pub boundary_crossings: usize,
    /// True if there are more boundary crossings than the verdict lists.
    pub more_crossings: bool,
    /// Overwound vertices.
    pub overwound_vertices: usize,
    /// Turning number of the boundary; null if an edge has no direction or turns back.
    pub turning_number: Option<i64>,
}

impl From<&Verdict> for VerdictCounts {
    fn from(verdict: &Verdict) -> Self {
        Self {
            planar: verdict.planar,
            planar_in_f32: verdict.planar_in_f32,
            mirrored: verdict.mirrored,
            flipped_faces: verdict.flipped_faces.len(),
            concave_polygons: verdict.concave_polygons.len(),
            crossed_holes: verdict.crossed_holes.len(),
            boundary_crossings: verdict.boundary_crossings.len(),
            more_crossings: verdict.more_crossings,
            overwound_vertices: verdict.overwound_vertices.len(),
            turning_number: verdict.turning_number,
        }
    }
}

/// Step with the quality of its embedding: a point of curves over time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TimedStep {
    /// The step.
    pub step: StepReport,
    /// Seconds from the start of the method to the end of the step's verdict. Measurements for this report are
    /// excluded.
    pub elapsed: f64,
    /// Mean symmetric Dirichlet energy of the embedding at equal total areas, at least 4; null if infinite.
    pub energy: f64,
    /// Root mean square stretch; null if infinite.
    pub stretch_l2: f64,
    /// Largest stretch; null if infinite.
    pub stretch_linf: f64,
}

/// Seconds of a method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MethodSeconds {
    /// All steps without their verdicts.
    pub solve: f64,
    /// Verdicts of all steps.
    pub verify: f64,
}

impl MethodSeconds {
    /// Sum of solve and verify seconds.
    pub fn total(self) -> f64 {
        self.solve + self.verify
    }
}

impl ComparisonReport {
    /// Report on a mesh, without methods yet.
    pub fn new(mesh: MeshReport, chart: Option<ChartNumber>, aspect: f64) -> Self {
        Self {
            schema: REPORT_SCHEMA,
            freebound: env!("CARGO_PKG_VERSION"),
            mesh,
            chart,
            aspect,
            methods: Vec::new(),
            morph: None,
            seconds: ComparisonSeconds::default(),
            peak_memory_bytes: peak_memory_bytes(),
        }
    }
}
