//! Writing a finished flattening to files.

use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec2;

use super::{Model, Outcome, OutputFit};
use crate::io::{
    MeshReport, Output, OutputKind, PinsReport, Report, Seconds, StepReport, WriteError, peak_memory_bytes,
    verdict_as_in_file,
};
use crate::mesh::DiskMesh;
use crate::solver::{Verdict, distortion};

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
    coordinates: Vec<DVec2>,
    verdict: Verdict,
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
        let (coordinates, placement, verdict) = outcome.output(mesh, fit);
        let unchanged = coordinates == outcome.step.solution.embedding;
        let summary = if unchanged { outcome.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = outcome.step.verify_seconds + start.elapsed().as_secs_f64();
        let settings = &outcome.settings;
        let report = Report {
            freebound: env!("CARGO_PKG_VERSION"),
            mesh: MeshReport::new(model.path_words(), mesh),
            method: Some(settings.method.name()),
            family: settings.method.uses_family().then(|| settings.family.to_string()),
            pins: Some(PinsReport {
                treatment: settings.treatment_on(outcome.step.rung, outcome.pins.len()).name(),
                count: outcome.pins.len(),
                max_error: outcome.pin_error(),
            }),
            boundary: Some(if outcome.step.has_convex_boundary() { "convex" } else { "free" }),
            placement: Some(placement.name()),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: 0,
            seconds: Seconds { read: read_seconds, solve, verify, write: 0.0, total: read_seconds + solve + verify },
            peak_memory_bytes: peak_memory_bytes(),
        };
        Self { model, mesh, coordinates, verdict, report }
    }

    /// Writes one file.
    ///
    /// # Errors
    ///
    /// Where it cannot be written.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<(), WriteError> {
        let output = Output {
            source: &self.model.source,
            mesh: self.mesh,
            coordinates: &self.coordinates,
            verdict: &self.verdict,
            report: &self.report,
        };
        output.write(kind, path)
    }

    /// The verdict on the coordinates as written.
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
    }
}
