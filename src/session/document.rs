//! What the user edits, and one edit of it.

use std::sync::Arc;

use super::Problem;
use super::model::example_picture;
use crate::examples::Example;
use crate::geom::{Bounds, PictureFrame, VAxis};
use crate::io::{PictureFile, Target, Targets, hard_targets, pins_in_plane};
use crate::mesh::{Form, VertexId};
use crate::solver::{GaugeSize, Pins, Settings};

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
    pub form: Form,
    /// Rounds of relaxing that a person has asked for: they follow wherever a run comes to its end, whatever happens to
    /// pins, picture and faces. Choosing method or weights in any way, a repair and solving again drop them; a pause leaves
    /// those that were taken.
    pub relaxed: usize,
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
        let frame = self.frame();
        let [low, high] = frame.corners();
        let has_picture = self.picture.is_some() || self.aspect.is_some();
        let size = if has_picture { GaugeSize::Within(Bounds { low, high }) } else { GaugeSize::TrueArea };
        Problem { settings: Settings { size, ..self.settings }, frame, targets: self.targets.clone() }
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
    SetForm(Form),
    /// Chooses how many rounds of relaxing follow a run.
    SetRelaxed(usize),
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
            Self::SetRelaxed(rounds) => Self::SetRelaxed(std::mem::replace(&mut document.relaxed, rounds)),
            Self::Together(commands) => {
                let mut inverses: Vec<Self> = commands.into_iter().map(|command| command.apply(document)).collect();
                inverses.reverse();
                Self::Together(inverses)
            }
        }
    }
}
