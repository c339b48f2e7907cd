//! Part: landmarks of the picture.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec2;

use freebound_core::geom::VAxis;
use freebound_io::{PictureLandmark, PinName};

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

/// Landmarks of the picture, in the order of their file.
#[derive(Debug, Default)]
pub(super) struct Landmarks(Vec<PictureLandmark>);

impl Landmarks {
    /// Landmarks in the order of their file.
    pub(super) fn new(list: Vec<PictureLandmark>) -> Self {
        Self(list)
    }

    /// All landmarks.
    pub(super) fn list(&self) -> &[PictureLandmark] {
        &self.0
    }

    /// Landmarks whose names are not taken. Keys of names are compared.
    pub(super) fn waiting(&self, taken: &BTreeSet<String>, v_axis: VAxis) -> Vec<WaitingLandmark> {
        let waits = self.0.iter().filter(|landmark| !taken.contains(&landmark.name.key()));
        waits.map(|it| WaitingLandmark { name: it.name.clone(), uv: turned(it.place, v_axis) }).collect()
    }

    /// Names of all landmarks, cyclically, from the one after the landmark with these texture coordinates.
    pub(super) fn names_after(&self, uv: Option<DVec2>, v_axis: VAxis) -> Vec<PinName> {
        let place_of = |uv: DVec2| self.0.iter().position(|it| turned(it.place, v_axis) == uv);
        let start = uv.and_then(place_of).map_or(0, |place| place + 1);
        self.0[start..].iter().chain(&self.0[..start]).map(|landmark| landmark.name.clone()).collect()
    }
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
