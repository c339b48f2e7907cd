//! What is known of the targets before they are solved for: conflicts on the mesh as it is, and whether they look
//! mirrored.
//!
//! An embedding keeps the faces' orientation, so mirrored targets can hardly be met, and never well: a reflection then
//! fits them much better than a rotation. They are compared with the mesh flattened without pins, once, in the
//! background.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec2;

use super::open_mesh::OpenMesh;
use super::{Background, Document, Session, Wake};
use crate::geom::Similarity;
use crate::mesh::VertexId;
use crate::solver::{Conflict, Control, Embedding, Family, Method, Pins, Settings, SolveError, conflicts, flatten};

/// With fewer pins either fits.
const LEAST_PINS: usize = 3;

/// A reflection fits much better where its error is less than this part of the rotation's.
const MUCH_BETTER: f64 = 0.5;

/// What is known of the targets.
#[derive(Debug)]
pub(super) struct TargetChecks {
    /// What conflicts were looked for in: the mesh by its revision, and the pins as they are held.
    looked_in: (u64, Pins),
    conflicts: Vec<Conflict>,
    /// The mesh flattened without pins, by its revision; none where it cannot be flattened.
    flat: Option<(u64, Option<Embedding>)>,
    flattening: Background<u64, Result<Embedding, SolveError>>,
}

impl TargetChecks {
    /// Nothing is known yet.
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            looked_in: Default::default(),
            conflicts: Vec::new(),
            flat: None,
            flattening: Background::new("undistorted", wake),
        }
    }

    /// Brings everything up to date. Call once per frame.
    pub(super) fn refresh(&mut self, mesh: &OpenMesh, document: &Document) {
        self.refresh_conflicts(mesh, document);
        self.refresh_flat(mesh, document);
    }

    fn refresh_conflicts(&mut self, mesh: &OpenMesh, document: &Document) {
        let settings = document.settings;
        let pins = if settings.method.uses_pins() { settings.held(&document.pins()) } else { Pins::default() };
        let looked_in = (mesh.revision(), pins);
        if self.looked_in != looked_in {
            self.conflicts = mesh.disk().map(|disk| conflicts(disk, &looked_in.1)).unwrap_or_default();
            self.looked_in = looked_in;
        }
    }

    fn refresh_flat(&mut self, mesh: &OpenMesh, document: &Document) {
        if let Some((revision, embedding)) = self.flattening.poll() {
            self.flat = Some((revision, embedding.ok().and_then(Result::ok)));
        }
        let revision = mesh.revision();
        let is_known = self.flat.as_ref().is_some_and(|(of, _)| *of == revision) || self.flattening.is_busy();
        let Some(disk) = mesh.disk().filter(|_| !is_known && document.targets.len() >= LEAST_PINS) else { return };
        let disk = Arc::clone(disk);
        self.flattening.start(revision, move |cancel: &AtomicBool| {
            let settings = Settings::new(Method::Natural, Family::Conformal);
            let solution = flatten(&disk, &settings, &Pins::new(), Control::new(cancel, &|_| {}));
            solution.map(|solution| solution.embedding)
        });
    }

    fn look_mirrored(&self, mesh: &OpenMesh, document: &Document) -> bool {
        let Some((revision, Some(embedding))) = &self.flat else { return false };
        let pins = document.pins();
        if *revision != mesh.revision() || pins.len() < LEAST_PINS || !document.settings.method.uses_pins() {
            return false;
        }
        let pairs = pins.iter().filter_map(|(vertex, pin)| Some([*embedding.get(vertex.index())?, pin.target]));
        look_mirrored(&pairs.collect::<Vec<_>>())
    }
}

impl Session {
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
        self.target_checks.look_mirrored(&self.mesh, &self.document)
    }
}

/// Whether a reflection takes the first of each pair much nearer to the second than a rotation does.
fn look_mirrored(pairs: &[[DVec2; 2]]) -> bool {
    let mirrored: Vec<[DVec2; 2]> = pairs.iter().map(|[z, target]| [DVec2::new(-z.x, z.y), *target]).collect();
    Similarity::fitting(&mirrored).is_some_and(|best| best.error(&mirrored) < MUCH_BETTER * error_of(pairs))
}

/// What the similarity without reflection that fits best leaves; where none fits, what one place for all leaves.
fn error_of(pairs: &[[DVec2; 2]]) -> f64 {
    if let Some(best) = Similarity::fitting(pairs) {
        return best.error(pairs);
    }
    let middle = pairs.iter().map(|[_, target]| *target).sum::<DVec2>() / pairs.len() as f64;
    let squares: f64 = pairs.iter().map(|[_, target]| target.distance_squared(middle)).sum();
    (squares / pairs.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(1.9, 1.0), DVec2::new(-0.2, 1.3)];

    fn to(map: impl Fn(DVec2) -> DVec2) -> Vec<[DVec2; 2]> {
        CORNERS.iter().map(|&z| [z, map(z)]).collect()
    }

    #[test]
    fn what_is_turned_does_not_look_mirrored() {
        let turn = DVec2::new(0.3, -1.2);
        assert!(!look_mirrored(&to(|z| turn.rotate(z) + DVec2::ONE)));
    }

    #[test]
    fn what_is_mirrored_does() {
        let turn = DVec2::new(0.3, -1.2);
        assert!(look_mirrored(&to(|z| turn.rotate(DVec2::new(z.x, -z.y)))));
    }

    #[test]
    fn a_square_in_the_mirror_does_though_no_rotation_fits_it_at_all() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        assert!(look_mirrored(&square.map(|z| [z, DVec2::new(-z.x, z.y)])));
    }

    #[test]
    fn a_line_fits_both_ways() {
        let line = [0.0, 1.0, 2.5].map(|x| [DVec2::new(x, 0.0), DVec2::new(1.0, x)]);
        assert!(!look_mirrored(&line));
    }
}
