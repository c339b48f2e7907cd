//! Files with the numbers and figures of the steps.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::Editor;
use super::step_curve::ShownCurve;
use crate::session::{Action, Timeline};
use crate::ui::state::{CURVE_COUNT, CurvesExport, TimelineView};
use freebound_core::flatten::{NoLinearSystem, StepSystem, linear_system_of_step};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Variant;
use freebound_io::MatrixFile;
use freebound_io::figure::{Drawing, FigureFormat, Panel, PlaneDrawing, PrintedSheet, StepCurve, StepFigure, Window};

impl Editor {
    /// Writes the curves of the steps.
    pub(super) fn export_curves(&mut self, what: CurvesExport, path: PathBuf) {
        let (timeline, view) = (self.session.timeline(), &self.timeline);
        let figure = step_figure(timeline, view, self.figure_caption(), what == CurvesExport::Table);
        self.session.write_file(path, move |mut out| match what {
            CurvesExport::Table => figure.write_csv(&mut out),
            CurvesExport::Svg => figure.page().write(FigureFormat::Svg, &mut out),
            CurvesExport::Pdf => figure.page().write(FigureFormat::Pdf, &mut out),
        });
    }

    /// Writes a picture of every step that is kept whole, in numbered files beside `path`, all with one camera.
    pub(super) fn export_step_pictures(&mut self, path: &Path) {
        let timeline = self.session.timeline();
        let Some(model) = self.session.model().cloned() else { return };
        let kept: Vec<(usize, Arc<Outcome>)> = timeline.kept().map(|(step, of)| (step, Arc::clone(of))).collect();
        let embeddings = kept.iter().map(|(_, outcome)| &outcome.step.candidate.solution.embedding);
        let Some(window) = Window::common(embeddings) else { return };
        let count = timeline.records().len();
        let missing = count - kept.len();
        let missing = if missing == 0 { String::new() } else { format!("; {missing} others are no longer in memory") };
        let about = format!("{} of {count} steps{missing}", kept.len());
        let paths: Vec<PathBuf> = kept.iter().map(|(step, _)| numbered(path, *step)).collect();
        if let Some(existing) = paths.iter().find(|path| path.exists()) {
            let existing = existing.clone();
            return self.act(Action::RefuseToReplace(existing));
        }
        let (format, caption) = (FigureFormat::of_path(path), self.figure_caption());
        self.session.write_files(paths, about, move |place, mut out| {
            let step = &kept[place].1.step;
            let Some(mesh) = model.disk() else { return Ok(()) };
            let mesh = Arc::new(step.candidate.mesh(mesh).clone());
            let drawing = PlaneDrawing { window: Some(window), ..PlaneDrawing::of_step(&mesh, step) };
            let words =
                format!("Step {}: {}, {}", step.index, step.candidate.stage.short_words(), step.verdict.summary());
            let panels = vec![Panel { words, drawing: Drawing::Plane(drawing) }];
            PrintedSheet { columns: 1, panels, caption: caption.clone() }.page().write(format, &mut out)
        });
    }

    /// Writes matrix and right-hand side of the linear system of the step on the screen.
    pub(super) fn export_linear_system(&mut self, path: PathBuf) {
        let Some((outcome, model)) = self.session.outcome().cloned().zip(self.session.model().cloned()) else { return };
        let before =
            outcome.step.index.checked_sub(1).and_then(|index| self.session.timeline().outcome(index)).cloned();
        let stage = outcome.step.candidate.stage.words();
        let about = format!("{} Step {}: {stage}.", self.figure_caption(), outcome.step.index);
        let right_side = beside(&path, "rhs");
        // If the matrix exists, the user has chosen to replace it.
        if right_side.exists() && !path.exists() {
            return self.act(Action::RefuseToReplace(right_side));
        }
        let words =
            format!("the right-hand side is in {}", right_side.file_name().unwrap_or_default().to_string_lossy());
        let made: OnceLock<Result<StepSystem, NoLinearSystem>> = OnceLock::new();
        self.session.write_files(vec![path, right_side], words, move |place, mut out| {
            let Some(mesh) = model.disk() else { return Ok(()) };
            let before = before.as_ref().map(|before| &before.step.candidate.solution.embedding);
            let system = made.get_or_init(|| linear_system_of_step(mesh, &outcome.step, before));
            let system = system.as_ref().map_err(|reason| io::Error::other(*reason))?;
            let numbers = mesh.vertices().map(|vertex| model.vertex_in_file(vertex)).collect();
            let file = MatrixFile { system, about: about.clone(), numbers };
            if place == 0 { file.write_matrix(&mut out) } else { file.write_right_side(&mut out) }
        });
    }

    /// Caption of figures of the document: name of the mesh, method, and sizes.
    fn figure_caption(&self) -> String {
        let method = Variant::of(&self.session.document().settings).title();
        let Some(model) = self.session.model() else { return method };
        let faces = model.mesh().real_face_count();
        let (name, vertices, steps) = (&model.name, model.vertex_count(), self.session.timeline().records().len());
        format!("{name}: {method}, {vertices} vertices, {faces} faces, {steps} steps.")
    }
}

/// Curves of all steps. A figure has the curves on the screen; a table has all.
fn step_figure(timeline: &Timeline, view: &TimelineView, caption: String, is_table: bool) -> StepFigure {
    let mut shown = if is_table { Vec::new() } else { ShownCurve::telling(timeline, view) };
    if shown.is_empty() {
        shown = (0..CURVE_COUNT).map(|place| ShownCurve::new(place, timeline, view)).collect();
    }
    let curve = |shown: ShownCurve| StepCurve {
        title: shown.curve.title.to_owned(),
        unit: shown.curve.unit.to_owned(),
        scale: shown.scale,
        values: shown.values,
    };
    StepFigure {
        curves: shown.into_iter().map(curve).collect(),
        stages: timeline.records().iter().map(|record| record.stage.short_words().to_owned()).collect(),
        caption,
    }
}

/// Path with the number of a step at the end of the name.
fn numbered(path: &Path, step: usize) -> PathBuf {
    beside(path, &format!("{step:04}"))
}

/// Path with an addition at the end of the name.
fn beside(path: &Path, addition: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{addition}.{extension}"))
}
