//! What is known of the targets before they are solved for: conflicts on the mesh as it is, and whether they look
//! mirrored.
//!
//! An embedding keeps the faces' orientation, so mirrored targets can hardly be met, and never well: a reflection then
//! fits them much better than a rotation. They are compared with the mesh flattened without pins, once, in the
//! background.

use super::{Background, Session, Wake};
use crate::geom::look_mirrored;
use crate::mesh::VertexId;
use crate::solver::{Conflict, Control, Embedding, Family, Method, Pins, Settings, SolveError, conflicts, solve_once};

/// With fewer pins either fits.
const LEAST_PINS: usize = 3;

/// What is known of the targets.
pub(super) struct TargetChecks {
    /// What conflicts were looked for in: the mesh by its revision, and the pins as they are held.
    looked_in: (u64, Pins),
    conflicts: Vec<Conflict>,
    /// The mesh flattened without pins, by its revision; none where it cannot be flattened.
    flat: Option<(u64, Option<Embedding>)>,
    flattening: Background<u64, Result<Embedding, SolveError>>,
}

impl TargetChecks {
    pub(super) fn new(wake: &Wake) -> Self {
        let flattening = Background::new("undistorted", wake);
        Self { looked_in: Default::default(), conflicts: Vec::new(), flat: None, flattening }
    }
}

impl Session {
    /// Brings everything up to date. Call once per frame.
    pub(super) fn refresh_target_checks(&mut self) {
        if !self.has_form_as_wanted() {
            return;
        }
        let settings = self.document.settings;
        let pins = if settings.method.uses_pins() { settings.held(&self.document.pins()) } else { Pins::default() };
        let looked_in = (self.model_revision(), pins);
        if self.target_checks.looked_in != looked_in {
            let found = self.disk().map(|disk| conflicts(disk, &looked_in.1));
            self.target_checks.conflicts = found.unwrap_or_default();
            self.target_checks.looked_in = looked_in;
        }
        let (revision, disk) = (self.model_revision(), self.disk().cloned());
        let TargetChecks { flat, flattening, .. } = &mut self.target_checks;
        if let Some((of, embedding)) = flattening.poll() {
            *flat = Some((of, embedding.ok().and_then(Result::ok)));
        }
        let is_known = flat.as_ref().is_some_and(|(of, _)| *of == revision) || flattening.is_busy();
        let Some(disk) = disk.filter(|_| !is_known && self.document.targets.len() >= LEAST_PINS) else { return };
        flattening.start(revision, move |cancel| {
            let settings = Settings::new(Method::Natural, Family::Conformal);
            let solution = solve_once(&disk, &settings, &Pins::new(), Control::new(cancel, &|_| {}));
            solution.map(|solution| solution.embedding)
        });
    }

    /// Constraints of the document that contradict each other on the mesh as it is.
    pub fn conflicts(&self) -> &[Conflict] {
        &self.target_checks.conflicts
    }

    /// The first conflict that a pin takes part in.
    pub fn conflict_of(&self, vertex: VertexId) -> Option<&Conflict> {
        self.conflicts().iter().find(|conflict| conflict.vertices().contains(&vertex))
    }

    /// Whether the targets of the document look mirrored: known only some time after there are enough of them.
    pub fn targets_look_mirrored(&self) -> bool {
        let Some((revision, Some(embedding))) = &self.target_checks.flat else { return false };
        let pins = self.document.pins();
        if *revision != self.model_revision() || pins.len() < LEAST_PINS || !self.document.settings.method.uses_pins() {
            return false;
        }
        let pairs = pins.iter().filter_map(|(vertex, pin)| Some([*embedding.get(vertex.index())?, pin.target]));
        look_mirrored(&pairs.collect::<Vec<_>>())
    }
}
