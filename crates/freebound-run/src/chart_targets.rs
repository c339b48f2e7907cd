//! Pins of a mesh with several charts. Files number the vertices of the mesh, runs those of each chart.

use std::collections::BTreeMap;

use super::Model;
use freebound_core::mesh::VertexId;

impl Model {
    /// Number of vertices that a pin file can name. With several charts these are the vertices of the repaired mesh.
    pub fn vertex_count_in_file(&self) -> usize {
        let whole = self.prepared.chart.as_ref().map(|of| of.charts.whole().polygons().positions.len());
        whole.unwrap_or_else(|| self.vertex_count())
    }

    /// Splits values of vertices of the mesh, such as targets, by chart. Values of vertices that belong to no chart are
    /// dropped.
    pub fn by_chart<T>(&self, of_mesh: BTreeMap<VertexId, T>) -> BTreeMap<usize, BTreeMap<VertexId, T>> {
        let Some(of) = &self.prepared.chart else { return BTreeMap::from([(0, of_mesh)]) };
        let mut found: BTreeMap<usize, BTreeMap<VertexId, T>> = BTreeMap::new();
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
}
