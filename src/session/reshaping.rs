//! The mesh in another form, with the pins that it has.
//!
//! Vertices and charts have other numbers where the mesh is cut or mended otherwise. So where there is something that is edited of
//! them, the mesh is formed in the background first; then form, pins and rounds of relaxing change together, in one edit. A pin stays
//! with the first corner in the file of those that its vertex had, and goes where none of them has a vertex any more. Where two pins
//! come to one vertex, that of the lower number stays.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ChartEdits, Document, Model, Shape};
use freebound_core::mesh::{FaceId, Preparation, Repaired, VertexId};
use freebound_core::pipeline::Targets;

/// The open mesh in another form, its faces the same way around.
pub(super) struct Reshaped {
    before: Arc<Model>,
    now: Model,
    /// The chart that is to be on the screen.
    chart: Option<usize>,
    /// The vertex that each vertex of the mesh as it was is now.
    vertices_now: Vec<Option<VertexId>>,
    /// The chart of the mesh as it was that has the first face of each chart.
    charts_before: Vec<Option<usize>>,
}

impl Reshaped {
    pub(super) fn new(before: Arc<Model>, form: Preparation) -> Self {
        let now = before.in_form(form);
        let [were, are] = [at_corners(&before), at_corners(&now)];
        // The chart on the screen stays there, or the one that has its first face.
        let first = before.prepared.chart.as_ref().map(|of| of.charts.first_face(of.number));
        let chart = first.and_then(|face| chart_at(&now, &are, face));
        let count = now.prepared.chart.as_ref().map_or(0, |of| of.charts.count());
        let first_faces = (0..count).filter_map(|number| Some(now.prepared.chart.as_ref()?.charts.first_face(number)));
        let charts_before = first_faces.map(|face| chart_at(&before, &were, face)).collect();
        let vertices_now = vertices_now(&before, &were, &are);
        Self { now: now.with_chart(chart), chart, vertices_now, charts_before, before }
    }

    /// The form with what the document says of the mesh as it was.
    pub(super) fn shape(&self, document: &Document) -> Shape {
        let mut pins = Targets::new();
        for (vertex, target) in self.before.all_targets(document) {
            if let Some(now) = self.vertices_now.get(vertex.index()).copied().flatten() {
                pins.entry(now).or_insert(target);
            }
        }
        let mut by_chart = self.now.by_chart(pins);
        let mut edits = |number: usize| ChartEdits {
            targets: by_chart.remove(&number).unwrap_or_default(),
            relaxed: self.rounds(document, number),
        };
        let here = self.now.prepared.chart.as_ref().map_or(0, |of| of.number);
        let shown = edits(here);
        let others = (0..self.now.chart_count()).filter(|&number| number != here).map(|number| (number, edits(number)));
        let elsewhere: BTreeMap<usize, ChartEdits> =
            others.filter(|(_, edits)| *edits != ChartEdits::default()).collect();
        Shape { form: self.now.prepared.form.clone(), chart: self.chart, shown, elsewhere }
    }

    /// The rounds of relaxing that were asked for of what a chart was before.
    fn rounds(&self, document: &Document, number: usize) -> usize {
        let (Some(before), Some(_)) = (&self.before.prepared.chart, &self.now.prepared.chart) else {
            return document.relaxed;
        };
        let chart = self.charts_before.get(number).copied().flatten();
        chart.map_or(0, |chart| document.edits_of(chart, before).relaxed)
    }

    /// The mesh as it was.
    pub(super) fn before(&self) -> &Arc<Model> {
        &self.before
    }

    /// The form of the mesh now.
    pub(super) fn form(&self) -> &Preparation {
        &self.now.prepared.form
    }

    /// The mesh in its new form.
    pub(super) fn into_model(self) -> Model {
        self.now
    }
}

/// The vertex of a mesh in its new form that each of its vertices is: the one at the first corner that it has in the file. One
/// without corners keeps its number; one whose corners have no vertex any more is none.
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

/// The vertex of all charts together at each corner of the file.
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

/// The chart that a face of the file is of, by the vertices at its corners.
fn chart_at(model: &Model, at_corners: &[Option<VertexId>], face: FaceId) -> Option<usize> {
    let charts = &model.prepared.chart.as_ref()?.charts;
    let corners = model.source.polygons.corner_range(face.index());
    at_corners[corners].iter().flatten().find_map(|&vertex| charts.chart_of_vertex(vertex))
}
