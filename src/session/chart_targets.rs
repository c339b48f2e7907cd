//! Pins of a mesh with several charts. Files number the vertices of the mesh, the document those of each chart.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ChartEdits, Document, Model};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};

impl Document {
    /// Targets of all charts, on the vertices of the mesh.
    pub(super) fn all_targets(&self, model: &Model) -> Targets {
        let Some(of) = &model.prepared.chart else { return self.targets.clone() };
        let here = (of.charts.pick(self.chart), &self.targets);
        let elsewhere = self.elsewhere.iter().map(|(&number, edits)| (number, &edits.targets));
        let mut all = Targets::new();
        for (number, targets) in std::iter::once(here).chain(elsewhere).filter(|(_, targets)| !targets.is_empty()) {
            let chart = if number == of.number { Arc::clone(&of.chart) } else { Arc::new(of.charts.chart(number)) };
            let in_file =
                |(vertex, target): (&VertexId, &Target)| Some((*chart.vertex_of.get(vertex.index())?, *target));
            all.extend(targets.iter().filter_map(in_file));
        }
        all
    }

    /// Applies the chart data of a project: pins on the vertices of the mesh, and relaxation rounds of charts that are
    /// not shown.
    pub(super) fn take_charts(&mut self, model: &Model, targets: Targets, relaxed: &BTreeMap<usize, usize>) {
        let here = model.prepared.chart.as_ref().map_or(0, |of| of.number);
        let mut by_chart = model.by_chart(targets);
        self.targets = by_chart.remove(&here).unwrap_or_default();
        let numbers: std::collections::BTreeSet<usize> = by_chart.keys().chain(relaxed.keys()).copied().collect();
        for number in numbers.into_iter().filter(|&number| number != here && number < model.chart_count()) {
            let targets = by_chart.remove(&number).unwrap_or_default();
            let relaxed = relaxed.get(&number).copied().unwrap_or_default();
            self.put_elsewhere(number, ChartEdits { targets, relaxed, shaped: None });
        }
    }
}
