//! What is done to all targets together: mirroring, and fitting them to the undistorted embedding.

use glam::DVec2;

use super::errands::{Errand, Purpose};
use super::{Command, Place, Session};
use crate::geom::{PictureFrame, Similarity};
use crate::io::Target;
use crate::solver::{Control, Embedding, Family, GaugeSize, Method, Pins, Settings, SolveError, flatten};

/// The mesh flattened without pins, in the middle of the picture.
pub(super) struct Flat {
    /// The picture's frame.
    frame: PictureFrame,
    /// Whether the mesh's faces were turned around.
    faces_turned: bool,
    /// Where vertices lie, in the plane.
    embedding: Result<Embedding, SolveError>,
}

impl Session {
    /// Mirrors all targets left to right, within the box around them.
    pub(super) fn mirror_targets(&mut self) {
        let across = self.document.targets.values().map(|target| target.uv.x);
        let (low, high) = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        let mirrored = |target: &Target| DVec2::new(low + (high - target.uv.x), target.uv.y);
        let targets: Vec<DVec2> = self.document.targets.values().map(mirrored).collect();
        self.move_targets(&targets);
    }

    /// Flattens the mesh, to fit the targets to it.
    pub(super) fn fit_targets(&mut self) {
        if self.document.targets.len() < 2 {
            let text = "one target can be anywhere: fitting needs two pins or more".to_owned();
            return self.fail(Place::Embedding, text, Some("place another constraint"));
        }
        let model = self.model.as_ref();
        let Some((disk, faces_turned)) = model.and_then(|model| Some((model.disk()?.clone(), model.faces_turned)))
        else {
            return self.fail(Place::Embedding, "a mesh with faults has nothing to fit to".to_owned(), None);
        };
        let frame = self.document.frame();
        let [low, high] = frame.corners();
        let size = GaugeSize::Within { low, high };
        let settings = Settings { size, ..Settings::new(Method::Natural, Family::Conformal) };
        self.send(Purpose::Fit, move |context| {
            let control = Control::new(context.cancel_flag(), &|_| {});
            let solution = flatten(&disk, &settings, &Pins::new(), control);
            Errand::Flat(Flat { frame, faces_turned, embedding: solution.map(|solution| solution.embedding) })
        });
    }

    /// Fits the targets to the flattened mesh.
    pub(super) fn take_flat(&mut self, flat: &Flat) {
        let embedding = match &flat.embedding {
            Ok(embedding) => embedding,
            Err(error) => return self.fail(Place::Embedding, format!("there is nothing to fit to: {error}"), None),
        };
        if flat.frame != self.document.frame() || flat.faces_turned != self.document.faces_turned {
            let text = "picture or faces changed while the targets were being fitted".to_owned();
            return self.fail(Place::Embedding, text, Some("fit them again"));
        }
        let pairs: Vec<[DVec2; 2]> =
            (self.document.pins().into_iter()).map(|(vertex, pin)| [pin.target, embedding[vertex]]).collect();
        let fitted = Similarity::fitting(&pairs).map(|similarity| {
            let targets = pairs.iter().map(|[target, _]| flat.frame.uv_from_plane(similarity.apply(*target)));
            targets.collect::<Vec<_>>()
        });
        match fitted.filter(|targets| targets.iter().all(|target| target.is_finite())) {
            Some(targets) => self.move_targets(&targets),
            None => self.fail(Place::Embedding, "no turn and no size fits these targets".to_owned(), None),
        }
    }

    /// Gives the pins other targets, in their order, as one edit.
    fn move_targets(&mut self, targets: &[DVec2]) {
        let moved = self.document.targets.iter().zip(targets).filter(|((_, before), uv)| before.uv != **uv);
        let commands =
            moved.map(|((&vertex, before), &uv)| Command::SetPin { vertex, target: Some(Target { uv, ..*before }) });
        let commands = commands.collect();
        self.edit(commands);
    }
}
