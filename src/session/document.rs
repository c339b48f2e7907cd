//! What the user edits, and one edit of it.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::model::example_picture;
use crate::examples::Example;
use freebound_core::geom::{PackingOptions, PictureFrame, VAxis};
use freebound_core::mesh::{Charts, FaceId, Preparation, VertexId};
use freebound_core::pipeline::{ChartOf, Problem, Target, Targets, hard_targets, pins_in_plane};
use freebound_core::problem::{Pins, Settings};
use freebound_io::PictureFile;

/// What the user edits. Small: mesh and pictures are immutable and kept elsewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The user's pins by their targets.
    pub targets: Targets,
    /// Method and weights.
    pub settings: Settings,
    /// The picture that is mapped on the mesh.
    pub picture: Option<Arc<PictureFile>>,
    /// Width over height of a picture that is not at hand.
    pub aspect: Option<f64>,
    /// Where v = 0 is on the picture.
    pub v_axis: VAxis,
    /// What is made of the mesh's faces.
    pub form: Preparation,
    /// The chart on the screen, where the mesh has several; none stands for the largest.
    pub chart: Option<usize>,
    /// How several charts are packed, where there is no picture that they go on.
    pub packing: PackingOptions,
    /// How many times as large as the others charts are packed, by their first faces in the file; 1 without it. Above
    /// [`PackingOptions::SIZES`] and below, the nearest end of it is taken.
    pub sizes: BTreeMap<FaceId, f64>,
    /// What the user has edited of charts that are not on the screen.
    pub elsewhere: BTreeMap<usize, ChartEdits>,
    /// Rounds of relaxing that a person has asked for: they follow wherever a run comes to its end, whatever happens to
    /// pins, picture and faces. Choosing method or weights in any way, a repair and solving again drop them; a pause leaves
    /// those that were taken.
    pub relaxed: usize,
}

/// What the user edits of one chart of several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartEdits {
    /// The pins by their targets. Vertices are the chart's own.
    pub targets: Targets,
    /// As [`Document::relaxed`].
    pub relaxed: usize,
}

/// What is made of the mesh's faces, with all that is edited of vertices and charts, whose numbers belong to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// As [`Document::form`].
    pub form: Preparation,
    /// As [`Document::chart`].
    pub chart: Option<usize>,
    /// What is edited of the chart on the screen, or of the mesh.
    pub shown: ChartEdits,
    /// As [`Document::elsewhere`].
    pub elsewhere: BTreeMap<usize, ChartEdits>,
}

impl Shape {
    /// Takes the place of the document's, which it becomes.
    fn exchange(&mut self, document: &mut Document) {
        std::mem::swap(&mut self.form, &mut document.form);
        std::mem::swap(&mut self.chart, &mut document.chart);
        std::mem::swap(&mut self.shown.targets, &mut document.targets);
        std::mem::swap(&mut self.shown.relaxed, &mut document.relaxed);
        std::mem::swap(&mut self.elsewhere, &mut document.elsewhere);
    }
}

impl Document {
    /// A built-in mesh's landmarks as constraints, on the picture that belongs to it.
    pub fn of_example(example: Example) -> Self {
        let landmarks = example.landmarks().into_iter();
        Self {
            targets: hard_targets(landmarks.map(|landmark| (landmark.vertex, landmark.target.into()))),
            picture: example_picture(example),
            ..Self::default()
        }
    }

    /// How texture coordinates lie in the plane where the mesh is flattened.
    pub fn frame(&self) -> PictureFrame {
        let aspect = self.picture.as_ref().map(|picture| picture.aspect()).or(self.aspect);
        PictureFrame { aspect: aspect.unwrap_or(1.0), v_axis: self.v_axis }
    }

    /// What a run of it is to solve: where there is a picture, the embedding is made to lie on it.
    pub fn problem(&self) -> Problem {
        self.problem_with(self.targets.clone())
    }

    /// What the user has edited of a chart.
    pub(super) fn edits_of(&self, number: usize, of: &ChartOf) -> ChartEdits {
        if of.charts.pick(self.chart) == number {
            return ChartEdits { targets: self.targets.clone(), relaxed: self.relaxed };
        }
        self.elsewhere.get(&number).cloned().unwrap_or_default()
    }

