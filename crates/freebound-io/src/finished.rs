//! Outcomes and atlases as [`Output`]: with their report, ready to be written.

use std::path::Path;
use std::time::Instant;

use super::{
    ChartReport, Materials, MeshFile, MeshReport, Output, Report, Seconds, ShapeReport, StepReport, verdict_as_in_file,
};
use freebound_core::mesh::Repaired;
use freebound_core::pipeline::{
    Atlas, ChartSummary, Fit, LaidChart, Outcome, Placement, PreparedMesh, Problem, SolvedChart, pins_summary, upright,
};
use freebound_core::verify::distortion;

/// Origin of a result: the file as read, and its names in the report.
#[derive(Clone, Debug)]
pub struct ResultSource<'a> {
    /// Contents of the file.
    pub file: &'a MeshFile,
    /// Path of the file. Absent for a stream or a built-in mesh.
    pub path: Option<&'a Path>,
    /// Name of the mesh in the report.
    pub name: String,
    /// Name of the layout that the run started from. Absent if it started from the surface alone.
    pub start: Option<String>,
}

impl<'a> ResultSource<'a> {
    /// Scales one outcome to its final size, then verifies and measures it there.
    ///
    /// # Panics
    ///
    /// If `prepared` is no disk.
    pub fn finished(
        self,
        prepared: &'a PreparedMesh,
        outcome: &'a Outcome,
        steps: Vec<StepReport>,
        fit: Fit,
    ) -> Output<'a> {
        let start = Instant::now();
        let given = prepared.disk().expect("only a disk has an outcome");
        let (Problem { settings, frame, .. }, step) = (&outcome.problem, &outcome.step);
        let (coordinates, placement, of_coordinates) = outcome.output(given, fit);
        let mesh = step.candidate.mesh(given);
        let is_on_picture = matches!(placement, Placement::Pins | Placement::Picture | Placement::File);
        let is_as_solved = is_on_picture || coordinates == step.candidate.solution.embedding;
        let summary = if is_as_solved { outcome.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let pins = pins_summary(outcome, &coordinates);
        let (coordinates, verdict) = match upright(&coordinates, frame.v_axis).filter(|_| is_on_picture) {
            Some(upright) => {
                let of_file = freebound_core::verify::verdict(mesh, &upright);
                (upright, of_file)
            }
            None => (coordinates, of_coordinates),
        };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = step.verify_seconds + start.elapsed().as_secs_f64();
        let report = Report {
            method: Some(settings.method.clone()),
            family: settings.method.uses_family().then_some(settings.family()),
            start: self.start,
            pins: Some(pins),
            boundary: Some(boundary_name(step.candidate.has_convex_boundary())),
            shape: ShapeReport::of(settings),
            placement: Some(placement),
            written_step: written_step(&steps, step.index),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: outcome.new_vertex_count(),
            split_edges: step.candidate.refinement.as_ref().map(|r| r.split_edges_of_surface()).unwrap_or_default(),
            cut_polygons: step.candidate.refinement.as_ref().map(|r| r.cut_polygons(given)).unwrap_or_default(),
            seconds: Seconds { solve, verify, total: solve + verify, ..Seconds::default() },
            ..Report::of_mesh(MeshReport::new(self.name, given).prepared(self.file, prepared))
        };
        let (refinement, held) = (step.candidate.refinement.as_deref(), outcome.held());
        Output {
            source: self.file,
            source_path: self.path,
            materials: Materials::default(),
            repaired: prepared.repaired.as_deref(),
            charts: vec![LaidChart { refinement, ..LaidChart::only(mesh, coordinates, verdict, held) }],
            report,
            picture: None,
            aspect: if is_on_picture { frame.aspect } else { 1.0 },
            svg_fit: fit,
        }
    }

    /// Reports charts that were laid out together. `steps` holds the steps of each chart.
    ///
    /// # Panics
    ///
    /// If there is no chart, or a chart has no disk.
    pub fn finished_atlas(
        self,
        charts: &[SolvedChart<'a>],
        atlas: Atlas<'a>,
        steps: Vec<Vec<StepReport>>,
    ) -> Output<'a> {
        let whole = charts[0].chart.whole_repaired();
        let polygons = whole.map_or(&self.file.polygons, Repaired::polygons);
        let disks = charts.iter().map(|chart| &**chart.chart.disk().expect("only a disk has an outcome"));
        let mesh = MeshReport::of_disks(self.name, polygons.positions.len(), disks);
        let settings = &charts[0].outcome.problem.settings;
        let solve = steps.iter().flatten().map(|step| step.seconds).sum();
        let new_vertices = atlas.summaries.iter().map(|summary| summary.new_vertices).sum();
        let report = Report {
            method: Some(settings.method.clone()),
            family: settings.method.uses_family().then_some(settings.family()),
            start: self.start,
            shape: ShapeReport::of(settings),
            atlas: Some(atlas.verdict),
            charts: atlas
                .summaries
                .into_iter()
                .zip(steps)
                .map(|(summary, steps)| chart_report(summary, steps))
                .collect(),
            packing: atlas.packing,
            new_vertices,
            split_edges: atlas.split_edges,
            cut_polygons: atlas.cut_polygons,
            seconds: Seconds { solve, ..Seconds::default() },
            ..Report::of_mesh(mesh.prepared(self.file, charts[0].chart))
        };
        Output {
            source: self.file,
            source_path: self.path,
            materials: Materials::default(),
            repaired: whole,
            charts: atlas.charts,
            report,
            picture: None,
            aspect: atlas.aspect,
            svg_fit: Fit::Unit,
        }
    }
}

/// Word of the report for the boundary.
const fn boundary_name(is_convex: bool) -> &'static str {
    if is_convex { "convex" } else { "free" }
}

/// Index of the written step, unless it is the last one.
fn written_step(steps: &[StepReport], written: usize) -> Option<usize> {
    steps.last().is_some_and(|last| last.index != written).then_some(written)
}

fn chart_report(summary: ChartSummary, steps: Vec<StepReport>) -> ChartReport {
    ChartReport {
        first_face: summary.first_face,
        faces: summary.faces,
        pins: summary.pins,
        boundary: boundary_name(summary.has_convex_boundary),
        placement: summary.placement,
        written_step: written_step(&steps, summary.step),
        steps,
        distortion: summary.distortion,
        density: summary.density,
        tile: summary.tile,
        new_vertices: summary.new_vertices,
        stacked: summary.stacked,
    }
}
