//! Writing a finished flattening to files.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::{Model, Outcome, OutputFit, PictureFile, Placement};
use crate::geom::VAxis;
use crate::io::{
    MeshReport, Output, OutputKind, PinsReport, Report, Seconds, StepReport, SvgPage, TexturePicture,
    WeightedPinReport, WriteError, peak_memory_bytes, verdict_as_in_file,
};
use crate::mesh::DiskMesh;
use crate::solver::{Hold, Pin, Verdict, distortion, verdict};

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

/// Coordinates ready to be written, proved as they are.
#[derive(Debug)]
pub struct Finished<'a> {
    model: &'a Model,
    mesh: &'a DiskMesh,
    /// As files have them, v up.
    coordinates: Vec<DVec2>,
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
    ///
    /// `read_seconds` is what opening the mesh took, for the report.
    pub fn new(
        (model, mesh): (&'a Model, &'a DiskMesh),
        outcome: &Outcome,
        steps: Vec<StepReport>,
        fit: OutputFit,
        read_seconds: f64,
    ) -> Self {
        let start = Instant::now();
        let (coordinates, placement, of_coordinates) = outcome.output(mesh, fit);
        let is_on_picture = matches!(placement, Placement::Pins | Placement::Picture);
        let is_as_solved = is_on_picture || coordinates == outcome.step.solution.embedding;
        let summary = if is_as_solved { outcome.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let pins = pins_report(outcome, &coordinates);
        let (coordinates, verdict) = if is_on_picture && outcome.frame.v_axis == VAxis::Down {
            // Where v runs down in the document, it runs up in the file, which rounds.
            let upright: Vec<DVec2> = coordinates.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
            let of_file = verdict(mesh, &upright);
            (upright, of_file)
        } else {
            (coordinates, of_coordinates)
        };
        let aspect = if is_on_picture { outcome.frame.aspect } else { 1.0 };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = outcome.step.verify_seconds + start.elapsed().as_secs_f64();
        let settings = &outcome.settings;
        let report = Report {
            freebound: env!("CARGO_PKG_VERSION"),
            mesh: MeshReport::new(model.path_words(), mesh),
            method: Some(settings.method.name()),
            family: settings.method.uses_family().then(|| settings.family.to_string()),
            pins: Some(pins),
            boundary: Some(if outcome.step.has_convex_boundary() { "convex" } else { "free" }),
            placement: Some(placement.name()),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: 0,
            seconds: Seconds { read: read_seconds, solve, verify, write: 0.0, total: read_seconds + solve + verify },
            peak_memory_bytes: peak_memory_bytes(),
        };
        Self { model, mesh, coordinates, verdict, aspect, picture: None, svg_fit: fit, report }
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

/// What the coordinates make of the user's pins.
fn pins_report(outcome: &Outcome, coordinates: &[DVec2]) -> PinsReport {
    let settings = &outcome.settings;
    let held = settings.held(&outcome.pins);
    let error = |vertex: usize, pin: &Pin| coordinates[vertex].distance(pin.target);
    let (mut max_hard_error, mut max_weighted_error) = (None::<f64>, None::<f64>);
    let mut weighted = Vec::new();
    for (&vertex, pin) in held.iter().filter(|_| settings.method.uses_pins()) {
        let error = error(vertex.index(), pin);
        let largest = match pin.hold {
            Hold::Weighted(weight) => {
                weighted.push(WeightedPinReport { vertex, weight, error });
                &mut max_weighted_error
            }
            Hold::Fixed | Hold::Hard => &mut max_hard_error,
        };
        *largest = Some(largest.unwrap_or(0.0).max(error));
    }
    PinsReport {
        treatment: settings.treatment_on(outcome.step.rung, outcome.pins.len()).name(),
        count: outcome.pins.len(),
        max_error: max_hard_error.unwrap_or(0.0).max(max_weighted_error.unwrap_or(0.0)),
        max_hard_error,
        max_weighted_error,
        weighted,
    }
}
