//! The mesh cut along other seams, with the pins that it has.
//!
//! Vertices and charts have other numbers where the mesh is cut otherwise. So where there is something that is edited of them, the
//! mesh is cut in the background first; then seams, pins and rounds of relaxing change together, in one edit. A pin stays with the first
//! corner in the file of those that its vertex had. Where two pins come to one vertex, that of the lower number stays.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::errands::Errand;
use super::{ChartEdits, Command, Document, Message, Model, Place, Session, Shape, Written};
use crate::io::{EdgesError, Targets, read_edges, write_durably, write_edges};
use crate::mesh::{Form, Repaired, Seams, VertexId};

/// The errand that cuts the mesh along other seams.
const CUTTING: &str = "cutting along the seams";

/// The open mesh, cut along other seams.
pub(super) struct Recut {
    before: Arc<Model>,
    now: Model,
    /// The chart that is to be on the screen.
    chart: Option<usize>,
    /// The vertex that each vertex of the mesh as it was is now.
    vertices_now: Vec<VertexId>,
}

impl Session {
    /// The seams that the mesh is cut along, or is to be next.
    pub fn seams(&self) -> &Seams {
        self.mesh.wanted_seams().unwrap_or(&self.document.form.seams)
    }

    /// Cuts the mesh along these seams, and no others, as one edit.
    pub(super) fn set_seams(&mut self, seams: Seams) {
        if self.model().is_none() || seams == *self.seams() {
            return;
        }
        if self.is_bare() {
            self.edit(vec![Command::SetForm(Form { seams, ..self.document.form.clone() })]);
        } else {
            self.mesh.want_seams(Some(seams).filter(|seams| *seams != self.document.form.seams));
            self.follow_seams();
        }
    }

    /// Whether nothing is edited of vertices and charts, so that the mesh is cut otherwise at once.
    pub(super) fn is_bare(&self) -> bool {
        let Document { targets, elsewhere, relaxed, chart, .. } = &self.document;
        let is_bare = targets.is_empty() && elsewhere.is_empty() && *relaxed == 0 && chart.is_none();
        is_bare && self.mesh.wanted_seams().is_none()
    }

    /// Has the mesh cut along the seams that are wanted, once it has the form that the document has.
    pub(super) fn follow_seams(&mut self) {
        let is_free = self.has_form_as_wanted() && !self.errands.is_under_way(CUTTING);
        let wanted = self.mesh.wanted_seams().filter(|_| is_free);
        if let (Some(seams), Some(model)) = (wanted.cloned(), self.model().cloned()) {
            let form = Form { seams, ..self.document.form.clone() };
            self.errands.send(CUTTING, move |_| Errand::Recut(Box::new(Recut::new(model, form))));
        }
    }

    /// Takes in the mesh as it was cut, where that is still what is wanted.
    pub(super) fn take_recut(&mut self, recut: Recut) {
        let is_of_screen = self.model().is_some_and(|model| Arc::ptr_eq(model, &recut.before));
        let is_wanted = self.mesh.wanted_seams() == Some(&recut.now.form.seams);
        if !(is_of_screen && is_wanted && self.has_form_as_wanted()) {
            return;
        }
        self.mesh.want_seams(None);
        let shape = recut.shape(&self.document);
        self.mesh.take_other(Arc::new(recut.now));
        self.edit(vec![Command::Reshape(Box::new(shape))]);
    }

    /// Reads seams; those that there are stay.
    pub(super) fn import_seams(&mut self, path: PathBuf) {
        let Some(source) = self.model().map(|model| Arc::clone(&model.source)) else {
            return self.complain("seams need a mesh: open one first", None);
        };
        self.errands.send("reading the seams", move |_| Errand::Seams(read_edges(&path, &source.polygons)));
    }

