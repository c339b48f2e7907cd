//! Numbers of a step: a part of the report, and a row of a table.

use serde::Serialize;

use freebound_core::flatten::Step;
use freebound_core::problem::{Convergence, Stage};

/// Step of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StepReport {
    /// Stage that made the step.
    pub stage: Stage,
    /// Position in the run.
    pub index: usize,
    /// Flipped faces.
    pub flipped_faces: usize,
    /// Concave polygons.
    pub concave_polygons: usize,
    /// Holes that intersect themselves or are turned inside out.
    pub crossed_holes: usize,
    /// Boundary crossings.
    pub boundary_crossings: usize,
    /// Overwound vertices.
    pub overwound_vertices: usize,
    /// Vertices outside the hull of their neighbours; or, on a straight boundary, without a neighbour on the
    /// surface's side. They are not defects themselves, but explain why the map folds.
    pub outside_hull_vertices: usize,
    /// Turning number of the boundary.
    pub turning_number: Option<i64>,
    /// Largest displacement of a vertex since the previous step.
    pub max_move: Option<f64>,
    /// ‖Ax − b‖ / ‖b‖ of the linear solve; null without a linear solve. For an eigenvector: the residual of its
    /// equations, relative to the sizes of their terms.
    pub residual: Option<f64>,
    /// ‖A z‖ of all vertex equations, pinned ones included, relative to the sum of their terms' sizes; null without a
    /// linear solve.
    pub equation_residual: Option<f64>,
    /// Number of pivots that were too small and were replaced.
    pub replaced_pivots: usize,
    /// Degenerate corners whose weight was clamped.
    pub bounded_corners: usize,
    /// Boundary vertices that were bent to a convex polygon to make the boundary simple.
    pub bent_vertices: usize,
    /// Bytes of the factors of the matrix.
    pub factor_bytes: usize,
    /// Time of the step.
    pub seconds: f64,
    /// True if the map is proved one-to-one.
    pub planar: bool,
    /// Mean energy of the faces' maps, 4 without distortion; null if the stage does not measure it.
    pub energy: Option<f64>,
    /// Smallest determinant of a face's map, at equal total areas; null without `energy`.
    pub least_determinant: Option<f64>,
    /// Largest distance of a hard pin from its target, in the plane; null without `energy`.
    pub distance_left: Option<f64>,
    /// End of the inner iteration of a method that converges within one step; absent for other methods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Remark on the step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Number as a cell of a table; empty if absent or not finite.
fn cell(number: impl Into<Option<f64>>) -> String {
    number.into().filter(|number| number.is_finite()).map(|number| format!("{number:?}")).unwrap_or_default()
}

impl StepReport {
    /// Fields as a row of a table, each with the head of its column; empty if there is no value.
    pub fn row(&self) -> [(&'static str, String); 25] {
        [
            ("stage", self.stage.name().to_owned()),
            ("index", self.index.to_string()),
            ("flipped_faces", self.flipped_faces.to_string()),
            ("concave_polygons", self.concave_polygons.to_string()),
            ("crossed_holes", self.crossed_holes.to_string()),
            ("boundary_crossings", self.boundary_crossings.to_string()),
            ("overwound_vertices", self.overwound_vertices.to_string()),
            ("outside_hull_vertices", self.outside_hull_vertices.to_string()),
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
            ("inner_steps", self.convergence.map(|inner| inner.steps.to_string()).unwrap_or_default()),
            ("inner_residual", cell(self.convergence.map(|inner| inner.residual))),
            ("inner_stop", self.convergence.map(|inner| inner.stop.name().to_owned()).unwrap_or_default()),
            ("note", self.note.clone().unwrap_or_default()),
        ]
    }

    /// Numbers of a step.
    pub fn of(step: &Step) -> Self {
        let (solution, verdict) = (&step.candidate.solution, &step.verdict);
        let counts = solution.linear.unwrap_or_default();
        Self {
            stage: step.candidate.stage.clone(),
            index: step.index,
            flipped_faces: verdict.flipped_faces.len(),
            concave_polygons: verdict.concave_polygons.len(),
            crossed_holes: verdict.crossed_holes.len(),
            boundary_crossings: verdict.boundary_crossings.len(),
            overwound_vertices: verdict.overwound_vertices.len(),
            outside_hull_vertices: step.outside_hull.len(),
            turning_number: verdict.turning_number,
            max_move: step.max_move,
            residual: solution.linear.map(|linear| linear.residual),
            equation_residual: solution.linear.map(|linear| linear.equation_residual),
            replaced_pivots: counts.replaced_pivots,
            bounded_corners: counts.bounded_corners,
            bent_vertices: step.candidate.bent_vertices,
            factor_bytes: counts.factor_bytes,
            seconds: step.seconds(),
            planar: verdict.planar,
            energy: step.candidate.progress.map(|progress| progress.energy),
            least_determinant: step.candidate.progress.map(|progress| progress.least_determinant),
            distance_left: step.candidate.progress.map(|progress| progress.distance_left),
            convergence: solution.convergence,
            note: step.candidate.note.clone(),
        }
    }

    /// Sum of flipped faces, concave polygons, crossed holes, boundary crossings and overwound vertices.
    pub fn defect_count(&self) -> usize {
        let faces = self.flipped_faces + self.concave_polygons + self.crossed_holes;
        faces + self.boundary_crossings + self.overwound_vertices
    }
}
