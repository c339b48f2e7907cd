//! Checks of the targets before a solve: conflicts on the current mesh, and mirrored targets.
//!
//! An embedding keeps the orientation of the faces, so mirrored targets can hardly be met, and never well. A reflection
//! fits them much better than a rotation. They are compared with the mesh flattened without pins, once, in the
//! background.

use std::sync::Arc;

use super::{Background, Wake};
use freebound_core::flatten::solve_once;
use freebound_core::geom::look_mirrored;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, SolveError};
use freebound_core::verify::{Conflict, conflicts};

/// Minimum number of pins. With fewer pins a reflection fits as well as a rotation.
const LEAST_PINS: usize = 3;

/// Results of the checks.
pub(super) struct TargetChecks {
    /// Input of the last search for conflicts: the revision of the mesh, and its pins.
    looked_in: (u64, Pins),
    conflicts: Vec<Conflict>,
    /// Mesh flattened without pins, by its revision. The embedding is `None` if the flattening failed.
    flat: Option<(u64, Option<Embedding>)>,
    flattening: Background<u64, Result<Embedding, SolveError>>,
}

impl TargetChecks {
    pub(super) fn new(wake: &Wake) -> Self {
        let flattening = Background::new("undistorted", wake);
        Self { looked_in: Default::default(), conflicts: Vec::new(), flat: None, flattening }
    }

    /// Searches for conflicts among pins on the mesh with this revision, unless they are known.
    pub(super) fn find_conflicts(&mut self, revision: u64, disk: Option<&DiskMesh>, pins: Pins) {
        let looked_in = (revision, pins);
        if self.looked_in != looked_in {
            self.conflicts = disk.map(|disk| conflicts(disk, &looked_in.1)).unwrap_or_default();
            self.looked_in = looked_in;
        }
    }

    /// Flattens the mesh without pins in the background, if there are enough targets and the result is not known.
    pub(super) fn flatten(&mut self, revision: u64, disk: Option<Arc<DiskMesh>>, target_count: usize) {
        let Self { flat, flattening, .. } = self;
        if let Some((of, embedding)) = flattening.poll() {
            *flat = Some((of, embedding.ok().and_then(Result::ok)));
        }
        let is_known = flat.as_ref().is_some_and(|(of, _)| *of == revision) || flattening.is_busy();
        let Some(disk) = disk.filter(|_| !is_known && target_count >= LEAST_PINS) else { return };
        flattening.start(revision, move |cancel| {
            let settings = Settings::new(Method::Natural, Family::Conformal);
            let solution = solve_once(&disk, &settings, &Pins::new(), Control::new(cancel, &|_| {}));
            solution.map(|solution| solution.embedding)
        });
    }

    /// Conflicts among the pins.
    pub(super) fn conflicts(&self) -> &[Conflict] {
        &self.conflicts
    }

    /// True if pins on the mesh with this revision look mirrored. False while this is unknown.
    pub(super) fn look_mirrored(&self, revision: u64, pins: &Pins) -> bool {
        let Some((of, Some(embedding))) = &self.flat else { return false };
        if *of != revision || pins.len() < LEAST_PINS {
            return false;
        }
        let pairs = pins.iter().filter_map(|(vertex, pin)| Some([*embedding.get(vertex.index())?, pin.target]));
        look_mirrored(&pairs.collect::<Vec<_>>())
    }
}
