//! Charts of a project with their saved maps, proved again while the project is read.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Document, Model};
use freebound_core::pipeline::{ChartOf, Outcome, Problem};
use freebound_io::SavedMap;

/// Number under which the map of a mesh of a single chart is saved.
pub(super) const ONLY: u32 = 0;

/// Chart of a project with its saved map, proved again.
#[derive(Clone, Debug)]
pub(super) struct RestoredChart {
    /// The chart, if the mesh has several.
    pub(super) chart: Option<ChartOf>,
    pub(super) model: Arc<Model>,
    pub(super) outcome: Arc<Outcome>,
}

/// Proves the saved maps of a project. Maps that do not belong to the mesh, or are not planar any more, are left out.
pub(super) fn restored(model: &Model, document: &Document, maps: &BTreeMap<u32, SavedMap>) -> Vec<RestoredChart> {
    if maps.is_empty() || model.prepared.form != document.form {
        return Vec::new();
    }
    let Some(of) = &model.prepared.chart else {
        let restored = maps.get(&ONLY).and_then(|map| restore(Arc::new(model.clone()), document.problem(), map));
        return restored.into_iter().collect();
    };
    let chart = |number: usize| {
        let map = maps.get(&of.charts.first_face(number).number())?;
        let model = if number == of.number { model.clone() } else { model.of_chart(number) };
        let problem = document.problem_with(document.edits_of(number, of));
        restore(Arc::new(model), problem, map)
    };
    (0..of.charts.count()).filter_map(chart).collect()
}

fn restore(model: Arc<Model>, problem: Problem, map: &SavedMap) -> Option<RestoredChart> {
    let outcome = Outcome::of_saved_map(model.disk()?, problem, map.0.as_ref().clone())?;
    Some(RestoredChart { chart: model.prepared.chart.clone(), model, outcome: Arc::new(outcome) })
}