    /// The same with other targets.
    pub(super) fn problem_with(&self, targets: Targets) -> Problem {
        let has_picture = self.picture.is_some() || self.aspect.is_some();
        Problem::new(&self.settings, self.frame(), has_picture, targets)
    }

    /// How many times as large as the others a chart is packed.
    pub fn size_of(&self, charts: &Charts, number: usize) -> f64 {
        self.sizes.get(&charts.first_face(number)).copied().unwrap_or(1.0)
    }

    /// Keeps what is edited of a chart that is not on the screen; nothing is no entry.
    pub(super) fn put_elsewhere(&mut self, chart: usize, edits: ChartEdits) {
        if edits != ChartEdits::default() {
            self.elsewhere.insert(chart, edits);
        }
    }

    /// The user's pins in that plane.
    pub fn pins(&self) -> Pins {
        pins_in_plane(&self.targets, self.frame())
    }
}

/// One undoable edit.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Pins `vertex`, or frees it when `target` is `None`.
    SetPin {
        /// The vertex to pin or free.
        vertex: VertexId,
        /// Its target.
        target: Option<Target>,
    },
    /// Chooses method and weights.
    SetSettings(Settings),
    /// Chooses the picture.
    SetPicture(Option<Arc<PictureFile>>),
    /// Chooses where v = 0 is.
    SetVAxis(VAxis),
    /// Takes the mesh's faces in another form.
    SetForm(Preparation),
    /// Takes the mesh in another form, with all that is edited of its vertices.
    Reshape(Box<Shape>),
    /// Chooses how many rounds of relaxing follow a run.
    SetRelaxed(usize),
    /// Puts another chart on the screen.
    ShowChart {
        /// The chart.
        to: usize,
        /// The one that is on the screen.
        from: usize,
        /// How the document has it: none stands for the largest.
        chart: Option<usize>,
    },
    /// Chooses how charts are packed.
    SetPacking(PackingOptions),
    /// Chooses how large a chart is packed, by its first face in the file.
    SetSize {
        /// The face.
        first_face: FaceId,
        /// How many times as large as the others; none for as large.
        size: Option<f64>,
    },
    /// Changes what is edited of a chart that is not on the screen.
    SetElsewhere {
        /// The chart.
        chart: usize,
        /// All that is edited of it.
        edits: ChartEdits,
    },
    /// Several edits that are one for the user.
    Together(Vec<Command>),
}

impl Command {
    /// Carries out the edit and returns the command that takes it back.
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
            Self::SetSettings(settings) => Self::SetSettings(std::mem::replace(&mut document.settings, settings)),
            Self::SetPicture(picture) => Self::SetPicture(std::mem::replace(&mut document.picture, picture)),
            Self::SetVAxis(v_axis) => Self::SetVAxis(std::mem::replace(&mut document.v_axis, v_axis)),
            Self::SetForm(form) => Self::SetForm(std::mem::replace(&mut document.form, form)),
            Self::Reshape(mut shape) => {
                shape.exchange(document);
                Self::Reshape(shape)
            }
            Self::SetRelaxed(rounds) => Self::SetRelaxed(std::mem::replace(&mut document.relaxed, rounds)),
            Self::ShowChart { to, from, chart } => {
                let coming = document.elsewhere.remove(&to).unwrap_or_default();
                let targets = std::mem::replace(&mut document.targets, coming.targets);
                let going = ChartEdits { targets, relaxed: std::mem::replace(&mut document.relaxed, coming.relaxed) };
                document.put_elsewhere(from, going);
                Self::ShowChart { to: from, from: to, chart: std::mem::replace(&mut document.chart, chart) }
            }
            Self::SetPacking(options) => Self::SetPacking(std::mem::replace(&mut document.packing, options)),
            Self::SetSize { first_face, size } => {
                let before = match size {
                    Some(size) => document.sizes.insert(first_face, size),
                    None => document.sizes.remove(&first_face),
                };
                Self::SetSize { first_face, size: before }
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
