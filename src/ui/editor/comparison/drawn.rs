//! Drawn data of the method comparison: scenes, face colours on one scale, and one camera.

use std::sync::Arc;

use glam::DVec2;

use crate::session::{Contender, JobFailure, Wake};
use crate::ui::editor::async_scene::AsyncScene;
use crate::ui::editor::paint::Legend;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::view::{CellFrame, CellFrames, FacePaint, PlaneCamera, Quantity};
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::Outcome;

/// Scenes and face colours of the compared methods.
#[derive(Debug)]
pub(super) struct Drawn {
    scenes: Vec<Arc<PlaneScene>>,
    /// Background job that makes a scene. Key: address of the outcome in memory.
    job: AsyncScene<usize, PlaneScene>,
    paints: Option<Paints>,
}

/// Face colours on one scale.
#[derive(Clone, Debug)]
struct Paints {
    key: (Option<Quantity>, Vec<usize>),
    faces: Vec<Arc<FacePaint>>,
    legend: Option<Legend>,
}

/// Layout and camera of the cells.
#[derive(Debug, Default)]
pub(super) struct Sight {
    frames: Option<(Vec<usize>, CellFrames)>,
    /// Size of every cell, points.
    size: DVec2,
    camera: Option<PlaneCamera>,
    /// Last camera that the window chose, not the user.
    framed: Option<PlaneCamera>,
}

/// Drawn data of a cell.
#[derive(Clone)]
pub(in crate::ui) struct CellScene {
    pub(in crate::ui) plane: Arc<PlaneScene>,
    pub(in crate::ui) faces: Arc<FacePaint>,
    pub(in crate::ui) frame: CellFrame,
}

/// Address of an outcome in memory, unique among live outcomes.
fn place_of(outcome: &Arc<Outcome>) -> usize {
    Arc::as_ptr(outcome).addr()
}

/// Latest embedding of a method.
pub(super) fn outcome_of(contender: &Contender) -> Option<&Arc<Outcome>> {
    contender.found()?.outcome.as_ref()
}

impl Drawn {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { scenes: Vec::new(), job: AsyncScene::new("compared scene", wake), paints: None }
    }

    pub(super) fn is_making(&self) -> bool {
        self.job.is_busy()
    }

    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Adds a finished scene, starts a job for a missing one, and drops scenes of outcomes that are no longer wanted.
    /// `given` is the mesh as given.
    pub(super) fn refresh(&mut self, wanted: &[Arc<Outcome>], given: Option<&Arc<MeshScene>>) {
        if let Some((_, scene)) = self.job.poll() {
            self.scenes.push(Arc::new(scene));
        }
        self.scenes.retain(|scene| wanted.iter().any(|outcome| Arc::ptr_eq(outcome, &scene.outcome)));
        let missing = wanted.iter().find(|outcome| self.place_of_scene(outcome).is_none());
        if let Some((given, outcome)) = given.zip(missing) {
            let (given, outcome) = (Arc::clone(given), Arc::clone(outcome));
            self.job.make(place_of(&outcome), move |_| {
                let mesh = MeshScene::of_step(&given, None, &outcome.step);
                PlaneScene::new(mesh, outcome, 0)
            });
        }
    }

    /// Drawn data of the cell of an embedding, once it is made and laid out.
    pub(super) fn cell(&self, outcome: &Arc<Outcome>, sight: &Sight) -> Option<CellScene> {
        let index = self.place_of_scene(outcome)?;
        Some(CellScene {
            plane: Arc::clone(&self.scenes[index]),
            faces: Arc::clone(self.paints.as_ref()?.faces.get(index)?),
            frame: sight.frame_of(index, outcome)?,
        })
    }

    pub(super) fn legend(&self) -> Option<&Legend> {
        self.paints.as_ref()?.legend.as_ref()
    }

    fn place_of_scene(&self, outcome: &Arc<Outcome>) -> Option<usize> {
        self.scenes.iter().position(|scene| Arc::ptr_eq(outcome, &scene.outcome))
    }

    fn places(&self) -> Vec<usize> {
        self.scenes.iter().map(|scene| place_of(&scene.outcome)).collect()
    }

    /// Colours the faces of all scenes on one scale, unless that is done.
    pub(super) fn paint(&mut self, quantity: Option<Quantity>) {
        let key = (quantity, self.places());
        if self.paints.as_ref().is_some_and(|paints| paints.key == key) {
            return;
        }
        let outcomes = || self.scenes.iter().map(|scene| &scene.outcome);
        let range = quantity.and_then(|quantity| quantity.common_range(outcomes().map(|outcome| &outcome.distortion)));
        let values: Vec<Vec<f64>> =
            outcomes().map(|outcome| quantity.map_or_else(Vec::new, |by| by.values(&outcome.distortion))).collect();
        let faces = outcomes().zip(&values).map(|(outcome, values)| {
            let flipped = &outcome.step.verdict.flipped_faces;
            Arc::new(match quantity.zip(range) {
                Some((by, range)) => FacePaint::by_value(values, by.scale(), range, flipped),
                None => FacePaint::plain(outcome.distortion.faces.len(), flipped),
            })
        });
        let faces = faces.collect();
        let legend = quantity.zip(range).map(|(by, range)| Legend::new(by.scale(), range, values.iter().flatten()));
        self.paints = Some(Paints { key, faces, legend });
    }
}

impl Sight {
    /// Lays out the scenes if they have changed.
    pub(super) fn refresh(&mut self, mesh: &DiskMesh, drawn: &Drawn) {
        let places = drawn.places();
        if self.frames.as_ref().is_none_or(|(of, _)| *of != places) {
            let outcomes: Vec<&Outcome> = drawn.scenes.iter().map(|scene| &*scene.outcome).collect();
            self.take(places, CellFrames::new(mesh, &outcomes));
        }
    }

    /// Camera of all cells, for cells of this size.
    pub(super) fn camera_in(&mut self, cell: DVec2) -> Option<PlaneCamera> {
        self.frame_in(cell);
        self.camera
    }

    pub(super) fn camera(&self) -> Option<PlaneCamera> {
        self.camera
    }

    pub(super) fn set_camera(&mut self, camera: Option<PlaneCamera>) {
        self.camera = camera;
    }

    fn frame_of(&self, index: usize, outcome: &Arc<Outcome>) -> Option<CellFrame> {
        let (places, frames) = self.frames.as_ref()?;
        frames.frames.get(index).filter(|_| places.get(index) == Some(&place_of(outcome))).copied()
    }

    /// Sets another layout of the cells. Reframes a camera that the user has not moved.
    fn take(&mut self, places: Vec<usize>, frames: CellFrames) {
        let is_first = self.frames.as_ref().is_none_or(|(before, _)| before.is_empty());
        let is_other = self.frames.as_ref().is_none_or(|(_, before)| before.bounds != frames.bounds);
        self.frames = Some((places, frames));
        if is_first || (is_other && self.is_framed()) {
            self.camera = None;
        }
    }

    fn is_framed(&self) -> bool {
        self.camera == self.framed
    }

    /// Frames the scenes for cells of this size, unless the user has moved the camera.
    fn frame_in(&mut self, cell: DVec2) {
        let has_other_size = std::mem::replace(&mut self.size, cell) != cell;
        let Some((_, frames)) = self.frames.as_ref().filter(|(_, frames)| !frames.frames.is_empty()) else { return };
        if self.camera.is_none() || (has_other_size && self.is_framed()) {
            self.camera = Some(PlaneCamera::framing(frames.bounds, cell));
            self.framed = self.camera;
        }
    }
}