    /// Takes in seams that were read.
    pub(super) fn take_seams(&mut self, read: Result<Vec<[VertexId; 2]>, EdgesError>) {
        match read {
            Ok(edges) if edges.is_empty() => self.complain("the file has no edges", None),
            Ok(edges) => self.set_seams(self.seams().with(edges)),
            Err(error) => {
                let model = self.model();
                let of_chart = |vertex| model.and_then(|model| model.vertex_of_file(vertex));
                let vertices = error.vertices().into_iter().filter_map(of_chart).collect();
                let message = Message::error(Place::Mesh, error.to_string()).with_vertices(vertices);
                self.messages.say(message.with_remedy("mend the file and import it again: nothing of it was taken"));
            }
        }
    }

    /// Writes the seams as a file of edges.
    pub(super) fn export_seams(&mut self, path: PathBuf) {
        let seams = self.seams().clone();
        if seams.edges().is_empty() {
            return self.complain("there are no seams to write: draw one with the Seam tool first", None);
        }
        if self.refuses_to_replace(&path, None) {
            return;
        }
        self.files.write(move || {
            write_durably(&path, |out| write_edges(out, seams.edges().iter().copied()))?;
            let words = if seams.edges().len() == 1 { "edge" } else { "edges" };
            Ok(Written { about: Some(format!("{} {words}", seams.edges().len())), ..Written::file(path) })
        });
    }
}

impl Recut {
    fn new(before: Arc<Model>, form: Form) -> Self {
        let now = before.in_form(form);
        // The chart on the screen stays there, or the one that has its first face.
        let first = before.chart.as_ref().map(|of| of.charts.faces(of.number)[0]);
        let chart = now.chart.as_ref().zip(first).and_then(|(of, face)| of.charts.chart_of_face(face));
        let now = now.with_chart(chart);
        Self { vertices_now: vertices_now(&before, &now), before, now, chart }
    }

    /// The form with what the document says of the mesh as it was.
    fn shape(&self, document: &Document) -> Shape {
        let mut pins = Targets::new();
        for (vertex, target) in self.before.all_targets(document) {
            pins.entry(self.vertices_now.get(vertex.index()).copied().unwrap_or(vertex)).or_insert(target);
        }
        let mut by_chart = self.now.by_chart(pins);
        let mut edits = |number: usize| ChartEdits {
            targets: by_chart.remove(&number).unwrap_or_default(),
            relaxed: self.rounds(document, number),
        };
        let here = self.now.chart.as_ref().map_or(0, |of| of.number);
        let shown = edits(here);
        let others = (0..self.now.chart_count()).filter(|&number| number != here).map(|number| (number, edits(number)));
        let elsewhere: BTreeMap<usize, ChartEdits> =
            others.filter(|(_, edits)| *edits != ChartEdits::default()).collect();
        Shape { form: self.now.form.clone(), chart: self.chart, shown, elsewhere }
    }

    /// The rounds of relaxing that were asked for of what a chart was before.
    fn rounds(&self, document: &Document, number: usize) -> usize {
        let (Some(before), Some(now)) = (&self.before.chart, &self.now.chart) else { return document.relaxed };
        let chart = before.charts.chart_of_face(now.charts.faces(number)[0]);
        chart.map_or(0, |chart| document.edits_of(chart, before).relaxed)
    }
}

/// The vertex of a mesh in its new form that each of its vertices is: the one at the first corner that it has in the file.
fn vertices_now(before: &Model, now: &Model) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> = (0..before.vertex_count_in_file()).map(VertexId::from_index).collect();
    let mut is_known = vec![false; vertices.len()];
    for (was, is) in at_corners(before).into_iter().zip(at_corners(now)) {
        if let (Some(was), Some(is)) = (was, is)
            && !std::mem::replace(&mut is_known[was.index()], true)
        {
            vertices[was.index()] = is;
        }
    }
    vertices
}

/// The vertex of all charts together at each corner of the file.
fn at_corners(model: &Model) -> Vec<Option<VertexId>> {
    let source = &model.source.polygons;
    let whole: Option<&Repaired> = match &model.chart {
        Some(of) => Some(of.charts.whole()),
        None => model.repaired.as_deref(),
    };
    match whole {
        Some(whole) => whole.vertices_at_corners(source),
        None => source.corners.iter().copied().map(Some).collect(),
    }
}
