//! Document that the user edits, and its undoable edits.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::chart_layout::ChartLayout;
use crate::examples::{Example, Landmark};
use freebound_core::geom::{PictureFrame, VAxis};
use freebound_core::mesh::{Preparation, VertexId};
use freebound_core::pipeline::{ChartOf, Problem, ShapedMap, Target, Targets, hard_targets, pins_in_plane};
use freebound_core::problem::{Pins, Settings};
use freebound_io::{PictureFile, PinName, PinNote, PinNotes};

/// Document that the user edits. It is small, because mesh and pictures are immutable and stored elsewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Targets of the user's pins.
    pub targets: Targets,
    /// Names of pins. No solve needs them.
    pub notes: PinNotes,
    /// Method and weights.
    pub settings: Settings,
    /// The picture that is mapped on the mesh.
    pub picture: Option<Arc<PictureFile>>,
    /// Aspect ratio (width over height) of a picture that is not available.
    pub aspect: Option<f64>,
    /// Side of the picture with v = 0.
    pub v_axis: VAxis,
    /// Preparation of the mesh.
    pub form: Preparation,
    /// Number of the shown chart, if the mesh has several. Default: the largest chart.
    pub chart: Option<usize>,
    /// Layout of several charts on the page.
    pub layout: ChartLayout,
    /// Edits of charts that are not shown.
    pub elsewhere: BTreeMap<usize, ChartEdits>,
    /// Number of relaxation rounds that the user requested. They follow the end of each run, also after edits of pins,
    /// picture and faces. A change of method or weights, a repair and solving from scratch reset the number. A pause
    /// keeps the rounds that were taken.
    pub relaxed: usize,
    /// Map of the shown chart that the user shaped with brushes.
    pub shaped: Option<ShapedMap>,
}

/// Edits of one chart of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartEdits {
    /// Targets of the chart's pins, by the chart's own vertices.
    pub targets: Targets,
    /// Notes on the chart's pins, see [`Document::notes`].
    pub notes: PinNotes,
    /// Number of relaxation rounds that the user requested, see [`Document::relaxed`].
    pub relaxed: usize,
    /// Map that the user shaped with brushes, see [`Document::shaped`].
    pub shaped: Option<ShapedMap>,
}

/// Preparation of the mesh, with all edits whose vertex and chart numbers depend on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Preparation of the mesh, see [`Document::form`].
    pub form: Preparation,
    /// Number of the shown chart, see [`Document::chart`].
    pub chart: Option<usize>,
    /// Edits of the shown chart, or of the whole mesh.
    pub shown: ChartEdits,
    /// Edits of charts that are not shown, see [`Document::elsewhere`].
    pub elsewhere: BTreeMap<usize, ChartEdits>,
}

impl Shape {
    /// Swaps all fields with those of the document.
    fn exchange(&mut self, document: &mut Document) {
        std::mem::swap(&mut self.form, &mut document.form);
        std::mem::swap(&mut self.chart, &mut document.chart);
        std::mem::swap(&mut self.shown.targets, &mut document.targets);
        std::mem::swap(&mut self.shown.notes, &mut document.notes);
        std::mem::swap(&mut self.shown.relaxed, &mut document.relaxed);
        std::mem::swap(&mut self.shown.shaped, &mut document.shaped);
        std::mem::swap(&mut self.elsewhere, &mut document.elsewhere);
    }
}

impl Document {
    /// Document of a built-in mesh: its landmarks as constraints, on its picture.
    pub fn of_example(example: Example) -> Self {
        let landmarks = example.landmarks();
        let note = |landmark: &Landmark| Some((landmark.vertex, PinNote::named(PinName::new(landmark.name).ok()?)));
        Self {
            notes: landmarks.iter().filter_map(note).collect(),
            targets: hard_targets(landmarks.iter().map(|landmark| (landmark.vertex, landmark.target.into()))),
            picture: example.picture_file(),
            ..Self::default()
        }
    }

    /// Frame of texture coordinates in the plane of the embedding.
    pub fn frame(&self) -> PictureFrame {
        let aspect = self.picture.as_ref().map(|picture| picture.aspect()).or(self.aspect);
        PictureFrame { aspect: aspect.unwrap_or(1.0), v_axis: self.v_axis }
    }

    /// Problem that a run of the document solves. If there is a picture, the embedding is placed on it.
    pub fn problem(&self) -> Problem {
        self.problem_with(self.edits_shown())
    }

    /// Edits of the shown chart.
    fn edits_shown(&self) -> ChartEdits {
        ChartEdits {
            targets: self.targets.clone(),
            notes: self.notes.clone(),
            relaxed: self.relaxed,
            shaped: self.shaped.clone(),
        }
    }

    /// Edits of a chart.
    pub(super) fn edits_of(&self, number: usize, of: &ChartOf) -> ChartEdits {
        if of.charts.pick(self.chart) == number {
            return self.edits_shown();
        }
        self.elsewhere.get(&number).cloned().unwrap_or_default()
    }

