//! Pins of a mesh with several charts. Files number the vertices of the mesh, the document those of each chart.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::{ChartEdits, Document, Model};
use freebound_core::mesh::VertexId;
use freebound_io::ProjectPins;

impl Document {
    /// Pins of all charts, on the vertices of the mesh.
    pub(super) fn all_pins(&self, model: &Model) -> ProjectPins {
        let Some(of) = &model.prepared.chart else {
            return ProjectPins { targets: self.targets.clone(), notes: self.notes.clone() };
        };
        let here = ChartEdits { targets: self.targets.clone(), notes: self.notes.clone(), ..ChartEdits::default() };
        let elsewhere = self.elsewhere.iter().map(|(&number, edits)| (number, edits));
        let mut all = ProjectPins::default();
        let charts = std::iter::once((of.charts.pick(self.chart), &here)).chain(elsewhere);
        for (number, edits) in charts.filter(|(_, edits)| !edits.targets.is_empty()) {
            let chart = if number == of.number { Arc::clone(&of.chart) } else { Arc::new(of.charts.chart(number)) };
            all.targets.extend(on_mesh(&edits.targets, &chart.vertex_of));
            all.notes.extend(on_mesh(&edits.notes, &chart.vertex_of));
        }
        all
    }

    /// Applies the chart data of a project: pins on the vertices of the mesh, and relaxation rounds of charts that are
    /// not shown.
    pub(super) fn take_charts(&mut self, model: &Model, pins: ProjectPins, relaxed: &BTreeMap<usize, usize>) {
        let here = model.prepared.chart.as_ref().map_or(0, |of| of.number);
        let (mut targets_of, mut notes_of) = (model.by_chart(pins.targets), model.by_chart(pins.notes));
        self.targets = targets_of.remove(&here).unwrap_or_default();
        self.notes = notes_of.remove(&here).unwrap_or_default();
        let numbers: BTreeSet<usize> = targets_of.keys().chain(relaxed.keys()).copied().collect();
        for number in numbers.into_iter().filter(|&number| number != here && number < model.chart_count()) {
            let targets = targets_of.remove(&number).unwrap_or_default();
            let notes = notes_of.remove(&number).unwrap_or_default();
            let relaxed = relaxed.get(&number).copied().unwrap_or_default();
            self.put_elsewhere(number, ChartEdits { targets, notes, relaxed, shaped: None });
        }
    }
}

/// Values of a chart's vertices on the vertices of the mesh.
fn on_mesh<T: Clone>(values: &BTreeMap<VertexId, T>, vertex_of: &[VertexId]) -> BTreeMap<VertexId, T> {
    let on_mesh = |(vertex, value): (&VertexId, &T)| Some((*vertex_of.get(vertex.index())?, value.clone()));
    values.iter().filter_map(on_mesh).collect()
}
