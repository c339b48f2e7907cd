//! An outcome made ready to be written to files.

use std::path::PathBuf;
use std::time::Instant;

use glam::DVec2;

use super::{Model, Outcome, Problem};
use crate::geom::VAxis;
use crate::io::{
    MeshReport, Output, OutputFit, OutputKind, PinsReport, Placement, Report, Seconds, StepReport, WeightedPinReport,
    verdict_as_in_file,
};
use crate::mesh::VertexId;
use crate::solver::{Embedding, Hold, distortion, verdict};

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaveRequest {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub kind: OutputKind,
    /// At which size, where the user's pins do not say.
    pub fit: OutputFit,
}

impl Outcome {
    /// Takes the embedding to its final size, and proves and measures it there. `model` is the mesh as it was opened.
    ///
    /// # Panics
    ///
    /// If the outcome is of another mesh, and the model no disk.
    pub fn finished<'a>(&'a self, model: &'a Model, steps: Vec<StepReport>, fit: OutputFit) -> Output<'a> {
        let start = Instant::now();
        let given = model.disk().expect("only a disk has an outcome");
        let (Problem { settings, frame, .. }, step) = (&self.problem, &self.step);
        let (coordinates, placement, of_coordinates) = self.output(given, fit);
        let mesh = step.mesh(given);
        let is_on_picture = matches!(placement, Placement::Pins | Placement::Picture);
        let is_as_solved = is_on_picture || coordinates == step.solution.embedding;
        let summary = if is_as_solved { self.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let pins = pins_report(self, &coordinates);
        let (coordinates, verdict) = if is_on_picture && frame.v_axis == VAxis::Down {
            // Where v runs down in the document, it runs up in the file, which rounds.
            let upright: Embedding = coordinates.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
            let of_file = verdict(mesh, &upright);
            (upright, of_file)
        } else {
            (coordinates, of_coordinates)
        };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = step.verify_seconds + start.elapsed().as_secs_f64();
        let report = Report {
            method: Some(settings.method),
            family: settings.method.uses_family().then_some(settings.family),
            pins: Some(pins),
            boundary: Some(if step.has_convex_boundary() { "convex" } else { "free" }),
            placement: Some(placement),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: self.new_vertex_count(),
            split_edges: step.refinement.as_ref().map(|r| r.split_edges()).unwrap_or_default(),
            seconds: Seconds { solve, verify, total: solve + verify, ..Seconds::default() },
            ..Report::of_mesh(MeshReport::new(model.path_words(), given))
        };
        Output {
            source: &model.source,
            mesh,
            refinement: step.refinement.as_deref(),
            coordinates,
            verdict,
            report,
            picture: None,
            aspect: if is_on_picture { frame.aspect } else { 1.0 },
            svg_fit: fit,
        }
    }
}

/// What became of the user's pins. Those that are to be met exactly have their own numbers in `coordinates`, whatever
/// was solved: for them the solver's places count too.
fn pins_report(outcome: &Outcome, coordinates: &Embedding) -> PinsReport {
    let settings = &outcome.problem.settings;
    let (mut max_hard_error, mut max_weighted_error) = (None::<f64>, None::<f64>);
    let (mut weighted, mut unmet) = (Vec::new(), Vec::new());
    let targets = &outcome.problem.targets;
    for (&vertex, target) in targets.iter().filter(|_| settings.method.uses_pins()) {
        let written = coordinates[vertex.index()].distance(target.uv);
        let (largest, error) = match settings.hold_of(target.hold) {
            Hold::Weighted(weight) => {
                weighted.push(WeightedPinReport { vertex, weight, error: written });
                (&mut max_weighted_error, written)
            }
            Hold::Fixed | Hold::Hard => {
                let error = written.max(solver_error(outcome, vertex, target.uv));
                if error != 0.0 {
                    unmet.push(vertex);
                }
                (&mut max_hard_error, error)
            }
        };
        *largest = Some(largest.unwrap_or(0.0).max(error));
    }
    PinsReport {
        treatment: settings.treatment_on(outcome.step.rung, targets.len()),
        count: targets.len(),
        max_error: max_hard_error.unwrap_or(0.0).max(max_weighted_error.unwrap_or(0.0)),
        max_hard_error,
        max_weighted_error,
        unmet,
        weighted,
    }
}

/// Distance of a pinned vertex from its target as solved for, in texture coordinates. Compared in the plane, so that it
/// is 0 where the solver met the target to the last bit, and only there.
fn solver_error(outcome: &Outcome, vertex: VertexId, target: DVec2) -> f64 {
    let frame = outcome.problem.frame;
    let off = outcome.step.solution.embedding[vertex] - frame.plane_from_uv(target);
    // The frame has no offset: it takes differences to differences.
    frame.uv_from_plane(off).length()
}