    /// Problem of a chart with these edits.
    pub(super) fn problem_with(&self, edits: ChartEdits) -> Problem {
        let has_picture = self.picture.is_some() || self.aspect.is_some();
        let ChartEdits { targets, shaped, .. } = edits;
        Problem::new(&self.settings, self.frame(), has_picture, targets).with_shaped_map(shaped)
    }

    /// Stores the edits of a chart that is not shown. Default edits get no entry.
    pub(super) fn put_elsewhere(&mut self, chart: usize, edits: ChartEdits) {
        if edits != ChartEdits::default() {
            self.elsewhere.insert(chart, edits);
        }
    }

    /// User's pins, in the plane of [`frame`](Self::frame).
    pub fn pins(&self) -> Pins {
        pins_in_plane(&self.targets, self.frame())
    }
}

/// Undoable edit.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Pins `vertex`, or unpins it if `target` is `None`.
    SetPin {
        /// Vertex to pin or unpin.
        vertex: VertexId,
        /// Its target.
        target: Option<Target>,
    },
    /// Sets the note on a pin. An empty note removes it.
    SetNote {
        /// The pinned vertex.
        vertex: VertexId,
        /// New note.
        note: PinNote,
    },
    /// Sets method and weights.
    SetSettings(Settings),
    /// Sets the picture.
    SetPicture(Option<Arc<PictureFile>>),
    /// Sets the side of the picture with v = 0.
    SetVAxis(VAxis),
    /// Sets the preparation of the mesh.
    SetForm(Preparation),
    /// Sets the preparation of the mesh, together with all edits of its vertices.
    Reshape(Box<Shape>),
    /// Sets the number of relaxation rounds that follow a run.
    SetRelaxed(usize),
    /// Sets the map of the shown chart that the user shaped.
    SetShaped(Option<ShapedMap>),
    /// Shows another chart.
    ShowChart {
        /// Number of the chart to show.
        to: usize,
        /// Number of the chart that is shown now.
        from: usize,
        /// New value of [`Document::chart`]. `None` means the largest chart.
        chart: Option<usize>,
    },
    /// Sets the layout of the charts.
    SetLayout(Box<ChartLayout>),
    /// Sets the edits of a chart that is not shown.
    SetElsewhere {
        /// The chart.
        chart: usize,
        /// All edits of the chart.
        edits: ChartEdits,
    },
    /// Several edits that are one edit for the user.
    Together(Vec<Command>),
}

impl Command {
    /// Carries out the edit and returns its inverse.
    #[must_use = "dropping the inverse makes the edit impossible to undo"]
    pub fn apply(self, document: &mut Document) -> Self {
        match self {
            Self::SetPin { vertex, target } => {
                let before = match target {
                    Some(target) => document.targets.insert(vertex, target),
                    None => document.targets.remove(&vertex),
                };
                Self::SetPin { vertex, target: before }
            }
            Self::SetNote { vertex, note } => {
                let before =
                    if note.is_empty() { document.notes.remove(&vertex) } else { document.notes.insert(vertex, note) };
                Self::SetNote { vertex, note: before.unwrap_or_default() }
            }
            Self::SetSettings(settings) => Self::SetSettings(std::mem::replace(&mut document.settings, settings)),
            Self::SetPicture(picture) => Self::SetPicture(std::mem::replace(&mut document.picture, picture)),
            Self::SetVAxis(v_axis) => Self::SetVAxis(std::mem::replace(&mut document.v_axis, v_axis)),
            Self::SetForm(form) => Self::SetForm(std::mem::replace(&mut document.form, form)),
            Self::Reshape(mut shape) => {
                shape.exchange(document);
                Self::Reshape(shape)
            }
            Self::SetRelaxed(rounds) => Self::SetRelaxed(std::mem::replace(&mut document.relaxed, rounds)),
            Self::SetShaped(shaped) => Self::SetShaped(std::mem::replace(&mut document.shaped, shaped)),
            Self::ShowChart { to, from, chart } => {
                let coming = document.elsewhere.remove(&to).unwrap_or_default();
                let going = ChartEdits {
                    targets: std::mem::replace(&mut document.targets, coming.targets),
                    notes: std::mem::replace(&mut document.notes, coming.notes),
                    relaxed: std::mem::replace(&mut document.relaxed, coming.relaxed),
                    shaped: std::mem::replace(&mut document.shaped, coming.shaped),
                };
                document.put_elsewhere(from, going);
                Self::ShowChart { to: from, from: to, chart: std::mem::replace(&mut document.chart, chart) }
            }
            Self::SetLayout(mut layout) => {
                std::mem::swap(&mut *layout, &mut document.layout);
                Self::SetLayout(layout)
            }
            Self::SetElsewhere { chart, edits } => {
                let before = document.elsewhere.remove(&chart).unwrap_or_default();
                document.put_elsewhere(chart, edits);
                Self::SetElsewhere { chart, edits: before }
            }
            Self::Together(commands) => {
                let mut inverses: Vec<Self> = commands.into_iter().map(|command| command.apply(document)).collect();
                inverses.reverse();
                Self::Together(inverses)
            }
        }
    }
}
