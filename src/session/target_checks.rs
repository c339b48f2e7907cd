//! What is known of the targets before they are solved for: conflicts on the mesh as it is, and whether they look
//! mirrored.
//!
//! An embedding keeps the faces' orientation, so mirrored targets can hardly be met, and never well: a reflection then
//! fits them much better than a rotation. They are compared with the mesh flattened without pins, once, in the
//! background.

use glam::DVec2;

use super::{Background, Session, Wake};
use crate::geom::Similarity;
use crate::mesh::VertexId;
use crate::solver::{Conflict, Control, Embedding, Family, Method, Pins, Settings, SolveError, conflicts, flatten};

/// With fewer pins either fits.
const LEAST_PINS: usize = 3;

/// A reflection fits much better where its error is less than this part of the rotation's.
const MUCH_BETTER: f64 = 0.5;

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
        self.refresh_conflicts();
        self.refresh_flat();
    }

    fn refresh_conflicts(&mut self) {
        let settings = self.document.settings;
        let pins = if settings.method.uses_pins() { settings.held(&self.document.pins()) } else { Pins::default() };
        let looked_in = (self.model_revision(), pins);
        if self.target_checks.looked_in != looked_in {
            let found = self.disk().map(|disk| conflicts(disk, &looked_in.1));
            self.target_checks.conflicts = found.unwrap_or_default();
            self.target_checks.looked_in = looked_in;
        }
    }

    fn refresh_flat(&mut self) {
        let (revision, disk) = (self.model_revision(), self.disk().cloned());
        let TargetChecks { flat, flattening, .. } = &mut self.target_checks;
        if let Some((of, embedding)) = flattening.poll() {
            *flat = Some((of, embedding.ok().and_then(Result::ok)));
        }
        let is_known = flat.as_ref().is_some_and(|(of, _)| *of == revision) || flattening.is_busy();
        let Some(disk) = disk.filter(|_| !is_known && self.document.targets.len() >= LEAST_PINS) else { return };
        flattening.start(revision, move |cancel| {
            let settings = Settings::new(Method::Natural, Family::Conformal);
            let solution = flatten(&disk, &settings, &Pins::new(), Control::new(cancel, &|_| {}));
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

/// Whether a reflection takes the first of each pair much nearer to the second than a rotation does.
fn look_mirrored(pairs: &[[DVec2; 2]]) -> bool {
    let mirrored: Vec<[DVec2; 2]> = pairs.iter().map(|[z, target]| [DVec2::new(-z.x, z.y), *target]).collect();
    Similarity::fitting(&mirrored).is_some_and(|best| best.error(&mirrored) < MUCH_BETTER * error_of(pairs))
}

/// Error of the similarity without reflection that fits best; where none fits, of one point for all.
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
