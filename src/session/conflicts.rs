//! Constraints that cannot be met on the mesh as it is, known before anything is solved.

use super::Session;
use crate::mesh::VertexId;
use crate::solver::{Conflict, Pins, conflicts};

/// Conflicts among the document's constraints, and what they were looked for in.
#[derive(Debug, Default)]
pub(super) struct Conflicts {
    /// The mesh by its revision, and the pins as they are held, in the plane.
    of: (u64, Pins),
    found: Vec<Conflict>,
}

impl Session {
    /// Constraints of the document that contradict each other on the mesh as it is.
    pub fn conflicts(&self) -> &[Conflict] {
        &self.conflicts.found
    }

    /// The first conflict that a pin takes part in.
    pub fn conflict_of(&self, vertex: VertexId) -> Option<&Conflict> {
        self.conflicts().iter().find(|conflict| conflict.vertices().contains(&vertex))
    }

    /// Looks for conflicts anew where pins or mesh have changed.
    pub(super) fn refresh_conflicts(&mut self) {
        let settings = self.document.settings;
        let pins = if settings.method.uses_pins() { settings.held(&self.document.pins()) } else { Pins::default() };
        let of = (self.model_revision, pins);
        if self.conflicts.of == of {
            return;
        }
        let disk = self.model.as_ref().and_then(|model| model.disk());
        let found = disk.map(|disk| conflicts(disk, &of.1)).unwrap_or_default();
        self.conflicts = Conflicts { of, found };
    }
}
