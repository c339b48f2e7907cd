//! Part: landmarks of the picture.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use freebound_core::geom::VAxis;
use freebound_io::{PictureFile, PictureLandmark, PinName};

/// Extension of files of landmarks.
const PTS: &str = "pts";

/// Landmark that no pin has the name of.
#[derive(Clone, Debug, PartialEq)]
pub struct WaitingLandmark {
    /// Name of the landmark.
    pub name: PinName,
    /// Its texture coordinates.
    pub uv: DVec2,
}

/// Landmarks of a picture, in the order of their file.
#[derive(Debug, Default)]
pub(super) struct Landmarks {
    list: Vec<PictureLandmark>,
    picture: Option<Arc<PictureFile>>,
}

impl Landmarks {
    /// Landmarks of a picture, in the order of their file.
    pub(super) fn new(list: Vec<PictureLandmark>, picture: Arc<PictureFile>) -> Self {
        Self { list, picture: Some(picture) }
    }

    /// All landmarks, if they belong to this picture.
    pub(super) fn of(&self, picture: Option<&Arc<PictureFile>>) -> &[PictureLandmark] {
        let own = self.picture.as_ref().zip(picture).is_some_and(|(own, picture)| Arc::ptr_eq(own, picture));
        if own { &self.list } else { &[] }
    }
}

/// Landmarks whose names are not taken. Keys of names are compared.
pub(super) fn waiting(list: &[PictureLandmark], taken: &BTreeSet<String>, v_axis: VAxis) -> Vec<WaitingLandmark> {
    let waits = list.iter().filter(|landmark| !taken.contains(&landmark.name.key()));
    waits.map(|it| WaitingLandmark { name: it.name.clone(), uv: turned(it.place, v_axis) }).collect()
}

/// Names of all landmarks, cyclically, from the one after all landmarks with these texture coordinates.
pub(super) fn names_after(list: &[PictureLandmark], uv: Option<DVec2>, v_axis: VAxis) -> Vec<PinName> {
    let place_of = |uv: DVec2| list.iter().rposition(|it| turned(it.place, v_axis) == uv);
    let start = uv.and_then(place_of).map_or(0, |place| place + 1);
    list[start..].iter().chain(&list[..start]).map(|landmark| landmark.name.clone()).collect()
}

/// True if a path names a file of landmarks.
pub(super) fn has_landmarks(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(PTS))
}

/// Texture coordinates of a place on the picture, or the place of texture coordinates.
pub(super) fn turned(place: DVec2, v_axis: VAxis) -> DVec2 {
    match v_axis {
        VAxis::Up => DVec2::new(place.x, 1.0 - place.y),
        VAxis::Down => place,
    }
}
