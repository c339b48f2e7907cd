//! Writing a finished flattening to files.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::{Model, Outcome, OutputFit, PictureFile, Placement};
use crate::geom::VAxis;
use crate::io::{
    MeshReport, Output, OutputKind, PinsReport, Report, Seconds, StepReport, SvgPage, TexturePicture,
    WeightedPinReport, WriteError, verdict_as_in_file,
};
use crate::mesh::{DiskMesh, Refinement, VertexId};
use crate::solver::{Embedding, Hold, Verdict, distortion, verdict};

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

/// A mesh as it was opened.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    /// With its name and path.
    pub model: &'a Model,
    /// The mesh itself.
    pub disk: &'a DiskMesh,
    /// What opening it took, for the report.
    pub read_seconds: f64,
}

/// Coordinates ready to be written, proved as they are.
#[derive(Debug)]
pub struct Finished<'a> {
    model: &'a Model,
    mesh: &'a DiskMesh,
    refinement: Option<&'a Refinement>,
    /// As files have them, v up.
    coordinates: Embedding,
    verdict: Verdict,
    /// Width over height of the picture that they are for.
    aspect: f64,
    picture: Option<Arc<PictureFile>>,
    svg_fit: OutputFit,
    /// What there is to say about it.
    pub report: Report,
}

impl<'a> Finished<'a> {
    /// Takes the embedding to its final size, and proves and measures it there.
    pub fn new(
        Given { model, disk: given, read_seconds }: Given<'a>,
        outcome: &'a Outcome,
        steps: Vec<StepReport>,
        fit: OutputFit,
    ) -> Self {
        let start = Instant::now();
        let (coordinates, placement, of_coordinates) = outcome.output(given, fit);
        let mesh = outcome.step.mesh(given);
        let is_on_picture = matches!(placement, Placement::Pins | Placement::Picture);
        let is_as_solved = is_on_picture || coordinates == outcome.step.solution.embedding;
        let summary = if is_as_solved { outcome.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let pins = pins_report(outcome, &coordinates);
        let (coordinates, verdict) = if is_on_picture && outcome.problem.frame.v_axis == VAxis::Down {
            // Where v runs down in the document, it runs up in the file, which rounds.
            let upright: Embedding = coordinates.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
            let of_file = verdict(mesh, &upright);
            (upright, of_file)
        } else {
            (coordinates, of_coordinates)
        };
        let aspect = if is_on_picture { outcome.problem.frame.aspect } else { 1.0 };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = outcome.step.verify_seconds + start.elapsed().as_secs_f64();
        let settings = &outcome.problem.settings;
        let report = Report {
            method: Some(settings.method),
            family: settings.method.uses_family().then_some(settings.family),
            pins: Some(pins),
            boundary: Some(if outcome.step.has_convex_boundary() { "convex" } else { "free" }),
            placement: Some(placement.name()),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: outcome.new_vertex_count(),
            split_edges: outcome.step.refinement.as_ref().map(|r| r.split_edges()).unwrap_or_default(),
            seconds: Seconds { read: read_seconds, solve, verify, write: 0.0, total: read_seconds + solve + verify },
            ..Report::of_mesh(MeshReport::new(model.path_words(), given))
        };
        let refinement = outcome.step.refinement.as_deref();
        Self { model, mesh, refinement, coordinates, verdict, aspect, picture: None, svg_fit: fit, report }
    }

    /// With a picture, which goes beside an OBJ file and on the mesh in a PNG file.
    #[must_use]
    pub fn with_picture(self, picture: Option<Arc<PictureFile>>) -> Self {
        Self { picture, ..self }
    }

    /// With a size of drawings of its own.
    #[must_use]
    pub fn with_svg_fit(self, svg_fit: OutputFit) -> Self {
        Self { svg_fit, ..self }
    }

    /// Writes one file.
    ///
    /// # Errors
    ///
    /// Where it cannot be written.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<(), WriteError> {
        let picture = self
            .picture
            .as_deref()
            .map(|picture| TexturePicture { path: picture.path.as_deref(), pixels: &picture.pixels });
        let output = Output {
            source: &self.model.source,
            mesh: self.mesh,
            refinement: self.refinement,
            coordinates: &self.coordinates,
            verdict: &self.verdict,
            report: &self.report,
            picture,
            svg_page: match self.svg_fit {
                OutputFit::Unit => SvgPage::Picture { aspect: self.aspect },
                OutputFit::True => SvgPage::TrueArea { aspect: self.aspect },
            },
        };
        output.write(kind, path)
    }

    /// The verdict on the coordinates as written.
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examples::Example;
    use crate::geom::PictureFrame;
    use crate::io::hard_targets;
    use crate::session::Problem;
    use crate::solver::{Control, Ladder, Settings};

    /// The dome's first step with hard pins, on a picture twice as wide as high.
    fn first_step() -> Outcome {
        let model = Model::example(Example::Dome);
        let mesh = model.disk().expect("a dome is a disk");
        let frame = PictureFrame { aspect: 2.0, ..PictureFrame::default() };
        let targets = [(3, [0.2, 0.2]), (40, [0.8, 0.3]), (11, [0.7, 0.9])];
        let targets = hard_targets(targets.map(|(vertex, uv)| (VertexId::new(vertex), uv.into())));
        let problem = Problem { settings: Settings::default(), frame, targets };
        let mut run = Ladder::new(problem.settings, problem.pins());
        let step = run.step(mesh, Control::unattended()).expect("a dome can be solved");
        Outcome::new(mesh, problem, step)
    }

    /// The largest error of the hard pins that the report tells.
    fn reported(outcome: &Outcome) -> Option<f64> {
        let model = Model::example(Example::Dome);
        let mesh = model.disk().expect("a dome is a disk");
        let finished =
            Finished::new(Given { model: &model, disk: mesh, read_seconds: 0.0 }, outcome, Vec::new(), OutputFit::Unit);
        finished.report.pins.and_then(|pins| pins.max_hard_error)
    }

    #[test]
    fn a_hard_constraint_that_the_solver_misses_is_reported_though_the_file_has_its_numbers() {
        let mut outcome = first_step();
        assert_eq!(reported(&outcome), Some(0.0));
        outcome.step.candidate.solution.embedding[40] += DVec2::new(0.25, 0.0);
        let error = reported(&outcome).expect("there are hard pins");
        assert!((error - 0.125).abs() < 1e-12, "{error}");
    }
}
