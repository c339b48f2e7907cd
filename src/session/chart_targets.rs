//! Pins of a mesh with several charts. Files number the vertices of the mesh, the document those of each chart.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ChartEdits, Document, Model};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};

impl Model {
    /// Number of vertices that a pin file can name. With several charts these are the vertices of the repaired mesh.
    pub fn vertex_count_in_file(&self) -> usize {
        let whole = self.prepared.chart.as_ref().map(|of| of.charts.whole().polygons().positions.len());
        whole.unwrap_or_else(|| self.vertex_count())
    }

    /// Splits the targets of the mesh by chart. Targets on vertices that belong to no chart are dropped.
    pub(super) fn by_chart(&self, of_mesh: Targets) -> BTreeMap<usize, Targets> {
        let Some(of) = &self.prepared.chart else { return BTreeMap::from([(0, of_mesh)]) };
        let mut found: BTreeMap<usize, Targets> = BTreeMap::new();
        for (vertex, target) in of_mesh {
            if let Some(chart) = of.charts.chart_of_vertex(vertex) {
                found.entry(chart).or_default().insert(vertex, target);
            }
        }
        for (&number, targets) in &mut found {
            let chart = if number == of.number { (*of.chart).clone() } else { of.charts.chart(number) };
            let own = |(vertex, target)| Some((chart.vertex_at(vertex)?, target));
            *targets = std::mem::take(targets).into_iter().filter_map(own).collect();
        }
        found
    }

    /// Targets of all charts, on the vertices of the mesh.
    pub(super) fn all_targets(&self, document: &Document) -> Targets {
        let Some(of) = &self.prepared.chart else { return document.targets.clone() };
        let here = (of.charts.pick(document.chart), &document.targets);
        let elsewhere = document.elsewhere.iter().map(|(&number, edits)| (number, &edits.targets));
        let mut all = Targets::new();
        for (number, targets) in std::iter::once(here).chain(elsewhere).filter(|(_, targets)| !targets.is_empty()) {
            let chart = if number == of.number { Arc::clone(&of.chart) } else { Arc::new(of.charts.chart(number)) };
            let in_file =
                |(vertex, target): (&VertexId, &Target)| Some((*chart.vertex_of.get(vertex.index())?, *target));
            all.extend(targets.iter().filter_map(in_file));
        }
        all
    }
}

impl Document {
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
            self.put_elsewhere(number, ChartEdits { targets, relaxed });
        }
    }
}
