//! Landmarks of the picture as pins. They move the pins of their names, and wait for a vertex if there is no such pin.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::background_jobs::BackgroundJob;
use super::edits::pin;
use super::in_use::Role;
use super::landmarks::{Landmarks, WaitingLandmark, names_after, turned, waiting};
use super::{Command, Message, MessagePlace, Session, Written};
use freebound_core::pipeline::Targets;
use freebound_io::{
    LandmarkSet, PictureLandmark, PinName, PinNotes, PtsError, in_order_of_a_set, read_pts, targets_at_landmarks,
    write_durably, write_pts,
};

/// Size of a picture that leaves coordinates in pixels.
const IN_PIXELS: [u32; 2] = [1, 1];

impl Session {
    /// Reads landmarks of the picture in the background.
    pub(super) fn import_landmarks(&mut self, path: PathBuf) {
        if self.model().is_none() {
            return self.complain("landmarks need a mesh: open one first", None);
        }
        // A picture that is being read arrives first, because jobs with one description keep their order.
        self.jobs.send("reading the picture", move |_| {
            let read = read_pts(&path, IN_PIXELS);
            BackgroundJob::Landmarks { path, read }
        });
    }

    /// Moves the pins that have names of landmarks. The other landmarks wait for their vertices.
    pub(super) fn take_landmarks(&mut self, path: &Path, read: Result<Vec<PictureLandmark>, PtsError>) {
        let mut list = match read {
            Ok(list) => list,
            Err(error) => {
                let message = Message::error(MessagePlace::Embedding, error.to_string()).with_remedy(error.remedy());
                self.messages.say(message.of_file(Some(path)));
                return;
            }
        };
        let Some(picture) = self.document.picture.clone() else {
            return self.complain("landmarks belong to a picture", Some("open the picture, then import them again"));
        };
        let size = DVec2::new(picture.pixels.width.into(), picture.pixels.height.into());
        for landmark in &mut list {
            landmark.place /= size;
        }
        self.landmarks = Landmarks::new(list, picture);
        if !self.takes_pins() {
            return;
        }
        let document = &self.document;
        let here = self.moved_to_landmarks(&document.targets, &document.notes);
        let mut commands: Vec<Command> = here.into_iter().map(|(vertex, target)| pin(vertex, target)).collect();
        for (&chart, edits) in &document.elsewhere {
            let moved = self.moved_to_landmarks(&edits.targets, &edits.notes);
            if !moved.is_empty() {
                let mut edits = edits.clone();
                edits.targets.extend(moved);
                commands.push(Command::SetElsewhere { chart, edits });
            }
        }
        if !commands.is_empty() {
            self.edit(commands);
        }
    }

    /// Landmarks of the picture of the document.
    fn landmarks(&self) -> &[PictureLandmark] {
        self.landmarks.of(self.document.picture.as_ref())
    }

    /// Targets that landmarks of their names move.
    fn moved_to_landmarks(&self, targets: &Targets, notes: &PinNotes) -> Targets {
        let v_axis = self.document.v_axis;
        let mut moved = targets_at_landmarks(targets, notes, self.landmarks(), |place| turned(place, v_axis));
        moved.retain(|vertex, target| targets.get(vertex) != Some(target));
        moved
    }

    /// Number of imported landmarks.
    pub fn landmark_count(&self) -> usize {
        self.landmarks().len()
    }

    /// Landmarks that no pin has the name of, in the order of their file.
    pub fn landmarks_waiting(&self) -> Vec<WaitingLandmark> {
        if self.landmarks().is_empty() {
            return Vec::new();
        }
        waiting(self.landmarks(), &self.taken_names(), self.document.v_axis)
    }

    /// Waiting landmark with exactly these texture coordinates.
    pub fn landmark_at(&self, uv: DVec2) -> Option<WaitingLandmark> {
        self.landmarks_waiting().into_iter().find(|landmark| landmark.uv == uv)
    }

    /// First waiting landmark after the one with these texture coordinates, cyclically. Default: the first one.
    pub fn next_landmark(&self, after: Option<DVec2>) -> Option<WaitingLandmark> {
        let all = self.landmarks_waiting();
        let order = names_after(self.landmarks(), after, self.document.v_axis);
        order.into_iter().find_map(|name| all.iter().find(|landmark| landmark.name == name)).cloned()
    }

    /// Drops the landmarks that wait. Pins stay.
    pub(super) fn close_landmarks(&mut self) {
        self.landmarks = Landmarks::default();
    }

    /// Writes the named pins as landmarks of the picture, in the order of the imported file, or of a known set.
    pub(super) fn export_landmarks(&mut self, path: PathBuf) {
        let Some(picture) = self.document.picture.clone() else {
            return self.complain("landmarks belong to a picture", Some("open the picture first"));
        };
        let pins = self.model().map(|model| self.document.all_pins(model)).unwrap_or_default();
        let v_axis = self.document.v_axis;
        let named = pins.notes.iter().filter_map(|(vertex, note)| {
            let place = turned(pins.targets.get(vertex)?.uv, v_axis);
            Some(PictureLandmark { name: note.name.clone()?, place })
        });
        let named: Vec<PictureLandmark> = named.collect();
        let with_name = |name: &PinName| named.iter().find(|landmark| landmark.name.key() == name.key()).cloned();
        let in_file: Option<Vec<_>> = self.landmarks().iter().map(|landmark| with_name(&landmark.name)).collect();
        // A file without known names was imported, and is not open any more.
        let count = named.len();
        let numbered = || (0..count).map(|place| with_name(&LandmarkSet::name_of(count, place))).collect();
        let ordered = in_file.filter(|list| !list.is_empty()).or_else(numbered);
        let ordered: Vec<PictureLandmark> = match (ordered.filter(|list| !list.is_empty()), in_order_of_a_set(&named)) {
            (Some(list), _) => list,
            (None, Ok(list)) => list.into_iter().cloned().collect(),
            (None, Err(missing)) => {
                let text = format!("{}: the landmarks are incomplete: {missing}", path.display());
                return self.complain(text, Some("name the pins of the missing points, or export a .txt file"));
            }
        };
        if self.refuses_to_replace(&path, Some(Role::Constraints)) {
            return;
        }
        self.files.write(move || {
            write_durably(&path, |out| write_pts(out, &ordered, [picture.pixels.width, picture.pixels.height]))?;
            let about = Some(format!("{} landmarks", ordered.len()));
            Ok(Written { about, ..Written::file(path) })
        });
    }
}
