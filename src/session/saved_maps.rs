//! Maps of a project: which are saved, and how they return without a solve.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::restored_charts::{ONLY, RestoredChart};
use super::solving::Task;
use super::{ChartState, Model, Session};
use freebound_core::pipeline::Outcome;
use freebound_io::{ProjectFile, SavedMap};

impl Session {
    /// Project file of the document, with its maps.
    pub(super) fn project(&self, model: &Model) -> Option<ProjectFile> {
        let mut project = self.files.project_file(model, &self.document)?;
        project.maps = self.maps_to_save();
        Some(project)
    }

    /// Maps of the document that a project keeps. A chart without a planar map that meets its constraints, or with new
    /// vertices, has none and is solved again when the project opens.
    fn maps_to_save(&self) -> BTreeMap<u32, SavedMap> {
        let map = |outcome: &Outcome| SavedMap(Arc::new(outcome.step.candidate.solution.embedding.clone()));
        let Some(charts) = self.charts() else {
            let outcome = self.outcome().filter(|outcome| self.is_current() && outcome.can_be_saved());
            return outcome.map(|outcome| (ONLY, map(outcome))).into_iter().collect();
        };
        let of_chart = |number: usize| {
            let ChartState::Solved(newest) = self.chart_state(number) else { return None };
            let shown = self.outcome().filter(|_| self.chart_on_screen() == Some(number));
            let outcome = shown.unwrap_or(&newest);
            outcome.can_be_saved().then(|| (charts.first_face(number).number(), map(outcome)))
        };
        (0..charts.count()).filter_map(of_chart).collect()
    }

    /// Shows the maps of an opened project.
    pub(super) fn take_restored(&mut self, restored: Vec<RestoredChart>) {
        let shown = self.chart_on_screen();
        for RestoredChart { chart, model, outcome } in restored {
            let Some(mesh) = model.disk().map(Arc::clone) else { continue };
            let task = Task { model: Arc::clone(&model), mesh, problem: outcome.problem.clone(), from: None };
            match chart.filter(|of| shown != Some(of.number)) {
                None => self.solving.show_map(outcome, task, self.document.relaxed, &mut self.messages),
                Some(of) => {
                    let relaxed = self.document.edits_of(of.number, &of).relaxed;
                    self.charts.restore(&of, outcome, task, relaxed);
                }
            }
        }
    }
}
