//! Mesh in another preparation, with its pins.
//!
//! Another cut or repair changes the numbers of vertices and charts. If edits refer to these numbers, the mesh is first
//! prepared in the background. Then preparation, pins and relaxation rounds change together, in one edit. A pin moves
//! to the vertex at the first corner, in the file's order, that still has one. A pin without such a corner is dropped.
//! If two pins meet at one vertex, the pin of the vertex with the lower number is kept.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ChartEdits, Document, Model, Shape};
use freebound_core::mesh::{FaceId, Preparation, Repaired, VertexId};
use freebound_core::problem::Control;
use freebound_io::ProjectPins;

/// Open mesh in another preparation, with the same orientation of its faces.
pub(super) struct Reshaped {
    before: Arc<Model>,
    now: Model,
    /// Chart to be shown.
    chart: Option<usize>,
    /// New vertex of each former vertex.
    vertices_now: Vec<Option<VertexId>>,
    /// Former chart that holds the first face of each new chart.
    charts_before: Vec<Option<usize>>,
}

impl Reshaped {
    pub(super) fn new(before: Arc<Model>, form: Preparation, control: Control<'_>) -> Self {
        let now = before.in_form(form).mapped(control);
        let [were, are] = [at_corners(&before), at_corners(&now)];
        // Show the new chart that holds the first face of the shown chart.
        let first = before.prepared.chart.as_ref().map(|of| of.charts.first_face(of.number));
        let chart = first.and_then(|face| chart_at(&now, &are, face));
        let count = now.prepared.chart.as_ref().map_or(0, |of| of.charts.count());
        let first_faces = (0..count).filter_map(|number| Some(now.prepared.chart.as_ref()?.charts.first_face(number)));
        let charts_before = first_faces.map(|face| chart_at(&before, &were, face)).collect();
        let vertices_now = vertices_now(&before, &were, &are);
        Self { now: now.with_chart(chart), chart, vertices_now, charts_before, before }
    }

    /// Preparation with the document's edits, transferred to the new vertices and charts.
    pub(super) fn shape(&self, document: &Document) -> Shape {
        let before = document.all_pins(&self.before);
        let mut pins = ProjectPins::default();
        for (vertex, target) in before.targets {
            let now = self.vertices_now.get(vertex.index()).copied().flatten();
            if let Some(now) = now.filter(|now| !pins.targets.contains_key(now)) {
                pins.targets.insert(now, target);
                pins.notes.extend(before.notes.get(&vertex).map(|note| (now, note.clone())));
            }
        }
        let (mut targets_of, mut notes_of) = (self.now.by_chart(pins.targets), self.now.by_chart(pins.notes));
        let mut edits = |number: usize| ChartEdits {
            targets: targets_of.remove(&number).unwrap_or_default(),
            notes: notes_of.remove(&number).unwrap_or_default(),
            relaxed: self.rounds(document, number),
            shaped: None,
        };
        let here = self.now.prepared.chart.as_ref().map_or(0, |of| of.number);
        let shown = edits(here);
        let others = (0..self.now.chart_count()).filter(|&number| number != here).map(|number| (number, edits(number)));
        let elsewhere: BTreeMap<usize, ChartEdits> =
            others.filter(|(_, edits)| *edits != ChartEdits::default()).collect();
        Shape { form: self.now.prepared.form.clone(), chart: self.chart, shown, elsewhere }
    }

    /// Relaxation rounds of the former chart that a new chart continues.
    fn rounds(&self, document: &Document, number: usize) -> usize {
        let (Some(before), Some(_)) = (&self.before.prepared.chart, &self.now.prepared.chart) else {
            return document.relaxed;
        };
        let chart = self.charts_before.get(number).copied().flatten();
        chart.map_or(0, |chart| document.edits_of(chart, before).relaxed)
    }

    /// Mesh before the change.
    pub(super) fn before(&self) -> &Arc<Model> {
        &self.before
    }

    /// Mesh in the new preparation.
    pub(super) fn now(&self) -> &Model {
        &self.now
    }

    /// New preparation.
    pub(super) fn form(&self) -> &Preparation {
        &self.now.prepared.form
    }

    /// Mesh in the new preparation.
    pub(super) fn into_model(self) -> Model {
        self.now
    }
}

/// New vertex of each former vertex: the vertex at the first of its corners in the file that still has one. A vertex
/// without corners keeps its number. A vertex whose corners all lost their vertex has none.
fn vertices_now(before: &Model, were: &[Option<VertexId>], are: &[Option<VertexId>]) -> Vec<Option<VertexId>> {
    let mut vertices: Vec<Option<VertexId>> =
        (0..before.vertex_count_in_file()).map(|index| Some(VertexId::from_index(index))).collect();
    let of_file = before.source.polygons.positions.len();
    vertices.iter_mut().skip(of_file).for_each(|vertex| *vertex = None);
    for was in were.iter().flatten() {
        vertices[was.index()] = None;
    }
    for (was, is) in were.iter().zip(are) {
        if let Some(was) = was {
            vertices[was.index()] = vertices[was.index()].or(*is);
        }
    }
    vertices
}

/// Vertex of the whole mesh at each corner of the file.
fn at_corners(model: &Model) -> Vec<Option<VertexId>> {
    let source = &model.source.polygons;
    let whole: Option<&Repaired> = match &model.prepared.chart {
        Some(of) => Some(of.charts.whole()),
        None => model.prepared.repaired.as_deref(),
    };
    match whole {
        Some(whole) => whole.vertices_at_corners(source),
        None => source.corners.iter().copied().map(Some).collect(),
    }
}

/// Chart of a face of the file, found by the vertices at its corners.
fn chart_at(model: &Model, at_corners: &[Option<VertexId>], face: FaceId) -> Option<usize> {
    let charts = &model.prepared.chart.as_ref()?.charts;
    let corners = model.source.polygons.corner_range(face.index());
    at_corners[corners].iter().flatten().find_map(|&vertex| charts.chart_of_vertex(vertex))
}
