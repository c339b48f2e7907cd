//! What is reported of a comparison: several methods on one mesh, each with its steps, its end and its numbers.
//!
//! | file     | what it holds                                                              |
//! |----------|----------------------------------------------------------------------------|
//! | `mod`    | the report (JSON)                                                          |
//! | `column` | the columns of the table: their heads, their cells, and the order by them  |
//! | `lines`  | the numbers of a method in a few short lines                               |
//! | `morph`  | planar morphs between what the methods have come to                        |
//! | `table`  | the table for a person and as a file; every step of every method as a file |

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

/// Everything that is reported of a comparison. Field names are part of the interface.
#[derive(Debug, Serialize)]
pub struct ComparisonReport {
    /// Version of the report's form.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// The input: one chart of it, where it has several.
    pub mesh: MeshReport,
    /// Which chart that is, of how many; absent where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chart: Option<ChartNumber>,
    /// Width over height of the picture that the pins are on; 1 where there is none.
    pub aspect: f64,
    /// The methods.
    pub methods: Vec<MethodReport>,
    /// Planar morphs through their maps; absent where none were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub morph: Option<MorphReport>,
    /// Where the time went, that of the methods aside.
    pub seconds: ComparisonSeconds,
    /// Most memory that the process held, where the system tells.
    pub peak_memory_bytes: Option<u64>,
}

/// One chart of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ChartNumber {
    /// Its number, from 0.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

/// Seconds of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ComparisonSeconds {
    /// Reading and diagnosing the mesh.
    pub read: f64,
    /// From the start to the report.
    pub total: f64,
}

/// One method of a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct MethodReport {
    /// What it is called here: method, weights and boundary, as they are typed.
    pub name: String,
    /// The same for the screen.
    #[serde(skip)]
    pub title: String,
    /// The method.
    pub method: Method,
    /// The weights, where the method has a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub family: Option<Family>,
    /// The shape that the boundary is laid on, where the method lays it on one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<BoundaryShape>,
    /// Why it came to its end: the name of an ending, or `failed`.
    pub ending: &'static str,
    /// Why it failed; absent where it did not. Steps before that are good.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<MethodError>,
    /// Each step of each stage.
    pub steps: Vec<TimedStep>,
    /// What came of it; absent where there is no embedding.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result: Option<ResultReport>,
    /// Where the time went.
    pub seconds: MethodSeconds,
    /// Bytes of the largest factors that a linear solve of it kept; null where it solved no linear system.
    pub factor_bytes: Option<usize>,
}

/// Why a method failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MethodError {
    /// A fixed name of it.
    pub kind: &'static str,
    /// In words.
    pub message: String,
}

impl From<&SolveError> for MethodError {
    fn from(error: &SolveError) -> Self {
        Self { kind: error.name(), message: error.to_string() }
    }
}

/// The embedding that a method came to.
#[derive(Clone, Debug, Serialize)]
pub struct ResultReport {
    /// The exact verdict on it where it lies.
    pub verdict: VerdictCounts,
    /// Whether the boundary is free, or convex: laid on a convex shape, or bent to one to make it simple.
    pub boundary: &'static str,
    /// What became of the pins. Vertices are those of the file.
    pub pins: PinsSummary,
    /// Its distortion at equal total areas.
    pub distortion: DistortionSummary,
    /// Vertices that the mesh did not have before.
    pub new_vertices: usize,
}

/// A verdict, its lists counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "the report's fields")]
pub struct VerdictCounts {
    /// Proved one-to-one.
    pub planar: bool,
    /// The same with all coordinates rounded to 32 bits.
    #[serde(rename = "f32")]
    pub planar_in_f32: bool,
    /// It is a mirror image.
    pub mirrored: bool,
    /// Flipped faces.
    pub flipped_faces: usize,
    /// Polygons that other cuts into triangles would fold.
    pub concave_polygons: usize,
    /// Holes that meet themselves or are turned inside out.
    pub crossed_holes: usize,
    /// Boundary crossings, those that a verdict lists.
    pub boundary_crossings: usize,
    /// There are more of them.
    pub more_crossings: bool,
    /// Overwound vertices.
    pub overwound_vertices: usize,
    /// Turning number of the boundary; null where an edge has no direction or turns back.
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

/// A step with what it has come to by then: points of curves over time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TimedStep {
    /// The step.
    pub step: StepReport,
    /// Seconds from the method's beginning to the end of the step's proof. What is measured for this report does not count.
    pub elapsed: f64,
    /// Mean symmetric Dirichlet energy of its embedding at equal total areas, 4 at best; null where it is infinite, as the next
    /// are.
    pub energy: f64,
    /// Root mean square stretch.
    pub stretch_l2: f64,
    /// Greatest stretch.
    pub stretch_linf: f64,
}

/// Seconds of a method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MethodSeconds {
    /// All steps without their proofs.
    pub solve: f64,
    /// Their proofs.
    pub verify: f64,
}

impl MethodSeconds {
    /// Both together.
    pub fn total(self) -> f64 {
        self.solve + self.verify
    }
}

impl ComparisonReport {
    /// A report on a mesh that is yet without methods.
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
