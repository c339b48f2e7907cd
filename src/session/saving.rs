//! Projects being written, one after the other.

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;

use glam::DVec2;

use super::chart_layout::ChartPlace;
use super::{Background, Document, MessagePlace, Messages, Model, Wake};
use freebound_core::mesh::{FaceId, Preparation};
use freebound_io::{PathStyle, PictureFile, ProjectFile, ProjectSource, WriteError};

/// Request to save a project.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) path: PathBuf,
    /// Document to be saved.
    pub(super) document: Document,
    /// Number of the opening that the document belongs to.
    pub(super) opening: u64,
}

/// Queue of projects to write. They are written in order, so that the last request is the last one written.
pub(super) struct ProjectSaves {
    under_way: Background<Request, Result<(), WriteError>>,
    waiting: VecDeque<(Request, ProjectFile)>,
}

impl ProjectSaves {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("save", wake), waiting: VecDeque::new() }
    }

    /// True if a project is being written or waits.
    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_busy() || !self.waiting.is_empty()
    }

    /// Writes a project after those before it.
    pub(super) fn start(&mut self, request: Request, project: ProjectFile) {
        self.waiting.push_back((request, project));
        self.begin_next();
    }

    fn begin_next(&mut self) {
        if self.under_way.is_busy() {
            return;
        }
        let Some((request, project)) = self.waiting.pop_front() else { return };
        let path = request.path.clone();
        self.under_way.start(request, move |_| project.write(&path, PathStyle::Relative));
    }

    /// Returns the request of a project that was written. Reports a failure.
    pub(super) fn poll(&mut self, messages: &mut Messages) -> Option<Request> {
        let (request, result) = self.under_way.poll()?;
        self.begin_next();
        match result {
            Ok(Ok(())) => return Some(request),
            Ok(Err(error)) => {
                messages.fail(MessagePlace::Embedding, error.to_string(), Some("save the project in another folder"));
            }
            Err(failure) => messages.fail_background(MessagePlace::Embedding, "saving", &failure),
        }
        None
    }
}

/// Origin of a mesh.
fn source_of(model: &Model) -> Option<ProjectSource> {
    let built_in = model.built_in.map(|name| ProjectSource::Example(name.to_owned()));
    let file = || Some(ProjectSource::File { path: model.path.clone()?, stamp: model.stamp.clone() });
    built_in.or_else(file)
}

/// Origin of a picture. A picture without a file belongs to the built-in mesh.
fn picture_source(picture: &PictureFile, model: &Model) -> Option<ProjectSource> {
    match &picture.path {
        Some(path) => Some(ProjectSource::File { path: path.clone(), stamp: picture.stamp.clone() }),
        None => model.built_in.map(|name| ProjectSource::Example(name.to_owned())),
    }
}

/// Project file of a document, without the view and without a picture that could not be read.
pub(super) fn project_of(model: &Model, document: &Document) -> Option<ProjectFile> {
    let mut project = ProjectFile::new(source_of(model)?, &document.settings);
    let Preparation { faces_turned, repair, holes, cut, seams, left_out } = document.form.clone();
    project.left_out_parts = left_out.iter().copied().collect();
    (project.faces_turned, project.repair, project.cut, project.seams) = (faces_turned, repair, cut, seams);
    project.weld_distance = repair.weld_distance();
    project.holes = Some(holes);
    project.relaxed = document.relaxed;
    project.picture = document.picture.as_ref().and_then(|picture| picture_source(picture, model));
    project.v_axis = document.v_axis;
    project.pins = document.all_pins(model);
    project.chart = document.chart;
    let layout = &document.layout;
    project.packing = layout.packing;
    project.sizes = layout.sizes.iter().map(|(face, &size)| (face.number(), size)).collect();
    (project.locked, project.placed) = (places(&layout.locked), places(&layout.placed));
    project.stacked = layout.stacked.iter().map(|(face, on)| (face.number(), on.number())).collect();
    let relaxed = document.elsewhere.iter().filter(|(_, edits)| edits.relaxed > 0);
    project.relaxed_elsewhere = relaxed.map(|(&chart, edits)| (chart, edits.relaxed)).collect();
    Some(project)
}

/// Places of charts, as a project stores them.
fn places(places: &BTreeMap<FaceId, ChartPlace>) -> BTreeMap<u32, Vec<[f64; 2]>> {
    let numbers = |ChartPlace(place): &ChartPlace| place.iter().map(DVec2::to_array).collect();
    places.iter().map(|(face, place)| (face.number(), numbers(place))).collect()
}
